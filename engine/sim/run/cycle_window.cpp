#include "sim/run/cycle_window.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <span>

#include "base/diagnostics.h"

namespace swarf::sim {
namespace {

/// Share of a period by which a time may miss a cycle that it means.
constexpr double kSameCycle = 1e-6;

[[noreturn]] void refuse_window(const std::string& place, const std::string& text, const std::string& fix) {
  throw InputError("place-unknown", {place}, text, fix);
}

/// The first cycle at this time or later.
size_t cycle_from(double t_s, const char* option, const motion::Cycles& cycles) {
  if (!(t_s >= 0.0) || t_s > cycles.time_s() + cycles.period_s())
    refuse_window(fmt::format("{} {:g}", option, t_s), "the program is not under way at this time",
                  fmt::format("write a time from 0 to {:.3f} s", cycles.time_s()));
  const double number = std::ceil(t_s / cycles.period_s() - kSameCycle);
  return std::min(static_cast<size_t>(std::max(number, 0.0)), cycles.size() - 1);
}

/// First and last element of a line.
struct LineElements {
  size_t first = 0, last = 0;
};

LineElements elements_of_line(int line, const char* option, const toolpath::Elements& elements) {
  std::optional<LineElements> found;
  int nearest = 0;
  for (size_t i = 0; i < elements.size(); ++i) {
    const int here = elements.line(i);
    if (std::abs(here - line) < std::abs(nearest - line)) nearest = here;
    if (here != line) continue;
    if (!found) found = LineElements{i, i};
    found->last = i;
  }
  if (found) return *found;
  refuse_window(fmt::format("{} {}", option, line), fmt::format("line {} of the program moves nothing", line),
                fmt::format("the nearest line with motion is {}", nearest));
}

/// The first cycle of an element, or of one behind it.
size_t first_cycle(size_t element, const motion::Cycles& cycles) {
  if (element >= cycles.elements().size()) return cycles.size();
  motion::CycleReader reader(cycles);
  return reader.reaching(static_cast<int>(element), -std::numeric_limits<double>::infinity());
}

}  // namespace

void require_line(int line, const toolpath::Elements& elements) {
  elements_of_line(line, "line", elements);
}

CycleWindow window_of(const WindowPlaces& places, const motion::Cycles& cycles) {
  CycleWindow window{0, cycles.size()};
  if (places.from_s) window.first = cycle_from(*places.from_s, "--from", cycles);
  if (places.to_s) {
    const double last = std::floor(*places.to_s / cycles.period_s() + kSameCycle);
    cycle_from(*places.to_s, "--to", cycles);
    window.end = std::min(static_cast<size_t>(last) + 1, cycles.size());
  }
  if (places.from_line)
    window.first =
        first_cycle(elements_of_line(*places.from_line, "--from-line", cycles.elements()).first, cycles);
  if (places.to_line)
    window.end =
        first_cycle(elements_of_line(*places.to_line, "--to-line", cycles.elements()).last + 1, cycles);
  if (places.from_s && places.to_s && *places.to_s < *places.from_s)
    refuse_window(fmt::format("--to {:g}", *places.to_s), "this is before --from",
                  fmt::format("write at least {:g}", *places.from_s));
  if (window.end < window.first)
    refuse_window("the window", "it ends before it begins", "exchange the two places");
  window.end = std::max(window.end, window.first + 1);
  return window;
}

}  // namespace swarf::sim
