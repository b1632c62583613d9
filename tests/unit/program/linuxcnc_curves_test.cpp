// G5, G5.1 and G5.2 G5.3 of LinuxCNC against closed forms.
#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "base/rng.h"
#include "unit/program/nc_support.h"

namespace swarf::program::linuxcnc_curves_test {
namespace {

using Plane2 = std::function<Vec3(double)>;

/// Bernstein's form, independent of the program's knots.
Vec3 cubic(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double u) {
  const double v = 1.0 - u;
  return v * v * v * a + 3.0 * v * v * u * b + 3.0 * v * u * u * c + u * u * u * d;
}

double length_of(const Plane2& curve) {
  constexpr int kPieces = 20000;
  double sum = 0.0;
  for (int i = 0; i < kPieces; ++i)
    sum += (curve((i + 1.0) / kPieces) - curve(i / static_cast<double>(kPieces))).norm();
  return sum;
}

/// Distance of `p` from the curve, by the best of a grid and bisection about it.
double distance(const Plane2& curve, const Vec3& p) {
  constexpr int kGrid = 2000;
  double best = 1e300, at = 0.0;
  for (int i = 0; i <= kGrid; ++i) {
    const double off = (curve(i / static_cast<double>(kGrid)) - p).norm();
    if (off < best) best = off, at = i / static_cast<double>(kGrid);
  }
  for (double step = 0.5 / kGrid; step > 1e-14; step *= 0.5) {
    for (const double u : {at - step, at + step}) {
      if (u < 0.0 || u > 1.0) continue;
      const double off = (curve(u) - p).norm();
      if (off < best) best = off, at = u;
    }
  }
  return best;
}

/// Ends and middles of the moves lie on the curve, both its ends are met, and its length takes its time.
void expect_follows(const std::vector<NcMove>& moves, const Plane2& curve, double feed_mm_s) {
  ASSERT_GE(moves.size(), 2u);
  EXPECT_NEAR((moves.front().from.tip_W - curve(0.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((moves.back().to.tip_W - curve(1.0)).norm(), 0.0, 1e-9);
  double time = 0.0;
  for (const NcMove& move : moves) {
    EXPECT_LT(distance(curve, move.to.tip_W), 1e-7);
    EXPECT_LT(distance(curve, 0.5 * (move.from.tip_W + move.to.tip_W)), 1.1e-4);
    time += move.duration_s;
  }
  const double whole = length_of(curve);
  EXPECT_NEAR(time * feed_mm_s, whole, 1e-3 * whole);
}

TEST(LinuxCncCurves, CubicWithItsControlPoints) {
  const NcRun run = linuxcnc("G90 G17 G21 F600\nG5 I0 J3 P0 Q-3 X1 Y1\nM2\n");
  ASSERT_EQ(run.text(), "");
  const Vec3 a(0, 0, 0), b(0, 3, 0), c(1, -2, 0), d(1, 1, 0);
  expect_follows(
      run.moves(), [&](double u) { return cubic(a, b, c, d, u); }, 10.0);
}

TEST(LinuxCncCurves, CubicGoesOnInTheDirectionOfTheOneBefore) {
  const NcRun run =
      linuxcnc("G90 G17 G21 F600\nG5 I0 J3 P0 Q-3 X1 Y1\nM8\nP1 Q-3 X2 Y2\nG91 P0 Q-1 X1\nM2\n");
  ASSERT_EQ(run.text(), "");
  std::vector<NcMove> second, third;
  for (const NcMove& move : run.moves()) {
    if (move.line == 4) second.push_back(move);
    if (move.line == 5) third.push_back(move);
  }
  // As if I and J were 0 and 3: the start of the second is (1, 1).
  const Vec3 a(1, 1, 0), b(1, 4, 0), c(3, -1, 0), d(2, 2, 0);
  expect_follows(
      second, [&](double u) { return cubic(a, b, c, d, u); }, 10.0);
  // P1 Q-3 before it: I-1 J3.
  const Vec3 e(1, 5, 0), f(3, 1, 0), g(3, 2, 0);
  expect_follows(
      third, [&](double u) { return cubic(d, e, f, g, u); }, 10.0);
}

TEST(LinuxCncCurves, QuadraticIsItsParabola) {
  const NcRun run = linuxcnc("G90 G17 G21 F600 G0 X-2 Y4\nG5.1 X2 I2 J-8\nM2\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_GE(run.moves().size(), 10u);
  for (const NcMove& move : run.moves())
    EXPECT_NEAR(move.to.tip_W.y(), move.to.tip_W.x() * move.to.tip_W.x(), 1e-9);
  expect_tip(run.moves().back(), 2, 4, 0);
}

TEST(LinuxCncCurves, NurbsOfTheReference) {
  const NcRun run = linuxcnc(
      "G21 G0 X0 Y0\nF600\nG5.2 P1 L3\n X0 Y1 P1\n X2 Y2 P1\n X2 Y0 P1\n X0 Y0 P2\nG5.3\nG0 X0 Y1\nM2\n");
  ASSERT_EQ(run.text(), "");
  // At the inner knots two neighbours in equal parts; in the middle of the last span, where the weight of 2
  // counts, (1/8 (2,2) + 5/8 (2,0) + 1/4 2 (0,0)) / (5/4).
  for (const Vec3& point : {Vec3(1, 1.5, 0), Vec3(2, 1, 0), Vec3(1.2, 0.2, 0)}) {
    double nearest = 1e300;
    for (const NcMove& move : run.moves()) nearest = std::min(nearest, (move.to.tip_W - point).norm());
    EXPECT_LT(nearest, 1e-12) << point.transpose();
  }
  EXPECT_EQ(run.moves().back().line, 9);
  EXPECT_TRUE(run.moves().back().rapid);
}

TEST(LinuxCncCurves, NurbsCirclesWithWeights) {
  const std::string half = "0.70710678118654752", whole = "1.41421356237309505";
  // Quarter circles of radius 10 and 1 inch; all weights doubled, the first by P of G5.2 alone.
  for (const auto& [text, radius] : std::vector<std::pair<std::string, double>>{
           {"G21 G0 X10 Y0\nF600 G5.2 L3\nX10 Y10 P" + half + "\nX0 Y10\nG5.3\nM2\n", 10.0},
           {"G21 G0 X10 Y0\nF600 G5.2 X10 Y10 P" + half + "\nX0 Y10 P1\nG5.3\nM2\n", 10.0},
           {"G21 G0 X10 Y0\nF600 G5.2 P2\nX10 Y10 P" + whole + "\nG5.2 X0 Y10 P2\nG5.3\nM2\n", 10.0},
           {"G20 G0 X1 Y0\nF20 G5.2 P2 L3\nX1 Y1 P" + whole + "\nX0 Y1 P2\nG5.3\nM2\n", 25.4}}) {
    const NcRun run = linuxcnc(text);
    ASSERT_EQ(run.text(), "");
    ASSERT_GE(run.moves().size(), 10u) << text;
    for (const NcMove& move : run.moves()) EXPECT_NEAR(move.to.tip_W.norm(), radius, 1e-9) << text;
    EXPECT_NEAR((run.moves().back().to.tip_W - Vec3(0, radius, 0)).norm(), 0.0, 1e-12);
  }
}

TEST(LinuxCncCurves, ACurveIsOneBlock) {
  const NcRun run = linuxcnc("G61.1 G21 F600 G4 P2\nG5.1 X20 I10 J10\nG1 X30\nM2\n");
  ASSERT_EQ(run.text(), "");
  const std::vector<NcMove>& moves = run.moves();
  ASSERT_GE(moves.size(), 4u);
  for (size_t i = 0; i + 2 < moves.size(); ++i) EXPECT_FALSE(moves[i].exact_stop) << i;
  EXPECT_TRUE(moves[moves.size() - 2].exact_stop);
  EXPECT_TRUE(moves.back().exact_stop);
  EXPECT_EQ(moves[0].dwell_s, 2.0);
  EXPECT_EQ(moves[1].dwell_s, 0.0);
}

TEST(LinuxCncCurves, RandomCubics) {
  Rng rng(5);
  const auto number = [&](double size) { return size * (2.0 * rng.uniform() - 1.0); };
  for (int round = 0; round < 40; ++round) {
    const bool inches = round % 2 == 1, steps = round % 3 == 1;
    const double unit = inches ? 25.4 : 1.0;
    double v[8];
    for (double& x : v) x = number(20.0 / unit);
    const std::string text = fmt::format(
        "{} G0 X{:.9f} Y{:.9f} Z3\n{} F{:.9f}\nG5 X{:.9f} Y{:.9f} I{:.9f} J{:.9f} P{:.9f} Q{:.9f}\nM2\n",
        inches ? "G20" : "G21", v[0], v[1], steps ? "G91" : "G90", 600.0 / unit, v[2], v[3], v[4], v[5], v[6],
        v[7]);
    SCOPED_TRACE(text);
    const NcRun run = linuxcnc(text);
    ASSERT_EQ(run.text(), "");
    const double height = inches ? 76.2 : 3.0;
    const Vec3 a(unit * v[0], unit * v[1], height);
    const Vec3 d = steps ? Vec3(a + unit * Vec3(v[2], v[3], 0)) : Vec3(unit * v[2], unit * v[3], height);
    const Vec3 b = a + unit * Vec3(v[4], v[5], 0), c = d + unit * Vec3(v[6], v[7], 0);
    EXPECT_NEAR((run.moves().back().to.tip_W - d).norm(), 0.0, 1e-6);
    for (size_t i = 1; i < run.moves().size(); i += 7)
      EXPECT_LT(distance([&](double u) { return cubic(a, b, c, d, u); }, run.moves()[i].to.tip_W), 1e-6);
  }
}

}  // namespace
}  // namespace swarf::program::linuxcnc_curves_test
