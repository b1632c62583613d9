// What earlier set-ups have cut, as this one sees it: a second clamping does not change the material, so the
// stock it begins with is the first raw body less all sweeps so far, moved by one rigid pose. Nothing is
// resampled: level set and measuring rays are cut by these sweeps before the program's own.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "sim/job/scene.h"
#include "stock/stock.h"
#include "stock/sweep/sweep.h"

namespace swarf::sim {

/// A block of an earlier program, by the first of its sweeps.
struct CarriedBlock {
  size_t first_sweep = 0;
  uint32_t file = 0;  ///< index into CarriedSweeps::files
  int line = 0;
};

/// Sweeps in the order in which they cut, W of this set-up; Sweep::block is the index.
struct CarriedSweeps {
  std::vector<stock::Sweep> sweeps;
  std::vector<int> solids;           ///< of each sweep, index into CarriedCuts::solids
  std::vector<std::string> where;    ///< of each set-up that has cut: in words
  std::vector<size_t> ends;          ///< of each set-up: behind its last sweep
  std::vector<CarriedBlock> blocks;  ///< of sweeps for the rays
  std::vector<std::string> files;    ///< that the blocks stand in
  double error_bound_mm = 0.0;       ///< greatest distance between the sweeps and the motion they stand for
};

struct CarriedCuts {
  std::vector<stock::CutterSolid> solids;        ///< all tools of all earlier set-ups
  CarriedSweeps stock;                           ///< for the level set
  CarriedSweeps rays;                            ///< for the measuring rays; empty without a design
  std::string tools;                             ///< in words that determine them
  std::vector<std::vector<std::string>> called;  ///< of each earlier set-up: files of called programs

  bool empty() const { return stock.sweeps.empty(); }
  /// "" without cuts; else what determines them: every pose and every tool.
  std::string text() const;
  size_t bytes() const;
};
using CarriedCutsPtr = std::shared_ptr<const CarriedCuts>;

/// The paths of the earlier set-ups, planned and swept again within this one's tolerances. Of a set-up that
/// another run has cut (stock.from_run) the sweeps must be those that its stock was cut by, all of them:
/// throws InputError "from-run-unfinished", "from-run-differs", what Stock::load throws, and as job_path()
/// does.
CarriedCutsPtr carried_cuts(const Job& job);

/// Cuts `stock` by all of them; false: the user stopped it, and it is of no use.
bool cut_carried(stock::Stock& stock, const CarriedCuts& cuts, Progress* progress = nullptr);

/// The material as the job's own program meets it, for pictures and previews.
stock::Stock starting_stock(const Job& job, const CarriedCuts& cuts, double voxel_mm);

/// Calls visit(solid, sweeps) for each row of consecutive sweeps of one tool in [begin, end).
template <typename Visit>
void for_each_solid(const CarriedSweeps& carried, size_t begin, size_t end, const Visit& visit) {
  for (size_t from = begin, to = begin; from < end; from = to) {
    while (to < end && carried.solids[to] == carried.solids[from]) ++to;
    visit(static_cast<size_t>(carried.solids[from]), std::span(carried.sweeps).subspan(from, to - from));
  }
}

/// "in set-up 1, first side" of a sweep.
const std::string& carried_place(const CarriedSweeps& carried, size_t sweep);

/// The block of the earlier program that a sweep for the rays belongs to.
SourceLocation carried_block(const CarriedSweeps& carried, size_t sweep);

}  // namespace swarf::sim
