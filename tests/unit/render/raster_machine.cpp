// The shipped machine's meshes, as every renderer gets them.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "mesh/mesh_enclosed.h"
#include "mesh/mesh_io.h"
#include "raster_scene.h"
#include "render/raster/raster_renderer.h"

namespace swarf::render::raster_machine {
namespace {

constexpr const char* kParts[] = {"bed",          "column",  "x_slide", "cradle",
                                  "rotary_table", "fixture", "y_slide", "spindle_head"};

TriMesh load_part(const std::string& name) {
  return mesh::load_mesh(SWARF_SOURCE_DIR "/assets/machines/lin_koren_xyzab/" + name + ".ply");
}

Vec3 at(const std::vector<std::array<float, 3>>& list, uint32_t i) {
  return {list[i][0], list[i][1], list[i][2]};
}

/// Share of the area whose vertex normals all lean less than 60 degrees from the face.
double well_lit_share(const TriMesh& mesh) {
  double good = 0.0, all = 0.0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = at(mesh.positions, t[0]), b = at(mesh.positions, t[1]), c = at(mesh.positions, t[2]);
    const Vec3 area = 0.5 * (b - a).cross(c - a);
    bool agrees = true;
    for (const uint32_t i : t) agrees = agrees && area.dot(at(mesh.normals, i)) > 0.5 * area.norm();
    all += area.norm();
    good += agrees ? area.norm() : 0.0;
  }
  return good / all;
}

TEST(MachineMeshes, HaveColoursAndUnitNormalsThatPointOutward) {
  size_t triangles = 0;
  for (const char* name : kParts) {
    const TriMesh mesh = load_part(name);
    triangles += mesh.triangles.size();
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size()) << name;
    ASSERT_EQ(mesh.colours.size(), mesh.positions.size()) << name;
    for (uint32_t i = 0; i < mesh.normals.size(); ++i) {
      ASSERT_NEAR(at(mesh.normals, i).norm(), 1.0, 1e-5) << name << " vertex " << i;
    }
    EXPECT_GT(well_lit_share(mesh), 0.999) << name;
  }
  EXPECT_LT(triangles, 60000U);  // what a software rasteriser draws within a frame
}

TEST(MachineMeshes, TheJobsAreaIsFreeOfFixedParts) {
  // Whatever turns with the cradle stays within 226 mm of the A axis and above z = -200 (the script's
  // promise).
  for (const char* name : {"cradle", "rotary_table", "fixture"}) {
    for (const auto& p : load_part(name).positions) {
      EXPECT_LT(std::hypot(p[1], p[2]), 226.0F) << name;
      EXPECT_LT(std::abs(p[0]), 170.0F) << name;
    }
  }
  for (const auto& p : load_part("column").positions) EXPECT_GT(p[1], 399.0F);
  for (const auto& p : load_part("y_slide").positions) EXPECT_GT(p[2], 238.0F);
  for (const auto& p : load_part("bed").positions) EXPECT_LT(p[2], -230.0F);
  for (const auto& p : load_part("fixture").positions) {  // outside the stock, below its clamping height
    const bool beside = p[0] < -42.99F || p[0] > 58.99F || p[1] < 55.01F || p[1] > 136.99F;
    EXPECT_TRUE(p[2] <= 100.01F || (beside && p[2] <= 108.0F)) << p[0] << " " << p[1] << " " << p[2];
  }
}

TEST(MachineMeshes, FillAPictureWithContrast) {
  std::vector<TriMesh> parts;
  for (const char* name : kParts) parts.push_back(load_part(name));
  DrawList list;
  list.camera = look_at_box({{-560, -230, -540}, {560, 920, 1046}}, {0.55, 0.8, -0.4}, 0.5, 1.6);
  for (const TriMesh& part : parts) list.items.push_back(item(part, {0.7F, 0.7F, 0.7F}));
  RasterRenderer renderer(320, 200);
  const Image machine = renderer.draw(list);
  int dark = 0, bright = 0, blue = 0;
  for (size_t i = 0; i < machine.rgba.size(); i += 4) {
    const int r = machine.rgba[i], b = machine.rgba[i + 2];
    dark += r < 80 && b < 100 ? 1 : 0;
    bright += r > 170 ? 1 : 0;
    blue += b > r + 40 ? 1 : 0;
  }
  EXPECT_GT(dark, 1000);    // motors, panels, plinth
  EXPECT_GT(bright, 5000);  // paint and background
  EXPECT_GT(blue, 200);     // the cradle
}

/// From outside and from within: in the column, and with the near plane through it.
TEST(MachineMeshes, LookTheSameWithoutWhatIsEnclosed) {
  std::vector<TriMesh> parts;
  std::vector<mesh::Enclosed> enclosed;
  size_t left_out = 0, triangles = 0;
  for (const char* name : kParts) {
    parts.push_back(load_part(name));
    enclosed.push_back(mesh::find_enclosed(parts.back()));
    left_out += static_cast<size_t>(
        std::count(enclosed.back().facets.begin(), enclosed.back().facets.end(), uint8_t{1}));
    triangles += parts.back().triangles.size();
  }
  EXPECT_GT(left_out, triangles / 6);
  DrawList list;
  for (const TriMesh& part : parts) list.items.push_back(item(part, {0.7F, 0.7F, 0.7F}));
  RasterRenderer smooth(240, 150, 4), fast(240, 150, 1);
  const auto look = [&](const Camera& camera) {
    list.camera = camera;
    Image seen[2];
    for (RasterRenderer* renderer : {&smooth, &fast}) {
      for (size_t known = 0; known < 2; ++known) {
        for (size_t i = 0; i < parts.size(); ++i)
          list.items[i].enclosed = known != 0 ? &enclosed[i] : nullptr;
        seen[known] = renderer->draw(list);
      }
      // The eye's place tells which: a picture's bytes fill a screen.
      EXPECT_TRUE(seen[0].rgba == seen[1].rgba) << camera.eye.transpose();
    }
  };
  for (const Vec3& from :
       {Vec3(0.55, 0.8, -0.4), Vec3(-0.8, 0.3, -0.3), Vec3(0.1, -0.9, -0.2), Vec3(0, 0.1, 1)})
    look(look_at_box({{-560, -230, -540}, {560, 920, 1046}}, from, 0.5, 1.6));
  for (const Vec3& eye : {Vec3(300, -500, 300), Vec3(0, 600, 0), Vec3(0, 412, 100), Vec3(100, -200, -150)})
    look({eye, Vec3(0, 96, 120)});
}

}  // namespace
}  // namespace swarf::render::raster_machine
