// scenes/lin_koren_dome/dome.nc: what it says, and the oracles of theory 1.6 on what was read.
#include "surface/curvature.h"
#include "unit/program/support.h"

namespace swarf::program {
namespace {

TEST(Dome, SaysWhatItsBlocksSay) {
  const Program program = parse_clean(dome_text());
  EXPECT_EQ(program.blocks, 12);
  ASSERT_EQ(program.surfaces.size(), 1U);
  EXPECT_EQ(program.surfaces[0].number, 1);
  EXPECT_EQ(program.surfaces[0].where.line, 6);
  ASSERT_EQ(program.operations.size(), 1U);
  const Operation& operation = program.operations[0];
  EXPECT_EQ(operation.kind, OperationKind::kArea);
  EXPECT_EQ(operation.surface, 0);
  EXPECT_EQ(operation.start, StartBoundary::kV0);
  EXPECT_TRUE(operation.zigzag);
  EXPECT_EQ(operation.scallop_mm, 0.01);
  EXPECT_EQ(operation.chord_tolerance_mm, 0.001);
  EXPECT_EQ(operation.feed_mm_s, 50.0);
  EXPECT_EQ(operation.lead_rad, 0.0);
  EXPECT_EQ(operation.tilt_rad, 0.0);
  EXPECT_EQ(operation.tool, 1);
  EXPECT_EQ(operation.spindle_rpm, 12000.0);
  EXPECT_EQ(operation.where.line, 13);
  EXPECT_EQ(operation.where.column, 6);
}

TEST(Dome, IsTheSurfaceOfTheTheory) {
  const Program program = parse_clean(dome_text());
  ASSERT_EQ(program.surfaces.size(), 1U);
  const auto& dome = *program.surfaces[0].surface;
  EXPECT_LT((dome.point(0.3, 0.6) - Vec3(-20.0, 8.0, 31.2)).norm(), 1e-12);
  const auto shape = surface::shape_at(dome.derivatives(0.5, 0.5), dome.outward_sign());
  EXPECT_NEAR(surface::principal_curvatures(shape).low, 0.016, 1e-15);
  EXPECT_NEAR(surface::principal_curvatures(shape).high, 0.01875, 1e-15);
  EXPECT_NEAR(surface::gaussian_curvature(shape), 3.0e-4, 1e-17);
}

TEST(Dome, LoadsFromItsFile) {
  Diagnostics warnings;
  EXPECT_EQ(load_program(project_file("scenes/lin_koren_dome/dome.nc"), &warnings).operations.size(), 1U);
  EXPECT_TRUE(warnings.list().empty());
}

}  // namespace
}  // namespace swarf::program
