// The machine as a tree of glTF nodes: axes that can be turned, tools, the stock in its stages.
#pragma once

#include <string>
#include <vector>

#include "motion/cycles/axis_keys.h"
#include "render/gltf/gltf_writer.h"
#include "reports/machine_view.h"
#include "reports/stock_stages.h"

namespace swarf::reports {

/// Seconds of the animation for each cycle: a power of two, so that the time of every key is a float exactly.
double cycle_seconds(const FinishedRun& run);

/// The machine as a tree of nodes: an axis moves its own node alone, in straight lines between its keys.
class MachineNodes {
 public:
  /// References must outlive it and what it gives.
  MachineNodes(const FinishedRun& run, const MachineView& view, const motion::AxisKeys& keys);
  void add_tools();
  /// The stock at its stages, each hidden but from its cycle to the next one's, then the finished part.
  void add_stock(const std::vector<StockStage>& stages, const TriMesh& part);
  /// Beside the stock, in the work frame.
  void add_to_work(render::GltfNode node);
  std::vector<render::GltfNode> take() { return std::move(nodes_); }
  /// How far each axis strays from the cycles between its keys.
  void state_errors(render::GltfExtras& extras) const;

 private:
  void add_link(const machine::Link& link);
  int add(render::GltfNode node);
  render::GltfNode stock_node(const std::string& name, const TriMesh& mesh, const render::Material& material);
  render::GltfNode on_work(render::GltfNode node) const;
  int moving_node(const machine::Link& link, int parent);

  const FinishedRun& run_;
  const MachineView& view_;
  const motion::AxisKeys& keys_;
  double seconds_;
  std::vector<render::GltfNode> nodes_;
  std::vector<int> of_link_;  ///< the node that carries the link's mesh and what hangs on it
};

}  // namespace swarf::reports
