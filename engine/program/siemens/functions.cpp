#include "program/siemens/functions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"

namespace swarf::program::nc::siemens {
namespace {

struct Function {
  const char* name;
  size_t arguments;
  double (*apply)(const double* x);  ///< NaN: outside the domain
  const char* domain;
};

/// Sine of an angle in degrees, exact at multiples of 30 degrees where the result is 0, 1/2 or 1.
double sine_deg(double angle_deg) {
  double turn = std::fmod(angle_deg, 360.0);
  if (turn < 0.0) turn += 360.0;
  if (turn >= 180.0) return -sine_deg(turn - 180.0);
  if (turn == 0.0) return 0.0;
  if (turn == 90.0) return 1.0;
  if (turn == 30.0 || turn == 150.0) return 0.5;
  return std::sin(turn * kPi / 180.0);
}
double cosine_deg(double angle_deg) {
  return sine_deg(std::fmod(angle_deg, 360.0) + 90.0);
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

constexpr std::array kFunctions = {
    Function{"SIN", 1, [](const double* x) { return sine_deg(x[0]); }, ""},
    Function{"COS", 1, [](const double* x) { return cosine_deg(x[0]); }, ""},
    Function{
        "TAN", 1,
        [](const double* x) { return cosine_deg(x[0]) == 0.0 ? kNone : sine_deg(x[0]) / cosine_deg(x[0]); },
        "an angle other than 90 degrees and its odd multiples"},
    Function{"ASIN", 1, [](const double* x) { return std::asin(x[0]) * 180.0 / kPi; }, "-1 to 1"},
    Function{"ACOS", 1, [](const double* x) { return std::acos(x[0]) * 180.0 / kPi; }, "-1 to 1"},
    Function{"ATAN2", 2,
             [](const double* x) {
               return x[0] == 0.0 && x[1] == 0.0 ? kNone : std::atan2(x[0], x[1]) * 180.0 / kPi;
             },
             "two sides that are not both zero"},
    Function{"SQRT", 1, [](const double* x) { return std::sqrt(x[0]); }, "zero or more"},
    Function{"ABS", 1, [](const double* x) { return std::fabs(x[0]); }, ""},
    Function{"POT", 1, [](const double* x) { return x[0] * x[0]; }, "a number whose square fits"},
    Function{"TRUNC", 1, [](const double* x) { return std::trunc(x[0]); }, ""},
    Function{"ROUND", 1, [](const double* x) { return std::round(x[0]); }, ""},
    Function{"LN", 1, [](const double* x) { return x[0] > 0.0 ? std::log(x[0]) : kNone; }, "above zero"},
    Function{"EXP", 1, [](const double* x) { return std::exp(x[0]); }, "at most 709"},
    Function{"MINVAL", 2, [](const double* x) { return std::min(x[0], x[1]); }, ""},
    Function{"MAXVAL", 2, [](const double* x) { return std::max(x[0], x[1]); }, ""},
    Function{"BOUND", 3, [](const double* x) { return x[0] > x[1] ? kNone : std::clamp(x[2], x[0], x[1]); },
             "a lower bound that is not above the upper one"},
};

[[noreturn]] void unknown_function(const std::string& name, const LineRef& line, size_t offset) {
  const std::string near = nearest_name(name, function_names());
  refuse(line, offset, "unknown-function", fmt::format("{} is not a function that is read", name),
         near.empty() ? "SIN COS TAN ASIN ACOS ATAN2 SQRT ABS POT TRUNC ROUND LN EXP MINVAL MAXVAL BOUND"
                      : fmt::format("did you mean {}?", near));
}

}  // namespace

Value call_function(const std::string& name, const std::vector<Value>& arguments, const LineRef& line,
                    size_t offset) {
  const auto* function =
      std::find_if(kFunctions.begin(), kFunctions.end(), [&](const Function& f) { return name == f.name; });
  if (function == kFunctions.end()) unknown_function(name, line, offset);
  if (arguments.size() != function->arguments) {
    refuse(line, offset, "wrong-arguments",
           fmt::format("{} takes {} argument(s), {} are given", name, function->arguments, arguments.size()),
           fmt::format("write {} argument(s) in its parentheses", function->arguments));
  }
  double x[3] = {};
  bool whole = true;
  for (size_t n = 0; n < arguments.size(); ++n) {
    x[n] = converted(arguments[n], Type::kReal, line, offset).number;
    whole = whole && arguments[n].type == Type::kInt;
  }
  const double result = function->apply(x);
  if (!std::isfinite(result)) {
    refuse(line, offset, "out-of-domain", fmt::format("{} of {:g} is not a number", name, x[0]),
           fmt::format("{} takes {}", name, function->domain));
  }
  const bool keeps_whole = name == "ABS" || name == "MINVAL" || name == "MAXVAL" || name == "BOUND";
  return whole && keeps_whole ? Value::integer(result) : Value::real(result);
}

const std::vector<std::string>& function_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Function& function : kFunctions) all.emplace_back(function.name);
    return all;
  }();
  return names;
}

std::string as_text(const Value& value) {
  if (value.type == Type::kString) return value.text;
  if (value.type == Type::kReal) return fmt::format("{:g}", value.number);
  return fmt::format("{:.0f}", value.number);
}

}  // namespace swarf::program::nc::siemens
