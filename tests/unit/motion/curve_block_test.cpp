// Blocks on one smooth curve are passed without corners: the tool stays on the curve, the feed does not sink
// at their joints, and the axes keep their limits.
#include <gtest/gtest.h>

#include <cmath>

#include "motion/blocks/block_motion.h"
#include "toolpath/pose_curve.h"
#include "unit/motion/random_program.h"

namespace swarf::motion::curve_block_test {
namespace {

constexpr double kRadius = 20.0, kLean = 0.2;

/// A half circle, the axis leaning outwards and a little more on the way.
ToolPose on_circle(double way) {
  const double angle = way / kRadius, lean = kLean + 0.1 * std::sin(angle);
  const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
  return {kRadius * out + Vec3(0, 0, 10), std::cos(lean) * Vec3::UnitZ() + std::sin(lean) * out};
}

std::shared_ptr<const toolpath::PoseCurve> half_circle() {
  constexpr int kSteps = 128;
  const double step = M_PI * kRadius / kSteps;
  std::vector<ToolPose> poses;
  for (int i = 0; i <= kSteps; ++i) poses.push_back(on_circle(i * step));
  return std::make_shared<const toolpath::PoseCurve>(step, poses);
}

toolpath::ToolPath path_on(const std::shared_ptr<const toolpath::PoseCurve>& curve, int blocks, double feed) {
  toolpath::ToolPath path;
  const double length = curve->length_mm();
  for (int i = 0; i < blocks; ++i) {
    toolpath::BlockMove block;
    const double from = length * i / blocks, to = length * (i + 1) / blocks;
    block.from = curve->pose(from);
    block.to = curve->pose(to);
    block.curve = toolpath::CurveSpan{curve, from, to};
    block.law = toolpath::BlockLaw::kCurve;
    block.feed_mm_s = feed;
    block.pass = 0;
    path.elements.push_back({block, 0, {}});
  }
  return path;
}

TEST(CurveBlocks, AreOneMotion) {
  const auto curve = half_circle();
  const kinematics::MachineModel machine = paper_machine();
  MotionOptions options;
  Progress silent;
  constexpr double kFeed = 15.0;
  double whole = 0.0;
  for (const int blocks : {1, 7, 40}) {
    const Interpolated result = interpolate(path_on(curve, blocks, kFeed), machine, {}, options, silent);
    double slowest = kFeed;
    const std::vector<ToolSample>& samples = result.trajectory.samples;
    for (size_t k = 0; k < samples.size(); ++k) {
      const Vec3& tip = samples[k].pose.tip_W;
      EXPECT_NEAR(std::hypot(tip.x(), tip.y()), kRadius, 1e-5);
      EXPECT_FALSE(samples[k].rounded);
      const bool inside = k > samples.size() / 4 && k < 3 * samples.size() / 4;
      if (inside) slowest = std::min(slowest, samples[k].feed_mm_s);
    }
    EXPECT_GT(slowest, 0.999 * kFeed) << blocks;
    if (blocks == 1) whole = result.statistics.time_s;
    EXPECT_NEAR(result.statistics.time_s, whole, 0.02 * whole) << blocks;
    const Excess excess = axis_excess(result.trajectory, machine);
    EXPECT_LE(excess.relative, 0.0) << excess.text;
  }
}

TEST(CurveBlocks, SweepsStayWithinTheirBound) {
  const auto curve = half_circle();
  const kinematics::MachineModel machine = paper_machine();
  BlockMotion motion;
  motion.machine = &machine;
  motion.block = path_on(curve, 3, 10.0).elements.block(1);
  const std::vector<ToolPose> poses = subdivide(motion, 40.0, 1e-3);
  ASSERT_GT(poses.size(), 10U);
  // A point of the tool at the lever: between two poses it is nowhere farther from its straight way.
  for (size_t i = 0; i + 1 < poses.size(); ++i) {
    const double middle = (static_cast<double>(i) + 0.5) / static_cast<double>(poses.size() - 1);
    const ToolPose at = pose_at(motion, middle);
    for (const double height : {0.0, 40.0}) {
      const Vec3 straight = 0.5 * (poses[i].tip_W + height * poses[i].axis_W + poses[i + 1].tip_W +
                                   height * poses[i + 1].axis_W);
      EXPECT_LT((at.tip_W + height * at.axis_W - straight).norm(), 1e-3);
    }
  }
}

}  // namespace
}  // namespace swarf::motion::curve_block_test
