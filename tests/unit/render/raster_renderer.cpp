#include "render/raster/raster_renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <future>

#include "base/check.h"
#include "mesh/mesh_enclosed.h"
#include "raster_scene.h"
#include "render/raster/depth_range.h"

namespace swarf::render::raster_renderer {
namespace {

constexpr int kWidth = 320, kHeight = 200;
constexpr Rgb kRed{0.8F, 0.05F, 0.05F}, kGreen{0.05F, 0.6F, 0.05F};

/// From the front, level: x to the right, z up.
Camera front(double distance, double fov = 0.6) {
  Camera camera;
  camera.eye = {0, -distance, 0};
  camera.vertical_fov_rad = fov;
  return camera;
}

TEST(RasterRenderer, DrawsThingsWhereTheyAre) {
  const TriMesh right = box_mesh({{20, -5, 10}, {30, 5, 20}}),
                left = box_mesh({{-30, -5, -20}, {-20, 5, -10}});
  DrawList list;
  list.camera = front(200);
  list.items = {item(right, kRed), item(left, kGreen)};
  const Image image = RasterRenderer(kWidth, kHeight).draw(list);
  ASSERT_EQ(image.rgba.size(), size_t{4} * kWidth * kHeight);
  const double px_per_mm = 0.5 * kHeight / std::tan(0.3) / 200;
  const auto at = [&](double x, double z) {
    return pixel(image, static_cast<int>(0.5 * kWidth + x * px_per_mm),
                 static_cast<int>(0.5 * kHeight - z * px_per_mm));
  };
  const Pixel red = at(25, 15), green = at(-25, -15);
  EXPECT_GT(red.r, 2 * red.g);
  EXPECT_GT(red.r, 90);
  EXPECT_GT(green.g, 2 * green.r);
  const Pixel neither = at(25, -15);
  EXPECT_LT(std::abs(neither.r - neither.b), 30);  // backdrop: nearly grey
}

TEST(RasterRenderer, CoversTheAreaThatPerspectiveGives) {
  const TriMesh box = box_mesh({{-30, 0, -20}, {30, 10, 20}});
  DrawList list;
  list.camera = front(150);
  list.items = {item(box, kRed)};
  const Image image = RasterRenderer(kWidth, kHeight).draw(list);
  int covered = 0;
  for (size_t i = 0; i < image.rgba.size(); i += 4) covered += image.rgba[i] > image.rgba[i + 2] + 40 ? 1 : 0;
  const double px_per_mm = 0.5 * kHeight / std::tan(0.3) / 150;  // of the front face at y = 0
  const double expected = 60 * 40 * px_per_mm * px_per_mm;
  // The rim is smoothed: at most a pixel of its length is in doubt.
  EXPECT_NEAR(covered, expected, 2 * (60 + 40) * px_per_mm);
}

TEST(RasterRenderer, GivesTheSameBytesEveryTime) {
  const TriMesh box = box_mesh({{-30, -20, -20}, {30, 20, 20}});
  DrawList list;
  list.camera = look_at_box({{-30, -20, -20}, {30, 20, 20}}, {-1, 2, -1}, 0.5, 1.6);
  list.items = {item(box, kRed)};
  list.lines.push_back({{{-40, -25, 0}, {40, -25, 5}, {40, 25, 9}}, {1, 1, 0}, 2.0F});
  RasterRenderer one(kWidth, kHeight), two(kWidth, kHeight);
  const Image first = one.draw(list);
  EXPECT_EQ(first.rgba, one.draw(list).rgba);
  EXPECT_EQ(first.rgba, two.draw(list).rgba);
}

/// A scene that looks otherwise from each side, with lines, near enough that its front is cut off by the near
/// plane where `distance` is small.
DrawList two_boxes(const TriMesh& near, const TriMesh& far, double distance) {
  DrawList list;
  list.camera = front(distance);
  list.camera.eye += Vec3(0.4 * distance, 0, 0.3 * distance);
  list.items = {item(near, kRed), item(far, kGreen)};
  list.items[1].X_world.translate(Vec3(0, 35, 4));
  list.lines.push_back({{{-40, -25, 0}, {40, -25, 5}, {40, 25, 9}}, {1, 1, 0}, 2.0F});
  return list;
}

TEST(RasterRenderer, WhatEarlierFramesLeftBehindIsNotSeen) {
  const TriMesh small = box_mesh({{-9, -7, -5}, {9, 7, 5}}),
                large = box_mesh({{-30, -20, -20}, {30, 20, 20}});
  std::vector<DrawList> lists{two_boxes(small, large, 60), two_boxes(large, small, 300),
                              two_boxes(small, small, 25), two_boxes(large, small, 90)};
  lists[1].section = SectionPlane{{0, 0, 3}, Vec3::UnitZ()};
  lists[1].items[0].sectioned = true;
  for (const int samples : {1, 4}) {
    std::vector<Image> alone;
    for (const DrawList& list : lists) alone.push_back(RasterRenderer(kWidth, kHeight, samples).draw(list));
    RasterRenderer renderer(kWidth, kHeight, samples);
    // Every list in every range, after every other one.
    for (int frame = 0; frame < 5 * kDepthRanges; ++frame) {
      const size_t one = static_cast<size_t>(frame + frame / 4 + frame / 16) % lists.size();
      ASSERT_EQ(renderer.draw(lists[one]).rgba, alone[one].rgba) << samples << " samples, frame " << frame;
    }
  }
}

TEST(DepthRange, EachLiesBeforeTheOneBefore) {
  EXPECT_EQ(depth_range(0).farthest, 1.0F);
  for (int frame = 1; frame < kDepthRanges; ++frame) {
    const DepthRange range = depth_range(frame), before = depth_range(frame - 1);
    EXPECT_LE(2.0F * range.farthest, before.nearest) << frame;
    EXPECT_EQ(range.nearest * 16.0F, before.nearest) << "by powers of two only";
    EXPECT_EQ(range.farthest * 16.0F, before.farthest);
  }
}

TEST(RasterRenderer, SmoothsEdgesByItsSamples) {
  const TriMesh box = box_mesh({{-30, -20, -20}, {30, 20, 20}});
  DrawList list;
  list.camera = look_at_box({{-60, -40, -40}, {60, 40, 40}}, {-1, 2, -0.7}, 0.5, 1.6);
  list.items = {item(box, kRed)};
  const auto half_red = [](const Image& image) {
    int count = 0;
    for (size_t i = 0; i < image.rgba.size(); i += 4) {
      const int over = image.rgba[i] - image.rgba[i + 2];
      count += over > 15 && over < 60 ? 1 : 0;
    }
    return count;
  };
  EXPECT_GT(half_red(RasterRenderer(kWidth, kHeight, 4).draw(list)),
            half_red(RasterRenderer(kWidth, kHeight, 1).draw(list)) + 50);
  EXPECT_THROW(RasterRenderer(kWidth, kHeight, 1000), InternalError);
}

TEST(RasterRenderer, NoticesChangedAndMovedMeshes) {
  TriMesh box = box_mesh({{-10, -10, -10}, {10, 10, 10}});
  DrawList list;
  list.camera = front(150);
  list.items = {item(box, kRed)};
  RasterRenderer renderer(kWidth, kHeight);
  const Image before = renderer.draw(list);
  box = box_mesh({{-20, -10, -20}, {20, 10, 20}});
  const Image grown = renderer.draw(list);
  EXPECT_NE(before.rgba, grown.rgba);
  list.items[0].dynamic = true;
  box = box_mesh({{-10, -10, -10}, {10, 10, 10}});
  EXPECT_EQ(before.rgba, renderer.draw(list).rgba);
  list.items[0].X_world.translation() = Vec3(20, 0, 0);
  EXPECT_NE(before.rgba, renderer.draw(list).rgba);
}

TEST(RasterRenderer, ARevisionSaysWhatChanged) {
  TriMesh box = box_mesh({{-10, -10, -10}, {10, 10, 10}});
  DrawList list;
  list.camera = front(150);
  list.items = {item(box, kRed)};
  list.items[0].revision = 1;
  list.items[0].outside_only = true;
  RasterRenderer renderer(kWidth, kHeight);
  const Image before = renderer.draw(list);
  box = box_mesh({{-20, -10, -20}, {20, 10, 20}});
  EXPECT_EQ(before.rgba, renderer.draw(list).rgba);  // it was not said
  list.items[0].revision = 2;
  EXPECT_NE(before.rgba, renderer.draw(list).rgba);
}

/// A hollow-free box cut open by a plane through its middle: its face is painted, the other half is gone.
TEST(RasterRenderer, ASectionOpensWhatItCuts) {
  const TriMesh box = box_mesh({{-20, -10, -10}, {20, 10, 10}});
  DrawList list;
  list.camera = front(150);
  list.items = {item(box, kGreen)};
  list.items[0].sectioned = true;
  RasterRenderer renderer(kWidth, kHeight);
  const Pixel whole = pixel(renderer.draw(list), kWidth / 2, kHeight / 2);
  EXPECT_GT(whole.g, 2 * whole.r);
  list.section = SectionPlane{{0, 0, 0}, {0, -1, 0}};  // what lies towards the eye is taken away
  const Pixel face = pixel(renderer.draw(list), kWidth / 2, kHeight / 2);
  EXPECT_GT(face.r, 2 * face.b);
  EXPECT_GT(face.r, face.g);
  list.section = SectionPlane{{0, -20, 0}, {0, -1, 0}};  // before the box
  const Pixel uncut = pixel(renderer.draw(list), kWidth / 2, kHeight / 2);
  EXPECT_GT(uncut.g, 2 * uncut.r);
  list.items[0].sectioned = false;
  list.section = SectionPlane{{0, 0, 0}, {0, -1, 0}};
  EXPECT_GT(pixel(renderer.draw(list), kWidth / 2, kHeight / 2).g, 2 * face.g / 3);
}

TEST(RasterRenderer, TwoAtOnceGiveTheSameBytesAsOne) {
  const TriMesh box = box_mesh({{-30, -20, -20}, {30, 20, 20}});
  DrawList list;
  list.camera = look_at_box({{-30, -20, -20}, {30, 20, 20}}, {-1, 2, -1}, 0.5, 1.6);
  list.items = {item(box, kRed)};
  RasterRenderer one(kWidth, kHeight), two(kWidth, kHeight), alone(kWidth, kHeight);
  const Image expected = alone.draw(list);
  for (int i = 0; i < 20; ++i) {
    auto first = std::async(std::launch::async, [&] { return one.draw(list); });
    auto second = std::async(std::launch::async, [&] { return two.draw(list); });
    EXPECT_EQ(first.get().rgba, expected.rgba);
    EXPECT_EQ(second.get().rgba, expected.rgba);
  }
}

TEST(RasterRenderer, VertexColoursWinOverTheMaterial) {
  TriMesh box = box_mesh({{-10, -10, -10}, {10, 10, 10}});
  box.colours.assign(box.positions.size(), {10, 200, 10, 255});
  DrawList list;
  list.camera = front(100);
  list.items = {item(box, kRed)};
  const Pixel centre = pixel(RasterRenderer(kWidth, kHeight).draw(list), kWidth / 2, kHeight / 2);
  EXPECT_GT(centre.g, 2 * centre.r);
}

TEST(RasterRenderer, NormalsChangeTheShadeOfAFace) {
  TriMesh box = box_mesh({{-10, -10, -10}, {10, 10, 10}});
  DrawList list;
  list.camera = front(100);
  list.items = {item(box, {0.5F, 0.5F, 0.5F})};
  RasterRenderer renderer(kWidth, kHeight);
  const int flat = pixel(renderer.draw(list), kWidth / 2, kHeight / 2).r;
  box.normals.assign(box.positions.size(), {0.0F, -0.3F, 0.953939F});  // leaning towards the light above
  const int lit = pixel(renderer.draw(list), kWidth / 2, kHeight / 2).r;
  EXPECT_GT(lit, flat + 10);
}

TEST(RasterRenderer, LinesHaveTheirColourWidthAndDepth) {
  const TriMesh box = box_mesh({{-10, -10, -10}, {10, 10, 10}});
  DrawList list;
  list.camera = front(200);
  list.items = {item(box, {0.2F, 0.2F, 0.2F})};
  list.lines.push_back({{{-90, -12, 0}, {90, -12, 0}}, {1, 0, 0}, 6.0F});   // in front of the box
  list.lines.push_back({{{-90, 12, 5}, {90, 12, 5}}, {0, 1, 0}, 6.0F});     // behind it
  list.lines.push_back({{{0, -500, -5}, {0, -400, -5}}, {0, 0, 1}, 6.0F});  // behind the eye
  const Image image = RasterRenderer(kWidth, kHeight).draw(list);
  int red_rows = 0, green = 0, blue = 0;
  for (int y = 0; y < kHeight; ++y) {
    const Pixel p = pixel(image, kWidth / 2, y);
    red_rows += p.r > 200 && p.g < 60 ? 1 : 0;
    green += p.g > 200 && p.r < 60 ? 1 : 0;
    blue += p.b > 200 && p.r < 60 ? 1 : 0;
  }
  EXPECT_NEAR(red_rows, 6, 1);
  EXPECT_EQ(green, 0);
  EXPECT_EQ(blue, 0);
  const int beside = kHeight / 2 - static_cast<int>(5 * 0.5 * kHeight / std::tan(0.3) / 212);
  EXPECT_GT(pixel(image, kWidth / 2 + 60, beside).g, 200);  // the second line, where the box does not hide it
}

TEST(RasterRenderer, TheKeyLightCastsAShadow) {
  const TriMesh plate = box_mesh({{-60, -60, -2}, {60, 60, 0}}),
                roof = box_mesh({{-20, -20, 30}, {20, 20, 34}});
  DrawList list;
  list.camera = look_at_box({{-60, -60, -2}, {60, 60, 34}}, {0, 1, -1.2}, 0.5, 1.6);
  list.items = {item(plate, {0.5F, 0.5F, 0.5F})};
  RasterRenderer renderer(kWidth, kHeight);
  const auto darkest_plate = [&] {
    const Image image = renderer.draw(list);
    int darkest = 255;
    for (int y = kHeight / 3; y < 2 * kHeight / 3; ++y) {
      for (int x = kWidth / 3; x < 2 * kWidth / 3; ++x) darkest = std::min(darkest, pixel(image, x, y).r);
    }
    return darkest;
  };
  const int lit = darkest_plate();
  list.items.push_back(item(roof, {0.9F, 0.9F, 0.9F}));
  EXPECT_LT(darkest_plate(), lit - 30);
}

TEST(RasterRenderer, AnEmptyListIsABackdrop) {
  const Image image = RasterRenderer(kWidth, kHeight).draw(DrawList{});
  for (const int y : {0, kHeight / 2, kHeight - 1}) {
    const Pixel p = pixel(image, kWidth / 2, y);
    EXPECT_GT(p.r, 120);
    EXPECT_LT(std::abs(p.r - p.b), 30);
  }
  EXPECT_GT(pixel(image, 0, 0).r, pixel(image, 0, kHeight - 1).r);  // lighter above
}

/// The floor's triangle covers the picture; where no floor is seen it must not show.
TEST(RasterRenderer, AboveTheFloorIsTheBackdrop) {
  RasterRenderer renderer(kWidth, kHeight);
  const Image backdrop = renderer.draw(DrawList{});
  const TriMesh box = box_mesh({{-10, -10, -10}, {10, 10, 10}});
  DrawList list;
  list.items = {item(box, kRed)};
  list.camera = front(200);
  const Image level = renderer.draw(list);
  const size_t row = size_t{4} * kWidth;
  for (size_t i = 0; i < row * (kHeight / 4); ++i) ASSERT_EQ(level.rgba[i], backdrop.rgba[i]) << i;
  list.camera.eye = {1, 0, 60};  // above the middle of the floor, looking up
  list.camera.target = {1, 0, 200};
  list.camera.up = Vec3::UnitY();
  EXPECT_EQ(renderer.draw(list).rgba, backdrop.rgba);
}

/// The eye stands between its walls: what is behind it is cut away, and no triangle is turned inside out.
TEST(RasterRenderer, WhatReachesBehindTheEyeIsCutOff) {
  const TriMesh tunnel = box_mesh({{-20, -300, -20}, {20, 300, -15}});
  DrawList list;
  list.camera = front(100);
  list.items = {item(tunnel, kRed)};
  const Image image = RasterRenderer(kWidth, kHeight).draw(list);
  EXPECT_GT(pixel(image, kWidth / 2, kHeight - 1).r, 90);
  EXPECT_LT(std::abs(pixel(image, kWidth / 2, 0).r - pixel(image, kWidth / 2, 0).b), 30);
}

/// Sizes that are no multiple of a tile: the same place has the same colour.
TEST(RasterRenderer, OddSizesAreWholePictures) {
  const TriMesh wall = box_mesh({{-500, 0, -500}, {500, 10, 500}});
  DrawList list;
  list.camera = front(100);
  list.items = {item(wall, kRed)};
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(67, 35), std::pair(131, 97)}) {
    const Image image = RasterRenderer(width, height).draw(list);
    ASSERT_EQ(image.rgba.size(), size_t{4} * width * height);
    for (size_t i = 0; i < image.rgba.size(); i += 4) {
      ASSERT_GT(image.rgba[i], 90) << i / 4 << " of " << width << " x " << height;
      ASSERT_EQ(image.rgba[i + 3], 255);
    }
  }
}

/// Not even its corners lie in the picture.
TEST(RasterRenderer, WhatIsGreaterThanThePictureIsDrawn) {
  const TriMesh wall = box_mesh({{-500, 0, -500}, {500, 10, 500}});
  DrawList list;
  list.camera = front(100);
  list.items = {item(wall, kRed)};
  const Image image = RasterRenderer(kWidth, kHeight).draw(list);
  for (const int x : {0, kWidth / 2, kWidth - 1}) EXPECT_GT(pixel(image, x, kHeight / 2).r, 90);
}

TEST(RasterRenderer, LeavesOutWhatIsEnclosedWhereItIsNotSeen) {
  TriMesh both = box_mesh({Vec3::Constant(-50.0), Vec3::Constant(50.0)});
  const TriMesh sunk = box_mesh({Vec3::Constant(-10.0), Vec3::Constant(10.0)});
  const TriMesh casting = both;
  const auto first = static_cast<uint32_t>(both.positions.size());
  both.positions.insert(both.positions.end(), sunk.positions.begin(), sunk.positions.end());
  for (const auto& t : sunk.triangles) both.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  const mesh::Enclosed known = mesh::find_enclosed(both);
  RasterRenderer renderer(kWidth, kHeight);
  const auto picture = [&](const Vec3& eye, const TriMesh& mesh, const mesh::Enclosed* enclosed, bool cut) {
    DrawList list;
    list.camera.eye = eye;
    list.items = {item(mesh, {0.9F, 0.1F, 0.1F})};
    list.items.front().enclosed = enclosed;
    list.items.front().sectioned = cut;
    if (cut) list.section = {Vec3::Zero(), Vec3(1.0, 0.0, 0.0)};
    return renderer.draw(list).rgba;
  };
  const Vec3 outside(200, -150, 120), within(45, 5, 5), before(60, 5, 5);
  EXPECT_TRUE(picture(outside, both, &known, false) == picture(outside, casting, nullptr, false));
  const mesh::Enclosed all{std::vector<uint8_t>(both.triangles.size(), 1), known.around};
  EXPECT_FALSE(picture(outside, both, &all, false) == picture(outside, both, nullptr, false));
  EXPECT_TRUE(picture(within, both, &known, false) == picture(within, both, nullptr, false));
  EXPECT_FALSE(picture(within, both, nullptr, false) == picture(within, casting, nullptr, false));
  EXPECT_TRUE(picture(before, both, &known, false) == picture(before, casting, nullptr, false));
  EXPECT_TRUE(picture(outside, both, &known, true) == picture(outside, both, nullptr, true));
}

}  // namespace
}  // namespace swarf::render::raster_renderer
