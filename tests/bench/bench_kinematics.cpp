// Time of the kinematics, one thread: forward and the nearest branch on the paper's machine, all branches on
// every shipped five-axis machine.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "base/rng.h"
#include "kinematics/machine_model.h"
#include "machine/machine_scene.h"

namespace swarf::kinematics {
namespace {

MachineModel shipped(const std::string& name) {
  return machine::load_machine(SWARF_SOURCE_DIR "/assets/machines/" + name + "/machine.toml").model;
}

MachineModel paper_machine() {
  return shipped("lin_koren_xyzab");
}

/// Poses in no order, so that the branch predictor learns nothing.
std::vector<ToolPose> random_poses() {
  Rng rng(5);
  std::vector<ToolPose> poses(4096);
  for (ToolPose& pose : poses) {
    pose = {100.0 * Vec3(rng.uniform(-1.0), rng.uniform(-1.0), rng.uniform()), rng.direction()};
  }
  return poses;
}

/// Poses along a cut: a circle of axes 30 degrees off the pole.
std::vector<ToolPose> path_poses() {
  std::vector<ToolPose> poses(4096);
  for (size_t i = 0; i < poses.size(); ++i) {
    const double s = 2.0 * kPi * static_cast<double>(i) / static_cast<double>(poses.size());
    poses[i] = {{50.0 * std::cos(s), 40.0 * std::sin(s), 30.0},
                {0.5 * std::sin(s), 0.5 * std::cos(s), std::sqrt(0.75)}};
  }
  return poses;
}

void nearest(benchmark::State& state, const std::vector<ToolPose>& poses) {
  const InverseKinematics inverse(paper_machine());
  AxisValues q = AxisValues::Zero();
  size_t i = 0;
  for (auto _ : state) {
    q = inverse.solve_nearest(poses[i++ % poses.size()], q).q;
    benchmark::DoNotOptimize(q);
  }
}

void BM_SolveNearestAlongPath(benchmark::State& state) {
  nearest(state, path_poses());
}
void BM_SolveNearestRandom(benchmark::State& state) {
  nearest(state, random_poses());
}

/// All branches of poses in the upper half space, in no order, which every five-axis machine here reaches.
void all_branches(benchmark::State& state, const std::string& name) {
  const InverseKinematics inverse(with_tool(shipped(name), 120.0));
  std::vector<ToolPose> poses = random_poses();
  for (ToolPose& pose : poses) pose.axis_W.z() = std::abs(pose.axis_W.z());
  size_t i = 0;
  for (auto _ : state) {
    const InverseSolutions both = inverse.solve(poses[i++ % poses.size()], AxisValues::Zero());
    benchmark::DoNotOptimize(both);
  }
}

void BM_AllBranches(benchmark::State& state) {
  static const char* const names[] = {"mikron_ucp710",   "nutating_head", "fork_head",     "head_table_bc",
                                      "lin_koren_xyzab", "maho_600c",     "spinner_u5_620"};
  const char* name = names[state.range(0)];
  state.SetLabel(name);
  all_branches(state, name);
}

void BM_Forward(benchmark::State& state) {
  const MachineModel machine = paper_machine();
  AxisValues q;
  q << 10.0, 20.0, 30.0, 0.4, 0.8;
  for (auto _ : state) {
    q[3] += 1e-4;
    const ToolPose pose = forward(machine, q);
    benchmark::DoNotOptimize(pose);
  }
}

BENCHMARK(BM_SolveNearestAlongPath);
BENCHMARK(BM_SolveNearestRandom);
BENCHMARK(BM_AllBranches)->DenseRange(0, 6);
BENCHMARK(BM_Forward);

}  // namespace
}  // namespace swarf::kinematics

BENCHMARK_MAIN();
