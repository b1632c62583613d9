// A block that leaves the pole: the table turns at rest first, within the limits of every axis.
#include "motion/blocks/pole_turn.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "base/units.h"
#include "motion/interpolator.h"
#include "motion/judged/motion_check.h"
#include "sim/simulation.h"
#include "support/program_run.h"

namespace swarf::sim::pole_turn_test {
namespace {

/// Away from the pole in the direction `azimuth` by `tilt`, straight to (10, 4, 5), back, and away to the
/// other side.
std::string path_text(double azimuth_rad, double tilt_rad) {
  const auto axis = [&](double azimuth) {
    return fmt::format("{:.15f},{:.15f},{:.15f}", std::sin(tilt_rad) * std::cos(azimuth),
                       std::sin(tilt_rad) * std::sin(azimuth), std::cos(tilt_rad));
  };
  return fmt::format(
      "MULTAX/ON\nSPINDL/8000,CLW\nFEDRAT/500,MMPM\nFROM/0,0,20,0,0,1\nGOTO/3,1,5,0,0,1\nGOTO/10,4,5,{0}\n"
      "GOTO/3,1,5,0,0,1\nGOTO/10,-4,5,{1}\nGOTO/0,0,20,0,0,1\nFINI\n",
      axis(azimuth_rad), axis(azimuth_rad + 2.0));
}

Job job_of(const std::string& path) {
  const auto folder = test::fresh_folder("pole_turn");
  test::write_text((folder / "path.cl").string(), path);
  test::write_text((folder / "scene.toml").string(),
                   "machine = \"" SWARF_SOURCE_DIR
                   "/assets/machines/mikron_ucp710/machine.toml\"\ncl = \"path.cl\"\n"
                   "[cutter]\ndiameter_mm = 10\nflute_length_mm = 25\nlength_mm = 60\n"
                   "[setup]\nwork_origin_mm = [0, 0, 120]\n"
                   "[stock]\nbox_mm = [[-20, -20, 0], [20, 20, 10]]\nvoxel_mm = 1\n"
                   "[design]\nkind = \"none\"\n");
  return load_job((folder / "scene.toml").string(), {});
}

TEST(PoleTurn, NoAxisIsAskedForMoreThanItCan) {
  Rng rng(61352);
  for (int n = 0; n < 8; ++n) {
    const double azimuth = rng.uniform(-kPi, kPi), tilt = rng.uniform(0.02, 0.5);
    const std::string which = fmt::format("azimuth {:.17g} tilt {:.17g}", azimuth, tilt);
    const Job job = job_of(path_text(azimuth, tilt));
    Progress silent;
    const MeasuredPath moved = move_tool(job, silent);
    for (const motion::MotionFinding& finding : moved.motion.findings)
      EXPECT_NE(finding.severity, Severity::kError) << which << "\n" << finding.text;
    EXPECT_LT(moved.motion.statistics.fk_ik_error_max_mm, 1e-9) << which;
    EXPECT_EQ(motion::check_motion(motion::trajectory_of(*moved.cycles), job.machine.model), "") << which;
    for (size_t i = 0; i < job.machine.model.axes.size(); ++i) {
      const kinematics::Axis& axis = job.machine.model.axes[i];
      EXPECT_LE(moved.motion.statistics.axes[i].acceleration_max, 1.02 * axis.acceleration_max)
          << which << " axis " << axis.name;
    }
  }
}

TEST(PoleTurn, TakesTheTimeOfItsAxis) {
  const Job job = job_of(path_text(1.2, 0.2));
  const std::vector<kinematics::MachineModel> machines = machines_by_tool(job);
  const kinematics::InverseKinematics inverse(machines.front());
  // On the table's centre the linear axes stand: the turn is the rotary axis' alone.
  const ToolPose pose{{0, 0, 30}, Vec3::UnitZ()};
  const kinematics::AxisValues from = inverse.solve_nearest(pose, kinematics::AxisValues::Zero()).q;
  kinematics::AxisValues to = from;
  const auto c = static_cast<Eigen::Index>(job.machine.model.axes.size() - 1);
  to[c] += 2.0;
  const motion::PoleTurn turn(inverse, machines.front(), pose, from, to);
  EXPECT_NEAR(turn.at(turn.duration_s())[c], to[c], 1e-12);
  EXPECT_GE(turn.duration_s(), 2.0 / job.machine.model.axes.back().speed_max);
  double before = from[c];
  for (double t = 0.0; t <= turn.duration_s(); t += 1e-3) {
    const kinematics::AxisValues q = turn.at(t);
    EXPECT_LE(std::abs(q[c] - before), 1e-3 * job.machine.model.axes.back().speed_max);
    EXPECT_LT((kinematics::forward(machines.front(), q).tip_W - pose.tip_W).norm(), 1e-9);
    before = q[c];
  }
}

}  // namespace
}  // namespace swarf::sim::pole_turn_test
