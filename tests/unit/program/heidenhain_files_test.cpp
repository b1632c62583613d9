// Conversational programs as CAM posts write them: what the machine alone knows is listed, the path is read.
#include <fmt/format.h>

#include <limits>

#include "unit/program/heidenhain_support.h"

namespace swarf::program {
namespace {

std::string codes_told(const NcRun& run) {
  std::string codes;
  for (const Diagnostic& one : run.diagnostics.list()) codes += (codes.empty() ? "" : " ") + one.code;
  return codes;
}

ControlSetup endless_setup() {
  ControlSetup setup = three_axis_setup();
  for (kinematics::Axis& axis : setup.machine.axes) {
    axis.min = -std::numeric_limits<double>::infinity();
    axis.max = std::numeric_limits<double>::infinity();
  }
  setup.start.reset();
  return setup;
}

/// Each Fusion program begins and ends its operations with L M140 MB MAX.
TEST(HeidenhainFiles, RetreatToTheEndOfTravelWithoutAMachine) {
  const NcRun run = klartext(
      "BLK FORM 0.1 Z X-10 Y-10 Z-20\nBLK FORM 0.2 X+10 Y+10 Z+0\nL M140 MB MAX\nTOOL CALL 1 Z S5000\nM3\n"
      "L X+0 Y+0 R0 FMAX\nL Z+5 R0 FMAX\nL Z-1 F200\nL M140 MB MAX\n",
      endless_setup());
  EXPECT_EQ(codes_told(run), "no-end-of-travel") << run.text();
  EXPECT_EQ(run.summary.functions,
            (std::vector<std::string>{"M140 MB MAX (the machine has no ends of travel)"}));
  expect_heights(run, {-1.0});
}

TEST(HeidenhainFiles, ToolDefThatContradictsTheTableIsAWarning) {
  const NcRun run = klartext("TOOL DEF 2 L+0 R+10\nTOOL CALL 2 Z S1000\nL Z+5 FMAX\n");
  EXPECT_EQ(codes_told(run), "tool-def-contradicts-table") << run.text();
  EXPECT_NEAR(run.moves().back().q_to[2], 55.0, 1e-12) << "the table's length";
}

TEST(HeidenhainFiles, SystemDataIsListedAndHasNoValue) {
  const NcRun run = klartext(
      "Q1 = 5\nFN 17: SYSWRITE ID420 NR0 IDX0 = +1\nFN 18: SYSREAD Q1 = ID50 NR4 IDX0\nQ2 = 3\nL X+Q2 "
      "FMAX\n");
  EXPECT_EQ(codes_told(run), "system-data-written system-data-read") << run.text();
  EXPECT_EQ(run.summary.functions.size(), 2u);
  expect_tip(run.moves().back(), 3.0, 0.0, 0.0);
  // What was assigned before is not taken for what the control would have read.
  EXPECT_EQ(klartext("Q1 = 5\nFN 18: SYSREAD Q1 = ID50 NR4 IDX0\nL X+Q1 FMAX\n").first_error(),
            "undefined-parameter 4:5");
}

TEST(HeidenhainFiles, ProbingIsListedAndItsResultsHaveNoValue) {
  const NcRun run = klartext(
      "TCH PROBE 419 BEZUGSPKT. IN ACHSE ~\n  Q263=+25 ;1. PUNKT ~\n  Q264=+25 ;2. PUNKT ~\n  Q260=+50 "
      ";HOEHE\n"
      "L X+Q263 FMAX\n");
  EXPECT_EQ(codes_told(run), "probing") << run.text();
  EXPECT_EQ(run.summary.functions, (std::vector<std::string>{"TCH PROBE 419"}));
  expect_tip(run.moves().back(), 25.0, 0.0, 0.0);
  EXPECT_EQ(klartext("Q115 = 1\nTCH PROBE 0.0 REF. PLANE Q5 X-\nL X+Q115 FMAX\n").first_error(),
            "undefined-parameter 4:5");
}

/// 241 as Fusion writes it, Q379 and Q395 among its values.
TEST(HeidenhainFiles, DeepDrillingFromALoweredPoint) {
  const std::string head = "TOOL CALL 1 Z S1000\nM3\nL Z+50 FMAX\n";
  const std::string cycle =
      "CYCL DEF 241 SINGLE-LIP DEEP-HOLE DRILLING ~\n  Q200=+2 ~\n  Q201=-80 ~\n  Q206=+150 ~\n  Q211=+0 ~\n"
      "  Q203=+0 ~\n  Q204=+50 ~\n  Q379={} ~\n  Q253=+750 ~\n  Q208=+1000 ~\n  Q426=+3 ~\n  Q427=+25 ~\n"
      "  Q428=+500 ~\n  Q429=+8 ~\n  Q430=+9 ~\n  Q435=+0 ~\n  Q401=+100 ~\n  Q202=+99999 ~\n  Q212=+0 ~\n"
      "  Q205=+0 ~\n  Q395=+0\nCYCL CALL\n";
  const NcRun flat = klartext(head + fmt::format(fmt::runtime(cycle), "+0"));
  EXPECT_EQ(flat.first_error(), "") << flat.text();
  expect_heights(flat, {50.0, 2.0, -80.0, 2.0, 50.0});
  // A fifth of 5 above -5; a fifth of 20 is more than the clearance of 2.
  const NcRun near = klartext(head + fmt::format(fmt::runtime(cycle), "+5"));
  expect_heights(near, {50.0, 2.0, -4.0, -80.0, 2.0, 50.0});
  EXPECT_FALSE(near.moves()[2].rapid);
  EXPECT_NEAR(near.moves()[2].feed_mm_s, 750.0 / 60.0, 1e-12);
  EXPECT_NEAR(near.moves()[2].spindle_rpm, 25.0, 1e-12);
  EXPECT_NEAR(near.moves()[3].spindle_rpm, 500.0, 1e-12);
  expect_heights(klartext(head + fmt::format(fmt::runtime(cycle), "+20")),
                 {50.0, 2.0, -18.0, -80.0, 2.0, 50.0});
}

}  // namespace
}  // namespace swarf::program
