// The stock of a movie as it is cut, in patches of which only the changed ones are made again.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "mesh/tri_mesh.h"
#include "render/draw_list.h"
#include "render/figures/colour.h"
#include "reports/machine_view.h"
#include "sim/job/scene.h"
#include "sim/run/cut_along.h"
#include "sim/run/measured_mesh.h"
#include "stock/mesher/stock_mesher.h"

namespace swarf::reports {

/// A state of the stock: its patches, shared with the states before and after it.
using StockState = std::vector<std::shared_ptr<const TriMesh>>;

/// Items of a state, in the frame that X_world leads to from the work frame. The state must outlive them.
void add_stock(const StockState& state, const std::vector<uint64_t>& revisions, const Pose& X_world,
               std::vector<render::DrawItem>& items);

/// The stock as the program cuts it, at the movie's own voxel size.
class MovieStock {
 public:
  MovieStock(const FinishedRun& run, sim::MovieColours colours);

  /// Cuts up to the tool's place in this cycle, which is no earlier than the last one.
  void advance(const motion::Cycle& cycle);
  const StockState& state() const { return patches_; }
  /// By patch: grows when the patch changes, and is like that of no other.
  const std::vector<uint64_t>& revisions() const { return revisions_; }
  /// Patches made again in all calls of advance().
  size_t patches_made() const { return made_; }
  /// Vertices that were measured in all calls of advance(), for their deviation.
  size_t vertices_measured() const { return vertices_measured_; }

 private:
  void mesh_changes();
  void colour_by_tool(size_t number, TriMesh& mesh);
  void colour_by_deviation(const std::vector<size_t>& changed,
                           const std::vector<std::shared_ptr<TriMesh>>& made);

  const FinishedRun& run_;
  sim::CutAlong along_;
  stock::StockMesher mesher_;
  sim::MovieColours colours_;
  StockState patches_;
  std::vector<uint64_t> revisions_;
  std::vector<std::vector<std::pair<uint64_t, int8_t>>> tools_;  ///< by patch: place of a vertex, who cut it
  /// By patch: place and normal of a finished vertex, its deviation, um (NaN: no ray sees it).
  std::vector<std::vector<std::pair<uint64_t, float>>> deviations_;
  std::unique_ptr<sim::MeshMeasure> measure_;  ///< made when first needed, as is the scale
  render::DeviationScale scale_{1.0};
  int8_t cutting_;  ///< the last tool that cut
  size_t made_ = 0, vertices_measured_ = 0;
};

}  // namespace swarf::reports
