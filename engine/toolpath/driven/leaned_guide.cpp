#include "toolpath/driven/leaned_guide.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "toolpath/tool_path.h"

namespace swarf::toolpath {
namespace {

/// A B-spline's support is four steps.
constexpr double kSupport = 4.0;
/// Sine of the least angle between the axis and the level.
constexpr double kLeastRise = 0.0871557427476582;

LeanCurve::Place reflected(const LeanCurve::Place& about, const LeanCurve::Place& p) {
  return {2.0 * about.axis_W.dot(p.axis_W) * about.axis_W - p.axis_W, 2.0 * about.height - p.height};
}

LeanCurve::Place upright_place(const DrivenPart& on, const GuideCurve& curve, double x,
                               const LeanOptions& lean, const SourceLocation& where, position::Near& near) {
  const Vec2 at = curve.point(x), along = curve.tangent(x);
  const position::Rest rest = on.part.rest(on.profile, position::upright(at.x(), at.y()), near);
  if (!std::isfinite(rest.height))
    throw InputError(
        "guide-misses-part", where,
        fmt::format("the upright tool, whose contact leans the axis, rests on nothing at ({:.3f}, {:.3f}) mm",
                    at.x(), at.y()),
        "keep the guide on the part (area_mm), or say how low the tool may go: floor_mm");
  const Vec3 normal = Vec3(-rest.gradient.x(), -rest.gradient.y(), 1.0).normalized();
  const Vec3 feed = Vec3(along.x(), along.y(), rest.gradient.dot(along)).normalized();
  const Vec3 axis = pose_in_contact(Vec3::Zero(), normal, feed, lean.lead_rad, lean.tilt_rad, {0.0}).axis_W;
  return {axis, rest.height};
}

void require_rise(const LeanCurve& lean, double end, size_t parts, const SourceLocation& where) {
  for (size_t i = 0; i <= parts; ++i) {
    const Vec3 axis = lean.at(end * static_cast<double>(i) / static_cast<double>(parts)).axis_W;
    if (axis.z() >= kLeastRise) continue;
    throw InputError("axis-too-low", where,
                     fmt::format("lead and tilt lean the tool to {:.1f} deg from Z: its axis would be level "
                                 "or point below the surface",
                                 deg_from_rad(std::acos(std::clamp(axis.z(), -1.0, 1.0)))),
                     "lower lead_deg or tilt_deg, or turn the part so that its steep side is up");
  }
}

}  // namespace

LeanCurve::LeanCurve(const std::vector<Place>& places, double end)
    : step_(end / static_cast<double>(places.size() - 1)) {
  control_.reserve(places.size() + 2);
  control_.push_back(reflected(places.front(), places[1]));
  control_.insert(control_.end(), places.begin(), places.end());
  control_.push_back(reflected(places.back(), places[places.size() - 2]));
}

LeanCurve::Place LeanCurve::at(double x) const {
  const double cells = static_cast<double>(control_.size()) - 3.0;
  const double place = std::clamp(x / step_, 0.0, cells);
  const double cell = std::min(std::floor(place), cells - 1.0), t = place - cell, s = 1.0 - t;
  const Place* c = control_.data() + static_cast<size_t>(cell);
  const double w[4] = {s * s * s / 6.0, (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0,
                       (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0, t * t * t / 6.0};
  Place out{Vec3::Zero(), 0.0};
  for (int i = 0; i < 4; ++i) {
    out.axis_W += w[i] * c[i].axis_W;
    out.height += w[i] * c[i].height;
  }
  out.axis_W.normalize();
  return out;
}

position::GuideLine LeanedGuide::line(double x) const {
  const Vec2 at = curve_.point(x);
  const LeanCurve::Place lean = lean_->at(offset_mm_ + x);
  return position::turned_line({at.x(), at.y(), lean.height + pivot_mm_}, lean.axis_W);
}

double pivot_height(const position::ToolProfile& profile) {
  double height = 0.0;
  for (const position::ProfilePiece& piece : profile.pieces()) height = std::max(height, piece.radius);
  return height;
}

std::shared_ptr<const LeanCurve> lean_curve(const DrivenPart& on, const std::vector<GuideCurve>& chain,
                                            const LeanOptions& options, const SourceLocation& where) {
  double end = 0.0;
  for (const GuideCurve& curve : chain) end += curve.end();
  const size_t parts =
      std::max<size_t>(4, static_cast<size_t>(std::ceil(kSupport * end / options.smooth_mm)));
  std::vector<LeanCurve::Place> places;
  position::Near near;
  size_t piece = 0;
  double before = 0.0;
  for (size_t i = 0; i <= parts; ++i) {
    const double x = end * static_cast<double>(i) / static_cast<double>(parts);
    while (piece + 1 < chain.size() && x >= before + chain[piece].end()) before += chain[piece++].end();
    places.push_back(
        upright_place(on, chain[piece], std::min(x - before, chain[piece].end()), options, where, near));
  }
  auto lean = std::make_shared<const LeanCurve>(places, end);
  require_rise(*lean, end, 2 * parts, where);
  return lean;
}

}  // namespace swarf::toolpath
