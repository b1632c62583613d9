#include "program/letters/arithmetic.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>

#include "base/angles.h"
#include "base/units.h"

namespace swarf::program::nc {
namespace {

/// Values closer than this are equal for kNearlyEqual.
constexpr double kNearby = 1e-6;

std::optional<double> refuse(std::string& why, std::string text) {
  why = std::move(text);
  return std::nullopt;
}

std::optional<double> finite(double value, std::string& why) {
  if (std::isfinite(value)) return value;
  return refuse(why, "the result is too large for a number");
}

/// RS274/NGC and the others round half away from zero.
double rounded(double x) {
  return std::round(x);
}

/// Bit by bit, of whole numbers below 2^31.
std::optional<double> of_bits(Operator op, double a, double b, std::string& why) {
  constexpr double kMost = 2147483648.0;
  if (!(a >= 0.0 && a < kMost && b >= 0.0 && b < kMost && a == std::floor(a) && b == std::floor(b)))
    return refuse(why, fmt::format("{:g} and {:g} have no bits: they must be whole and not negative", a, b));
  const auto x = static_cast<uint32_t>(a), y = static_cast<uint32_t>(b);
  return op == Operator::kBitAnd ? x & y : op == Operator::kBitOr ? x | y : x ^ y;
}

bool truth(double x) {
  return x != 0.0;
}

}  // namespace

std::optional<double> apply(Function function, double x, std::string& why) {
  switch (function) {
    case Function::kAbs:
      return std::abs(x);
    case Function::kAcos:
      if (!(std::abs(x) <= 1.0)) return refuse(why, fmt::format("acos of {:g} does not exist", x));
      return deg_from_rad(std::acos(x));
    case Function::kAsin:
      if (!(std::abs(x) <= 1.0)) return refuse(why, fmt::format("asin of {:g} does not exist", x));
      return deg_from_rad(std::asin(x));
    case Function::kAtan:
      return deg_from_rad(std::atan(x));
    case Function::kCos:
      return cos_deg(x);
    case Function::kExp:
      return finite(std::exp(x), why);
    case Function::kFix:
      return std::floor(x);
    case Function::kFup:
      return std::ceil(x);
    case Function::kLn:
      if (!(x > 0.0)) return refuse(why, fmt::format("the logarithm of {:g} does not exist", x));
      return std::log(x);
    case Function::kRound:
      return rounded(x);
    case Function::kTruncate:
      return std::trunc(x);
    case Function::kAway:
      return x < 0.0 ? std::floor(x) : std::ceil(x);
    case Function::kSign:
      return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0;
    case Function::kSin:
      return sin_deg(x);
    case Function::kSqrt:
      if (!(x >= 0.0)) return refuse(why, fmt::format("the square root of {:g} does not exist", x));
      return std::sqrt(x);
    case Function::kTan:
      if (cos_deg(x) == 0.0) return refuse(why, fmt::format("tan of {:g} degrees does not exist", x));
      return sin_deg(x) / cos_deg(x);
  }
  return std::nullopt;
}

std::optional<double> apply(Operator op, double a, double b, std::string& why) {
  switch (op) {
    case Operator::kAdd:
      return finite(a + b, why);
    case Operator::kSubtract:
      return finite(a - b, why);
    case Operator::kMultiply:
      return finite(a * b, why);
    case Operator::kDivide:
      if (b == 0.0) return refuse(why, "division by zero");
      return finite(a / b, why);
    case Operator::kIntegerDivide:
      if (b == 0.0) return refuse(why, "division by zero");
      return finite(std::trunc(a / b), why);
    case Operator::kModulo:
      if (b == 0.0) return refuse(why, "remainder of a division by zero");
      return finite(a - std::floor(a / b) * b, why);
    case Operator::kPositiveModulo:
      if (b == 0.0) return refuse(why, "remainder of a division by zero");
      if (b < 0.0)
        return refuse(
            why, fmt::format("the remainder of a division by {:g}: the reference does not say its sign", b));
      return finite(a - std::floor(a / b) * b, why);
    case Operator::kPower:
      if (a < 0.0 && b != std::floor(b))
        return refuse(why, fmt::format("{:g} to the power of {:g} does not exist", a, b));
      if (a == 0.0 && b < 0.0) return refuse(why, "zero to a negative power is a division by zero");
      return finite(std::pow(a, b), why);
    case Operator::kAnd:
      return truth(a) && truth(b) ? 1.0 : 0.0;
    case Operator::kOr:
      return truth(a) || truth(b) ? 1.0 : 0.0;
    case Operator::kXor:
      return truth(a) != truth(b) ? 1.0 : 0.0;
    case Operator::kBitAnd:
    case Operator::kBitOr:
    case Operator::kBitXor:
      return of_bits(op, a, b, why);
    case Operator::kEqual:
      return a == b ? 1.0 : 0.0;
    case Operator::kNotEqual:
      return a != b ? 1.0 : 0.0;
    case Operator::kNearlyEqual:
      return std::abs(a - b) < kNearby ? 1.0 : 0.0;
    case Operator::kNotNearlyEqual:
      return std::abs(a - b) < kNearby ? 0.0 : 1.0;
    case Operator::kLess:
      return a < b ? 1.0 : 0.0;
    case Operator::kLessEqual:
      return a <= b ? 1.0 : 0.0;
    case Operator::kGreater:
      return a > b ? 1.0 : 0.0;
    case Operator::kGreaterEqual:
      return a >= b ? 1.0 : 0.0;
  }
  return std::nullopt;
}

std::optional<double> arc_tangent(double y, double x, bool positive, std::string& why) {
  if (y == 0.0 && x == 0.0) return refuse(why, "the direction of a vector of length zero does not exist");
  const double angle = deg_from_rad(std::atan2(y, x));
  return positive && angle < 0.0 ? angle + 360.0 : angle;
}

size_t read_number(std::string_view text, double& value, bool* whole_number) {
  // Whole numbers and powers of ten up to these are exact, and so their quotient is the nearest number.
  constexpr int kExactDigits = 15;
  static constexpr double kTens[kExactDigits + 1] = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                     1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
  size_t at = 0;
  const bool sign = !text.empty() && (text[0] == '+' || text[0] == '-');
  if (sign) at = 1;
  int digits = 0, behind_point = 0;
  bool point = false;
  int64_t whole = 0;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (c >= '0' && c <= '9') {
      if (++digits <= kExactDigits) whole = 10 * whole + (c - '0');
      if (point) ++behind_point;
    } else if (c == '.' && !point) {
      point = true;
    } else {
      break;
    }
  }
  if (digits == 0) return 0;
  if (whole_number != nullptr) *whole_number = !point;
  if (digits <= kExactDigits) {
    const double size = static_cast<double>(whole) / kTens[behind_point];
    value = text[0] == '-' ? -size : size;
    return at;
  }
  const size_t from = text[0] == '+' ? 1 : 0;
  const auto [end, problem] =
      std::from_chars(text.data() + from, text.data() + at, value, std::chars_format::fixed);
  if (problem != std::errc{} || end != text.data() + at || !std::isfinite(value))
    return std::string_view::npos;
  return at;
}

}  // namespace swarf::program::nc
