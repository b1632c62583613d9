// Boring cycles of Fanuc programs: every move of the manual's figures, with feed, spindle and dwell.
#include <fmt/format.h>

#include <cmath>

#include "base/rng.h"
#include "unit/program/nc_support.h"

namespace swarf::program::nc_fanuc_cycles_test {
namespace {

NcRun fanuc(const std::string& text, const ControlSetup& setup = three_axis_setup()) {
  return run_text(text, Dialect::kFanuc, setup);
}

struct Step {
  Vec3 tip;
  bool rapid;
  double spindle_rpm;
  double dwell_s = 0.0;
};

/// The moves from `first` on are exactly these.
void expect_steps(const NcRun& run, size_t first, const std::vector<Step>& steps) {
  ASSERT_EQ(run.moves().size(), first + steps.size()) << run.text();
  for (size_t i = 0; i < steps.size(); ++i) {
    const NcMove& move = run.moves()[first + i];
    EXPECT_NEAR((move.to.tip_W - steps[i].tip).norm(), 0.0, 1e-9)
        << "step " << i << ": " << move.to.tip_W.transpose();
    EXPECT_EQ(move.rapid, steps[i].rapid) << "step " << i;
    EXPECT_EQ(move.spindle_rpm, steps[i].spindle_rpm) << "step " << i;
    EXPECT_DOUBLE_EQ(move.dwell_s, steps[i].dwell_s) << "step " << i;
  }
}

std::vector<std::string> codes(const NcRun& run) {
  std::vector<std::string> all;
  for (const Diagnostic& one : run.diagnostics.list()) all.push_back(one.code);
  return all;
}

using Codes = std::vector<std::string>;

TEST(NcFanucCycles, FineBoringLeavesAsideWithTheSpindleStopped) {
  const NcRun run =
      fanuc("G21 G90 S500 M03\nG00 X0 Y0 Z50\nG98 G76 X10 Y5 Z-20 R3 Q0.5 P1500 F100\nG99 X30\nG80\nM30\n");
  EXPECT_EQ(codes(run), (Codes{"shift-direction", "oriented-tool"}));
  expect_steps(run, 1,
               {{{10, 5, 50}, true, 500},
                {{10, 5, 3}, true, 500},
                {{10, 5, -20}, false, 500},
                {{10.5, 5, -20}, true, 0, 1.5},
                {{10.5, 5, 50}, true, 0},
                {{10, 5, 50}, true, 0},
                {{30, 5, 50}, true, 500},
                {{30, 5, 3}, true, 500},
                {{30, 5, -20}, false, 500},
                {{30.5, 5, -20}, true, 0, 1.5},
                {{30.5, 5, 3}, true, 0},
                {{30, 5, 3}, true, 0}});
}

TEST(NcFanucCycles, ShiftByVectorSaysItsDirection) {
  const NcRun run = fanuc("G00 Z50\nM03 S300\nG99 G76 X10 Z-20 R3 I-0.3 J0.4 F100\nM30\n");
  EXPECT_EQ(codes(run), Codes{"oriented-tool"});
  expect_steps(run, 1,
               {{{10, 0, 50}, true, 300},
                {{10, 0, 3}, true, 300},
                {{10, 0, -20}, false, 300},
                {{9.7, 0.4, -20}, true, 0},
                {{9.7, 0.4, 3}, true, 0},
                {{10, 0, 3}, true, 0}});
}

TEST(NcFanucCycles, ShiftFollowsThePlane) {
  // G18: the first axis is Z; a negative Q shifts like a positive one.
  const NcRun run = fanuc("G00 Y50\nG18 G99 G76 X10 Y-20 R3 Q-2 F100\nM30\n");
  expect_steps(run, 1,
               {{{10, 50, 0}, true, 0},
                {{10, 3, 0}, true, 0},
                {{10, -20, 0}, false, 0},
                {{10, -20, 2}, true, 0},
                {{10, 3, 2}, true, 0},
                {{10, 3, 0}, true, 0}});
}

TEST(NcFanucCycles, BackBoringComesFromBelow) {
  const char* const kHead = "G00 X0 Y0 Z50\nM03 S400\n";
  const std::vector<Step> steps{{{10, 5, 50}, true, 400},   {{13, 5, 50}, true, 0},
                                {{13, 5, -30}, true, 0},    {{10, 5, -30}, true, 0},
                                {{10, 5, -20}, false, 400}, {{13, 5, -20}, true, 0, 0.25},
                                {{13, 5, 50}, true, 0},     {{10, 5, 50}, true, 0}};
  expect_steps(fanuc(std::string(kHead) + "G98 G87 X10 Y5 Z-20 R-30 Q3 P250 F80\nM30\n"), 1, steps);
  // G91: R counts from the initial level, Z from R.
  expect_steps(fanuc(std::string(kHead) + "G91 G98 G87 X10 Y5 Z10 R-80 Q3 P250 F80\nM30\n"), 1, steps);
}

TEST(NcFanucCycles, BoringWithManualRetract) {
  const NcRun run = fanuc("G00 Z50\nM03 S400\nG98 G88 X10 Z-20 R3 P1000 F80\nM30\n");
  EXPECT_EQ(codes(run), Codes{"manual-retract"});
  expect_steps(run, 1,
               {{{10, 0, 50}, true, 400},
                {{10, 0, 3}, true, 400},
                {{10, 0, -20}, false, 400},
                {{10, 0, 3}, true, 0, 1.0},
                {{10, 0, 50}, true, 400}});
}

TEST(NcFanucCycles, TappingDwellsBelowAndAtTheApproach) {
  const NcRun run = fanuc("G00 Z50\nM03 S400\nG98 G84 X10 Z-20 R3 P200 F400\nM30\n");
  EXPECT_EQ(run.text(), "");
  expect_steps(run, 1,
               {{{10, 0, 50}, true, 400},
                {{10, 0, 3}, true, 400},
                {{10, 0, -20}, false, 400},
                {{10, 0, 3}, false, -400, 0.2},
                {{10, 0, 50}, true, -400, 0.2}});
}

TEST(NcFanucCycles, RepeatsAndNoHoles) {
  // K0 stores the words; the next block drills with them. G91 X5 K3 drills three holes 5 mm apart.
  const NcRun run = fanuc("G00 Z10\nM03 S400\nG99 G81 Z-5 R2 F100 K0\nG91 X5 K3\nG80\nM30\n");
  EXPECT_EQ(run.text(), "");
  std::vector<double> holes;
  for (const NcMove& move : run.moves()) {
    if (!move.rapid) holes.push_back(move.to.tip_W.x());
  }
  EXPECT_EQ(holes, (std::vector<double>{5, 10, 15}));
}

/// Whatever the numbers: feed only between R and Z over the hole, and every cycle ends over it.
TEST(NcFanucCycles, RandomBores) {
  Rng rng(76);
  for (int round = 0; round < 60; ++round) {
    const bool back = round % 2 == 1;
    const double x = std::floor(100 * rng.uniform()), q = 0.25 * std::ceil(8 * rng.uniform());
    const double r = back ? -40 - std::floor(10 * rng.uniform()) : 2, z = back ? r + 5 : -10;
    const std::string text = fmt::format("G00 X0 Y0 Z60\nM03 S100\nG98 G{} X{} Y7 Z{} R{} Q{} F100\nM30\n",
                                         back ? 87 : 76, x, z, r, q);
    const NcRun run = fanuc(text);
    ASSERT_EQ(run.first_error(), "") << text;
    for (const NcMove& move : run.moves()) {
      if (move.rapid) continue;
      ASSERT_NEAR((move.to.tip_W - Vec3(x, 7, z)).norm(), 0.0, 1e-9) << text;
      ASSERT_NEAR((move.from.tip_W - Vec3(x, 7, r)).norm(), 0.0, 1e-9) << text;
      ASSERT_EQ(move.spindle_rpm, 100.0) << text;
    }
    ASSERT_NEAR((run.moves().back().to.tip_W - Vec3(x, 7, 60)).norm(), 0.0, 1e-9) << text;
  }
}

}  // namespace
}  // namespace swarf::program::nc_fanuc_cycles_test
