// All pairs of bodies of a machine over a long program: links, a tool with its holder, a fixture and a part.
#include <benchmark/benchmark.h>

#include <cmath>

#include "base/rng.h"
#include "base/units.h"
#include "collision/path_check.h"

namespace swarf::collision {
namespace {

constexpr size_t kLocations = 100000;

machine::MachineScene maho() {
  return machine::load_machine(SWARF_SOURCE_DIR "/assets/machines/maho_600c/machine.toml");
}

TriMesh box_of(const Vec3& low, const Vec3& high) {
  TriMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.push_back({static_cast<float>((i & 1) != 0 ? high.x() : low.x()),
                              static_cast<float>((i & 2) != 0 ? high.y() : low.y()),
                              static_cast<float>((i & 4) != 0 ? high.z() : low.z())});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// A dome of 5 000 triangles on the table, radius 40 mm, closed.
TriMesh dome() {
  constexpr int kAround = 50, kRings = 50;
  TriMesh mesh;
  const auto add = [&](double r, double z, double turn) {
    mesh.positions.push_back({static_cast<float>(r * std::cos(turn)), static_cast<float>(r * std::sin(turn)),
                              static_cast<float>(z)});
  };
  for (int i = 0; i < kRings; ++i)
    for (int j = 0; j < kAround; ++j) {
      const double polar = 0.5 * kPi * (i + 1) / kRings;
      add(40.0 * std::sin(polar), 40.0 * std::cos(polar), 2.0 * kPi * j / kAround);
    }
  add(0.0, 40.0, 0.0);
  add(0.0, 0.0, 0.0);
  const auto at = [&](int i, int j) { return static_cast<uint32_t>(i * kAround + j % kAround); };
  const uint32_t top = kRings * kAround, foot = top + 1;
  for (int j = 0; j < kAround; ++j) {
    mesh.triangles.push_back({top, at(0, j), at(0, j + 1)});
    mesh.triangles.push_back({foot, at(kRings - 1, j + 1), at(kRings - 1, j)});
    for (int i = 0; i + 1 < kRings; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

constexpr double kToolLength = 120.0;

std::vector<Body> all_bodies(const machine::MachineScene& scene) {
  std::vector<Body> bodies = link_bodies(scene);
  const kinematics::MachineModel with = kinematics::with_tool(scene.model, kToolLength);
  const std::vector<ToolFrustum> shank{{20.0, 60.0, 4.0, 4.0}};
  const std::vector<ToolFrustum> holder{{60.0, 80.0, 10.0, 20.0}, {80.0, 120.0, 20.0, 31.0}};
  bodies.push_back(tool_body(scene, with, "shank", shank));
  bodies.push_back(tool_body(scene, with, "holder", holder));
  bodies.push_back(work_body(scene, "fixture", BodyKind::kFixture, box_of({55, -15, 0}, {75, 15, 30})));
  bodies.push_back(work_body(scene, "part", BodyKind::kPart, dome()));
  return bodies;
}

/// Locations on the dome, normal to it, in rings a location a millimetre; five axes move.
std::vector<motion::Cycle> locations(const machine::MachineScene& scene) {
  const kinematics::InverseKinematics inverse(kinematics::with_tool(scene.model, kToolLength));
  std::vector<motion::Cycle> cycles(kLocations);
  kinematics::AxisValues q = home_of(scene);
  double turn = 0.0;
  for (size_t k = 0; k < kLocations; ++k) {
    const double polar = 0.05 + 1.1 * static_cast<double>(k) / kLocations;
    turn += 0.5 / (40.0 * std::sin(polar));
    const Vec3 normal(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar));
    q = inverse.solve_nearest({40.0 * normal, normal}, q).q;
    cycles[k].number = k;
    cycles[k].q = q;
    cycles[k].sample.t_s = 1e-3 * static_cast<double>(k);
    cycles[k].sample.element = static_cast<int>(k);
  }
  return cycles;
}

void BM_PathCheck(benchmark::State& state) {
  const machine::MachineScene scene = maho();
  const std::vector<motion::Cycle> cycles = locations(scene);
  size_t pairs = 0, contacts = 0, near = 0;
  for (auto _ : state) {
    Diagnostics diagnostics;
    PathCheck check(scene, all_bodies(scene), {}, diagnostics);
    check.add(cycles);
    const PathFindings found = check.finish();
    pairs = found.pairs.size();
    contacts = near = 0;
    for (const PairFindings& pair : found.pairs) {
      contacts += pair.contact_count();
      near += pair.near_miss.within ? 1 : 0;
    }
  }
  state.counters["locations/s"] =
      benchmark::Counter(static_cast<double>(state.iterations() * kLocations), benchmark::Counter::kIsRate);
  state.counters["pairs"] = static_cast<double>(pairs);
  state.counters["contacts"] = static_cast<double>(contacts);
  state.counters["near"] = static_cast<double>(near);
}

/// The arm (3 144 triangles) and the ram (12 520) at places in no order: `limit` mm, 0: none.
void BM_DistanceAtRest(benchmark::State& state) {
  const machine::MachineScene scene = maho();
  const std::vector<Body> links = link_bodies(scene);
  const Encounter pair = encounter(scene, links[3], links[5]);
  ApproachQuery query;
  if (state.range(0) > 0) query.limit = static_cast<double>(state.range(0));
  Rng rng(1);
  for (auto _ : state) {
    AxisSegment still;
    still.q0 << rng.uniform(-200, 200), rng.uniform(-150, 150), rng.uniform(100, 500), rng.uniform(-1.5, 1.5),
        rng.uniform(-3, 3);
    still.q1 = still.q0;
    benchmark::DoNotOptimize(closest_approach(pair, still, query));
  }
}

BENCHMARK(BM_PathCheck)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(BM_DistanceAtRest)->Arg(10)->Arg(0);

}  // namespace
}  // namespace swarf::collision

BENCHMARK_MAIN();
