// A design of exact surfaces under coarse facets is measured and proven as the surfaces are, not as the
// facets.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "base/units.h"
#include "cutter/cutter.h"
#include "half_shaft.h"
#include "measure/certificate.h"
#include "measure/design_cell.h"
#include "stock/rays/free_ranges.h"
#include "stock/rays/surface_dexels.h"
#include "surface/analytic.h"
#include "surface/under_facets.h"

namespace swarf::measure {
namespace {

Certificate prove_faces(const stock::RayFieldPtr& field, double depth_mm) {
  const Box box{{-6, -21, -21}, {6, 21, 1}};
  const stock::CutterSolid cutter(3.0, 30.0);
  // A flat end across the top of the shaft, `depth` below it, and one beside it that touches nothing.
  const std::vector<stock::Sweep> sweeps{
      {{{-6, 0, -depth_mm}, Vec3::UnitZ()}, {{6, 0, -depth_mm}, Vec3::UnitZ()}, 0}};
  stock::Stock stock(box, 0.5);
  stock.cut(sweeps, cutter);
  const stock::FreeRange ranges({&field, 1});
  const SweepCutters cutters(cutter);
  Progress progress;
  return certify(
      {*field, ranges, sweeps, cutters, 0.0, stock, 0.0, 2e-4, 1.0, false, false, 1.0, 0.0, 0.0, progress});
}

TEST(FacesCertificate, RaysStandOnTheSurfaceAndNotOnItsFacets) {
  const HalfShaft part = half_shaft(24);  // facets stray by 43 um
  const stock::RayFieldPtr field = stock::rays_on_mesh(part.mesh, 0.4, stock::kCrease, part.under);
  size_t curved = 0;
  for (size_t i = 0; i < field->size(); ++i) {
    const Vec3 out(0, field->points[i].y(), field->points[i].z() + kShaftRadius);
    const Vec3& n = field->normals[i];
    if (std::abs(n.x()) > 0.5 || n.z() < -0.5) continue;
    ++curved;
    ASSERT_NEAR(out.norm(), kShaftRadius, 1e-9);
    ASSERT_NEAR(n.dot(out.normalized()), 1.0, 1e-9);
  }
  EXPECT_GT(curved, 1000U);
  const auto foot = field->between(field->edges[5][0], field->edges[5][1], 0.37);
  EXPECT_GT(field->size(), 0U);
  EXPECT_TRUE(foot.point.allFinite());
}

TEST(FacesCertificate, AGougeIsAsDeepAsUnderTheSurfaceHoweverCoarseTheFacets) {
  for (const int sides : {24}) {
    const HalfShaft part = half_shaft(sides);
    for (const double depth_um : {0.0, 5.0}) {
      SCOPED_TRACE(testing::Message() << sides << " sides, " << depth_um << " um");
      const Certificate proof = prove_faces(stock::rays_on_mesh(part.mesh, 0.4, stock::kCrease, part.under),
                                            depth_um * kMicrometre);
      EXPECT_NEAR(proof.gouge_found_um, depth_um, 0.025 + 1e-3 * depth_um);
      EXPECT_GE(proof.gouge.um, depth_um - 1e-6);
    }
  }
}

// A rim .2 mm thick: every corner of its curved facets stands on one of its two edges, where nothing is the
// rim's own. A groove between them is its own, and as deep as it is.
TEST(FacesCertificate, AGrooveInARimWhoseCornersAllStandOnEdges) {
  const HalfShaft part = half_shaft(24, 0.1);
  const stock::RayFieldPtr field = stock::rays_on_mesh(part.mesh, 1.0, stock::kCrease, part.under);
  constexpr double kBall = 0.05, kDeep = 0.03;
  cutter::Cutter ball;
  ball.shape = cutter::Shape::kBall;
  ball.diameter_mm = 2.0 * kBall;
  ball.corner_radius_mm = kBall;
  ball.flute_length_mm = 5.0;
  for (const double y : {0.9, 1.4}) {
    const double top = std::sqrt(kShaftRadius * kShaftRadius - y * y) - kShaftRadius;
    const Vec3 tip(0, y, top - kDeep);
    const std::vector<stock::Sweep> sweeps{
        {{tip, Vec3::UnitZ()}, {tip + Vec3(0, 0.02, 0), Vec3::UnitZ()}, 0}};
    const Box box{{-1, -21, -21}, {1, 21, 1}};
    const stock::CutterSolid solid(ball);
    stock::Stock stock(box, 0.5);
    stock.cut(sweeps, solid);
    const stock::FreeRange ranges({&field, 1});
    const SweepCutters cutters(solid);
    Progress progress;
    const Certificate proof = certify(
        {*field, ranges, sweeps, cutters, 0.0, stock, 0.0, 2e-4, 1.0, false, false, 1.0, 0.0, 0.0, progress});
    // Along the normal of the rim, which leans by 4 degrees at most.
    EXPECT_GE(proof.gouge.um, 1e3 * kDeep - 0.1) << y;
    EXPECT_LE(proof.gouge.um, 1e3 * kDeep + 2.0) << y;
  }
}

// The same cuts measured on the facets: what the surfaces spare.
TEST(FacesCertificate, FacetsAloneWouldErrByTheirChord) {
  const HalfShaft part = half_shaft(25);  // an odd number: the middle of a facet lies at the top
  const Certificate proof = prove_faces(stock::rays_on_mesh(part.mesh, 0.4), 60.0 * kMicrometre);
  EXPECT_LT(proof.gouge_found_um, 60.0 - 35.0);
}

/// What memory is asked for before the cells are made.
TEST(RootCells, AreAboutAsManyAsExpected) {
  const HalfShaft part = half_shaft(24, 30.0);
  for (const stock::RayFieldPtr& field :
       {stock::rays_on_mesh(part.mesh, 1.0, stock::kCrease, part.under), stock::rays_on_mesh(part.mesh, 1.0),
        stock::RayFieldPtr(stock::rays_on_surface(part.under->surfaces.front(), 1.0))}) {
    for (const double size_mm : {0.5, 1.0, 3.0}) {
      const double made = static_cast<double>(root_cells(*field, size_mm).size());
      const double expected = expected_roots(*field, size_mm);
      std::printf("cells of %.1f mm: expected %.0f, made %.0f\n", size_mm, expected, made);
      EXPECT_NEAR(expected / made, 1.0, 0.3) << "of " << size_mm << " mm";
    }
  }
}

}  // namespace
}  // namespace swarf::measure
