// G5, G5.1: Bezier curves of degree 3 and 2. G5.2, G5.3: a NURBS, point by point. All lie in X Y.
#include <fmt/format.h>

#include <stdexcept>

#include "program/linuxcnc/reader.h"

namespace swarf::program::nc::linuxcnc {
namespace {

constexpr int kDefaultOrder = 3, kOrderMax = 100;

/// A Bezier curve through its first and last point.
NurbsCurve bezier(const std::vector<Vec3>& polygon) {
  std::vector<CurvePoint> points(polygon.size());
  for (size_t i = 0; i < polygon.size(); ++i) points[i].tip = polygon[i];
  std::vector<double> knots(polygon.size(), 0.0);
  knots.insert(knots.end(), polygon.size(), 1.0);
  return NurbsCurve(static_cast<int>(polygon.size()), std::move(points),
                    std::vector<double>(polygon.size(), 1.0), std::move(knots));
}

/// The knots that go with G5.2: evenly spaced, and as many at each end as the order, so that the curve runs
/// from the first point to the last.
std::vector<double> even_knots(size_t points, int order) {
  std::vector<double> knots(static_cast<size_t>(order), 0.0);
  const size_t spans = points - static_cast<size_t>(order) + 1;
  for (size_t i = 1; i < spans; ++i) knots.push_back(static_cast<double>(i));
  knots.insert(knots.end(), static_cast<size_t>(order), static_cast<double>(spans));
  return knots;
}

}  // namespace

/// What the reference lists as errors of all of them, and what it leaves open.
void LinuxCnc::check_curve(const char* name) const {
  const int at = reader_.column_of(block_.first);
  for (const char letter : {'Z', 'A', 'B', 'C'}) {
    if (block_.has(letter))
      control_.report.fail("bad-spline", column(letter),
                           fmt::format("{} lies in X Y, and {} stands here", name, letter),
                           "move the other axes in a block of their own");
  }
  if (control_.modal.plane != Plane::kXY)
    control_.report.fail("bad-spline", at,
                         fmt::format("{} is a curve of the plane X Y, and another plane is active", name),
                         "select it first: G17");
  if (control_.contour.side() != Compensation::kOff)
    control_.report.fail("compensation-active", at,
                         fmt::format("{} while cutter radius compensation is on", name),
                         "switch it off first: G40");
  if (control_.modal.feed_mode == FeedMode::kInverseTime)
    control_.report.fail("bad-spline", at,
                         fmt::format("the reference does not say what F of G93 means for {}", name),
                         "write G94 and a feed before it");
  if (!control_.path.started)
    control_.report.fail("start-unknown", at,
                         fmt::format("{} starts, and the position is not known yet", name),
                         "give the start position in the scene, or position all axes with G0 before it");
}

/// G5 X Y I J P Q: control points at start + (I, J) and end + (P, Q). Without I J the curve goes on in the
/// direction in which the G5 before it ended, as if they were -P -Q of that one.
void LinuxCnc::cubic_spline() {
  check_curve("G5");
  need('P', "G5");
  need('Q', "G5");
  const bool i = block_.has('I'), j = block_.has('J');
  if (i != j)
    control_.report.fail("missing-word", column(i ? 'I' : 'J'),
                         fmt::format("G5 has {} without {}", i ? 'I' : 'J', i ? 'J' : 'I'),
                         "write both I and J, or neither to go on in the direction of the G5 before it");
  if (!i && !spline_tangent_)
    control_.report.fail("missing-word", reader_.column_of(block_.first),
                         "the first G5 of a series needs I and J",
                         "add I and J: the way from the start to the first control point");
  const Vec3 start = nc::position_xyz(control_), end = end_of_curve();
  const Vec3 out = i ? Vec3(control_.modal.mm(block_.get('I')), control_.modal.mm(block_.get('J')), 0.0)
                     : *spline_tangent_;
  const Vec3 in(control_.modal.mm(block_.get('P')), control_.modal.mm(block_.get('Q')), 0.0);
  nc::curve(control_, bezier({start, start + out, end + in, end}), kCurveToleranceMm);
  spline_tangent_ = -in;
}

/// G5.1 X Y I J: one control point, at start + (I, J); what is left out of I and J is zero.
void LinuxCnc::quadratic_spline() {
  check_curve("G5.1");
  const Vec3 offset(control_.modal.mm(block_.get('I', 0.0)), control_.modal.mm(block_.get('J', 0.0)), 0.0);
  if (offset.isZero(0.0))
    control_.report.fail("missing-word", reader_.column_of(block_.first), "G5.1 needs I or J other than zero",
                         "add the way from the start to the control point");
  const Vec3 start = nc::position_xyz(control_), end = end_of_curve();
  nc::curve(control_, bezier({start, start + offset, end}), kCurveToleranceMm);
}

Vec3 LinuxCnc::end_of_curve() {
  const Target target = target_of(block_, incremental_, reader_, control_);
  Vec3 end = nc::position_xyz(control_);
  for (int axis = 0; axis < 2; ++axis) {
    const double value = target.value[static_cast<size_t>(axis)];
    if (target.has(axis)) end[axis] = incremental_ ? end[axis] + value : value;
  }
  return end;
}

/// Between G5.2 and G5.3 stand the points of the curve and nothing else.
void LinuxCnc::check_nurbs_words() {
  constexpr uint32_t kPoint = 1u << ('X' - 'A') | 1u << ('Y' - 'A') | 1u << ('P' - 'A');
  const int motion = block_.has_g(kMotionGroup) ? block_.g[kMotionGroup] : 52;
  const bool codes = (block_.g_given & ~(1u << kMotionGroup)) != 0 || block_.m_count > 0 || block_.free_g > 0;
  if (codes || (motion != 52 && motion != 53) || (block_.given & ~kPoint) != 0)
    control_.report.fail(
        "bad-nurbs", reader_.column_of(block_.first),
        fmt::format("the NURBS that begins in line {} is open: only points X Y P belong here",
                    nurbs_->place.line),
        "close it first: G5.3");
}

/// G5.2 <P> <X Y> <L>, then X Y <P>: the first point is where the tool stands; P of a block without X Y is
/// its weight. Weights are 1 and the order is 3 unless P and L say otherwise.
void LinuxCnc::nurbs_point() {
  const bool point = block_.has('X') || block_.has('Y');
  const double weight = block_.get('P', 1.0);
  if (!(weight > 0.0))
    control_.report.fail("bad-nurbs", column('P'), fmt::format("P {:g} is no weight", weight),
                         "write P above zero");
  if (!nurbs_) {
    check_curve("G5.2");
    if (incremental_)
      control_.report.fail("bad-nurbs", g_column(kMotionGroup),
                           "the points of a NURBS under G91: from which point each counts is not documented",
                           "write them under G90");
    nurbs_.emplace();
    nurbs_->place = control_.report.place;
    nurbs_->order = block_.has('L') ? whole(block_, 'L', 2, kOrderMax, reader_, control_) : kDefaultOrder;
    nurbs_->points.push_back({nc::position_xyz(control_), {}, {}});
    nurbs_->weights.push_back(point ? 1.0 : weight);
    if (!point) return;
  }
  need('X', "a point of a NURBS");
  need('Y', "a point of a NURBS");
  const Vec3 tip(control_.modal.mm(block_.get('X')), control_.modal.mm(block_.get('Y')),
                 nurbs_->points.front().tip.z());
  nurbs_->points.push_back({tip, {}, {}});
  nurbs_->weights.push_back(weight);
}

void LinuxCnc::close_nurbs() {
  if (!nurbs_)
    control_.report.fail("bad-nurbs", g_column(kMotionGroup), "G5.3 closes a NURBS, and none is open",
                         "begin it with G5.2");
  if (block_.given != 0)
    control_.report.fail("unexpected-word", reader_.column_of(block_.first), "G5.3 stands alone in its block",
                         "write the last point in a block before it");
  const OpenNurbs all = std::move(*nurbs_);
  nurbs_.reset();
  if (all.points.size() < static_cast<size_t>(all.order))
    control_.report.fail(
        "bad-nurbs", g_column(kMotionGroup),
        fmt::format("a NURBS of order {} needs {} points, this one has {} with the one it starts from",
                    all.order, all.order, all.points.size()),
        "add points, or give a lower order L");
  nc::curve(control_,
            NurbsCurve(all.order, all.points, all.weights, even_knots(all.points.size(), all.order)),
            kCurveToleranceMm);
}

void LinuxCnc::fail_open_nurbs() const {
  control_.report.at(nurbs_->place.file, nurbs_->place.line, nurbs_->place.column);
  control_.report.fail("bad-nurbs", 0, "the NURBS that begins here is not closed before the program ends",
                       "close it with G5.3");
}

}  // namespace swarf::program::nc::linuxcnc
