#include "motion/options.h"

#include <fmt/format.h>

#include <cmath>

namespace swarf::motion {

std::vector<std::string> validate(const MotionOptions& options) {
  std::vector<std::string> problems;
  const auto positive = [&](double value, const char* name, const char* unit) {
    if (!(value > 0.0) || !std::isfinite(value))
      problems.push_back(fmt::format("{} must be a number above 0 {}, it is {:g}", name, unit, value));
  };
  positive(options.period_s, "period_s", "s");
  positive(options.path_acceleration_max, "path_acceleration_max", "mm/s^2");
  positive(options.path_jerk_max, "path_jerk_max", "mm/s^3");
  positive(options.corner_tolerance_mm, "corner_tolerance_mm", "mm");
  positive(options.fast_rotary_rad_mm, "fast_rotary_rad_mm", "rad/mm");
  positive(options.swing_rad, "swing_rad", "rad");
  return problems;
}

}  // namespace swarf::motion
