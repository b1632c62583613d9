// What pictures of a design of facets or CAD faces colour: each vertex what a measuring ray finds there,
// whatever the mesh's own error; walls, overhangs and what was never cut too.
#include "measure/vertex_rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "half_shaft.h"
#include "measure/seen_surface.h"
#include "mesh/plain_solids.h"
#include "stock/rays/surface_dexels.h"
#include "surface/analytic.h"

namespace swarf::measure {
namespace {

constexpr double kVertexSlack = 0.12;  // mm; 0.6 voxels of 0.2
/// As far as a vertex of the level set's mesh may be off, mm, and how exact its deviation is for all that,
/// um: a float of 3000 um.
constexpr double kOff = 0.008, kExactUm = 1e-3;

void add_vertex(TriMesh& mesh, const Vec3& p, const Vec3& normal) {
  const auto floats = [](const Vec3& v) {
    return std::array<float, 3>{static_cast<float>(v.x()), static_cast<float>(v.y()),
                                static_cast<float>(v.z())};
  };
  mesh.positions.push_back(floats(p));
  mesh.normals.push_back(floats(normal));
}

struct Place {
  Vec3 point, normal;
  double um;  ///< NaN: not measured
  const char* what;
};

/// A block whose top is z = 0, in a raw block 3 mm higher: faced for x < 5, with a hole of D2, 0.828 deep, at
/// (-3, 0), and under what stands beyond x = 5 a slot from z = 0 to z = 1.
const Box kRaw{{-10, -10, -8}, {10, 10, 3}};
constexpr double kHoleDepth = 0.828;

TriMesh design_block() {
  TriMesh mesh;
  mesh::add_box(mesh, {{-10, -10, -8}, {10, 10, 0}});
  return mesh;
}

void cut_block(stock::SurfaceDexels& dexels) {
  const stock::CutterSolid mill{5.0, 25.0}, drill{1.0, 25.0}, disc{4.0, 1.0};
  std::vector<stock::Sweep> rows;
  for (double y = -10.0; y <= 10.0; y += 4.0)
    rows.push_back(
        {{{-20, y, 0}, Vec3::UnitZ()}, {{0, y, 0}, Vec3::UnitZ()}, static_cast<uint32_t>(rows.size())});
  dexels.cut(rows, mill);
  dexels.cut(
      std::vector<stock::Sweep>{{{{-3, 0, 5}, Vec3::UnitZ()}, {{-3, 0, -kHoleDepth}, Vec3::UnitZ()}, 100}},
      drill);
  dexels.cut(std::vector<stock::Sweep>{{{{6, -20, 0}, Vec3::UnitZ()}, {{6, 20, 0}, Vec3::UnitZ()}, 101}},
             disc);
}

std::vector<Place> places_of_block() {
  const Vec3 up = Vec3::UnitZ(), in = Vec3::UnitX();
  const double none = std::numeric_limits<double>::quiet_NaN();
  return {{{0, 2, kOff}, up, 0.0, "the face"},
          {{-3.2, 0.1, -kHoleDepth - kOff}, up, -1e3 * kHoleDepth, "the hole's bottom"},
          {{-4 - kOff, 0, -0.4}, in, -400.0, "its wall"},
          {{8.5, 8, 3 - kOff}, up, 3000.0, "the raw top, above a gap"},
          {{8, 9, 1 + kOff}, -up, 1000.0, "the underside"},
          {{0, 5, 1.5}, up, none, "nothing is there"}};
}

TriMesh mesh_of(const std::vector<Place>& places) {
  TriMesh mesh;
  for (const Place& place : places) add_vertex(mesh, place.point, place.normal);
  return mesh;
}

void expect_deviations(const std::vector<Place>& places, const TriMesh& mesh, double within_um = kExactUm) {
  for (size_t i = 0; i < places.size(); ++i) {
    if (std::isnan(places[i].um))
      EXPECT_TRUE(std::isnan(mesh.deviation_um[i])) << places[i].what << ": " << mesh.deviation_um[i];
    else
      EXPECT_NEAR(mesh.deviation_um[i], places[i].um, within_um) << places[i].what;
  }
}

TEST(VertexRays, OverAMeshSayWhatTheSweepsLeft) {
  const TriMesh design = design_block();
  const stock::RayFieldPtr field = stock::rays_on_mesh(design, 1.0);
  const std::vector<Place> places = places_of_block();
  TriMesh mesh = mesh_of(places);
  deviation_by_vertex_rays({*field, stock::RawShape::of_box(kRaw), kVertexSlack, cut_block}, mesh);
  expect_deviations(places, mesh);
}

TEST(VertexRays, OverASurfaceSayTheSameOffItsFace) {
  const auto plane =
      std::make_shared<surface::PlaneSurface>(Vec3(-10, -10, 0), Vec3(20, 0, 0), Vec3(0, 20, 0));
  stock::SurfaceDexels dexels(plane, 0.2, kRaw);
  cut_block(dexels);
  const SeenSurface seen(dexels, kVertexSlack);
  const std::vector<Place> places = places_of_block();
  TriMesh mesh = mesh_of(places);
  std::vector<uint32_t> off_face;
  for (uint32_t i = 0; i < places.size(); ++i) {
    const auto here = seen.at(places[i].point, places[i].normal);
    EXPECT_EQ(here.has_value(), !std::isnan(places[i].um)) << places[i].what;
    mesh.deviation_um.push_back(here ? static_cast<float>(1e3 * here->deviation_mm)
                                     : std::numeric_limits<float>::quiet_NaN());
    if (here && !here->on_face) off_face.push_back(i);
  }
  EXPECT_EQ(off_face.size(), 3U) << "the hole's wall, the raw top and the underside";
  deviation_by_vertex_rays({dexels.field(), stock::RawShape::of_box(kRaw), kVertexSlack, cut_block}, seen,
                           off_face, mesh);
  expect_deviations(places, mesh);
}

/// A flat end .05 over the top of a shaft leaves a plane: at the angle a it lies (R + .05) / cos a - R above.
/// The facets' chords lie up to 15 um below the shaft.
TEST(VertexRays, OverACadFaceMeasureTheFace) {
  constexpr double kOver = 0.05;
  constexpr double kFootUm = 0.02;  // the foot is found by steps, on a slope of 12 degrees, half a mm below
  const HalfShaft shaft = half_shaft(40);
  const stock::RayFieldPtr field = stock::rays_on_mesh(shaft.mesh, 1.0, stock::kCrease, shaft.under);
  const auto cut = [=](stock::SurfaceDexels& dexels) {
    dexels.cut(
        std::vector<stock::Sweep>{{{{-20, 0, kOver}, Vec3::UnitZ()}, {{20, 0, kOver}, Vec3::UnitZ()}, 0}},
        stock::CutterSolid(9.0, 30.0));
  };
  std::vector<Place> places;
  for (double y = -4.2; y <= 4.2; y += 0.35) {
    for (const double off : {-kOff, 0.0, kOff}) {
      const Vec3 p = Vec3(0.3 * y, y, kOver + off).cast<float>().cast<double>();
      const double a = std::atan2(p.y(), kOver + kShaftRadius);  // on the plane, whatever the vertex is off
      places.push_back({p, Vec3::UnitZ(), 1e3 * ((kShaftRadius + kOver) / std::cos(a) - kShaftRadius),
                        "the plane over the shaft"});
    }
  }
  TriMesh mesh = mesh_of(places);
  deviation_by_vertex_rays({*field, stock::RawShape::of_box({{-5, -21, -21}, {5, 21, 2}}), kVertexSlack, cut},
                           mesh);
  expect_deviations(places, mesh, kFootUm);
}

}  // namespace
}  // namespace swarf::measure
