// Haas NGC: what it has of its own, with exact ends; what it shares with Fanuc, move for move.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "unit/program/nc_support.h"

namespace swarf::program {
namespace {

NcRun haas(const std::string& text, const ControlSetup& setup = three_axis_setup()) {
  return run_text(text, Dialect::kHaas, setup);
}

NcRun fanuc_twin(const std::string& text, const ControlSetup& setup = three_axis_setup()) {
  return run_text(text, Dialect::kFanuc, setup);
}

/// Every number of both programs' moves is the same.
void expect_twins(const NcRun& one, const NcRun& other) {
  ASSERT_EQ(one.first_error() + other.first_error(), "") << one.text() << other.text();
  ASSERT_EQ(one.moves().size(), other.moves().size());
  for (size_t i = 0; i < one.moves().size(); ++i) {
    const NcMove &a = one.moves()[i], &b = other.moves()[i];
    EXPECT_EQ(a.q_from, b.q_from) << "move " << i;
    EXPECT_EQ(a.q_to, b.q_to) << "move " << i;
    EXPECT_EQ(a.to.tip_W, b.to.tip_W) << "move " << i;
    EXPECT_EQ(a.to.axis_W, b.to.axis_W) << "move " << i;
    EXPECT_EQ(a.law, b.law) << "move " << i;
    EXPECT_EQ(a.rapid, b.rapid) << "move " << i;
    EXPECT_EQ(a.feed_mm_s, b.feed_mm_s) << "move " << i;
    EXPECT_EQ(a.duration_s, b.duration_s) << "move " << i;
    EXPECT_EQ(a.dwell_s, b.dwell_s) << "move " << i;
    EXPECT_EQ(a.spindle_rpm, b.spindle_rpm) << "move " << i;
    ASSERT_EQ(a.arc.has_value(), b.arc.has_value()) << "move " << i;
    if (a.arc) {
      EXPECT_EQ(a.arc->centre_W, b.arc->centre_W) << "move " << i;
      EXPECT_EQ(a.arc->normal_W, b.arc->normal_W) << "move " << i;
    }
  }
}

std::vector<std::array<double, 3>> haas_tips(const NcRun& run) {
  std::vector<std::array<double, 3>> all;
  for (const NcMove& move : run.moves())
    all.push_back({move.to.tip_W.x(), move.to.tip_W.y(), move.to.tip_W.z()});
  return all;
}
using Tips = std::vector<std::array<double, 3>>;

TEST(NcHaas, G28AloneSendsEveryAxisHomeAtOnce) {
  ControlSetup setup = five_axis_setup();
  for (kinematics::Axis& axis : setup.machine.axes) {
    if (axis.name == "Z") axis.home = 400.0;
    if (axis.name == "X") axis.home = -20.0;
  }
  const NcRun run = haas("G00 X1. Y2. Z3. A10. C20.\nG28\nG91 G28 Z0\nM30\n", setup);
  ASSERT_EQ(run.text(), "");
  ASSERT_GE(run.moves().size(), 2u);
  for (size_t axis = 0; axis < setup.machine.axes.size(); ++axis)
    EXPECT_EQ(run.moves()[1].q_to[static_cast<long>(axis)], setup.machine.axes[axis].home);
  EXPECT_TRUE(run.moves()[1].rapid);
  // The control that it is derived from wants axis words there.
  EXPECT_EQ(fanuc_twin("G00 X1. Y2. Z3.\nG28\nM30\n").first_error(), "missing-word 2:1");
}

TEST(NcHaas, CircularPocketOfOnePass) {
  // Cutter of 8 mm in radius 8: its centre goes round in radius 4.
  const NcRun run = haas("S1000 M03\nG00 X20. Y5. Z2.\nG13 D1 I8. Z-3. F120.\nG00 Z2.\nM30\n");
  ASSERT_EQ(run.text(), "");
  EXPECT_EQ(haas_tips(run),
            (Tips{{20, 5, 2}, {20, 5, -3}, {24, 5, -3}, {24, 5, -3}, {20, 5, -3}, {20, 5, 2}}));
  const NcMove &in = run.moves()[2], &round = run.moves()[3], &out = run.moves()[4];
  EXPECT_EQ(in.arc->centre_W, Vec3(22, 5, -3));
  EXPECT_EQ(round.arc->centre_W, Vec3(20, 5, -3));
  EXPECT_EQ(out.arc->centre_W, Vec3(22, 5, -3));
  for (const NcMove* move : {&in, &round, &out}) {
    EXPECT_EQ(move->arc->normal_W, Vec3::UnitZ());
    EXPECT_EQ(move->feed_mm_s, 2.0);
  }
  EXPECT_NEAR(round.duration_s, 2.0 * kPi * 4.0 / 2.0, 1e-12);
  EXPECT_NEAR(in.duration_s, kPi * 2.0 / 2.0, 1e-12);
  // Clockwise, and without D the one that stood last.
  const NcRun other = haas("S1000 M03\nG41 D1\nG40\nG00 X20. Y5. Z-3.\nG12 I8. F120.\nM30\n");
  ASSERT_EQ(other.text(), "");
  EXPECT_EQ(other.moves()[2].arc->normal_W, Vec3(0, 0, -1));
}

TEST(NcHaas, CircularPocketOfSeveralPassesAndDepths) {
  // Walls at 6, 9, 10; centres at 2, 5, 6; each circle begins on the other side.
  const NcRun run =
      haas("S1000 M03\nG00 X0. Y0. Z1.\nG91 G13 D1 I6. K10. Q3. Z-2. L2 F100.\nG90 G00 Z5.\nM30\n");
  ASSERT_EQ(run.text(), "");
  Tips expected{{0, 0, 1}};
  for (const double z : {-1.0, -3.0}) {
    for (const double x : {0.0, 2.0, 2.0, -5.0, -5.0, 6.0, 6.0, 0.0}) expected.push_back({x, 0, z});
  }
  expected.push_back({0, 0, 5});
  EXPECT_EQ(haas_tips(run), expected);
  // No half circle leaves the circle that it leads to.
  for (const NcMove& move : run.moves()) {
    if (!move.arc) continue;
    const double radius = (move.to.tip_W - move.arc->centre_W).norm();
    EXPECT_LE(move.arc->centre_W.head<2>().norm() + radius,
              std::max(move.to.tip_W.head<2>().norm(), move.from.tip_W.head<2>().norm()) + 1e-12);
  }
}

TEST(NcHaas, CircularPocketSaysWhatItLeavesStanding) {
  EXPECT_NE(
      haas("S1000 M03\nT1 M06\nG00 X0. Y0. Z1.\nG13 D1 I20. Z-1. F100.\nM30\n").text().find("pocket-rests"),
      std::string::npos);
  EXPECT_EQ(haas("S1000 M03\nT1 M06\nG00 X0. Y0. Z1.\nG13 D1 I8. K20. Q8. Z-1. F100.\nM30\n").text(), "");
}

TEST(NcHaas, BoltCirclesDrillTheCycleThatIsOn) {
  const std::string head = "S1000 M03\nG00 X10. Y20. Z5.\nG98 G81 Z-4. R1. F100. L0\n";
  const NcRun run = haas(head + "G70 I5. J90. L4\nG80\nM30\n");
  ASSERT_EQ(run.text(), "");
  std::vector<std::array<double, 2>> holes;
  for (const NcMove& move : run.moves()) {
    if (move.to.tip_W.z() == -4.0) holes.push_back({move.to.tip_W.x(), move.to.tip_W.y()});
  }
  EXPECT_EQ(holes, (std::vector<std::array<double, 2>>{{10, 25}, {5, 20}, {10, 15}, {15, 20}}));
  const NcRun arc = haas(head + "G71 I5. J0. K90. L2\nG80\nM30\n");
  ASSERT_EQ(arc.text(), "");
  EXPECT_EQ(haas_tips(arc).back(), (std::array<double, 3>{10, 25, 5}));
  EXPECT_EQ(haas("G70 I5. L4\nM30\n").first_error(), "modal-conflict 1:1");
}

TEST(NcHaas, LocalSubprogramsBeginAtABlockNumber) {
  const NcRun run = haas("O01000\nM97 P100 L2\nG00 Y9.\nM30\nN100 G91 G00 X1.\nN110 X2.\nG90 M99\n");
  ASSERT_EQ(run.text(), "");
  EXPECT_EQ(haas_tips(run), (Tips{{1, 0, 0}, {3, 0, 0}, {4, 0, 0}, {6, 0, 0}, {6, 9, 0}}));
  // From a subprogram the block is one of it.
  const NcRun nested = haas("M98 P20\nM30\nN5 G00 X99.\nM99\nO00020\nM97 P5\nM99\nN5 G00 X7.\nM99\n");
  ASSERT_EQ(nested.text(), "");
  EXPECT_EQ(haas_tips(nested), (Tips{{7, 0, 0}}));
  EXPECT_EQ(haas("M97 P7\nM30\n").first_error(), "unknown-label 1:1");
  EXPECT_EQ(haas("N1 M97 P1\nM30\n").first_error(), "recursion-limit 1:4");
}

TEST(NcHaas, ProgramNumbersHaveFiveDigits) {
  // P is the number alone: 30100 does not call O0100 three times.
  const NcRun run = haas("M98 P30100 L2\nM30\nO30100\nG91 G00 X1.\nG90 M99\nO0100\nG00 X77.\nM99\n");
  ASSERT_EQ(run.text(), "");
  EXPECT_EQ(haas_tips(run), (Tips{{1, 0, 0}, {2, 0, 0}}));
  const auto folder = std::filesystem::temp_directory_path() / "swarf_nc_haas_external";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "O00040.nc") << "%\nO00040 (A FILE)\nG91 G00 X5.\nG90 M99\n%\n";
  ControlSetup setup = three_axis_setup();
  setup.subprogram_folders = {folder.string()};
  const NcRun called = haas("M98 P40\nM30\n", setup);
  EXPECT_EQ(called.text(), "");
  EXPECT_EQ(haas_tips(called), (Tips{{5, 0, 0}}));
  std::filesystem::remove_all(folder);
}

TEST(NcHaas, DwellsAreSecondsWithAPoint) {
  const NcRun run = haas("G04 P2.5\nG00 X1.\nG04 P250\nX2.\nM30\n");
  ASSERT_EQ(run.text(), "");
  EXPECT_EQ(run.moves()[0].dwell_s, 2.5);
  EXPECT_EQ(run.moves()[1].dwell_s, 0.25);
}

TEST(NcHaas, NumbersWithoutAPointAreSaid) {
  const NcRun run = haas("G00 X5\nM30\n");
  EXPECT_NE(run.text().find("number-without-point"), std::string::npos);
  EXPECT_EQ(haas("G00 X5. Y0\nM30\n").text(), "");
}

TEST(NcHaas, WorkOffsets) {
  // G154 P3 is G112; G10 L20 sets it.
  for (const char* code : {"G154 P3", "G112"}) {
    const NcRun run = haas(fmt::format("G10 L20 P3 X10. Y20. Z30.\n{} G00 X1. Y1. Z1.\nM30\n", code));
    ASSERT_EQ(run.text(), "") << code;
    EXPECT_EQ(haas_tips(run), (Tips{{11, 21, 31}})) << code;
  }
  EXPECT_EQ(haas("G154 P100\nM30\n").first_error(), "out-of-range 1:6");
  EXPECT_EQ(haas("G54.1 P1\nM30\n").first_error(), "unknown-word 1:1");
}

TEST(NcHaas, Variables) {
  const NcRun run = haas(
      "G154 P7\n#1=#4012\nG55\n#2=#4012\nT1 M06\n#3=#3026\n#4=#2002\n#5=#2402\nG00 X#1 Y#2 Z#3\nX#4 "
      "Y#5\nM30\n");
  ASSERT_EQ(run.first_error(), "") << run.text();
  EXPECT_EQ(haas_tips(run)[0], (std::array<double, 3>{154, 55, 1}));
  EXPECT_EQ(haas_tips(run)[1], (std::array<double, 3>{50, 10, 1}));
  EXPECT_NE(run.text().find("offset-as-diameter"), std::string::npos);
  EXPECT_EQ(haas("#1=#20085\nM30\n").first_error(), "undefined-parameter 1:4");
  EXPECT_EQ(haas("#1=#10101\nM30\n").first_error(), "undefined-parameter 1:4");
  EXPECT_EQ(haas("#20085=1\nM30\n").first_error(), "bad-parameter 1:1");
}

TEST(NcHaas, ListedWordsMoveNothing) {
  const NcRun run = haas("G187 P3 E0.02\nG103 P1\nM59 P1114\nM19 P90\nDPRNT[X#1[43]]\nM31\nG00 X1.\nM30\n");
  ASSERT_EQ(run.text(), "");
  EXPECT_EQ(run.moves().size(), 1u);
  for (const char* word : {"G187 (smoothness)", "G103 (block look-ahead limit)", "M59 (relay)", "DPRNT"}) {
    EXPECT_NE(std::find(run.summary.functions.begin(), run.summary.functions.end(), word),
              run.summary.functions.end())
        << word;
  }
}

TEST(NcHaas, TcpcIsFanucsTcp) {
  const std::string moves = "G01 X10. Y5. Z20. A30. C45. F600.\nX-10. A-20. C90.\nG49\nM30\n";
  expect_twins(haas("S1000 M03\nT2 M06\nG234 H2\n" + moves, five_axis_setup()),
               fanuc_twin("S1000 M03\nT2 M06\nG43.4 H2\n" + moves, five_axis_setup()));
}

TEST(NcHaas, FeatureCoordinateSystemTurnsAboutStandingAxes) {
  const std::string moves = "G00 X3. Y4. Z5.\nG01 X1. F500.\n";
  expect_twins(
      haas("S1000 M03\nT2 M06\nG43 H2\nG00 X0. Y0. Z50. A0. C0.\nG268 X1. Y2. Z3. I20. J30. K40. "
           "Q123\nG253\n" +
               moves + "G269\nG00 X0. Y0.\nM30\n",
           five_axis_setup()),
      fanuc_twin(
          "S1000 M03\nT2 M06\nG43 H2\nG00 X0. Y0. Z50. A0. C0.\nG68.2 P1 X1. Y2. Z3. I20. J30. K40. Q123\n"
          "G53.1\n" +
              moves + "G69\nG00 X0. Y0.\nM30\n",
          five_axis_setup()));
  // G69 ends the rotation of G68, not the feature coordinate system.
  const std::string head = "G00 X0. Y0. Z50. A0. C0.\nG268 X1. Y2. Z3. K90. Q123\n";
  const NcRun kept = haas(head + "G69\nG00 X1. Y0.\nM30\n", five_axis_setup());
  ASSERT_EQ(kept.text(), "");
  const NcRun plain = haas(head + "G00 X1. Y0.\nM30\n", five_axis_setup());
  EXPECT_EQ(kept.moves().back().q_to, plain.moves().back().q_to);
  EXPECT_EQ(haas(head + "G68 X0. Y0. R10.\nM30\n", five_axis_setup()).first_error(), "modal-conflict 3:1");
}

TEST(NcHaas, MirrorImagesLieAtTheZero) {
  expect_twins(haas("G101 X0.\nG00 X5. Y3. Z1.\nG100 X0.\nX5.\nM30\n"),
               fanuc_twin("G51.1 X0.\nG00 X5. Y3. Z1.\nG50.1 X0.\nX5.\nM30\n"));
  EXPECT_EQ(haas("G101 X4.\nM30\n").first_error(), "unsupported-word 1:6");
}

TEST(NcHaas, OffsetDiameters) {
  const NcRun run = haas("G10 L12 P1 R6.\nS1000 M03\nG00 X0. Y0. Z-1.\nG13 D1 I10. F100.\nM30\n");
  ASSERT_EQ(run.first_error(), "");
  EXPECT_NE(run.text().find("offset-as-diameter"), std::string::npos);
  EXPECT_EQ(run.moves()[1].to.tip_W.x(), 7.0);
}

TEST(NcHaas, SharedProgramsMoveAsFanucReadsThem) {
  const std::string job =
      "G21 G90 G94 G17 G40 G49 G80 G54\nT2 M06\nG43 H2\nS4000 M03\nG00 X0. Y0. Z20.\nG01 Z-2. F300.\n"
      "G41 D2 X10. Y0.\nG01 Y20.\nG03 X0. Y30. I-10. J0.\nG01 X-20.\nG40 X-30. Y40.\nG00 Z20.\n"
      "G68 X0. Y0. R30.\nG98 G83 X5. Y5. Z-12. R2. Q4. F200.\nX10.\nG80\nG69\nG91 G28 Z0.\nG90\n"
      "#1=0\nWHILE [#1 LT 3] DO1\nG00 X[#1*10.]\n#1=#1+1\nEND1\nG65 P50 A4.\nM30\nO50\nG00 Y#1\nM99\n";
  expect_twins(haas("%\nO01234\n" + job + "%\n"), fanuc_twin("%\nO1234\n" + job + "%\n"));
}

TEST(NcHaas, TheSameCutAsItsFanucTwin) {
  // The job of scenes/nc_pocket, its pocket by G13 and its holes by G70 in a local subprogram, against arcs
  // and points written out. Ends within the rounding of the angles: 1e-13 of 33.5 mm.
  ControlSetup setup = three_axis_setup();
  setup.tools = {{1, "MILL_10", 45.0, 10.0, 0.0}, {2, "DRILL_8", 90.0, 8.0, 0.0}};
  const std::string folder = std::string(SWARF_SOURCE_DIR) + "/tests/data/programs/nc/";
  const NcRun one = run_file(folder + "haas/good/pocket.nc", std::nullopt, setup),
              other = run_file(folder + "fanuc/good/pocket.nc", std::nullopt, setup);
  ASSERT_EQ(one.text() + other.text(), "");
  EXPECT_EQ(one.summary.dialect, Dialect::kHaas);
  EXPECT_EQ(other.summary.dialect, Dialect::kFanuc);
  ASSERT_EQ(one.moves().size(), other.moves().size());
  for (size_t i = 0; i < one.moves().size(); ++i) {
    const NcMove &a = one.moves()[i], &b = other.moves()[i];
    EXPECT_NEAR((a.to.tip_W - b.to.tip_W).norm(), 0.0, 1e-11) << "lines " << a.line << " and " << b.line;
    EXPECT_EQ(a.rapid, b.rapid) << "lines " << a.line << " and " << b.line;
    EXPECT_EQ(a.feed_mm_s, b.feed_mm_s) << "lines " << a.line << " and " << b.line;
    EXPECT_EQ(a.tool, b.tool) << "lines " << a.line << " and " << b.line;
    ASSERT_EQ(a.arc.has_value(), b.arc.has_value()) << "lines " << a.line << " and " << b.line;
    if (a.arc) EXPECT_EQ(a.arc->centre_W, b.arc->centre_W) << "lines " << a.line << " and " << b.line;
  }
}

TEST(NcHaas, IsRecognised) {
  const auto recognised = [](const std::string& text) {
    const auto path = std::filesystem::temp_directory_path() / "swarf_nc_haas_recognised.nc";
    std::ofstream(path) << text;
    return run_file(path.string(), std::nullopt, three_axis_setup());
  };
  EXPECT_EQ(recognised("%\nO01234\nG00 X1.\nG187 P2\nWHILE [1 EQ 2] DO1\nEND1\nM30\n%\n").summary.dialect,
            Dialect::kHaas);
  EXPECT_EQ(recognised("%\nO1234\nG00 X1.\nG05.1 Q1\nM30\n%\n").summary.dialect, Dialect::kFanuc);
}

/// G254: zero is the work's origin where the standing axes have carried it, X Y Z are those of the machine.
TEST(NcHaas, DynamicWorkOffsetFollowsTheStandingRotaries) {
  const NcRun run =
      haas("G00 X0 Y0 Z0 A0. C0.\nZ200.\nA30. C40.\nG254\nX0 Y0\nZ0\nX10.\nZ5.\nG255\nG53 G00 Z0\nM30\n",
           five_axis_setup());
  ASSERT_EQ(run.text(), "");
  const auto& moves = run.moves();
  ASSERT_GE(moves.size(), 6u);
  const size_t zero = moves.size() - 4;  // Z0 of the dynamic offset
  EXPECT_LT(moves[zero].to.tip_W.norm(), 1e-9) << "the work's origin, wherever the table has carried it";
  const AxisValues by_x = moves[zero + 1].q_to - moves[zero].q_to,
                   by_z = moves[zero + 2].q_to - moves[zero + 1].q_to;
  const auto axis = [](const char* name) {
    const auto axes = five_axis_setup().machine.axes;
    return std::find_if(axes.begin(), axes.end(), [&](const auto& one) { return one.name == name; }) -
           axes.begin();
  };
  EXPECT_NEAR(std::abs(by_x[axis("X")]), 10.0, 1e-9);
  EXPECT_NEAR(by_x.cwiseAbs().sum(), 10.0, 1e-9);
  EXPECT_NEAR(std::abs(by_z[axis("Z")]), 5.0, 1e-9);
  EXPECT_NEAR(by_z.cwiseAbs().sum(), 5.0, 1e-9);
  const Vec3 up = moves[zero + 2].to.tip_W - moves[zero + 1].to.tip_W;
  EXPECT_LT((up - 5.0 * moves[zero].to.axis_W).norm(), 1e-9) << "Z lies along the tool";
}

TEST(NcHaas, DynamicWorkOffsetAtZeroIsTheWorkOffset) {
  const std::string path = "G00 X1. Y2. Z3.\nG01 X5. F100.\nY7.\n";
  const NcRun with = haas("G00 X0 Y0 Z0 A0. C0.\nG254\n" + path + "G255\nM30\n", five_axis_setup());
  const NcRun without = haas("G00 X0 Y0 Z0 A0. C0.\n" + path + "M30\n", five_axis_setup());
  ASSERT_EQ(with.text() + without.text(), "");
  ASSERT_EQ(with.moves().size(), without.moves().size());
  for (size_t i = 0; i < with.moves().size(); ++i)
    EXPECT_LT((with.moves()[i].q_to - without.moves()[i].q_to).norm(), 1e-9);
}

TEST(NcHaas, WhatTurnsUnderDynamicWorkOffsetIsRefused) {
  const std::string on = "G00 X0 Y0 Z0 A0. C30.\nG254\n";
  EXPECT_EQ(haas(on + "A10.\nM30\n", five_axis_setup()).first_error(), "modal-conflict 3:1");
  EXPECT_EQ(haas(on + "G28\nM30\n", five_axis_setup()).first_error(), "modal-conflict 3:1");
  EXPECT_EQ(haas(on + "G234 H1\nM30\n", five_axis_setup()).first_error(), "modal-conflict 3:1");
  EXPECT_EQ(haas(on + "G254\nM30\n", five_axis_setup()).first_error(), "modal-conflict 3:1");
  EXPECT_EQ(haas(on + "G255\nA10.\nM30\n", five_axis_setup()).first_error(), "");
}

}  // namespace
}  // namespace swarf::program
