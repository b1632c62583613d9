// Random patches, cutters and lines against sampling: nothing that a grid finds may be higher than what the
// search proves, and the place that it names must ask for the height that it gives.
#include <gtest/gtest.h>

#include <sstream>

#include "base/rng.h"
#include "tests/unit/position/patch_scene.h"

namespace swarf::position {
namespace {

struct RandomCase {
  std::vector<Patch> patches;
  ToolProfile profile = ball_end(5.0);
  GuideLine line;
  std::string text;
};

Patch random_patch(Rng& rng, const Vec3& offset) {
  const int degree_u = 1 + static_cast<int>(rng.uniform(0.0, 3.0));
  const int degree_v = 1 + static_cast<int>(rng.uniform(0.0, 3.0));
  const double size = rng.uniform(1.0, 30.0), high = size * rng.uniform(0.0, 0.5);
  const double wild = rng.uniform() < 0.3 ? 0.3 * size : 0.02 * size;
  std::vector<Vec3> poles;
  for (int i = 0; i <= degree_u; ++i) {
    for (int j = 0; j <= degree_v; ++j) {
      const Vec3 jitter{rng.uniform(-wild, wild), rng.uniform(-wild, wild), rng.uniform(-high, high)};
      poles.push_back(offset + jitter +
                      Vec3(size * (1.0 * i / degree_u - 0.5), size * (1.0 * j / degree_v - 0.5), 0.0));
    }
  }
  return bezier(degree_u, degree_v, poles);
}

ToolProfile random_tool(Rng& rng, std::ostream& text) {
  const double r = rng.uniform(0.5, 10.0);
  const int kind = static_cast<int>(rng.uniform(0.0, 4.0));
  text << "tool " << kind << " radius " << r;
  if (kind == 0) return ball_end(r);
  if (kind == 1) return flat_end(r);
  if (kind == 2) return nose_end(0.6 * r, 0.4 * r);
  return pointed(r, rng.uniform(0.1, 1.5));
}

RandomCase random_case(uint64_t seed) {
  Rng rng(seed);
  RandomCase out;
  std::ostringstream text;
  text.precision(17);
  text << "seed " << seed << " ";
  const bool far = rng.uniform() < 0.1;
  const Vec3 offset = far ? Vec3(1e4, -1e4, 1e4) : Vec3::Zero();
  const int count = 1 + static_cast<int>(rng.uniform(0.0, 2.0));
  for (int i = 0; i < count; ++i)
    out.patches.push_back(random_patch(rng, offset + Vec3{rng.uniform(-8, 8), rng.uniform(-8, 8), 0.0}));
  out.profile = random_tool(rng, text);
  const Vec3 place = offset + Vec3{rng.uniform(-12.0, 12.0), rng.uniform(-12.0, 12.0), 0.0};
  Vec3 axis = Vec3::UnitZ();
  if (rng.uniform() < 0.5) axis += Vec3{rng.uniform(-0.6, 0.6), rng.uniform(-0.6, 0.6), 0.0};
  out.line = guide_line(place, axis);
  text << " line " << place.transpose() << " / " << axis.transpose();
  out.text = text.str();
  return out;
}

void compare(uint64_t seed) {
  const RandomCase one = random_case(seed);
  const PatchTarget target(one.patches);
  PatchWork work;
  const Rest rest = rest_on(target, one.profile, one.line, &work);
  EXPECT_LE(work.gap, kPatchProof_mm) << one.text;
  const double sampled = sampled_height(one.patches, one.profile, one.line, 60);
  if (!rest.touches()) {
    EXPECT_EQ(sampled, -std::numeric_limits<double>::infinity()) << one.text;
    return;
  }
  EXPECT_GE(rest.height, sampled - kPatchProof_mm) << one.text;
  const Vec3 place = one.patches[static_cast<size_t>(rest.number)].surface->point(rest.u, rest.v);
  EXPECT_NEAR((place - rest.contact_W).norm(), 0.0, 1e-9) << one.text;
  const Vec3 local = one.line.local(place);
  const double rho = std::hypot(local.x(), local.y());
  EXPECT_LE(rho, one.profile.radius() + kRim_mm) << one.text;
  EXPECT_NEAR(rest.height, local.z() - one.profile.height(std::min(rho, one.profile.radius())), 1e-9)
      << one.text;
}

TEST(PatchRandom, NothingThatAGridFindsIsHigher) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    compare(seed);
    if (HasFailure()) break;
  }
}

// From wherever the last contact was.
TEST(PatchRandom, TheHintMovesTheHeightByLessThanTheProof) {
  for (uint64_t seed = 1001; seed <= 1200; ++seed) {
    const RandomCase one = random_case(seed);
    const PatchTarget target(one.patches);
    const double height = rest_on(target, one.profile, one.line).height;
    Rng rng(seed);
    for (int i = 0; i < 5; ++i) {
      Rest best;
      PatchHint near{static_cast<int>(rng.uniform(0.0, static_cast<double>(one.patches.size()))),
                     Vec2{rng.uniform(), rng.uniform()}};
      target.raise(one.profile, one.line, best, near);
      if (!best.touches()) {
        EXPECT_EQ(height, best.height) << one.text;
      } else {
        EXPECT_NEAR(best.height, height, kPatchProof_mm) << one.text;
      }
    }
  }
}

// The slope of the surface of resting tips, by difference.
TEST(PatchRandom, GradientIsTheSlopeOfTheRestingTips) {
  int compared = 0;
  for (uint64_t seed = 2001; seed <= 2150; ++seed) {
    const RandomCase one = random_case(seed);
    const PatchTarget target(one.patches);
    const Rest rest = rest_on(target, one.profile, one.line);
    if (!rest.touches() || rest.gradient.norm() > 3.0) continue;
    constexpr double kStep = 1e-3;
    for (int i = 0; i < 2; ++i) {
      const Vec3 way = i == 0 ? one.line.x_W : one.line.y_W;
      double height[2];
      Rest sides[2];
      for (int side = 0; side < 2; ++side) {
        GuideLine moved = one.line;
        moved.point_W += way * (side == 0 ? -kStep : kStep);
        sides[side] = rest_on(target, one.profile, moved);
        height[side] = sides[side].height;
      }
      // Only where all three touch as smoothly: at creases it is the slope of one side.
      const bool smooth =
          sides[0].touches() && sides[1].touches() && (sides[0].gradient - sides[1].gradient).norm() < 0.01;
      if (!smooth) continue;
      ++compared;
      EXPECT_NEAR((height[1] - height[0]) / (2.0 * kStep), rest.gradient[i], 0.02) << one.text;
    }
  }
  EXPECT_GT(compared, 50);
}

}  // namespace
}  // namespace swarf::position
