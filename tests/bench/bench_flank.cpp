// Flank milling: one query of the envelope's error, one placement, one ray of the prediction.
#include <benchmark/benchmark.h>

#include "flank/envelope.h"
#include "flank/feed.h"
#include "surface/polynomial.h"

namespace swarf::flank {
namespace {

FlankTask blade(Placement placement) {
  FlankProfile profile;
  profile.radius = 8.0;
  profile.high = 45.0;
  auto surface = std::make_shared<surface::PolynomialSurface>(
      1, 1, std::vector<Vec3>{{0, 0, 0}, {0, -10, 30}, {60, 0, 0}, {0, 20, 0}}, 1);
  return {std::move(surface), profile, placement, 3.0};
}

void EnvelopeQuery(benchmark::State& state) {
  const FlankTask task = blade(Placement::kMinimax);
  const ToolPose pose = pose_at(task, 0.4);
  double c = 3.0;
  for (auto _ : state) {
    c = c > 30.0 ? 3.0 : c + 0.1;
    const Foot foot = foot_of(*task.surface, pose.tip_W + c * pose.axis_W, 0.4, c / 31.0);
    benchmark::DoNotOptimize(foot.distance_mm - ball_radius(task.profile, c));
  }
}
BENCHMARK(EnvelopeQuery);

void MinimaxPlacement(benchmark::State& state) {
  const FlankTask task = blade(Placement::kMinimax);
  double u = 0.0;
  for (auto _ : state) {
    u = u > 0.99 ? 0.0 : u + 0.01;
    benchmark::DoNotOptimize(pose_at(task, u));
  }
}
BENCHMARK(MinimaxPlacement)->Unit(benchmark::kMicrosecond);

void RayOfTheEnvelope(benchmark::State& state) {
  const FlankTask task = blade(Placement::kMinimax);
  std::vector<ToolPose> poses;
  for (int i = 0; i <= 500; ++i) poses.push_back(pose_at(task, i / 500.0));
  const PoseTrack track(poses, task.profile);
  const surface::Derivatives d = task.surface->derivatives(0.43, 0.6);
  const Vec3 normal = surface::outward_normal(*task.surface, d);
  for (auto _ : state) benchmark::DoNotOptimize(track.height(d.S, normal));
}
BENCHMARK(RayOfTheEnvelope)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace swarf::flank

BENCHMARK_MAIN();
