// CUTCOM against contours moved aside by hand, and against distances.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/rng.h"
#include "program/cl/writer.h"
#include "unit/program/cl_support.h"

namespace swarf::program::cl_cutcom_test {
namespace {

ClOptions with(ClPoints points) {
  ClOptions options = as_nx();
  options.cutcom = points;
  return options;
}

void expect_tips(const ClProgram& p, const std::vector<Vec3>& tips) {
  ASSERT_EQ(p.moves.size(), tips.size());
  for (size_t i = 0; i < tips.size(); ++i) {
    expect_tip(p.moves[i].to.tip_W, tips[i].x(), tips[i].y(), tips[i].z());
    if (i > 0) expect_tip(p.moves[i].from.tip_W, tips[i - 1].x(), tips[i - 1].y(), tips[i - 1].z());
  }
}

// A cutter of 8 mm round a square of 30 mm, on its right: 4 mm outside, arcs about the corners.
TEST(ClCutcom, SquareFromOutside) {
  const ClProgram p = read_cl_clean(
      "CUTTER/8\nFEDRAT/600,MMPM\nGOTO/-20,0,2\nCUTCOM/RIGHT,1\nGOTO/0,0,2\nGOTO/30,0,2\nGOTO/30,30,2\n"
      "GOTO/0,30,2\nGOTO/0,-10,2\nCUTCOM/OFF\nGOTO/-20,-10,2\nGOTO/-20,-20,2\n",
      with(ClPoints::kContour));
  expect_tips(p, {{0, -4, 2},
                  {30, -4, 2},
                  {34, 0, 2},
                  {34, 30, 2},
                  {30, 34, 2},
                  {0, 34, 2},
                  {-4, 30, 2},
                  {-4, -10, 2},
                  {-20, -10, 2},
                  {-20, -20, 2}});
  ASSERT_TRUE(p.moves[2].arc);
  EXPECT_EQ(p.moves[2].arc->centre_W, Vec3(30, 0, 2));
  EXPECT_EQ(p.moves[2].arc->normal_W, Vec3(0, 0, 1));
  EXPECT_DOUBLE_EQ(p.moves[2].feed_mm_s, 10.0);
  EXPECT_EQ(p.moves[1].line, 6) << "the move of the programmed block";
  ASSERT_EQ(p.remarks.size(), 1U);
  EXPECT_NE(p.remarks[0].find("radius 4 mm"), std::string::npos);
}

TEST(ClCutcom, SquareFromInsideCutsItsCorners) {
  const ClProgram p = read_cl_clean(
      "CUTTER/8\nFEDRAT/600\nGOTO/15,15,0\nCUTCOM/LEFT\nGOTO/15,0,0\nGOTO/30,0,0\nGOTO/30,30,0\nGOTO/0,30,0\n"
      "GOTO/0,0,0\nGOTO/15,0,0\nCUTCOM/OFF\nGOTO/15,15,0\n",
      with(ClPoints::kContour));
  expect_tips(p, {{15, 4, 0}, {26, 4, 0}, {26, 26, 0}, {4, 26, 0}, {4, 4, 0}, {15, 4, 0}, {15, 15, 0}});
}

TEST(ClCutcom, CirclesKeepTheirCentre) {
  for (const bool inside : {true, false}) {
    // NX's vector (0,0,-1): counter-clockwise; left of it is inside.
    const ClProgram p = read_cl_clean(
        std::string("CUTTER/8\nFEDRAT/600\nGOTO/20,-30,0\nCUTCOM/") + (inside ? "LEFT" : "RIGHT") +
            "\nGOTO/20,0,0\nCIRCLE/0,0,0,0,0,-1,20\nGOTO/20,0,0\nGOTO/20,30,0\nCUTCOM/OFF\nGOTO/20,60,0\n",
        with(ClPoints::kContour));
    ASSERT_GE(p.moves.size(), 3U);
    const double r = inside ? 16.0 : 24.0;
    expect_tip(p.moves[1].from.tip_W, r, 0, 0);
    ASSERT_TRUE(p.moves[1].arc);
    expect_tip(p.moves[1].arc->centre_W, 0, 0, 0);
    expect_tip(p.moves[1].to.tip_W, r, 0, 0);
  }
}

TEST(ClCutcom, InTheOtherPlanesAndSystems) {
  // YZ seen from +X: along +Y, LEFT is +Z. ZX seen from +Y: along +Z, LEFT is +X.
  const ClProgram yz = read_cl_clean(
      "CUTTER/6\nMULTAX/ON\nFEDRAT/60\nGOTO/0,-20,0,1,0,0\nCUTCOM/LEFT,2,YZPLAN\nGOTO/0,0,0\nGOTO/0,9,0\n"
      "CUTCOM/OFF\nGOTO/0,30,0\n",
      with(ClPoints::kContour));
  expect_tips(yz, {{0, 0, 3}, {0, 9, 3}, {0, 30, 0}});
  const ClProgram zx = read_cl_clean(
      "CUTTER/6\nMULTAX/ON\nFEDRAT/60\nGOTO/0,0,-20,0,1,0\nCUTCOM/LEFT,ZXPLAN\nGOTO/0,0,0\nGOTO/0,0,9\n"
      "CUTCOM/OFF\nGOTO/0,0,30\n",
      with(ClPoints::kContour));
  expect_tips(zx, {{3, 0, 0}, {3, 0, 9}, {0, 0, 30}});
  // XY of a system whose X runs along Y and whose Y runs along Z.
  const ClProgram system = read_cl_clean(
      "CUTTER/6\nMSYS/10,20,30, 0,1,0, 0,0,1\nFEDRAT/60\nGOTO/-20,0,0,0,0,1\nCUTCOM/LEFT\nGOTO/0,0,0\n"
      "GOTO/9,0,0\nCUTCOM/OFF\nGOTO/30,0,0\n",
      with(ClPoints::kContour));
  expect_tips(system, {{10, 20, 33}, {10, 29, 33}, {10, 50, 30}});
}

TEST(ClCutcom, TheCentreStaysWhereItIs) {
  const std::string text =
      "$$ SWARF CL DATA\nCUTTER/8\nFEDRAT/600\nGOTO/-20,0,0\nCUTCOM/LEFT,3,XYPLAN\nGOTO/0,0,0\nGOTO/5,0,0\n"
      "CUTCOM/OFF\nGOTO/9,9,0\n";
  const ClProgram p = read_cl_clean(text, with(ClPoints::kCentre));
  expect_tips(p, {{0, 0, 0}, {5, 0, 0}, {9, 9, 0}});
  ASSERT_EQ(p.remarks.size(), 1U);
  EXPECT_NE(p.remarks[0].find("wear"), std::string::npos);
  const std::string written = write_cl(p);
  EXPECT_NE(written.find("CUTCOM/LEFT,3,XYPLAN\nFEDRAT/MMPM,600\nGOTO/0,0,0"), std::string::npos) << written;
  EXPECT_EQ(first_place(written), "cutcom-meaning 6:1") << written;
  const ClProgram again = read_cl_clean(written, with(ClPoints::kCentre));
  ASSERT_EQ(again.moves.size(), p.moves.size());
  for (size_t i = 0; i < p.moves.size(); ++i) EXPECT_EQ(again.moves[i].to.tip_W, p.moves[i].to.tip_W);
}

TEST(ClCutcom, OnSwitchesTheLastSideOnAgain) {
  const ClProgram p = read_cl_clean(
      "CUTTER/6\nFEDRAT/60\nGOTO/-20,0,0\nCUTCOM/LEFT\nGOTO/0,0,0\nGOTO/9,0,0\nCUTCOM/OFF\nGOTO/30,0,0\n"
      "CUTCOM/ON\nGOTO/60,0,0\nGOTO/70,0,0\nCUTCOM/OFF\nGOTO/90,0,0\n",
      with(ClPoints::kContour));
  expect_tips(p, {{0, 3, 0}, {9, 3, 0}, {30, 0, 0}, {60, 3, 0}, {70, 3, 0}, {90, 0, 0}});
}

TEST(ClCutcom, TheSceneKnowsTheRadius) {
  ClOptions options = with(ClPoints::kContour);
  options.tools = {{7, "", 2.5}, {8, "", 4.0}};
  const ClProgram p = read_cl_clean(
      "LOADTL/8\nFEDRAT/60\nGOTO/-20,0,0\nCUTCOM/LEFT\nGOTO/0,0,0\nGOTO/9,0,0\nCUTCOM/OFF\nGOTO/30,0,0\n",
      options);
  expect_tip(p.moves[0].to.tip_W, 0, 4, 0);
  EXPECT_EQ(first_place("LOADTL/9\nFEDRAT/60\nGOTO/-20,0,0\nCUTCOM/LEFT\nGOTO/0,0,0\n", options),
            "compensation-no-tool 4:1");
}

/// Distance of a point from a segment.
double distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double s = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - s * (b - a)).norm();
}

TEST(ClCutcom, ConvexContoursAreRoundedAtTheRadius) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    Rng rng(seed);
    const int sides = 3 + static_cast<int>(rng.next() % 6);
    const double r = rng.uniform(0.5, 12.0), size = rng.uniform(10.0, 60.0);
    std::vector<double> angles;
    for (int i = 0; i < sides; ++i)
      angles.push_back(2.0 * std::numbers::pi * (i + rng.uniform(0.1, 0.9)) / sides);
    std::vector<Vec3> corners;
    for (const double a : angles) corners.emplace_back(size * std::cos(a), size * std::sin(a), 0.0);
    std::string text = "CUTTER/" + std::to_string(2.0 * r) + "\nFEDRAT/600\n";
    const auto go = [&](const Vec3& p) {
      char line[120];
      std::snprintf(line, sizeof line, "GOTO/%.17g,%.17g,0\n", p.x(), p.y());
      text += line;
    };
    const Vec3 ahead = (corners[1] - corners[0]).normalized();
    go(corners[0] - 40.0 * ahead);
    text += "CUTCOM/RIGHT\n";
    for (const Vec3& corner : corners) go(corner);
    go(corners[0]);
    text += "CUTCOM/OFF\n";
    const Vec3 back = (corners[0] - corners.back()).normalized();
    go(corners[0] + 40.0 * back);
    const ClProgram p = read_cl_clean(text, with(ClPoints::kContour));
    ASSERT_GE(p.moves.size(), static_cast<size_t>(sides));
    for (size_t i = 1; i + 1 < p.moves.size(); ++i) {
      const Move& move = p.moves[i];
      for (const double share : {0.0, 0.3, 0.5, 0.8, 1.0}) {
        Vec3 tip = move.from.tip_W + share * (move.to.tip_W - move.from.tip_W);
        if (move.arc) tip = move.arc->centre_W + r * (tip - move.arc->centre_W).normalized();
        double least = 1e9;
        for (size_t k = 0; k < corners.size(); ++k)
          least = std::min(least, distance(tip, corners[k], corners[(k + 1) % corners.size()]));
        ASSERT_NEAR(least, std::stod(text.substr(7)) / 2.0, 1e-6) << "seed " << seed << ":\n" << text;
      }
    }
  }
}

}  // namespace
}  // namespace swarf::program::cl_cutcom_test
