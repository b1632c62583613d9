// POLY of Siemens 840D against closed forms.
#include <fmt/format.h>

#include <cmath>

#include "base/rng.h"
#include "unit/program/siemens_support.h"

namespace swarf::program::nc::siemens {
namespace {

/// The feed moves of a program; each test positions with G0.
std::vector<NcMove> cuts(const std::string& text) {
  const Ran ran = run_clean(text + "\nM30\n");
  std::vector<NcMove> all;
  for (const NcMove& move : ran.moves) {
    if (!move.rapid) all.push_back(move);
  }
  EXPECT_FALSE(all.empty()) << text;
  return all;
}

double way_of(const std::vector<NcMove>& moves) {
  double way = 0.0;
  for (const NcMove& move : moves) way += (move.to.tip_W - move.from.tip_W).norm();
  return way;
}

double time_of(const std::vector<NcMove>& moves) {
  double time = 0.0;
  for (const NcMove& move : moves) time += move.duration_s;
  return time;
}

/// y = x^2 / 10 - x from (0,0) to (10,0), p = x.
const char* const kParabola = "G0 X0 Y0 Z300\nPOLY PO[X]=(10) PO[Y]=(0,0.1) PL=10 F600";

TEST(SiemensPoly, AParabolaIsMetAtEveryPointAndBetweenThem) {
  const std::vector<NcMove> moves = cuts(kParabola);
  EXPECT_GT(moves.size(), 50U);
  for (const NcMove& move : moves) {
    const Vec3 end = move.to.tip_W, middle = 0.5 * (move.from.tip_W + end);
    EXPECT_NEAR(end.y(), 0.1 * end.x() * end.x() - end.x(), 1e-12);
    EXPECT_NEAR(middle.y(), 0.1 * middle.x() * middle.x() - middle.x(), 1.5e-4);
    EXPECT_EQ(end.z(), 300.0);
    EXPECT_NEAR(move.feed_mm_s, 10.0, 1e-12);
  }
  EXPECT_EQ(moves.back().to.tip_W.x(), 10.0);
  EXPECT_EQ(moves.back().to.tip_W.y(), 0.0);
  // Length of y = x^2/10 - x over [0, 10]: twice that of the half with slopes 0 to 1, times 5.
  const double length = 5.0 * (std::sqrt(2.0) + std::asinh(1.0));
  EXPECT_NEAR(way_of(moves), length, 1e-4);
  EXPECT_NEAR(time_of(moves), length / 10.0, 1e-5);
}

TEST(SiemensPoly, BothNotationsSayTheSame) {
  const std::vector<NcMove> old_way = cuts(kParabola);
  const std::vector<NcMove> new_way = cuts("g0 x0 y0 z300\npoly x=po(10) y=PO(0,0.1) pl=10 f600");
  ASSERT_EQ(old_way.size(), new_way.size());
  for (size_t n = 0; n < old_way.size(); ++n) EXPECT_EQ(old_way[n].q_to, new_way[n].q_to) << n;
}

TEST(SiemensPoly, TheCubicOfTheManualRunsThroughItsPoints) {
  // PO[X]=(1,2.5,0.7) PO[Y]=(0.3,1,3.2) PL=1.5 from the origin.
  const double PL = 1.5;
  const auto axis = [&](double end, double a2, double a3, double p) {
    const double a1 = (end - a2 * PL * PL - a3 * PL * PL * PL) / PL;
    return p * (a1 + p * (a2 + p * a3));
  };
  const auto curve = [&](double p) { return Vec3(axis(1, 2.5, 0.7, p), axis(0.3, 1, 3.2, p), 300.0); };
  const std::vector<NcMove> moves =
      cuts("G0 X0 Y0 Z300\nPOLY PO[X]=(1,2.5,0.7) PO[Y]=(0.3,1,3.2) PL=1.5 F100");
  double p = 0.0, length = 0.0;
  const int steps = 400'000;
  size_t next = 0;
  for (int n = 1; n <= steps; ++n) {
    const double to = PL * n / steps;
    length += (curve(to) - curve(p)).norm();
    p = to;
    // Ends come in their order: the next one is passed as the parameter runs.
    while (next < moves.size() && (moves[next].to.tip_W - curve(p)).norm() < 1e-4) ++next;
  }
  EXPECT_EQ(next, moves.size()) << "not every end lies on the curve";
  EXPECT_NEAR(way_of(moves), length, 1e-3);
  EXPECT_LE(way_of(moves), length + 1e-9);
}

TEST(SiemensPoly, TheDivisorOfTheManualGivesAQuarterOfACircle) {
  for (const char* block :
       {"PO[X]=(0,-10) PO[Y]=(10) PO[]=(2,1)", "PO[X]=(0,-2.5) PO[Y]=(10) PO[]=(2,0.25) PL=2",
        "G91 PO[X]=(-10,-10) PO[Y]=(10) PO[]=(2,1)"}) {
    const std::vector<NcMove> moves = cuts(std::string("G0 X10 Y0 Z300\nPOLY ") + block + " F600");
    for (const NcMove& move : moves) {
      const Vec3 end = move.to.tip_W, middle = 0.5 * (move.from.tip_W + end);
      EXPECT_NEAR(std::hypot(end.x(), end.y()), 10.0, 1e-12) << block;
      EXPECT_NEAR(std::hypot(middle.x(), middle.y()), 10.0, 1.1e-4) << block;
      EXPECT_EQ(end.z(), 300.0) << "Z stands under any divisor";
    }
    EXPECT_EQ(moves.back().to.tip_W, Vec3(0, 10, 300)) << block;
    EXPECT_NEAR(way_of(moves), 5.0 * kPi, 1e-4) << block;
  }
}

TEST(SiemensPoly, WithoutCoefficientsItIsAStraightLine) {
  const char* const blocks[] = {"POLY X20 Y10", "POLY PO[X]=(20) PO[Y]=(10)", "POLY PO[X]=(20,0,0) Y10 PL=7",
                                "POLY X=PO(20) Y=PO(10,0,0,0,0)", "G1 PO[X]=(20,5) PO[Y]=(10,3)"};
  const std::vector<NcMove> line = cuts("G0 X1 Y2 Z300\nG1 X20 Y10 F500");
  for (const char* block : blocks) {
    const std::vector<NcMove> moves = cuts(std::string("G0 X1 Y2 Z300\n") + block + " F500");
    EXPECT_EQ(moves.back().q_to, line[0].q_to) << block;
    EXPECT_NEAR(time_of(moves), line[0].duration_s, 1e-12) << block;
    for (const NcMove& move : moves) {
      const Vec3 off = move.to.tip_W - Vec3(1, 2, 300), along = Vec3(19, 8, 0).normalized();
      EXPECT_LE((off - off.dot(along) * along).norm(), 1e-12) << block;
    }
  }
  const Ran ran = run_clean("G0 X1 Y2 Z300\nG1 PO[X]=(20,5) F500\nM30\n");
  EXPECT_NE(all_text(ran.diagnostics).find("polynomial-not-active"), std::string::npos);
}

TEST(SiemensPoly, IsModalUntilAnotherMotion) {
  const std::vector<NcMove> moves = cuts(
      "G0 X0 Y0 Z300\nPOLY PO[X]=(10) PO[Y]=(0,0.1) PL=10 F600\nX20\nPO[X]=(30) PO[Y]=(0,0.1) PL=10\nG1 X40");
  int straight = 0, bent = 0;
  for (const NcMove& move : moves) (move.line == 3 || move.line == 5 ? straight : bent)++;
  EXPECT_EQ(straight, 2);
  EXPECT_EQ(bent % 2, 0);
  EXPECT_GT(bent, 100);
  for (const NcMove& move : moves) {
    if (move.line != 4) continue;
    const double x = move.to.tip_W.x() - 20.0;
    EXPECT_NEAR(move.to.tip_W.y(), 0.1 * x * x - x, 1e-11);
  }
}

/// The coefficients belong to the path from the start point, whatever G90 and G91 say of its end.
TEST(SiemensPoly, IncrementsInchesAndFrames) {
  const auto expect_on = [](const std::string& text, const Mat3& R, const Vec3& origin, double scale) {
    for (const NcMove& move : cuts(text)) {
      const Vec3 p = R.transpose() * (move.to.tip_W - origin) / scale;
      EXPECT_NEAR(p.y(), 0.1 * p.x() * p.x() - p.x(), 1e-10) << text;
      EXPECT_NEAR(p.z(), 0.0, 1e-10) << text;
    }
  };
  const Mat3 I = Mat3::Identity();
  expect_on("G0 X7 Y-3 Z300\nG91 POLY PO[X]=(10) PO[Y]=(0,0.1) PL=10 F600", I, Vec3(7, -3, 300), 1.0);
  expect_on("G0 X0 Y0 Z300\nG700 POLY PO[X]=(10) PO[Y]=(0,0.1) PL=10 F60", I, Vec3(0, 0, 300), 25.4);
  expect_on("G0 X0 Y0 Z300\nG70 POLY PO[X]=(10) PO[Y]=(0,0.1) PL=10 F600", I, Vec3(0, 0, 300), 25.4);
  const Mat3 R = Eigen::AngleAxisd(rad_from_deg(30.0), Vec3::UnitY()).toRotationMatrix();
  expect_on("TRANS X1 Y2 Z300\nAROT Y30\nG0 X0 Y0 Z0\nPOLY PO[X]=(10) PO[Y]=(0,0.1) PL=10 F600", R,
            Vec3(1, 2, 300), 1.0);
}

/// The example of the manual: PO[X]=(10,10) with an axis that is not in FGROUP.
TEST(SiemensPoly, OtherAxesFollowTheWayOrTheParameter) {
  const std::vector<NcMove> by_way = cuts("G0 X0 Y0 Z300 B0\nSPATH POLY PO[X]=(10,10) B10 F600");
  for (const NcMove& move : by_way) EXPECT_NEAR(deg_from_rad(move.q_to[3]), move.q_to[0], 1e-6);
  EXPECT_EQ(by_way.back().q_to[3], rad_from_deg(10.0));
  const std::vector<NcMove> by_parameter = cuts("G0 X0 Y0 Z300 B0\nUPATH POLY PO[X]=(10,10) B10 F600");
  for (const NcMove& move : by_parameter) {
    EXPECT_NEAR(deg_from_rad(move.q_to[3]), std::sqrt(10.0 * move.q_to[0]), 1e-9);
    const double x = 0.5 * (move.q_from[0] + move.q_to[0]);
    EXPECT_NEAR(deg_from_rad(0.5 * (move.q_from[3] + move.q_to[3])), std::sqrt(10.0 * x), 1.5e-3);
  }
  // Polynomials of their own: B = 4 s + 6 s^2 over the share s of the way.
  for (const NcMove& move : cuts("G0 X0 Y0 Z300 B0\nPOLY PO[X]=(10,10) PO[B]=(10,6) F600")) {
    const double s = move.q_to[0] / 10.0;
    EXPECT_NEAR(deg_from_rad(move.q_to[3]), 4.0 * s + 6.0 * s * s, 1e-6);
  }
  // A rotary axis alone: F counts degrees.
  const std::vector<NcMove> alone = cuts("G0 B0\nPOLY PO[B]=(10,6) F600");
  EXPECT_NEAR(time_of(alone), 1.0, 1e-9);
  EXPECT_EQ(alone.back().q_to[3], rad_from_deg(10.0));
}

TEST(SiemensPoly, UnderTraoriTheTipStaysOnTheCurveAndTheVectorOnItsGreatCircle) {
  const std::string head = "T=\"MILL10\" M6\nTRAORI\nORIWKS\nG0 X0 Y0 Z300 A3=0 B3=0 C3=1\n";
  const Vec3 last = Vec3(1, 1, 3).normalized();
  const std::vector<NcMove> moves = cuts(head + "POLY PO[X]=(10) PO[Y]=(0,0.1) PL=10 A3=1 B3=1 C3=3 F600");
  const double whole = std::acos(last.z()), length = way_of(moves);
  double way = 0.0;
  for (const NcMove& move : moves) {
    const Vec3 end = move.to.tip_W;
    way += (end - move.from.tip_W).norm();
    EXPECT_NEAR(end.y(), 0.1 * end.x() * end.x() - end.x(), 1e-9);
    EXPECT_EQ(move.law, BlockLaw::kTcp);
    const Vec3 axis = move.to.axis_W;
    EXPECT_NEAR(axis.dot(Vec3(1, -1, 0)), 0.0, 1e-9) << "off the great circle";
    EXPECT_NEAR(std::acos(std::min(1.0, axis.z())), whole * way / length, 2e-5);
  }
  EXPECT_LE((moves.back().to.axis_W - last).norm(), 1e-9);
  for (const NcMove& move : cuts("T=\"MILL10\" M6\nTRAORI\nORIAXES\nG0 X0 Y0 Z300 B0 C0\n"
                                 "POLY PO[X]=(10,10) PO[B]=(10,6) C20 F600")) {
    const double s = move.to.tip_W.x() / 10.0;
    EXPECT_NEAR(deg_from_rad(move.q_to[3]), 4.0 * s + 6.0 * s * s, 1e-6);
    EXPECT_NEAR(deg_from_rad(move.q_to[4]), 20.0 * s, 1e-6);
    EXPECT_NEAR(move.to.tip_W.y(), 0.0, 1e-9);
  }
}

TEST(SiemensPoly, ComesToRestAtTheEndOfTheBlockAlone) {
  const std::vector<NcMove> moves = cuts(std::string("G60\n") + kParabola);
  for (size_t n = 0; n < moves.size(); ++n) EXPECT_EQ(moves[n].exact_stop, n + 1 == moves.size()) << n;
  const std::vector<NcMove> once =
      cuts("G64\nG0 X0 Y0 Z300\nG9 POLY PO[X]=(10) PO[Y]=(0,0.1) PL=10 F600\nX20");
  for (const NcMove& move : once) {
    EXPECT_EQ(move.exact_stop, move.line == 3 && move.to.tip_W.x() == 10.0);
  }
  for (const NcMove& move : cuts("G60\nG0 X10 Y0 Z300\nG3 X0 Y10 Z290 I-10 J0 TURN=2 F600"))
    EXPECT_EQ(move.exact_stop, move.to.tip_W.z() == 290.0) << "whole turns of a helix go on";
}

TEST(SiemensPoly, TheNextTangentialArcGoesOnInItsDirection) {
  // The parabola ends with the slope 1 at (10,0): the arc to (20,0) has its centre at (15,-5).
  const std::vector<NcMove> moves = cuts(std::string(kParabola) + "\nCT X20 Y0");
  ASSERT_TRUE(moves.back().arc);
  EXPECT_LE((moves.back().arc->centre_W - Vec3(15, -5, 300)).norm(), 1e-9);
}

/// Four zeros of the distance from the chord at the quarters of the parameter: it still is no line.
TEST(SiemensPoly, AQuinticThatCrossesItsChordAtEachQuarterIsNoLine) {
  // y = k u (u - 1/4)(u - 1/2)(u - 3/4)(u - 1), x = 100 u
  const double k = 1000.0;
  const double a5 = k, a4 = -2.5 * k, a3 = 35.0 / 16.0 * k, a2 = -25.0 / 32.0 * k;
  const std::vector<NcMove> moves = cuts(fmt::format(
      "G0 X0 Y0 Z300\nPOLY PO[X]=(100) PO[Y]=(0,{:.9f},{:.9f},{:.9f},{:.9f}) F600", a2, a3, a4, a5));
  double most = 0.0;
  for (const NcMove& move : moves) {
    const double u = move.to.tip_W.x() / 100.0;
    EXPECT_NEAR(move.to.tip_W.y(), k * u * (u - 0.25) * (u - 0.5) * (u - 0.75) * (u - 1.0), 1e-8);
    most = std::max(most, std::abs(move.to.tip_W.y()));
  }
  EXPECT_GT(most, 3.0);
}

TEST(SiemensPoly, RandomPolynomialsOfEveryDegree) {
  Rng rng(8400);
  const auto between = [&](double low, double high) { return low + (high - low) * rng.uniform(); };
  for (int round = 0; round < 150; ++round) {
    const double PL = std::round(1e3 * between(0.2, 20.0)) / 1e3,
                 x_end = between(0.0, 1.0) < 0.5 ? 30.0 : -40.0;
    const int degree = 1 + static_cast<int>(rng.next() % 5);
    double ends[2], a[2][6] = {};
    std::string text = fmt::format("G0 X2 Y3 Z300\nPOLY PO[X]=({:.0f})", x_end);
    for (int i = 0; i < 2; ++i) {
      ends[i] = std::round(1e3 * between(-20.0, 20.0)) / 1e3 + (i == 1 ? 300.0 : 0.0);
      text += fmt::format(" PO[{}]=({:.3f}", "YZ"[i], ends[i]);
      for (int k = 2; k <= degree; ++k) {
        a[i][k] = std::round(1e9 * between(-30.0, 30.0) / std::pow(PL, k)) / 1e9;
        text += fmt::format(",{:.9f}", a[i][k]);
      }
      text += ")";
      a[i][0] = i == 0 ? 3.0 : 300.0;
      double left = ends[i] - a[i][0];
      for (int k = 2; k <= degree; ++k) left -= a[i][k] * std::pow(PL, k);
      a[i][1] = left / PL;
    }
    text += fmt::format(" PL={:.3f} F1000", PL);
    const std::vector<NcMove> moves = cuts(text);
    const auto at = [&](int i, double x) {
      const double p = PL * (x - 2.0) / (x_end - 2.0);
      double sum = 0.0;
      for (int k = 5; k >= 0; --k) sum = sum * p + a[i][k];
      return sum;
    };
    for (const NcMove& move : moves) {
      const Vec3 end = move.to.tip_W, middle = 0.5 * (move.from.tip_W + end);
      ASSERT_NEAR(end.y(), at(0, end.x()), 1e-8) << text;
      ASSERT_NEAR(end.z(), at(1, end.x()), 1e-8) << text;
      const Vec3 way = end - move.from.tip_W;
      const double steep = way.norm() / std::abs(way.x());
      ASSERT_LE(std::hypot(middle.y() - at(0, middle.x()), middle.z() - at(1, middle.x())), 1.5e-4 * steep)
          << text;
    }
    ASSERT_LE((moves.back().to.tip_W - Vec3(x_end, ends[0], ends[1])).norm(), 1e-9) << text;
  }
}

}  // namespace
}  // namespace swarf::program::nc::siemens
