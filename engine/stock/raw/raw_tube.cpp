#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/units.h"
#include "mesh/plain_solids.h"
#include "stock/raw/raw_body.h"

namespace swarf::stock {
namespace {

/// A place in the half plane through the axis: distance from it, and along it from the base.
struct Meridian {
  double across, along;
  Vec3 outward;  ///< unit, from the axis
};

/// Values of `m_along z + rho m_across cos(angle)`, angles from the direction's own, over ranges of all
/// three.
struct TubePatch {
  double low_across, high_across, low_along, high_along, least_cosine, greatest_cosine;
};

class RawTubeBody final : public RawBody {
 public:
  explicit RawTubeBody(const RawTube& tube) : tube_(tube) {
    SWARF_CHECK(tube.radius_mm > tube.inner_radius_mm && tube.inner_radius_mm >= 0.0 && tube.length_mm > 0.0,
                "a tube has a wall and a length");
  }

  Box box() const override {
    const Vec3 end = tube_.base_W + tube_.length_mm * tube_.axis_W;
    const Vec3 disc = tube_.radius_mm * (Vec3::Ones() - tube_.axis_W.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
    return {tube_.base_W.cwiseMin(end) - disc, tube_.base_W.cwiseMax(end) + disc};
  }
  std::shared_ptr<const RawBody> moved(const Pose& X_VW) const override {
    RawTube tube = tube_;
    tube.base_W = X_VW * tube_.base_W;
    tube.axis_W = (X_VW.linear() * tube_.axis_W).normalized();
    return make_raw_tube(tube);
  }
  TriMesh mesh_around() const override {
    TriMesh mesh;
    mesh::add_tube(mesh, tube_.base_W, tube_.axis_W, tube_.radius_mm, tube_.inner_radius_mm, tube_.length_mm);
    return mesh;
  }
  double volume_mm3() const override { return ring() * tube_.length_mm; }
  double area_mm2() const override {
    return 2.0 * ring() + 2.0 * kPi * (tube_.radius_mm + tube_.inner_radius_mm) * tube_.length_mm;
  }

  /// In the half plane through axis and point the tube is a rectangle.
  RawPoint at(const Vec3& p, double within) const override {
    const Meridian here = meridian(p);
    const double outer = here.across - tube_.radius_mm;
    const double inner = hollow() ? tube_.inner_radius_mm - here.across : outer;
    const double low = -here.along, high = here.along - tube_.length_mm;
    const double side = std::max(outer, inner), end = std::max(low, high);
    const bool outer_side = outer >= inner, low_end = low >= high;
    RawPoint at;
    at.distance_mm = std::hypot(std::max(side, 0.0), std::max(end, 0.0)) + std::min(std::max(side, end), 0.0);
    if (std::abs(at.distance_mm) > within) return {};
    const Vec3 side_normal = outer_side ? here.outward : Vec3(-here.outward);
    const Vec3 end_normal = low_end ? Vec3(-tube_.axis_W) : tube_.axis_W;
    if (side > 0.0 && end > 0.0) {
      at.normal = (side * side_normal + end * end_normal) / at.distance_mm;
    } else {
      at.normal = side >= end ? side_normal : end_normal;
    }
    at.foot = p - at.distance_mm * at.normal;
    return at;
  }

  void add_crossings(const Vec3& p, const Vec3& way, std::vector<double>& s) const override {
    const Vec3 q = p - tube_.base_W;
    const double z = q.dot(tube_.axis_W), rise = way.dot(tube_.axis_W);
    if (rise != 0.0) {
      s.push_back(-z / rise);
      s.push_back((tube_.length_mm - z) / rise);
    }
    const Vec3 from = q - z * tube_.axis_W, along = way - rise * tube_.axis_W;
    for (const double radius : {tube_.radius_mm, tube_.inner_radius_mm}) {
      if (radius > 0.0) add_circle(from, along, radius, s);
    }
  }

  std::vector<RawFace> faces(const Vec3& centre, double radius) const override {
    const Meridian c = meridian(centre);
    std::vector<RawFace> faces;
    const double base = tube_.base_W.dot(tube_.axis_W);
    if (std::abs(tube_.length_mm - c.along) <= radius)
      faces.push_back({tube_.axis_W, base + tube_.length_mm, base + tube_.length_mm});
    if (std::abs(c.along) <= radius) faces.push_back({-tube_.axis_W, -base, -base});
    const double half = c.across > radius ? std::asin(radius / c.across) : kPi;
    const auto add_side = [&](double side, double sign) {
      if (side <= 0.0 || std::abs(side - c.across) > radius) return;
      const Vec3 out = sign * c.outward;
      const double axis_at = out.dot(tube_.base_W), edge = side * std::cos(half);
      faces.push_back(
          {out, axis_at + std::min(sign * edge, sign * side), axis_at + std::max(sign * edge, sign * side)});
    };
    add_side(tube_.radius_mm, 1.0);
    add_side(tube_.inner_radius_mm, -1.0);
    return faces;
  }

  RawExtent extent(const Vec3& centre, double radius, const Vec3& m) const override {
    const Meridian c = meridian(centre);
    const double m_along = m.dot(tube_.axis_W);
    const Vec3 m_plane = m - m_along * tube_.axis_W;
    const double m_across = m_plane.norm();
    TubePatch all{std::max(c.across - radius, tube_.inner_radius_mm),
                  std::min(c.across + radius, tube_.radius_mm),
                  std::max(c.along - radius, 0.0),
                  std::min(c.along + radius, tube_.length_mm),
                  -1.0,
                  1.0};
    RawExtent extent;
    if (all.low_across > all.high_across || all.low_along > all.high_along) return extent;
    if (c.across > radius && m_across > 0.0) {
      const double half = std::asin(radius / c.across);
      const double middle = std::acos(std::clamp(m_plane.dot(c.outward) / m_across, -1.0, 1.0));
      all.greatest_cosine = middle <= half ? 1.0 : std::cos(middle - half);
      all.least_cosine = middle + half >= kPi ? -1.0 : std::cos(middle + half);
    }
    const auto add = [&](const TubePatch& patch) {
      for (const double across : {patch.low_across, patch.high_across})
        for (const double along : {patch.low_along, patch.high_along})
          for (const double cosine : {patch.least_cosine, patch.greatest_cosine})
            include(extent, m.dot(tube_.base_W) + m_along * along + across * m_across * cosine);
    };
    for (const double side : {tube_.radius_mm, tube_.inner_radius_mm}) {
      if (side <= 0.0 || std::abs(side - c.across) > radius) continue;
      add({side, side, all.low_along, all.high_along, all.least_cosine, all.greatest_cosine});
    }
    for (const double end : {0.0, tube_.length_mm}) {
      if (std::abs(end - c.along) > radius) continue;
      add({all.low_across, all.high_across, end, end, all.least_cosine, all.greatest_cosine});
    }
    return extent;
  }

  std::vector<RawPlace> places(double) const override {
    const Vec3 aside = across_axis();
    const double middle = 0.5 * (tube_.radius_mm + tube_.inner_radius_mm);
    return {{tube_.base_W + 0.5 * tube_.length_mm * tube_.axis_W + tube_.radius_mm * aside, aside},
            {tube_.base_W + middle * aside, -tube_.axis_W}};
  }

  std::string text() const override {
    const Vec3 &b = tube_.base_W, &a = tube_.axis_W;
    return fmt::format("{} D {}{} mm, {} mm long, base ({}, {}, {}) mm, axis ({}, {}, {})",
                       hollow() ? "tube" : "cylinder", 2.0 * tube_.radius_mm,
                       hollow() ? fmt::format(" and {}", 2.0 * tube_.inner_radius_mm) : "", tube_.length_mm,
                       b.x(), b.y(), b.z(), a.x(), a.y(), a.z());
  }

 private:
  bool hollow() const { return tube_.inner_radius_mm > 0.0; }
  double ring() const {
    return kPi * (tube_.radius_mm - tube_.inner_radius_mm) * (tube_.radius_mm + tube_.inner_radius_mm);
  }
  Vec3 across_axis() const {
    int least = 0;
    tube_.axis_W.cwiseAbs().minCoeff(&least);
    return tube_.axis_W.cross(Vec3::Unit(least)).normalized();
  }
  Meridian meridian(const Vec3& p) const {
    const Vec3 q = p - tube_.base_W;
    const double along = q.dot(tube_.axis_W);
    const Vec3 from_axis = q - along * tube_.axis_W;
    const double across = from_axis.norm();
    return {across, along, across > 0.0 ? Vec3(from_axis / across) : across_axis()};
  }
  /// |from + s along| = radius.
  static void add_circle(const Vec3& from, const Vec3& along, double radius, std::vector<double>& s) {
    const double a = along.squaredNorm(), b = from.dot(along), c = from.squaredNorm() - radius * radius;
    const double square = b * b - a * c;
    if (!(a > 0.0) || !(square >= 0.0)) return;
    // The root that does not cancel, and the other from the product of both.
    const double q = -(b + std::copysign(std::sqrt(square), b));
    s.push_back(q / a);
    if (q != 0.0) s.push_back(c / q);
  }

  RawTube tube_;
};

}  // namespace

std::shared_ptr<const RawBody> make_raw_tube(const RawTube& tube) {
  return std::make_shared<RawTubeBody>(tube);
}

}  // namespace swarf::stock
