// The proof of a body by its sweeps and features: amounts in closed form, faults that it finds and twins that
// pass.
#include <gtest/gtest.h>

#include <random>

#include "base/units.h"
#include "proof/gouge_bound.h"
#include "proof/leftover_bound.h"
#include "proof/polytope.h"
#include "proof/tool_body.h"
#include "stock/contact/convex_contact.h"
#include "stock/sweep/sweep_map.h"
#include "support/solids.h"

namespace body_proof_test {
namespace {

using swarf::Box;
using swarf::Progress;
using swarf::TriMesh;
using swarf::Vec2;
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

TEST(BodyProof, RowsThatMeetEdgeToEdgeLeaveNothing) {
  const swarf::proof::SolidDesign design(slotted_block(), 0.0);
  const CutterSolid cutter(2.5, 20.0);
  const swarf::measure::SweepCutters cutters(cutter);
  Progress silent;
  for (const double apart : {0.0, 1e-13, 0.005}) {
    const std::vector<Sweep> rows{along_x(-2.5, -4, 0), along_x(2.5 + apart, -4, 1)};
    Stock stock(Box{Vec3(-20, -15, -10), Vec3(20, 15, 0)}, 0.4);
    stock.cut(rows, cutter);
    // A ray on the seam has met 4 mm of material.
    const std::vector<Vec3> tops{Vec3(0, 0.5 * apart, 0)};
    const auto stand =
        swarf::proof::which_stand({design, rows, cutters, stock, 0.0, 0.010, 0.0, silent}, tops);
    EXPECT_EQ(stand, std::vector<uint8_t>{apart > 1e-3}) << apart;
  }
}

TEST(BodyProof, MaterialFarAboveTheDesignIsFound) {
  const Proven proven = prove({along_x(0, -4, 0)}, CutterSolid(5.0, 20.0), 2.0, 10.0, 5.0);
  EXPECT_NEAR(proven.leftover.found_mm, 5.0, 1e-3);
}

TEST(BodyProof, ALeftoverProofThatIsCutShortProvesNoLessThanWhatStands) {
  const swarf::proof::SolidDesign design(slotted_block(), 0.0);
  const CutterSolid cutter(5.0, 20.0);
  const std::vector<Sweep> sweeps{along_x(0, -4, 0)};
  const swarf::measure::SweepCutters cutters(cutter);
  Progress silent;
  for (const double top : {0.0, 5.0}) {
    Stock stock(Box{Vec3(-20, -15, -10), Vec3(20, 15, top)}, 0.4);
    stock.cut(sweeps, cutter);
    swarf::proof::LeftoverQuestion question{design, sweeps, cutters, stock, 0.0, 0.010, 0.0, silent};
    question.most_parts = 0;
    const auto short_of_work = swarf::proof::bound_leftover(question);
    EXPECT_GT(short_of_work.open, 0U);
    EXPECT_GE(short_of_work.bound_mm, std::max(top, 0.010 + 1e-9)) << "or it would pass";
  }
}

TEST(BodyProof, ABuriedToolIsAGouge) {
  const std::vector<Sweep> buried{
      {{Vec3(-15, 10, -8), Vec3::UnitZ()}, {Vec3(-10, 10, -8), Vec3::UnitZ()}, 0}};
  const Proven proven = prove(buried, CutterSolid(1.0, 3.0), 2.0, 10.0);
  EXPECT_GT(proven.gouge.found_mm, 1.0);
  EXPECT_GE(proven.gouge.bound_mm, proven.gouge.found_mm);
}

/// A round bar along x in flats, radius 20 mm to their corners.
TriMesh bar(int flats) {
  TriMesh mesh;
  const auto count = static_cast<uint32_t>(flats);
  for (const float x : {-15.0F, 15.0F})
    for (int k = 0; k < flats; ++k) {
      const double angle = 2.0 * M_PI * k / flats;
      mesh.positions.push_back(
          {x, static_cast<float>(20.0 * std::cos(angle)), static_cast<float>(20.0 * std::sin(angle))});
    }
  for (uint32_t k = 0; k < count; ++k) {
    const uint32_t next = (k + 1) % count;
    mesh.triangles.push_back({k, next, count + next});
    mesh.triangles.push_back({k, count + next, count + k});
    if (k > 0 && next > 0) {
      mesh.triangles.push_back({0, next, k});
      mesh.triangles.push_back({count, count + k, count + next});
    }
  }
  return mesh;
}

/// The end of the tool on the bar, `off_mm` above its round, from one angle to another.
Sweep round_the_bar(double from, double to, double off_mm) {
  const auto at = [&](double angle) -> swarf::ToolPose {
    const Vec3 way(0, std::cos(angle), std::sin(angle));
    return {(20.0 + off_mm) * way, way};
  };
  return {at(from), at(to), 0};
}

swarf::proof::GougeBound gouge_of(const TriMesh& design, const Sweep& sweep, const CutterSolid& cutter) {
  const swarf::proof::SolidDesign solid(design, 0.0);
  const std::vector<Sweep> sweeps{sweep};
  const swarf::measure::SweepCutters cutters(cutter);
  const Progress silent;
  return swarf::proof::bound_gouges({solid, sweeps, cutters, 0.002, 0.0, silent});
}

TEST(BodyProof, AWideToolTurnsRoundABarWithoutGouging) {
  // The chord of the tip's way lies 20 (1 - cos 0.0025) = 0.06 um below its ends: the start is raised by it.
  const CutterSolid cutter(8.0, 30.0);
  const auto clear = gouge_of(bar(360), round_the_bar(0.3, 0.305, 0.0001), cutter);
  EXPECT_EQ(clear.open, 0U);
  const auto deep = gouge_of(bar(360), round_the_bar(0.3, 0.305, -0.0089), cutter);
  EXPECT_GE(deep.bound_mm, 0.0088);
  EXPECT_LE(deep.bound_mm, 0.0095);
  EXPECT_GE(deep.found_mm, 0.0080);
}

TEST(BodyProof, NoPointOfATurningToolIsDeeperThanTheBound) {
  std::mt19937 random(411);
  std::uniform_real_distribution<double> any(-1.0, 1.0), share(0.0, 1.0);
  swarf::cutter::Cutter ball;
  ball.shape = swarf::cutter::Shape::kBall;
  ball.diameter_mm = 6.0;
  ball.corner_radius_mm = 3.0;
  const TriMesh block = slotted_block();
  const swarf::proof::SolidDesign design(block, 0.0);
  for (int n = 0; n < 60; ++n) {
    const auto pose = [&](double tilt) -> swarf::ToolPose {
      return {Vec3(10 * any(random), 6 * any(random), 3.0 * share(random) - 3.5),
              Vec3(tilt * any(random), tilt * any(random), 1.0).normalized()};
    };
    const swarf::ToolPose start = pose(0.6);
    const Sweep sweep{start,
                      {start.tip_W + 2.0 * Vec3(any(random), any(random), 0.3 * any(random)),
                       (start.axis_W + 0.2 * Vec3(any(random), any(random), any(random))).normalized()},
                      0};
    const double radius = 3.0, height = 12.0;
    const CutterSolid cutter = n % 2 == 0 ? CutterSolid(radius, height) : CutterSolid(ball);
    const swarf::proof::GougeBound told = gouge_of(block, sweep, cutter);
    const swarf::stock::SweepMap map = swarf::stock::sweep_map(sweep);
    double deepest = 0.0;
    for (int i = 0; i < 4000; ++i) {
      const double t = share(random), turn = 2.0 * M_PI * share(random),
                   z = height * share(random) * share(random);
      const double rho =
          n % 2 == 0 ? radius : std::sqrt(std::max(0.0, 9.0 - std::pow(std::min(z, 3.0) - 3.0, 2)));
      // Where the tool's point is in the work, the axis turning evenly between close ends.
      const Vec3 home(rho * std::cos(turn), rho * std::sin(turn), z);
      const Vec3 from = map.R0t.transpose() * home + map.tip0, to = map.R1t.transpose() * home + map.tip1;
      const Vec3 p = from + t * (to - from);
      if (swarf::stock::swept_contact(p, map, cutter).distance_mm > 0.0) continue;
      deepest = std::max(deepest, -design.distance().at(p).distance_mm);
    }
    EXPECT_GE(told.bound_mm, deepest - 1e-6)
        << "seed 411, case " << n << ": " << start.tip_W.transpose() << " / " << start.axis_W.transpose()
        << " to " << sweep.end.tip_W.transpose() << " / " << sweep.end.axis_W.transpose();
    EXPECT_GE(told.bound_mm, told.found_mm - 1e-9);
  }
}

TEST(BodyProof, ACastPocketNeedsNoCuts) {
  // The raw stock is the slotted block itself, a mesh; what it has above is milled.
  const TriMesh cast =
      swarf::test::towers({-20, 20}, {-15, -5, 5, 15}, -10, [](int, int j) { return j == 1 ? -4.0 : 1.0; });
  const auto left = [&](double floor_mm) {
    TriMesh block = swarf::test::towers({-20, 20}, {-15, -5, 5, 15}, -10,
                                        [&](int, int j) { return j == 1 ? floor_mm : 0.0; });
    const swarf::proof::SolidDesign design(block, 0.0);
    Stock stock(swarf::stock::RawShape::of_mesh(cast, "cast"), 0.4);
    const std::vector<Sweep> rows{along_x(-8, 0, 0), along_x(8, 0, 1)};
    const CutterSolid cutter(10.0, 20.0);
    stock.cut(rows, cutter);
    const swarf::measure::SweepCutters cutters(cutter);
    Progress silent;
    return swarf::proof::bound_leftover({design, rows, cutters, stock, 0.0, 0.010, 0.0, silent});
  };
  const auto flush = left(-4.0);
  EXPECT_EQ(flush.open, 0U);
  EXPECT_EQ(flush.found_mm, 0.0);
  EXPECT_LE(flush.bound_mm, 0.010);
  EXPECT_EQ(left(-4.0099).found_mm, 0.0);
  EXPECT_NEAR(left(-4.02).found_mm, 0.020, 1e-5) << "the casting stands 20 um too high";
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

swarf::cutter::Cutter cutter_of(swarf::cutter::Shape shape, double diameter) {
  swarf::cutter::Cutter cutter;
  cutter.shape = shape;
  cutter.diameter_mm = diameter;
  cutter.flute_length_mm = 20.0;
  return cutter;
}

/// A ball; a V tool, a drill and a chamfer tool with sharp tips; a ball on a flank of 15 degrees.
std::vector<CutterSolid> cutters_to_reduce() {
  using swarf::cutter::Shape;
  std::vector<CutterSolid> cutters{CutterSolid(5.0, 20.0)};
  swarf::cutter::Cutter ball = cutter_of(Shape::kBall, 10.0);
  ball.corner_radius_mm = 5.0;
  cutters.emplace_back(ball);
  for (const double point : {30.0, 60.0, 90.0}) {
    swarf::cutter::Cutter chamfer = cutter_of(Shape::kChamfer, 6.0);
    chamfer.point_angle_rad = swarf::rad_from_deg(point);
    chamfer.tip_diameter_mm = 0.0;
    cutters.emplace_back(chamfer);
  }
  for (const double point : {118.0, 140.0}) {
    swarf::cutter::Cutter drill = cutter_of(Shape::kDrill, 6.8);
    drill.point_angle_rad = swarf::rad_from_deg(point);
    cutters.emplace_back(drill);
  }
  swarf::cutter::Cutter tapered = cutter_of(Shape::kTaper, 4.0);
  tapered.corner_radius_mm = 2.0;
  tapered.taper_rad = swarf::rad_from_deg(15.0);
  cutters.emplace_back(tapered);
  return cutters;
}

/// From a place (rho, z) to a profile whose corners go up along a convex outline, mm.
double distance_to(const swarf::collision::RevolvedSolid& solid, const Vec2& p) {
  std::vector<Vec2> chain{{0.0, solid.corners.front().y()}};
  const double lowest = solid.corners.front().y() + 1e-12;
  for (const Vec2& corner : solid.corners)
    if (corner.x() > 0.0 || corner.y() > lowest) chain.push_back(corner);
  chain.emplace_back(0.0, solid.corners.back().y());
  bool inside = true;
  double least = 1e9;
  for (size_t k = 0; k + 1 < chain.size(); ++k) {
    const Vec2 way = chain[k + 1] - chain[k], from = p - chain[k];
    const double length2 = way.squaredNorm();
    inside = inside && way.x() * from.y() - way.y() * from.x() >= 0.0;
    const double share = length2 > 0.0 ? std::clamp(from.dot(way) / length2, 0.0, 1.0) : 0.0;
    least = std::min(least, (from - share * way).norm());
  }
  return inside && solid.corners.size() > 2 ? 0.0 : least;
}

TEST(ToolBody, EveryPointOfTheCutterIsNearTheReducedBody) {
  int pointed = 0;
  for (const double g : {0.002, 0.05, 0.4}) {
    for (const CutterSolid& cutter : cutters_to_reduce()) {
      const auto& piece = cutter.pieces.front();
      const auto outline = swarf::proof::piece_body(piece, 1e-6).corners;
      for (const swarf::proof::ReducedBody& bodies : swarf::proof::reduced_bodies(piece, g)) {
        pointed += bodies.size() > 1 ? 1 : 0;
        for (size_t k = 0; k + 1 < outline.size(); ++k) {
          for (int i = 0; i <= 60; ++i) {
            // Denser near the lower corner, where a tip may be.
            const double share = std::pow(i / 60.0, 3.0);
            const Vec2 p = outline[k] + share * (outline[k + 1] - outline[k]);
            double least = 1e9;
            for (const auto& body : bodies) least = std::min(least, distance_to(body, p));
            ASSERT_LE(least, g + 2e-6) << "g " << g << ", place (" << p.x() << ", " << p.y() << "), radius "
                                       << piece.radius << ", bodies " << bodies.size();
          }
        }
      }
    }
  }
  EXPECT_EQ(pointed, 30);  // five tools with tips, two ways, three depths
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
