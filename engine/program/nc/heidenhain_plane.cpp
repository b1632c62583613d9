// PLANE, M128, FUNCTION TCPM, and the frame that they and the datum shifts make.
#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "program/nc/arithmetic.h"
#include "program/nc/heidenhain_executor.h"

namespace swarf::program::heidenhain {

using nc::Motion;

namespace {

/// Rotation about X, Y or Z; exact at multiples of 90 degrees.
Mat3 turned(int axis, double angle_deg) {
  std::string why;
  const double s = *nc::apply(nc::Function::kSin, angle_deg, why);
  const double c = *nc::apply(nc::Function::kCos, angle_deg, why);
  const int b = (axis + 1) % 3, d = (axis + 2) % 3;
  Mat3 R = Mat3::Identity();
  R(b, b) = R(d, d) = c;
  R(d, b) = s;
  R(b, d) = -s;
  return R;
}

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

Pose shifted(const Vec3& shift, double turn_deg) {
  Pose X = Pose::Identity();
  X.linear() = turned(2, turn_deg);
  X.translation() = shift;
  return X;
}

}  // namespace

Mat3 spatial_rotation(double a_deg, double b_deg, double c_deg) {
  return turned(2, c_deg) * turned(1, b_deg) * turned(0, a_deg);
}

void Executor::update_frame() {
  Pose tilted = Pose::Identity();
  tilted.linear() = tilt_;
  control_.set_frame(shifted(outer_.shift, outer_.turn_deg) * tilted *
                     shifted(inner_.shift, inner_.turn_deg));
  tangent_.reset();
  centre_.reset();
}

Mat3 Executor::plane_rotation(BlockReader& reader, const std::string& kind, size_t start) {
  if (kind == "SPATIAL") {
    const Named words(reader, {"SPA", "SPB", "SPC"}, start);
    return spatial_rotation(words["SPA"], words["SPB"], words["SPC"]);
  }
  if (kind == "EULER") {
    const Named words(reader, {"EULPR", "EULNU", "EULROT"}, start);
    return turned(2, words["EULPR"]) * turned(0, words["EULNU"]) * turned(2, words["EULROT"]);
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
    return tilt_ * turned(axis - 'A', words[fmt::format("SP{}", axis)]);
  }
  if (kind == "PROJECTED" || kind == "AXIAL")
    reader.fail("unsupported-word", start, fmt::format("PLANE {} is known, but not supported here", kind),
                "PLANE SPATIAL is");
  reader.fail("unknown-word", start, fmt::format("there is no PLANE {}", kind),
              "SPATIAL, EULER, VECTOR, POINTS, RELATIV or RESET");
}

void Executor::plane(BlockReader& reader, size_t start) {
  const std::string kind(reader.take_letters());
  if (tcpm_)
    reader.fail("unsupported-word", start, "PLANE while M128 or FUNCTION TCPM is on is not supported",
                "write M129 before it");
  if (control_.plane() != nc::Plane::kXY)
    reader.fail("unsupported-word", start, "PLANE is supported with the tool axis Z alone", "TOOL CALL 5 Z");
  const bool reset = kind == "RESET";
  const Mat3 R = reset ? Mat3(Mat3::Identity()) : plane_rotation(reader, kind, start);
  // Everything behind the angles is checked before the plane changes.
  reader.done();
  const size_t rest = reader.offset();
  position_plane(reader, true, start);
  reader.move_to(rest);
  tilt(reader, R, !reset, start);
  position_plane(reader, false, start);
}

/// MOVE, TURN or STAY with DIST, F, SEQ; `check`: reads the words and does nothing.
void Executor::position_plane(BlockReader& reader, bool check, size_t start) {
  std::string how;
  nc::TiltPreference preference;
  Motion motion = Motion::kFeed;
  double feed = feed_;
  while (!reader.done()) {
    const size_t at = reader.offset();
    const std::string word(reader.take_letters());
    if (word == "MOVE" || word == "TURN" || word == "STAY") {
      if (!how.empty())
        reader.fail("words-conflict", at, fmt::format("{} and {} in one block", how, word),
                    "keep one of them");
      how = word;
    } else if (word == "SEQ") {
      if (!reader.take_char('+') && reader.peek() != '-')
        reader.fail("missing-word", at, "SEQ has no sign", "SEQ+ or SEQ-");
      preference.choice = reader.take_char('-') ? nc::TiltPreference::Choice::kNegative
                                                : nc::TiltPreference::Choice::kPositive;
    } else if (word == "DIST") {
      if (reader.value() != 0.0)
        reader.fail("unsupported-word", at, "DIST other than 0 is not supported",
                    "DIST0, or move away before it");
    } else if (word == "FMAX") {
      motion = Motion::kRapid;
    } else if (word == "F" || word == "FAUTO") {
      if (word == "FAUTO" || reader.take("AUTO")) {
        feed = tool_feed_;
      } else if (reader.take("MAX")) {
        motion = Motion::kRapid;
      } else {
        feed = reader.value();
      }
      if (motion == Motion::kFeed && !(feed > 0.0))
        reader.fail("bad-feed", at, fmt::format("F {:g} is not a feed", feed), "F1000");
    } else if (word == "COORD" && reader.take("ROT")) {
      // the frame is turned as its angles say
    } else if (word == "ABST") {
      if (reader.value() != 0.0)
        reader.fail("unsupported-word", at, "ABST other than 0 is not supported", "ABST0");
    } else if (word == "TABLE" || word == "MB" || word == "SYM" || word == "COORD") {
      reader.fail("unsupported-word", at, fmt::format("{} is known, but not supported here", word),
                  "take it out");
    } else {
      refuse_word(reader, at, word.empty() ? std::string(1, reader.peek()) : word);
    }
  }
  if (how.empty())
    reader.fail("missing-word", start, "PLANE says neither MOVE nor TURN nor STAY", "PLANE RESET STAY");
  const bool turns = how != "STAY";
  if (turns && motion == Motion::kFeed && !(feed > 0.0))
    reader.fail("missing-feed", start, "the rotary axes turn without F", "TURN FMAX");
  if (check) return;
  const bool free = control_.machine().axes.size() > 3;
  if (!free) {
    if (!tilt_.isIdentity(1e-12))
      reader.fail("unreachable-orientation", start, "the machine has no rotary axes for a tilted plane",
                  "choose a five-axis machine");
    return;
  }
  if (!control_.started()) {
    if (turns)
      reader.fail("start-unknown", start, "the rotary axes turn, and the position is not known yet",
                  "position all axes before it");
    return;
  }
  kinematics::AxisValues q = control_.tilt_solution(Vec3::UnitZ(), preference, control_.place().column);
  if (!tilted_) {  // PLANE RESET: all rotary axes go to zero
    for (int slot = 0; slot < 3; ++slot) {
      const int axis = control_.axis_of(static_cast<nc::AxisWord>(slot + 3));
      if (axis >= 0) q[axis] = control_.space().rotary_zero(slot);
    }
  }
  rotary_parameters(q);
  if (!turns) return;
  if (motion == Motion::kFeed) set_feed(feed, true);
  control_.turn_rotaries(motion, q, how == "MOVE");
}

/// Q120, Q121, Q122: where A, B and C have to go, degrees.
void Executor::rotary_parameters(const kinematics::AxisValues& values) {
  for (int slot = 0; slot < 3; ++slot) {
    const int axis = control_.axis_of(static_cast<nc::AxisWord>(slot + 3));
    if (axis >= 0)
      parameters_.set_q(120 + slot, deg_from_rad(values[axis] - control_.space().rotary_zero(slot)));
  }
}

void Executor::tilt(BlockReader& reader, const Mat3& rotation, bool on, size_t start) {
  if (!inner_.none())
    reader.fail("words-conflict", start, "a shift or rotation of the tilted plane is still active",
                "reset it (CYCL DEF 7, CYCL DEF 10) before the plane changes");
  if (tcpm_)
    reader.fail("unsupported-word", start, "tilting while M128 or FUNCTION TCPM is on is not supported",
                "write M129 before it");
  tilt_ = rotation;
  tilted_ = on;
  update_frame();
  control_.set_coordinates(on ? nc::Coordinates::kWork : nc::Coordinates::kAxes);
  if (control_.started() && on && control_.machine().axes.size() > 3)
    rotary_parameters(control_.tilt_solution(Vec3::UnitZ(), {}, control_.place().column));
}

void Executor::set_tcpm(bool on, bool by_vector, bool spatial, bool chosen) {
  if (!on && !tcpm_) return;
  tcpm_ = on;
  spatial_ = on && spatial;
  path_chosen_ = on && chosen;
  control_.set_tcp(!on ? nc::Tcp::kOff : by_vector ? nc::Tcp::kVector : nc::Tcp::kAxes);
  if (!on && tilted_) control_.set_coordinates(nc::Coordinates::kWork);
}

/// How the next block turns the tool, unless PATHCTRL says it for all.
void Executor::turn_by(nc::Tcp law) {
  if (tcpm_ && !path_chosen_ && control_.tcp() != law) control_.set_tcp(law);
}

/// FUNCTION TCPM ..., FUNCTION RESET TCPM, FUNCTION PROG PATH ...
void Executor::function_word(BlockReader& reader, size_t start) {
  if (reader.take("TCPM")) return tcpm(reader);
  if (reader.take("RESET")) {
    if (!reader.take("TCPM"))
      reader.fail("unsupported-word", start, "of FUNCTION RESET, only TCPM is supported",
                  "FUNCTION RESET TCPM");
    reader.expect_end();
    return set_tcpm(false, false, false, false);
  }
  if (reader.take("PROG") && reader.take("PATH")) {
    if (reader.take("OFF")) {
      path_is_contour_ = false;
    } else if (reader.take("IS") && reader.take("CONTOUR")) {
      path_is_contour_ = true;
    } else {
      reader.fail("unknown-word", start, "FUNCTION PROG PATH IS CONTOUR or OFF",
                  "FUNCTION PROG PATH IS CONTOUR");
    }
    return reader.expect_end();
  }
  if (reader.take("MODE")) {
    if (reader.take("MILL")) {
      control_.without_effect("FUNCTION MODE MILL");
      return reader.expect_end();
    }
    reader.fail("unsupported-word", start, "FUNCTION MODE other than MILL is not supported",
                "FUNCTION MODE MILL");
  }
  const std::string word(reader.take_letters());
  reader.fail("unsupported-word", start, fmt::format("FUNCTION {} is not supported", word),
              "FUNCTION TCPM is");
}

/// FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS [REFPNT TIP-TIP] [F500]
void Executor::tcpm(BlockReader& reader) {
  bool spatial = false, vector = false, axis_given = false, path_given = false, feed_given = false;
  reader.done();
  const size_t start = reader.offset();
  while (!reader.done()) {
    const size_t at = reader.offset();
    const std::string word(reader.take_letters());
    if (word == "F" && (reader.take("TCP") || reader.letters() == "CONT")) {
      if (reader.take("CONT")) reader.fail("unsupported-word", at, "F CONT is not supported", "F TCP");
      feed_given = true;
    } else if (word == "F" && reader.value_follows()) {
      reader.value();  // the largest feed of compensating moves: dynamics of the machine
    } else if (word == "AXIS") {
      axis_given = true;
      spatial = reader.take("SPAT");
      if (!spatial && !reader.take("POS")) reader.fail("missing-word", at, "AXIS is POS or SPAT", "AXIS POS");
    } else if (word == "PATHCTRL") {
      path_given = true;
      vector = reader.take("VECTOR");
      if (!vector && !reader.take("AXIS"))
        reader.fail("missing-word", at, "PATHCTRL is AXIS or VECTOR", "PATHCTRL AXIS");
    } else if (word == "REFPNT") {
      const std::string first(reader.take_letters());
      const bool dash = reader.take_char('-');
      const std::string second(reader.take_letters());
      if (first != "TIP" || !dash || second != "TIP")
        reader.fail("unsupported-word", at, fmt::format("REFPNT {}-{} is not supported", first, second),
                    "REFPNT TIP-TIP");
    } else {
      refuse_word(reader, at, word.empty() ? std::string(1, reader.peek()) : word);
    }
  }
  if (!axis_given || !path_given || !feed_given)
    reader.fail("missing-word", start, "FUNCTION TCPM needs F, AXIS and PATHCTRL",
                "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS");
  set_tcpm(true, vector, spatial, true);
}

}  // namespace swarf::program::heidenhain
