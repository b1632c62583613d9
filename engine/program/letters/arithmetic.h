// Arithmetic of program expressions with every domain checked: what dialects' formulas come down to.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace swarf::program::nc {

enum class Function {
  kAbs,
  kAcos,
  kAsin,
  kAtan,
  kCos,
  kExp,
  kFix,
  kFup,
  kLn,
  kRound,
  kSin,
  kSqrt,
  kTan,
  kSign,
  kTruncate,  ///< towards zero
  kAway       ///< away from zero
};
enum class Operator {
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kPower,
  kModulo,          ///< with the sign of the divisor
  kPositiveModulo,  ///< by divisors above zero alone (MOD of LinuxCNC, whose sign for others is not
                    ///< documented)
  kIntegerDivide,
  kAnd,
  kOr,
  kXor,
  kBitAnd,
  kBitOr,
  kBitXor,
  kEqual,
  kNotEqual,
  kNearlyEqual,  ///< within 1e-6 (EQ of LinuxCNC)
  kNotNearlyEqual,
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual
};

/// Angles are degrees, as in every dialect here; multiples of 90 degrees are exact. Nothing and `why` set
/// where the value does not exist or is not finite: "division by zero", "asin of 1.2".
std::optional<double> apply(Function function, double x, std::string& why);
std::optional<double> apply(Operator op, double a, double b, std::string& why);
/// atan2 in degrees, in [0, 360) when `positive`, else (-180, 180]. Both zero: nothing.
std::optional<double> arc_tangent(double y, double x, bool positive, std::string& why);

/// A number at the start of `text`: [+-] digits [.] digits, no exponent. Returns its length, 0: none is
/// there, and npos when it does not fit a double. `whole_number`: written without a point.
size_t read_number(std::string_view text, double& value, bool* whole_number = nullptr);

}  // namespace swarf::program::nc
