// The way of a move and the box that holds it, against points taken densely from the arc.
#include "program/move_way.h"

#include <gtest/gtest.h>

#include <random>

namespace swarf::program {
namespace move_way_test {

Move arc(const Vec3& centre, const Vec3& normal, const Vec3& from, double angle, double rise) {
  Move move;
  move.arc = Arc{centre, normal};
  move.from.tip_W = from;
  move.to.tip_W = centre + Eigen::AngleAxisd(angle, normal) * (from - centre) + rise * normal;
  return move;
}

TEST(MoveWay, OfAStraightMoveIsTheDistanceOfItsEnds) {
  Move move;
  move.to.tip_W = {3, 4, 0};
  EXPECT_DOUBLE_EQ(way_mm(move), 5.0);
  EXPECT_EQ(extent_W(move).max(), Vec3(3, 4, 0));
}

TEST(MoveWay, OfThreeQuartersOfACircleHasItsBulges) {
  const Move move = arc({0, 0, 0}, Vec3::UnitZ(), {10, 0, 0}, 1.5 * kPi, 0.0);
  EXPECT_NEAR(way_mm(move), 15.0 * kPi, 1e-12);
  EXPECT_NEAR(extent_W(move).min().x(), -10.0, 1e-12);
  EXPECT_NEAR(extent_W(move).max().y(), 10.0, 1e-12);
  EXPECT_NEAR(extent_W(move).min().y(), -10.0, 1e-12);
}

TEST(MoveWay, OfAWholeTurnOfAHelix) {
  const Move move = arc({5, 5, 0}, Vec3::UnitZ(), {8, 5, 0}, 2.0 * kPi, 4.0);
  EXPECT_NEAR(way_mm(move), std::hypot(6.0 * kPi, 4.0), 1e-9);
  EXPECT_NEAR(extent_W(move).min().x(), 2.0, 1e-12);
  EXPECT_NEAR(extent_W(move).max().z(), 4.0, 1e-12);
}

TEST(MoveWay, BoxesOfRandomArcsHoldThemTightly) {
  std::mt19937 random(20261123);
  std::uniform_real_distribution<double> number(-1.0, 1.0), turn(0.1, 6.2);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 normal = Vec3(number(random), number(random), number(random)).normalized();
    const Vec3 centre = 50.0 * Vec3(number(random), number(random), number(random));
    const Vec3 across = normal.unitOrthogonal();
    const double radius = 20.0 + 15.0 * number(random), angle = turn(random);
    const Move move = arc(centre, normal, centre + radius * across, angle, 0.0);
    Eigen::AlignedBox3d dense;
    double length = 0.0;
    Vec3 before = move.from.tip_W;
    constexpr int kParts = 4000;
    for (int k = 0; k <= kParts; ++k) {
      const Vec3 p = centre + Eigen::AngleAxisd(angle * k / kParts, normal) * (move.from.tip_W - centre);
      dense.extend(p);
      length += (p - before).norm();
      before = p;
    }
    const Eigen::AlignedBox3d box = extent_W(move);
    const double sagitta = radius * angle * angle / (8.0 * kParts * kParts) + 1e-9;
    EXPECT_LT((box.min() - dense.min()).cwiseAbs().maxCoeff(), sagitta) << "case " << i;
    EXPECT_LT((box.max() - dense.max()).cwiseAbs().maxCoeff(), sagitta) << "case " << i;
    EXPECT_NEAR(way_mm(move), length, 1e-5 * length) << "case " << i;
  }
}

}  // namespace move_way_test
}  // namespace swarf::program
