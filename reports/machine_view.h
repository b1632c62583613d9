// The machine as things to draw: links, cutter, holder and stock at given axis positions.
#pragma once

#include "kinematics/machine_model.h"
#include "render/draw_list.h"
#include "sim/scene.h"
#include "stock/stock.h"
#include "stock/surface_dexels.h"

namespace swarf::reports {

/// What pictures are made of: a run in memory, or one read back from its folder. Borrowed.
struct FinishedRun {
  const sim::Job& job;
  const motion::Trajectory& trajectory;
  const stock::Stock& stock;
  const std::vector<stock::SurfaceDexels>& dexels;
};

/// Meshes of cutter and holder, made once from the scene's [cutter].
class MachineView {
 public:
  explicit MachineView(const sim::Job& job);

  /// Links, cutter, holder and the given stock mesh (work frame; may be null), in the machine frame at q.
  std::vector<render::DrawItem> items(const kinematics::AxisValues& q, const TriMesh* stock_mesh) const;
  /// Work frame to machine frame at q.
  Pose work_pose(const kinematics::AxisValues& q) const;
  /// Tool frame (tip, axis +Z) to machine frame at q.
  Pose tool_pose(const kinematics::AxisValues& q) const;
  const TriMesh& tool() const { return tool_; }
  const TriMesh& holder() const { return holder_; }
  /// The holder's nose in the tool frame.
  Pose holder_in_tool() const;

 private:
  const sim::Job& job_;
  TriMesh tool_, holder_;
};

inline constexpr render::Material kStockMaterial{{0.62F, 0.64F, 0.67F}, 0.55F, 0.38F};
inline constexpr render::Material kToolMaterial{{0.80F, 0.72F, 0.45F}, 0.9F, 0.25F};
inline constexpr render::Material kHolderMaterial{{0.30F, 0.31F, 0.33F}, 0.9F, 0.35F};

}  // namespace swarf::reports
