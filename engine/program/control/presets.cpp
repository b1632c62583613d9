#include "program/control/presets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

#include "program/control/report.h"

namespace swarf::program {

std::string preset_name(std::string_view written) {
  std::string name;
  for (const char c : written) {
    if (std::string_view("#<> ").find(c) == std::string_view::npos)
      name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return name;
}

namespace nc {

std::optional<long> preset_number(std::string_view name, std::string_view prefix) {
  if (!name.starts_with(prefix)) return std::nullopt;
  const char* const end = name.data() + name.size();
  long number = 0;
  const auto [next, failure] = std::from_chars(name.data() + prefix.size(), end, number);
  return failure == std::errc() && next == end && number >= 0 ? std::optional(number) : std::nullopt;
}

void refuse_preset(std::string_view name, const Preset& preset, const char* known) {
  Report::fail_at(preset.where, "bad-preset",
                  fmt::format("'{}' is no parameter that a program of this dialect may set", name), known);
}

}  // namespace nc
}  // namespace swarf::program
