// Parameters that hold a value before the program starts (ControlSetup::presets), as a dialect takes them.
#pragma once

#include <optional>
#include <string_view>

#include "program/nc_program.h"

namespace swarf::program::nc {

/// The number behind `prefix` ("R" of R12; "" of 500), where nothing else stands behind it.
std::optional<long> preset_number(std::string_view name, std::string_view prefix);

/// Throws InputError "bad-preset": the dialect has no such parameter that a program may set. `known`: which
/// it has.
[[noreturn]] void refuse_preset(std::string_view name, const Preset& preset, const char* known);

}  // namespace swarf::program::nc
