#include <gtest/gtest.h>

#include <cstring>

#include "stock/level_set/leaf_kernel.h"
#include "stock/sweep/sweep_distance.h"
#include "stock_test_support.h"

namespace swarf::stock::sweep_distance_test {
namespace {

MovingPoint<double> moving(const SweepMap& map, const Vec3& x) {
  const Vec3 P = map.start(x), D = map.end(x) - P;
  return {P.x(), P.y(), P.z(), D.x(), D.y(), D.z()};
}

/// Minimum over 400 instants, refined twice around the best of them (F is convex along the motion).
double scanned(const SweepMap& map, const Vec3& x, const CutterSolid& cutter) {
  double best = 1e300, low = 0.0, high = 1.0;
  for (int level = 0; level < 4; ++level) {
    double best_t = low;
    best = 1e300;
    const double step = (high - low) / 400;
    for (int i = 0; i <= 400; ++i) {
      const double t = low + i * step;
      const double f = cutter_value((1.0 - t) * map.start(x) + t * map.end(x), cutter);
      if (f < best) {
        best = f;
        best_t = t;
      }
    }
    low = std::max(0.0, best_t - step);
    high = std::min(1.0, best_t + step);
  }
  return best;
}

TEST(SweptDistance, EqualsAScanForRandomSweeps) {
  constexpr uint64_t kSeed = 21;
  Rng rng(kSeed);
  const CutterSolid cutter{5.0, 12.0};
  for (int n = 0; n < 3000; ++n) {
    const Sweep sweep = random_sweep(rng, 3.0, n % 3 == 0 ? 0.0 : 4.0, n % 2 == 0 ? 0.0 : 0.3);
    const Vec3 x = 15.0 * rng.direction() * rng.uniform();
    const SweepMap map = sweep_map(sweep);
    ASSERT_NEAR((swept_distance<double, true>(moving(map, x), cutter.radius, cutter.height)),
                scanned(map, x, cutter), 1e-7)
        << "seed " << kSeed << " case " << n << ": " << text(sweep) << " point " << text(x);
  }
}

TEST(SweptDistance, RigidMotionLiesWithinTheMotionBound) {
  constexpr uint64_t kSeed = 22;
  Rng rng(kSeed);
  const CutterSolid cutter{5.0, 20.0};
  for (int n = 0; n < 300; ++n) {
    const Sweep sweep = random_sweep(rng, 3.0, 2.0, 0.1);
    const Vec3 x = sweep.start.tip_W + 20.0 * rng.direction() * rng.uniform();
    const SweepMap map = sweep_map(sweep);
    const Vec3 about = sweep.start.axis_W.cross(sweep.end.axis_W);
    const double theta = std::atan2(about.norm(), sweep.start.axis_W.dot(sweep.end.axis_W));
    double rigid = 1e300;
    for (int i = 0; i <= 400; ++i) {
      const double t = i / 400.0;
      const Vec3 tip = (1.0 - t) * sweep.start.tip_W + t * sweep.end.tip_W;
      const Mat3 turn = Eigen::AngleAxisd(t * theta, about.normalized()).toRotationMatrix();
      rigid = std::min(rigid, cutter_value(map.R0t * (turn.transpose() * (x - tip)), cutter));
    }
    const double lever = 22.0;             // farthest point looked at
    const double sampling = 25.0 / 400.0;  // of the rigid poses: at most the way between two of them, squared
    ASSERT_NEAR((swept_distance<double, true>(moving(map, x), cutter.radius, cutter.height)), rigid,
                motion_bound(sweep, lever) + 0.1 * sampling)
        << "seed " << kSeed << " case " << n << ": " << text(sweep);
  }
}

/// A turning cutter, or one that stands along the leaf's columns and moves level, gently, steeply or straight
/// down.
constexpr int kMotions = 5;
Sweep random_passage(Rng& rng, int kind) {
  Sweep sweep = random_sweep(rng, 0.0, 2.0, kind == 0 ? 0.2 : 0.0);
  if (kind == 0) return sweep;
  sweep.start.axis_W = sweep.end.axis_W = Vec3::UnitZ();
  constexpr double kSlope[kMotions] = {0.0, 0.0, 0.3, 3.0, 1.0};
  Vec3 way = sweep.end.tip_W - sweep.start.tip_W;
  way.z() = (rng.uniform() < 0.5 ? -1.0 : 1.0) * kSlope[kind] * way.head<2>().norm();
  if (kind == kMotions - 1) way.head<2>().setZero();
  sweep.end.tip_W = sweep.start.tip_W + way;
  return sweep;
}

LeafMotion random_motion(Rng& rng, bool capped, int kind) {
  const Sweep sweep = random_passage(rng, kind);
  const SweepMap map = sweep_map(sweep);
  // Near the cutter's surface: at the flank, the bottom or inside.
  const Vec3 local(rng.uniform(-6, 6), rng.uniform(-6, 6), rng.uniform(-1, 6));
  const Vec3 first = sweep.start.tip_W + map.R0t.transpose() * local;
  LeafMotion m{};
  for (int c = 0; c < 3; ++c) {
    m.start[c] = static_cast<float>(map.start(first)[c]);
    m.end[c] = static_cast<float>(map.end(first)[c]);
    for (int a = 0; a < 3; ++a) {
      m.start_step[a][c] = static_cast<float>(0.1 * map.R0t(c, a));
      m.end_step[a][c] = static_cast<float>(0.1 * map.R1t(c, a));
    }
  }
  m.radius = 5.0F;
  m.height = 5.0F;
  m.background = 3.0F;
  m.capped = capped;
  return m;
}

TEST(LeafKernel, EveryInstructionSetGivesTheSameBits) {
  constexpr uint64_t kSeed = 23;
  Rng rng(kSeed);
  const auto variants = leaf_kernel_variants();
  ASSERT_STREQ(variants.back().instruction_set, "baseline");
  for (int n = 0; n < 500; ++n) {
    const LeafMotion motion = random_motion(rng, n % 2 == 0, n / 2 % kMotions);
    float reference[kLeafVoxels];
    std::fill(std::begin(reference), std::end(reference), -3.0F);
    variants.back().kernel(reference, motion, kAllPatches);
    for (const LeafKernelVariant& variant : variants) {
      float values[kLeafVoxels];
      std::fill(std::begin(values), std::end(values), -3.0F);
      const uint32_t risen = variant.kernel(values, motion, kAllPatches);
      ASSERT_EQ(std::memcmp(values, reference, sizeof(values)), 0)
          << variant.instruction_set << " differs, seed " << kSeed << " case " << n;
      uint32_t above = 0;
      for (int voxel = 0; voxel < kLeafVoxels; ++voxel) {
        const int patch = voxel / 128 * kPatchSide + voxel / 16 % kPatchSide;
        above |= values[voxel] > -3.0F ? 1U << patch : 0U;
      }
      ASSERT_EQ(risen, above) << variant.instruction_set << ", seed " << kSeed << " case " << n;
    }
  }
}

/// The distance itself, without the kernel's closed form.
double exact_depth(const Vec3& P, const Vec3& Q, bool capped, double radius, double height) {
  const auto depth = [&](double t) {
    const Vec3 X = P + t * (Q - P);
    const double deep = std::min(radius - X.head<2>().norm(), X.z());
    return capped ? std::min(deep, height - X.z()) : deep;
  };
  double low = 0.0, high = 1.0;  // concave in t
  for (int n = 0; n < 100; ++n) {
    const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
    (depth(a) < depth(b) ? low : high) = depth(a) < depth(b) ? a : b;
  }
  return std::max({depth(0.0), depth(1.0), depth(0.5 * (low + high))});
}

TEST(LeafKernel, FloatsAgreeWithDoubles) {
  constexpr uint64_t kSeed = 24;
  Rng rng(kSeed);
  for (int n = 0; n < 200; ++n) {
    const bool capped = n % 2 == 0;
    const LeafMotion m = random_motion(rng, capped, n / 2 % kMotions);
    float values[kLeafVoxels];
    std::fill(std::begin(values), std::end(values), -3.0F);
    leaf_kernel_variants().front().kernel(values, m, kAllPatches);
    double worst = 0.0;
    for (int voxel = n % 7; voxel < kLeafVoxels; voxel += 7) {
      const Vec3 ijk(voxel / 64, voxel / 8 % 8, voxel % 8);
      Vec3 P, Q;
      for (int c = 0; c < 3; ++c) {
        P[c] = m.start[c] + m.start_step[0][c] * ijk[0] + m.start_step[1][c] * ijk[1] +
               m.start_step[2][c] * ijk[2];
        Q[c] = m.end[c] + m.end_step[0][c] * ijk[0] + m.end_step[1][c] * ijk[1] + m.end_step[2][c] * ijk[2];
      }
      const double exact = exact_depth(P, Q, capped, 5.0, 5.0);
      worst = std::max(worst, std::abs(std::clamp(exact, -3.0, 3.0) - values[voxel]));
    }
    // mm: rounding of floats of about 10 mm
    ASSERT_LT(worst, 6e-6) << "seed " << kSeed << " case " << n;
  }
}

}  // namespace
}  // namespace swarf::stock::sweep_distance_test
