// A stock that is cut as far as the tool has come: in the middle of a block there is nothing behind the tool
// and all of it ahead, and in the end it is to the last bit the stock that whole sweeps leave.
#include "sim/run/cut_along.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/parallel.h"
#include "sim/simulation.h"
#include "support/scratch.h"

namespace swarf::sim {
namespace {

/// A slot of 100 mm with a disc and one with a flat end, a ball down a ramp and round an arc, a hole.
constexpr const char* kProgram = R"(G21 G90 G17 G94
G54
T1 M6
G43 H1
S8000 M3
G0 X-12 Y0
G0 Z10
G1 Z-4 F2000
G1 X112 F3000
G0 Z20
T2 M6
G43 H2
G0 X12.3 Y10.1
G1 Z2.2 F2000
G1 X63.7 Y12.9 Z-3.1 F3000
G2 X80.3 Y-7.7 R16.7
G0 Z20
T3 M6
G43 H3
G0 X-20 Y-9
G1 Z-6 F2000
G1 X120.5 Y-8.3 F3000
G0 Z20
T4 M6
G43 H4
G0 X31 Y-7
G1 Z-11.3 F500
G0 Z20
M30
)";
constexpr const char* kTools = R"([[tool]]
number = 1
shape = "flat"
diameter_mm = 10
flute_length_mm = 25
length_mm = 60
[[tool]]
number = 2
shape = "ball"
diameter_mm = 6
flute_length_mm = 25
length_mm = 60
[[tool]]
number = 3
shape = "woodruff"
diameter_mm = 16
corner_radius_mm = 0.5
width_mm = 3
length_mm = 60
shank_diameter_mm = 6
[[tool]]
number = 4
shape = "drill"
diameter_mm = 5
point_angle_deg = 118
flute_length_mm = 30
length_mm = 60
)";
constexpr const char* kScene = R"(machine = "mill_3axis"
nc = "slots.ngc"
dialect = "linuxcnc"
tool_table = "tools.toml"
[setup]
work_origin_mm = "on_table"
[stock]
box_mm = [[0, -15, -12], [100, 15, 0]]
voxel_mm = 0.5
[design]
kind = "none"
)";

/// A job, moved.
struct Moved {
  explicit Moved(Job its_job) : job(std::move(its_job)), path(move_tool(job, progress)) {}
  CutAlong along(double voxel_mm) const { return {job, *path.carried, *path.cycles, voxel_mm}; }

  Progress progress;
  Job job;
  MeasuredPath path;
};
Moved slots() {
  const std::filesystem::path& folder = test::scratch_folder();
  std::ofstream(folder / "slots.ngc") << kProgram;
  std::ofstream(folder / "tools.toml") << kTools;
  std::ofstream(folder / "slots.toml") << kScene;
  return Moved(load_job((folder / "slots.toml").string(), {}));
}
Moved scene(const std::string& name) {
  return Moved(load_job(SWARF_SOURCE_DIR "/scenes/" + name + "/scene.toml", {}));
}

TEST(CutAlong, InTheMiddleOfABlockTheSlotEndsWhereTheToolIs) {
  constexpr double kVoxel = 0.5, kRadius = 5.0;
  const Moved moved = slots();
  CutAlong along = moved.along(kVoxel);
  motion::CycleReader reader(*moved.path.cycles);
  int inside = 0;
  double before = -1e9;
  // The first slot, from its ramp down outside the stock on; each look a millimetre farther.
  for (size_t k = 0; k < moved.path.cycles->size(); ++k) {
    const motion::Cycle cycle = reader.at(k);
    const Vec3& tip = cycle.sample.pose.tip_W;
    if (tip.z() != -4.0 || tip.x() < before + 1.0) continue;
    if (cycle.sample.tool != 0) break;
    before = tip.x();
    along.advance(cycle);
    const double front = tip.x() + kRadius;
    if (front < 2.0 || front > 98.0) continue;
    ++inside;
    // Half deep and a voxel beside the cutter's front, in front of it and behind.
    EXPECT_LT(along.stock().distance_mm({front + kVoxel, 0.0, -2.0}), -0.9 * kVoxel) << "x " << tip.x();
    EXPECT_GT(along.stock().distance_mm({front - kVoxel, 0.0, -2.0}), 0.9 * kVoxel) << "x " << tip.x();
  }
  EXPECT_GT(inside, 80);
}

/// The stock after so many looks on the way.
uint64_t hash_after(const Moved& moved, double voxel_mm, size_t looks) {
  CutAlong along = moved.along(voxel_mm);
  motion::CycleReader reader(*moved.path.cycles);
  const size_t last = moved.path.cycles->size() - 1;
  for (size_t n = 1; n <= looks; ++n) along.advance(reader.at(last * n / looks));
  return along.stock().hash();
}

TEST(CutAlong, LooksOnTheWayLeaveNoTrace) {
  const auto expect_no_trace = [](const Moved& moved, double voxel_mm) {
    stock::Stock whole = starting_stock(moved.job, *moved.path.carried, voxel_mm);
    const JobSweeps all = stock_sweeps(moved.job, *moved.path.cycles);
    const std::vector<stock::CutterSolid> solids = tool_solids(moved.job.scene);
    for (const stock::Sweep& sweep : all.sweeps)
      whole.cut(std::span(&sweep, 1), solids[static_cast<size_t>(all.sources[sweep.block].tool)]);
    for (const size_t looks : {1, 7, 97, 1001})
      EXPECT_EQ(hash_after(moved, voxel_mm, looks), whole.hash()) << looks;
  };
  const Moved moved = slots();
  for (const double voxel_mm : {0.13, 0.5, 2.0}) {
    SCOPED_TRACE(voxel_mm);
    expect_no_trace(moved, voxel_mm);
  }
  for (const char* name : {"so_tilted_cone_10", "exact_rounded_corner", "exact_scallop_ball_plane"}) {
    SCOPED_TRACE(name);
    expect_no_trace(scene(name), 0.7);
  }
}

TEST(CutAlong, WhatALookShowsIsTheSameForAnyNumberOfThreads) {
  const Moved moved = slots();
  const auto half_way = [&] {
    CutAlong along = moved.along(0.5);
    motion::CycleReader reader(*moved.path.cycles);
    std::vector<uint64_t> hashes;
    for (size_t n = 1; n < 20; ++n) {
      along.advance(reader.at(moved.path.cycles->size() * n / 20));
      hashes.push_back(along.stock().hash());
    }
    return hashes;
  };
  set_thread_count(1);
  const std::vector<uint64_t> by_one = half_way();
  set_thread_count(3);
  EXPECT_EQ(half_way(), by_one);
  set_thread_count(0);
}

TEST(CutAlong, AToolThatIsElsewhereHasNoShareOfASweep) {
  const stock::Sweep sweep{{{0, 0, 0}, {0, 0, 1}}, {{10, 0, 0}, {0, 0, 1}}, 0};
  EXPECT_NEAR(share_on(sweep, {{2.5, 0.3, 0}, {0, 0, 1}}, 20.0, 0.5).value(), 0.25, 1e-12);
  EXPECT_FALSE(share_on(sweep, {{2.5, 0.6, 0}, {0, 0, 1}}, 20.0, 0.5));
  EXPECT_FALSE(share_on(sweep, {{-0.6, 0.0, 0}, {0, 0, 1}}, 20.0, 0.5));
  EXPECT_FALSE(share_on(sweep, {{2.5, 0.0, 0}, Vec3(0.03, 0.0, 1.0).normalized()}, 20.0, 0.5));
  const stock::Sweep stands{sweep.start, sweep.start, 0};
  EXPECT_FALSE(share_on(stands, sweep.start, 20.0, 0.5));
  // Turning about its tip.
  const Vec3 axis = Vec3(0.1, 0.0, 1.0).normalized(), half = (axis + Vec3::UnitZ()).normalized();
  EXPECT_NEAR(share_on({{{1, 2, 3}, {0, 0, 1}}, {{1, 2, 3}, axis}, 0}, {{1, 2, 3}, half}, 20.0, 0.5).value(),
              0.5, 1e-3);
}

}  // namespace
}  // namespace swarf::sim
