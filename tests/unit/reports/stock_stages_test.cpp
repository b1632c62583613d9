// The stock at times of the program, as viewers show it that cannot cut.
#include "reports/stock_stages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "base/progress.h"
#include "sim/simulation.h"
#include "support/scratch.h"

namespace swarf::reports {
namespace {

/// One block through a bar, and rapids many times its length.
constexpr const char* kProgram =
    "G21 G90 G17 G94\nG54\nT1 M6\nG43 H1\nS8000 M3\nG0 X-12 Y0\nG0 Z100\nG0 Z10\nG0 Z-4\nG1 X112 F500\nG0 "
    "Z200\nG0 X-12\nM30\n";
constexpr const char* kScene = R"(machine = "mill_3axis"
nc = "bar.ngc"
dialect = "linuxcnc"
[cutter]
number = 1
diameter_mm = 10
flute_length_mm = 25
length_mm = 60
[setup]
work_origin_mm = "on_table"
[stock]
box_mm = [[0, -15, -12], [100, 15, 0]]
voxel_mm = 0.5
[design]
kind = "none"
[movie]
voxel_mm = 0.5
)";
constexpr double kVoxel = 100.0 / kStageVoxels, kRadius = 5.0, kFloor = -4.0;

/// How far along the bar the slot's floor reaches, mm.
double slot_end(const TriMesh& mesh) {
  float end = 0.0F;
  for (const auto& p : mesh.positions)
    if (std::abs(p[2] - kFloor) < 0.1 && std::abs(p[1]) < kRadius) end = std::max(end, p[0]);
  return end;
}

TEST(StockStages, OneBlockIsShownCutUpToTheToolAtEachOfThem) {
  constexpr size_t kStages = 9;
  const std::filesystem::path& folder = test::scratch_folder();
  std::ofstream(folder / "bar.ngc") << kProgram;
  std::ofstream(folder / "bar.toml") << kScene;
  const sim::Job job = sim::load_job((folder / "bar.toml").string(), {});
  Progress progress;
  const sim::Result result = sim::simulate(job, {}, progress);
  const FinishedRun run{job, *result.main.cycles, *result.stock, result.main.dexels, *result.main.carried};
  const std::vector<StockStage> stages = stock_stages(run, kStages);
  ASSERT_EQ(stages.size(), kStages);
  EXPECT_EQ(slot_end(stages.front().mesh), 0.0);
  motion::CycleReader reader(run.cycles);
  for (size_t k = 1; k < kStages; ++k) {
    const Vec3 tip = reader.at(stages[k].cycle).sample.pose.tip_W;
    const double way = 124.0 * static_cast<double>(k) / kStages;
    EXPECT_NEAR(tip.x(), -12.0 + way, 1.0) << "equal shares of the way at feed";
    EXPECT_NEAR(slot_end(stages[k].mesh), std::clamp(tip.x() + kRadius, 0.0, 100.0), 1.5 * kVoxel) << k;
  }
}

}  // namespace
}  // namespace swarf::reports
