#include "post/number_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace swarf::post {

std::string written(const NumberFormat& format, double value) {
  std::string text = fmt::format("{:.{}f}", value, format.decimals);
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  if (format.decimals > 0 && !format.zeros) text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.' && !format.point) text.pop_back();
  if (format.decimals == 0 && format.point) text += '.';
  if (format.plus && text.front() != '-') text.insert(text.begin(), '+');
  return text;
}

double half_digit(const NumberFormat& format) {
  return 0.5 * std::pow(10.0, -format.decimals);
}

}  // namespace swarf::post
