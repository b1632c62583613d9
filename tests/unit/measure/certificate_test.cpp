#include "measure/certificate.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "base/angles.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "base/units.h"
#include "cutter/cutter.h"
#include "dome_cut.h"
#include "measure/measure.h"
#include "measure/root_proof.h"
#include "surface/analytic.h"
#include "test_surfaces.h"

namespace swarf::measure {
namespace {

/// A design with what cut it.
struct Job {
  stock::RayFieldPtr field;
  Box box;
  stock::CutterSolid cutter;
  std::vector<stock::Sweep> sweeps;
  double gouge_limit_mm = 2e-4, excess_limit_mm = 1.0;
};

void move(Job& job, const Vec3& from, const Vec3& to, const Vec3& axis = Vec3::UnitZ()) {
  job.sweeps.push_back({{from, axis}, {to, axis}, static_cast<uint32_t>(job.sweeps.size())});
}

Certificate prove(const Job& job, double voxel_mm = 0.5, bool asks_above = true) {
  stock::Stock stock(job.box, voxel_mm);
  stock.cut(job.sweeps, job.cutter);
  const stock::FreeRange ranges({&job.field, 1});
  const SweepCutters cutters(job.cutter);
  stock::SurfaceDexels dexels(job.field, job.box, {});
  dexels.cut(job.sweeps, job.cutter);
  double known = 0.0;
  for (const double height : dexels.heights_mm()) known = std::max(known, height);
  Progress progress;
  return certify({*job.field, ranges, job.sweeps, cutters, 0.0, stock, 0.0, job.gouge_limit_mm,
                  job.excess_limit_mm, asks_above, asks_above, job.excess_limit_mm, 0.0, known, progress});
}

surface::SurfacePtr plane(double length, double width) {
  return std::make_shared<surface::PlaneSurface>(Vec3(-0.5 * length, -0.5 * width, 0), Vec3(length, 0, 0),
                                                 Vec3(0, width, 0));
}

/// A closed box from -half to half, its top at z = 0, `deep` mm high.
TriMesh block(double half_x, double half_y, double deep) {
  TriMesh mesh;
  for (const float z : {static_cast<float>(-deep), 0.0F}) {
    for (const double y : {-half_y, half_y}) {
      for (const double x : {-half_x, half_x})
        mesh.positions.push_back({static_cast<float>(x), static_cast<float>(y), z});
    }
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// The top of a shaft of radius R along x, highest at z = 0.
surface::SurfacePtr shaft(double R) {
  surface::Turn turn;
  turn.base_W = {-5, 0, -R};
  turn.axis_W = Vec3::UnitX();
  turn.from_rad = 0.5 * kPi - 3.0 / R;
  turn.to_rad = 0.5 * kPi + 3.0 / R;
  return surface::cylinder_surface(turn, R, 10.0, surface::MaterialSide::kConvex);
}

/// z = -(x^2 + y^2) / 2R over 10 x 10 mm.
surface::SurfacePtr cap(double R) {
  return std::make_shared<Paraboloid>(1.0 / R, 1.0 / R, 5.0);
}

stock::CutterSolid chamfer(double point_angle_deg, double radius) {
  stock::CutterSolid cutter(radius, 25.0);
  cutter::ConvexPiece piece;
  const double half = 0.5 * rad_from_deg(point_angle_deg);
  piece.faces = {{{std::cos(half), -std::sin(half)}, 0.0}, {{1.0, 0.0}, radius}, {{0.0, 1.0}, 25.0}};
  piece.radius = radius;
  piece.low = 0.0;
  piece.high = 25.0;
  cutter.pieces = {piece};
  return cutter;
}

void rows(Job& job, double half_x, double from_y, double to_y, double step, double z = 0.0) {
  int sign = 1;
  for (double y = from_y; y <= to_y + 1e-9; y += step, sign = -sign)
    move(job, {-sign * half_x, y, z}, {sign * half_x, y, z});
}

// The case: a sharp cone of 60 deg .15 mm into a plane, along a line that no ray meets.
TEST(Certificate, SharpLineBetweenRaysHasItsDepthAtAnyPitch) {
  for (const double pitch : {0.07, 0.2, 0.5, 2.0}) {
    Job job{stock::rays_on_surface(plane(18, 9), pitch), {{-10, -5, -5}, {10, 5, 0}}, chamfer(60, 4), {}};
    move(job, {-8, 0.013, -0.15}, {8, 0.013, -0.15});
    const Certificate proof = prove(job);
    EXPECT_NEAR(proof.gouge_found_um, 150.0, 0.1) << pitch;
    EXPECT_GE(proof.gouge.um, 150.0 - 1e-6) << pitch;
    EXPECT_LE(proof.gouge.um, 150.0 + 0.1) << pitch;
    ASSERT_EQ(proof.gouges.size(), 1U) << pitch;
    // A groove 2 x .15 tan 30 wide; the area counts what is deeper than the limit.
    const double width = 2.0 * (0.15 - job.gouge_limit_mm) * std::tan(kPi / 6.0);
    EXPECT_NEAR(proof.gouges[0].area_mm2, 16.0 * width, 0.03 * 16.0 * width) << pitch;
    EXPECT_NEAR(proof.gouges[0].volume_mm3, 16.0 * 0.15 * 0.15 * std::tan(kPi / 6.0), 0.01) << pitch;
    EXPECT_EQ(proof.open_cells, 0U);
  }
}

// A flat D10 whose rows are 10.1 (10.01) apart leaves walls .1 (.01) thick as high as the stock.
TEST(Certificate, WallsBetweenPassesAreFound) {
  for (const double thick : {0.1, 0.01}) {
    for (const double pitch : {0.3, 1.0}) {
      Job job{stock::rays_on_surface(plane(20, 18), pitch), {{-20, -10, -5}, {20, 10, 3}}, {5.0, 25.0}, {}};
      job.excess_limit_mm = 0.01;
      rows(job, 30, -10 - thick, 10 + 2 * thick, 10 + thick);
      const Certificate proof = prove(job);
      EXPECT_NEAR(proof.excess_found_um, 3000.0, 1.0) << thick << ' ' << pitch;
      EXPECT_GE(proof.excess.um, 3000.0 - 1e-6);
      ASSERT_EQ(proof.excesses.size(), 2U) << thick << ' ' << pitch;
      EXPECT_NEAR(proof.excesses[0].area_mm2, 20.0 * thick, 20.0 * (0.1 * thick + 0.01));
    }
  }
}

TEST(Certificate, IslandBetweenFourPlunges) {
  // Four quarters of the plane are cut away; a cross .05 mm wide stays.
  Job job{stock::rays_on_surface(plane(16, 16), 0.5), {{-9, -9, -5}, {9, 9, 2}}, {5.0, 25.0}, {}};
  job.excess_limit_mm = 0.01;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-5.025, 5.025}) {
      move(job, {x > 0 ? 5.025 : -20.0, y, 0}, {x > 0 ? 20.0 : -5.025, y, 0});
    }
  }
  const Certificate proof = prove(job);
  EXPECT_NEAR(proof.excess_found_um, 2000.0, 1.0);
}

// theory 8: ball D10, rows 1 mm apart in X and in Y: the corner of four ridges.
TEST(Certificate, CrossingRidges) {
  Job job{stock::rays_on_surface(plane(8, 6), 0.37), {{-8, -8, -3}, {8, 8, 1}}, ball(5.0, 25.0), {}};
  job.excess_limit_mm = 0.025;  // below what is left: the bound is then made close
  rows(job, 12, -8, 8, 1.0);
  for (double x = -8; x <= 8; x += 1.0) move(job, {x, -12, 0}, {x, 12, 0});
  const Certificate proof = prove(job, 0.2);
  // The planes of both directions leave the same ridges: their crossing is as high as either.
  EXPECT_NEAR(proof.excess_found_um, 25.0628, 0.05);
  EXPECT_LE(proof.excess.um, 25.0628 + 0.06);
  EXPECT_GE(proof.excess.um, 25.0628);
  EXPECT_LE(proof.gouge.um, 0.05);
}

/// All around a block is cut away but what lies outside of all three faces of one corner.
TEST(Certificate, WhatStandsOutsideACornerOfAMeshIsFound) {
  Job job{stock::rays_on_mesh(block(6, 5, 4), 1.0), {{-7, -6, -4}, {7, 6, 1}}, {5.0, 25.0}, {}};
  job.excess_limit_mm = 1.6;
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  move(job, {6, 0, -20}, {6, 0, 20}, x);    // beside x = 6 where y <= 5
  move(job, {6, -20, -5}, {6, 20, -5}, x);  // and where z <= 0
  move(job, {-20, 5, -5}, {20, 5, -5}, y);  // beside y = 5 where z <= 0
  move(job, {1, -20, 0}, {1, 20, 0}, z);    // over z = 0 where x <= 6
  move(job, {-3, -20, 0}, {-3, 20, 0}, z);
  move(job, {-6, -20, -4}, {-6, 20, -4}, -x);
  move(job, {-20, -5, -4}, {20, -5, -4}, -y);
  const Certificate proof = prove(job);
  EXPECT_GE(proof.excess.um, 1000.0 * std::sqrt(3.0));
  EXPECT_LE(proof.excess.um, 1000.0 * std::sqrt(3.0) * 1.03);
  EXPECT_GE(proof.excess_found_um, 1000.0 * std::sqrt(3.0) * 0.97);
  EXPECT_LE(proof.gouge.um, 0.1);
}

// A column from the rim of a plate runs along its side face: none of it is its own, however far the cut goes
// on beyond the plate.
/// A disc cutter passes under a roof: nothing stands on the design, and the roof is told as high as it is
/// left, which a second pass over it lowers. Its cells are not divided for ever.
TEST(Certificate, ARoofAboveAGapIsMeasured) {
  for (const bool lowered : {false, true}) {
    Job job{stock::rays_on_surface(plane(10, 6), 0.5), {{-10, -5, -5}, {10, 5, 12}}, {8.0, 4.0}, {}};
    job.excess_limit_mm = 0.01;
    move(job, {-30, 0, 0}, {30, 0, 0});
    if (lowered) move(job, {-30, 0, 9}, {30, 0, 9});
    const Certificate proof = prove(job);
    const double roof_um = lowered ? 9000.0 : 12000.0;
    EXPECT_NEAR(proof.excess_found_um, roof_um, 1e-3);
    EXPECT_GE(proof.excess.um, roof_um);
    EXPECT_LE(proof.excess.um, roof_um + um_from_mm(above_gap(0.5)) + 1.0);
    EXPECT_LE(proof.scallop.um, 10.0);
    EXPECT_LE(proof.gouge.um, 0.2);
    EXPECT_EQ(proof.open_area_mm2, 0.0);
    EXPECT_LT(proof.cells, 50000U);
  }
}

TEST(Certificate, DepthAlongASideFaceIsNotOwn) {
  const stock::RayFieldPtr field = stock::rays_on_mesh(block(6, 5, 2), 1.0);
  for (const double depth : {0.5, 2.0, 35.0, 1e4})
    EXPECT_LT(field->own_depth({6, 0.3, -2}, {0, 0, -1}, depth), 1e-4) << depth;
}

// A wall .2 mm thick: the corners of its top all stand on edges, where no depth is the top's own. A short
// groove between them is, and as deep as it is.
TEST(Certificate, AGrooveInAThinWallWhoseCornersAllStandOnEdges) {
  for (const double x : {0.77, 2.1}) {
    Job job{
        stock::rays_on_mesh(block(4, 0.125, 3), 1.0), {{-4, -0.125, -3}, {4, 0.125, 0}}, ball(0.05, 5.0), {}};
    move(job, {x, 0, -0.03}, {x + 0.02, 0, -0.03});
    const Certificate proof = prove(job, 0.5, false);
    EXPECT_GE(proof.gouge.um, 30.0 - 1e-6) << x;
    EXPECT_LE(proof.gouge.um, 30.0 + 0.1) << x;
  }
}

/// A bar along Y: its top at z = 0 from x = 0 on, under it a face that goes down from the edge x = 0 by 30
/// deg.
TriMesh acute_bar(double length, double width) {
  TriMesh mesh;
  const auto deep = static_cast<float>(-length * std::tan(rad_from_deg(30.0))),
             l = static_cast<float>(length), w = static_cast<float>(width);
  mesh.positions = {{0, 0, 0}, {l, 0, 0}, {l, 0, deep}, {0, w, 0}, {l, w, 0}, {l, w, deep}};
  mesh.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  return mesh;
}

// A small ball mills the lower face of an acute edge exactly to size. Columns of the top meet it where the
// bar ends, less than a skin below: that is no gouge of the top, and one 20 um deep of the lower face is no
// deeper.
TEST(Certificate, BesideAnAcuteEdgeACutOfTheOtherFaceIsNone) {
  const double radius = 0.3, slope = rad_from_deg(30.0);
  const Vec3 out(-std::sin(slope), 0, -std::cos(slope)), along(std::cos(slope), 0, -std::sin(slope));
  for (const double deep : {0.0, 0.02}) {
    Job job{stock::rays_on_mesh(acute_bar(6, 8), 0.1), {{-1, -1, -4}, {7, 9, 1}}, ball(radius, 5.0), {}};
    const Vec3 tip = 0.6 * along + (radius - deep) * out + radius * Vec3::UnitZ();
    move(job, tip + Vec3(0, 2, 0), tip + Vec3(0, 6, 0), -Vec3::UnitZ());
    stock::SurfaceDexels dexels(job.field, job.box, {});
    dexels.cut(job.sweeps, job.cutter);
    dexels.limit_depths();
    double deepest = 0.0;
    for (const double height : dexels.heights_mm()) deepest = std::max(deepest, -height);
    EXPECT_LE(deepest, deep + 5e-5);
    EXPECT_GE(deepest, 0.6 * deep);
  }
}

// Ridges stand far above the excess limit. Where nothing is asked of them they break nothing, so that the
// proof of the gouge beside them has its whole budget; what is found of both is the same.
TEST(Certificate, WhatStandsBreaksNoLimitWhereNothingIsAskedOfIt) {
  Job job{stock::rays_on_mesh(block(4, 3, 2), 1.0), {{-4, -3, -2}, {4, 3, 1}}, ball(2.0, 25.0), {}};
  rows(job, 8, -3, 3, 1.5);
  stock::Stock stock(job.box, 0.5);
  stock.cut(job.sweeps, job.cutter);
  const stock::FreeRange ranges({&job.field, 1});
  const SweepCutters cutters(job.cutter);
  const SweepIndex index(job.sweeps, cutters);
  Progress progress;
  std::array<RootResult, 2> whole;
  for (const bool asks : {false, true}) {
    const CertificateInput input{.field = *job.field,
                                 .ranges = ranges,
                                 .sweeps = job.sweeps,
                                 .cutters = cutters,
                                 .stock = stock,
                                 .gouge_limit_mm = 2e-4,
                                 .excess_limit_mm = 0.01,
                                 .wants_excess = asks,
                                 .progress = progress};
    RootResult& all = whole[asks ? 1 : 0];
    for (const RootCell& root : root_cells(*job.field, 2.0)) {
      const RootResult one = prove_root(input, index, root, {100'000, 0});
      all.broken = all.broken || one.broken;
      all.gouge = std::max(all.gouge, one.gouge);
      all.excess_found = std::max(all.excess_found, one.excess_found);
    }
  }
  EXPECT_FALSE(whole[0].broken);
  EXPECT_TRUE(whole[1].broken);
  EXPECT_LT(whole[0].gouge, 2e-4);
  EXPECT_LT(whole[1].gouge, 2e-4);
  EXPECT_NEAR(whole[0].excess_found, whole[1].excess_found, 1e-3);
  EXPECT_GT(whole[1].excess_found, 0.1);  // ridges of .146 mm
}

TEST(Certificate, NothingWasCut) {
  Job job{stock::rays_on_surface(plane(8, 6), 1.0), {{-5, -4, -3}, {5, 4, 1}}, ball(2.0, 25.0), {}};
  job.excess_limit_mm = 0.01;
  const Certificate proof = prove(job);
  EXPECT_NEAR(proof.excess.um, 1000.0, 1.0);
  ASSERT_EQ(proof.excesses.size(), 1U);
  EXPECT_NEAR(proof.excesses[0].area_mm2, 48.0, 1e-6);
  EXPECT_NEAR(proof.excesses[0].volume_mm3, 48.0, 1e-3);
  EXPECT_LE(proof.gouge.um, 0.001 + 1e-9);  // what is not told from a touch
}

struct Planted {
  std::string about;
  Job job;
  double depth_um;
  uint32_t block;
};

/// A gouge of known depth: a move of `length` that comes `depth` below the design at its deepest.
Planted plant(Rng& rng) {
  const double depth = std::exp(rng.uniform(std::log(0.25e-3), std::log(20e-3)));
  const double length = std::exp(rng.uniform(std::log(0.02), std::log(3.0)));
  const double radius = std::exp(rng.uniform(std::log(0.5), std::log(5.0)));
  const double pitch = rng.uniform(0.1, 0.8);
  const int tool = static_cast<int>(rng.uniform(0, 3)), design = static_cast<int>(rng.uniform(0, 4));
  const double x = rng.uniform(-3, 3), y = rng.uniform(-2, 2);
  Planted planted;
  Job& job = planted.job;
  job.box = {{-6, -5, -4}, {6, 5, 0}};
  job.gouge_limit_mm = 0.5 * depth;
  job.cutter = tool == 0   ? ball(radius, 30.0)
               : tool == 1 ? stock::CutterSolid(radius, 30.0)
                           : chamfer(60, radius);
  // A flat end leans along its way; its lowest point is the rim, `behind` the tip.
  const double lean = tool == 1 ? rng.uniform(0.02, 0.3) : 0.0;
  const Vec3 axis(std::sin(lean), 0, std::cos(lean));
  const Vec3 rim = tool == 1 ? Vec3(radius * std::cos(lean), 0, -radius * std::sin(lean)) : Vec3(0, 0, 0);
  if (design == 0) job.field = stock::rays_on_surface(plane(10, 8), pitch);
  if (design == 1) job.field = stock::rays_on_mesh(block(6, 5, 4), pitch);
  if (design >= 2) {
    // The top of a shaft along x; the top of a dome, where the move must be short.
    const double R = design == 2 ? rng.uniform(10, 60) : rng.uniform(40, 60);
    job.field = stock::rays_on_surface(design == 2 ? shaft(R) : cap(R), pitch);
  }
  const double y_at = design >= 2 ? 0.0 : y;
  // On the dome the move turns about its top and is deepest in its middle.
  const double x_at = design == 3 ? -0.5 * length : x;
  const Vec3 from = Vec3(x_at, y_at, -depth) - rim, to = from + Vec3(length, 0, 0);
  move(job, from + Vec3(0, 0, 3), from + Vec3(0, 0, 1), axis);
  move(job, from, to, axis);
  planted.block = 1;
  planted.depth_um = um_from_mm(depth);
  planted.about = fmt::format("tool {} design {} depth {} um length {} radius {} pitch {} x {} y {} lean {}",
                              tool, design, planted.depth_um, length, radius, pitch, x, y_at, lean);
  return planted;
}

TEST(Certificate, PlantedGougesAreFoundBetweenTheRays) {
  const char* count = std::getenv("SWARF_PLANTED_GOUGES");
  Rng rng(8);
  for (int n = 0; n < (count != nullptr ? std::atoi(count) : 60); ++n) {
    const Planted planted = plant(rng);
    const Certificate proof = prove(planted.job);
    const std::string where = fmt::format("case {}: {}", n, planted.about);
    EXPECT_NEAR(proof.gouge_found_um, planted.depth_um, 0.05 + 5e-4 * planted.depth_um) << where;
    EXPECT_GE(proof.gouge.um, planted.depth_um - 1e-6) << where;
    EXPECT_LE(proof.gouge.um, planted.depth_um + 0.1 + 1e-3 * planted.depth_um)
        << where
        << fmt::format("\n  loosest about ({}, {}, {}), {} open cells of {}, {:.4g} mm2",
                       proof.gouge.place.x(), proof.gouge.place.y(), proof.gouge.place.z(), proof.open_cells,
                       proof.cells, proof.open_area_mm2);
    EXPECT_EQ(proof.gouges.size(), 1U) << where;
    ASSERT_FALSE(proof.gouges.empty());
    EXPECT_EQ(proof.gouges[0].block, planted.block) << where;
    EXPECT_GT(proof.gouges[0].area_mm2, 0.0) << where;
    EXPECT_GT(proof.gouges[0].volume_mm3, 0.0) << where;
  }
}

/// Rays far denser than the cells find nothing beyond the bounds, and the bounds are close.
TEST(Certificate, DenseRaysOfTheDomeStayWithinTheBounds) {
  const surface::SurfacePtr surface = dome();
  const Passes passes = dome_passes(*surface, true, 30, 0.01, 0.06);
  Job job{stock::rays_on_surface(surface, 1.0), kDomeBox, kCutter, passes.sweeps, 5e-5, 0.0235};
  const Certificate proof = prove(job, 1.0);
  stock::SurfaceDexels dexels(stock::rays_on_surface(surface, 0.13), kDomeBox, {});
  dexels.cut(job.sweeps, job.cutter);
  double low = 0.0, high = 0.0;
  for (const double height : dexels.heights_mm()) {
    low = std::min(low, height);
    high = std::max(high, height);
  }
  EXPECT_GE(proof.excess.um, um_from_mm(high));
  EXPECT_LE(proof.excess.um, proof.excess_found_um * 1.001 + 0.06);
  EXPECT_GE(proof.gouge.um, um_from_mm(-low));
  EXPECT_LE(proof.gouge.um, proof.gouge_found_um * 1.001 + 0.06);
  EXPECT_EQ(proof.open_cells, 0U);
}

TEST(Certificate, IsEqualForAnyNumberOfThreads) {
  Rng rng(3);
  const Planted planted = plant(rng);
  set_thread_count(1);
  const Certificate one = prove(planted.job);
  set_thread_count(0);
  const Certificate all = prove(planted.job);
  EXPECT_EQ(one.gouge.um, all.gouge.um);
  EXPECT_EQ(one.excess.um, all.excess.um);
  EXPECT_EQ(one.cells, all.cells);
  ASSERT_EQ(one.gouges.size(), all.gouges.size());
  for (size_t i = 0; i < one.gouges.size(); ++i) EXPECT_EQ(one.gouges[i].area_mm2, all.gouges[i].area_mm2);
}

TEST(Certificate, DepthIsMaterialNotTravel) {
  // A ball goes 25 mm down through a plate of 2 mm.
  Job job{stock::rays_on_surface(plane(18, 9), 0.5), {{-10, -5, -2}, {10, 5, 0}}, ball(1.0, 40.0), {}};
  move(job, {0, 0, 5}, {0, 0, -25});
  const Certificate proof = prove(job);
  EXPECT_NEAR(proof.gouge_found_um, 2000.0, 1e-6);
  ASSERT_EQ(proof.gouges.size(), 1U);
  EXPECT_NEAR(proof.gouges[0].area_mm2, kPi, 0.02);
}

}  // namespace
}  // namespace swarf::measure
