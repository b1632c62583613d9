// The cycles of one program by number and by place. Those of the first minutes are kept; the others are made
// anew, equal to the last bit, from the nearest of a few places that the first pass has left.
//
//   first pass   |----x--------x------x---------x----|     x: CyclePlace, at the start of an element or of a
//   CycleReader            [window]                            stretch of a run, about kPlaceApart cycles
//   apart
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "base/progress.h"
#include "motion/cycles/cycle_stream.h"

namespace swarf::motion {

/// What a long program may take.
struct CycleLimits {
  LookAheadReach reach;
  size_t kept = size_t{1} << 18U;  ///< cycles, 53 MB: four minutes at 1 ms
};

class Cycles {
 public:
  /// Solves the blocks' axis values (block_motions()); no cycle is made yet. `elements` must outlive this, in
  /// place. Throws InputError ("bad-options", "unreachable").
  Cycles(std::span<const toolpath::Element> elements, std::span<const kinematics::MachineModel> by_tool,
         const cutter::Cutter& cutter, const MotionOptions& options, const CycleLimits& limits = {});
  Cycles(Cycles&&) = default;
  Cycles& operator=(Cycles&&) = default;

  /// The first pass: visits all cycles in their order, until the user stops it. Not to be called twice.
  void walk(const std::function<void(std::span<const Cycle>)>& visit, Progress& progress);
  /// Cycles that the first pass has visited.
  size_t size() const { return size_; }
  /// The user has stopped it: there would be more.
  bool stopped() const { return stopped_; }
  double time_s() const { return size_ > 0 ? static_cast<double>(size_ - 1) * options_.period_s : 0.0; }
  double period_s() const { return options_.period_s; }

  const std::vector<BlockMotion>& motions() const { return motions_; }
  std::span<const toolpath::Element> elements() const { return elements_; }
  std::span<const kinematics::MachineModel> machines() const { return by_tool_; }
  const kinematics::InverseKinematics& inverse(size_t tool) const {
    return inverses_[inverses_.size() == 1 ? 0 : tool];
  }
  const cutter::Cutter& cutter() const { return cutter_; }
  const MotionOptions& options() const { return options_; }
  CycleSource source() const;
  /// The first ones.
  std::span<const Cycle> kept() const { return kept_; }
  /// So many cycles from the first to the last, spread evenly; those of long programs lie up to a
  /// kSpreadLeast-th of it away from there. Fewer where the program has fewer.
  std::vector<Cycle> spread(size_t count) const;
  static constexpr size_t kSpreadLeast = 2048;
  /// By cycle; the first stands before the first cycle.
  const std::vector<CyclePlace>& places() const { return places_; }

 private:
  void keep(const Cycle& cycle);

  std::span<const toolpath::Element> elements_;
  std::vector<kinematics::MachineModel> by_tool_;
  std::vector<kinematics::InverseKinematics> inverses_;
  std::vector<BlockMotion> motions_;
  cutter::Cutter cutter_;
  MotionOptions options_;
  CycleLimits limits_;
  std::vector<Cycle> kept_;
  std::vector<Cycle> sparse_;  ///< every sparse_step_-th; kSpreadLeast to twice as many in long programs
  uint64_t sparse_step_ = 1;
  Cycle last_;
  std::vector<CyclePlace> places_;
  size_t size_ = 0;
  bool stopped_ = false;
};

/// Looks cycles up, best in their order; holds one window of them. Cycles must outlive it and have been
/// walked. One reader for each thread.
class CycleReader {
 public:
  explicit CycleReader(const Cycles& cycles) : cycles_(&cycles) {}
  /// k below Cycles::size(). Valid until the next call.
  const Cycle& at(size_t k);
  /// Of a path of blocks: the first cycle that has come to this share of an element or is past it; the last
  /// one if none has.
  size_t reaching(int element, double share);

 private:
  bool holds(size_t k) const { return k >= first_ && k < first_ + window_.size(); }
  void move_on();
  void start_from(const CyclePlace& place);

  const Cycles* cycles_;
  std::unique_ptr<CycleStream> stream_;
  std::vector<Cycle> window_;
  size_t first_ = 0;  ///< number of window_.front()
};

}  // namespace swarf::motion
