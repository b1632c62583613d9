// Stock and rays with cutters of every kind against exact answers (theory 1.1 and 6).
#include <gtest/gtest.h>

#include <limits>

#include "cutter_shapes.h"
#include "dome.h"
#include "stock/contact/convex_contact.h"
#include "stock/rays/surface_dexels.h"
#include "stock/stock.h"
#include "stock_test_support.h"

namespace swarf::stock::convex_stock_test {
namespace {

double removed(const Box& box, double voxel, const CutterSolid& cutter, const std::vector<Sweep>& sweeps) {
  Stock stock(box, voxel);
  const double before = stock.volume_mm3();
  stock.cut(sweeps, cutter);
  EXPECT_EQ(stock.check(), "");
  return before - stock.volume_mm3();
}

/// The slot of theory 6: 30 mm long, 3 mm deep.
const Box kSlotBox{{-23.05, -8.03, -8.07}, {23.02, 8.06, 0.0}};
const std::vector<Sweep> kSlot{{{{-15, 0, -3}, Vec3::UnitZ()}, {{15, 0, -3}, Vec3::UnitZ()}, 0}};

TEST(ConvexStock, FlatAndBallSlotsAtAFiftiethOfTheDiameter) {
  EXPECT_NEAR(removed(kSlotBox, 0.2, CutterSolid(5.0, 20.0), kSlot), 1135.6194490, 1.1356);
  EXPECT_NEAR(removed(kSlotBox, 0.2, ball_nose(5.0, 20.0), kSlot), 707.6024043774, 0.7076);
}

TEST(ConvexStock, SlotInShortBlocksIsTheSlot) {
  const auto blocks = straight_sweeps(kSlot[0].start, kSlot[0].end, 60);
  EXPECT_NEAR(removed(kSlotBox, 0.2, ball_nose(5.0, 20.0), blocks), 707.6024043774, 0.7076);
}

/// Root mean square of the level set at exact points of the ball slot's groove, away from its edges.
double groove_error(double voxel) {
  Stock stock(kSlotBox, voxel);
  stock.cut(kSlot, ball_nose(5.0, 20.0));
  double sum = 0.0;
  int count = 0;
  for (double x = -10.0; x < 10.0; x += 0.37) {
    for (double angle = -0.5; angle < 0.5; angle += 0.031) {
      const double d = stock.distance_mm({x, 5.0 * std::sin(angle), 2.0 - 5.0 * std::cos(angle)});
      sum += d * d;
      ++count;
    }
  }
  return std::sqrt(sum / count);
}

TEST(ConvexStock, SmoothPartsConvergeInSecondOrder) {
  double previous = groove_error(0.8);
  for (const double voxel : {0.4, 0.2, 0.1}) {
    const double error = groove_error(voxel);
    EXPECT_LT(error, previous / 3.4) << "voxel " << voxel;  // 4 in the limit
    previous = error;
  }
  EXPECT_LT(previous, 3e-4);  // mm at 0.1 mm voxels: about voxel^2 / (8 radius)
}

TEST(ConvexStock, SlotVolumesConvergeInSecondOrder) {
  // The error oscillates with the place on the lattice; over four voxel sizes it stays below c voxel^2.
  for (const double voxel : {0.8, 0.4, 0.2, 0.1}) {
    const double error = removed(kSlotBox, voxel, ball_nose(5.0, 20.0), kSlot) - 707.6024043774;
    EXPECT_LT(std::abs(error), 12.0 * voxel * voxel) << "voxel " << voxel;
  }
}

TEST(ConvexStock, PlungedTaperMakesACone) {
  const double half = rad_from_deg(15.0), depth = 6.0, tip = 2.0;
  const CutterSolid cutter = taper(tip, 15.0, 20.0);
  const std::vector<Sweep> plunge{{{{0, 0, 2}, Vec3::UnitZ()}, {{0, 0, -depth}, Vec3::UnitZ()}, 0}};
  const double top = tip + depth * std::tan(half);
  const double exact = kPi * depth * (tip * tip + tip * top + top * top) / 3.0;
  EXPECT_NEAR(removed({{-6, -6, -8}, {6, 6, 0}}, 0.1, cutter, plunge), exact, 1e-3 * exact);
  for (const double rho : {2.1, 2.5, 3.0, 3.5}) {
    const double wall = (rho - tip) / std::tan(half) - depth;
    const double angle = rho;
    EXPECT_NEAR(
        ray_height({rho * std::cos(angle), rho * std::sin(angle), 0}, Vec3::UnitZ(), plunge[0], cutter), wall,
        1e-10);
  }
  EXPECT_NEAR(ray_height({1, 1, 0}, Vec3::UnitZ(), plunge[0], cutter), -depth, 1e-10);
}

TEST(ConvexStock, PlungedBallMakesItsHemisphere) {
  const std::vector<Sweep> plunge{{{{0, 0, 3}, Vec3::UnitZ()}, {{0, 0, -7}, Vec3::UnitZ()}, 0}};
  const double exact = kPi * 25.0 * 2.0 + 2.0 / 3.0 * kPi * 125.0;  // shaft of 2 mm above the hemisphere
  EXPECT_NEAR(removed({{-7, -7, -9}, {7, 7, 0}}, 0.2, ball_nose(5.0, 20.0), plunge), exact, 1e-3 * exact);
}

TEST(ConvexStock, TSlotUndercutsWhatItsNeckLeaves) {
  const CutterSolid cutter = t_slot(6.0, 3.0, 2.0, 20.0);
  const std::vector<Sweep> slot{{{{-10, 0, -5}, Vec3::UnitZ()}, {{10, 0, -5}, Vec3::UnitZ()}, 0}};
  const double exact = (12.0 * 20.0 + 36.0 * kPi) * 3.0 + (4.0 * 20.0 + 4.0 * kPi) * 2.0;
  EXPECT_NEAR(removed({{-18, -8, -7}, {18, 8, 0}}, 0.2, cutter, slot), exact, 1e-3 * exact);
}

TEST(ConvexStock, ZeroLengthBlockCutsItsPose) {
  const ToolPose pose{{0.3, -0.2, -3.0}, Vec3(0.2, 0.1, 1.0).normalized()};
  const CutterSolid cutter = bull_nose(5.0, 2.0, 20.0);
  const double once = removed(kSlotBox, 0.2, cutter, {{pose, pose, 0}});
  const ToolPose next{pose.tip_W + Vec3(1e-7, 0, 0), pose.axis_W};
  EXPECT_GT(once, 100.0);
  EXPECT_NEAR(once, removed(kSlotBox, 0.2, cutter, {{pose, next, 0}}), 1e-3);
}

TEST(ConvexStock, TurnOnTheSpot) {
  const double turn = 0.3;
  const Sweep sweep{{Vec3::Zero(), Vec3::UnitZ()}, {Vec3::Zero(), {std::sin(turn), 0, std::cos(turn)}}, 0};
  // Points on the axis of the turn keep their place in the tool's frame.
  const SweepMap map = sweep_map(sweep);
  EXPECT_NEAR(swept_contact({0, 2, 0}, map, ball_nose(5.0, 20.0)).distance_mm, std::sqrt(29.0) - 5.0, 1e-12);
  // A flat end sinks its front edge: the end pose's plane is the deepest under it, the start pose's behind.
  const CutterSolid flat = solid_of({ProfileWalk({0, 0}, -90).line(5.0).turn_to(1e-9).line(20.0).close()});
  for (const CutterSolid& cutter : {CutterSolid(5.0, 20.0), flat}) {
    EXPECT_NEAR(ray_height({4, 1, 0}, Vec3::UnitZ(), sweep, cutter), -4.0 * std::tan(turn), 1e-9);
    EXPECT_NEAR(ray_height({-4, 1, 0}, Vec3::UnitZ(), sweep, cutter), 0.0, 1e-9);
  }
}

/// The cusp between two straight passes along x whose poses are turned by +-theta about the x axis at
/// distance `radius` from it (negative: concave), measured by the ray half way between them.
double cusp(const CutterSolid& cutter, double radius, double theta) {
  double height = std::numeric_limits<double>::infinity();
  const Vec3 crest(0, 0, radius);
  for (const double side : {-theta, theta}) {
    const Vec3 normal(0, std::sin(side), std::cos(side));
    const Vec3 touch = radius * normal;
    const Sweep pass{{touch - Vec3(20, 0, 0), normal}, {touch + Vec3(20, 0, 0), normal}, 0};
    height = std::min(height, ray_height(crest, Vec3::UnitZ(), pass, cutter));
  }
  return height;
}

TEST(ConvexStock, BallScallopOnPlaneConvexAndConcave) {
  const CutterSolid ball = ball_nose(5.0, 20.0);
  const double P = 1.0;
  const auto on_circle = [&](double R) { return cusp(ball, R, std::asin(0.5 * P / R)); };
  EXPECT_NEAR(on_circle(50.0), 0.027591995, 1e-9);
  EXPECT_NEAR(on_circle(-50.0), 0.022541229, 1e-9);
  const auto plane_pass = [&](double y) {
    return Sweep{{{-20, y, 0}, Vec3::UnitZ()}, {{20, y, 0}, Vec3::UnitZ()}, 0};
  };
  EXPECT_NEAR(ray_height({0, 0, 0}, Vec3::UnitZ(), plane_pass(0.5), ball), 0.025062814, 1e-9);
}

TEST(ConvexStock, LeanedFlatEndLeavesItsExactScallop) {
  // theory 1.1: h = r sin(phi) (1 - sqrt(1 - (P / 2r)^2)); the rim's lowest point runs on the plane.
  const CutterSolid general = solid_of({ProfileWalk({0, 0}, -90).line(5.0).turn_to(1e-9).line(20.0).close()});
  struct {
    double phi_deg, P, h;
  } const oracles[] = {{5, 2, 0.0088045}, {10, 4, 0.0724850}, {20, 2, 0.0345511}};
  for (const auto& o : oracles) {
    const double phi = rad_from_deg(o.phi_deg);
    const Vec3 axis(std::sin(phi), 0, std::cos(phi));
    const Vec3 tip(0, 0, 5.0 * std::sin(phi));
    const Sweep pass{{tip - Vec3(20, 0, 0), axis}, {tip + Vec3(20, 0, 0), axis}, 0};
    for (const CutterSolid& cutter : {CutterSolid(5.0, 20.0), general}) {
      EXPECT_NEAR(ray_height({0, 0.5 * o.P, 0}, Vec3::UnitZ(), pass, cutter), o.h, 1e-7) << o.phi_deg;
    }
  }
}

TEST(ConvexStock, DexelsTakeEveryCutter) {
  // Passes 2.4 mm apart over DOME: each ray ends at the lowest of the single sweeps' heights.
  const std::vector<Sweep> sweeps = dome_passes(0.45, 0.51, 3, 12);
  for (const CutterSolid& cutter : {ball_nose(5.0, 25.0), bull_nose(5.0, 1.5, 25.0), barrel()}) {
    SurfaceDexels dexels(dome(), 2.0, {{-50, -40, -20}, {50, 40, 40}});
    const std::vector<double> before = dexels.heights_mm();
    dexels.cut(sweeps, cutter);
    int lowered = 0;
    for (size_t i = 0; i < before.size(); ++i) {
      double lowest = before[i];
      for (const Sweep& sweep : sweeps) {
        const double height = ray_height(dexels.points()[i], dexels.normals()[i], sweep, cutter);
        if (height >= -kSkin) lowest = std::min(lowest, height);
      }
      ASSERT_EQ(dexels.heights_mm()[i], lowest) << "ray " << i;
      lowered += lowest < before[i] ? 1 : 0;
    }
    EXPECT_GT(lowered, 50);
  }
}

TEST(ConvexStock, HashDoesNotDependOnCallsForAnyCutter) {
  Rng rng(91);
  const CutterSolid cutter = bull_nose(4.0, 1.5, 15.0);
  std::vector<Sweep> sweeps;
  for (int n = 0; n < 700; ++n) sweeps.push_back(random_sweep(rng, 9.0, 2.0, 0.2));
  const Box box{{-10, -10, -10}, {10, 10, 10}};
  Stock whole(box, 0.5), parts(box, 0.5), backward(box, 0.5);
  whole.cut(sweeps, cutter);
  for (size_t n = 0; n < sweeps.size(); n += 7) parts.cut(std::span(sweeps).subspan(n, 7), cutter);
  backward.cut(std::vector<Sweep>(sweeps.rbegin(), sweeps.rend()), cutter);
  EXPECT_EQ(whole.hash(), parts.hash());
  EXPECT_EQ(whole.hash(), backward.hash());
}

}  // namespace
}  // namespace swarf::stock::convex_stock_test
