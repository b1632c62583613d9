#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/hash.h"
#include "mesh/mesh_check.h"
#include "mesh/mesh_lines.h"
#include "mesh/mesh_ops.h"
#include "mesh/signed_distance.h"
#include "stock/raw/raw_body.h"

namespace swarf::stock {
namespace {

/// A facet cut down to a box has at most nine corners.
struct CutFacet {
  std::array<Vec3, 12> corners;
  size_t count = 0;
};

/// Keeps what lies on one side of a plane across an axis.
void keep(CutFacet& facet, int axis, double at, double side) {
  CutFacet kept;
  for (size_t i = 0; i < facet.count; ++i) {
    const Vec3 &p = facet.corners[i], &q = facet.corners[(i + 1) % facet.count];
    const double hp = side * (p[axis] - at), hq = side * (q[axis] - at);
    if (hp >= 0.0) kept.corners[kept.count++] = p;
    if ((hp > 0.0 && hq < 0.0) || (hp < 0.0 && hq > 0.0))
      kept.corners[kept.count++] = p + hp / (hp - hq) * (q - p);
  }
  facet = kept;
}

class RawMeshBody final : public RawBody {
 public:
  RawMeshBody(const TriMesh& mesh, const std::string& name)
      : name_(name),
        volume_(mesh::enclosed_volume(mesh)),
        surface_(mesh),
        lines_(surface_.mesh()),
        box_(mesh::bounds(surface_.mesh())) {
    for (uint32_t t = 0; t < facets(); ++t) area_ += facet_area(t);
  }

  Box box() const override { return box_; }
  std::vector<Vec3> corners() const override {
    std::vector<Vec3> corners;
    for (const auto& p : surface_.mesh().positions) corners.emplace_back(p[0], p[1], p[2]);
    return corners;
  }
  TriMesh mesh_around() const override { return surface_.mesh(); }
  double volume_mm3() const override { return volume_; }
  double area_mm2() const override { return area_; }
  /// Positions, normals, neighbours, both trees; Embree's takes most of it.
  size_t memory_bytes() const override { return size_t{400} * facets(); }

  RawPoint at(const Vec3& p, double within) const override {
    const mesh::SignedPoint seen = surface_.at(p, within);
    return {seen.distance_mm, seen.foot, seen.normal};
  }
  void add_crossings(const Vec3& p, const Vec3& way, std::vector<double>& s) const override {
    lines_.add_hits(p, way, s);
  }

  RawExtent extent(const Vec3& centre, double radius, const Vec3& m) const override {
    RawExtent extent;
    surface_.tree().each_near(centre, radius, [&](uint32_t t) {
      const CutFacet facet = part_in(centre, radius, t);
      for (size_t i = 0; i < facet.count; ++i) include(extent, m.dot(facet.corners[i]));
    });
    return extent;
  }

  std::vector<RawFace> faces(const Vec3& centre, double radius) const override {
    std::vector<RawFace> faces;
    surface_.tree().each_near(centre, radius, [&](uint32_t t) {
      if (faces.size() > RawShape::kMostFaces) return;
      const Vec3& n = surface_.face_normal(t);
      RawExtent extent;
      for (size_t i = 0; i < 3; ++i) include(extent, n.dot(surface_.corner(t, i)));
      const CutFacet part = part_in(centre, radius, t);
      if (part.count == 0) return;
      faces.push_back(
          {n, extent.least, extent.greatest, {part.corners.begin(), part.corners.begin() + part.count}});
    });
    return faces;
  }

  /// The middles of each facet's equal parts.
  std::vector<RawPlace> places(double step) const override {
    std::vector<RawPlace> places;
    for (uint32_t t = 0; t < facets(); ++t) {
      const Vec3 a = surface_.corner(t, 0), ab = surface_.corner(t, 1) - a, ac = surface_.corner(t, 2) - a;
      const double longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
      // As many as the area asks for: of a needle fewer than of a square with its longest side.
      const double wanted = std::min(longest / step, facet_area(t) / step / step + 1.0);
      const auto parts = static_cast<int>(std::clamp(std::ceil(wanted), 1.0, 256.0));
      for (int i = 0; i < parts; ++i) {
        for (int k = 0; i + k < parts; ++k) {
          const double u = (i + 1.0 / 3.0) / parts, v = (k + 1.0 / 3.0) / parts;
          places.push_back({a + u * ab + v * ac, surface_.face_normal(t)});
        }
      }
    }
    return places;
  }

  std::string text() const override {
    Hash hash;
    for (const auto& t : surface_.mesh().triangles) {
      for (const uint32_t v : t)
        for (const float x : surface_.mesh().positions[v]) hash.add(static_cast<double>(x) + 0.0);
    }
    return fmt::format("mesh {} of {} facets {}", name_, facets(), hash.text());
  }

 private:
  CutFacet part_in(const Vec3& centre, double radius, uint32_t t) const {
    CutFacet facet{{surface_.corner(t, 0), surface_.corner(t, 1), surface_.corner(t, 2)}, 3};
    for (int axis = 0; axis < 3 && facet.count > 0; ++axis) {
      keep(facet, axis, centre[axis] - radius, 1.0);
      keep(facet, axis, centre[axis] + radius, -1.0);
    }
    return facet;
  }
  uint32_t facets() const { return static_cast<uint32_t>(surface_.mesh().triangles.size()); }
  double facet_area(uint32_t t) const {
    const Vec3 a = surface_.corner(t, 0);
    return 0.5 * (surface_.corner(t, 1) - a).cross(surface_.corner(t, 2) - a).norm();
  }

  std::string name_;
  double volume_;
  mesh::SignedDistance surface_;
  mesh::MeshLines lines_;
  Box box_;
  double area_ = 0.0;
};

}  // namespace

std::shared_ptr<const RawBody> make_raw_mesh(const TriMesh& mesh_W, const std::string& name) {
  return std::make_shared<RawMeshBody>(mesh_W, name);
}

}  // namespace swarf::stock
