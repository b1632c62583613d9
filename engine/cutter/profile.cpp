#include "cutter/profile.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/plane_vectors.h"
#include "base/units.h"
#include "cutter/profile_check.h"

namespace swarf::cutter {
namespace {

constexpr double kShortest = 1e-9;  // mm

/// Unit direction of travel at a point of the element.
Vec2 tangent(const OutlineElement& element, const Vec2& at) {
  if (element.is_line()) return (element.to - element.from).normalized();
  // Counter-clockwise about the centre when the arc bulges, clockwise when it is hollow.
  return left((at - element.centre) / element.radius);
}

class Builder {
 public:
  /// A line from the last point; left out when it has no length.
  void line(const Vec2& to) {
    if ((to - last_).norm() > kShortest) add({last_, to, 0.0, Vec2::Zero()});
  }
  void arc(const Vec2& to, double radius, const Vec2& centre) { add({last_, to, radius, centre}); }
  void arc(const Vec2& to, double radius) { add(arc_between(last_, to, radius)); }
  std::vector<OutlineElement> take() { return std::move(elements_); }

 private:
  void add(const OutlineElement& element) {
    elements_.push_back(element);
    last_ = element.to;
  }
  std::vector<OutlineElement> elements_;
  Vec2 last_ = Vec2::Zero();
};

void build_apt(Builder& build, const AptForm& form) {
  build.line(form.bottom_end());
  if (form.r > 0.0) build.arc(form.flank_start(), form.r, form.corner_centre());
  build.line(form.flank_end());
}

void build_chamfer(Builder& build, const Cutter& c) {
  const double cone = (c.radius() - 0.5 * c.tip_diameter_mm) / std::tan(0.5 * c.point_angle_rad);
  build.line({0.5 * c.tip_diameter_mm, 0.0});
  // A cone that ends with the flutes has no cylinder of a rounding error's height above it.
  const double cone_end = std::abs(cone - c.flute_length_mm) < kShortest ? c.flute_length_mm : cone;
  build.line({c.radius(), cone_end});
  build.line({c.radius(), c.flute_length_mm});
}

void build_woodruff(Builder& build, const Cutter& c) {
  const double radius = c.radius(), r = c.corner_radius_mm, width = c.flute_length_mm;
  build.line({radius - r, 0.0});
  if (r > 0.0) build.arc({radius, r}, r, {radius - r, r});
  build.line({radius, width - r});
  if (r > 0.0) build.arc({radius - r, width}, r, {radius - r, width - r});
}

}  // namespace

OutlineElement arc_between(const Vec2& from, const Vec2& to, double radius) {
  const Vec2 chord = to - from;
  const double half = 0.5 * chord.norm();
  const double rise = std::sqrt(std::max(0.0, radius * radius - half * half));
  const Vec2 inwards = left(chord.normalized()) * (radius > 0.0 ? rise : -rise);
  return {from, to, radius, 0.5 * (from + to) + inwards};
}

Vec2 start_tangent(const OutlineElement& element) {
  return tangent(element, element.from);
}

Vec2 end_tangent(const OutlineElement& element) {
  return tangent(element, element.to);
}

double arc_angle(const OutlineElement& element) {
  if (element.is_line()) return 0.0;
  const double half = 0.5 * (element.to - element.from).norm() / std::abs(element.radius);
  return 2.0 * std::asin(std::min(1.0, half));
}

Vec2 outward(const Vec2& tangent) {
  return {tangent.y(), -tangent.x()};
}

Vec2 AptForm::corner_centre() const {
  // Both lines pass through the crossing; the centre lies r inside of each: n . (centre - crossing) = -r.
  const Vec2 crossing(0.5 * d, 0.5 * d * std::tan(alpha));
  const Vec2 bottom(std::sin(alpha), -std::cos(alpha)), flank(std::cos(beta), -std::sin(beta));
  return crossing + r / std::cos(alpha + beta) * Vec2(bottom.y() - flank.y(), flank.x() - bottom.x());
}

Vec2 AptForm::bottom_end() const {
  return corner_centre() + r * Vec2(std::sin(alpha), -std::cos(alpha));
}

Vec2 AptForm::flank_start() const {
  return corner_centre() + r * Vec2(std::cos(beta), -std::sin(beta));
}

Vec2 AptForm::flank_end() const {
  return {0.5 * d + (h - 0.5 * d * std::tan(alpha)) * std::tan(beta), h};
}

double AptForm::largest_corner_radius() const {
  return 0.5 * d / (std::cos(alpha) * std::tan(0.5 * (0.5 * kPi - alpha - beta)));
}

std::optional<AptForm> apt_form(const Cutter& c) {
  AptForm form{c.diameter_mm, 0.0, 0.0, 0.0, c.flute_length_mm};
  switch (c.shape) {
    case Shape::kFlat:
      return form;
    case Shape::kBall:
      form.r = c.radius();
      return form;
    case Shape::kBullNose:
      form.r = c.corner_radius_mm;
      return form;
    case Shape::kTaper: {
      // The corner's centre stands at e = D/2 - r, f = r; the flank's line through it reaches z = 0 at d/2.
      form.r = c.corner_radius_mm;
      form.beta = c.taper_rad;
      const double e = c.radius() - form.r;
      form.d = 2.0 * (e + form.r * (1.0 - std::sin(form.beta)) / std::cos(form.beta));
      return form;
    }
    case Shape::kDrill:
      form.alpha = 0.5 * (kPi - c.point_angle_rad);
      return form;
    case Shape::kApt:
      form.r = c.corner_radius_mm;
      form.alpha = c.alpha_rad;
      form.beta = c.beta_rad;
      return form;
    case Shape::kChamfer:
    case Shape::kWoodruff:
    case Shape::kProfile:
      return std::nullopt;
  }
  SWARF_CHECK(false, "a shape without an outline");
}

std::vector<OutlineElement> outline(const Cutter& c) {
  Builder build;
  if (const std::optional<AptForm> form = apt_form(c)) {
    build_apt(build, *form);
  } else if (c.shape == Shape::kChamfer) {
    build_chamfer(build, c);
  } else if (c.shape == Shape::kWoodruff) {
    build_woodruff(build, c);
  } else {
    for (size_t i = 1; i < c.profile.size(); ++i) {
      const ProfilePoint& point = c.profile[i];
      if (point.radius_mm == 0.0) {
        build.line(point.to);
      } else {
        build.arc(point.to, point.radius_mm);
      }
    }
  }
  return build.take();
}

double greatest_radius(const std::vector<OutlineElement>& outline) {
  double greatest = 0.0;
  for (const OutlineElement& element : outline) {
    greatest = std::max({greatest, element.from.x(), element.to.x()});
    const double level = element.centre.y();
    if (element.radius > 0.0 && element.from.y() <= level && level <= element.to.y()) {
      greatest = std::max(greatest, element.centre.x() + element.radius);
    }
  }
  return greatest;
}

void set_profile(Cutter& cutter, std::vector<ProfilePoint> points) {
  cutter.shape = Shape::kProfile;
  cutter.profile = std::move(points);
  if (!profile_problems(cutter.profile).empty()) return;
  cutter.diameter_mm = 2.0 * greatest_radius(outline(cutter));
  cutter.flute_length_mm = cutter.profile.back().to.y();
}

std::vector<Vec2> sample_outline(const std::vector<OutlineElement>& outline, double tolerance_mm) {
  std::vector<Vec2> points;
  if (!outline.empty()) points.push_back(outline.front().from);
  for (const OutlineElement& element : outline) {
    const double angle = arc_angle(element);
    if (angle > 0.0) {
      const double step = 2.0 * std::acos(std::max(0.0, 1.0 - tolerance_mm / std::abs(element.radius)));
      const int pieces = std::max(1, static_cast<int>(std::ceil(angle / step)));
      const Vec2 arm = element.from - element.centre;
      const double turn = element.radius > 0.0 ? angle : -angle;
      for (int i = 1; i < pieces; ++i) {
        points.emplace_back(element.centre + Eigen::Rotation2Dd(turn * i / pieces) * arm);
      }
    }
    points.push_back(element.to);
  }
  return points;
}

}  // namespace swarf::cutter
