// CYCLE72 and the older pockets of the 840D: ways against what the parameters say, to the last digits.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "unit/program/mutate.h"
#include "unit/program/siemens_support.h"

namespace swarf::program::nc::siemens {
namespace {

constexpr double kCutter = 5.0;  // radius of T1

std::string contour_program(const std::string& cycle, const std::string& contour) {
  return "G17 G90 G54 G94\nT1 M6\nS2000 M3 F700\nG0 X0 Y0 Z50\n" + cycle + "\nG0 Z60\nM30\nBEG:\n" + contour +
         "LAST:\n";
}

Ran contour_ran(const std::string& cycle, const std::string& contour) {
  return run_text(contour_program(cycle, contour));
}

/// From the middle of its left side clockwise around 40 by 20: the outside lies on the left.
const std::string kBox = "G1 X0 Y10\nY20\nX40\nY0\nX0\nY10\n";

std::vector<Vec3> ends(const Ran& ran) {
  EXPECT_FALSE(ran.diagnostics.has_errors()) << all_text(ran.diagnostics);
  std::vector<Vec3> all;
  for (const NcMove& move : ran.moves) all.push_back(move.to.tip_W);
  return all;
}

void expect_ends(const Ran& ran, const std::vector<Vec3>& wanted) {
  const std::vector<Vec3> have = ends(ran);
  // The first moves go to X0 Y0 Z50, the last one up to Z60.
  size_t from = 0;
  while (from < have.size() && have[from] != Vec3(0.0, 0.0, 50.0)) ++from;
  ASSERT_EQ(have.size(), from + 1 + wanted.size() + 1);
  for (size_t n = 0; n < wanted.size(); ++n)
    EXPECT_LT((have[from + 1 + n] - wanted[n]).norm(), 1e-9) << n << ": " << have[from + 1 + n].transpose();
}

TEST(SiemensContour, QuarterCirclesOntoABoxAndOffIt) {
  const Ran ran = contour_ran("CYCLE72(\"BEG:LAST\",20,0,1,-3,0,0,0,500,200,1,41,2,8)", kBox);
  const double r = kCutter;
  expect_ends(ran, {{0, 0, 20},
                    {-13, 2, 20},
                    {-13, 2, -2},
                    {-13, 2, -3},
                    {-r, 10, -3},
                    {-r, 20, -3},
                    {0, 20 + r, -3},
                    {40, 20 + r, -3},
                    {40 + r, 20, -3},
                    {40 + r, 0, -3},
                    {40, -r, -3},
                    {0, -r, -3},
                    {-r, 0, -3},
                    {-r, 10, -3},
                    {-13, 18, -3},
                    {-13, 18, 20}});
  int arcs = 0;
  for (const NcMove& move : ran.moves) {
    if (!move.arc) continue;
    const double radius = (move.from.tip_W - move.arc->centre_W).head<2>().norm();
    const bool lead = std::abs(move.arc->centre_W.x() + 13.0) < 1e-9;
    EXPECT_NEAR(radius, lead ? 8.0 : kCutter, 1e-9);
    EXPECT_EQ(move.arc->normal_W.z() > 0.0, lead);  // outer corners turn the other way
    ++arcs;
  }
  EXPECT_EQ(arcs, 6);
}

TEST(SiemensContour, AllowancesInfeedsAndTheWayUpBetween) {
  // Two levels of 2 mm less .5 on the floor; 1 mm left on the walls; straight on, half circle off.
  const std::string cycle = "CYCLE72(\"BEG:LAST\",20,0,1,-4,2,1,.5,500,200,";
  for (const auto& [kind, up] : {std::pair{"1", 20.0}, {"101", 1.0}, {"201", -1.75 + 1.0}}) {
    const std::vector<Vec3> have = ends(contour_ran(cycle + kind + ",41,1,7,300,3,6)", kBox));
    std::vector<double> levels;
    for (size_t n = 1; n < have.size(); ++n) {
      const bool down = have[n].z() < have[n - 1].z() && (have[n] - have[n - 1]).head<2>().norm() == 0.0;
      if (down && have[n].z() < 0.0) levels.push_back(have[n].z());
    }
    // Rapid to SDIS above each level, feed to it.
    ASSERT_GE(levels.size(), 3u);
    EXPECT_NEAR(levels.back(), -3.5, 1e-12);
    bool straight = false, half = false, lifted = false;
    for (size_t n = 1; n < have.size(); ++n) {
      straight |= (have[n - 1] - Vec3(-6, 10 - 7 - kCutter, -1.75)).norm() < 1e-9 &&
                  (have[n] - Vec3(-6, 10, -1.75)).norm() < 1e-9;
      half |=
          (have[n - 1] - Vec3(-6, 10, -1.75)).norm() < 1e-9 && (have[n] - Vec3(-18, 10, -1.75)).norm() < 1e-9;
      lifted |= (have[n] - Vec3(-18, 10, up)).norm() < 1e-9;
    }
    EXPECT_TRUE(straight && half && lifted) << kind;
  }
}

TEST(SiemensContour, WithoutCompensationTheCentreFollows) {
  const std::vector<Vec3> have =
      ends(contour_ran("CYCLE72(\"BEG:LAST\",20,0,1,-3,0,0,0,500,200,311,40,1,7,900,1,9)", kBox));
  // Feed between, at 900.
  EXPECT_LT((have[have.size() - 2] - Vec3(0, 19, 20)).norm(), 1e-9);
  EXPECT_LT((have[have.size() - 3] - Vec3(0, 19, -3)).norm(), 1e-9);
  const Ran ran = contour_ran("CYCLE72(\"BEG:LAST\",20,0,1,-3,0,0,0,500,200,311,40,1,7,900)", kBox);
  int at_900 = 0;
  for (const NcMove& move : ran.moves) at_900 += std::abs(move.feed_mm_s * 60.0 - 900.0) < 1e-9 ? 1 : 0;
  EXPECT_EQ(at_900, 4);
}

TEST(SiemensContour, CornersArcsAndIncrementsOfTheContourCount) {
  // The same contour in four ways: RND between lines is the arc of its radius; G91 behind the start.
  const std::string cycle = "CYCLE72(\"BEG:LAST\",20,0,1,-3,0,0,0,500,200,2,42,3,8)";
  const std::vector<Vec3> wanted =
      ends(contour_ran(cycle, "G1 X0 Y0\nX26\nG3 X30 Y4 CR=4\nG1 Y20\nG2 X36 Y26 I6 J0\nG1 X50\n"));
  for (const char* same : {"G0 X0 Y0\nG1 X30 RND=4\nY20\nG2 X36 Y26 I6 J0\nG1 X50\n",
                           "G0 X0 Y0\nG91\nG1 X30 RND=4\nY20\nG2 X6 Y6 I6 J0\nG1 X14\n",
                           "R1=26\nG0 X=R1-26 Y0\nG1 X=R1\nIF R1<0 GOTOF LAST\nG3 X=IC(4) Y=IC(4) I0 "
                           "J4\nG1 Y20\nG2 X36 Y26 CR=6\nG1 X50\n"}) {
    const std::vector<Vec3> have = ends(contour_ran(cycle, same));
    ASSERT_EQ(have.size(), wanted.size()) << same;
    for (size_t n = 0; n < have.size(); ++n) EXPECT_LT((have[n] - wanted[n]).norm(), 1e-9) << same << n;
  }
}

TEST(SiemensContour, InchProgramsAreTheSameInInches) {
  const std::string contour = "G1 X0 Y10\nY20\nX40\nG3 X50 Y10 I0 J-10\nG1 Y0\n";
  const std::vector<Vec3> wanted =
      ends(contour_ran("CYCLE72(\"BEG:LAST\",20,0,1,-3,0,0,0,508,254,1,41,2,8)", contour));
  const std::string inches =
      "G1 X0 Y=10/25.4\nY=20/25.4\nX=40/25.4\nG3 X=50/25.4 Y=10/25.4 I0 J=-10/25.4\nG1 Y0\n";
  const std::vector<Vec3> have =
      ends(run_text("G17 G90 G54 G94\nT1 M6\nS2000 M3 F700\nG0 X0 Y0 "
                    "Z50\nG700\nCYCLE72(\"BEG:LAST\",20/25.4,0,1/25.4,-3/25.4,"
                    "0,0,0,20,10,1,41,2,8/25.4)\nG710\nG0 Z60\nM30\nBEG:\n" +
                    inches + "LAST:\n"));
  ASSERT_EQ(have.size(), wanted.size());
  for (size_t n = 0; n < have.size(); ++n) EXPECT_LT((have[n] - wanted[n]).norm(), 1e-9) << n;
}

TEST(SiemensContour, WhatHeldBeforeTheCycleHoldsAfterIt) {
  const Ran ran = contour_ran("G91\nCYCLE72(\"BEG:LAST\",20,0,1,-3,0,0,0,500,200,1,41,2,8)\nG1 X1 Y1",
                              "G90 G1 X0 Y10 F111\nY20\n");
  ASSERT_FALSE(ran.diagnostics.has_errors()) << all_text(ran.diagnostics);
  const NcMove& move = ran.moves[ran.moves.size() - 2];
  EXPECT_LT((move.to.tip_W - move.from.tip_W - Vec3(1, 1, 0)).norm(), 1e-12);  // G91 and G1 as before
  EXPECT_NEAR(move.feed_mm_s * 60.0, 700.0, 1e-9);
}

TEST(SiemensContour, AContourInAFileOfItsOwnAndPartOfOne) {
  const std::string name = "CONTOUR" + std::to_string(getpid()),
                    path = test::scratch_text() + "/" + name + ".spf";
  std::ofstream(path) << "PROC " << name << "\n"
                      << "AA:\n"
                      << kBox << "BB:\nM17\n";
  const std::string rest = "\",20,0,1,-3,0,0,0,500,200,1,41,2,8)";
  const std::vector<Vec3> wanted = ends(contour_ran("CYCLE72(\"BEG:LAST" + rest, kBox));
  for (const std::string& asked : {name, name + ":AA:BB"}) {
    const std::vector<Vec3> have = ends(contour_ran("CYCLE72(\"" + asked + rest, ""));
    ASSERT_EQ(have.size(), wanted.size()) << asked;
    for (size_t n = 0; n < have.size(); ++n) EXPECT_EQ(have[n], wanted[n]) << asked;
  }
  // A contour that calls itself, or mills.
  std::ofstream(path) << name << "\nM17\n";
  EXPECT_EQ(errors_of(contour_ran("CYCLE72(\"" + name + rest, "").diagnostics)[0].substr(0, 15),
            "recursion-limit");
  std::ofstream(path) << "G1 X0 Y0\nCYCLE72(\"" << name << rest << "\nM17\n";
  EXPECT_EQ(errors_of(contour_ran("CYCLE72(\"" + name + rest, "").diagnostics)[0], "bad-contour 2:1");
  std::filesystem::remove(path);
}

TEST(SiemensContour, WhatCannotBeMilledIsRefused) {
  const auto first = [](const std::string& cycle, const std::string& contour) {
    const std::vector<std::string> all = errors_of(contour_ran(cycle, contour).diagnostics);
    return all.empty() ? std::string("none") : all[0];
  };
  const std::string good = "CYCLE72(\"BEG:LAST\",20,0,1,-3,0,0,0,500,200,1,41,2,8)";
  EXPECT_EQ(first(good, kBox), "none");
  const std::string head = "CYCLE72(\"BEG:LAST\",20,0,1,-3,0,0,0,500,200,";
  EXPECT_EQ(first("CYCLE72(\"BEG:GONE\",20,0,1,-3,0,0,0,500,200,1,41,2,8)", kBox), "unknown-label 5:9");
  EXPECT_EQ(first("CYCLE72(\"GONE\",20,0,1,-3,0,0,0,500,200,1,41,2,8)", kBox), "unknown-subprogram 5:9");
  EXPECT_EQ(first("CYCLE72(\"A:B:C:D\",20,0,1,-3,0,0,0,500,200,1,41,2,8)", kBox), "bad-contour 5:9");
  EXPECT_EQ(first("CYCLE72(7,20,0,1,-3,0,0,0,500,200,1,41,2,8)", kBox), "wrong-type 5:9");
  EXPECT_EQ(first("CYCLE72(\"BEG:LAST\",20,0,1,3,0,0,0,500,200,1,41,2,8)", kBox), "bad-cycle 5:27");
  EXPECT_EQ(first(head + "1,41,12,8)", kBox), "unsupported-word 5:49");  // in space
  EXPECT_EQ(first(head + "1,40,2,8)", kBox), "words-conflict 5:49");     // no side
  EXPECT_EQ(first(head + "1,41,2,0)", kBox), "bad-cycle 5:51");          // no way
  EXPECT_EQ(first(head + "10001,41,2,8)", kBox), "unsupported-word 5:44");
  EXPECT_EQ(first(head + "1,43,2,8)", kBox), "out-of-range 5:46");
  EXPECT_EQ(first("CYCLE72(\"BEG:LAST\",20,0,1,-3,0,1,0,500,200,1,40,1,8)", kBox), "words-conflict 5:32");
  EXPECT_EQ(first("MCALL " + good, kBox), "unsupported-word 5:7");
  EXPECT_EQ(first(good, ""), "bad-contour 5:9");
  EXPECT_EQ(first(good, "G1 X0 Y0\n"), "bad-contour 5:9");
  EXPECT_EQ(first(good, "G1 X0\nY20\n"), "bad-contour 9:1");
  EXPECT_EQ(first(good, "G91 G1 X0 Y0\nY20\n"), "bad-contour 9:5");
  EXPECT_EQ(first(good, "G1 X0 Y0\nG0 Y20\n"), "bad-contour 10:4");
  EXPECT_EQ(first(good, "G1 X0 Y0\nY20 Z1\n"), "bad-contour 10:5");
  EXPECT_EQ(first(good, "G1 X0 Y0 RND=2\nY20\nX5\n"), "bad-contour 9:1");
  EXPECT_EQ(first(good, "G1 X0 Y0\nX9 RND=2\n"), "bad-corner 10:4");
  EXPECT_EQ(first(good, "G1 X0 Y0\nG41 X9\n").substr(0, 11), "bad-contour");
  EXPECT_EQ(first(good, "G1 X0 Y0\nT2\nX9\n"), "bad-contour 10:1");
  EXPECT_EQ(first(good, "G1 X0 Y0\nGOTOF AWAY\nX9\n"), "unknown-label 10:7");
  EXPECT_EQ(first(good, "G1 X0 Y0\nX20\nGOTOB OUT\n"), "unknown-label 11:7");
  // A notch narrower than the cutter.
  EXPECT_EQ(first(good, "G1 X0 Y0\nY20\nX-3\nY0\nX-9\n").substr(0, 18), "compensation-gouge");
}

TEST(SiemensContour, NoMutationOfAContourCrashesOrHangs) {
  const std::string good =
      contour_program("CYCLE72(\"BEG:LAST\",20,0,1,-4,2,.5,.1,500,200,111,41,2,8,900,3,4)",
                      "G0 X0 Y10\nG1 Y20 RND=3\nG2 X9 Y29 CR=9\nG91 G1 X20 CHF=1\nY-30\nG90 X0\nY10\n");
  Rng rng(14);
  for (int n = 0; n < 400; ++n) {
    std::string text = good;
    for (int k = 0; k <= n % 3; ++k) mutate(text, "0123456789.,-=\"():GXYZIJMNRLAST\n ;", rng);
    run_text(text);
  }
}

/// Ways and feeds of both, but for the columns.
void expect_same_moves(const Ran& have, const Ran& want) {
  ASSERT_FALSE(have.diagnostics.has_errors()) << all_text(have.diagnostics);
  ASSERT_EQ(have.moves.size(), want.moves.size());
  for (size_t n = 0; n < have.moves.size(); ++n) {
    EXPECT_LT((have.moves[n].to.tip_W - want.moves[n].to.tip_W).norm(), 1e-9) << n;
    EXPECT_EQ(have.moves[n].rapid, want.moves[n].rapid);
    EXPECT_NEAR(have.moves[n].feed_mm_s, want.moves[n].feed_mm_s, 1e-9);
  }
}

TEST(SiemensContour, OlderPocketsAreTheNewerOnesRoughedAndTheirWalls) {
  // Roughing alone: POCKET3 and POCKET4 straight in, rings of .8 of the tool.
  expect_same_moves(contour_ran("POCKET1(5,0,.5,-17.5,,60,40,8,1,2,30,120,300,4,2,.75,1)", ""),
                    contour_ran("POCKET3(5,0,.5,-17.5,60,40,8,1,2,30,4,.75,0,300,120,2,11,0)", ""));
  expect_same_moves(contour_ran("POCKET2(3,0,.5,-20,,25,4,-7,200,100,6,3,0,0)", ""),
                    contour_ran("POCKET4(3,0,.5,-20,25,4,-7,6,0,0,100,200,3,11,0)", ""));
  // All of it: then the walls with MIDF, FFP2, SSF.
  const Ran all = contour_ran("POCKET1(5,0,1,-9,,50,30,6,0,0,0,200,800,5,3,.5,0,3,600,5000)", "");
  expect_same_moves(all, contour_ran("POCKET3(5,0,1,-9,50,30,6,0,0,0,5,.5,0,800,200,3,11,0)\n"
                                     "POCKET3(5,0,1,-9,50,30,6,0,0,0,3,.5,0,600,200,3,4,0)",
                                     ""));
  EXPECT_EQ(all.moves[all.moves.size() - 3].spindle_rpm, 5000.0);
  EXPECT_EQ(all.moves.back().spindle_rpm, 2000.0);
  for (const char* bad : {"POCKET1(5,0,1,-9,9,50,30,6,0,0,0,200,800,5,3,.5,0)",   // depth twice
                          "POCKET1(5,0,1,-9,,50,30,6,0,0,0,200,800,5,1,.5,0)",    // direction
                          "POCKET2(5,0,1,-9,,4,0,0,200,800,5,3,.5,0)",            // too narrow
                          "POCKET2(5,0,1,-9,,25,0,0,200,800,5,3,.5,3)",           // VARI
                          "POCKET2(5,0,1,-9,,25,0,0,200,800,5,3,.5,0,1,2,3,4)"})  // arguments
    EXPECT_TRUE(contour_ran(bad, "").diagnostics.has_errors()) << bad;
}

}  // namespace
}  // namespace swarf::program::nc::siemens
