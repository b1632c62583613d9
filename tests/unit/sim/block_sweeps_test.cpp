// The bound that says into how many sweeps a block is cut, held against dense sampling of the true motion for
// random machines and blocks; and the sweeps of a CL job.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "sim/simulation.h"
#include "stock/sweep/sweep_map.h"
#include "unit/motion/random_block.h"

namespace swarf::motion::block_sweeps_test {
namespace {

using toolpath::BlockLaw;

/// Greatest distance, seen in the tool's meridian plane, between a point of the moving tool within the lever
/// and where the sweeps have it at that instant.
double measured_error(const BlockMotion& motion, int pieces, double lever) {
  constexpr int kInstants = 24, kRound = 8, kHeights = 5;
  double worst = 0.0;
  for (int piece = 0; piece < pieces; ++piece) {
    const double s0 = static_cast<double>(piece) / pieces, s1 = static_cast<double>(piece + 1) / pieces;
    const stock::SweepMap map = stock::sweep_map({pose_at(motion, s0), pose_at(motion, s1), 0});
    for (int k = 1; k < kInstants; ++k) {
      const double t = static_cast<double>(k) / kInstants;
      const ToolPose pose = pose_at(motion, s0 + t * (s1 - s0));
      const Vec3 e1 = pose.axis_W.unitOrthogonal(), e2 = pose.axis_W.cross(e1);
      for (int h = 0; h < kHeights; ++h) {
        const double height = -lever + 2.0 * lever * h / (kHeights - 1);
        const double rho = std::sqrt(std::max(0.0, lever * lever - height * height));
        for (int i = 0; i < kRound; ++i) {
          const double angle = 2.0 * kPi * i / kRound;
          const Vec3 x =
              pose.tip_W + height * pose.axis_W + rho * (std::cos(angle) * e1 + std::sin(angle) * e2);
          const Vec3 X = (1.0 - t) * map.start(x) + t * map.end(x);
          worst = std::max(worst, std::hypot(std::hypot(X.x(), X.y()) - rho, X.z() - height));
        }
      }
    }
  }
  return worst;
}

class SplitError : public testing::TestWithParam<BlockLaw> {};

TEST_P(SplitError, HoldsAndIsNotWasteful) {
  Rng rng(31 + static_cast<int>(GetParam()));
  double loosest = 0.0;
  for (int trial = 0; trial < 300; ++trial) {
    const RandomBlock c = random_block(rng, GetParam());
    const double lever = rng.uniform(5, 80);
    const int pieces = 1 + static_cast<int>(rng.uniform(0, 12));
    const MotionBounds bounds = motion_bounds(c.motion());
    const double bound = split_error(bounds, pieces, lever);
    if (!std::isfinite(bound)) continue;
    const double actual = measured_error(c.motion(), pieces, lever);
    ASSERT_LE(actual, bound * (1.0 + 1e-9) + 1e-10) << c.text() << " pieces " << pieces << " lever " << lever;
    if (bounds.turn_rate / pieces < 0.2) loosest = std::max(loosest, bound / actual);
  }
  EXPECT_LT(loosest, 4.0);
  RecordProperty("loosest", fmt::format("{:.3f}", loosest));
}

INSTANTIATE_TEST_SUITE_P(Laws, SplitError, testing::Values(BlockLaw::kTcp, BlockLaw::kJoint, BlockLaw::kEnds),
                         [](const auto& test) { return std::string(law_name(test.param)); });

}  // namespace
}  // namespace swarf::motion::block_sweeps_test

namespace swarf::sim {
namespace {

Job job_of(const std::string& text) {
  Job job;
  job.scene.kind = ProgramKind::kCl;
  job.machine.model = motion::paper_machine();
  Diagnostics diagnostics;
  job.cl = program::parse_cl(text, "test.cl", diagnostics);
  diagnostics.throw_if_errors();
  return job;
}

struct Swept {
  toolpath::ToolPath path;
  std::unique_ptr<motion::Cycles> cycles;
  motion::Trajectory trajectory;
};

Swept sweep_through(const Job& job) {
  Swept swept;
  Diagnostics diagnostics;
  Progress silent;
  swept.path = job_path(job, diagnostics).path;
  swept.cycles = std::make_unique<motion::Cycles>(swept.path.elements, machines_by_tool(job),
                                                  job.scene.tools.front(), job.scene.motion);
  motion::interpolate(*swept.cycles, silent);
  swept.trajectory = motion::trajectory_of(*swept.cycles);
  return swept;
}

TEST(JobSweeps, CollinearBlocksAreOneSweepOfTheLevelSetAndManyOfTheRays) {
  std::string text = "FEDRAT/3000\nGOTO/0,0,0\n";
  for (int i = 1; i <= 100; ++i) text += "GOTO/" + std::to_string(i) + "," + std::to_string(2 * i) + ",0\n";
  text += "GOTO/100,250,0\n";
  const Job job = job_of(text);
  const Swept swept = sweep_through(job);
  const JobSweeps stock = stock_sweeps(job, *swept.cycles);
  ASSERT_EQ(stock.sweeps.size(), 2U);
  EXPECT_EQ(stock.sources[stock.sweeps[0].block].element, 99);
  EXPECT_EQ(stock.sources[stock.sweeps[1].block].element, 100);
  EXPECT_LT(stock.error_bound_mm, 1e-9);
  const JobSweeps rays = ray_sweeps(job, *swept.cycles);
  EXPECT_EQ(rays.sweeps.size(), 101U);
}

TEST(JobSweeps, FollowEachOtherAndNameTheirElementAndCycle) {
  const Job job = job_of(
      "MULTAX/ON\nFEDRAT/1200\nGOTO/20,0,0,0,0.342020143,0.939692621\n"
      "GOTO/10,17,0,-0.296198133,0.171010072,0.939692621\nRAPID\nGOTO/10,17,40\n");
  const Swept swept = sweep_through(job);
  const motion::Trajectory& trajectory = swept.trajectory;
  motion::CycleReader reader(*swept.cycles);
  for (const JobSweeps& sweeps : {stock_sweeps(job, *swept.cycles), ray_sweeps(job, *swept.cycles)}) {
    ASSERT_GT(sweeps.sweeps.size(), 3U);
    EXPECT_LE(sweeps.error_bound_mm, job.scene.stock.sweep_tolerance_mm);
    for (size_t i = 0; i < sweeps.sweeps.size(); ++i) {
      EXPECT_EQ(sweeps.sweeps[i].block, i);
      if (i > 0) {
        EXPECT_EQ(sweeps.sweeps[i].start.tip_W, sweeps.sweeps[i - 1].end.tip_W);
      }
      const SweepSource& source = sweeps.sources[i];
      // The tool is where the sweep ends, as near as a cycle takes it.
      const ToolPose& at = trajectory.samples[cycle_of(source, reader)].pose;
      EXPECT_LT((at.tip_W - sweeps.sweeps[i].end.tip_W).norm(), 0.3) << "sweep " << i;
    }
    const std::vector<int> passes = pass_of_blocks(sweeps, swept.path);
    EXPECT_EQ(passes.front(), 0);
    EXPECT_EQ(passes.back(), -1) << "the rapid";
  }
}

double distance_to_way(const Vec3& from, const Vec3& to, const Vec3& p) {
  const Vec3 way = to - from;
  const double t = way.isZero() ? 0.0 : std::clamp((p - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (from + t * way - p).norm();
}

/// Greatest distance of the tool's tip and of its upper end from the sweeps, over places inside the cycles
/// where the axes have moved linearly.
double farthest_from_sweeps(const Job& job, const motion::Trajectory& trajectory, const JobSweeps& sweeps) {
  const std::vector<kinematics::MachineModel> machines = machines_by_tool(job);
  double worst = 0.0;
  for (const stock::Sweep& sweep : sweeps.sweeps) {
    const uint64_t cycle = *sweeps.sources[sweep.block].cycle;
    for (int k = 0; k <= 16; ++k) {
      const kinematics::AxisValues q =
          trajectory.axes[cycle - 1] + k / 16.0 * (trajectory.axes[cycle] - trajectory.axes[cycle - 1]);
      const ToolPose pose = kinematics::forward(machines.front(), q);
      const auto off = [&](double height) {
        const Vec3 at = pose.tip_W + height * pose.axis_W;
        double nearest = 1e9;
        for (const stock::Sweep& part : sweeps.sweeps) {
          if (*sweeps.sources[part.block].cycle != cycle) continue;
          const Vec3 a = part.start.tip_W + height * part.start.axis_W;
          nearest = std::min(nearest, distance_to_way(a, part.end.tip_W + height * part.end.axis_W, at));
        }
        return nearest;
      };
      worst = std::max({worst, off(0.0), off(lever_of(job.scene.tools.front()))});
    }
  }
  return worst;
}

// Ten-millisecond cycles that turn fast: the chord of a cycle is far from where the tool goes.
TEST(DrivenSweeps, StayWithinTheToleranceOfTheAxesMotion) {
  Job job = job_of(
      "MULTAX/ON\nFEDRAT/6000\nGOTO/20,0,0,0,0.342020143,0.939692621\n"
      "GOTO/10,17,0,-0.296198133,0.171010072,0.939692621\nGOTO/-20,17,0,0,0,1\n");
  job.scene.stock.cut_by = CutBy::kCycles;
  job.scene.motion.period_s = 0.01;
  const Swept swept = sweep_through(job);
  const JobSweeps rays = ray_sweeps(job, *swept.cycles);
  EXPECT_LE(rays.error_bound_mm, job.scene.design.sweep_tolerance_mm);
  EXPECT_GT(rays.sweeps.size(), 2 * swept.trajectory.samples.size()) << "turning cycles are divided";
  EXPECT_LT(farthest_from_sweeps(job, swept.trajectory, rays), job.scene.design.sweep_tolerance_mm);
  const JobSweeps level_set = stock_sweeps(job, *swept.cycles);
  EXPECT_LE(level_set.error_bound_mm, job.scene.stock.sweep_tolerance_mm);
  EXPECT_LT(level_set.sweeps.size(), rays.sweeps.size()) << "joined";
}

TEST(DrivenSweeps, FollowTheRoundedCornerAndKeepRapidsApart) {
  Job job =
      job_of("FEDRAT/3000\nGOTO/0,0,0\nGOTO/20,0,0\nGOTO/20,20,0\nRAPID\nGOTO/20,20,50\nGOTO/20,30,0\n");
  job.scene.stock.cut_by = CutBy::kCycles;
  const Swept swept = sweep_through(job);
  for (const JobSweeps& sweeps : {stock_sweeps(job, *swept.cycles), ray_sweeps(job, *swept.cycles)}) {
    double nearest = 1.0;
    for (size_t i = 0; i < sweeps.sweeps.size(); ++i) {
      const stock::Sweep& sweep = sweeps.sweeps[i];
      nearest = std::min(nearest, distance_to_way(sweep.start.tip_W, sweep.end.tip_W, Vec3(20, 0, 0)));
      if (i > 0) {
        EXPECT_EQ(sweep.start.tip_W, sweeps.sweeps[i - 1].end.tip_W);
      }
      const toolpath::BlockMove block =
          swept.path.elements.block(static_cast<size_t>(sweeps.sources[i].element));
      const bool lifts = sweep.end.tip_W.z() > sweep.start.tip_W.z() + 1e-3;
      EXPECT_TRUE(!lifts || is_rapid(block)) << "sweep " << i;
    }
    EXPECT_GT(nearest, 0.5 * job.scene.motion.corner_tolerance_mm);
    // A cycle's chord lies a little farther inside the corner than its ends.
    EXPECT_LT(nearest, 1.02 * job.scene.motion.corner_tolerance_mm);
  }
}

}  // namespace
}  // namespace swarf::sim
