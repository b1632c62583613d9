// The proven range of the volume: it holds the exact one, for solids known in closed form.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/rng.h"
#include "base/units.h"
#include "stock/stock.h"

namespace swarf::stock::stock_volume_test {
namespace {

const Box kBlock{{-20.03, -15.07, -10.01}, {20.05, 15.02, 0.03}};

double block_volume() {
  return kBlock.size().prod();
}

/// A slot through the block along x at y = 0, depth d: both ends of the sweep lie outside.
std::vector<Sweep> slot(double d, double radius, const Vec3& axis = Vec3::UnitZ()) {
  const double z = kBlock.upper.z() - d, out = kBlock.upper.x() + 2.0 * radius;
  return {{{{-out, 0, z}, axis}, {{out, 0, z}, axis}, 0}};
}

void expect_within(const Stock& stock, double exact, double share_of_area, double area, const char* what) {
  const VolumeRange range = stock.volume_between(0.0);
  EXPECT_LE(range.least, exact) << what;
  EXPECT_GE(range.greatest, exact) << what;
  EXPECT_LE(range.least, stock.volume_mm3()) << what;
  EXPECT_GE(range.greatest, stock.volume_mm3()) << what;
  // Useful: the range is a small share of a voxel over the whole surface.
  EXPECT_LE(range.greatest - range.least, share_of_area * stock.voxel_mm() * area) << what;
}

double block_area() {
  const Vec3 s = kBlock.size();
  return 2.0 * (s.x() * s.y() + s.y() * s.z() + s.z() * s.x());
}

TEST(StockVolume, TheUncutBlock) {
  for (const double voxel : {0.2, 0.31, 0.5}) {
    const Stock stock(kBlock, voxel);
    expect_within(stock, block_volume(), 0.4, block_area(), "block");
  }
}

TEST(StockVolume, AFlatSlotAndABallSlot) {
  for (const double voxel : {0.2, 0.33}) {
    const double length = kBlock.size().x();
    Stock flat(kBlock, voxel);
    flat.cut(slot(4.0, 4.0), CutterSolid(4.0, 25.0));
    expect_within(flat, block_volume() - 8.0 * 4.0 * length, 0.4, block_area() + 8.0 * length, "flat");
    cutter::Cutter ball;
    ball.diameter_mm = 8.0;
    ball.shape = cutter::Shape::kBall;
    ball.flute_length_mm = 25.0;
    Stock round(kBlock, voxel);
    round.cut(slot(4.0, 4.0), CutterSolid(ball));
    expect_within(round, block_volume() - 0.5 * kPi * 16.0 * length, 0.4, block_area() + 4.0 * length,
                  "ball");
  }
}

TEST(StockVolume, ObliqueSlots) {
  Rng rng(20261122);
  for (int n = 0; n < 6; ++n) {
    const double lean = rng.uniform(-0.5, 0.5), depth = rng.uniform(1.0, 4.0), voxel = rng.uniform(0.25, 0.5);
    Stock stock(kBlock, voxel);
    // Leaned about x: a V of the end plane and the flank, through the whole length. Its section, with the tip
    // centre at depth d on y = 0: the part of the rectangle |a| < R, b > 0 of the tool's frame below the top.
    const double R = 3.0;
    const Vec3 axis(0.0, std::sin(lean), std::cos(lean));
    stock.cut(slot(depth, R, axis), CutterSolid(R, 60.0));
    // Section below the top z = 0 of points p = a u + b w, u = (cos, -sin), w = (sin, cos), z = -d - a sin +
    // b cos < 0 : for each a in (-R, R) the length of b in (0, (d + a sin) / cos).
    double area = 0.0;
    constexpr int kSteps = 200000;
    for (int i = 0; i < kSteps; ++i) {
      const double a = R * ((2.0 * i + 1.0) / kSteps - 1.0);
      area += std::max(0.0, (depth + a * std::sin(lean)) / std::cos(lean)) * 2.0 * R / kSteps;
    }
    const std::string what = fmt::format("lean {:.17g} depth {:.17g} voxel {:.17g}", lean, depth, voxel);
    expect_within(stock, block_volume() - area * kBlock.size().x(), 0.5, block_area() + 16.0 * 40.0,
                  what.c_str());
  }
}

TEST(StockVolume, SlackWidensTheRange) {
  Stock stock(kBlock, 0.4);
  stock.cut(slot(4.0, 4.0), CutterSolid(4.0, 25.0));
  const VolumeRange plain = stock.volume_between(0.0), wide = stock.volume_between(0.01);
  EXPECT_LT(wide.least, plain.least - 0.01 * 1000.0);
  EXPECT_GT(wide.greatest, plain.greatest + 0.01 * 1000.0);
}

// A plunge from 500 mm above: coordinates of the tool's frame that large round to 3e-5 mm, and their squares
// to 2e-3 mm. The sweep is shortened to where the cutter can reach a leaf.
TEST(StockRounding, LongMovesKeepInvariantEight) {
  Rng rng(8);
  for (int n = 0; n < 12; ++n) {
    const double voxel = rng.uniform(0.16, 0.3), radius = rng.uniform(1.0, 12.0);
    const double far = rng.uniform(200.0, 900.0), x = rng.uniform(-3.0, 3.0), y = rng.uniform(-3.0, 3.0);
    const double depth = rng.uniform(-8.0, -1.0), lean = rng.uniform(-0.4, 0.4);
    const Vec3 axis(std::sin(lean), 0.0, std::cos(lean));
    const std::vector<Sweep> sweeps{{{{x, y, far}, axis}, {{x, y, depth}, axis}, 0},
                                    {{{x, y, depth}, axis}, {{x + far, y - 0.3 * far, depth}, axis}, 1}};
    Stock stock(kBlock, voxel);
    stock.cut(sweeps, CutterSolid(radius, 30.0));
    EXPECT_EQ(stock.check(), "") << fmt::format(
        "voxel {:.17g} radius {:.17g} far {:.17g} x {:.17g} y {:.17g} depth {:.17g} lean {:.17g}", voxel,
        radius, far, x, y, depth, lean);
    EXPECT_LT(stock.rounding_mm(), 0.01 * voxel);
  }
}

}  // namespace
}  // namespace swarf::stock::stock_volume_test
