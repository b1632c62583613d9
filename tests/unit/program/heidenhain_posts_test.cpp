// What post-processors and shop-floor programmers write, against hand calculation.
#include <fmt/format.h>

#include "unit/program/heidenhain_support.h"

namespace swarf::program {
namespace {

TEST(HeidenhainPosts, FeedsAndSpeedsByParameter) {
  const NcRun run = klartext_clean(
      "Q50 = 600\nQ20 = 3000\nQL5 = 1200\nQ51 = 4\nTOOL CALL 1 Z SQ20 FQ50 DL+0,1\nL X+0Y+0 Z+10 R0 FMAX "
      "M3\nL X+10 "
      "FQ50\nL X+20 FQL5\nRND RQ51\nL Y+30\n");
  ASSERT_EQ(run.moves().size(), 5u);
  EXPECT_NEAR(run.moves()[1].feed_mm_s, 10.0, 1e-12);
  EXPECT_NEAR(run.moves()[1].spindle_rpm, 3000.0, 1e-12);
  EXPECT_NEAR(run.moves()[2].feed_mm_s, 20.0, 1e-12);
  expect_tip(run.moves()[2], 16, 0, 10.1);  // the true tool is 0.1 mm shorter than DL says
  expect_tip(run.moves()[3], 20, 4, 10.1);
}

// The words of old cycles are those of the control's language.
TEST(HeidenhainPosts, OldCyclesInGerman) {
  const NcRun run = klartext_clean(
      "TOOL CALL 7 Z S2000\nL X+10 Y+10 Z+2 R0 FMAX M3\nCYCL DEF 1.0 TIEFBOHREN\nCYCL DEF 1.1 ABST 2\nCYCL "
      "DEF 1.2 "
      "TIEFE -8\nCYCL DEF 1.3 ZUSTLG 5\nCYCL DEF 1.4 V.ZEIT 0.5\nCYCL DEF 1.5 F200\nCYCL CALL M8\n");
  expect_heights(run, {2, -5, 2, -4.4, -8, 2});
  EXPECT_NEAR(run.moves().back().dwell_s, 0.5, 1e-12);
}

TEST(HeidenhainPosts, HandwheelAndLookAheadAreListed) {
  const NcRun run = klartext_clean("L X+0 Y+0 R0 FMAX M118 X1 Y1\nL X+5 F600 M120 LA5\nM118\n");
  ASSERT_EQ(run.moves().size(), 1u);
  expect_tip(run.moves()[0], 5, 0, 0);
  EXPECT_EQ(run.summary.functions, (std::vector<std::string>{"M118", "M120"}));
}

TEST(HeidenhainPosts, LinesOfCommentsAreCounted) {
  const NcRun run = klartext_clean("* - ROUGHING\n\n; a comment\nL X+1 FMAX ; go\n");
  EXPECT_EQ(run.summary.lines, 6);
}

// TABLE ROT and COORD ROT differ only where a rotary axis is parallel to the tool.
TEST(HeidenhainPosts, TableRotWhereNoAxisIsFree) {
  const std::string plane = "PLANE SPATIAL SPA+0 SPB+30 SPC+20 TURN MB MAX FMAX SEQ- ";
  const NcRun coordinates = klartext_clean(plane + "COORD ROT\n", free_five_axis_setup());
  const NcRun table = klartext_clean(plane + "TABLE ROT\n", free_five_axis_setup());
  ASSERT_EQ(table.moves().size(), coordinates.moves().size());
  for (size_t i = 0; i < table.moves().size(); ++i)
    EXPECT_EQ(table.moves()[i].q_to, coordinates.moves()[i].q_to);
}

// With the table free, COORD ROT turns the coordinates and TABLE ROT the work: X is then the machine's.
TEST(HeidenhainPosts, TableRotTurnsAFreeTable) {
  const kinematics::MachineModel machine = free_five_axis_setup().machine;
  for (const double angle : {20.0, -75.0, 180.0}) {
    for (const std::string& kind :
         {fmt::format("SPATIAL SPA+0 SPB+0 SPC{:+g}", angle),
          fmt::format("EULER EULPR{:+g} EULNU+0 EULROT+0", angle), fmt::format("RELATIV SPC{:+g}", angle),
          fmt::format("VECTOR BX{:+.9f} BY{:+.9f} BZ+0 NX+0 NY+0 NZ+1", std::cos(rad_from_deg(angle)),
                      std::sin(rad_from_deg(angle)))}) {
      const auto moves = [&](const char* how) {
        return klartext_clean("L X+5 Y+3 Z+50 FMAX\nPLANE " + kind + " TURN FMAX " + how +
                                  " ROT\nL X+0 Y+0 FMAX\nL X+10 FMAX\n",
                              free_five_axis_setup())
            .moves();
      };
      const std::vector<NcMove> table = moves("TABLE"), coordinates = moves("COORD");
      // The same points of the part ..
      EXPECT_LT((table.back().to.tip_W - coordinates.back().to.tip_W).norm(), 1e-6) << kind;
      EXPECT_LT((table.back().from.tip_W - coordinates.back().from.tip_W).norm(), 1e-6) << kind;
      // .. reached by X alone, with the table turned by the angle.
      const kinematics::AxisValues way = table.back().q_to - table.back().q_from;
      const kinematics::AxisValues turned = table.back().q_to - coordinates.back().q_to;
      double most = 0.0;
      for (size_t i = 0; i < machine.axes.size(); ++i) {
        const auto at = static_cast<long>(i);
        EXPECT_NEAR(std::abs(way[at]), machine.axes[i].name == "X" ? 10.0 : 0.0, 1e-6) << kind;
        if (machine.axes[i].kind == kinematics::AxisKind::kRotary)
          most = std::max(most, std::abs(turned[at]));
      }
      EXPECT_NEAR(most, rad_from_deg(std::abs(angle)), 1e-7) << kind;
    }
  }
}

TEST(HeidenhainPosts, RemediesSpeakKlartext) {
  const std::string tool = "TOOL CALL 1 Z S100\nL X-20 FMAX\n";
  EXPECT_NE(klartext(tool + "L X+0 RL F100\nL X+30\nTOOL CALL 2 Z\n").text().find("switch it off first: R0"),
            std::string::npos);
  EXPECT_NE(klartext(tool + "L X+10 FU0.1\n").text().find("(M136, FU)"), std::string::npos);
  ControlSetup nowhere = three_axis_setup();
  nowhere.start.reset();
  EXPECT_NE(klartext("L X+10 F100\n", nowhere).text().find("position all axes with L .. FMAX before it"),
            std::string::npos);
}

// Rows of a zigzag by FN 12, each back in the air.
TEST(HeidenhainPosts, ZigzagByLabelAndParameter) {
  const NcRun run = klartext_clean(
      "TOOL CALL 1 Z S2000 F800\nQ1 = +0 ; Y\nLBL 1\nL X-5 Y+Q1 FMAX M3\nL Z-2 FMAX\nL X+105 F AUTO\nL Z+5 "
      "FMAX\nQ1 = Q1 + "
      "7,5\nFN 12: IF +Q1 LT +30 GOTO LBL 1\nL Z+100 R0 FMAX M2\n");
  double way = 0.0;
  std::vector<double> rows;
  for (const NcMove& move : run.moves()) {
    if (move.rapid) continue;
    way += (move.to.tip_W - move.from.tip_W).norm();
    rows.push_back(move.to.tip_W.y());
  }
  EXPECT_NEAR(way, 4 * 110.0, 1e-9);
  EXPECT_EQ(rows, (std::vector<double>{0.0, 7.5, 15.0, 22.5}));
}

}  // namespace
}  // namespace swarf::program
