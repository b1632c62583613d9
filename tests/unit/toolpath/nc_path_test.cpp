// Moves of a control as elements of a tool path. The control here is played by the test.
#include <gtest/gtest.h>

#include "toolpath/nc_path.h"

namespace swarf::toolpath::nc_path_test {
namespace {

using program::NcMove;

/// A move of a three-axis control whose tip stands at its axis values.
NcMove line(const Vec3& from, const Vec3& to, double feed_mm_s, int line) {
  NcMove move;
  move.q_from.head<3>() = from;
  move.q_to.head<3>() = to;
  move.from = {from, Vec3::UnitZ()};
  move.to = {to, Vec3::UnitZ()};
  move.rapid = feed_mm_s == 0.0;
  move.feed_mm_s = feed_mm_s;
  move.duration_s = move.rapid ? 0.0 : (to - from).norm() / feed_mm_s;
  move.spindle_rpm = 3000.0;
  move.tool = 0;
  move.line = line;
  move.column = 1;
  return move;
}

program::NcSummary summary() {
  program::NcSummary read;
  read.files = {"part.mpf", "sub.spf"};
  return read;
}

struct Made {
  NcPath nc;
  Diagnostics diagnostics;
};

Made make(const std::vector<NcMove>& moves) {
  NcPathSink sink;
  for (const NcMove& move : moves) EXPECT_TRUE(sink.move(move));
  Made made;
  made.nc = sink.finish(summary(), made.diagnostics);
  return made;
}

BlockMove block(const Made& made, size_t i) {
  return made.nc.path.elements.block(i);
}

TEST(NcPath, EveryMoveIsABlockWithItsPlaceAndAxisValues) {
  NcMove cut = line({0, 0, 0}, {10, 0, 0}, 20.0, 7);
  cut.file = 1;
  cut.column = 5;
  cut.exact_stop = true;
  cut.corner_tolerance_mm = 0.02;
  const Made made = make({line({0, 0, 50}, {0, 0, 0}, 0.0, 3), cut});
  ASSERT_FALSE(made.diagnostics.has_errors());
  ASSERT_EQ(made.nc.path.elements.size(), 2U);
  EXPECT_TRUE(is_rapid(block(made, 0)));
  EXPECT_EQ(block(made, 0).pass, -1);
  EXPECT_FALSE(is_rapid(block(made, 1)));
  EXPECT_EQ(block(made, 1).pass, 0);
  EXPECT_EQ(block(made, 1).spindle_rpm, 3000.0);
  EXPECT_TRUE(block(made, 1).exact_stop);
  EXPECT_EQ(block(made, 1).corner_tolerance_mm, 0.02);
  ASSERT_TRUE(block(made, 1).axes);
  EXPECT_EQ(block(made, 1).axes->to, cut.q_to);
  const SourceLocation where = made.nc.path.elements.where(1);
  EXPECT_EQ(where.file, "sub.spf");
  EXPECT_EQ(where.line, 7);
  EXPECT_EQ(where.column, 5);
  EXPECT_EQ(made.nc.path.elements[0].where.file, "part.mpf");
  EXPECT_DOUBLE_EQ(made.nc.path.pass_length_mm, 10.0);
  EXPECT_DOUBLE_EQ(made.nc.path.link_length_mm, 50.0);
  EXPECT_EQ(made.nc.reading.rapids, 1);
  EXPECT_EQ(made.nc.reading.feed_moves_by_law[static_cast<size_t>(BlockLaw::kJoint)], 1);
}

TEST(NcPath, InverseTimeIsNoRapid) {
  NcMove cut = line({0, 0, 0}, {10, 0, 0}, 20.0, 7);
  cut.feed_mm_s = 0.0;  // G93
  const Made made = make({cut});
  EXPECT_FALSE(is_rapid(block(made, 0)));
  EXPECT_EQ(block(made, 0).pass, 0);
}

TEST(NcPath, AnArcOfStandingRotariesKeepsItsShape) {
  NcMove cut = line({10, 0, 0}, {0, 10, 0}, 20.0, 7);
  cut.arc = program::Arc{Vec3::Zero(), Vec3::UnitZ()};
  const Made made = make({cut});
  ASSERT_TRUE(block(made, 0).arc);
  EXPECT_EQ(block(made, 0).law, BlockLaw::kTcpAxes);
  EXPECT_EQ(made.nc.reading.feed_moves_by_law[static_cast<size_t>(BlockLaw::kJoint)], 1);
  EXPECT_NEAR(made.nc.path.pass_length_mm, 5.0 * 3.14159265358979, 1e-9);
}

TEST(NcPath, PassesPartAtRapidsCornersAndTools) {
  NcMove other = line({20, 0, 0}, {30, 0, 0}, 20.0, 4);
  other.tool = 1;
  NcMove back = line({30, 0, 0}, {30, 5, 0}, 20.0, 5);
  back.tool = 1;
  const Made made =
      make({line({0, 0, 0}, {10, 0, 0}, 20.0, 2), line({10, 0, 0}, {20, 1, 0}, 20.0, 3), other, back});
  EXPECT_EQ(block(made, 0).pass, 0);
  EXPECT_EQ(block(made, 1).pass, 0);
  EXPECT_EQ(block(made, 2).pass, 1) << "another tool";
  EXPECT_EQ(block(made, 3).pass, 2) << "a corner of 90 degrees";
  EXPECT_EQ(made.nc.path.passes, 3);
}

TEST(NcPath, DwellsOfMovesThatGoNowhereAreKept) {
  NcMove stand = line({0, 0, 0}, {0, 0, 0}, 20.0, 2);
  stand.dwell_s = 1.5;
  NcMove cut = line({0, 0, 0}, {10, 0, 0}, 20.0, 3);
  cut.dwell_s = 0.25;
  const Made made = make({stand, cut});
  ASSERT_EQ(made.nc.path.elements.size(), 1U);
  EXPECT_DOUBLE_EQ(block(made, 0).dwell_s, 1.75);
}

TEST(NcPath, RapidsBeforeTheFirstToolAreLeftOutAndCounted) {
  NcMove empty = line({0, 0, 100}, {0, 0, 50}, 0.0, 1);
  empty.tool = -1;
  const Made made = make({empty, line({0, 0, 20}, {10, 0, 0}, 20.0, 3)});
  EXPECT_FALSE(made.diagnostics.has_errors());
  EXPECT_EQ(made.nc.path.elements.size(), 1U);
  EXPECT_EQ(made.nc.reading.moves_without_tool, 1);
}

TEST(NcPath, NothingIsCutWithAnEmptySpindle) {
  NcMove empty = line({0, 0, 0}, {10, 0, 0}, 20.0, 4);
  empty.tool = -1;
  const NcMove cut = line({0, 0, 20}, {10, 0, 0}, 20.0, 3);
  NcMove leave = line({10, 0, 0}, {10, 0, 50}, 0.0, 5);
  leave.tool = -1;
  for (const std::vector<NcMove>& moves : {std::vector<NcMove>{empty}, std::vector<NcMove>{cut, leave}}) {
    const Made made = make(moves);
    ASSERT_EQ(made.diagnostics.list().size(), 1U);
    EXPECT_EQ(made.diagnostics.list()[0].code, "no-tool-in-spindle");
    EXPECT_EQ(made.diagnostics.list()[0].where.line, moves.back().line);
  }
}

TEST(NcPath, AProgramWithoutMotionIsNoJob) {
  const Made made = make({});
  ASSERT_EQ(made.diagnostics.list().size(), 1U);
  EXPECT_EQ(made.diagnostics.list()[0].code, "no-motion");
}

}  // namespace
}  // namespace swarf::toolpath::nc_path_test
