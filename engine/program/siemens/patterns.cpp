// Position patterns of Siemens 840D: where the cycle of MCALL drills.
//
//   HOLES1(SPCA,SPCO,STA1,FDIS,DBH,NUM)            a row: SPC + (FDIS + n DBH) (cos STA1, sin STA1)
//   HOLES2(CPA,CPO,RAD,STA1,INDA,NUM)              a circle: CP + RAD at STA1 + n INDA (0: 360 / NUM)
//   CYCLE801(SPCA,SPCO,STA,DIS1,DIS2,NUM1,NUM2)    a grid: SPC + n DIS1 along STA + m DIS2 across it
//
// A row begins at the end that is nearer to the tool, a grid at the nearest corner.
#include <fmt/format.h>

#include <algorithm>

#include "program/siemens/functions.h"
#include "program/siemens/steps.h"

namespace swarf::program::nc::siemens {
namespace {

constexpr int kPlacesMax = 10'000;

int count_of(const CycleCall& call, size_t index, const LineRef& line) {
  const int count = whole_argument(call, index, line, std::nullopt);
  if (count >= 1 && count <= kPlacesMax) return count;
  refuse(line, call.offsets[index], "out-of-range", fmt::format("{} places are no pattern", count),
         fmt::format("1 to {} places", kPlacesMax));
}

/// The places of a pattern in their order, mm along the first and second axis of the plane.
std::vector<Vec2> places(nc::Control& control, BlockPlace& place, Frames& frames, const CycleCall& call) {
  const auto length = [&](size_t n) {
    return control.modal.mm(argument(call, n, *place.line, std::nullopt));
  };
  const auto along = [&](double deg, double way) {
    const std::vector<Value> angle = {Value::real(deg)};
    return Vec2(way * call_function("COS", angle, *place.line, 0).number,
                way * call_function("SIN", angle, *place.line, 0).number);
  };
  const nc::PlaneAxes plane = nc::axes_of(control.modal.plane);
  const Vec3 now = nc::position_xyz(control).cwiseQuotient(frames.stretch.factor);
  const Vec2 here(now[plane.first], now[plane.second]), reference(length(0), length(1));
  const auto nearer = [&](const Vec2& a, const Vec2& b) { return (a - here).norm() < (b - here).norm(); };
  std::vector<Vec2> all;
  if (call.name == "HOLES1") {
    const double angle = argument(call, 2, *place.line, 0.0), first = length(3), step = length(4);
    const int count = count_of(call, 5, *place.line);
    only_zero(place, call, 6, call.arguments.size());
    for (int n = 0; n < count; ++n) all.push_back(reference + along(angle, first + n * step));
    if (nearer(all.back(), all.front())) std::reverse(all.begin(), all.end());
  } else if (call.name == "HOLES2") {
    const double radius = length(2), start = argument(call, 3, *place.line, 0.0);
    const int count = count_of(call, 5, *place.line);
    const double step = argument(call, 4, *place.line, 0.0);
    only_zero(place, call, 6, call.arguments.size());
    for (int n = 0; n < count; ++n)
      all.push_back(reference + along(start + (step == 0.0 ? 360.0 * n / count : n * step), radius));
  } else {
    const double angle = argument(call, 2, *place.line, 0.0);
    const Vec2 one = along(angle, length(3)), other = along(angle + 90.0, length(4));
    const int columns = count_of(call, 5, *place.line), rows = count_of(call, 6, *place.line);
    only_zero(place, call, 7, call.arguments.size());
    if (columns > kPlacesMax / rows) {
      fail(place, "out-of-range", call.offsets[6],
           fmt::format("{} times {} places are no pattern", columns, rows),
           fmt::format("1 to {} places", kPlacesMax));
    }
    const auto spot = [&](int column, int row) { return Vec2(reference + column * one + row * other); };
    const bool from_right = nearer(spot(columns - 1, 0), spot(0, 0));
    const bool from_top =
        nearer(spot(from_right ? columns - 1 : 0, rows - 1), spot(from_right ? columns - 1 : 0, 0));
    for (int m = 0; m < rows; ++m) {
      for (int n = 0; n < columns; ++n) {
        const bool back = from_right != (m % 2 == 1);
        all.push_back(spot(back ? columns - 1 - n : n, from_top ? rows - 1 - m : m));
      }
    }
  }
  return all;
}

}  // namespace

/// Rapid to each place, where the cycle of MCALL works.
void pattern(Executor& executor, const CycleCall& call) {
  if (!executor.control.path.started) {
    fail(executor.place, "start-unknown", call.offset, "a pattern starts, and the position is not known yet",
         "position all axes before it");
  }
  const nc::PlaneAxes plane = nc::axes_of(executor.control.modal.plane);
  for (const Vec2& place : places(executor.control, executor.place, executor.frames, call)) {
    nc::Target target;
    target.column = column(executor.place, call.offset);
    target.set(plane.first, place.x() * executor.frames.stretch.factor[plane.first], false);
    target.set(plane.second, place.y() * executor.frames.stretch.factor[plane.second], false);
    nc::line(executor.control, nc::Motion::kRapid, target);
    if (executor.calls.modal_cycle)
      drill(executor.control, executor.place, executor.path,
            drilling(executor.control, executor.place, executor.frames, *executor.calls.modal_cycle),
            *executor.calls.modal_cycle);
  }
  executor.path.last.valid = false;
  executor.calls.pattern_done = true;
}

}  // namespace swarf::program::nc::siemens
