// Rotated and tilted coordinate systems: G68, G68.2 to G68.4, G69, and the rotary axes that follow (G53.1,
// G53.6).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/units.h"
#include "program/fanuc/steps.h"

namespace swarf::program::nc::fanuc {
namespace {

/// How far from a right angle both vectors of P3 may be: the rounding of printed vectors.
constexpr double kSquareDeg = 0.1;
/// Between these angles from the vertical axis the manual's parameter 12322 decides what G68.3 does.
constexpr double kParallelRad = 1e-9, kNearlyParallelDeg = 1.0;

Mat3 about(double deg, const Vec3& axis) {
  return Eigen::AngleAxisd(rad_from_deg(deg), axis).toRotationMatrix();
}

Mat3 from_columns(const Vec3& x, const Vec3& y, const Vec3& z) {
  Mat3 all;
  all << x, y, z;
  return all;
}

Vec3 plane_words(const LetterDialect& letters, const char names[4]) {
  Vec3 values;
  for (int i = 0; i < 3; ++i) values[i] = letters.block.get(names[i], 0.0);
  return values;
}

/// G68 X Y R: a turn in the plane about the centre, by default the present position. Mirror images and
/// scaling come before it: they move the centre, and a mirror image reverses the turn.
void turn_in_plane(Fanuc& fanuc) {
  only_words(fanuc, "XYZR", "G68");
  fanuc.need('R', "G68");
  const int normal = axes_of(fanuc.control.modal.plane).normal;
  const Target at = target_of(fanuc.block, false, fanuc.reader, fanuc.control);
  Vec3 centre = nc::position_xyz(fanuc.control);
  for (int i = 0; i < 3; ++i) {
    const auto slot = static_cast<size_t>(i);
    if (at.has(i)) centre[i] = fanuc.mapping.stretch.along(i, at.value[slot], false);
  }
  centre[normal] = 0.0;
  if (!centre.allFinite())
    fanuc.control.report.fail("start-unknown", 0,
                              "G68 turns about the present position, which is not known yet",
                              "give its centre");
  const double angle_deg =
      mapped(fanuc.mapping) && reversed(fanuc.mapping, fanuc) ? -fanuc.block.get('R') : fanuc.block.get('R');
  const Mat3 rotation = about(angle_deg, Vec3::Unit(normal));
  fanuc.planes.turned.on = true;
  fanuc.planes.turned.in_work = false;
  fanuc.planes.turned.frame = Pose::Identity();
  fanuc.planes.turned.frame.linear() = rotation;
  fanuc.planes.turned.frame.translation() = centre - rotation * centre;
  update_space(fanuc);
}

void set_plane(Fanuc& fanuc, const Vec3& origin, const Mat3& rotation, bool incremental) {
  Pose plane = Pose::Identity();
  plane.linear() = rotation;
  plane.translation() = origin;
  fanuc.planes.turned.frame = incremental ? Pose(fanuc.planes.turned.frame * plane) : plane;
  fanuc.planes.turned.on = fanuc.planes.turned.in_work = true;
  update_space(fanuc);
}

/// From the first point to the second is X, the third lies on the side of Y.
void plane_by_points(Fanuc& fanuc, const PlaneBlocks& plane) {
  const Vec3 x = plane.vectors[1] - plane.vectors[0], side = plane.vectors[2] - plane.vectors[0];
  const Vec3 z = x.cross(side);
  const double away = x.norm() > 0.0 ? z.norm() / x.norm() : 0.0;  // of the third point from the line, mm
  if (!(x.norm() > 1e-3) || !(away > 1e-3))
    fanuc.control.report.fail(
        "bad-plane", 0, fmt::format("the third point lies {:.6f} mm beside the line of the others", away),
        "give three points that are not on one line");
  const Vec3 ex = x.normalized(), ez = z.normalized();
  const Mat3 rotation = from_columns(ex, ez.cross(ex), ez) * about(plane.turn_deg, Vec3::UnitZ());
  set_plane(fanuc, plane.vectors[0], rotation, plane.incremental);
}

/// The tool stands along the second vector; X is the first one's part across it.
void plane_by_vectors(Fanuc& fanuc, const PlaneBlocks& plane) {
  const Vec3& x = plane.vectors[0];
  const Vec3& z = plane.vectors[1];
  if (!(x.norm() > 1e-9) || !(z.norm() > 1e-9))
    fanuc.control.report.fail("bad-plane", 0, "a vector of the plane has no length",
                              "write a vector that is not zero");
  const Vec3 ez = z.normalized();
  const double off_deg = deg_from_rad(std::asin(std::min(1.0, std::abs(x.normalized().dot(ez)))));
  if (off_deg > kSquareDeg)
    fanuc.control.report.fail("bad-plane", 0,
                              fmt::format("both vectors stand {:.4f} degrees off a right angle", off_deg),
                              "give X and Z of the plane perpendicular to each other");
  const Vec3 ex = (x - x.dot(ez) * ez).normalized();
  set_plane(fanuc, plane.vectors[2], from_columns(ex, ez.cross(ex), ez), plane.incremental);
}

/// One block of G68.2 P2 (Q0 to Q3: shift and turn, three points) or P3 (Q1, Q2: X and Z of the plane).
void collect_plane(Fanuc& fanuc) {
  PlaneBlocks& plane = *fanuc.planes.open;
  const bool points = plane.form == 2;
  const std::string name = fmt::format("{} P{}", plane.incremental ? "G68.4" : "G68.2", plane.form);
  fanuc.need('Q', name.c_str());
  const int q = whole(fanuc.block, 'Q', points ? 0 : 1, points ? 3 : 2, fanuc.reader, fanuc.control);
  if ((plane.given >> q & 1u) != 0)
    fanuc.control.report.fail("word-twice", fanuc.column('Q'), fmt::format("{} gives Q{} twice", name, q),
                              "write each Q once");
  plane.given |= 1u << q;
  if (points) {
    only_words(fanuc, q == 0 ? "PQXYZR" : "PQXYZ", (name + fmt::format(" Q{}", q)).c_str());
    if (q == 0 && !plane_words(fanuc, "XYZ").isZero(0.0))
      fanuc.control.report.fail("unsupported-word",
                                fanuc.column(fanuc.block.has('X')   ? 'X'
                                             : fanuc.block.has('Y') ? 'Y'
                                                                    : 'Z'),
                                "a shift of the origin by Q0 is not read",
                                "put the first point (Q1) on the origin");
    if (q == 0)
      plane.turn_deg = fanuc.block.get('R', 0.0);
    else
      plane.vectors[static_cast<size_t>(q - 1)] = fanuc.control.modal.mm(1.0) * plane_words(fanuc, "XYZ");
  } else {
    only_words(fanuc, q == 1 ? "PQXYZIJK" : "PQIJK", (name + fmt::format(" Q{}", q)).c_str());
    if (q == 1) plane.vectors[2] = fanuc.control.modal.mm(1.0) * plane_words(fanuc, "XYZ");
    plane.vectors[static_cast<size_t>(q - 1)] = plane_words(fanuc, "IJK");
  }
  const unsigned wanted = points ? 0b1110u : 0b110u;
  if ((plane.given & wanted) != wanted) return;
  const PlaneBlocks all = plane;
  fanuc.planes.open.reset();
  points ? plane_by_points(fanuc, all) : plane_by_vectors(fanuc, all);
}

/// P1: I J K turn about X Y Z of the workpiece coordinate system, which stand; Q says in which order.
Mat3 roll_pitch_yaw(LetterDialect& letters, const std::string& name) {
  const Vec3 angles = plane_words(letters, "IJK");
  const long turns = (angles.array() != 0.0).count();
  if (!letters.block.has('Q') && turns > 1)
    letters.control.report.fail("missing-word", 0,
                                name + " with several angles needs Q, the order of its rotations",
                                "write Q123 where X turns first, then Y, then Z");
  const int order =
      letters.block.has('Q') ? whole(letters.block, 'Q', 123, 321, letters.reader, letters.control) : 123;
  const int digits[] = {order / 100, order / 10 % 10, order % 10};
  Mat3 rotation = Mat3::Identity();
  unsigned seen = 0;
  for (const int axis : digits) {
    if (axis >= 1 && axis <= 3) {
      seen |= 1u << axis;
      rotation = about(angles[axis - 1], Vec3::Unit(axis - 1)) * rotation;
    }
  }
  if (seen != 0b1110u)
    letters.control.report.fail("out-of-range", letters.column('Q'),
                                fmt::format("Q{} is no order of rotations", order),
                                "write each of 1 (X), 2 (Y) and 3 (Z) once: Q123");
  return rotation;
}

/// G68.2 in the workpiece coordinate system, G68.4 in the feature coordinate system that holds.
void tilt(Fanuc& fanuc, bool incremental) {
  const int at = fanuc.g_column(kFanucTurn);
  if (incremental && !(fanuc.planes.turned.on && fanuc.planes.turned.in_work))
    fanuc.control.report.fail("modal-conflict", at, "G68.4 tilts a tilted plane further, and none is on",
                              "write G68.2 before it");
  const bool named = fanuc.rules.plane_form < 0;  // the form is a word of the program
  const int form = !named                 ? fanuc.rules.plane_form
                   : fanuc.block.has('P') ? whole(fanuc.block, 'P', 0, 4, fanuc.reader, fanuc.control)
                                          : 0;
  if (form == 2 || form == 3) {
    if (!fanuc.planes.open) {
      PlaneBlocks plane;
      plane.form = form;
      plane.incremental = incremental;
      plane.where = fanuc.control.report.place;
      fanuc.planes.open = plane;
    }
    return collect_plane(fanuc);
  }
  Mat3 rotation;
  if (form == 0) {
    only_words(fanuc, "XYZIJKP", "G68.2 with Euler angles");
    rotation = about(fanuc.block.get('I', 0.0), Vec3::UnitZ()) *
               about(fanuc.block.get('J', 0.0), Vec3::UnitX()) *
               about(fanuc.block.get('K', 0.0), Vec3::UnitZ());
  } else if (form == 1) {
    const std::string name = named ? "G68.2 P1" : fanuc.g_name(kFanucTurn);
    only_words(fanuc, named ? "XYZIJKPQ" : "XYZIJKQ", name.c_str());
    rotation = roll_pitch_yaw(fanuc, name);
  } else {
    fanuc.control.report.fail("unsupported-word", fanuc.column('P'),
                              "G68.2 P4 (projection angles) is not read",
                              "post the plane as two vectors (P3) or Euler angles");
  }
  set_plane(fanuc, fanuc.control.modal.mm(1.0) * plane_words(fanuc, "XYZ"), rotation, incremental);
}

/// G68.3: Z along the tool as it stands, X across it and the vertical axis (parameter 12321 as delivered:
/// the tool axis with all rotary axes at zero), turned by R about Z.
void tilt_by_tool_axis(Fanuc& fanuc) {
  only_words(fanuc, "XYZR", "G68.3");
  const int given = fanuc.block.has('X') + fanuc.block.has('Y') + fanuc.block.has('Z');
  if (given != 0 && given != 3)
    fanuc.control.report.fail("missing-word", fanuc.g_column(kFanucTurn),
                              "G68.3 wants X, Y and Z of the origin, or none", "write all three");
  // The words and the tool axis count in the workpiece coordinate system.
  fanuc.planes.turned = Turned();
  update_space(fanuc);
  nc::set_coordinates(fanuc.control, Coordinates::kWork);
  const Vec3 origin = given == 3 ? Vec3(fanuc.control.modal.mm(1.0) * plane_words(fanuc, "XYZ"))
                                 : nc::position_xyz(fanuc.control);
  if (!fanuc.control.path.started || !origin.allFinite())
    fanuc.control.report.fail("start-unknown", fanuc.g_column(kFanucTurn),
                              "G68.3 takes the tool axis as it stands, and the position is not known yet",
                              "give the start position: start in [setup] of the scene, swarf check --home");
  const Vec3 z = nc::tool_axis_P(fanuc.control), vertical = nc::tool_axis_at_zero_P(fanuc.control.space);
  const Vec3 across = vertical.cross(z);
  const double angle = std::atan2(across.norm(), vertical.dot(z));
  Mat3 rotation = Mat3::Identity();
  if (angle <= kParallelRad) {
    const auto upright = vertical.isApprox(Vec3::UnitZ(), 1e-12);
    if (!upright)
      fanuc.control.report.fail("bad-plane", fanuc.g_column(kFanucTurn),
                                "the tool of this machine does not hang along Z", "write the plane as G68.2");
  } else if (angle < rad_from_deg(kNearlyParallelDeg) || angle > kPi - rad_from_deg(kNearlyParallelDeg)) {
    fanuc.control.report.fail(
        "bad-plane", fanuc.g_column(kFanucTurn),
        fmt::format("the tool stands {:.6f} degrees from the vertical axis: where X of the plane "
                    "points depends on parameter 12322",
                    deg_from_rad(angle)),
        "write the plane as G68.2");
  } else {
    const Vec3 x = across.normalized();
    rotation = from_columns(x, z.cross(x), z);
  }
  set_plane(fanuc, origin, rotation * about(fanuc.block.get('R', 0.0), Vec3::UnitZ()), false);
}

/// Where tilted planes have an end of their own, the codes of plane rotations do not touch them.
bool of_other_kind(Fanuc& fanuc, int tenths) {
  if (fanuc.rules.plane_off == G::kTurnOff || !fanuc.planes.turned.on) return false;
  const bool tilted = fanuc.planes.turned.in_work;
  if (tilted && tenths == G::kTurnOn)
    fanuc.control.report.fail("modal-conflict", fanuc.g_column(kFanucTurn),
                              "a rotation in the plane of a tilted plane is not read",
                              "post the plane with its rotation");
  return tenths == G::kTurnOff && tilted != (fanuc.block.g_written[kFanucTurn] == fanuc.rules.plane_off);
}

}  // namespace

void turn(Fanuc& fanuc, int tenths) {
  if (of_other_kind(fanuc, tenths)) return;
  if (tenths >= G::kTiltedPlane && tenths <= G::kFurtherTiltedPlane)
    refuse_mapped(fanuc.mapping, fanuc, fanuc.g_column(kFanucTurn), "a plane is tilted", true);
  fanuc.modes.turn_code = tenths;
  switch (tenths) {
    case G::kTurnOn:
      return turn_in_plane(fanuc);
    case G::kTiltedPlane:
    case G::kFurtherTiltedPlane:
      return tilt(fanuc, tenths == G::kFurtherTiltedPlane);
    case G::kPlaneByTool:
      return tilt_by_tool_axis(fanuc);
    default:
      fanuc.planes.turned = Turned();
      return update_space(fanuc);
  }
}

/// Fails for a word that this form does not have.
void only_words(LetterDialect& letters, std::string_view names, const char* form) {
  for (const char letter : std::string_view("XYZABCIJKPQR")) {
    if (letters.block.has(letter) && names.find(letter) == std::string_view::npos)
      letters.control.report.fail("unexpected-word", letters.column(letter),
                                  fmt::format("{} has no meaning with {}", letter, form),
                                  fmt::format("{} has the words {}", form, names));
  }
}

/// A plane of several blocks must be complete before anything else comes.
void expect_plane_block(Planes& planes, LetterDialect& letters) {
  if (!planes.open) return;
  const bool goes_on = !letters.block.empty() &&
                       g(letters, kFanucTurn) == (planes.open->incremental ? 684 : 682) &&
                       letters.block.has('P') && letters.block.get('P') == planes.open->form;
  if (goes_on) return;
  const Place where = planes.open->where;
  letters.control.report.at(where.file, where.line, where.column);
  letters.control.report.fail("bad-plane", 0,
                              fmt::format("this plane (P{}) is not complete", planes.open->form),
                              planes.open->form == 2 ? "give Q1, Q2 and Q3 in blocks that follow each other"
                                                     : "give Q1 and Q2 in blocks that follow each other");
}

/// G53.1: the rotary axes turn to the plane, the linear ones stand. G53.6: the tip stands where it is on the
/// work. Of both solutions the one with the least rotary travel.
void tilt_rotaries(Fanuc& fanuc, bool tip_stands) {
  const int at = fanuc.g_column(kFanucOneShot);
  const std::string name = fanuc.g_name(kFanucOneShot);
  if (!fanuc.planes.turned.on || !fanuc.planes.turned.in_work)
    fanuc.control.report.fail("modal-conflict", at,
                              fmt::format("{} positions to a tilted plane, and none is on", name),
                              "write G68.2 before it");
  only_words(fanuc, "PR", name.c_str());
  for (const char letter : {'P', 'R'}) {
    if (fanuc.block.has(letter) && fanuc.block.get(letter) != 0.0)
      fanuc.control.report.fail(
          "unsupported-word", fanuc.column(letter), fmt::format("{} of {} is not read", letter, name),
          letter == 'P' ? "write the rotary values in a G00 block where the other solution is meant"
                        : "write it without R: the axes turn about the tip");
  }
  const Motion kind = fanuc.modes.motion == 0 ? Motion::kRapid : Motion::kFeed;
  const bool on = fanuc.control.tools.length_on;
  const double before = fanuc.control.space.length();
  if (tip_stands && fanuc.block.has('H'))
    nc::set_length_compensation(fanuc.control, tool_value(fanuc.modes, fanuc.zero, fanuc, 'H', true), true);
  else if (tip_stands && !on)
    fanuc.control.report.fail("missing-word", at, "G53.6 turns about the tip, and no tool length is known",
                              "write G53.6 H, or G43 H before it");
  nc::turn_rotaries(fanuc.control, kind,
                    nc::tilt_solution(fanuc.control, Vec3::UnitZ(), TiltPreference(), at),
                    tip_stands || fanuc.modes.tcp != Tcp::kOff);
  if (tip_stands && fanuc.block.has('H')) nc::set_length_compensation(fanuc.control, before, on);
}

}  // namespace swarf::program::nc::fanuc
