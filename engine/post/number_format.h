// How a control wants its numbers.
#pragma once

#include <string>

namespace swarf::post {

struct NumberFormat {
  int decimals = 3;    ///< digits behind the point, 0 to 9
  bool point = true;   ///< "10." instead of "10": older controls count a number without one in its last digit
  bool zeros = false;  ///< zeros at the end stay: "10.500"
  bool plus = false;   ///< "+10"
};

/// The number nearest to `value` that the format has; zero never has a minus sign.
std::string written(const NumberFormat& format, double value);

/// No number is farther from what is written for it, in its own unit, but for the rounding of doubles.
double half_digit(const NumberFormat& format);

}  // namespace swarf::post
