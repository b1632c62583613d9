// Rotated and tilted coordinate systems: G68, G68.2 to G68.4, G69, and the rotary axes that follow (G53.1,
// G53.6).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/units.h"
#include "program/fanuc/reader.h"

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

}  // namespace

void Fanuc::turn(int tenths) {
  if (tenths >= 682 && tenths <= 684) refuse_mapped(g_column(kFanucTurn), "a plane is tilted", true);
  turn_code_ = tenths;
  switch (tenths) {
    case 680:
      return turn_in_plane();
    case 682:
    case 684:
      return tilt(tenths == 684);
    case 683:
      return tilt_by_tool_axis();
    default:
      turned_ = Turned();
      return update_space();
  }
}

Vec3 Fanuc::plane_words(const char letters[4]) const {
  Vec3 values;
  for (int i = 0; i < 3; ++i) values[i] = block_.get(letters[i], 0.0);
  return values;
}

/// Fails for a word that this form does not have.
void Fanuc::only_words(std::string_view letters, const char* form) {
  for (const char letter : std::string_view("XYZABCIJKPQR")) {
    if (block_.has(letter) && letters.find(letter) == std::string_view::npos)
      control_.report.fail("unexpected-word", column(letter),
                           fmt::format("{} has no meaning with {}", letter, form),
                           fmt::format("{} has the words {}", form, letters));
  }
}

/// G68 X Y R: a turn in the plane about the centre, by default the present position. Mirror images and
/// scaling come before it: they move the centre, and a mirror image reverses the turn.
void Fanuc::turn_in_plane() {
  only_words("XYZR", "G68");
  need('R', "G68");
  const int normal = axes_of(control_.modal.plane).normal;
  const Target at = target_of(block_, false, reader_, control_);
  Vec3 centre = nc::position_xyz(control_);
  for (int i = 0; i < 3; ++i) {
    const auto slot = static_cast<size_t>(i);
    if (at.has(i)) centre[i] = map_[slot].at(at.value[slot], false);
  }
  centre[normal] = 0.0;
  if (!centre.allFinite())
    control_.report.fail("start-unknown", 0, "G68 turns about the present position, which is not known yet",
                         "give its centre");
  const double angle_deg = mapped() && reversed() ? -block_.get('R') : block_.get('R');
  const Mat3 rotation = about(angle_deg, Vec3::Unit(normal));
  turned_.on = true;
  turned_.in_work = false;
  turned_.frame = Pose::Identity();
  turned_.frame.linear() = rotation;
  turned_.frame.translation() = centre - rotation * centre;
  update_space();
}

/// G68.2 in the workpiece coordinate system, G68.4 in the feature coordinate system that holds.
void Fanuc::tilt(bool incremental) {
  const int at = g_column(kFanucTurn);
  if (incremental && !(turned_.on && turned_.in_work))
    control_.report.fail("modal-conflict", at, "G68.4 tilts a tilted plane further, and none is on",
                         "write G68.2 before it");
  const int form = block_.has('P') ? whole(block_, 'P', 0, 4, reader_, control_) : 0;
  if (form == 2 || form == 3) {
    if (!plane_blocks_) {
      PlaneBlocks plane;
      plane.form = form;
      plane.incremental = incremental;
      plane.where = control_.report.place;
      plane_blocks_ = plane;
    }
    return collect_plane();
  }
  Mat3 rotation;
  if (form == 0) {
    only_words("XYZIJKP", "G68.2 with Euler angles");
    rotation = about(block_.get('I', 0.0), Vec3::UnitZ()) * about(block_.get('J', 0.0), Vec3::UnitX()) *
               about(block_.get('K', 0.0), Vec3::UnitZ());
  } else if (form == 1) {
    only_words("XYZIJKPQ", "G68.2 P1");
    rotation = roll_pitch_yaw();
  } else {
    control_.report.fail("unsupported-word", column('P'), "G68.2 P4 (projection angles) is not read",
                         "post the plane as two vectors (P3) or Euler angles");
  }
  set_plane(control_.modal.mm(1.0) * plane_words("XYZ"), rotation, incremental);
}

/// P1: I J K turn about X Y Z of the workpiece coordinate system, which stand; Q says in which order.
Mat3 Fanuc::roll_pitch_yaw() {
  const Vec3 angles = plane_words("IJK");
  const long turns = (angles.array() != 0.0).count();
  if (!block_.has('Q') && turns > 1)
    control_.report.fail("missing-word", 0,
                         "G68.2 P1 with several angles needs Q, the order of its rotations",
                         "write Q123 where X turns first, then Y, then Z");
  const int order = block_.has('Q') ? whole(block_, 'Q', 123, 321, reader_, control_) : 123;
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
    control_.report.fail("out-of-range", column('Q'), fmt::format("Q{} is no order of rotations", order),
                         "write each of 1 (X), 2 (Y) and 3 (Z) once: Q123");
  return rotation;
}

/// One block of G68.2 P2 (Q0 to Q3: shift and turn, three points) or P3 (Q1, Q2: X and Z of the plane).
void Fanuc::collect_plane() {
  PlaneBlocks& plane = *plane_blocks_;
  const bool points = plane.form == 2;
  const std::string name = fmt::format("{} P{}", plane.incremental ? "G68.4" : "G68.2", plane.form);
  need('Q', name.c_str());
  const int q = whole(block_, 'Q', points ? 0 : 1, points ? 3 : 2, reader_, control_);
  if ((plane.given >> q & 1u) != 0)
    control_.report.fail("word-twice", column('Q'), fmt::format("{} gives Q{} twice", name, q),
                         "write each Q once");
  plane.given |= 1u << q;
  if (points) {
    only_words(q == 0 ? "PQXYZR" : "PQXYZ", (name + fmt::format(" Q{}", q)).c_str());
    if (q == 0 && !plane_words("XYZ").isZero(0.0))
      control_.report.fail("unsupported-word",
                           column(block_.has('X')   ? 'X'
                                  : block_.has('Y') ? 'Y'
                                                    : 'Z'),
                           "a shift of the origin by Q0 is not read",
                           "put the first point (Q1) on the origin");
    if (q == 0)
      plane.turn_deg = block_.get('R', 0.0);
    else
      plane.vectors[static_cast<size_t>(q - 1)] = control_.modal.mm(1.0) * plane_words("XYZ");
  } else {
    only_words(q == 1 ? "PQXYZIJK" : "PQIJK", (name + fmt::format(" Q{}", q)).c_str());
    if (q == 1) plane.vectors[2] = control_.modal.mm(1.0) * plane_words("XYZ");
    plane.vectors[static_cast<size_t>(q - 1)] = plane_words("IJK");
  }
  const unsigned wanted = points ? 0b1110u : 0b110u;
  if ((plane.given & wanted) != wanted) return;
  const PlaneBlocks all = plane;
  plane_blocks_.reset();
  points ? plane_by_points(all) : plane_by_vectors(all);
}

/// From the first point to the second is X, the third lies on the side of Y.
void Fanuc::plane_by_points(const PlaneBlocks& plane) {
  const Vec3 x = plane.vectors[1] - plane.vectors[0], side = plane.vectors[2] - plane.vectors[0];
  const Vec3 z = x.cross(side);
  const double away = x.norm() > 0.0 ? z.norm() / x.norm() : 0.0;  // of the third point from the line, mm
  if (!(x.norm() > 1e-3) || !(away > 1e-3))
    control_.report.fail("bad-plane", 0,
                         fmt::format("the third point lies {:.6f} mm beside the line of the others", away),
                         "give three points that are not on one line");
  const Vec3 ex = x.normalized(), ez = z.normalized();
  const Mat3 rotation = from_columns(ex, ez.cross(ex), ez) * about(plane.turn_deg, Vec3::UnitZ());
  set_plane(plane.vectors[0], rotation, plane.incremental);
}

/// The tool stands along the second vector; X is the first one's part across it.
void Fanuc::plane_by_vectors(const PlaneBlocks& plane) {
  const Vec3& x = plane.vectors[0];
  const Vec3& z = plane.vectors[1];
  if (!(x.norm() > 1e-9) || !(z.norm() > 1e-9))
    control_.report.fail("bad-plane", 0, "a vector of the plane has no length",
                         "write a vector that is not zero");
  const Vec3 ez = z.normalized();
  const double off_deg = deg_from_rad(std::asin(std::min(1.0, std::abs(x.normalized().dot(ez)))));
  if (off_deg > kSquareDeg)
    control_.report.fail("bad-plane", 0,
                         fmt::format("both vectors stand {:.4f} degrees off a right angle", off_deg),
                         "give X and Z of the plane perpendicular to each other");
  const Vec3 ex = (x - x.dot(ez) * ez).normalized();
  set_plane(plane.vectors[2], from_columns(ex, ez.cross(ex), ez), plane.incremental);
}

/// G68.3: Z along the tool as it stands, X across it and the vertical axis (parameter 12321 as delivered:
/// the tool axis with all rotary axes at zero), turned by R about Z.
void Fanuc::tilt_by_tool_axis() {
  only_words("XYZR", "G68.3");
  const int given = block_.has('X') + block_.has('Y') + block_.has('Z');
  if (given != 0 && given != 3)
    control_.report.fail("missing-word", g_column(kFanucTurn),
                         "G68.3 wants X, Y and Z of the origin, or none", "write all three");
  // The words and the tool axis count in the workpiece coordinate system.
  turned_ = Turned();
  update_space();
  nc::set_coordinates(control_, Coordinates::kWork);
  const Vec3 origin =
      given == 3 ? Vec3(control_.modal.mm(1.0) * plane_words("XYZ")) : nc::position_xyz(control_);
  if (!control_.path.started || !origin.allFinite())
    control_.report.fail("start-unknown", g_column(kFanucTurn),
                         "G68.3 takes the tool axis as it stands, and the position is not known yet",
                         "give the start position in the scene");
  const Vec3 z = nc::tool_axis_P(control_), vertical = nc::tool_axis_at_zero_P(control_.space);
  const Vec3 across = vertical.cross(z);
  const double angle = std::atan2(across.norm(), vertical.dot(z));
  Mat3 rotation = Mat3::Identity();
  if (angle <= kParallelRad) {
    const auto upright = vertical.isApprox(Vec3::UnitZ(), 1e-12);
    if (!upright)
      control_.report.fail("bad-plane", g_column(kFanucTurn),
                           "the tool of this machine does not hang along Z", "write the plane as G68.2");
  } else if (angle < rad_from_deg(kNearlyParallelDeg) || angle > kPi - rad_from_deg(kNearlyParallelDeg)) {
    control_.report.fail(
        "bad-plane", g_column(kFanucTurn),
        fmt::format("the tool stands {:.6f} degrees from the vertical axis: where X of the plane "
                    "points depends on parameter 12322",
                    deg_from_rad(angle)),
        "write the plane as G68.2");
  } else {
    const Vec3 x = across.normalized();
    rotation = from_columns(x, z.cross(x), z);
  }
  set_plane(origin, rotation * about(block_.get('R', 0.0), Vec3::UnitZ()), false);
}

void Fanuc::set_plane(const Vec3& origin, const Mat3& rotation, bool incremental) {
  Pose plane = Pose::Identity();
  plane.linear() = rotation;
  plane.translation() = origin;
  turned_.frame = incremental ? Pose(turned_.frame * plane) : plane;
  turned_.on = turned_.in_work = true;
  update_space();
}

/// A plane of several blocks must be complete before anything else comes.
void Fanuc::expect_plane_block() {
  if (!plane_blocks_) return;
  const bool goes_on = !block_.empty() && g(kFanucTurn) == (plane_blocks_->incremental ? 684 : 682) &&
                       block_.has('P') && block_.get('P') == plane_blocks_->form;
  if (goes_on) return;
  const Place where = plane_blocks_->where;
  control_.report.at(where.file, where.line, where.column);
  control_.report.fail("bad-plane", 0, fmt::format("this plane (P{}) is not complete", plane_blocks_->form),
                       plane_blocks_->form == 2 ? "give Q1, Q2 and Q3 in blocks that follow each other"
                                                : "give Q1 and Q2 in blocks that follow each other");
}

/// G53.1: the rotary axes turn to the plane, the linear ones stand. G53.6: the tip stands where it is on the
/// work. Of both solutions the one with the least rotary travel.
void Fanuc::tilt_rotaries(bool tip_stands) {
  const int at = g_column(kFanucOneShot);
  const char* name = tip_stands ? "G53.6" : "G53.1";
  if (!turned_.on || !turned_.in_work)
    control_.report.fail("modal-conflict", at,
                         fmt::format("{} positions to a tilted plane, and none is on", name),
                         "write G68.2 before it");
  only_words("PR", name);
  for (const char letter : {'P', 'R'}) {
    if (block_.has(letter) && block_.get(letter) != 0.0)
      control_.report.fail(
          "unsupported-word", column(letter), fmt::format("{} of {} is not read", letter, name),
          letter == 'P' ? "write the rotary values in a G00 block where the other solution is meant"
                        : "write it without R: the axes turn about the tip");
  }
  const Motion kind = motion_ == 0 ? Motion::kRapid : Motion::kFeed;
  const bool on = control_.tools.length_on;
  const double before = control_.space.length();
  if (tip_stands && block_.has('H'))
    nc::set_length_compensation(control_, tool_value('H', true), true);
  else if (tip_stands && !on)
    control_.report.fail("missing-word", at, "G53.6 turns about the tip, and no tool length is known",
                         "write G53.6 H, or G43 H before it");
  nc::turn_rotaries(control_, kind, nc::tilt_solution(control_, Vec3::UnitZ(), TiltPreference(), at),
                    tip_stands || tcp_ != Tcp::kOff);
  if (tip_stands && block_.has('H')) nc::set_length_compensation(control_, before, on);
}

}  // namespace swarf::program::nc::fanuc
