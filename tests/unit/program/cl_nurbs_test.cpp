// MOVNRB of Creo: B-splines of the tip, and of a point up the tool.
#include <gtest/gtest.h>

#include <cmath>

#include "program/cl/nurbs.h"
#include "program/cl/program.h"
#include "unit/program/support.h"

namespace swarf::program::cl_nurbs_test {
namespace {

const char* const kStart = "MULTAX/ON\nFEDRAT/600,MMPM\nFROM/0,0,0,0,0,1\n";
const char* const kCubic = "MOVNRB/1,0,0,0,0,1,1,1,1\nMOVNRB/2,0,0,0,10,0,0,20,10,0,30,10,0\n";

ClProgram read(const std::string& text, Diagnostics& diagnostics) {
  return parse_cl(text, "test.cl", diagnostics);
}

Vec3 bezier(const Vec3 (&p)[4], double u) {
  const double v = 1.0 - u;
  return v * v * v * p[0] + 3.0 * v * v * u * p[1] + 3.0 * v * u * u * p[2] + u * u * u * p[3];
}

double off_chord(const Move& move, const Vec3& p) {
  const Vec3 way = move.to.tip_W - move.from.tip_W;
  const double s = std::clamp((p - move.from.tip_W).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (p - move.from.tip_W - s * way).norm();
}

TEST(ClNurbs, ThreeAxesFollowTheBezierCurve) {
  Diagnostics diagnostics;
  const ClProgram program = read(std::string(kStart) + "MOVNRB/M3AXIS\nMOVNRB/ON,4,8,0,4,33\n" + kCubic +
                                     "MOVNRB/NEXT\nGOTO/15,5,0\nGOTO/30,10,0\nMOVNRB/OFF\nGOTO/30,20,0\n",
                                 diagnostics);
  EXPECT_FALSE(diagnostics.has_errors()) << all_text(diagnostics);
  const Vec3 p[4] = {{0, 0, 0}, {10, 0, 0}, {20, 10, 0}, {30, 10, 0}};
  ASSERT_GT(program.moves.size(), 8U);
  const std::vector<Move> chords(program.moves.begin(), program.moves.end() - 1);
  EXPECT_EQ(chords.front().from.tip_W, p[0]);
  EXPECT_LT((chords.back().to.tip_W - p[3]).norm(), 1e-12);
  for (int i = 0; i <= 1000; ++i) {
    double nearest = 1e9;
    for (const Move& chord : chords) nearest = std::min(nearest, off_chord(chord, bezier(p, i / 1000.0)));
    EXPECT_LE(nearest, kNurbsChordMm * 1.001) << i;
  }
  EXPECT_EQ(program.moves.back().from.tip_W, chords.back().to.tip_W);
  EXPECT_DOUBLE_EQ(chords.front().feed_mm_s, 10.0);
}

TEST(ClNurbs, FiveAxesTurnTheToolWithTheUpperCurve) {
  // The upper curve is the lower one, 50 mm up at its start and 50 mm along (0, 0.6, 0.8) at its end.
  Diagnostics diagnostics;
  const ClProgram program =
      read(std::string(kStart) + "MOVNRB/5AXIS,LENGTH,50\nMOVNRB/ON,4,8,0,4,33\n" + kCubic +
               "MOVNRB/3,0,0,50,10,10,50\nMOVNRB/3,20,30,45,30,40,40\n"
               "MOVNRB/NEXT\nGOTO/30,10,0,0,0.6,0.8\nMOVNRB/OFF\n",
           diagnostics);
  ASSERT_FALSE(diagnostics.has_errors()) << all_text(diagnostics);
  const Vec3 low[4] = {{0, 0, 0}, {10, 0, 0}, {20, 10, 0}, {30, 10, 0}};
  const Vec3 high[4] = {{0, 0, 50}, {10, 10, 50}, {20, 30, 45}, {30, 40, 40}};
  EXPECT_LT((program.moves.back().to.axis_W - Vec3(0, 0.6, 0.8)).norm(), 1e-12);
  for (const Move& move : program.moves) {
    EXPECT_NEAR(move.to.axis_W.norm(), 1.0, 1e-14);
    // x of the lower curve is 30 u: so the place on both is known.
    const double u = move.to.tip_W.x() / 30.0;
    EXPECT_LT((move.to.tip_W - bezier(low, u)).norm(), 1e-12);
    EXPECT_LT((move.to.axis_W - (bezier(high, u) - bezier(low, u)).normalized()).norm(), 1e-12);
  }
}

struct BadCurve {
  const char *name, *text, *says;
};
void PrintTo(const BadCurve& bad, std::ostream* out) {
  *out << bad.name;
}

class BadNurbs : public testing::TestWithParam<BadCurve> {};

TEST_P(BadNurbs, IsRefused) {
  Diagnostics diagnostics;
  read(std::string(kStart) + GetParam().text + "GOTO/0,0,9\n", diagnostics);
  EXPECT_TRUE(diagnostics.has_errors());
  EXPECT_NE(all_text(diagnostics).find(GetParam().says), std::string::npos) << all_text(diagnostics);
}

const BadCurve kBad[] = {
    {"outside", "MOVNRB/1,0,1\n", "outside of a curve"},
    {"no_length", "MOVNRB/5AXIS\nMOVNRB/OFF\n", "need the length"},
    {"sizes_missing", "MOVNRB/3AXIS\nMOVNRB/ON,4\n", "four whole numbers"},
    {"sizes_broken", "MOVNRB/3AXIS\nMOVNRB/ON,4.5,8,0,4,1\n", "four whole numbers"},
    {"weights", "MOVNRB/3AXIS\nMOVNRB/ON,4,8,4,4,1\n", "has weights"},
    {"knots_missing",
     "MOVNRB/3AXIS\nMOVNRB/ON,2,4,0,2,1\nMOVNRB/1,0,0,1\nMOVNRB/2,0,0,0,1,0,0\nMOVNRB/NEXT\n", "announced 4"},
    {"knots_decrease",
     "MOVNRB/3AXIS\nMOVNRB/ON,2,4,0,2,1\nMOVNRB/1,0,1,0,1\nMOVNRB/2,0,0,0,1,0,0\nMOVNRB/NEXT\n",
     "knots decrease"},
    {"order_too_high",
     "MOVNRB/3AXIS\nMOVNRB/ON,4,6,0,2,1\nMOVNRB/1,0,0,0,1,1,1\nMOVNRB/2,0,0,0,1,0,0\nMOVNRB/NEXT\n",
     "at least as many points"},
    {"starts_elsewhere",
     "MOVNRB/3AXIS\nMOVNRB/ON,2,4,0,2,1\nMOVNRB/1,0,0,1,1\nMOVNRB/2,1,0,0,2,0,0\nMOVNRB/NEXT\n",
     "from where the tool stands"},
    {"ends_elsewhere",
     "MOVNRB/3AXIS\nMOVNRB/ON,2,4,0,2,1\nMOVNRB/1,0,0,1,1\nMOVNRB/2,0,0,0,2,0,0\nMOVNRB/NEXT\nGOTO/1,0,0\n"
     "MOVNRB/OFF\n",
     "is not where the curve ends"},
    {"length_wrong",
     "MOVNRB/5AXIS,LENGTH,50\nMOVNRB/ON,2,4,0,2,1\nMOVNRB/1,0,0,1,1\nMOVNRB/2,0,0,0,2,0,0\n"
     "MOVNRB/3,0,0,10,2,0,10\nMOVNRB/NEXT\n",
     "LENGTH says 50"},
    {"upper_in_three_axes", "MOVNRB/3AXIS\nMOVNRB/3,0,0,1\n", "no such values"},
    {"point_not_whole", "MOVNRB/3AXIS\nMOVNRB/2,0,0\n", "no such values"},
    {"no_number", "MOVNRB/3AXIS\nMOVNRB/2,0,0,A\n", "is no number"},
    {"feed_inside",
     "MOVNRB/3AXIS\nMOVNRB/ON,2,4,0,2,1\nMOVNRB/1,0,0,1,1\nMOVNRB/2,0,0,0,2,0,0\nMOVNRB/NEXT\nFEDRAT/5\n",
     "inside of a MOVNRB curve"},
    {"not_ended", "MOVNRB/3AXIS\n", "inside of a MOVNRB curve"},
    {"next_missing", "MOVNRB/3AXIS\nMOVNRB/OFF\n", "without MOVNRB/NEXT"},
};
INSTANTIATE_TEST_SUITE_P(Curves, BadNurbs, testing::ValuesIn(kBad),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(ClNurbs, ACurveWithoutAnEndIsRefused) {
  Diagnostics diagnostics;
  read(std::string(kStart) + "GOTO/0,0,1\nMOVNRB/3AXIS\n", diagnostics);
  EXPECT_NE(all_text(diagnostics).find("does not end"), std::string::npos) << all_text(diagnostics);
}

}  // namespace
}  // namespace swarf::program::cl_nurbs_test
