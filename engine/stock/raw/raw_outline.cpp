#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/hash.h"
#include "mesh/plain_solids.h"
#include "stock/raw/raw_body.h"

namespace swarf::stock {
namespace {

/// How far beyond its ends a line still passes a side, of the side's length: neighbours must leave no gap.
constexpr double kBeyondEnd = 1e-9;

/// The nearest place of the polygon.
struct OutlinePoint {
  double distance;  ///< < 0 inside
  Vec2 foot, normal;
};

/// The part of a side that lies in a square about a centre; nothing: from > to.
struct SidePart {
  double from = 0.0, to = 1.0;
};

SidePart within_square(const Vec2& a, const Vec2& way, const Vec2& centre, double half) {
  SidePart part;
  for (int i = 0; i < 2; ++i) {
    const double low = centre[i] - half - a[i], high = centre[i] + half - a[i];
    if (way[i] == 0.0) {
      if (low > 0.0 || high < 0.0) return {1.0, 0.0};
      continue;
    }
    part.from = std::max(part.from, std::min(low / way[i], high / way[i]));
    part.to = std::min(part.to, std::max(low / way[i], high / way[i]));
  }
  return part;
}

class RawOutlineBody final : public RawBody {
 public:
  explicit RawOutlineBody(RawOutline outline) : outline_(std::move(outline)) {
    SWARF_CHECK(outline_.points_mm.size() >= 3 && outline_.high_mm > outline_.low_mm,
                "an outline has three corners and a height");
    double twice = 0.0;
    for (size_t i = 0; i < sides(); ++i) {
      const Vec2 &a = corner(i), &b = corner(i + 1);
      twice += a.x() * b.y() - a.y() * b.x();
      length_ += (b - a).norm();
    }
    if (twice < 0.0) std::reverse(outline_.points_mm.begin(), outline_.points_mm.end());
    area_ = 0.5 * std::abs(twice);
  }

  std::vector<Vec3> corners() const override {
    std::vector<Vec3> corners;
    for (const Vec2& p : outline_.points_mm) {
      corners.emplace_back(p.x(), p.y(), outline_.low_mm);
      corners.emplace_back(p.x(), p.y(), outline_.high_mm);
    }
    return corners;
  }
  Box box() const override {
    Vec2 low = corner(0), high = low;
    for (const Vec2& p : outline_.points_mm) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    return {{low.x(), low.y(), outline_.low_mm}, {high.x(), high.y(), outline_.high_mm}};
  }
  TriMesh mesh_around() const override {
    TriMesh mesh;
    if (!mesh::add_prism(mesh, outline_.points_mm, outline_.low_mm, outline_.high_mm))
      mesh::add_box(mesh, box());
    return mesh;
  }
  double volume_mm3() const override { return area_ * height(); }
  double area_mm2() const override { return 2.0 * area_ + length_ * height(); }

  RawPoint at(const Vec3& p, double within) const override {
    const double low = outline_.low_mm - p.z(), high = p.z() - outline_.high_mm, end = std::max(low, high);
    if (end > within) return {};
    const OutlinePoint flat = nearest(p.head<2>());
    const Vec3 side_normal(flat.normal.x(), flat.normal.y(), 0.0);
    const Vec3 end_normal = low > high ? Vec3(-Vec3::UnitZ()) : Vec3::UnitZ();
    const double side = flat.distance;
    RawPoint at;
    at.distance_mm = std::hypot(std::max(side, 0.0), std::max(end, 0.0)) + std::min(std::max(side, end), 0.0);
    if (std::abs(at.distance_mm) > within) return {};
    at.normal = side > 0.0 && end > 0.0 ? Vec3((side * side_normal + end * end_normal) / at.distance_mm)
                : side >= end           ? side_normal
                                        : end_normal;
    at.foot = p - at.distance_mm * at.normal;
    return at;
  }

  void add_crossings(const Vec3& p, const Vec3& way, std::vector<double>& s) const override {
    if (way.z() != 0.0) {
      s.push_back((outline_.low_mm - p.z()) / way.z());
      s.push_back((outline_.high_mm - p.z()) / way.z());
    }
    const Vec2 d = way.head<2>();
    for (size_t i = 0; i < sides(); ++i) {
      const Vec2 from = corner(i) - p.head<2>(), along = corner(i + 1) - corner(i);
      const double across = d.x() * along.y() - d.y() * along.x();
      if (across == 0.0) continue;  // the sides beside it tell where the line passes
      const double u = (from.x() * d.y() - from.y() * d.x()) / across;
      if (u < -kBeyondEnd || u > 1.0 + kBeyondEnd) continue;
      s.push_back((from.x() * along.y() - from.y() * along.x()) / across);
    }
  }

  /// Walls by their parts in the square about the ball, ends by their rim there and by the disc's own end.
  RawExtent extent(const Vec3& centre, double radius, const Vec3& m) const override {
    RawExtent extent;
    const Vec2 c = centre.head<2>(), m_flat = m.head<2>();
    const double low = std::max(outline_.low_mm, centre.z() - radius);
    const double high = std::min(outline_.high_mm, centre.z() + radius);
    if (low > high) return extent;
    const auto add = [&](double flat, double z) { include(extent, flat + m.z() * z); };
    std::vector<double> ends;
    for (const double end : {outline_.low_mm, outline_.high_mm})
      if (std::abs(end - centre.z()) <= radius) ends.push_back(end);
    for (size_t i = 0; i < sides(); ++i) {
      const Vec2 &a = corner(i), way = corner(i + 1) - corner(i);
      const SidePart part = within_square(a, way, c, radius);
      if (part.from > part.to) continue;
      for (const double t : {part.from, part.to}) {
        add(m_flat.dot(a + t * way), low);
        add(m_flat.dot(a + t * way), high);
      }
    }
    const double across = m_flat.norm();
    for (const double side : {-1.0, 1.0}) {
      const Vec2 farthest = across > 0.0 ? Vec2(c + side * radius * m_flat / across) : c;
      if (ends.empty() || nearest(farthest).distance > 0.0) continue;
      for (const double end : ends) add(m_flat.dot(farthest), end);
    }
    return extent;
  }

  std::vector<RawFace> faces(const Vec3& centre, double radius) const override {
    std::vector<RawFace> faces;
    if (std::abs(outline_.high_mm - centre.z()) <= radius)
      faces.push_back({Vec3::UnitZ(), outline_.high_mm, outline_.high_mm});
    if (std::abs(outline_.low_mm - centre.z()) <= radius)
      faces.push_back({-Vec3::UnitZ(), -outline_.low_mm, -outline_.low_mm});
    for (size_t i = 0; i < sides() && faces.size() <= RawShape::kMostFaces; ++i) {
      const Vec2 &a = corner(i), way = corner(i + 1) - corner(i);
      const SidePart part = within_square(a, way, centre.head<2>(), radius);
      if (part.from > part.to) continue;
      const Vec2 out = Vec2(way.y(), -way.x()).normalized();
      const Vec2 b = corner(i + 1);
      faces.push_back(
          {{out.x(), out.y(), 0.0}, std::min(out.dot(a), out.dot(b)), std::max(out.dot(a), out.dot(b))});
    }
    return faces;
  }

  std::vector<RawPlace> places(double step) const override {
    std::vector<RawPlace> places;
    const double middle = 0.5 * (outline_.low_mm + outline_.high_mm);
    for (size_t i = 0; i < sides(); ++i) {
      const Vec2 &a = corner(i), way = corner(i + 1) - corner(i);
      const auto parts = static_cast<int>(std::clamp(std::ceil(way.norm() / step), 1.0, 1e5));
      for (int k = 0; k < parts; ++k) {
        const Vec2 p = a + (k + 0.5) / parts * way, out = Vec2(way.y(), -way.x()).normalized();
        places.push_back({{p.x(), p.y(), middle}, {out.x(), out.y(), 0.0}});
      }
    }
    const Vec2 rim = 0.5 * (corner(0) + corner(1));
    places.push_back({{rim.x(), rim.y(), outline_.high_mm}, Vec3::UnitZ()});
    return places;
  }

  std::string text() const override {
    Hash hash;
    for (const Vec2& p : outline_.points_mm) {
      hash.add(p.x());
      hash.add(p.y());
    }
    return fmt::format("outline of {} corners {}, z {} to {} mm", outline_.points_mm.size(), hash.text(),
                       outline_.low_mm, outline_.high_mm);
  }

 private:
  size_t sides() const { return outline_.points_mm.size(); }
  const Vec2& corner(size_t i) const { return outline_.points_mm[i % sides()]; }
  double height() const { return outline_.high_mm - outline_.low_mm; }

  OutlinePoint nearest(const Vec2& p) const {
    OutlinePoint best{std::numeric_limits<double>::infinity(), Vec2::Zero(), Vec2::UnitX()};
    bool inside = false;
    size_t nearest_side = 0;
    for (size_t i = 0; i < sides(); ++i) {
      const Vec2 &a = corner(i), &b = corner(i + 1), way = b - a;
      const double t = std::clamp((p - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
      const double distance = (p - a - t * way).norm();
      if (distance < best.distance) {
        best.distance = distance;
        best.foot = a + t * way;
        nearest_side = i;
      }
      const bool passes = (a.y() > p.y()) != (b.y() > p.y());
      if (passes && p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
    }
    const Vec2 way = corner(nearest_side + 1) - corner(nearest_side);
    best.normal = Vec2(way.y(), -way.x()).normalized();
    if (best.distance > 0.0) {
      const Vec2 away = (p - best.foot) / best.distance;
      best.normal = inside ? Vec2(-away) : away;
    }
    if (inside) best.distance = -best.distance;
    return best;
  }

  RawOutline outline_;  ///< counter-clockwise
  double area_ = 0.0, length_ = 0.0;
};

}  // namespace

std::shared_ptr<const RawBody> make_raw_outline(const RawOutline& outline) {
  return std::make_shared<RawOutlineBody>(outline);
}

}  // namespace swarf::stock
