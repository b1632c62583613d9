// The proof of a body by its sweeps and features: amounts in closed form, faults that it finds and twins that
// pass.
#include <gtest/gtest.h>

#include <random>

#include "proof/gouge_bound.h"
#include "proof/leftover_bound.h"
#include "proof/polytope.h"
#include "proof/tool_body.h"
#include "support/solids.h"

namespace body_proof_test {
namespace {

using swarf::Box;
using swarf::Progress;
using swarf::TriMesh;
using swarf::Vec3;
using swarf::stock::CutterSolid;
using swarf::stock::Stock;
using swarf::stock::Sweep;

/// A block 40 x 30 x 10 mm, its top at z = 0, with a slot 10 wide and 4 deep along x through it.
TriMesh slotted_block() {
  return swarf::test::towers({-20, 20}, {-15, -5, 5, 15}, -10,
                             [](int, int j) { return j == 1 ? -4.0 : 0.0; });
}

Sweep along_x(double y, double z, uint32_t block) {
  return {{Vec3(-30, y, z), Vec3::UnitZ()}, {Vec3(30, y, z), Vec3::UnitZ()}, block};
}

struct Proven {
  swarf::proof::GougeBound gouge;
  swarf::proof::LeftoverBound leftover;
};

/// The slot cut in a block that is flush with the design on all other sides.
Proven prove(const std::vector<Sweep>& sweeps, const CutterSolid& cutter, double gouge_um, double leftover_um,
             double top = 0.0) {
  const swarf::proof::SolidDesign design(slotted_block(), 0.0);
  Stock stock(Box{Vec3(-20, -15, -10), Vec3(20, 15, top)}, 0.4);
  stock.cut(sweeps, cutter);
  const swarf::measure::SweepCutters cutters(cutter);
  Progress silent;
  return {
      swarf::proof::bound_gouges({design, sweeps, cutters, gouge_um * 1e-3, 0.0, silent}),
      swarf::proof::bound_leftover({design, sweeps, cutters, stock, 0.0, leftover_um * 1e-3, 0.0, silent})};
}

TEST(BodyProof, ARightSlotHasNeitherGougeNorLeftover) {
  const Proven proven = prove({along_x(0, -4, 0)}, CutterSolid(5.0, 20.0), 2.0, 10.0);
  EXPECT_EQ(proven.gouge.open, 0U);
  EXPECT_LE(proven.gouge.bound_mm, 0.002);
  EXPECT_EQ(proven.leftover.open, 0U);
  EXPECT_LE(proven.leftover.bound_mm, 0.010);
  EXPECT_EQ(proven.leftover.found_mm, 0.0);
}

TEST(BodyProof, AFloorCutTooDeepIsToldToTheDepth) {
  const Proven proven = prove({along_x(0, -4.008, 0)}, CutterSolid(5.0, 20.0), 2.0, 10.0);
  EXPECT_NEAR(proven.gouge.found_mm, 0.008, 1e-6);
  EXPECT_GE(proven.gouge.bound_mm, 0.008);
  EXPECT_LE(proven.gouge.bound_mm, 0.0084);
  EXPECT_NEAR(proven.gouge.bottom.z(), -4.008, 1e-6);
}

TEST(BodyProof, AWallCutTooFarIsToldToTheDepth) {
  const Proven proven = prove({along_x(0.006, -4, 0)}, CutterSolid(5.0, 20.0), 2.0, 10.0);
  EXPECT_NEAR(proven.gouge.found_mm, 0.006, 1e-6);
  EXPECT_GE(proven.gouge.bound_mm, 0.006);
  // And 6 um are left at the other wall, within 10 um.
  EXPECT_EQ(proven.leftover.open, 0U);
  EXPECT_LE(proven.leftover.bound_mm, 0.010);
}

TEST(BodyProof, AFloorLeftTooHighIsToldToTheHeight) {
  const Proven proven = prove({along_x(0, -3.988, 0)}, CutterSolid(5.0, 20.0), 2.0, 10.0);
  EXPECT_NEAR(proven.leftover.found_mm, 0.012, 2e-6);  // a touch of 1e-6
  EXPECT_GE(proven.leftover.bound_mm, 0.012);
  EXPECT_LE(proven.leftover.bound_mm, 0.0122);
}

TEST(BodyProof, AThinWallBetweenTwoRowsIsFound) {
  // Tools of 4.9 mm leave 0.1 mm between the rows, 4 mm high, and nothing at the walls.
  const std::vector<Sweep> rows{along_x(-2.55, -4, 0), along_x(2.55, -4, 1)};
  const Proven proven = prove(rows, CutterSolid(2.45, 20.0), 2.0, 10.0);
  EXPECT_GT(proven.leftover.found_mm, 3.0);
  const std::vector<Sweep> closer{along_x(-2.55, -4, 0), along_x(0, -4, 1), along_x(2.55, -4, 2)};
  EXPECT_EQ(prove(closer, CutterSolid(2.45, 20.0), 2.0, 10.0).leftover.open, 0U);
}

TEST(BodyProof, MaterialFarAboveTheDesignIsFound) {
  const Proven proven = prove({along_x(0, -4, 0)}, CutterSolid(5.0, 20.0), 2.0, 10.0, 5.0);
  EXPECT_NEAR(proven.leftover.found_mm, 5.0, 1e-3);
}

TEST(BodyProof, ABuriedToolIsAGouge) {
  const std::vector<Sweep> buried{
      {{Vec3(-15, 10, -8), Vec3::UnitZ()}, {Vec3(-10, 10, -8), Vec3::UnitZ()}, 0}};
  const Proven proven = prove(buried, CutterSolid(1.0, 3.0), 2.0, 10.0);
  EXPECT_GT(proven.gouge.found_mm, 1.0);
  EXPECT_GE(proven.gouge.bound_mm, proven.gouge.found_mm);
}

TEST(BodyProof, EveryPointOutsideLiesOverItsNearestFeature) {
  const uint32_t seed = 41;
  const swarf::proof::SolidDesign design(slotted_block(), 0.0);
  const std::vector<swarf::proof::FeatureCell> cells = design.cells();
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> x(-22, 22), y(-17, 17), z(-12, 2);
  int outside = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p(x(random), y(random), z(random));
    const swarf::mesh::SignedPoint seen = design.distance().at(p);
    if (seen.distance_mm < 1e-6) continue;
    ++outside;
    const Vec3 way = (p - seen.foot).normalized();
    const bool held = std::any_of(cells.begin(), cells.end(), [&](const swarf::proof::FeatureCell& cell) {
      Vec3 mean = Vec3::Zero();
      for (const Vec3& one : cell.ways) mean += one;
      double widest = 1.0, nearest = 1e9;
      for (const Vec3& one : cell.ways) widest = std::min(widest, one.dot(mean.normalized()));
      if (cell.feet.size() == 3)
        nearest =
            (swarf::mesh::closest_point_on_triangle(seen.foot, cell.feet[0], cell.feet[1], cell.feet[2]) -
             seen.foot)
                .norm();
      else if (cell.feet.size() == 2)
        nearest =
            (swarf::mesh::closest_point_on_triangle(seen.foot, cell.feet[0], cell.feet[1], cell.feet[1]) -
             seen.foot)
                .norm();
      else
        nearest = (seen.foot - cell.feet[0]).norm();
      return nearest < 1e-6 && way.dot(mean.normalized()) >= widest - 1e-6;
    });
    EXPECT_TRUE(held) << "seed " << seed << ", point {" << p.x() << ", " << p.y() << ", " << p.z() << "}";
  }
  EXPECT_GT(outside, 500);
}

TEST(ToolBody, EveryPointOfTheCutterIsNearTheReducedBody) {
  const double g = 0.05;
  swarf::cutter::Cutter ball;
  ball.shape = swarf::cutter::Shape::kBall;
  ball.diameter_mm = 10.0;
  ball.corner_radius_mm = 5.0;
  for (const CutterSolid& cutter : {CutterSolid(5.0, 20.0), CutterSolid(ball)}) {
    const auto& piece = cutter.pieces.front();
    for (const auto& body : swarf::proof::reduced_bodies(piece, g)) {
      // In each direction across the outline the body reaches as far as the cutter, less g.
      for (double angle = -1.57; angle < 1.57; angle += 0.05) {
        const Vec3 d(std::cos(angle), 0.0, std::sin(angle));
        const double whole = d.dot(support(swarf::proof::piece_body(piece, 1e-4), d));
        EXPECT_GE(d.dot(support(body, d)), whole - 1e-4 - g);
      }
    }
  }
}

TEST(Polytopes, BothPartsOfACutMakeTheWhole) {
  const auto volume = [](const swarf::proof::Polytope& body) {
    double sum = 0.0;
    const Vec3 middle = body.centre();
    for (const auto& face : body.faces)
      for (size_t k = 1; k + 1 < face.size(); ++k)
        sum +=
            std::abs((body.corners[face[0]] - middle)
                         .dot((body.corners[face[k]] - middle).cross(body.corners[face[k + 1]] - middle))) /
            6.0;
    return sum;
  };
  const swarf::proof::Polytope cube = swarf::proof::box_polytope({Vec3(0, 0, 0), Vec3(1, 2, 3)});
  EXPECT_NEAR(volume(cube), 6.0, 1e-12);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const Vec3 normal = Vec3(any(random), any(random), any(random)).normalized();
    const double offset = normal.dot(Vec3(0.5, 1.0, 1.5)) + 0.5 * any(random);
    const auto [below, above] = swarf::proof::cut_by_plane(cube, normal, offset);
    const double sum = (below.is_empty() ? 0.0 : volume(below)) + (above.is_empty() ? 0.0 : volume(above));
    EXPECT_NEAR(sum, 6.0, 1e-9) << "cut " << i;
  }
}

}  // namespace
}  // namespace body_proof_test
