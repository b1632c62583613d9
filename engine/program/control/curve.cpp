#include "program/control/curve.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/angles.h"
#include "base/units.h"

namespace swarf::program::nc {
namespace {

/// A point in homogeneous coordinates: everything that the basis functions blend.
struct Blend {
  Vec3 tip = Vec3::Zero(), axis = Vec3::Zero();
  double rotary[3] = {0.0, 0.0, 0.0}, weight = 0.0;

  void add(const CurvePoint& point, double share) {
    tip += share * point.tip;
    if (point.axis) axis += share * *point.axis;
    for (size_t i = 0; i < 3; ++i) rotary[i] += share * point.rotary[i].value_or(0.0);
    weight += share;
  }
};

/// Halvings of a curve piece; 2^20 pieces of the smallest curve are far below any tolerance.
constexpr int kHalvings = 20;

double off_chord(const Vec3& a, const Vec3& b, const Vec3& p) {
  const Vec3 way = b - a;
  const double length_squared = way.squaredNorm();
  const double s = length_squared > 0.0 ? std::clamp((p - a).dot(way) / length_squared, 0.0, 1.0) : 0.0;
  return (p - a - s * way).norm();
}

/// Appends the parameters that end the pieces of [a, b].
void split(const Curve& curve, double a, const Vec3& at_a, double b, const Vec3& at_b, double tolerance,
           int depth, std::vector<double>& ends) {
  bool close = true;
  for (const double s : {0.25, 0.5, 0.75})
    close = close && off_chord(at_a, at_b, curve.at(a + s * (b - a)).tip) <= tolerance;
  if (close || depth == 0) {
    ends.push_back(b);
    return;
  }
  const double middle = 0.5 * (a + b);
  const Vec3 at_middle = curve.at(middle).tip;
  split(curve, a, at_a, middle, at_middle, tolerance, depth - 1, ends);
  split(curve, middle, at_middle, b, at_b, tolerance, depth - 1, ends);
}

}  // namespace

std::vector<double> chord_ends(const Curve& curve, double tolerance_mm) {
  std::vector<double> stops = curve.breaks();
  stops.push_back(1.0);
  std::vector<double> ends;
  double a = 0.0;
  for (const double b : stops) {
    split(curve, a, curve.at(a).tip, b, curve.at(b).tip, tolerance_mm, kHalvings, ends);
    a = b;
  }
  return ends;
}

double swept(const Segment& arc) {
  const auto flat = [&](const Vec3& v) { return Vec3(v - v.dot(arc.normal) * arc.normal); };
  const Vec3 a = flat(arc.from - arc.centre), b = flat(arc.to - arc.centre);
  if ((a - b).norm() <= 1e-9) return 2.0 * kPi;
  const double angle = signed_angle(arc.normal, a, b);
  return angle > 0.0 ? angle : angle + 2.0 * kPi;
}

TurningArc::TurningArc(const Segment& arc, double angle, const Rotaries& from, const Rotaries& to)
    : arc_(arc), angle_(angle), from_(from), to_(to) {
  const auto radius = [&](const Vec3& p) { return arc.normal.cross(p - arc.centre).norm(); };
  growth_ = radius(arc.to) / radius(arc.from) - 1.0;
}

CurvePoint TurningArc::at(double u) const {
  const Vec3 start = arc_.from - arc_.centre;
  const Vec3 out = start - start.dot(arc_.normal) * arc_.normal;
  const double angle = u * angle_, rise = u * (arc_.to - arc_.from).dot(arc_.normal);
  CurvePoint point;
  point.tip = arc_.from - out + rise * arc_.normal +
              (1.0 + u * growth_) * (std::cos(angle) * out + std::sin(angle) * arc_.normal.cross(out));
  if (u == 1.0) point.tip = arc_.to;
  for (size_t i = 0; i < 3; ++i) {
    if (from_[i] && to_[i]) point.rotary[i] = *from_[i] + u * (*to_[i] - *from_[i]);
  }
  return point;
}

/// Quarters of a turn: no piece of the search for chords can miss one.
std::vector<double> TurningArc::breaks() const {
  std::vector<double> breaks;
  for (double angle = 0.5 * kPi; angle < angle_ * (1.0 - 1e-9); angle += 0.5 * kPi)
    breaks.push_back(angle / angle_);
  return breaks;
}

NurbsCurve::NurbsCurve(int order, std::vector<CurvePoint> points, std::vector<double> weights,
                       std::vector<double> knots)
    : order_(order), points_(std::move(points)), weights_(std::move(weights)), knots_(std::move(knots)) {
  const size_t wanted = points_.size() + static_cast<size_t>(std::max(order_, 0));
  if (order_ < 2) throw std::invalid_argument("the order of a NURBS is at least 2");
  if (points_.size() < static_cast<size_t>(order_))
    throw std::invalid_argument("a NURBS needs at least as many points as its order");
  if (weights_.size() != points_.size()) throw std::invalid_argument("each point needs one weight");
  if (knots_.size() != wanted)
    throw std::invalid_argument("a NURBS needs as many knots as points and order together");
  if (!std::is_sorted(knots_.begin(), knots_.end())) throw std::invalid_argument("the knots decrease");
  if (!(knots_[points_.size()] > knots_[static_cast<size_t>(order_) - 1]))
    throw std::invalid_argument("the knots span nothing");
  if (std::any_of(weights_.begin(), weights_.end(), [](double weight) { return !(weight > 0.0); }))
    throw std::invalid_argument("a weight is not above zero");
}

CurvePoint NurbsCurve::at(double u) const {
  const size_t degree = static_cast<size_t>(order_) - 1;
  const double low = knots_[degree], high = knots_[points_.size()];
  const double t = low + u * (high - low);
  // The span that holds t; the last one holds its end too (A2.1).
  const auto after = std::upper_bound(knots_.begin() + static_cast<long>(degree),
                                      knots_.begin() + static_cast<long>(points_.size()), t);
  size_t span = static_cast<size_t>(after - knots_.begin()) - 1;
  while (span > degree && knots_[span] == knots_[span + 1]) --span;
  // Basis functions of the span (A2.2).
  std::vector<double> basis(degree + 1, 0.0);
  basis[0] = 1.0;
  for (size_t j = 1; j <= degree; ++j) {
    double saved = 0.0;
    for (size_t r = 0; r < j; ++r) {
      const double right = knots_[span + r + 1] - t, left = t - knots_[span + 1 + r - j];
      const double share = basis[r] / (right + left);
      basis[r] = saved + right * share;
      saved = left * share;
    }
    basis[j] = saved;
  }
  Blend blend;
  for (size_t j = 0; j <= degree; ++j) {
    const size_t i = span - degree + j;
    blend.add(points_[i], basis[j] * weights_[i]);
  }
  CurvePoint point;
  point.tip = blend.tip / blend.weight;
  const CurvePoint& first = points_.front();
  if (first.axis) point.axis = blend.axis / blend.weight;
  for (size_t i = 0; i < 3; ++i) {
    if (first.rotary[i]) point.rotary[i] = blend.rotary[i] / blend.weight;
  }
  return point;
}

std::vector<double> NurbsCurve::breaks() const {
  const size_t degree = static_cast<size_t>(order_) - 1;
  const double low = knots_[degree], high = knots_[points_.size()];
  std::vector<double> inner;
  for (size_t i = degree + 1; i < points_.size(); ++i) {
    const double u = (knots_[i] - low) / (high - low);
    if (u > 0.0 && u < 1.0 && (inner.empty() || u > inner.back())) inner.push_back(u);
  }
  return inner;
}

}  // namespace swarf::program::nc
