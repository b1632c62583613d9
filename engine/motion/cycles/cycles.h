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

#include "base/hash.h"
#include "base/progress.h"
#include "motion/cycles/cycle_stream.h"

namespace swarf::motion {

/// What a long program may take.
struct CycleLimits {
  LookAheadReach reach;
  size_t kept = size_t{1} << 18U;  ///< cycles, 53 MB: four minutes at 1 ms
};

/// What a first pass leaves to those that come after it.
struct CycleRecall {
  std::vector<CyclePlace> places;
  /// By place: hash of the kPlaceChecked cycles that follow it, or of as many as there are.
  std::vector<uint64_t> checks;
  uint64_t cycles = 0;
  uint64_t hash = 0;  ///< of all cycles
};
inline constexpr uint64_t kPlaceChecked = 64;

class Cycles {
 public:
  /// Solves the blocks' axis values (block_motions()); no cycle is made yet. Throws InputError
  /// ("bad-options", "unreachable").
  Cycles(const toolpath::Elements& elements, std::span<const kinematics::MachineModel> by_tool,
         const cutter::Cutter& cutter, const MotionOptions& options, const CycleLimits& limits = {});
  Cycles(Cycles&&) = default;
  Cycles& operator=(Cycles&&) = default;

  /// The first pass: visits all cycles in their order, until the user stops it. Not to be called twice. The
  /// visitor may be on another thread, one window at a time.
  void walk(const std::function<void(std::span<const Cycle>)>& visit, Progress& progress);
  /// Instead of walk(): what an earlier first pass over the same path has left. Nothing is kept then, and
  /// spread() is not to be asked.
  void recall(CycleRecall before);
  /// For recall(), when all cycles have been visited.
  CycleRecall recalled() const { return {places_, checks_, size_, hash_.value()}; }
  /// Cycles that the first pass has visited.
  size_t size() const { return size_; }
  /// The user has stopped it: there would be more.
  bool stopped() const { return stopped_; }
  double time_s() const { return size_ > 0 ? static_cast<double>(size_ - 1) * options_.period_s : 0.0; }
  double period_s() const { return options_.period_s; }

  /// None but of blocks.
  const BlockMotions& motions() const { return motions_; }
  const toolpath::Elements& elements() const { return elements_; }
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
  /// By place, of a recalled motion; else empty.
  std::span<const uint64_t> recalled_checks() const {
    return recalled_ ? std::span<const uint64_t>(checks_) : std::span<const uint64_t>();
  }
  /// Of one cycle, for CycleRecall.
  static void add_to(Hash& hash, const Cycle& cycle);

 private:
  void take(std::span<const Cycle> window, const CyclePlace& place,
            const std::function<void(std::span<const Cycle>)>& visit);
  void keep(const Cycle& cycle);
  void check(std::span<const Cycle> window);

  toolpath::Elements elements_;
  std::vector<kinematics::MachineModel> by_tool_;
  std::vector<kinematics::InverseKinematics> inverses_;
  BlockMotions motions_;
  cutter::Cutter cutter_;
  MotionOptions options_;
  CycleLimits limits_;
  std::vector<Cycle> kept_;
  std::vector<Cycle> sparse_;  ///< every sparse_step_-th; kSpreadLeast to twice as many in long programs
  uint64_t sparse_step_ = 1;
  Cycle last_;
  std::vector<CyclePlace> places_;
  std::vector<uint64_t> checks_;
  Hash hash_, place_hash_;
  size_t size_ = 0;
  bool stopped_ = false, recalled_ = false;
};

/// Looks cycles up, best in their order; holds one window of them. Cycles must outlive it and have been
/// walked or recalled; throws InputError "run-differs" where those of a recalled motion are not what they
/// were. One reader for each thread.
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
  void start_from(size_t place);
  void pass_to(size_t k);

  const Cycles* cycles_;
  std::unique_ptr<CycleStream> stream_;
  std::vector<Cycle> window_;
  size_t first_ = 0;  ///< number of window_.front()
};

}  // namespace swarf::motion
