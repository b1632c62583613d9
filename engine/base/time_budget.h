// Time that a command may take, and progress that ends with it.
//
// Work that has to be done (cutting, measuring) does not look at it. Work that only adds (proofs, pictures)
// asks its progress whether to stop, as it does for Ctrl-C, and tells what it has left out.
#pragma once

#include <chrono>

#include "base/progress.h"

namespace swarf {

/// Wall-clock time from a moment on; without seconds it has no end. Results that hang on it are told as such:
/// another machine may come farther.
class TimeBudget {
 public:
  using Clock = std::chrono::steady_clock;

  TimeBudget() = default;
  /// It may have begun before, with the command that has loaded the job.
  explicit TimeBudget(double seconds, Clock::time_point begun = Clock::now());

  /// 0: no end.
  double seconds() const { return seconds_; }
  /// Whether this share of it has passed, 0 to 1; false where it has no end. Any thread may ask, as often as
  /// it likes.
  bool has_passed(double share = 1.0) const;
  /// One of `parts` equal parts of what is left, from now on; of several set-ups each gets one.
  TimeBudget part_of_rest(size_t parts) const;

 private:
  double spent_s() const;

  double seconds_ = 0.0;
  Clock::time_point begun_ = Clock::now();
};

/// Another progress that also asks to stop when a share of a budget has passed. The other one says whether
/// the user has stopped the work.
class BudgetProgress final : public Progress {
 public:
  /// `inner` must outlive it. share: 0 to 1 of the budget.
  BudgetProgress(Progress& inner, const TimeBudget& budget, double share);

  /// All of them are passed on; only the question whether to stop has an answer of its own.
  void begin(std::string_view stage, double total, std::string_view unit) override;
  void advance(double done) override;
  void start_at(double done) override;
  void note(std::string_view text) override;
  void end() override;
  bool stop_requested() const override;

 private:
  Progress& inner_;
  TimeBudget budget_;
  double share_;
};

}  // namespace swarf
