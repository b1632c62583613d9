// Functions of Siemens 840D formulas.
#pragma once

#include <string>
#include <vector>

#include "program/siemens/variables.h"

namespace swarf::program::nc::siemens {

/// SIN COS TAN ASIN ACOS ATAN2 (degrees) SQRT ABS POT (square) TRUNC ROUND LN EXP MINVAL MAXVAL BOUND.
/// Throws InputError "unknown-function" with the nearest name, "wrong-arguments", "wrong-type",
/// "out-of-domain".
Value call_function(const std::string& name, const std::vector<Value>& arguments, const LineRef& line,
                    size_t offset);
const std::vector<std::string>& function_names();
/// A value as << joins it to a text.
std::string as_text(const Value& value);

}  // namespace swarf::program::nc::siemens
