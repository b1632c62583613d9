// Mazak EIA/ISO: what it has of its own, with exact ends.
#include "unit/program/nc_support.h"

namespace swarf::program {
namespace {

NcRun mazak(const std::string& text, const ControlSetup& setup = three_axis_setup()) {
  return run_text(text, Dialect::kMazak, setup);
}

std::vector<std::array<double, 2>> drilled(const NcRun& run, double bottom) {
  std::vector<std::array<double, 2>> holes;
  for (const NcMove& move : run.moves()) {
    if (move.to.tip_W.z() == bottom) holes.push_back({move.to.tip_W.x(), move.to.tip_W.y()});
  }
  return holes;
}
using Holes = std::vector<std::array<double, 2>>;

TEST(NcMazak, PatternsOfHoles) {
  const std::string head = "S1000 M03\nG00 X0. Y0. Z5.\nG98 G81 Z-4. R1. F100. L0\n";
  const auto holes = [&](const std::string& block) {
    const NcRun run = mazak(head + block + "\nG80\nM30\n");
    EXPECT_EQ(run.text(), "") << block;
    return drilled(run, -4.0);
  };
  EXPECT_EQ(holes("G34.1 X10. Y20. I5. J0. K4"), (Holes{{15, 20}, {10, 25}, {5, 20}, {10, 15}}));
  EXPECT_EQ(holes("G34.1 X10. Y20. I5. J0. K-4"), (Holes{{15, 20}, {10, 15}, {5, 20}, {10, 25}}));
  EXPECT_EQ(holes("G35 X10. Y20. I5. J90. K3"), (Holes{{10, 20}, {10, 25}, {10, 30}}));
  EXPECT_EQ(holes("G36 X10. Y20. I5. J0. P90. K2"), (Holes{{15, 20}, {10, 25}}));
  EXPECT_EQ(mazak("G34.1 X10. Y20. I5. J0. K4\nM30\n").first_error(), "modal-conflict 1:1");
  EXPECT_EQ(mazak(head + "G35 I5. J0. K0\nM30\n").first_error(), "out-of-range 4:13");
}

TEST(NcMazak, SubprogramsBeginAtQ) {
  const NcRun run = mazak(
      "M98 P12345678 Q20 L2\nM98 P12345678\nM30\nO12345678\nN10 G91 G00 X1.\nN20 G91 G00 X10.\nG90 M99\n");
  ASSERT_EQ(run.text(), "");
  std::vector<double> xs;
  for (const NcMove& move : run.moves()) xs.push_back(move.to.tip_W.x());
  EXPECT_EQ(xs, (std::vector<double>{10, 20, 21, 31}));
  EXPECT_EQ(mazak("M98 P5 Q7\nM30\nO5\nM99\n").first_error(), "unknown-label 1:1");
}

TEST(NcMazak, EightLevelsOfSubprograms) {
  std::string text = "M98 P1\nM30\n";
  for (int level = 1; level < 8; ++level)
    text += "O" + std::to_string(level) + "\nM98 P" + std::to_string(level + 1) + "\nM99\n";
  EXPECT_EQ(mazak(text + "O8\nG00 X1.\nM99\n").text(), "");
  EXPECT_EQ(mazak(text + "O8\nM98 P9\nM99\nO9\nM99\n").first_error(), "recursion-limit 25:1");
}

TEST(NcMazak, GeometryCompensationDoesNotStop) {
  const NcRun run = mazak("S1000 M03\nG61.1\nG01 X1. F100.\nG61\nX2.\nG64\nX3.\nM30\n");
  ASSERT_EQ(run.text(), "");
  EXPECT_FALSE(run.moves()[0].exact_stop);
  EXPECT_TRUE(run.moves()[1].exact_stop);
  EXPECT_FALSE(run.moves()[2].exact_stop);
  EXPECT_NE(
      std::find(run.summary.functions.begin(), run.summary.functions.end(), "G61.1 (geometry compensation)"),
      run.summary.functions.end());
}

TEST(NcMazak, FiveAxesAsOnFanuc) {
  const std::string job =
      "S1000 M03\nT2 M06\nG43.4 H2\nG01 X10. Y5. Z20. A30. C45. F600.\nG49\nG43 H2\nG69\nG68.2 X1. Y2. Z3. "
      "I10. J20. "
      "K30.\nG53.1\n"
      "G00 X1. Y1. Z5.\nG69\nM30\n";
  const NcRun one = mazak(job, five_axis_setup()), other = run_text(job, Dialect::kFanuc, five_axis_setup());
  ASSERT_EQ(one.text() + other.text(), "");
  ASSERT_EQ(one.moves().size(), other.moves().size());
  for (size_t i = 0; i < one.moves().size(); ++i) {
    EXPECT_EQ(one.moves()[i].q_to, other.moves()[i].q_to) << "move " << i;
    EXPECT_EQ(one.moves()[i].law, other.moves()[i].law) << "move " << i;
  }
}

TEST(NcMazak, WhatItRefuses) {
  EXPECT_EQ(mazak("G84.2 Z-4. R1. F1.5\nM30\n").first_error(), "unsupported-word 1:1");
  EXPECT_EQ(mazak("G68.5\nM30\n").first_error(), "unsupported-word 1:1");
  EXPECT_EQ(mazak("#1=#10001\nM30\n").first_error(), "undefined-parameter 1:4");
  EXPECT_EQ(mazak("G45\nM30\n").first_error(), "unsupported-word 1:1");
  EXPECT_EQ(mazak("G05.1 Q1\nM30\n").first_error(), "unknown-word 1:1");
  EXPECT_NE(mazak("G00 X5\nM30\n").text().find("number-without-point"), std::string::npos);
}

}  // namespace
}  // namespace swarf::program
