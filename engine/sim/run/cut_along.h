// A stock of the eye's own voxels that is cut as far as the tool has come, in the middle of a block too.
//
//   sweep      |================================|        cut whole, once the tool has come to its end
//   frames     |--------|-----------|- - - - - -         until then the part since the last frame, held back
//              f0       f1          f2
//
// What a part leaves must be no less than what the whole sweep leaves, to the last bit, so that in the end
// nothing tells whether there were frames on the way. Parts and whole are rounded differently, and a part of
// a sweep that turns lies beside it by up to twice its motion_bound(): so the parts are cut by a cutter that
// is smaller all around by more than both. That is far below a pixel, and gone when the whole sweep is cut.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "motion/cycles/cycles.h"
#include "sim/job/scene.h"
#include "sim/run/carried_cuts.h"
#include "sim/run/job_sweeps.h"
#include "stock/stock.h"

namespace swarf::sim {

/// Share of the sweep, 0 to 1, at which the tool in this pose is nearest to it; none where the tip is farther
/// from there than `near_mm`, or the axis turned from there by so much that a point `lever_mm` above the tip
/// is.
std::optional<double> share_on(const stock::Sweep& sweep, const ToolPose& pose, double lever_mm,
                               double near_mm);

/// The cutter, smaller by this all around, mm; none where a rounding of it is not twice that.
std::optional<stock::CutterSolid> held_back(const stock::CutterSolid& cutter, double by_mm);

class CutAlong {
 public:
  /// What a part leaves stands out no farther, voxels; a sweep that turns too much for that is seen when it
  /// is whole.
  static constexpr double kProudVoxels = 0.04;

  /// The material as the job's own program meets it. `cycles`: walked or recalled.
  CutAlong(const Job& job, const CarriedCuts& carried, const motion::Cycles& cycles, double voxel_mm);

  /// Cuts up to the tool's place in this cycle, which is no earlier than the last one. `before`: called with
  /// each tool (index into Scene::tools) before it cuts.
  void advance(const motion::Cycle& cycle, const std::function<void(size_t tool)>& before = {});
  /// Cuts the sweeps alone that are over by then: what is left follows from the cycle, whatever the calls
  /// before.
  void advance_whole(const motion::Cycle& cycle, const std::function<void(size_t tool)>& before = {});
  const stock::Stock& stock() const { return stock_; }
  const JobSweeps& sweeps() const { return all_; }

 private:
  void cut_part(const motion::Cycle& cycle, const std::function<void(size_t tool)>& before);

  stock::Stock stock_;
  JobSweeps all_;
  std::vector<stock::CutterSolid> solids_;  ///< by tool
  std::vector<double> levers_mm_;           ///< by tool
  size_t done_ = 0;                         ///< sweeps that are cut whole
  double share_ = 0.0;                      ///< of the next one that is cut
};

}  // namespace swarf::sim
