// Numbers beside their limits, in as many digits as it takes to read on the same side of them.
#pragma once

#include <fmt/format.h>

#include <string>

namespace swarf::sim {

/// A limit as it was written: the shortest text that is read back as the same number. One of more digits than
/// anybody writes is computed, and told in six.
inline std::string limit_text(double limit) {
  constexpr size_t kLongest = 12;  // characters
  const std::string rounded = fmt::format("{:g}", limit), whole = fmt::format("{}", limit);
  return std::stod(rounded) == limit || whole.size() > kLongest ? rounded : whole;
}

/// Three digits behind the point, or more: "1.0010004" is above 1.001, which "1.001" would not say.
inline std::string text_beside(double value, double limit) {
  constexpr int kLeastDigits = 3, kMostDigits = 12;
  for (int digits = kLeastDigits; digits <= kMostDigits; ++digits) {
    std::string text = fmt::format("{:.{}f}", value, digits);
    if ((std::stod(text) > limit) == (value > limit)) return text;
  }
  return fmt::format("{}", value);
}

}  // namespace swarf::sim
