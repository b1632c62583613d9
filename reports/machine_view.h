// The machine as things to draw: links, cutter, holder and stock at given axis positions.
#pragma once

#include <optional>
#include <vector>

#include "kinematics/machine_model.h"
#include "motion/cycles/axis_keys.h"
#include "motion/cycles/cycles.h"
#include "render/draw_list.h"
#include "sim/check.h"
#include "sim/job/scene.h"
#include "sim/run/carried_cuts.h"
#include "sim/run/cycle_window.h"
#include "sim/run/job_sweeps.h"
#include "stock/rays/surface_dexels.h"
#include "stock/stock.h"

namespace swarf::reports {

/// What pictures are made of: a run in memory, or one read back from its folder. Borrowed.
struct FinishedRun {
  const sim::Job& job;
  const motion::Cycles& cycles;
  const stock::Stock& stock;
  const std::vector<stock::SurfaceDexels>& dexels;
  const sim::CarriedCuts& carried;  ///< of earlier set-ups
  /// What of the motion is shown; none: all of it.
  std::optional<sim::CycleWindow> window{};
  /// Of all cycles, finished; null: they are gathered where they are needed.
  const motion::AxisKeys* keys = nullptr;
  /// What cut the measuring rays, sim::all_ray_sweeps(); null where nobody asks for colours that need them
  /// (sim::colours_need_sweeps).
  const sim::JobSweeps* rays = nullptr;
  /// Null: none are known, and the movie shows none.
  const std::vector<sim::Finding>* findings = nullptr;

  /// Numbers of the first and the last cycle that are shown; there must be one.
  size_t first_shown() const { return window ? window->first : 0; }
  size_t last_shown() const { return (window ? window->end : cycles.size()) - 1; }
  /// So many of them, spread evenly, the first and the last among them; fewer where there are fewer. Of long
  /// motions without a window as Cycles::spread().
  std::vector<motion::Cycle> shown_cycles(size_t count) const;
};

/// Meshes of cutters and holders, made once from the scene's tools. `tool`: index into Scene::tools.
class MachineView {
 public:
  explicit MachineView(const sim::Job& job);

  /// Links, cutter and holder in the spindle, and the given stock mesh (work frame; may be null), in the
  /// machine frame at q. A section of the drawing opens the stock and what holds it.
  std::vector<render::DrawItem> items(const kinematics::AxisValues& q, size_t tool,
                                      const TriMesh* stock_mesh) const;
  /// Work frame to machine frame at q.
  Pose work_pose(const kinematics::AxisValues& q) const;
  /// Tool frame (tip, axis +Z) to machine frame at q.
  Pose tool_pose(const kinematics::AxisValues& q, size_t tool) const;
  const TriMesh& cutter(size_t tool) const { return figures_[tool].cutter; }
  const TriMesh& holder(size_t tool) const { return figures_[tool].holder; }
  /// The holder's nose in the tool frame.
  Pose holder_in_tool(size_t tool) const;

 private:
  struct Figure {
    TriMesh cutter, holder;
    kinematics::MachineModel machine;  ///< with this tool
  };
  const sim::Job& job_;
  std::vector<Figure> figures_;  ///< by tool
};

inline constexpr render::Material kStockMaterial{{0.62F, 0.64F, 0.67F}, 0.55F, 0.38F};
inline constexpr render::Material kToolMaterial{{0.80F, 0.72F, 0.45F}, 0.9F, 0.25F};
inline constexpr render::Material kHolderMaterial{{0.30F, 0.31F, 0.33F}, 0.9F, 0.35F};

}  // namespace swarf::reports
