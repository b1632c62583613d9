// PLANE and cycle 19: the tilted working plane.
#include <fmt/format.h>

#include <cmath>

#include "base/angles.h"
#include "base/units.h"
#include "program/heidenhain/steps.h"

namespace swarf::program::nc::heidenhain {
namespace {

/// The words of a PLANE by name, each once.
class Named {
 public:
  Named(BlockReader& reader, const std::vector<std::string>& names, size_t start)
      : start_(start), reader_(reader) {
    for (;;) {
      reader.done();
      const size_t at = reader.offset();
      std::string name(reader.letters());
      // P1X: a digit stands inside of the name.
      if (name == "P" && reader.peek_after(1) >= '1' && reader.peek_after(1) <= '3')
        name = std::string{reader.peek(), reader.peek_after(1), reader.peek_after(2)};
      bool known = false;
      for (const std::string& one : names) known = known || one == name;
      if (!known) return;
      reader.move_to(at + name.size());
      if (!values_.emplace(name, reader.value()).second)
        reader.fail("word-twice", at, fmt::format("{} stands twice in this block", name), "keep one of them");
    }
  }
  bool has(const std::string& name) const { return values_.count(name) > 0; }
  size_t count() const { return values_.size(); }
  double operator[](const std::string& name) const {
    const auto found = values_.find(name);
    if (found == values_.end())
      reader_.fail("missing-word", start_, fmt::format("{} is missing in this block", name),
                   fmt::format("{}+0", name));
    return found->second;
  }

 private:
  size_t start_;
  BlockReader& reader_;
  std::map<std::string, double> values_;
};

Mat3 axes_from(BlockReader& reader, const Vec3& along_x, const Vec3& normal, size_t start) {
  const Vec3 z = normal.normalized();
  const Vec3 x = along_x - along_x.dot(z) * z;
  if (!z.allFinite() || !(normal.norm() > 1e-9) || !(x.norm() > 1e-6 * along_x.norm()))
    reader.fail("bad-vector", start, "these vectors or points span no plane",
                "give directions across each other");
  Mat3 R;
  R.col(0) = x.normalized();
  R.col(1) = z.cross(R.col(0));
  R.col(2) = z;
  return R;
}

Mat3 plane_rotation(Orientation& orientation, BlockReader& reader, const std::string& kind, size_t start) {
  if (kind == "SPATIAL") {
    const Named words(reader, {"SPA", "SPB", "SPC"}, start);
    return spatial_rotation(words["SPA"], words["SPB"], words["SPC"]);
  }
  if (kind == "EULER") {
    const Named words(reader, {"EULPR", "EULNU", "EULROT"}, start);
    return rotation_deg(2, words["EULPR"]) * rotation_deg(0, words["EULNU"]) *
           rotation_deg(2, words["EULROT"]);
  }
  if (kind == "VECTOR") {
    const Named words(reader, {"BX", "BY", "BZ", "NX", "NY", "NZ"}, start);
    const Vec3 base(words["BX"], words["BY"], words["BZ"]), normal(words["NX"], words["NY"], words["NZ"]);
    if (std::abs(base.dot(normal)) > 1e-3 * base.norm() * normal.norm())
      reader.fail("bad-vector", start, "the vectors B and N are not perpendicular", "correct one of them");
    return axes_from(reader, base, normal, start);
  }
  if (kind == "POINTS") {
    const Named words(reader, {"P1X", "P1Y", "P1Z", "P2X", "P2Y", "P2Z", "P3X", "P3Y", "P3Z"}, start);
    const Vec3 p1(words["P1X"], words["P1Y"], words["P1Z"]), p2(words["P2X"], words["P2Y"], words["P2Z"]),
        p3(words["P3X"], words["P3Y"], words["P3Z"]);
    return axes_from(reader, p2 - p1, (p2 - p1).cross(p3 - p1), start);
  }
  if (kind == "RELATIV" || kind == "RELATIVE") {
    const Named words(reader, {"SPA", "SPB", "SPC"}, start);
    if (words.count() != 1)
      reader.fail("missing-word", start, "PLANE RELATIV has one angle", "PLANE RELATIV SPB+30");
    const char axis = words.has("SPA") ? 'A' : words.has("SPB") ? 'B' : 'C';
    return orientation.tilt * rotation_deg(axis - 'A', words[fmt::format("SP{}", axis)]);
  }
  if (kind == "PROJECTED")
    reader.fail("unsupported-word", start, "PLANE PROJECTED is known, but not supported here",
                "PLANE SPATIAL, EULER, VECTOR or POINTS give the same plane");
  reader.fail("unknown-word", start, fmt::format("there is no PLANE {}", kind),
              "SPATIAL, EULER, VECTOR, POINTS, RELATIV, AXIAL or RESET");
}

/// PLANE AXIAL B-45, PLANE AXIAL IC+90: the values of the rotary axes themselves, which are modal. The plane
/// is the one in which the tool's own frame then stands. SEQ has no meaning here.
void axial_plane(Executor& executor, BlockReader& reader, size_t start) {
  std::array<double, 3> deg = executor.orientation.axial_deg;
  uint8_t given = 0;
  for (;;) {
    reader.done();
    const size_t at = reader.offset();
    const std::string word(reader.letters());
    const bool added = word.size() == 2 && word[0] == 'I';
    const std::string_view letter = std::string_view(word).substr(added ? 1 : 0);
    const size_t slot = letter.size() == 1 ? std::string_view("ABC").find(letter[0]) : std::string_view::npos;
    if (slot == std::string_view::npos) break;
    reader.take_letters();
    nc::require_axis(executor.control, static_cast<nc::AxisWord>(slot + 3), reader.column(at));
    if ((given >> slot & 1u) != 0)
      reader.fail("word-twice", at, fmt::format("{} stands twice in this block", word), "keep one of them");
    given = static_cast<uint8_t>(given | (1u << slot));
    deg[slot] = reader.value() + (added ? deg[slot] : 0.0);
  }
  if (given == 0) reader.fail("missing-word", start, "PLANE AXIAL has no axis", "PLANE AXIAL B-45 TURN FMAX");
  if (executor.frames.outer.turn_deg != 0.0)
    reader.fail("unsupported-word", start, "PLANE AXIAL while a rotation is active is not supported",
                "end the rotation before it: CYCL DEF 10.1 ROT+0");
  const Positioning how = positioning(executor.control, executor.modes, reader, start);
  kinematics::AxisValues q = executor.control.path.q;
  for (int slot = 0; slot < 3; ++slot) {
    const int axis = executor.control.space.axis_of(static_cast<nc::AxisWord>(slot + 3));
    if (axis < 0) continue;
    q[axis] = rad_from_deg(deg[static_cast<size_t>(slot)]) + executor.control.space.rotary_zero(slot);
    const kinematics::Axis& limits = executor.control.setup.machine.axes[static_cast<size_t>(axis)];
    if (q[axis] < limits.min - 1e-9 || q[axis] > limits.max + 1e-9)
      reader.fail(
          "unreachable-orientation", start,
          fmt::format("{} {:g} degrees lies outside the travel of the axis, {:g} to {:g} degrees",
                      limits.name, deg_from_rad(q[axis]), deg_from_rad(limits.min), deg_from_rad(limits.max)),
          "change the angle");
  }
  executor.orientation.axial_deg = deg;
  kinematics::AxisValues zero = q;
  for (int slot = 0; slot < 3; ++slot) {
    const int axis = executor.control.space.axis_of(static_cast<nc::AxisWord>(slot + 3));
    if (axis >= 0) zero[axis] = executor.control.space.rotary_zero(slot);
  }
  const kinematics::MachineModel& machine = executor.control.setup.machine;
  tilt(executor, reader, tool_frame_W(machine, q) * tool_frame_W(machine, zero).transpose(), true, start);
  position_plane(executor, reader, how, &q, start);
}

}  // namespace

void plane(Executor& executor, BlockReader& reader, size_t start) {
  const std::string kind(reader.take_letters());
  if (executor.orientation.tcpm)
    reader.fail("unsupported-word", start, "PLANE while M128 or FUNCTION TCPM is on is not supported",
                "write M129 before it");
  if (executor.orientation.compensates_heads)
    reader.fail("unsupported-word", start, "PLANE while M114 or M144 is on is not supported",
                "write M115 or M145 before it");
  if (executor.control.modal.plane != nc::Plane::kXY)
    reader.fail("unsupported-word", start, "PLANE is supported with the tool axis Z alone", "TOOL CALL 5 Z");
  if (kind == "AXIAL") return axial_plane(executor, reader, start);
  const bool reset = kind == "RESET";
  const Mat3 R = reset ? Mat3(Mat3::Identity()) : plane_rotation(executor.orientation, reader, kind, start);
  // Everything behind the angles is checked before the plane changes.
  const Positioning how = positioning(executor.control, executor.modes, reader, start);
  executor.orientation.axial_deg = {};
  tilt(executor, reader, R, !reset, start);
  position_plane(executor, reader, how, nullptr, start);
}

void tilt(Executor& executor, BlockReader& reader, const Mat3& rotation, bool on, size_t start) {
  if (!executor.frames.inner.none())
    reader.fail("words-conflict", start, "a transformation within the tilted plane is still active",
                "reset it (CYCL DEF 7, 8, 10, 11, 26) before the plane changes");
  if (on && executor.frames.outer.stretches())
    reader.fail("unsupported-word", start,
                "tilting while a mirror image or a scaling is active is not supported",
                "tilt first, then mirror or scale within the plane");
  if (executor.orientation.tcpm)
    reader.fail("unsupported-word", start, "tilting while M128 or FUNCTION TCPM is on is not supported",
                "write M129 before it");
  if (executor.orientation.compensates_heads)
    reader.fail("unsupported-word", start, "tilting while M114 or M144 is on is not supported",
                "write M115 or M145 before it");
  executor.orientation.tilt = rotation;
  executor.orientation.tilted = on;
  update_frame(executor);
  nc::set_coordinates(executor.control, on ? nc::Coordinates::kWork : nc::Coordinates::kAxes);
  if (executor.control.path.started && on && executor.control.setup.machine.axes.size() > 3)
    rotary_parameters(
        executor.control, executor.parameters,
        nc::tilt_solution(executor.control, Vec3::UnitZ(), {}, executor.control.report.place.column));
}

}  // namespace swarf::program::nc::heidenhain
