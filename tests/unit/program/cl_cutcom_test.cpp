// CUTCOM against contours moved aside by hand, and against distances; TRACUT against positions turned by
// hand.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

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

// --- TRACUT: what its matrix does to positions, tool axes, arcs and holes, and what is refused.

ClOptions with_tracut(ClTracut meaning) {
  ClOptions options = as_nx();
  options.tracut = meaning;
  return options;
}

ClProgram applied(const std::string& text) {
  return read_cl_clean(text, with_tracut(ClTracut::kApply));
}

std::string fault_of(const std::string& text) {
  return first_place(text, with_tracut(ClTracut::kApply));
}

std::string fault_text(const std::string& text) {
  Diagnostics diagnostics;
  parse_cl(text, "test.cl", diagnostics, with_tracut(ClTracut::kApply));
  return all_text(diagnostics);
}

/// A quarter turn about Z and (100, 0, 5).
constexpr const char* kQuarter = "TRACUT/0,-1,0,100,1,0,0,0,0,0,1,5\n";
/// A quarter turn about X: Z goes to -Y.
constexpr const char* kTilt = "TRACUT/1,0,0,0,0,0,-1,0,0,1,0,0\n";
constexpr const char* kSquare = "GOTO/0,0,0\nGOTO/10,0,0\nGOTO/10,10,0\nGOTO/0,10,0\n";

TEST(ClTracut, TurnsASquareUntilNomore) {
  const ClProgram p =
      applied(std::string("FEDRAT/60\n") + kQuarter + kSquare + "TRACUT/NOMORE\nGOTO/1,2,3\nGODLTA/1,0,0\n");
  expect_tip(p.start.tip_W, 100, 0, 5);
  ASSERT_EQ(p.moves.size(), 5u);
  expect_tip(p.moves[0].to.tip_W, 100, 10, 5);
  expect_tip(p.moves[1].to.tip_W, 90, 10, 5);
  expect_tip(p.moves[2].to.tip_W, 90, 0, 5);
  expect_tip(p.moves[3].to.tip_W, 1, 2, 3);
  expect_tip(p.moves[4].to.tip_W, 2, 2, 3);
  EXPECT_EQ(p.moves[2].to.axis_W, Vec3(0, 0, 1));
  EXPECT_EQ(p.remarks.size(), 1u);
}

TEST(ClTracut, TurnsArcsAndToolAxes) {
  const ClProgram p = applied(std::string("FEDRAT/60\nMULTAX/ON\n") + kTilt +
                              "GOTO/10,0,4,0,0,1\nCIRCLE/0,0,4,0,0,-1,10\nGOTO/0,10,4\nGOTO/0,0,4,0.6,0,0.8\n"
                              "TRACUT/NOMORE\nTLAXIS/1,0,0\nGOTO/0,0,0\n");
  expect_tip(p.start.tip_W, 10, -4, 0);
  EXPECT_LT((p.start.axis_W - Vec3(0, -1, 0)).norm(), 1e-15);
  ASSERT_EQ(p.moves.size(), 3u);
  ASSERT_TRUE(p.moves[0].arc);
  expect_tip(p.moves[0].to.tip_W, 0, -4, 10);
  expect_tip(p.moves[0].arc->centre_W, 0, -4, 0);
  // Clockwise about (0,0,-1) in the file is counter-clockwise about (0,0,1), which goes to (0,-1,0).
  expect_tip(p.moves[0].arc->normal_W, 0, -1, 0);
  EXPECT_LT((p.moves[1].to.axis_W - Vec3(0.6, -0.8, 0)).norm(), 1e-15);
  EXPECT_EQ(p.moves[2].to.axis_W, Vec3(1, 0, 0));
}

/// The words of a path with arcs of both forms, a helix, holes, deltas and axes.
constexpr const char* kPath =
    "GOTO/10,0,0,0,0,1\nCIRCLE/0,0,0,0,0,-1,10\nGOTO/0,10,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/10,0,3\n"
    "MOVARC/0,0,3,0,0,1,10,ANGLE,90\nGOTO/0,10,3\nGODLTA/1,2,3\nGODLTA/1,2,3,0,0.6,0.8\nGOTO/5,6,7,0,0,1\n"
    "CYCLE/DRILL,DEPTH,5,MMPM,20,CLEAR,2\nGOTO/0,0,1\nGOTO/20,5,1,0,-0.6,0.8\nCYCLE/OFF\nGOTO/1,1,1,1,0,0\n";

/// What TRACUT makes of a path is the path read without it, moved by the same motion.
TEST(ClTracut, IsTheMotionOfTheWholePath) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const std::string head = "FEDRAT/60\nMULTAX/ON\n";
  const ClProgram plain = read_cl_clean(head + kPath);
  for (int i = 0; i < 50; ++i) {
    Pose X = Pose::Identity();
    X.linear() = Eigen::Quaterniond(number(random), number(random), number(random), number(random))
                     .normalized()
                     .toRotationMatrix();
    X.translation() = 100.0 * Vec3(number(random), number(random), number(random));
    std::string rows;
    for (int k = 0; k < 12; ++k) rows += fmt::format("{}{:.15f}", k > 0 ? "," : "", X.matrix()(k / 4, k % 4));
    const ClProgram turned = applied(head + "TRACUT/" + rows + "\n" + kPath);
    ASSERT_EQ(turned.moves.size(), plain.moves.size());
    EXPECT_LT((turned.start.tip_W - X * plain.start.tip_W).norm(), 1e-9);
    for (size_t k = 0; k < plain.moves.size(); ++k) {
      const Move &a = plain.moves[k], &b = turned.moves[k];
      EXPECT_LT((b.to.tip_W - X * a.to.tip_W).norm(), 1e-9) << k;
      EXPECT_LT((b.to.axis_W - X.linear() * a.to.axis_W).norm(), 1e-9) << k;
      ASSERT_EQ(b.arc.has_value(), a.arc.has_value()) << k;
      if (!a.arc) continue;
      EXPECT_LT((b.arc->centre_W - X * a.arc->centre_W).norm(), 1e-9) << k;
      EXPECT_LT((b.arc->normal_W - X.linear() * a.arc->normal_W).norm(), 1e-9) << k;
    }
  }
}

TEST(ClTracut, ShiftsInTheUnitOfTheFile) {
  const ClProgram p =
      applied("UNITS/INCHES\nFEDRAT/9\nTRACUT/1,0,0,1,0,1,0,0,0,0,1,-2\nGOTO/0,0,0\nGOTO/1,0,0\n");
  expect_tip(p.start.tip_W, 25.4, 0, -50.8);
  expect_tip(p.moves[0].to.tip_W, 50.8, 0, -50.8);
  EXPECT_EQ(fault_of("TRACUT/1,0,0,1,0,1,0,0,0,0,1,-2\nUNITS/INCHES\nGOTO/0,0,0\n"), "unsupported-word 2:1");
}

TEST(ClTracut, OriginAndTransActOnWhatItGives) {
  const ClProgram p =
      applied(std::string("ORIGIN/1,2,3\nFEDRAT/9\n") + kQuarter + "TRANS/0,0,50\nGOTO/10,0,0\nGOTO/0,0,0\n");
  expect_tip(p.start.tip_W, 99, 8, 52);
  expect_tip(p.moves[0].to.tip_W, 99, -2, 52);
}

/// The rotation goes into the machining system of MSYS: first the matrix, then the system.
TEST(ClTracut, StandsWithinTheSystem) {
  const ClProgram p =
      applied(std::string("MSYS/0,0,7,0,1,0,-1,0,0\nFEDRAT/9\n") + kQuarter + "GOTO/10,0,0\nGOTO/0,0,0\n");
  expect_tip(p.start.tip_W, -10, 100, 12);
  expect_tip(p.moves[0].to.tip_W, 0, 100, 12);
}

TEST(ClTracut, NeedsItsMeaningUnlessItDoesNothing) {
  const std::string turned = std::string("FEDRAT/9\n") + kQuarter + "GOTO/10,0,0\nGOTO/0,0,0\n";
  EXPECT_EQ(first_place(turned), "tracut-meaning 2:1");
  const ClProgram stands = read_cl_clean(turned, with_tracut(ClTracut::kApplied));
  expect_tip(stands.start.tip_W, 10, 0, 0);
  EXPECT_EQ(stands.remarks.size(), 1u);
  const ClProgram none = read_cl_clean(
      "FEDRAT/9\nTRACUT/1,0,0,0,0,1,0,0,0,0,1.000,0\nGOTO/1,2,3\nTRACUT/NOMORE\nTRACUT/LAST,NOMORE\nGOTO/"
      "0,0,0\n");
  expect_tip(none.start.tip_W, 1, 2, 3);
  EXPECT_EQ(first_place("TRACUT/1,0,0,1E-9,0,1,0,0,0,0,1,0\n"), "tracut-meaning 1:1");
  // What scales has been applied by whoever says so.
  read_cl_clean("FEDRAT/9\nTRACUT/LAST,2,0,0,0,0,2,0,0,0,0,2,0\nGOTO/1,2,3\nGOTO/2,2,2\n",
                with_tracut(ClTracut::kApplied));
}

TEST(ClTracut, RefusesOtherMatrices) {
  EXPECT_EQ(fault_of("GOTO/0,0,0\nTRACUT/1,0,0,0,0,1,0,0,0,0,1\n"), "wrong-arguments 2:1");
  EXPECT_EQ(fault_of("TRACUT/1,0,0,0,0,1,0,0,0,0,1,0,0\n"), "wrong-arguments 1:1");
  EXPECT_EQ(fault_of("TRACUT\n"), "wrong-arguments 1:1");
  EXPECT_EQ(fault_of("TRACUT/M1\n"), "wrong-arguments 1:8");
  EXPECT_EQ(fault_of("TRACUT/LAST,0,-1,0,0,1,0,0,0,0,0,1,0\n"), "bad-tracut 1:8");
  EXPECT_NE(fault_text("TRACUT/2,0,0,0,0,2,0,0,0,0,2,0\n").find("[bad-tracut]"), std::string::npos);
  EXPECT_NE(fault_text("TRACUT/2,0,0,0,0,2,0,0,0,0,2,0\n").find("determinant 8): it scales or skews"),
            std::string::npos);
  EXPECT_NE(fault_text("TRACUT/-1,0,0,0,0,1,0,0,0,0,1,0\n").find("determinant -1): it mirrors"),
            std::string::npos);
  EXPECT_EQ(fault_of("TRACUT/1,0.001,0,0,0,1,0,0,0,0,1,0\n"), "bad-tracut 1:1") << "a shear of determinant 1";
  EXPECT_EQ(fault_of("TRACUT/0,0,0,0,0,0,0,0,0,0,0,0\n"), "bad-tracut 1:1");
}

TEST(ClTracut, OneAfterTheOtherButNotWithin) {
  const std::string head = std::string("FEDRAT/9\n") + kQuarter + "GOTO/10,0,0\n";
  EXPECT_EQ(fault_of(head + kQuarter), "bad-tracut 4:1");
  EXPECT_EQ(fault_of(head + "TRACUT/1,0,0,0,0,1,0,0,0,0,1,0\n"), "bad-tracut 4:1");
  const ClProgram p = applied(head + "TRACUT/NOMORE\nTRACUT/0,-1,0,0,1,0,0,0,0,0,1,0\nGOTO/10,0,0\n");
  expect_tip(p.moves[0].to.tip_W, 0, 10, 0);
}

TEST(ClTracut, ATiltTakesTheToolAxisAway) {
  const std::string head = "FEDRAT/9\n";
  EXPECT_EQ(fault_of(head + kTilt + "GOTO/0,0,0\n"), "missing-axis 3:1");
  EXPECT_EQ(fault_of(head + "FROM/0,0,9\nMULTAX/ON\n" + kTilt + "GOTO/0,0,0\n"), "missing-axis 5:1");
  EXPECT_EQ(fault_of(head + "FROM/0,0,9\n" + kTilt + "MULTAX/ON\nGOTO/0,0,0\n"), "missing-axis 5:1");
  EXPECT_EQ(fault_of(head + "FROM/0,0,9\n" + kTilt + "MULTAX/OFF\nGOTO/0,0,0\n"), "missing-axis 5:1");
  EXPECT_EQ(fault_of(head + kTilt + "GOTO/0,0,0,0,0,1\nTRACUT/NOMORE\nGOTO/0,0,0\n"), "missing-axis 5:1");
  const ClProgram p =
      applied(head + kTilt + "GOTO/0,0,0,0,0,1\nGOTO/1,0,0\nTRACUT/NOMORE\nMULTAX/OFF\nGOTO/0,0,0\n");
  EXPECT_LT((p.moves[0].to.axis_W - Vec3(0, -1, 0)).norm(), 1e-15);
  EXPECT_EQ(p.moves[1].to.axis_W, Vec3(0, 0, 1));
}

TEST(ClTracut, RefusesWhatItWouldTearApart) {
  const std::string head = "FEDRAT/9\nGOTO/10,0,0\n";
  EXPECT_EQ(fault_of(head + "CIRCLE/0,0,0,0,0,1,10\n" + kQuarter), "bad-arc 4:1");
  EXPECT_EQ(fault_of(head + "CYCLE/DRILL,DEPTH,5,MMPM,20,CLEAR,2\n" + kQuarter), "bad-cycle 4:1");
  EXPECT_EQ(fault_of(head + kQuarter + "GODLTA/1,0,0\n"), "no-position 4:1");
  EXPECT_EQ(fault_of(head + kQuarter + "GOTO/0,0,0\nTRACUT/NOMORE\nGODLTA/1,0,0\n"), "no-position 6:1");
  EXPECT_EQ(fault_of(head + kQuarter + "CLEARP/XYPLAN,50\n"), "unsupported-word 4:1");
  ClOptions contour = with_tracut(ClTracut::kApply);
  contour.cutcom = ClPoints::kContour;
  EXPECT_EQ(
      first_place("CUTTER/10\nFEDRAT/9\nGOTO/0,-20,0\nCUTCOM/LEFT\nGOTO/0,0,0\n" + std::string(kQuarter),
                  contour),
      "compensation-active 6:1");
}

/// A contour that is compensated under TRACUT is the compensated contour, turned.
TEST(ClTracut, CompensatesInTheFilesPlane) {
  const std::string path =
      "GOTO/0,-20,0\nCUTCOM/LEFT,XYPLAN\nGOTO/0,0,0\nGOTO/0,50,0\nGOTO/50,50,0\nCUTCOM/OFF\nGOTO/60,40,0\n";
  ClOptions options = with_tracut(ClTracut::kApply);
  options.cutcom = ClPoints::kContour;
  const ClProgram plain = read_cl_clean("CUTTER/10\nFEDRAT/9\n" + path, options);
  const ClProgram turned = read_cl_clean("CUTTER/10\nFEDRAT/9\n" + std::string(kQuarter) + path, options);
  ASSERT_EQ(turned.moves.size(), plain.moves.size());
  for (size_t i = 0; i < plain.moves.size(); ++i) {
    const Vec3& at = plain.moves[i].to.tip_W;
    expect_tip(turned.moves[i].to.tip_W, 100 - at.y(), at.x(), at.z() + 5);
  }
}

}  // namespace
}  // namespace swarf::program::cl_cutcom_test
