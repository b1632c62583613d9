// Motions, cycles, tilted planes, NURBS, references.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/units.h"
#include "program/nc/fanuc.h"

namespace swarf::program::nc {
namespace {

using kinematics::AxisValues;

/// Chords of a NURBS miss it by at most this much: a tenth of what surface checks can see.
constexpr double kNurbsToleranceMm = 1e-4;
/// The first control point must be where the tool stands, mm.
constexpr double kNurbsStartMm = 5e-3;

}  // namespace

void Fanuc::one_shot() {
  switch (block_.g[kFanucOneShot]) {
    case 40:
      return control_.dwell(block_.has('X') ? block_.get('X') : 1e-3 * block_.get('P'));
    case 100:
      return set_data();
    case 110:
      return;
    case 280:
    case 300:
      return reference();
    case 520:
      return shift_to_words(false);
    case 920:
      return shift_to_words(true);
    case 531:
      return tilt_rotaries();
    default:
      return motion();
  }
}

void Fanuc::reference() {
  const kinematics::MachineModel& machine = control_.machine();
  const bool second = block_.g[kFanucOneShot] == 300;
  if (second && block_.has('P') && whole(block_, 'P', 2, 4, reader_, control_) != 2)
    control_.fail("unsupported-word", column('P'), "the third and fourth reference positions are not known",
                  "write G30 P2, which goes to the tool change position");
  if (second && !machine.tool_change)
    control_.fail("no-reference", g_column(kFanucOneShot),
                  "G30 goes to the tool change position, and the machine has none",
                  "add tool_change to the machine file, or write G28");
  const Target through = words();
  if (!through.any())
    control_.fail("missing-word", g_column(kFanucOneShot), "G28 has no axis words",
                  "name the axes: G91 G28 Z0");
  control_.line(Motion::kRapid, through);
  Target home;
  home.column = g_column(kFanucOneShot);
  for (int word = 0; word < kAxisWords; ++word) {
    if (!through.has(word)) continue;
    const int axis = control_.require_axis(static_cast<AxisWord>(word), through.column);
    home.set(word, second ? (*machine.tool_change)[axis] : machine.axes[static_cast<size_t>(axis)].home,
             false);
  }
  control_.machine_line(Motion::kRapid, home);
}

void Fanuc::set_data() {
  need('L', "G10");
  const int kind = whole(block_, 'L', 0, 100, reader_, control_);
  if (kind != 2 && kind != 20)
    control_.fail("unsupported-word", column('L'), fmt::format("G10 L{} changes data of the control", kind),
                  "give tools as a table; G10 L2 and L20 set work offsets");
  need('P', "G10");
  const int p = whole(block_, 'P', 1, kind == 2 ? 6 : 300, reader_, control_);
  const int number = kind == 2 ? p : 100 + p;
  const Target values = target_of(block_, false, reader_, control_);
  AxisValues origin = control_.offset_origin(number);
  for (int word = 0; word < kAxisWords; ++word) {
    if (!values.has(word)) continue;
    const int axis = control_.require_axis(static_cast<AxisWord>(word), values.column);
    const double value = values.value[static_cast<size_t>(word)];
    origin[axis] = incremental_ ? origin[axis] + value : value;
  }
  control_.set_offset_origin(number, origin);
}

/// G92: the present position reads as written. G52: the local shift is as written.
void Fanuc::shift_to_words(bool position) {
  const Target values = target_of(block_, false, reader_, control_);
  if (turned_.on || tcp_ != Tcp::kOff)
    control_.fail("modal-conflict", g_column(kFanucOneShot),
                  "the work offset shifts while a turned frame or TCP is on",
                  "switch it off first: G69, G49");
  const std::array<double, kAxisWords> here = control_.position();
  for (int word = 0; word < kAxisWords; ++word) {
    if (!values.has(word)) continue;
    const int axis = control_.require_axis(static_cast<AxisWord>(word), values.column);
    const double value = values.value[static_cast<size_t>(word)], now = here[static_cast<size_t>(word)];
    if (position && !std::isfinite(now))
      control_.fail("start-unknown", values.column, "G92 needs the position, which is not known yet",
                    "give the start position in the scene");
    if (position)
      shift_[axis] += now - value;
    else
      local_[axis] = value;
  }
  update_space();
}

void Fanuc::motion() {
  if (block_.has_g(kFanucMotion)) {
    motion_ = block_.g[kFanucMotion];
    cycle_ = 800;
    sticky_ = CycleWords();
  }
  if (block_.has_g(kFanucCycle)) {
    const int code = block_.g[kFanucCycle];
    if (code == 800) sticky_ = CycleWords();
    if (code != 800 && cycle_ == 800)
      cycle_start_ = control_.position_xyz()[axes_of(control_.plane()).normal];
    cycle_ = code;
  }
  if (cycle_ != 800) return cycle(cycle_);
  if (motion_ == 62) return nurbs();
  const bool machine = g(kFanucOneShot) == 530;
  Target target = machine ? target_of(block_, false, reader_, control_) : words();
  if (motion_ == 20 || motion_ == 30) {
    if (machine)
      control_.fail("modal-conflict", g_column(kFanucOneShot), "G53 goes with G00 and G01 only",
                    "write G53 G00");
    std::optional<ArcWords> arc = arc_words(block_, target, false, reader_, control_);
    if (arc) control_.arc(motion_ == 20 ? Motion::kClockwise : Motion::kCounterClockwise, target, *arc);
    return;
  }
  if (tcp_ == Tcp::kVector && (block_.has('I') || block_.has('J') || block_.has('K'))) {
    target.axis_P = Vec3(block_.get('I', 0.0), block_.get('J', 0.0), block_.get('K', 0.0));
    if (target.column == 0) target.column = reader_.column_of(block_.first);
  }
  if (!target.any()) return;
  const Motion kind = motion_ == 0 ? Motion::kRapid : Motion::kFeed;
  if (machine)
    control_.machine_line(kind, target);
  else
    control_.line(kind, target);
}

/// G68.2 X Y Z I J K: origin and Euler angles (Z, X', Z''), in the work. G68 X Y R: a turn in the plane.
void Fanuc::turn(int tenths) {
  if (tenths == 690) {
    turned_ = Turned();
    return update_space();
  }
  const Target at = target_of(block_, false, reader_, control_);
  if ((at.given & 0x38u) != 0)
    control_.fail("unexpected-word", at.column, "rotary words have no meaning with G68",
                  "give the angles as I J K or R");
  turned_.on = true;
  turned_.in_work = tenths == 682;
  Vec3 origin = Vec3::Zero();
  const Vec3 here = tenths == 680 ? control_.position_xyz() : Vec3(Vec3::Zero());
  for (int i = 0; i < 3; ++i) origin[i] = at.has(i) ? at.value[static_cast<size_t>(i)] : here[i];
  Mat3 rotation;
  const auto about = [](double deg, const Vec3& axis) {
    return Mat3(Eigen::AngleAxisd(rad_from_deg(deg), axis).toRotationMatrix());
  };
  if (tenths == 682) {
    if (block_.has('P') && block_.get('P') != 0.0)
      control_.fail("unsupported-word", column('P'), "G68.2 is read with Euler angles (P0)",
                    "post it with I J K as Euler angles");
    rotation = about(block_.get('I', 0.0), Vec3::UnitZ()) * about(block_.get('J', 0.0), Vec3::UnitX()) *
               about(block_.get('K', 0.0), Vec3::UnitZ());
  } else {
    need('R', "G68");
    origin[axes_of(control_.plane()).normal] = 0.0;
    if (!origin.allFinite())
      control_.fail("start-unknown", 0, "G68 turns about the present position, which is not known yet",
                    "give its centre");
    rotation = about(block_.get('R'), Vec3::Unit(axes_of(control_.plane()).normal));
  }
  turned_.frame = Pose::Identity();
  turned_.frame.linear() = rotation;
  turned_.frame.translation() = tenths == 682 ? origin : Vec3(origin - rotation * origin);
  update_space();
}

void Fanuc::tilt_rotaries() {
  const int at = g_column(kFanucOneShot);
  if (!turned_.on || !turned_.in_work)
    control_.fail("modal-conflict", at, "G53.1 positions to a tilted plane, and none is on",
                  "write G68.2 before it");
  const Motion kind = motion_ == 0 ? Motion::kRapid : Motion::kFeed;
  control_.turn_rotaries(kind, control_.tilt_solution(Vec3::UnitZ(), TiltPreference(), at),
                         tcp_ != Tcp::kOff);
}

// --- NURBS
// ---------------------------------------------------------------------------------------------------

void Fanuc::nurbs() {
  Nurbs nurbs;
  nurbs.where = control_.place();
  if (block_.has('P')) nurbs.order = whole(block_, 'P', 2, 6, reader_, control_);
  if (!block_.has('K') || (block_.given & kAxisBits) == 0)
    control_.fail("missing-word", 0, "G06.2 needs a knot K and a control point", "write G06.2 P4 K0 X Y Z");
  nurbs_ = nurbs;
  add_to_nurbs();
}

bool Fanuc::add_to_nurbs() {
  if (block_.has_g(kFanucMotion) && !nurbs_->knots.empty()) {
    control_.fail("bad-nurbs", g_column(kFanucMotion),
                  fmt::format("another motion begins after {} knots; {} points of order {} want {}",
                              nurbs_->knots.size(), nurbs_->points.size(), nurbs_->order,
                              nurbs_->points.size() + static_cast<size_t>(nurbs_->order)),
                  "give as many knots as points and order together");
  }
  need('K', "each block of a NURBS");
  if (block_.has('F')) control_.set_feed(block_.get('F'), column('F'));
  nurbs_->knots.push_back(block_.get('K'));
  const Target target = target_of(block_, false, reader_, control_);
  if (target.any()) {
    if (nurbs_->knots.size() != nurbs_->points.size() + 1)
      control_.fail("bad-nurbs", target.column, "a control point follows a knot that has none",
                    "write the points first");
    CurvePoint point;
    const std::array<double, kAxisWords> here = control_.position();
    for (int i = 0; i < 3; ++i) {
      const double before =
          nurbs_->points.empty() ? here[static_cast<size_t>(i)] : nurbs_->points.back().tip[i];
      point.tip[i] = target.has(i) ? target.value[static_cast<size_t>(i)] : before;
      if (target.has(i + 3)) control_.require_axis(static_cast<AxisWord>(i + 3), target.column);
      if (control_.axis_of(static_cast<AxisWord>(i + 3)) < 0) continue;
      const auto slot = static_cast<size_t>(i);
      const double angle = nurbs_->points.empty() ? here[slot + 3] : *nurbs_->points.back().rotary[slot];
      point.rotary[slot] = target.has(i + 3) ? target.value[slot + 3] : angle;
    }
    if (nurbs_->points.empty() && !((point.tip - control_.position_xyz()).norm() <= kNurbsStartMm))
      control_.fail("bad-nurbs", target.column, "the first control point is not where the tool stands",
                    "move there with G01 first");
    nurbs_->points.push_back(point);
    nurbs_->weights.push_back(block_.get('R', 1.0));
  }
  if (nurbs_->knots.size() < nurbs_->points.size() + static_cast<size_t>(nurbs_->order)) return true;
  const Nurbs all = *nurbs_;
  nurbs_.reset();
  motion_ = 10;
  try {
    control_.curve(NurbsCurve(all.order, all.points, all.weights, all.knots), kNurbsToleranceMm);
  } catch (const std::invalid_argument& problem) {
    control_.fail("bad-nurbs", 0, problem.what(), "correct the points and knots of the NURBS");
  }
  return true;
}

}  // namespace swarf::program::nc
