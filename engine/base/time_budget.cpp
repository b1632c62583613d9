#include "base/time_budget.h"

#include <algorithm>

namespace swarf {

TimeBudget TimeBudget::part_of_rest(size_t parts) const {
  if (seconds_ <= 0.0) return {};
  constexpr double kLeast = 1e-3;  // s: spent, but not without end
  return TimeBudget(std::max(kLeast, (seconds_ - spent_s()) / static_cast<double>(parts)));
}

}  // namespace swarf
