// Time that a command may take, and progress that ends with it.
#pragma once

#include <chrono>

#include "base/progress.h"

namespace swarf {

/// Wall-clock time from a moment on; without seconds it has no end.
class TimeBudget {
 public:
  using Clock = std::chrono::steady_clock;

  TimeBudget() = default;
  explicit TimeBudget(double seconds, Clock::time_point begun = Clock::now())
      : seconds_(seconds), begun_(begun) {}

  /// 0: no end.
  double seconds() const { return seconds_; }
  /// Whether this share of it has passed.
  bool has_passed(double share = 1.0) const { return seconds_ > 0.0 && spent_s() >= share * seconds_; }
  /// One of `parts` equal parts of what is left, from now on.
  TimeBudget part_of_rest(size_t parts) const;

 private:
  double spent_s() const { return std::chrono::duration<double>(Clock::now() - begun_).count(); }

  double seconds_ = 0.0;
  Clock::time_point begun_ = Clock::now();
};

/// Another progress that also asks to stop when a share of a budget has passed.
class BudgetProgress final : public Progress {
 public:
  BudgetProgress(Progress& inner, const TimeBudget& budget, double share)
      : inner_(inner), budget_(budget), share_(share) {}

  void begin(std::string_view stage, double total, std::string_view unit) override {
    inner_.begin(stage, total, unit);
  }
  void advance(double done) override { inner_.advance(done); }
  void start_at(double done) override { inner_.start_at(done); }
  void note(std::string_view text) override { inner_.note(text); }
  void end() override { inner_.end(); }
  bool stop_requested() const override { return inner_.stop_requested() || budget_.has_passed(share_); }

 private:
  Progress& inner_;
  TimeBudget budget_;
  double share_;
};

}  // namespace swarf
