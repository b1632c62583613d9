// Patches that are hard on the search: degenerate, tiny, smaller than the tool, narrower than it; and what
// the search must not do: depend on threads, or touch what is higher already.
#include <gtest/gtest.h>

#include <cmath>

#include "base/diagnostics.h"
#include "base/parallel.h"
#include "tests/unit/position/patch_scene.h"

namespace swarf::position {
namespace {

/// Height, held against sampling, which comes to the rim of a flat end, a jump of the height, less closely.
void expect_sampled(const std::vector<Patch>& patches, const ToolProfile& profile, const GuideLine& line) {
  PatchWork work;
  const Rest rest = rest_on(PatchTarget(patches), profile, line, &work);
  const double sampled = sampled_height(patches, profile, line);
  EXPECT_LE(work.gap, kPatchProof_mm);
  EXPECT_GE(rest.height, sampled - kPatchProof_mm);
  EXPECT_LE(rest.height, sampled + (profile.height(profile.radius()) > 0.0 ? 1e-4 : 1e-3));
}

/// A quarter of a torus about z, tube radius 6 about radius 15, its upper side; biquadratic polynomials.
std::vector<Patch> ring_like() {
  std::vector<Vec3> poles;
  for (const Vec2& a : {Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)})
    for (const Vec2& b : {Vec2(21, 0), Vec2(21, 6), Vec2(15, 6)})
      poles.push_back({a.x() * b.x(), a.y() * b.x(), b.y()});
  return {bezier(2, 2, poles)};
}

TEST(PatchAttack, CollapsedEdgesAndPoints) {
  // A triangle as a square with one side in a point, and a patch that is one point.
  const Patch triangle = bezier(1, 1, {{0, 0, 0}, {0, 0, 0}, {10, -5, 3}, {10, 5, 1}});
  for (const ToolProfile& tool : {ball_end(3.0), flat_end(3.0), nose_end(1.0, 2.0), pointed(3.0, 0.7)}) {
    for (const Vec2& at : {Vec2(0, 0), Vec2(-1, 0.5), Vec2(5, 0), Vec2(11, 4)})
      expect_sampled({triangle}, tool, upright(at.x(), at.y()));
  }
  const Patch point = bezier(1, 1, {{1, 1, 4}, {1, 1, 4}, {1, 1, 4}, {1, 1, 4}});
  EXPECT_NEAR(rest_on(PatchTarget({point}), flat_end(3.0), upright(0, 0)).height, 4.0, kPatchProof_mm);
  EXPECT_FALSE(rest_on(PatchTarget({point}), flat_end(1.0), upright(0, 0)).touches());
}

TEST(PatchAttack, TinyPatchesUnderALargeTool) {
  std::vector<Patch> patches;
  for (int i = 0; i < 20; ++i)
    patches.push_back(plane_patch({0.01 * i, 0.0, 1e-3 * i}, {1e-4, 0, 0}, {0, 1e-4, 1e-5}));
  for (const ToolProfile& tool : {ball_end(40.0), flat_end(40.0), pointed(40.0, 0.3)})
    expect_sampled(patches, tool, upright(0.05, 3.0));
}

TEST(PatchAttack, TorusLikePatchByTapersAndApt) {
  cutter::Cutter taper;
  taper.shape = cutter::Shape::kTaper;
  taper.diameter_mm = 4.0;
  taper.corner_radius_mm = 2.0;
  taper.taper_rad = rad_from_deg(7.0);
  taper.flute_length_mm = 12.0;
  cutter::Cutter apt;
  apt.shape = cutter::Shape::kApt;
  apt.diameter_mm = 12.0;
  apt.corner_radius_mm = 2.0;
  apt.alpha_rad = rad_from_deg(8.0);
  apt.beta_rad = rad_from_deg(15.0);
  apt.flute_length_mm = 12.0;
  for (const cutter::Cutter* tool : {&taper, &apt}) {
    const ToolProfile profile(*tool);
    for (const Vec2& at : {Vec2(12, 12), Vec2(9, 9), Vec2(16, 16), Vec2(3, 19)}) {
      expect_sampled(ring_like(), profile, upright(at.x(), at.y()));
      expect_sampled(ring_like(), profile, guide_line({at.x(), at.y(), 0.0}, {0.3, -0.2, 1.0}));
    }
  }
}

TEST(PatchAttack, ChannelNarrowerThanTheTool) {
  // A parabola of radius 2 at its bottom: balls of 5 rest on both walls, as high as the closed form says.
  const std::vector<Patch> channel{quadric_patch(0.5, 0.0, 0.0, 10.0)};
  PatchWork work;
  const Rest rest = rest_on(PatchTarget(channel), ball_end(5.0), upright(0.0, 1.0), &work);
  EXPECT_LE(work.gap, kPatchProof_mm);
  // Contact at x: centre = z + x / z' = x^2 / 4 + 2, and (x^2 / 4)' = x / 2: x^2 + 4 = 25.
  EXPECT_NEAR(rest.height, 21.0 / 4.0 + 2.0 - 5.0, kPatchProof_mm);
}

TEST(PatchAttack, SameCellsForAnyNumberOfThreads) {
  std::vector<double> sums;
  for (const int threads : {1, 2, 0}) {
    set_thread_count(threads);
    const PatchTarget target(wavy_patches());
    double sum = 0.0;
    for (const PatchCell& cell : target.cells()) sum = 0.5 * sum + cell.radius + cell.p.x() + cell.child;
    sums.push_back(sum + static_cast<double>(target.cells().size()));
  }
  EXPECT_EQ(sums[0], sums[1]);
  EXPECT_EQ(sums[0], sums[2]);
}

TEST(PatchAttack, TooManyCellsAreRefused) {
  CellOptions few;
  few.most_cells = 100;
  EXPECT_THROW(PatchTarget({dome_patch()}, few), InputError);
}

TEST(PatchAttack, WhatIsHeldAlreadyStays) {
  const PatchTarget target({dome_patch()});
  Rest held;
  held.height = 50.0;
  held.number = 77;
  PatchHint near;
  target.raise(ball_end(5.0), upright(0.0, 0.0), held, near);
  EXPECT_EQ(held.height, 50.0);
  EXPECT_EQ(held.number, 77);
  EXPECT_EQ(near.patch, -1);
}

}  // namespace
}  // namespace swarf::position
