#include "program/control/control.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "program/control/corner.h"
#include "program/control/emit.h"
#include "program/control/path.h"
#include "program/control/tools.h"

namespace swarf::program::nc {
Plane ContourOfControl::plane() const {
  return control_.modal.plane;
}

const DialectWords& ContourOfControl::words() const {
  return control_.report.words;
}

void ContourOfControl::at(int file, int line, int column) {
  control_.report.at(file, line, column);
}

void ContourOfControl::fail(const char* code, int column, std::string text, std::string fix) const {
  control_.report.fail(code, column, std::move(text), std::move(fix));
}

void ContourOfControl::emit(const Segment& segment) {
  nc::emit(control_, segment);
}

Control::Control(const ControlSetup& given, NcSink& sink, Diagnostics& diagnostics, NcSummary& summary)
    : setup(given), report(given.builder_words, sink, diagnostics, summary), space(given.machine) {
  const Mat3& columns = space.compensated({0.0, 0.0, 0.0}).columns_W;
  offsets.axes_rigid = (columns.transpose() * columns - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-9;
  for (int number = 1; number <= 9; ++number) offsets.origins[number] = space.gauge_zero();
  for (const auto& [number, difference] : setup.work_offsets)
    offsets.origins[number] = space.gauge_zero() + difference;
  offsets.origins[0] = space.gauge_zero();
  space.set_origin(offsets.origins[1]);
  if (setup.unit_mm) set_inches(modal, *setup.unit_mm != 1.0);
  if (setup.start_tool >= 0) {
    tools.active = tools.selected = setup.start_tool;
    tools.active_number = tools.selected_number = active_tool(*this)->number;
    set_true_tool(*this);
  }
  if (setup.start) {
    path.q = *setup.start;
    start_here(*this, "given by the scene");
  }
}

void set_plane(Control& control, Plane plane) {
  if (plane == control.modal.plane) return;
  if (control.contour.side() != Compensation::kOff) {
    control.report.fail("compensation-plane", 0, "the plane changes while cutter radius compensation is on",
                        fmt::format("switch it off first: {}", control.report.words.compensation_off));
  }
  release_corner(control);
  control.modal.plane = plane;
}

void set_compensation(Control& control, Compensation side, double radius_mm, int column) {
  if (side != Compensation::kOff && !(radius_mm >= 0.0 && std::isfinite(radius_mm))) {
    control.report.fail("compensation-no-tool", column,
                        fmt::format("{:g} mm is not a cutter radius", radius_mm),
                        "give the tool's diameter in the tool table");
  }
  if (side != control.contour.side()) release_corner(control);
  control.contour.set_side(side, radius_mm, column);
}

void enter_compensation(Control& control, Compensation side, double radius_mm, const Vec3& contour_point) {
  const Vec3 tool = position_xyz(control);
  control.contour.enter(side, radius_mm, tool);
  for (int i = 0; i < 3; ++i) control.path.position[static_cast<size_t>(i)] = contour_point[i];
}

void flush(Control& control) {
  release_corner(control);
  // Without the lead-out, the tool stands beside the programmed point.
  if (control.contour.leading_out()) control.path.position_valid = false;
  control.contour.flush();
}

void finish(Control& control) {
  flush(control);
  if (!control.path.started && control.path.first_motion.line > 0) {
    control.report.place = control.path.first_motion;
    control.report.fail("no-start", 0,
                        fmt::format("the program never gives {} a position, and the scene gives no start",
                                    missing_axes(control.space, control.path)),
                        "give the start position: start in [setup] of the scene, swarf check --home");
  }
  if (control.modal.pending_dwell_s > 0.0 && control.path.started) {
    Segment stand;
    prepare(control.report, control.modal, Motion::kRapid, Target(), stand);
    stand.machine = true;
    stand.from = stand.to = control.space.linear_of(control.path.q);
    stand.rotary_from = stand.rotary_to = control.space.rotary_of(control.path.q);
    emit(control, stand);
  }
  for (int slot = 0; slot < 3; ++slot) {
    if (control.path.unwound[slot] > 0) {
      control.report.diagnostics.note(
          "rotary-unwinds", {control.report.summary.files.empty() ? "" : control.report.summary.files[0]},
          fmt::format("{} turned by more than half a turn in {} block(s), as written", kAxisLetters[slot + 3],
                      control.path.unwound[slot]));
    }
  }
}

void jump(Control& control) {
  constexpr long kJumpsWithoutMove = 1'000'000;
  if (++control.path.jumps <= kJumpsWithoutMove) return;
  control.report.fail(
      "endless-loop", 0,
      fmt::format("{} jumps and calls without any move: the program never ends here", control.path.jumps),
      "correct the condition of the loop");
}

void refresh_position(WorkSpace& space, PathState& path) {
  if (path.position_valid) return;
  const std::array<double, 3> rotary = space.rotary_of(path.q);
  const Vec3 p = space.program_from_linear(space.linear_of(path.q), rotary);
  for (size_t i = 0; i < 3; ++i) {
    path.position[i] = p[static_cast<long>(i)];
    path.position[i + 3] = rotary[i] - space.rotary_zero(static_cast<int>(i));
    if (path.started) continue;
    if ((path.known >> i & 1u) == 0) path.position[i] = std::nan("");
    if ((path.known >> (i + 3) & 1u) == 0) path.position[i + 3] = std::nan("");
  }
  path.position_valid = path.started;
}

const std::array<double, kAxisWords>& position(Control& control) {
  refresh_position(control.space, control.path);
  return control.path.position;
}

Vec3 position_xyz(Control& control) {
  refresh_position(control.space, control.path);
  return {control.path.position[0], control.path.position[1], control.path.position[2]};
}

Vec3 tool_axis_P(Control& control) {
  return control.space.X_WP().linear().transpose() *
         control.space.compensated(control.space.rotary_of(control.path.q)).axis_W;
}

Vec3 tool_axis_at_zero_P(const WorkSpace& space) {
  return space.X_WP().linear().transpose() * space.axis_at_zero_W();
}

int require_axis(const Control& control, AxisWord word, int column) {
  const int axis = control.space.axis_of(word);
  if (axis >= 0) return axis;
  std::string names;
  for (const kinematics::Axis& one : control.setup.machine.axes)
    names += (names.empty() ? "" : " ") + one.name;
  control.report.fail(
      "axis-missing", column,
      fmt::format("the machine {} has no axis {}, it has {}", control.setup.machine.name, kAxisLetters[word],
                  names),
      "take the word out, or name the machine that the program was posted for: --machine, in a scene "
      "`machine`");
}

}  // namespace swarf::program::nc
