// Tilted and leaned driven tools against closed forms.
#include "toolpath/driven/leaned_guide.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"

namespace swarf::toolpath {
namespace {

cutter::Cutter ball() {
  cutter::Cutter tool;
  tool.shape = cutter::Shape::kBall;
  tool.diameter_mm = 6.0;
  tool.corner_radius_mm = 3.0;
  return tool;
}

/// A ball of radius 3 on a sphere of radius 20 about the origin, along any axis.
class Sphere final : public position::Target {
 public:
  void raise(const position::ToolProfile&, const position::GuideLine& line, position::Rest& best,
             position::Near&) const override {
    const Vec3 c = line.local(Vec3::Zero());
    const double d = c.head<2>().norm(), root = std::sqrt(23.0 * 23.0 - d * d);
    best.height = c.z() + root - 3.0;
    best.what = position::Touched::kFace;
    best.gradient = c.head<2>() / root;
  }
};

DrivenPart sphere_part() {
  return {{{std::make_shared<Sphere>()}, {}}, position::ToolProfile(ball())};
}

DrivenPass leaned_pass(double lead, double tilt) {
  DrivenPass pass;
  pass.on = std::make_shared<DrivenPart>(sphere_part());
  const GuideCurve curve({guide_line({-9.0, 2.0}, {9.0, 2.0})});
  pass.guide = std::make_shared<LeanedGuide>(curve, lean_curve(*pass.on, {curve}, {lead, tilt, 2.0}, {}), 0.0,
                                             pivot_height(pass.on->profile));
  return pass;
}

TEST(LeanedGuide, BallsCentreStaysOnTheParallelSphere) {
  const DrivenPass pass = leaned_pass(rad_from_deg(12.0), rad_from_deg(-8.0));
  position::Near near;
  for (int i = 0; i <= 180; ++i) {
    const ToolPose pose = tip_at(pass, 0.1 * i, near).pose;
    ASSERT_NEAR((pose.tip_W + 3.0 * pose.axis_W).norm(), 23.0, 1e-11) << i;
  }
}

TEST(LeanedGuide, AxisIsTheNormalLeanedByLeadAndTilt) {
  const double lead = rad_from_deg(12.0), tilt = rad_from_deg(-8.0);
  const DrivenPass pass = leaned_pass(lead, tilt);
  for (int i = 20; i <= 160; ++i) {  // but for the ends, where the curve goes on as its reflection
    const Vec3 at(-9.0 + 0.1 * i, 2.0, std::sqrt(529.0 - std::pow(-9.0 + 0.1 * i, 2) - 4.0));
    const Vec3 normal = at.normalized(), feed = Vec3(1.0, 0.0, -at.x() / at.z()).normalized();
    const Vec3 exact = pose_in_contact(Vec3::Zero(), normal, feed, lead, tilt, {0.0}).axis_W;
    // Averaged over 2 mm: h^2 / 6 of the second derivative, h = .5 mm, 1/(23 mm)^2.
    ASSERT_LT((pass.guide->line(0.1 * i).axis_W - exact).norm(), 2e-4) << i;
  }
}

TEST(LeanedGuide, TurnedDirectionsAreOrthonormalAndUprightOnesExact) {
  const position::GuideLine up = position::turned_line(Vec3::Zero(), Vec3::UnitZ());
  EXPECT_EQ(up.x_W, Vec3(Vec3::UnitX()));
  EXPECT_EQ(up.y_W, Vec3(Vec3::UnitY()));
  for (const Vec3& a : {Vec3(0.6, 0.0, 0.8), Vec3(-0.48, 0.6, 0.64), Vec3(0.0, 0.6, -0.8), Vec3(0, 0, -1)}) {
    const position::GuideLine line = position::turned_line(Vec3::Zero(), a);
    EXPECT_LT((line.x_W.cross(line.y_W) - a).norm(), 1e-12);
    EXPECT_NEAR(line.x_W.norm(), 1.0, 1e-12);
  }
}

// A level floor under a tilted tool: theory 3's planes of slope tan(b), seen along the axis.
TEST(LeanedGuide, FloorStopsATiltedToolAtItsRim) {
  const double b = rad_from_deg(20.0);
  const position::GuideLine line = position::turned_line({1.0, 2.0, 5.0}, {std::sin(b), 0.0, std::cos(b)});
  position::Near near;
  position::Part part;
  part.floor_mm = -1.0;
  const double on_axis = -6.0 / std::cos(b);
  const position::Rest round = part.rest(position::ToolProfile(ball()), line, near);
  EXPECT_NEAR(round.height, on_axis - 3.0 + 3.0 / std::cos(b), 1e-12);
  EXPECT_NEAR(round.contact_W.z(), -1.0, 1e-12);
  cutter::Cutter flat;
  flat.diameter_mm = 6.0;
  EXPECT_NEAR(part.rest(position::ToolProfile(flat), line, near).height, on_axis + 3.0 * std::tan(b), 1e-12);
}

TEST(LeanedGuide, TooLowAnAxisIsRefused) {
  EXPECT_THROW(leaned_pass(rad_from_deg(80.0), 0.0), InputError);
}

}  // namespace
}  // namespace swarf::toolpath
