#include "cli/nc_totals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "cli/terminal.h"
#include "program/move_way.h"

namespace swarf::cli {

void ProgramHours::add(double seconds, const program::Move& move, int file) {
  seconds_ += seconds;
  if (!(seconds > longest_s_)) return;
  longest_s_ = seconds;
  file_ = file;
  line_ = move.line;
  column_ = move.column;
}

void ProgramHours::refuse_too_long(const std::vector<std::string>& files) const {
  constexpr double kMost = program::kHoursMax;
  const double hours = seconds_ / 3600.0;
  if (!(hours > kMost)) return;
  throw InputError(
      "too-many-cycles", {files.at(static_cast<size_t>(file_)), line_, column_},
      fmt::format("the program takes {:.3g} h at its programmed feeds, more than {:g} h; this is "
                  "its slowest block",
                  hours, kMost),
      "mend the feed or the dwell of this block");
}

void NcTotals::add_rapid(const program::NcMove& move) {
  double longest = 0.0;
  for (size_t i = 0; i < machine_.axes.size(); ++i) {
    const kinematics::Axis& axis = machine_.axes[i];
    const auto index = static_cast<long>(i);
    const double speed = axis.rapid_max > 0.0 ? axis.rapid_max : axis.speed_max;
    const double way = std::abs(move.q_to[index] - move.q_from[index]);
    if (way == 0.0) continue;
    if (speed > 0.0)
      longest = std::max(longest, way / speed);
    else
      rapids_timed = false;
  }
  rapid_s += longest;
}

void NcTotals::check_travel(const program::NcMove& move) {
  for (size_t i = 0; i < machine_.axes.size() && out_of_travel.empty(); ++i) {
    const kinematics::Axis& axis = machine_.axes[i];
    const double q = move.q_to[static_cast<long>(i)];
    if (q >= axis.min - 1e-9 && q <= axis.max + 1e-9) continue;
    const bool linear = axis.kind == kinematics::AxisKind::kLinear;
    const auto shown = [&](double x) { return linear ? x : deg_from_rad(x); };
    out_of_travel_line = move.line;
    out_of_travel =
        fmt::format("{} goes to {:.3f} {} in line {} first; its travel is {:.3f} to {:.3f}", axis.name,
                    shown(q), linear ? "mm" : "deg", move.line, shown(axis.min), shown(axis.max));
  }
}

bool NcTotals::move(const program::NcMove& move) {
  if (feeds + rapids == 0) low = high = move.q_from;
  (move.rapid ? rapids : feeds) += 1;
  feed_s += move.duration_s;
  dwell_s += move.dwell_s;
  hours.add(move.duration_s + move.dwell_s, move, move.file);
  low = low.cwiseMin(move.q_to);
  high = high.cwiseMax(move.q_to);
  arcs += move.arc ? 1 : 0;
  (move.rapid ? rapid_mm : feed_mm) += program::way_mm(move);
  if (move.rapid)
    add_rapid(move);
  else
    cut_W.extend(program::extent_W(move));
  check_travel(move);
  return !interrupted();
}

}  // namespace swarf::cli
