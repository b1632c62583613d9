// Chips of a movie: as many as material is removed, where and when it is, thrown and falling as they must.
#include "reports/chips.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>

#include "mesh/mesh_check.h"
#include "render/figures/chip_mesh.h"
#include "sim/simulation.h"
#include "support/scratch.h"

namespace swarf::reports {
namespace {

constexpr double kRadius = 5.0, kRpm = 6000.0;
constexpr double kRpmRad = kRpm * 2.0 * kPi / 60.0;

/// A block of 40 x 60 x 10 mm, cut by this program with a flat end mill of 10 mm in frames of 20 ms.
struct SlotRun {
  explicit SlotRun(const std::string& name, const std::string& moves,
                   const std::string& spindle = "S6000 M3") {
    const std::filesystem::path folder = test::scratch_folder() / ("chips_" + name);
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "slots.ngc") << "G21 G90 G17 G94\nG54\nT1 M6\nG43 H1\n"
                                        << spindle << "\nG0 X-10 Y15\nG0 Z10\n"
                                        << moves << "G0 Z20\nM30\n";
    std::ofstream(folder / "scene.toml") << R"(machine = "mill_3axis"
nc = "slots.ngc"
dialect = "linuxcnc"
[cutter]
number = 1
diameter_mm = 10
flute_length_mm = 25
length_mm = 60
[setup]
work_origin_mm = "on_table"
[stock]
box_mm = [[0, 0, -10], [40, 60, 0]]
voxel_mm = 1
[design]
kind = "none"
[movie]
voxel_mm = 1
chips = true
)";
    job = sim::load_job((folder / "scene.toml").string(), {});
    path = sim::move_tool(job, progress);
    along.emplace(job, *path.carried, *path.cycles, 1.0);
    motion::CycleReader reader(*path.cycles);
    along->advance_whole(reader.at(path.cycles->size() - 1));
    run.emplace(FinishedRun{job, *path.cycles, along->stock(), path.dexels, *path.carried});
    for (size_t k = 0; k < path.cycles->size(); k += 20) frames.push_back({reader.at(k), 0, 0.0});
  }

  /// All that ever fly, by birth.
  std::map<uint64_t, Chip> all(Chips& chips) const {
    std::map<uint64_t, Chip> found;
    for (const PlannedFrame& frame : frames)
      for (const Chip& chip : chips.at(frame)) found.emplace(chip.seed, chip);
    return found;
  }

  sim::Job job;
  Progress progress;
  sim::MeasuredPath path;
  std::optional<sim::CutAlong> along;
  std::optional<FinishedRun> run;
  std::vector<PlannedFrame> frames;
};

/// Two slots right through the block, 1 and 3 mm deep; back in the air at feed.
const SlotRun& two_slots() {
  static const SlotRun slots("two", "G1 Z-1 F3000\nG1 X50\nG1 Z5\nG1 X-10\nG0 Y45\nG1 Z-3\nG1 X50\nG1 Z5\n");
  return slots;
}

TEST(Chips, AreAsManyAsMaterialIsRemoved) {
  const SlotRun& slots = two_slots();
  Chips chips(*slots.run, slots.frames);
  const double shallow = 40.0 * 10.0 * 1.0, deep = 40.0 * 10.0 * 3.0;  // mm3
  std::array<double, 2> count{};
  for (const auto& [seed, chip] : slots.all(chips)) count[chip.place_W.y() > 30.0 ? 1 : 0] += 1.0;
  const double one = chips.clock(0).one_mm3;
  EXPECT_GT(count[0], 100.0);
  // Random points: 256 in each of some hundred ticks, of which a fiftieth to a sixteenth cuts.
  EXPECT_NEAR(count[0] * one, shallow, 0.1 * shallow);
  EXPECT_NEAR(count[1] * one, deep, 0.1 * deep);
  EXPECT_NEAR(chips.removed_mm3(), shallow + deep, 0.05 * (shallow + deep));
}

TEST(Chips, LeaveTheEdgeInMaterialAtItsSpeedTheWayItTurns) {
  for (const double turn : {1.0, -1.0}) {
    const SlotRun one("turn", "G1 Z-2 F3000\nG1 X50\n", turn > 0.0 ? "S6000 M3" : "S6000 M4");
    Chips chips(*one.run, one.frames);
    const auto all = one.all(chips);
    EXPECT_GT(all.size(), 100U);
    motion::CycleReader reader(*one.path.cycles);
    for (const auto& [seed, chip] : all) {
      const Vec3& tip = reader.at(static_cast<size_t>(std::lround(chip.born_s / 1e-3))).sample.pose.tip_W;
      const Vec3 arm = chip.place_W - tip;
      EXPECT_NEAR(arm.head<2>().norm(), kRadius, 1e-6);
      EXPECT_GT(arm.x(), 0.0);  // where the tool goes
      EXPECT_GT(chip.place_W.x(), -1e-6);
      EXPECT_LT(chip.place_W.z(), 1e-6);
      EXPECT_NEAR(chip.speed_W.norm(), kRpmRad * kRadius, 1e-6);
      EXPECT_LT(turn * arm.cross(chip.speed_W).z(), 0.0);  // M3: clockwise from above
      EXPECT_GT(chip.speed_W.z(), 0.0);
    }
  }
}

TEST(Chips, NoneFlyInRapidsWhereNothingIsLeftOrFromAStandingTool) {
  // A rapid through the block, then at feed over it and once more along the slot that the rapid has cut.
  const SlotRun rapid("rapid", "G0 Z-2\nG0 X50\nG1 Z1 F3000\nG1 X-10\nG1 Z-2\nG1 X50\n");
  Chips of_rapid(*rapid.run, rapid.frames);
  EXPECT_GT(of_rapid.clock(0).one_mm3, 0.0);
  EXPECT_TRUE(rapid.all(of_rapid).empty());
  const SlotRun stands("stands", "G1 Z-2 F3000\nG1 X50\n", "M5");
  Chips of_standing(*stands.run, stands.frames);
  EXPECT_TRUE(stands.all(of_standing).empty());
}

TEST(Chips, OfAMomentAreTheSameWhateverIsAskedBefore) {
  const SlotRun& slots = two_slots();
  Chips whole(*slots.run, slots.frames);
  // A part of the movie alone, in the middle of the second slot.
  const size_t from = slots.frames.size() * 3 / 4;
  const std::vector<PlannedFrame> part(slots.frames.begin() + static_cast<std::ptrdiff_t>(from),
                                       slots.frames.begin() + static_cast<std::ptrdiff_t>(from) + 40);
  Chips alone(*slots.run, part), by_sevens(*slots.run, slots.frames), backwards(*slots.run, slots.frames);
  size_t most = 0;
  const auto expect_same = [](const std::vector<Chip>& a, const std::vector<Chip>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].seed, b[i].seed);
      EXPECT_EQ(a[i].flown_s, b[i].flown_s);
      EXPECT_EQ(a[i].place_W, b[i].place_W);
      EXPECT_EQ(a[i].speed_W, b[i].speed_W);
    }
  };
  backwards.at(slots.frames.back());
  for (size_t f = 0; f < from + part.size(); ++f) {
    const std::vector<Chip> chips = whole.at(slots.frames[f]);
    most = std::max(most, chips.size());
    if (f >= from) expect_same(chips, alone.at(slots.frames[f]));
    if (f % 7 == 0) expect_same(chips, by_sevens.at(slots.frames[f]));
    if (f == from) expect_same(chips, backwards.at(slots.frames[f]));
  }
  EXPECT_GT(most, 50U);
  EXPECT_LE(most, kChipsMost);
}

TEST(Chips, FallAsAThrownBodyAndComeToRest) {
  Chip chip;
  chip.place_W = {1.0, 2.0, 3.0};
  chip.speed_W = {2000.0, 0.0, 500.0};
  Pose X_born = Pose::Identity();
  X_born.translation() = Vec3(0.0, 0.0, 100.0);
  X_born.linear() = Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitZ()).toRotationMatrix();
  chip.flown_s = 0.05;
  // 500 * 0.05 up, 9806.65 / 2 * 0.05^2 down.
  EXPECT_TRUE(flown(chip, X_born, 0.0)
                  .translation()
                  .isApprox(Vec3(-2.0, 1.0 + 100.0, 103.0 + 25.0 - 12.2583125), 1e-12));
  // Down at 90 mm, 13 below its start: at the root of 13 + 500 t - 4903.325 t^2.
  const double down_s = (500.0 + std::sqrt(500.0 * 500.0 + 4.0 * 4903.325 * 13.0)) / (2.0 * 4903.325);
  for (const double after : {0.2, 0.5}) {
    chip.flown_s = after;
    EXPECT_TRUE(
        flown(chip, X_born, 90.0).translation().isApprox(Vec3(-2.0, 1.0 + 2000.0 * down_s, 90.0), 1e-12));
  }
}

TEST(Chips, FlyAtTheirOwnSpeedInSlowMovesAndThroughThePictureInFastOnes) {
  // Half as fast as the program, and sixty times faster; 1000 mm3 in 100 s.
  const ChipClock slow = chip_clock(0.0625, 1000.0, 100.0, 1e-3),
                  fast = chip_clock(64.0, 1000.0, 100.0, 1e-3);
  EXPECT_EQ(slow.flight, 1.0);
  EXPECT_EQ(slow.step, 1U);
  EXPECT_DOUBLE_EQ(slow.one_mm3 * kChipsMean, 1000.0 / 100.0 * kFlight_s);
  EXPECT_DOUBLE_EQ(fast.flight * 64.0, kFlightSpeed);  // s of flight in a second of the movie
  EXPECT_DOUBLE_EQ(fast.one_mm3 * kChipsMean, 1000.0 / 100.0 * kFlight_s / fast.flight);
  EXPECT_EQ(chip_clock(1.0, 0.0, 100.0, 1e-3).one_mm3, 0.0);
}

TEST(Chips, AreClosedAndOfTheirSize) {
  const TriMesh chip = render::chip_mesh(2.0);
  EXPECT_EQ(mesh::check_closed(chip), "");
  double reach = 0.0;
  for (const auto& p : chip.positions) reach = std::max(reach, std::hypot(double{p[0]}, p[1], p[2]));
  EXPECT_NEAR(reach, 1.0, 1e-6);
}

}  // namespace
}  // namespace swarf::reports
