// G5, G5.1: Bezier curves of degree 3 and 2. G5.2, G5.3: a NURBS, point by point. All lie in X Y.
#include <fmt/format.h>

#include <stdexcept>

#include "program/linuxcnc/steps.h"

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

/// What the reference lists as errors of all of them, and what it leaves open.
void check_curve(const LetterDialect& letters, const char* name) {
  const int at = letters.reader.column_of(letters.block.first);
  for (const char letter : {'Z', 'A', 'B', 'C'}) {
    if (letters.block.has(letter))
      letters.control.report.fail("bad-spline", letters.column(letter),
                                  fmt::format("{} lies in X Y, and {} stands here", name, letter),
                                  "move the other axes in a block of their own");
  }
  if (letters.control.modal.plane != Plane::kXY)
    letters.control.report.fail(
        "bad-spline", at, fmt::format("{} is a curve of the plane X Y, and another plane is active", name),
        "select it first: G17");
  if (letters.control.contour.side() != Compensation::kOff)
    letters.control.report.fail("compensation-active", at,
                                fmt::format("{} while cutter radius compensation is on", name),
                                "switch it off first: G40");
  if (letters.control.modal.feed_mode == FeedMode::kInverseTime)
    letters.control.report.fail("bad-spline", at,
                                fmt::format("the reference does not say what F of G93 means for {}", name),
                                "write G94 and a feed before it");
  if (!letters.control.path.started)
    letters.control.report.fail("start-unknown", at,
                                fmt::format("{} starts, and the position is not known yet", name),
                                "give the start position (start in [setup] of the scene, swarf check "
                                "--home), or position all axes with G0 before it");
}

Vec3 end_of_curve(Modes& modes, LetterDialect& letters) {
  const Target target = target_of(letters.block, modes.incremental, letters.reader, letters.control);
  Vec3 end = nc::position_xyz(letters.control);
  for (int axis = 0; axis < 2; ++axis) {
    const double value = target.value[static_cast<size_t>(axis)];
    if (target.has(axis)) end[axis] = modes.incremental ? end[axis] + value : value;
  }
  return end;
}

}  // namespace

/// G5 X Y I J P Q: control points at start + (I, J) and end + (P, Q). Without I J the curve goes on in the
/// direction in which the G5 before it ended, as if they were -P -Q of that one.
void cubic_spline(Modes& modes, Curves& curves, LetterDialect& letters) {
  check_curve(letters, "G5");
  letters.need('P', "G5");
  letters.need('Q', "G5");
  const bool i = letters.block.has('I'), j = letters.block.has('J');
  if (i != j)
    letters.control.report.fail(
        "missing-word", letters.column(i ? 'I' : 'J'),
        fmt::format("G5 has {} without {}", i ? 'I' : 'J', i ? 'J' : 'I'),
        "write both I and J, or neither to go on in the direction of the G5 before it");
  if (!i && !curves.spline_tangent)
    letters.control.report.fail("missing-word", letters.reader.column_of(letters.block.first),
                                "the first G5 of a series needs I and J",
                                "add I and J: the way from the start to the first control point");
  const Vec3 start = nc::position_xyz(letters.control), end = end_of_curve(modes, letters);
  const Vec3 out = i ? Vec3(letters.control.modal.mm(letters.block.get('I')),
                            letters.control.modal.mm(letters.block.get('J')), 0.0)
                     : *curves.spline_tangent;
  const Vec3 in(letters.control.modal.mm(letters.block.get('P')),
                letters.control.modal.mm(letters.block.get('Q')), 0.0);
  nc::curve(letters.control, bezier({start, start + out, end + in, end}), kCurveToleranceMm);
  curves.spline_tangent = -in;
}

/// G5.1 X Y I J: one control point, at start + (I, J); what is left out of I and J is zero.
void quadratic_spline(Modes& modes, LetterDialect& letters) {
  check_curve(letters, "G5.1");
  const Vec3 offset(letters.control.modal.mm(letters.block.get('I', 0.0)),
                    letters.control.modal.mm(letters.block.get('J', 0.0)), 0.0);
  if (offset.isZero(0.0))
    letters.control.report.fail("missing-word", letters.reader.column_of(letters.block.first),
                                "G5.1 needs I or J other than zero",
                                "add the way from the start to the control point");
  const Vec3 start = nc::position_xyz(letters.control), end = end_of_curve(modes, letters);
  nc::curve(letters.control, bezier({start, start + offset, end}), kCurveToleranceMm);
}

/// Between G5.2 and G5.3 stand the points of the curve and nothing else.
void check_nurbs_words(Curves& curves, LetterDialect& letters) {
  constexpr uint32_t kPoint = 1u << ('X' - 'A') | 1u << ('Y' - 'A') | 1u << ('P' - 'A');
  const int motion = letters.block.has_g(kMotionGroup) ? letters.block.g[kMotionGroup] : 52;
  const bool codes = (letters.block.g_given & ~(1u << kMotionGroup)) != 0 || letters.block.m_count > 0 ||
                     letters.block.free_g > 0;
  if (codes || (motion != G::kNurbsPoint && motion != G::kNurbsEnd) || (letters.block.given & ~kPoint) != 0)
    letters.control.report.fail(
        "bad-nurbs", letters.reader.column_of(letters.block.first),
        fmt::format("the NURBS that begins in line {} is open: only points X Y P belong here",
                    curves.nurbs->place.line),
        "close it first: G5.3");
}

/// G5.2 <P> <X Y> <L>, then X Y <P>: the first point is where the tool stands; P of a block without X Y is
/// its weight. Weights are 1 and the order is 3 unless P and L say otherwise.
void nurbs_point(Modes& modes, Curves& curves, LetterDialect& letters) {
  const bool point = letters.block.has('X') || letters.block.has('Y');
  const double weight = letters.block.get('P', 1.0);
  if (!(weight > 0.0))
    letters.control.report.fail("bad-nurbs", letters.column('P'), fmt::format("P {:g} is no weight", weight),
                                "write P above zero");
  if (!curves.nurbs) {
    check_curve(letters, "G5.2");
    if (modes.incremental)
      letters.control.report.fail(
          "bad-nurbs", letters.g_column(kMotionGroup),
          "the points of a NURBS under G91: from which point each counts is not documented",
          "write them under G90");
    curves.nurbs.emplace();
    curves.nurbs->place = letters.control.report.place;
    curves.nurbs->order = letters.block.has('L')
                              ? whole(letters.block, 'L', 2, kOrderMax, letters.reader, letters.control)
                              : kDefaultOrder;
    curves.nurbs->points.push_back({nc::position_xyz(letters.control), {}, {}});
    curves.nurbs->weights.push_back(point ? 1.0 : weight);
    if (!point) return;
  }
  letters.need('X', "a point of a NURBS");
  letters.need('Y', "a point of a NURBS");
  const Vec3 tip(letters.control.modal.mm(letters.block.get('X')),
                 letters.control.modal.mm(letters.block.get('Y')), curves.nurbs->points.front().tip.z());
  curves.nurbs->points.push_back({tip, {}, {}});
  curves.nurbs->weights.push_back(weight);
}

void close_nurbs(Curves& curves, LetterDialect& letters) {
  if (!curves.nurbs)
    letters.control.report.fail("bad-nurbs", letters.g_column(kMotionGroup),
                                "G5.3 closes a NURBS, and none is open", "begin it with G5.2");
  if (letters.block.given != 0)
    letters.control.report.fail("unexpected-word", letters.reader.column_of(letters.block.first),
                                "G5.3 stands alone in its block",
                                "write the last point in a block before it");
  const OpenNurbs all = std::move(*curves.nurbs);
  curves.nurbs.reset();
  if (all.points.size() < static_cast<size_t>(all.order))
    letters.control.report.fail(
        "bad-nurbs", letters.g_column(kMotionGroup),
        fmt::format("a NURBS of order {} needs {} points, this one has {} with the one it starts from",
                    all.order, all.order, all.points.size()),
        "add points, or give a lower order L");
  nc::curve(letters.control,
            NurbsCurve(all.order, all.points, all.weights, even_knots(all.points.size(), all.order)),
            kCurveToleranceMm);
}

void fail_open_nurbs(const Curves& curves, const LetterDialect& letters) {
  letters.control.report.at(curves.nurbs->place.file, curves.nurbs->place.line, curves.nurbs->place.column);
  letters.control.report.fail("bad-nurbs", 0,
                              "the NURBS that begins here is not closed before the program ends",
                              "close it with G5.3");
}

}  // namespace swarf::program::nc::linuxcnc
