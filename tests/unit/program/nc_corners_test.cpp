// Corners that a word rounds or cuts: the same piece of contour from 840D's words and from ,R ,C of Fanuc and
// what is derived from it. Places by hand.
#include <cmath>

#include "unit/program/nc_support.h"

namespace swarf::program {
namespace {

const double kRoot2 = std::sqrt(2.0);

/// A contour in the plane at Z0 from 0, 0: its blocks, with the corner's words behind the first.
struct Words {
  Dialect dialect;
  const char *round, *legs;  ///< of 2 mm and of 1 mm
};
constexpr Words kAll[] = {{Dialect::kSiemens, "RND=2", "CHR=1"},
                          {Dialect::kFanuc, ",R2.", ",C1."},
                          {Dialect::kHaas, ",R2.", ", C1."},
                          {Dialect::kMazak, ",r2.", ",C1."}};

NcRun contour(Dialect dialect, const std::string& first, const std::string& rest) {
  return run_text("G21 G90 G17 G94\nG0 X0. Y0. Z0.\n" + first + "\n" + rest + "\nM30\n", dialect,
                  three_axis_setup());
}
NcRun siemens(const std::string& blocks) {
  return run_text("G71 G90 G17 G94\nG0 X0 Y0 Z0\n" + blocks + "M30\n", Dialect::kSiemens, three_axis_setup());
}
NcRun turned(const Words& words, const std::string& corner, const std::string& rest) {
  NcRun run = contour(words.dialect, "G1 X10. F100. " + corner, rest);
  if (words.dialect == Dialect::kSiemens) run = siemens("G1 X10 F100 " + corner + "\n" + rest + "\n");
  EXPECT_EQ(run.first_error(), "") << run.text();
  return run;
}

/// Moves of feed; the rapid at the head is of no length.
std::vector<NcMove> feeds(const NcRun& run) {
  std::vector<NcMove> found;
  for (const NcMove& move : run.moves())
    if (!move.rapid) found.push_back(move);
  return found;
}

void expect_arc(const NcMove& move, double x, double y, double normal_z) {
  ASSERT_TRUE(move.arc.has_value());
  EXPECT_NEAR(move.arc->centre_W.x(), x, 1e-9);
  EXPECT_NEAR(move.arc->centre_W.y(), y, 1e-9);
  EXPECT_NEAR(move.arc->normal_W.z(), normal_z, 1e-12);
}

TEST(Corners, RoundARightAngle) {
  for (const Words& words : kAll) {
    const std::vector<NcMove> moves = feeds(turned(words, words.round, "Y10."));
    ASSERT_EQ(moves.size(), 3u);
    expect_tip(moves[0], 8, 0, 0);
    expect_tip(moves[1], 10, 2, 0);
    expect_arc(moves[1], 8, 2, 1);
    expect_tip(moves[2], 10, 10, 0);
    EXPECT_EQ(moves[1].line, 3) << "the block that asks for it";
  }
}

TEST(Corners, RoundToTheRightTurnsTheOtherWay) {
  for (const Words& words : kAll) {
    const std::vector<NcMove> moves = feeds(turned(words, words.round, "Y-10."));
    ASSERT_EQ(moves.size(), 3u);
    expect_tip(moves[1], 10, -2, 0);
    expect_arc(moves[1], 8, -2, -1);
  }
}

TEST(Corners, CutARightAngle) {
  for (const Words& words : kAll) {
    const std::vector<NcMove> moves = feeds(turned(words, words.legs, "Y10."));
    ASSERT_EQ(moves.size(), 3u);
    expect_tip(moves[0], 9, 0, 0);
    expect_tip(moves[1], 10, 1, 0);
    EXPECT_FALSE(moves[1].arc.has_value());
    expect_tip(moves[2], 10, 10, 0);
  }
}

/// An angle of 135 degrees between the pieces: the way turns by 45; a circle of radius 2 touches them
/// 2 tan 22.5 = 2 (root 2 - 1) from the corner.
TEST(Corners, RoundAndCutAnObtuseAngle) {
  const double t = 2.0 * (kRoot2 - 1.0);
  for (const Words& words : kAll) {
    const std::vector<NcMove> round = feeds(turned(words, words.round, "X20. Y10."));
    ASSERT_EQ(round.size(), 3u);
    expect_tip(round[0], 10 - t, 0, 0);
    expect_tip(round[1], 10 + t / kRoot2, t / kRoot2, 0);
    expect_arc(round[1], 10 - t, 2, 1);
    const std::vector<NcMove> cut = feeds(turned(words, words.legs, "X20. Y10."));
    ASSERT_EQ(cut.size(), 3u);
    expect_tip(cut[0], 9, 0, 0);
    expect_tip(cut[1], 10 + 1 / kRoot2, 1 / kRoot2, 0);
  }
}

/// CHF is the length of the cut itself: 1.5 / (2 cos 22.5) off each piece, 1.5 / root 2 at a right angle.
TEST(Corners, ChfIsTheLengthOfTheCut) {
  const std::vector<NcMove> right = feeds(siemens("G1 X10 F100 CHF=1.5\nY10\n"));
  ASSERT_EQ(right.size(), 3u);
  expect_tip(right[0], 10 - 1.5 / kRoot2, 0, 0);
  expect_tip(right[1], 10, 1.5 / kRoot2, 0);
  const std::vector<NcMove> wide = feeds(siemens("G1 X10 F100 CHF=1.5\nX20 Y10\n"));
  ASSERT_EQ(wide.size(), 3u);
  EXPECT_NEAR((wide[1].to.tip_W - wide[0].to.tip_W).norm(), 1.5, 1e-12);
  expect_tip(wide[0], 10 - 0.75 / std::cos(rad_from_deg(22.5)), 0, 0);
}

/// From a line onto a clockwise circle of radius 10 about 20, 0, which starts upwards: the centre of the
/// rounding is 2 above the line and 12 from the circle's.
TEST(Corners, RoundALineAndAnArc) {
  const double x = 20.0 - std::sqrt(140.0);
  for (const Words& words : kAll) {
    const std::vector<NcMove> moves = feeds(turned(words, words.round, "G2 X20. Y10. I10. J0."));
    ASSERT_EQ(moves.size(), 3u);
    expect_tip(moves[0], x, 0, 0);
    expect_arc(moves[1], x, 2, 1);
    expect_tip(moves[1], 20 + (x - 20) * 10 / 12, 2.0 * 10 / 12, 0);
    expect_tip(moves[2], 20, 10, 0);
    expect_arc(moves[2], 20, 0, -1);
  }
}

/// Between two arcs of radius 10, both to the left, which meet at a right angle: the rounding touches both
/// from within, its centre is 9 from either, and the ways go on in the direction in which they end.
TEST(Corners, RoundTwoArcs) {
  for (const char* how : {"G3 X10 Y10 I0 J10 F100 RND=1\nX0 Y0 I0 J-10\n",
                          "RNDM=1\nG3 X10 Y10 I0 J10 F100\nX0 Y0 I0 J-10\nRNDM=0\n"}) {
    const std::vector<NcMove> moves = feeds(siemens(how));
    ASSERT_EQ(moves.size(), 3u);
    ASSERT_TRUE(moves[0].arc && moves[1].arc && moves[2].arc);
    const Vec3 c = moves[1].arc->centre_W;
    EXPECT_NEAR((c - Vec3(0, 10, 0)).norm(), 9.0, 1e-9);
    EXPECT_NEAR((c - Vec3(0, 10, 0)).norm(), (c - moves[2].arc->centre_W).norm(), 1e-9);
    EXPECT_NEAR((moves[0].to.tip_W - c).norm(), 1.0, 1e-9);
    EXPECT_NEAR((moves[1].to.tip_W - c).norm(), 1.0, 1e-9);
    for (size_t n = 0; n < 2; ++n) {
      const auto along = [](const NcMove& move, const Vec3& at) {
        return move.arc->normal_W.cross(at - move.arc->centre_W).normalized();
      };
      const Vec3 at = moves[n].to.tip_W;
      EXPECT_LT((along(moves[n], at) - along(moves[n + 1], at)).norm(), 1e-9);
    }
  }
}

TEST(Corners, WaitAcrossBlocksWithoutAMove) {
  for (const Words& words : kAll) {
    const std::vector<NcMove> moves = feeds(turned(words, words.round, "M8\nY10."));
    ASSERT_EQ(moves.size(), 3u);
    expect_tip(moves[1], 10, 2, 0);
  }
}

TEST(Corners, FollowOneAnother) {
  for (const Words& words : kAll) {
    const std::string corner = words.round;
    const std::vector<NcMove> moves =
        feeds(turned(words, corner, "Y10. " + corner + "\nX0. " + words.legs + "\nY0."));
    ASSERT_EQ(moves.size(), 7u);
    expect_tip(moves[2], 10, 8, 0);
    expect_tip(moves[3], 8, 10, 0);
    expect_tip(moves[4], 1, 10, 0);
    expect_tip(moves[5], 0, 9, 0);
    expect_tip(moves[6], 0, 0, 0);
  }
}

TEST(Corners, TakeAWholePieceBetweenThem) {
  const std::vector<NcMove> moves = feeds(siemens("G1 X10 F100 RND=2\nY4 RND=2\nX0\n"));
  ASSERT_EQ(moves.size(), 4u);
  expect_tip(moves[1], 10, 2, 0);
  expect_tip(moves[2], 8, 4, 0);
  expect_arc(moves[2], 8, 2, 1);
}

TEST(Corners, CutterCompensationGoesAboutWhatTheyMake) {
  ControlSetup setup = three_axis_setup();
  setup.tools = {{1, "D2", 0.0, 2.0, 0.0}};
  setup.start_tool = 0;
  const NcRun run =
      run_text("G71 G90 G17 G94 D1\nG0 X-5 Y-5 Z0\nG1 G41 X0 Y0 F100\nX10 RND=3\nY10\nX9\nG40 X20 Y20\nM30\n",
               Dialect::kSiemens, setup);
  ASSERT_EQ(run.first_error(), "") << run.text();
  bool inside = false;  // left of the way, in the bend: radius 3 - 1 about 7, 3
  for (const NcMove& move : run.moves()) {
    if (!move.arc || (move.arc->centre_W - Vec3(7, 3, 0)).norm() > 1e-9) continue;
    inside = true;
    EXPECT_NEAR((move.to.tip_W - move.arc->centre_W).norm(), 2.0, 1e-9);
  }
  EXPECT_TRUE(inside);
}

TEST(Corners, RndmRoundsEachCornerUntilItIsZero) {
  const std::vector<NcMove> moves =
      feeds(siemens("G1 X10 F100 RNDM=2\nY10\nX20 Y10\nX20 Y20 RNDM=0\nX0\nG0 Z10\n"));
  // 10,0 rounded; 10,10 rounded; 20,10 rounded; 20,20 not: RNDM=0 stands in its block.
  ASSERT_EQ(moves.size(), 8u);
  expect_tip(moves[1], 10, 2, 0);
  expect_tip(moves[3], 12, 10, 0);
  expect_tip(moves[5], 20, 12, 0);
  expect_tip(moves[6], 20, 20, 0);
}

TEST(Corners, RndmLeavesWhatIsNoCornerAlone) {
  const NcRun run = siemens("RNDM=2\nG1 X10 F100\nX20\nG0 Z5\nG1 X30 F100\nZ0\nY10\nM30\n");
  EXPECT_EQ(run.first_error(), "") << run.text();
  EXPECT_EQ(feeds(run).size(), 5u);
  for (const NcMove& move : run.moves()) EXPECT_FALSE(move.arc.has_value());
}

TEST(Corners, CurvesHaveNone) {
  const NcRun run = siemens("RNDM=2\nG1 X10 F100\nPOLY PO[X]=(20,1) PO[Y]=(5,2)\nG1 Y20\n");
  EXPECT_EQ(run.first_error(), "") << run.text();
  for (const NcMove& move : run.moves()) EXPECT_FALSE(move.arc.has_value());
  EXPECT_EQ(siemens("G1 X10 F100 RND=2\nPOLY PO[X]=(20,1) PO[Y]=(5,2)\n").first_error(), "bad-corner 3:13");
  EXPECT_EQ(siemens("G1 X10 F100\nPOLY PO[X]=(20,1) PO[Y]=(5,2) RND=2\nG1 Y9\n").first_error(),
            "bad-corner 4:31");
}

TEST(Corners, FeedIsThatOfTheBlockBehindOrFrc) {
  const auto feed = [](const std::string& blocks) { return feeds(siemens(blocks))[1].feed_mm_s * 60.0; };
  EXPECT_NEAR(feed("G1 X10 F100 RND=2\nY10 F300\n"), 300.0, 1e-9);
  EXPECT_NEAR(feed("G1 X10 F100 RND=2 FRC=50\nY10 F300\n"), 50.0, 1e-9);
  EXPECT_NEAR(feed("FRCM=70\nG1 X10 F100 CHR=2\nY10 F300\n"), 70.0, 1e-9);
  const NcRun fanuc = contour(Dialect::kFanuc, "G1 X10. F100. ,R2.", "Y10. F300.");
  EXPECT_NEAR(feeds(fanuc)[1].feed_mm_s * 60.0, 100.0, 1e-9);
}

/// Half a degree is no corner to Fanuc; 840D rounds it.
TEST(Corners, NearlyStraightIsNoneToFanuc) {
  const std::string rest = "X20. Y0.05";
  EXPECT_EQ(feeds(contour(Dialect::kFanuc, "G1 X10. F100. ,R2.", rest)).size(), 2u);
  EXPECT_EQ(feeds(siemens("G1 X10 F100 RND=2\nX20 Y0.05\n")).size(), 3u);
  EXPECT_EQ(feeds(siemens("G1 X10 F100 RND=2\nX20\n")).size(), 2u) << "straight on";
}

TEST(Corners, MirrorImagesAndScalesHoldForThem) {
  const std::vector<NcMove> moves =
      feeds(siemens("MIRROR X0\nSCALE X1\nMIRROR X0\nG1 X10 F100 RND=2\nY10\n"));
  ASSERT_EQ(moves.size(), 3u);
  expect_tip(moves[0], -8, 0, 0);
  expect_arc(moves[1], -8, 2, -1);
  const NcRun scaled =
      contour(Dialect::kFanuc, "G51 X0. Y0. Z0. I2. J2. K2.\nG1 X10. F100. ,R2.", "Y10.\nG50");
  ASSERT_EQ(feeds(scaled).size(), 3u) << scaled.text();
  expect_tip(feeds(scaled)[0], 16, 0, 0);
  expect_arc(feeds(scaled)[1], 16, 4, 1);
}

TEST(Corners, InOtherPlanes) {
  const NcRun run = siemens("G18 G1 Z10 F100 RND=2\nX10\n");
  const std::vector<NcMove> moves = feeds(run);
  ASSERT_EQ(moves.size(), 3u) << run.text();
  expect_tip(moves[0], 0, 0, 8);
  expect_tip(moves[1], 2, 0, 10);
}

TEST(Corners, WhereNoneCanBeTheirWordIsNamed) {
  EXPECT_EQ(siemens("G1 X10 F100 RND=12\nY30\n").first_error(), "bad-corner 3:13");
  EXPECT_EQ(siemens("G1 X10 F100 RND=2\nG0 Y30\n").first_error(), "bad-corner 3:13");
  EXPECT_EQ(siemens("G1 X10 F100 RND=2\nZ30\n").first_error(), "bad-corner 3:13");
  EXPECT_EQ(siemens("G1 X10 F100 RND=2\n").first_error(), "bad-corner 3:13");
  EXPECT_EQ(siemens("G1 X10 F100 RND=2\nG18\nX20\n").first_error(), "bad-corner 3:13");
  EXPECT_EQ(siemens("G1 X10 F100 CHR=2\nG2 X20 Y10 I10 J0\n").first_error(), "bad-corner 3:13");
  EXPECT_EQ(siemens("G0 X10 RND=2\nG1 Y30 F100\n").first_error(), "bad-corner 3:8");
  EXPECT_EQ(siemens("G1 Z10 F100 RND=2\nX30\n").first_error(), "bad-corner 3:13");
  EXPECT_EQ(siemens("RND=2\n").first_error(), "bad-corner 3:1");
  EXPECT_EQ(siemens("G1 X10 F100 RND=2 CHR=1\nY10\n").first_error(), "words-conflict 3:19");
  EXPECT_EQ(siemens("G1 X10 F100 RND=-2\nY10\n").first_error(), "out-of-range 3:13");
  const auto fanuc = [](const std::string& first, const std::string& rest) {
    return contour(Dialect::kFanuc, first, rest).first_error();
  };
  EXPECT_EQ(fanuc("G1 X10. F100. ,R12.", "Y30."), "bad-corner 3:15");
  EXPECT_EQ(fanuc("G1 X10. F100. ,R2.", "G0 Y30."), "bad-corner 3:15");
  EXPECT_EQ(fanuc("G0 X10. ,C2.", "G1 Y30. F100."), "bad-corner 3:9");
  EXPECT_EQ(fanuc("G1 F100. ,C2.", "X10."), "bad-corner 3:10");
  EXPECT_EQ(fanuc("G1 X10. F100. ,A45.", "Y30."), "unsupported-word 3:15");
  EXPECT_EQ(fanuc("G1 X10. F100. ,R2. ,C1.", "Y30."), "word-twice 3:20");
  EXPECT_EQ(fanuc("G1 X10. F100. ,Q2.", "Y30."), "unexpected-character 3:15");
  EXPECT_EQ(contour(Dialect::kLinuxCnc, "G1 X10. F100. ,R2.", "Y30.").first_error(),
            "unexpected-character 3:15");
}

TEST(Ang, OneCoordinateAndTheAngleGiveTheOther) {
  const std::vector<NcMove> moves =
      feeds(siemens("G1 X10 ANG=45 F100\nY20 ANG=90\nX0 ANG=180\nX-10 ANG=180+30\nG91 X10 ANG=-45\n"));
  ASSERT_EQ(moves.size(), 5u);
  expect_tip(moves[0], 10, 10, 0);
  expect_tip(moves[1], 10, 20, 0);
  expect_tip(moves[2], 0, 20, 0);
  expect_tip(moves[3], -10, 20 - 10 / std::sqrt(3.0), 0);
  expect_tip(moves[4], 0, 10 - 10 / std::sqrt(3.0), 0);
}

TEST(Ang, CountsFromThePlanesFirstAxis) {
  const std::vector<NcMove> moves = feeds(siemens("G18 G1 Z10 ANG=30 F100\n"));
  ASSERT_EQ(moves.size(), 1u);
  expect_tip(moves[0], 10 / std::sqrt(3.0), 0, 10);
}

TEST(Ang, WithACorner) {
  const std::vector<NcMove> moves = feeds(siemens("G1 X10 F100 RND=2\nX20 ANG=45\n"));
  ASSERT_EQ(moves.size(), 3u);
  expect_tip(moves[2], 20, 10, 0);
}

TEST(Ang, TwoLinesByTheirAnglesMeetWhereTheyCross) {
  const std::vector<NcMove> moves = feeds(siemens("G1 ANG=45 F100\nX20 Y0 ANG=-45 F300\n"));
  ASSERT_EQ(moves.size(), 2u);
  expect_tip(moves[0], 10, 10, 0);
  expect_tip(moves[1], 20, 0, 0);
  EXPECT_NEAR(moves[0].feed_mm_s * 60.0, 100.0, 1e-9);  // each with the words of its own block
  EXPECT_NEAR(moves[1].feed_mm_s * 60.0, 300.0, 1e-9);
  EXPECT_EQ(moves[0].line + 1, moves[1].line);
  // A corner between them: root 2 - 1 of the radius from the point where they cross.
  const std::vector<NcMove> round = feeds(siemens("G1 ANG=45 RND=2 F100\nX20 Y0 ANG=-45\n"));
  ASSERT_EQ(round.size(), 3u);
  expect_tip(round[0], 10 - std::sqrt(2.0), 10 - std::sqrt(2.0), 0);
  expect_tip(round[1], 10 + std::sqrt(2.0), 10 - std::sqrt(2.0), 0);
  // In G18, and with a mirrored axis.
  expect_tip(feeds(siemens("G18 G1 ANG=45 F100\nZ20 X0 ANG=-45\n"))[0], 10, 0, 10);
  expect_tip(feeds(siemens("MIRROR X0\nG1 ANG=45 F100\nX20 Y0 ANG=-45\n"))[0], -10, 10, 0);
}

TEST(Ang, ALineThatWaitsIsNotLost) {
  for (const char* next : {"X20 Y0", "X20 ANG=-45", "G91 X20 Y0 ANG=-45", "G0 X20 Y0 ANG=-45", "T1", "G4 F1",
                           "M30", "G2 X20 Y0 CR=30 ANG=10", "TRANS X5", "G55", ""})
    EXPECT_EQ(siemens(std::string("G1 ANG=45 F100\n") + next + "\n").first_error(), "line-without-end 3:4")
        << next;
  EXPECT_EQ(siemens("G1 ANG=45 F100\nX20 Y0 ANG=45\n").first_error(), "out-of-range 4:8");   // parallel
  EXPECT_EQ(siemens("G1 ANG=45 F100\nX20 Y0 ANG=135\n").first_error(), "out-of-range 4:8");  // behind it
  EXPECT_EQ(siemens("G0 ANG=45\nX20 Y0 ANG=-45\n").first_error(), "words-conflict 3:4");
}

TEST(Ang, WhatHasNoEndIsRefused) {
  EXPECT_EQ(siemens("G1 X10 ANG=90 F100\n").first_error(), "out-of-range 3:8");
  EXPECT_EQ(siemens("G1 X10 ANG=180 F100\n").first_error(), "out-of-range 3:8");
  EXPECT_EQ(siemens("G1 X10 Y10 ANG=45 F100\n").first_error(), "unsupported-word 3:12");
  EXPECT_EQ(siemens("G2 X10 ANG=45 I5 J0 F100\n").first_error(), "words-conflict 3:8");
}

}  // namespace
}  // namespace swarf::program
