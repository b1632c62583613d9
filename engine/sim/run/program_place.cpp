#include "sim/run/program_place.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <string_view>

#include "base/diagnostics.h"
#include "sim/job/tool_table.h"

namespace swarf::sim {
namespace {

template <typename Number>
bool parse_whole(std::string_view text, Number& value) {
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  return failure == std::errc() && end == text.data() + text.size();
}

/// "T5" or "T=DRILL_8".
bool parse_tool(const std::string& text, ProgramPlace& place) {
  if (text.size() < 2 || text[0] != 'T') return false;
  if (text[1] != '=')
    return parse_whole(std::string_view(text).substr(1), place.tool_number) && place.tool_number > 0;
  place.tool_name = text.substr(2);
  return !place.tool_name.empty();
}

ProgramPlace parse_place(const std::string& text) {
  ProgramPlace place{text, 0, 0.0, 0, ""};
  if (parse_tool(text, place)) return place;
  const bool is_time = !text.empty() && text.back() == 's';
  const bool read = is_time ? parse_whole(std::string_view(text).substr(0, text.size() - 1), place.t_s)
                            : parse_whole(std::string_view(text), place.line);
  if (read && (is_time ? place.t_s >= 0.0 : place.line > 0)) return place;
  throw InputError(
      "bad-place", {text}, "this is no place in a program",
      "write a line of the program (13), a program time in seconds (12.5s) or a tool (T5, T=NAME)");
}

size_t sweeps_until_tool(const ProgramPlace& place, const CutSweeps& sweeps,
                         const std::vector<cutter::Cutter>& tools) {
  const int tool = tool_index(tools, place.tool_number, place.tool_name);
  size_t count = 0;
  for (size_t n = 0; n < sweeps.size() && tool >= 0; ++n) {
    if (sweeps.tool(n) == tool) count = n + 1;
  }
  if (count > 0) return count;
  throw InputError("place-unknown", {place.text},
                   tool < 0 ? "the scene has no such tool" : "the program never moves this tool",
                   "the scene's tools: " + list_tools(tools));
}

}  // namespace

std::vector<ProgramPlace> parse_places(const std::string& list) {
  std::vector<ProgramPlace> places;
  for (size_t begin = 0; begin <= list.size();) {
    const size_t comma = std::min(list.find(',', begin), list.size());
    places.push_back(parse_place(list.substr(begin, comma - begin)));
    begin = comma + 1;
  }
  return places;
}

CutPlace place_of(const CutSweeps& sweeps, size_t n, const toolpath::Elements& elements,
                  motion::CycleReader& reader) {
  const SweepSource source = sweeps.source(n);
  return {sweeps.block(n), elements.line(static_cast<size_t>(source.element)),
          reader.at(cycle_of(source, reader)).sample.t_s};
}

size_t sweeps_until(const ProgramPlace& place, const CutSweeps& sweeps, const motion::Cycles& cycles,
                    const std::vector<cutter::Cutter>& tools) {
  if (place.tool_number > 0 || !place.tool_name.empty()) return sweeps_until_tool(place, sweeps, tools);
  motion::CycleReader reader(cycles);
  size_t count = 0;
  int nearest = 0;
  for (size_t n = 0; n < sweeps.size(); ++n) {
    const CutPlace at = place_of(sweeps, n, cycles.elements(), reader);
    if (place.line > 0 ? at.line == place.line : at.t_s <= place.t_s) count = n + 1;
    if (std::abs(at.line - place.line) < std::abs(nearest - place.line)) nearest = at.line;
  }
  const double last_s = cycles.time_s();
  if (place.line > 0 && count == 0) {
    throw InputError("place-unknown", {place.text},
                     fmt::format("line {} of the program moves nothing", place.line),
                     fmt::format("the nearest line with motion is {}", nearest));
  }
  if (place.line == 0 && (count == 0 || place.t_s > last_s)) {
    throw InputError("place-unknown", {place.text},
                     "no motion is complete at this program time, or it is over",
                     fmt::format("write a time up to {:.3f}s", last_s));
  }
  return count;
}

}  // namespace swarf::sim
