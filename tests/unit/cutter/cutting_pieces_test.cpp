// The union of convex pieces against the outline itself: a polygon, point-in-polygon and the nearest edge.
#include "cutter/cutting_pieces.h"

#include <gtest/gtest.h>

#include "cutter/profile_check.h"
#include "shapes.h"

namespace swarf::cutter {
namespace {

using namespace test;

constexpr double kSample = 1e-5;  // mm, of the polygon

/// Compares F with the polygon at random points; the least F / -distance met inside.
double compare(const Cutter& cutter, uint64_t seed, int points) {
  const std::vector<ConvexPiece> pieces = cutting_pieces(cutter);
  const std::vector<Vec2> polygon = polygon_of(cutter, kSample);
  const double slack = chord_error_mm(cutter) + 3.0 * kSample;
  Rng rng(seed);
  double least = 1.0;
  for (int i = 0; i < points; ++i) {
    const Vec2 p = point_near(cutter, rng);
    const double value = union_distance(pieces, p), distance = edge_distance(polygon, p);
    const auto place = [&] { return fmt::format("{} at ({:.17g}, {:.17g})", pasted(cutter), p.x(), p.y()); };
    EXPECT_LE(std::abs(value), distance + slack) << place() << ": no F exceeds the distance";
    if (distance <= slack) continue;
    EXPECT_EQ(value < 0.0, inside(polygon, p)) << place() << " F " << value << " distance " << distance;
    if (inside(polygon, p)) least = std::min(least, -value / distance);
    if (pieces.size() == 1 && value < 0.0) {
      EXPECT_NEAR(value, -distance, slack) << place();
    }
  }
  return least;
}

TEST(CuttingPieces, EveryShapeIsItsOutline) {
  for (const Named& one : every_shape()) {
    SCOPED_TRACE(one.name);
    ASSERT_TRUE(validate(one.cutter).empty()) << validate(one.cutter)[0].text;
    EXPECT_EQ(cutting_pieces(one.cutter).size() == 1, one.convex);
    const double least = compare(one.cutter, 7, 1500);
    EXPECT_GT(least, one.convex ? 0.99 : 0.3) << "F is clearly negative inside, also between pieces";
  }
}

TEST(CuttingPieces, RandomAptCutters) {
  Rng rng(3003);
  int tried = 0;
  for (int i = 0; i < 2000; ++i) {
    Cutter c = apt(rng.uniform(1, 20), 0.0, i % 3 == 0 ? 0.0 : rng.uniform(0, 50), rng.uniform(-20, 34),
                   rng.uniform(5, 40));
    c.corner_radius_mm = (i % 4 == 0 ? 0.0 : rng.uniform()) * apt_form(c)->largest_corner_radius();
    c.flute_length_mm = apt_form(c)->flank_start().y() + rng.uniform(0.1, 20.0);
    c.length_mm = 2.0 * c.flute_length_mm;
    if (!validate(c).empty()) continue;  // the flank met the axis
    ++tried;
    compare(c, static_cast<uint64_t>(i), 60);
    if (HasFailure()) return;
  }
  EXPECT_GT(tried, 1500);
}

/// Lines, bulging and hollow arcs, level steps in and out; corners that make no outline are drawn again.
Cutter random_profile(Rng& rng) {
  std::vector<ProfilePoint> points{{{0, 0}, 0.0}};
  const size_t corners = 3 + rng.next() % 8;
  for (int attempts = 0; points.size() < corners && attempts < 200; ++attempts) {
    const Vec2 last = points.back().to;
    Vec2 step(rng.uniform(-3, 3), rng.uniform(0, 3));
    if (rng.uniform() < 0.25) step.y() = 0.0;
    if (rng.uniform() < 0.25) step.x() = 0.0;
    ProfilePoint next{last + step, 0.0};
    if (rng.uniform() < 0.4)
      next.radius_mm = step.norm() * rng.uniform(0.5, 3) * (rng.uniform() < 0.5 ? 1 : -1);
    if (next.to.x() < 0.5 || next.to.x() > 10.0) continue;
    points.push_back(next);
    const std::vector<std::string> problems = profile_problems(points);
    // Level so far: what comes next may go up.
    const bool unfinished =
        problems.size() == 1 && (problems[0] == "the profile has no height" ||
                                 problems[0].find("without thickness") != std::string::npos);
    if (!problems.empty() && !unfinished) points.pop_back();
  }
  if (!profile_problems(points).empty()) points.push_back({points.back().to + Vec2(0, 2), 0.0});
  return profile(points);
}

TEST(CuttingPieces, RandomProfiles) {
  Rng rng(909);
  size_t several = 0, hollow = 0;
  for (int i = 0; i < 2000; ++i) {
    const Cutter c = random_profile(rng);
    SCOPED_TRACE(pasted(c));
    ASSERT_TRUE(validate(c).empty()) << validate(c)[0].text;
    several += cutting_pieces(c).size() > 1 ? 1 : 0;
    hollow += chord_error_mm(c) > 0.0 ? 1 : 0;
    EXPECT_LE(chord_error_mm(c), kChordTolerance);
    EXPECT_GT(compare(c, static_cast<uint64_t>(i), 60), 0.0);
    if (HasFailure()) return;
  }
  EXPECT_GT(several, 1000U);
  EXPECT_GT(hollow, 500U);
}

TEST(CuttingPieces, FStaysNegativeAcrossTheBordersBetweenPieces) {
  // On the level line through each reflex corner, where the pieces part, and close to it on both sides.
  for (const Named& one : every_shape()) {
    if (one.convex) continue;
    SCOPED_TRACE(one.name);
    const std::vector<ConvexPiece> pieces = cutting_pieces(one.cutter);
    const std::vector<Vec2> polygon = polygon_of(one.cutter, kSample);
    for (const OutlineElement& e : outline(one.cutter)) {
      for (const double z : {e.to.y() - 1e-6, e.to.y(), e.to.y() + 1e-6}) {
        for (double rho = 0.0; rho < e.to.x(); rho += 0.01) {
          const double depth = edge_distance(polygon, {rho, z});
          if (!inside(polygon, {rho, z}) || depth < 1e-3) continue;
          EXPECT_LT(union_distance(pieces, {rho, z}), -0.3 * depth + chord_error_mm(one.cutter))
              << rho << " " << z;
        }
      }
    }
  }
}

TEST(CuttingPieces, AFlatEndIsTheCylinderThatTheKernelsKnow) {
  const std::vector<ConvexPiece> pieces = cutting_pieces(of_shape(Shape::kFlat, 10, 0, 25));
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_TRUE(pieces[0].is_cylinder());
  EXPECT_EQ(pieces[0].radius, 5.0);
  EXPECT_EQ(pieces[0].high, 25.0);
  EXPECT_TRUE(cutting_pieces(woodruff(20, 0, 4))[0].is_cylinder());
  EXPECT_FALSE(cutting_pieces(of_shape(Shape::kBall, 10, 0, 25))[0].is_cylinder());
}

TEST(CuttingPieces, NormalsNeverPointToTheAxis) {
  Rng rng(11);
  for (int i = 0; i < 200; ++i) {
    const Cutter c = random_profile(rng);
    SCOPED_TRACE(pasted(c));
    for (const ConvexPiece& piece : cutting_pieces(c)) {
      for (const Face& face : piece.faces) {
        EXPECT_GE(face.normal.x(), 0.0);
        EXPECT_NEAR(face.normal.norm(), 1.0, 1e-12);
      }
      for (const Round& round : piece.rounds) {
        EXPECT_GE(std::min(round.from.x(), round.to.x()), 0.0);
        EXPECT_GT(round.radius, 0.0);
        EXPECT_GE(round.from.x() * round.to.y() - round.from.y() * round.to.x(), -1e-12)
            << "less than half a turn";
      }
      EXPECT_LT(piece.low, piece.high);
      EXPECT_GE(piece.low, -1e-9);
      EXPECT_LE(piece.high, c.flute_length_mm + 1e-9);
      EXPECT_LE(piece.radius, c.radius() + 1e-9);
    }
  }
}

TEST(CuttingPieces, AWholeBallTurnsThroughHalfATurnInTwoRounds) {
  const Cutter c = profile({{{0, 0}}, {{0.0, 8.0}, 4.0}});
  ASSERT_TRUE(validate(c).empty()) << validate(c)[0].text;
  EXPECT_EQ(cutting_pieces(c)[0].rounds.size(), 2U);
  EXPECT_NEAR(c.radius(), 4.0, 1e-12);
  compare(c, 1, 500);
}

TEST(CuttingPieces, HollowArcsAreNeverCutTooSmallAndByHalfAMicrometreAtMost) {
  const Cutter c = flared();
  const std::vector<ConvexPiece> pieces = cutting_pieces(c);
  EXPECT_GT(chord_error_mm(c), 0.25 * kChordTolerance);
  EXPECT_LE(chord_error_mm(c), kChordTolerance);
  double most = 0.0;
  for (double angle = 0.0; angle < 0.5 * kPi; angle += 1e-4) {
    const Vec2 on_arc(5.0 - 2.0 * std::cos(angle), 10.0 + 2.0 * std::sin(angle));
    const double value = union_distance(pieces, on_arc);
    EXPECT_LE(value, 1e-12);
    most = std::max(most, -value);
  }
  EXPECT_NEAR(most, chord_error_mm(c), 1e-6);
}

}  // namespace
}  // namespace swarf::cutter
