// Rays on meshes are as many as the pitch asks for, however the facets are cut, and none of the design is far
// from one.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <string>

#include "base/rng.h"
#include "stock/rays/ray_field.h"

namespace swarf::stock {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Facets by their corners; what is equal is welded by the rays themselves.
class Facets {
 public:
  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto first = static_cast<uint32_t>(mesh_.positions.size());
    for (const Vec3& p : {a, b, c})
      mesh_.positions.push_back(
          {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    mesh_.triangles.push_back({first, first + 1, first + 2});
  }
  /// From the lower edge (a, b) up by `height`, outward to the right of a -> b.
  void add_wall(const Vec3& a, const Vec3& b, double height) {
    const Vec3 up(0, 0, height);
    add(a, b, b + up);
    add(a, b + up, a + up);
  }
  const TriMesh& mesh() const { return mesh_; }

 private:
  TriMesh mesh_;
};

Vec3 on_circle(const Vec3& centre, double radius, int side, int sides) {
  const double angle = 2.0 * kPi * (side % sides + 0.5) / sides;
  return centre + radius * Vec3(std::cos(angle), std::sin(angle), 0.0);
}

/// The half of a plate 5 mm thick from x0 to x1, with a hole of 72 sides: needles fan out from the corners.
void add_half(Facets& facets, double x0, double x1) {
  constexpr int kSides = 72;
  constexpr double kHalf = 20.0, kThick = 5.0, kRadius = 6.0;
  const std::array<Vec3, 4> corners{{{x1, kHalf, 0}, {x0, kHalf, 0}, {x0, -kHalf, 0}, {x1, -kHalf, 0}}};
  const Vec3 down(0, 0, -kThick), centre(0.5 * (x0 + x1), 0, 0);
  const auto hole = [&](int i) { return on_circle(centre, kRadius, i, kSides); };
  const auto both_faces = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    facets.add(a, b, c);
    facets.add(a + down, c + down, b + down);
  };
  for (int i = 0; i < kSides; ++i) {
    both_faces(corners[static_cast<size_t>(4 * i / kSides)], hole(i + 1), hole(i));
    facets.add_wall(hole(i + 1) + down, hole(i) + down, kThick);
  }
  for (size_t k = 0; k < 4; ++k)
    both_faces(corners[k], corners[(k + 1) % 4], hole(static_cast<int>(k + 1) * kSides / 4));
  facets.add_wall(corners[2] + down, corners[3] + down, kThick);
  facets.add_wall(corners[0] + down, corners[1] + down, kThick);
}

TriMesh drilled_plate() {
  Facets facets;
  add_half(facets, -30.0, 0.0);
  add_half(facets, 0.0, 30.0);
  const Vec3 a(30, -20, -5), b(30, 20, -5), c(-30, 20, -5), d(-30, -20, -5);
  facets.add_wall(a, b, 5.0);
  facets.add_wall(c, d, 5.0);
  return facets.mesh();
}

/// A shaft of 360 facets, each as long as the shaft, with caps that fan out from a corner.
TriMesh shaft() {
  constexpr int kSides = 360;
  Facets facets;
  const Vec3 up(0, 0, 50);
  const auto foot = [](int i) { return on_circle(Vec3::Zero(), 10.0, i, kSides); };
  for (int i = 0; i < kSides; ++i) {
    facets.add_wall(foot(i), foot(i + 1), 50.0);
    if (i == 0 || i + 1 == kSides) continue;
    facets.add(foot(0), foot(i + 1), foot(i));
    facets.add(foot(0) + up, foot(i) + up, foot(i + 1) + up);
  }
  return facets.mesh();
}

/// z = 20 cos(x/20) cos(y/30) over 40 x 40 mm in steps.
TriMesh bowl(double step) {
  Facets facets;
  const auto at = [&](int i, int j) {
    const double x = step * i - 20.0, y = step * j - 20.0;
    return Vec3(x, y, 20.0 * std::cos(x / 20.0) * std::cos(y / 30.0));
  };
  const int steps = static_cast<int>(std::lround(40.0 / step));
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      facets.add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      facets.add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return facets.mesh();
}

struct Design {
  const char* name;
  TriMesh mesh;
};

const std::vector<Design>& designs() {
  static const std::vector<Design> all{{"drilled plate", drilled_plate()},
                                       {"shaft", shaft()},
                                       {"bowl in steps of 1 mm", bowl(1.0)},
                                       {"bowl in steps of 0.2 mm", bowl(0.2)}};
  return all;
}

double area_of(const RayField& field) {
  return std::accumulate(field.areas_mm2.begin(), field.areas_mm2.end(), 0.0);
}

TEST(RayDensity, AsManyAsThePitchAsksFor) {
  constexpr double kLeast = 0.7, kMost = 1.5;  // rays per square of the pitch
  for (const Design& design : designs()) {
    for (const double pitch : {0.25, 0.5, 1.0}) {
      const RayFieldPtr field = rays_on_mesh(design.mesh, pitch);
      const double asked = area_of(*field) / (pitch * pitch),
                   share = static_cast<double>(field->size()) / asked;
      EXPECT_LE(share, kMost) << design.name << " at " << pitch;
      EXPECT_GE(share, kLeast) << design.name << " at " << pitch;
    }
  }
}

/// A place on a facet picked with chances by area, or on one of its sides.
FacetPlace random_place(const FacetSheets& sheets, uint32_t facet, Rng& rng) {
  double u = rng.uniform(), v = rng.uniform();
  if (u + v > 1.0) {
    u = 1.0 - u;
    v = 1.0 - v;
  }
  if (rng.uniform() < 0.3) v = 0.0;
  return sheets.place(facet, {1.0 - u - v, u, v});
}

TEST(RayDensity, EveryPlaceIsNearARayOfItsSheet) {
  constexpr uint64_t kSeed = 11;
  constexpr double kPitch = 0.5, kRounding = 1e-9;
  Rng rng(kSeed);
  for (const Design& design : designs()) {
    const RayFieldPtr field = rays_on_mesh(design.mesh, kPitch);
    const FacetSheets& sheets = *field->sheets;
    double farthest = 0.0;
    for (int n = 0; n < 400; ++n) {
      const auto facet = static_cast<uint32_t>(rng.next() % sheets.facets.size());
      const FacetPlace place = random_place(sheets, facet, rng);
      double least = 1e9;
      for (uint32_t ray = 0; ray < field->size(); ++ray) {
        if (sheets.sheet[field->facet_of[ray]] == sheets.sheet[facet])
          least = std::min(least, (field->points[ray] - place.point).norm());
      }
      ASSERT_LE(least, kFarthestRay * kPitch + kRounding)
          << design.name << ", seed " << kSeed << ": facet " << facet << " at (" << place.point.x() << ", "
          << place.point.y() << ", " << place.point.z() << ")";
      farthest = std::max(farthest, least);
    }
    RecordProperty(design.name, std::to_string(farthest / kPitch));
  }
}

TEST(RayDensity, AreasAreSharedAndNeighboursHangTogether) {
  for (const Design& design : designs()) {
    const RayFieldPtr field = rays_on_mesh(design.mesh, 0.5);
    const FacetSheets& sheets = *field->sheets;
    double area = 0.0;
    for (uint32_t f = 0; f < sheets.facets.size(); ++f) {
      const Vec3& a = sheets.corner(f, 0);
      area += 0.5 * (sheets.corner(f, 1) - a).cross(sheets.corner(f, 2) - a).norm();
    }
    EXPECT_NEAR(area_of(*field), area, 1e-9 * area) << design.name;
    for (const double share : field->areas_mm2) {
      ASSERT_GT(share, 0.0) << design.name;
      ASSERT_LE(share, 3.0 * 0.25) << design.name;
    }
    std::vector<uint32_t> parent(field->size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&](uint32_t n) {
      while (parent[n] != n) n = parent[n] = parent[parent[n]];
      return n;
    };
    size_t pieces = field->size();
    for (const auto& [a, b] : field->edges) {
      ASSERT_EQ(sheets.sheet[field->facet_of[a]], sheets.sheet[field->facet_of[b]]) << design.name;
      pieces -= root(a) != root(b) ? 1 : 0;
      parent[root(a)] = root(b);
    }
    const std::set<uint32_t> asked(sheets.sheet.begin(), sheets.sheet.end());
    EXPECT_EQ(pieces, asked.size()) << design.name;
  }
}

/// Half way between two rays, and where a ray's foot is displaced to, is on the design: rays span the facets
/// between them.
TEST(RayDensity, PlacesBetweenRaysAreOnTheFacets) {
  const RayFieldPtr field = rays_on_mesh(shaft(), 1.0);
  const double inner = 10.0 * std::cos(kPi / 360.0);
  constexpr double kFloat = 1e-6;  // mm: vertices are floats
  size_t on_wall = 0;
  for (const auto& [a, b] : field->edges) {
    if (std::abs(field->normals[a].z()) > 0.5) continue;
    ++on_wall;
    const Foot foot = field->between(a, b, 0.5);
    const double radius = foot.point.head<2>().norm();
    ASSERT_GE(radius, inner - kFloat);
    ASSERT_LE(radius, 10.0 + kFloat);
    ASSERT_LE(std::abs(foot.normal.z()), kFloat);
    const Vec3 aside = 0.7 * Vec3(-field->normals[a].y(), field->normals[a].x(), 0.0);
    const auto moved = field->displaced(a, aside);
    ASSERT_TRUE(moved.has_value());
    ASSERT_GE(moved->point.head<2>().norm(), inner - kFloat);
    ASSERT_LE(moved->point.head<2>().norm(), 10.0 + kFloat);
    ASSERT_NEAR((moved->point - field->points[a]).dot(aside), aside.squaredNorm(), kFloat);
  }
  EXPECT_GT(on_wall, 3000u);
}

/// Where the design is the stock's own face, nothing stands above it: not the last digit of its rays.
TEST(RayDensity, RaysStandInThePlanesOfTheirFacets) {
  const RayFieldPtr field = rays_on_mesh(drilled_plate(), 0.3);
  for (uint32_t ray = 0; ray < field->size(); ++ray) {
    const Vec3 &p = field->points[ray], &n = field->normals[ray];
    if (std::abs(n.z()) > 0.9) ASSERT_TRUE(p.z() == 0.0 || p.z() == -5.0) << p.transpose();
    ASSERT_TRUE(p.z() <= 0.0 && p.z() >= -5.0 && std::abs(p.x()) <= 30.0 && std::abs(p.y()) <= 20.0)
        << p.transpose();
  }
}

/// A fillet far smaller than the pitch keeps rays around its turn.
TEST(RayDensity, FilletsKeepTheirRays) {
  Facets facets;
  constexpr int kSides = 18;
  const auto at = [&](int i, double y) {
    const double angle = 0.5 * kPi * i / kSides;
    return Vec3(0.2 * std::sin(angle), y, 0.2 * std::cos(angle));
  };
  for (int i = 0; i < kSides; ++i) {
    facets.add(at(i, 0), at(i + 1, 0), at(i + 1, 10));
    facets.add(at(i, 0), at(i + 1, 10), at(i, 10));
  }
  const RayFieldPtr field = rays_on_mesh(facets.mesh(), 1.0);
  // No place turns by more than the crease angle from all rays within reach.
  for (double y = 0.0; y <= 10.0; y += 0.25) {
    for (double angle = 0.0; angle <= 0.5 * kPi; angle += 0.05) {
      const Vec3 normal(std::sin(angle), 0, std::cos(angle));
      double best = -1.0;
      for (uint32_t ray = 0; ray < field->size(); ++ray) {
        if ((field->points[ray] - Vec3(0.2 * normal.x(), y, 0.2 * normal.z())).norm() <= kFarthestRay)
          best = std::max(best, normal.dot(field->normals[ray]));
      }
      // The normal of the nearest place that was offered differs by one facet at most.
      ASSERT_GE(best, std::cos(kCrease + 0.5 * kPi / kSides)) << y << " " << angle;
    }
  }
}

}  // namespace
}  // namespace swarf::stock
