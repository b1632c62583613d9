#include "base/time_budget.h"

#include <algorithm>

namespace swarf {

TimeBudget::TimeBudget(double seconds, Clock::time_point begun) : seconds_(seconds), begun_(begun) {}

double TimeBudget::spent_s() const {
  return std::chrono::duration<double>(Clock::now() - begun_).count();
}

bool TimeBudget::has_passed(double share) const {
  return seconds_ > 0.0 && spent_s() >= share * seconds_;
}

TimeBudget TimeBudget::part_of_rest(size_t parts) const {
  if (seconds_ <= 0.0) return {};
  constexpr double kLeast = 1e-3;  // s: spent, but not without end
  return TimeBudget(std::max(kLeast, (seconds_ - spent_s()) / static_cast<double>(parts)));
}

BudgetProgress::BudgetProgress(Progress& inner, const TimeBudget& budget, double share)
    : inner_(inner), budget_(budget), share_(share) {}

void BudgetProgress::begin(std::string_view stage, double total, std::string_view unit) {
  inner_.begin(stage, total, unit);
}

void BudgetProgress::advance(double done) {
  inner_.advance(done);
}

void BudgetProgress::start_at(double done) {
  inner_.start_at(done);
}

void BudgetProgress::note(std::string_view text) {
  inner_.note(text);
}

void BudgetProgress::end() {
  inner_.end();
}

bool BudgetProgress::stop_requested() const {
  return inner_.stop_requested() || budget_.has_passed(share_);
}

}  // namespace swarf
