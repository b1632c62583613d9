#include "stock/rays/surface_dexels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>

#include "base/diagnostics.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "cutter_shapes.h"
#include "dome.h"
#include "stock/rays/dexel_kernel.h"
#include "stock/rays/ray_height.h"
#include "stock/rays/ray_material.h"
#include "stock/rays/tile_bounds.h"
#include "stock_test_support.h"
#include "support/scratch.h"

namespace swarf::stock::surface_dexels_test {
namespace {

const CutterSolid kCutter{5.0, 25.0};
const Box kBox{{-55, -45, -10}, {55, 45, 45}};

TEST(SurfaceDexels, GridHasThePitchAndStartsAtTheStock) {
  const SurfaceDexels dexels(dome(), 1.0, kBox);
  EXPECT_EQ(dexels.nu(), 111);  // longest curve v = const: 109.823 mm
  EXPECT_EQ(dexels.heights_mm().size(), static_cast<size_t>(dexels.nu()) * dexels.nv());
  for (size_t n = 0; n < dexels.points().size(); n += 97) {
    const Vec3 top = dexels.points()[n] + dexels.heights_mm()[n] * dexels.normals()[n];
    EXPECT_NEAR(std::min((kBox.upper - top).minCoeff(), (top - kBox.lower).minCoeff()), 0.0, 1e-9);
    EXPECT_EQ(dexels.blocks()[n], kUncut);
  }
}

/// Rays round about the tool's, some flatter than the kernel answers.
TileRays random_rays(Rng& rng) {
  TileRays rays;
  for (int n = 0; n < kTileRays; ++n) {
    const Vec3 foot(rng.uniform(-6.0, 6.0), rng.uniform(-6.0, 6.0), rng.uniform(-2.0, 1.0));
    const Vec3 normal = (Vec3::UnitZ() + rng.uniform(0.0, 1.5) * rng.direction()).normalized();
    rays.px[n] = foot.x(), rays.py[n] = foot.y(), rays.pz[n] = foot.z();
    rays.nx[n] = normal.x(), rays.ny[n] = normal.y(), rays.nz[n] = normal.z();
  }
  return rays;
}

TEST(DexelKernel, EveryInstructionSetGivesTheSameBits) {
  constexpr uint64_t kSeed = 29;
  Rng rng(kSeed);
  const auto variants = dexel_kernel_variants();
  ASSERT_STREQ(variants.back().instruction_set, "baseline");
  int exact = 0, open = 0;
  for (int n = 0; n < 2000; ++n) {
    const TileRays rays = random_rays(rng);
    const auto pose = [&] {
      return ToolPose{rng.direction(),
                      (Vec3::UnitZ() + rng.uniform(0.0, 0.3) * rng.direction()).normalized()};
    };
    const SweepMap map = sweep_map({pose(), pose(), 0});
    TileHeights reference;
    variants.back().kernel(rays, map, kCutter.radius, reference);
    for (const DexelKernelVariant& variant : variants) {
      TileHeights heights;
      variant.kernel(rays, map, kCutter.radius, heights);
      ASSERT_EQ(std::memcmp(&heights, &reference, sizeof(heights)), 0)
          << variant.instruction_set << " differs, seed " << kSeed << " case " << n;
    }
    for (const double height : reference.exact) ++(height == kNoHeight ? open : exact);
  }
  EXPECT_GT(exact, 20000);
  EXPECT_GT(open, 20000);
}

/// What the cheap test rules out, no ray of the kernel reaches; and it rules out what it can.
TEST(DexelKernel, ThePlaneTestRulesOutNothingThatTheKernelReaches) {
  constexpr uint64_t kSeed = 31;
  Rng rng(kSeed);
  int out = 0, kept = 0;
  for (int n = 0; n < 4000; ++n) {
    TileRays rays = random_rays(rng);
    for (double& z : rays.pz) z -= 2.0;
    for (double& z : rays.nz) z = std::max(z, 0.05);
    const auto pose = [&] {
      return ToolPose{rng.direction(),
                      (Vec3::UnitZ() + rng.uniform(0.0, 0.2) * rng.direction()).normalized()};
    };
    const SweepMap map = sweep_map({pose(), pose(), 0});
    TileHeights heights;
    dexel_kernel_variants().back().kernel(rays, map, kCutter.radius, heights);
    // Tops just below the bounds, at them, or anywhere.
    double tops[kTileRays];
    const int kind = n % 3;
    for (int k = 0; k < kTileRays; ++k)
      tops[k] = kind < 2 ? heights.bound[k] - (kind == 0 ? 1e-6 : 0.0) : rng.uniform(-3.0, 1.0);
    bool reached = false;
    for (int k = 0; k < kTileRays; ++k) reached |= heights.bound[k] <= tops[k] + kBoundSlack;
    for (const DexelKernelVariant& variant : dexel_kernel_variants()) {
      const bool found = variant.planes_reach(rays, {&map, 1}, tops) != 0;
      ASSERT_TRUE(found || !reached) << variant.instruction_set << ", seed " << kSeed << " case " << n;
      ++(found ? kept : out);
    }
  }
  EXPECT_GT(out, 200);
  EXPECT_GT(kept, 200);
}

/// Poses that two sweeps share are looked at once: a row of sweeps is told what each is told alone.
TEST(DexelKernel, ThePlaneTestOfARowTellsWhatEachOfItsSweepsTells) {
  constexpr uint64_t kSeed = 33;
  constexpr uint32_t kRow = 8;
  Rng rng(kSeed);
  int out = 0, kept = 0;
  for (int n = 0; n < 2000; ++n) {
    TileRays rays = random_rays(rng);
    for (double& z : rays.nz) z = std::max(z, 0.05);
    double tops[kTileRays];
    const double top = rng.uniform(-6.0, 0.0);
    std::fill(std::begin(tops), std::end(tops), top);
    const auto pose = [&] {
      return ToolPose{rng.direction(),
                      (Vec3::UnitZ() + rng.uniform(0.0, 0.2) * rng.direction()).normalized()};
    };
    std::vector<SweepMap> row;
    ToolPose before = pose();
    for (uint32_t k = 0; k < kRow; ++k) {
      if (rng.uniform(0.0, 1.0) < 0.2) before = pose();  // a gap in the path
      const ToolPose next = pose();
      row.push_back(sweep_map({before, next, k}));
      before = next;
    }
    uint32_t one_by_one = 0;
    for (uint32_t k = 0; k < kRow; ++k)
      one_by_one |= dexel_kernel_variants().back().planes_reach(rays, {&row[k], 1}, tops) << k;
    for (const DexelKernelVariant& variant : dexel_kernel_variants())
      ASSERT_EQ(variant.planes_reach(rays, row, tops), one_by_one)
          << variant.instruction_set << ", seed " << kSeed << " case " << n;
    for (uint32_t k = 0; k < kRow; ++k) ++((one_by_one >> k & 1U) != 0 ? kept : out);
  }
  EXPECT_GT(out, 1000);
  EXPECT_GT(kept, 1000);
}

/// The loop over a disc's rays against the kernel that tells their heights: what it lowers stands at the
/// exact height, what it does not answer for it says, and every instruction set gives the same bits.
TEST(DexelKernel, TheDiscLowersToTheKernelsHeights) {
  constexpr uint64_t kSeed = 37;
  constexpr double kBlock = 7.0;
  Rng rng(kSeed);
  int lowered = 0, taken_over = 0, left = 0;
  for (int n = 0; n < 3000; ++n) {
    TileRays rays = random_rays(rng);
    const double share = n % 2 == 0 ? 0.5 : 1.0;  // half of the cases lie within the disc
    for (int k = 0; k < kTileRays; ++k) rays.px[k] *= share, rays.py[k] *= share, rays.pz[k] -= 1.0;
    const auto pose = [&] { return ToolPose{0.3 * rng.direction(), Vec3::UnitZ()}; };
    const SweepMap map = sweep_map({pose(), pose(), 0});
    TileHeights told;
    dexel_kernel_variants().back().kernel(rays, map, kCutter.radius, told);
    TileMaterial before;
    for (int k = 0; k < kTileRays; ++k) {
      const bool tie = told.exact[k] != kNoHeight && rng.uniform(0.0, 1.0) < 0.2;
      before.heights[k] = tie ? told.exact[k] : rng.uniform(-0.5, 3.0);
      before.blocks[k] = std::floor(rng.uniform(0.0, 14.0));
    }
    TileMaterial reference = before;
    const Lowering expected =
        dexel_kernel_variants().back().cut_by_disc(rays, map, kCutter.radius, kBlock, reference);
    bool open = false;
    for (int k = 0; k < kTileRays; ++k) {
      const double height = before.heights[k], s = told.exact[k];
      const bool known = s != kNoHeight && s > -kNoteworthy;
      const bool lower = known && (s < height || (s == height && kBlock < before.blocks[k]));
      ASSERT_EQ(reference.heights[k], lower ? s : height)
          << "seed " << kSeed << " case " << n << " ray " << k;
      ASSERT_EQ(reference.blocks[k], lower ? kBlock : before.blocks[k]) << "case " << n << " ray " << k;
      open |= !known && told.bound[k] <= height + kBoundSlack;
      if (lower) ++(s == height ? taken_over : lowered);
    }
    ASSERT_TRUE(expected.left || !open) << "seed " << kSeed << " case " << n;
    left += expected.left ? 1 : 0;
    for (const DexelKernelVariant& variant : dexel_kernel_variants()) {
      TileMaterial other = before;
      const Lowering found = variant.cut_by_disc(rays, map, kCutter.radius, kBlock, other);
      ASSERT_EQ(std::memcmp(&other, &reference, sizeof(other)), 0)
          << variant.instruction_set << " case " << n;
      ASSERT_EQ(found.changed, expected.changed) << variant.instruction_set << " case " << n;
      ASSERT_EQ(found.left, expected.left) << variant.instruction_set << " case " << n;
    }
  }
  EXPECT_GT(lowered, 1000);
  EXPECT_GT(taken_over, 1000);
  EXPECT_GT(left, 100);
  EXPECT_LT(left, 3000);
}

TEST(SurfaceDexels, DesignOutsideTheStockIsMissingMaterial) {
  const SurfaceDexels dexels(dome(), 4.0, {{-55, -45, -10}, {55, 45, 20}});
  for (size_t n = 0; n < dexels.points().size(); ++n) {
    if (dexels.points()[n].z() > 20.0 + 1e-9) {
      EXPECT_LT(dexels.heights_mm()[n], 0.0);
    } else {
      EXPECT_GE(dexels.heights_mm()[n], -1e-9);
    }
  }
}

/// Every ray against every sweep, without tiles, bounds or kernels.
void expect_brute_force(const SurfaceDexels& dexels, const SurfaceDexels& fresh,
                        std::span<const Sweep> sweeps) {
  for (size_t n = 0; n < dexels.points().size(); ++n) {
    double expected = fresh.heights_mm()[n];
    for (const Sweep& sweep : sweeps) {
      const double height = ray_height(dexels.points()[n], dexels.normals()[n], sweep, kCutter);
      if (height > -kSkin) expected = std::min(expected, height);
    }
    ASSERT_NEAR(dexels.heights_mm()[n], expected, 1e-10) << "ray " << n;
    if (dexels.blocks()[n] == kUncut) continue;
    ASSERT_NEAR(ray_height(dexels.points()[n], dexels.normals()[n], sweeps[dexels.blocks()[n]], kCutter),
                expected, 1e-10);
  }
}

TEST(SurfaceDexels, DomePassesEqualBruteForce) {
  const std::vector<Sweep> sweeps = dome_passes(0.35, 0.6, 6, 24);
  SurfaceDexels dexels(dome(), 1.3, kBox);
  const SurfaceDexels fresh = dexels;
  dexels.cut(sweeps, kCutter);
  expect_brute_force(dexels, fresh, sweeps);
}

/// Tiles that lie wholly under a wide disc, by flutes that are longer than the material is thick, about as
/// long, and much shorter: then material stays above the cut.
TEST(SurfaceDexels, ShortFlutesUnderTheDiscEqualBruteForce) {
  const std::vector<Sweep> sweeps = dome_passes(0.4, 0.6, 4, 24);
  CutterSolid rounded{20.0, 2.0};
  rounded.pieces = {ProfileWalk({0.0, 0.0}, -90.0).line(19.0).turn_to(0.0, 1.0).line(1.0).close()};
  for (const CutterSolid& cutter :
       {CutterSolid{20.0, 60.0}, CutterSolid{20.0, 2.0}, CutterSolid{20.0, 0.3}, rounded}) {
    SurfaceDexels dexels(dome(), 1.4, {{-55, -45, -10}, {55, 45, 31}});
    const SurfaceDexels fresh = dexels;
    dexels.cut(sweeps, cutter);
    std::map<uint32_t, std::vector<MaterialAbove>> found;
    dexels.each_above([&](uint32_t ray, const MaterialAbove& m) { found[ray].push_back(m); });
    size_t gaps = 0;
    for (uint32_t n = 0; n < dexels.points().size(); ++n) {
      StandingMaterial standing{fresh.heights_mm()[n], kUncut};
      std::vector<MaterialAbove> above;
      for (const Sweep& sweep : sweeps) {
        const RayInterval cut =
            ray_interval(dexels.points()[n], dexels.normals()[n], sweep_map(sweep), cutter.pieces.front());
        if (cut.hit() && cut.high >= 0.0)
          remove_material({cut.low, cut.high, sweep.block}, 0, standing, above);
      }
      ASSERT_NEAR(dexels.heights_mm()[n], standing.height, 1e-8)
          << "flutes " << cutter.height << " ray " << n;
      const auto total = [](const std::vector<MaterialAbove>& list) {
        return std::accumulate(list.begin(), list.end(), 0.0,
                               [](double sum, const MaterialAbove& m) { return sum + m.high - m.low; });
      };
      ASSERT_NEAR(total(found[n]), total(above), 1e-6) << "flutes " << cutter.height << " ray " << n;
      gaps += above.size();
    }
    EXPECT_GT(gaps, 10U) << cutter.height;
  }
}

TEST(SurfaceDexels, WildSweepsEqualBruteForce) {
  for (const uint64_t seed : {41, 42, 43}) {
    Rng rng(seed);
    std::vector<Sweep> sweeps;
    for (uint32_t n = 0; n < 150; ++n) {
      const Vec3 target = dome()->point(rng.uniform(), rng.uniform());
      Sweep sweep = random_sweep(rng, 1.0, 4.0, 0.2);
      const Vec3 tilt = (Vec3(0, 0, 2) + rng.direction()).normalized();
      sweep.end.axis_W = (tilt + 0.1 * rng.direction()).normalized();
      sweep.start.axis_W = tilt;
      sweep.start.tip_W += target + Vec3(0, 0, 1.5);
      sweep.end.tip_W += target + Vec3(0, 0, 1.5);
      sweep.block = n;
      sweeps.push_back(sweep);
    }
    SurfaceDexels dexels(dome(), 2.1, kBox);
    dexels.cut(sweeps, kCutter);
    // Wild cuts may run deep below the skin from the side; compare where they do not.
    const SurfaceDexels fresh(dome(), 2.1, kBox);
    for (size_t n = 0; n < dexels.points().size(); ++n) {
      double expected = fresh.heights_mm()[n];
      bool deep = false;
      for (const Sweep& sweep : sweeps) {
        const double height = ray_height(dexels.points()[n], dexels.normals()[n], sweep, kCutter);
        deep |= height < -kSkin;
        expected = std::min(expected, height);
      }
      if (deep) continue;
      ASSERT_NEAR(dexels.heights_mm()[n], expected, 1e-10) << "seed " << seed << " ray " << n;
    }
  }
}

TEST(SurfaceDexels, OrderCallsAndThreadsDoNotMatter) {
  const std::vector<Sweep> sweeps = dome_passes(0.1, 0.9, 8, 40);
  SurfaceDexels once(dome(), 0.9, kBox);
  once.cut(sweeps, kCutter);
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    std::vector<Sweep> reversed(sweeps.rbegin(), sweeps.rend());
    SurfaceDexels other(dome(), 0.9, kBox);
    for (size_t n = 0; n < reversed.size(); n += 50) {
      other.cut(std::span(reversed).subspan(n, std::min<size_t>(50, reversed.size() - n)), kCutter);
    }
    EXPECT_EQ(other.heights_mm(), once.heights_mm()) << threads << " threads";
    EXPECT_EQ(other.blocks(), once.blocks()) << threads << " threads";
  }
  set_thread_count(0);
}

/// Tiles of rays cut apart and put together, intervals above gaps included; rays of another design are
/// refused.
TEST(SurfaceDexels, SharesPutTogetherAreTheWhole) {
  std::vector<Sweep> sweeps = dome_passes(0.1, 0.9, 8, 40);
  const ToolPose side{Vec3(-60, 0, 25), Vec3::UnitX()};  // an undercut: gaps above the dome
  sweeps.push_back({side, {Vec3(-20, 5, 25), Vec3::UnitX()}, static_cast<uint32_t>(sweeps.size())});
  SurfaceDexels whole(dome(), 0.9, kBox);
  whole.cut(sweeps, kCutter);
  size_t above = 0;
  whole.each_above([&](uint32_t, const MaterialAbove&) { ++above; });
  EXPECT_GT(above, 0U);
  for (const int count : {1, 2, 3, 8}) {
    SurfaceDexels lead(dome(), 0.9, kBox);
    lead.cut(sweeps, kCutter, {0, count});
    for (int rank = 1; rank < count; ++rank) {
      SurfaceDexels own(dome(), 0.9, kBox);
      own.cut(sweeps, kCutter, {rank, count});
      EXPECT_TRUE(lead.take_tiles(own.tiles_of({rank, count}), {rank, count}));
    }
    EXPECT_EQ(lead.heights_mm(), whole.heights_mm()) << count;
    EXPECT_EQ(lead.blocks(), whole.blocks()) << count;
    EXPECT_EQ(lead.ray_updates(), whole.ray_updates()) << count;
    size_t found = 0;
    lead.each_above([&](uint32_t, const MaterialAbove&) { ++found; });
    EXPECT_EQ(found, above) << count;
  }
  SurfaceDexels coarse(dome(), 1.8, kBox);
  EXPECT_FALSE(coarse.take_tiles(whole.tiles_of({0, 2}), {0, 2}));
}

TEST(SurfaceDexels, ACutBehindTheSkinIsNotMet) {
  // The cutter works on the underside, 5 mm below the dome's foot plane; the dome's rays run through it.
  SurfaceDexels dexels(dome(), 5.0, kBox);
  const SurfaceDexels fresh = dexels;
  dexels.cut(std::vector<Sweep>{{{{-40, 0, -5}, -Vec3::UnitZ()}, {{40, 0, -5}, -Vec3::UnitZ()}, 0}}, kCutter);
  EXPECT_EQ(dexels.heights_mm(), fresh.heights_mm());
}

class SurfaceDexelsFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::path(test::scratch_text()) / "surface_dexels_file";
    std::filesystem::create_directories(folder);
    path = (folder / "surface.rays").string();
  }
  std::string code_of_load(const surface::SurfacePtr& surface) const {
    try {
      SurfaceDexels::load(path, surface);
    } catch (const InputError& error) {
      return error.diagnostics.list().front().code;
    }
    return "";
  }
  std::filesystem::path folder;
  std::string path;
};

TEST_F(SurfaceDexelsFile, RoundTripAndDamage) {
  SurfaceDexels dexels(dome(), 2.0, kBox);
  dexels.cut(dome_passes(0.4, 0.6, 3, 10), kCutter);
  dexels.save(path);
  const SurfaceDexels loaded = SurfaceDexels::load(path, dome());
  EXPECT_EQ(loaded.heights_mm(), dexels.heights_mm());
  EXPECT_EQ(loaded.blocks(), dexels.blocks());
  EXPECT_EQ(code_of_load(dome(59.0)), "rays-file-other-surface");
  const auto size = std::filesystem::file_size(path);
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(size / 2));
    file.put('\x55');
  }
  EXPECT_EQ(code_of_load(dome()), "rays-file-damaged");
  for (const uintmax_t keep : {size - 1, size / 2, uintmax_t{40}, uintmax_t{3}, uintmax_t{0}}) {
    std::filesystem::resize_file(path, keep);
    EXPECT_EQ(code_of_load(dome()), "rays-file-damaged") << keep;
  }
  std::filesystem::remove(path);
  EXPECT_EQ(code_of_load(dome()), "rays-file-unreadable");
  EXPECT_THROW(dexels.save((folder / "missing" / "x.rays").string()), InputError);
}

}  // namespace
}  // namespace swarf::stock::surface_dexels_test
