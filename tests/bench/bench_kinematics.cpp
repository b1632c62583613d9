// Time of the kinematics on the paper's machine: forward, the nearest branch, both branches.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "base/rng.h"
#include "kinematics/machine_model.h"

namespace swarf::kinematics {
namespace {

Axis axis(const std::string& name, AxisKind kind, Side side, const Vec3& direction,
          const Vec3& origin = Vec3::Zero(), bool reversed = false) {
  Axis one;
  one.name = name;
  one.kind = kind;
  one.side = side;
  one.direction_M = direction;
  one.origin_M = origin;
  one.reversed = reversed;
  one.min = -5000.0;
  one.max = 5000.0;
  return one;
}

MachineModel paper_machine() {
  MachineModel machine;
  machine.axes = {axis("X", AxisKind::kLinear, Side::kTable, Vec3::UnitX()),
                  axis("A", AxisKind::kRotary, Side::kTable, Vec3::UnitX(), Vec3::Zero(), true),
                  axis("B", AxisKind::kRotary, Side::kTable, Vec3::UnitZ(), Vec3(0.0, 96.0, 120.0), true),
                  axis("Y", AxisKind::kLinear, Side::kHead, Vec3::UnitY()),
                  axis("Z", AxisKind::kLinear, Side::kHead, Vec3::UnitZ())};
  machine.table_chain = {0, 1, 2};
  machine.head_chain = {3, 4};
  machine.X_MW.translation() = Vec3(8.0, 96.0, 120.0);
  return machine;
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

void BM_SolveBoth(benchmark::State& state) {
  const InverseKinematics inverse(paper_machine());
  const std::vector<ToolPose> poses = path_poses();
  size_t i = 0;
  for (auto _ : state) {
    const InverseSolutions both = inverse.solve(poses[i++ % poses.size()], AxisValues::Zero());
    benchmark::DoNotOptimize(both);
  }
}

void BM_Forward(benchmark::State& state) {
  const MachineModel machine = paper_machine();
  AxisValues q;
  q << 10.0, 0.4, 0.8, 20.0, 30.0;
  for (auto _ : state) {
    q[1] += 1e-4;
    const ToolPose pose = forward(machine, q);
    benchmark::DoNotOptimize(pose);
  }
}

BENCHMARK(BM_SolveNearestAlongPath);
BENCHMARK(BM_SolveNearestRandom);
BENCHMARK(BM_SolveBoth);
BENCHMARK(BM_Forward);

}  // namespace
}  // namespace swarf::kinematics

BENCHMARK_MAIN();
