#include <limits>

#include "base/rng.h"
#include "unit/program/cl_support.h"

namespace swarf::program::cl_reader_test {
namespace {

TEST(ClReader, MovesFromTheFirstCompletePosition) {
  const ClProgram p = read_cl_clean(
      "PARTNO/bracket, left\nUNITS/MM\nLOADTL/3\nCUTTER/10,0\nSPINDL/8000,CLW\nCOOLNT/ON\nMULTAX/ON\n"
      "RAPID\nGOTO/1,2,3,0,0,1\nFEDRAT/600,MMPM\nGOTO/4,5,6\nGODLTA/0,0,-1\nRAPID\nGOTO/"
      "0,0,50,0,0.6,0.8\nFINI\n");
  EXPECT_EQ(p.start_line, 9);
  EXPECT_EQ(p.start.tip_W, Vec3(1, 2, 3));
  ASSERT_EQ(p.moves.size(), 3U);
  EXPECT_EQ(p.moves[0].from.tip_W, Vec3(1, 2, 3));
  EXPECT_EQ(p.moves[0].to.axis_W, Vec3::UnitZ()) << "three numbers keep the axis";
  EXPECT_DOUBLE_EQ(p.moves[0].feed_mm_s, 10.0);
  EXPECT_EQ(p.moves[0].line, 11);
  EXPECT_EQ(p.moves[1].to.tip_W, Vec3(4, 5, 5));
  EXPECT_EQ(p.moves[2].feed_mm_s, 0.0);
  EXPECT_LT((p.moves[2].to.axis_W - Vec3(0, 0.6, 0.8)).norm(), 1e-15);
  ASSERT_EQ(p.moves[2].tool, 0);
  EXPECT_EQ(p.tools[0].number, 3);
  EXPECT_DOUBLE_EQ(p.moves[2].spindle_rpm, 8000.0);
  ASSERT_EQ(p.notes.size(), 2U);
  EXPECT_EQ(p.notes[0].text, "bracket, left");
}

TEST(ClReader, RapidHoldsForOneMove) {
  const ClProgram p = read_cl_clean("FEDRAT/60\nFROM/0,0,0\nRAPID\nGOTO/1,0,0\nGOTO/2,0,0\n");
  EXPECT_EQ(p.moves[0].feed_mm_s, 0.0);
  EXPECT_EQ(p.moves[1].feed_mm_s, 1.0);
}

TEST(ClReader, ContinuationCommentsBlanksAndSmallLetters) {
  const ClProgram p = read_cl_clean(
      "$$ a comment\r\n  multax / on $$ another\r\nfedrat/100\r\nGOTO / 1.5, +2, $ the rest follows\r\n"
      "  -3E0, 0, $\r\n 0,1\r\nGOTO/2,2,2\r\n\r\n");
  ASSERT_EQ(p.moves.size(), 1U);
  EXPECT_EQ(p.moves[0].from.tip_W, Vec3(1.5, 2, -3));
  EXPECT_EQ(p.moves[0].line, 7);
}

TEST(ClReader, AnArcStaysAnArc) {
  const ClProgram p = read_cl_clean(
      "FEDRAT/100\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,-1,10,0.005,0.5,10,0\nGOTO/0,10,0\nGOTO/0,0,0\n");
  ASSERT_EQ(p.moves.size(), 2U);
  ASSERT_TRUE(p.moves[0].arc);
  EXPECT_EQ(p.moves[0].arc->normal_W, Vec3(0, 0, 1)) << "clockwise about (0,0,-1)";
  EXPECT_FALSE(p.moves[1].arc);
}

TEST(ClReader, MultaxOffTurnsTheToolBackInTheNextMove) {
  const ClProgram p =
      read_cl_clean("MULTAX/ON\nFEDRAT/100\nGOTO/0,0,0,0,0.6,0.8\nGOTO/1,0,0\nMULTAX/OFF\nGOTO/2,0,0\n");
  EXPECT_LT((p.moves[1].from.axis_W - Vec3(0, 0.6, 0.8)).norm(), 1e-15);
  EXPECT_EQ(p.moves[1].to.axis_W, Vec3::UnitZ());
}

TEST(ClReader, NormalisesAxesThatAreUnitWithinRounding) {
  const ClProgram p = read_cl_clean("MULTAX/ON\nFEDRAT/100\nGOTO/0,0,0,0,0.6,0.80005\nGOTO/1,0,0\n");
  EXPECT_NEAR(p.start.axis_W.norm(), 1.0, 1e-15);
}

TEST(ClReader, PositionsFollowTheSystem) {
  // X of the system runs along Y of the work, its Z along X.
  const ClProgram p = read_cl_clean(
      "FEDRAT/60\nMSYS/10,20,30, 0,1,0, 0,0,1\nGOTO/1,2,3\nGOTO/1,2,4,0,0.6,0.8\nGODLTA/1,0,0\n"
      "MSYS/0,0,0,1,0,0,0,1,0\nGOTO/5,5,5,0,0,1\n");
  ASSERT_EQ(p.moves.size(), 3U);
  EXPECT_LT((p.start.tip_W - Vec3(13, 21, 32)).norm(), 1e-12);
  EXPECT_LT((p.moves[0].to.axis_W - Vec3(0.8, 0, 0.6)).norm(), 1e-12);
  EXPECT_LT((p.moves[1].to.tip_W - Vec3(14, 22, 32)).norm(), 1e-12);
  EXPECT_EQ(p.moves[2].to.tip_W, Vec3(5, 5, 5));
}

TEST(ClReader, InchesAreConvertedOnce) {
  const ClProgram p = read_cl_clean(
      "UNITS/INCHES\nFEDRAT/10,IPM\nCUTTER/0.5,0.125,0,0,10,5,2\nGOTO/0,0,1\nGOTO/1,0,1\nFEDRAT/60,MMPM\n"
      "CIRCLE/2,0,1,0,0,-1,1\nGOTO/2,-1,1\n");
  EXPECT_DOUBLE_EQ(p.moves[0].to.tip_W.x(), 25.4);
  EXPECT_DOUBLE_EQ(p.moves[0].feed_mm_s, 254.0 / 60.0);
  EXPECT_DOUBLE_EQ(p.moves[1].feed_mm_s, 1.0);
  EXPECT_EQ(p.cutters[0].parameters, (std::vector<double>{12.7, 3.175, 0, 0, 10, 5, 50.8}));
}

TEST(ClReader, FeedPerRevolutionAndCounterClockwise) {
  const ClProgram p = read_cl_clean("SPINDL/RPM,600,CCLW\nFEDRAT/0.1,MMPR\nGOTO/0,0,0\nGOTO/1,0,0\n");
  EXPECT_DOUBLE_EQ(p.moves[0].feed_mm_s, 1.0);
  EXPECT_DOUBLE_EQ(p.moves[0].spindle_rpm, -600.0);
}

TEST(ClReader, ToolsByNumberAndByName) {
  const ClProgram p = read_cl_clean(
      "TOOL PATH/FINISH A,TOOL,20MM, LONG \nTLDATA/MILL,20.0,1.0,75,0,0\nFEDRAT/9\nGOTO/0,0,0\nGOTO/1,0,0\n"
      "SELECT/TOOL,7\nLOAD/TOOL,7,ADJUST,3\nDELAY/1.5\nGOTO/2,0,0\nLOADTL/7,OSETNO,2\nGOTO/3,0,0\n");
  ASSERT_EQ(p.tools.size(), 2U);
  EXPECT_EQ(p.tools[0].name, "20MM, LONG");
  EXPECT_EQ(p.tools[1].number, 7);
  EXPECT_EQ(p.moves[0].tool, 0);
  EXPECT_EQ(p.moves[1].tool, 1);
  EXPECT_EQ(p.moves[2].tool, 1);
  EXPECT_DOUBLE_EQ(p.moves[1].dwell_s, 1.5);
  EXPECT_DOUBLE_EQ(p.moves[2].dwell_s, 0.0);
  EXPECT_EQ(p.cutters[0].parameters, (std::vector<double>{20, 1}));
}

std::string heights(const ClProgram& p) {
  std::string text;
  for (const Move& move : p.moves) {
    text += move.feed_mm_s == 0.0 ? 'r' : 'f';
    text += std::to_string(move.to.tip_W.z()).substr(0, 5);
    text += ' ';
  }
  return text;
}

TEST(ClReader, DrillingCycles) {
  const std::string before = "FEDRAT/60\nGOTO/0,0,50\n",
                    after = "GOTO/5,0,10\nCYCLE/OFF\nRAPID\nGOTO/0,0,50\n";
  const auto run = [&](const std::string& cycle) { return heights(read_cl_clean(before + cycle + after)); };
  EXPECT_EQ(run("CYCLE/DRILL,DEPTH,8,MMPM,100,CLEAR,2\n"), "r12.00 f2.000 r12.00 r50.00 ");
  EXPECT_EQ(run("CYCLE/DRILL,RAPTO,2,FEDTO,-8,RTRCTO,20\n"), "r12.00 f2.000 r30.00 r50.00 ");
  EXPECT_EQ(run("CYCLE/BORE,DEPTH,8,CLEAR,2\n"), "r12.00 f2.000 f12.00 r50.00 ");
  EXPECT_EQ(run("CYCLE/DEEP,DEPTH,5,CLEAR,2,STEP,3\n"), "r12.00 f7.000 r12.00 r7.500 f5.000 r12.00 r50.00 ");
  EXPECT_EQ(run("CYCLE/BRKCHP,DEPTH,5,CLEAR,2,STEP,3\n"), "r12.00 f7.000 r7.500 f5.000 r12.00 r50.00 ");
}

TEST(ClReader, HolesAlongALeaningAxis) {
  const ClProgram p = read_cl_clean(
      "MULTAX/ON\nGOTO/0,0,50,0,0,1\nCYCLE/DRILL,DEPTH,10,MMPM,60,CLEAR,5,DWELL,0.5\nGOTO/1,2,3,0,0.6,0.8\n");
  ASSERT_EQ(p.moves.size(), 3U);
  EXPECT_LT((p.moves[0].to.tip_W - Vec3(1, 5, 7)).norm(), 1e-12);
  EXPECT_LT((p.moves[1].to.tip_W - Vec3(1, -4, -5)).norm(), 1e-12);
  EXPECT_DOUBLE_EQ(p.moves[2].dwell_s, 0.5);
}

struct BadProgram {
  const char* name;
  const char* text;
  const char* place;  ///< "code line:column" of the first problem
  const char* says = "";
};
void PrintTo(const BadProgram& bad, std::ostream* out) {
  *out << bad.name;
}

class BadCl : public testing::TestWithParam<BadProgram> {};

TEST_P(BadCl, IsRefusedWhereItIsWrong) {
  Diagnostics diagnostics;
  parse_cl(GetParam().text, "test.cl", diagnostics, as_nx());
  ASSERT_TRUE(diagnostics.has_errors());
  EXPECT_EQ(places(diagnostics).front(), GetParam().place) << all_text(diagnostics);
  EXPECT_NE(all_text(diagnostics).find(GetParam().says), std::string::npos) << all_text(diagnostics);
}

const BadProgram kBad[] = {
    {"empty", " \n", "empty-file 0:0"},
    {"unknown_word", "FEDRAT/1\nGOTO/0,0,0\n  GOTOO/1,2,3\n", "unknown-word 3:3", "did you mean GOTO?"},
    {"unsupported_word", "ROTABL/1\n", "unsupported-word 1:1"},
    {"not_a_statement", "FEDRAT/1\n123,4\n", "bad-statement 2:1"},
    {"no_slash", "GOTO 1,2,3\n", "bad-statement 1:6"},
    {"empty_argument", "GOTO/1,,3\n", "bad-statement 1:8"},
    {"last_argument_empty", "GOTO/1,2,\n", "bad-statement 1:10"},
    {"no_arguments", "GOTO/\n", "bad-statement 1:6"},
    {"nan", "GOTO/1,nan,3\n", "bad-number 1:8"},
    {"nan_capitals", "GOTO/1,NaN,3\n", "bad-number 1:8"},
    {"infinite", "GOTO/1,1e999,3\n", "bad-number 1:8"},
    {"half_a_number", "GOTO/1,2x,3\n", "bad-number 1:8"},
    {"word_for_number", "GOTO/1,TWO,3\n", "wrong-arguments 1:8"},
    {"four_numbers", "GOTO/1,2,3,4\n", "wrong-arguments 1:1"},
    {"ends_after_dollar", "GOTO/1,2,$\n", "bad-statement 1:1"},
    {"axis_too_long", "MULTAX/ON\nGOTO/1,2,3,0,0,1.001\n", "axis-not-unit 2:12", "length 1.001"},
    {"axis_zero", "MULTAX/ON\nGOTO/1,2,3,0,0,0\n", "axis-not-unit 2:12"},
    {"axis_missing", "MULTAX/ON\nGOTO/1,2,3\n", "missing-axis 2:1"},
    {"delta_first", "GODLTA/1,2,3\n", "no-position 1:1"},
    {"no_feed", "GOTO/0,0,0\nGOTO/1,2,3\n", "missing-feed 2:1"},
    {"feed_zero", "FEDRAT/0,MMPM\n", "out-of-range 1:8"},
    {"feed_word", "FEDRAT/10,FAST\n", "unsupported-word 1:11"},
    {"feed_per_revolution", "FEDRAT/0.1,MMPR\n", "missing-spindle 1:8"},
    {"feed_without_number", "FEDRAT/MMPM\n", "wrong-arguments 1:1"},
    {"units", "UNITS/FEET\n", "unsupported-word 1:1"},
    {"units_late", "GOTO/1,2,3\nUNITS/INCHES\n", "unsupported-word 2:1"},
    {"cycle_word", "CYCLE/DRILL,5\n", "wrong-arguments 1:1"},
    {"cycle_kind", "CYCLE/KNIT,DEPTH,5\n", "unsupported-word 1:1"},
    {"cycle_key", "CYCLE/DRILL,DEPTH,5,TINT,2\n", "unsupported-word 1:21"},
    {"cycle_depth", "CYCLE/DRILL,FEDTO,5,CLEAR,2,MMPM,100\n", "bad-cycle 1:1", "its depth is -5 mm"},
    {"cycle_clearance", "CYCLE/DRILL,DEPTH,5,MMPM,100\n", "bad-cycle 1:1", "clearance is 0 mm"},
    {"cycle_feed", "CYCLE/DRILL,DEPTH,5,CLEAR,1\n", "bad-cycle 1:1", "no feed"},
    {"cycle_step", "CYCLE/DEEP,DEPTH,5,CLEAR,1,MMPM,100\n", "bad-cycle 1:1", "its step is 0 mm"},
    {"cycle_retract", "CYCLE/DRILL,DEPTH,5,CLEAR,3,RTRCTO,1,MMPM,9\n", "bad-cycle 1:1",
     "below its clearance"},
    {"cycle_feed_zero", "CYCLE/DRILL,DEPTH,5,CLEAR,3,MMPM,0\n", "out-of-range 1:34"},
    {"arc_in_cycle",
     "FEDRAT/9\nGOTO/10,0,0\nCYCLE/DRILL,DEPTH,5,CLEAR,3\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0\n",
     "bad-arc 4:1"},
    {"delay_negative", "DELAY/-1\n", "out-of-range 1:7"},
    {"system_skew", "MSYS/0,0,0,1,0,0,0.6,0.8,0\n", "out-of-range 1:18"},
    {"system_short", "MSYS/0,0,0\n", "wrong-arguments 1:1"},
    {"system_not_unit", "CSYS/0,0,0,2,0,0,0,1,0\n", "axis-not-unit 1:12"},
    {"tool_path_without_tool", "TOOL PATH/ROUGH\n", "wrong-arguments 1:1"},
    {"tool_data_kind", "TLDATA/TCUTTER,10,1\n", "unsupported-word 1:1"},
    {"tool_data_word", "TLDATA/MILL,TEN\n", "wrong-arguments 1:13"},
    {"load_what", "LOAD/PALLET,1\n", "wrong-arguments 1:1"},
    {"compensation", "CUTCOM/LEFT\n", "cutcom-meaning 1:1"},
    {"incremental", "SET/MODE,INCR\n", "unsupported-word 1:1"},
    {"from_late", "GOTO/0,0,0\nFROM/1,1,1\n", "from-not-first 2:1"},
    {"rapid_with_argument", "RAPID/5\n", "wrong-arguments 1:7"},
    {"multax_maybe", "MULTAX/MAYBE\n", "wrong-arguments 1:1"},
    {"tool_nothing", "LOADTL/X\n", "wrong-arguments 1:1"},
    {"tool_half", "LOADTL/1.5\n", "wrong-arguments 1:1"},
    {"cutter_empty", "CUTTER\n", "wrong-arguments 1:1"},
    {"cutter_eight", "CUTTER/1,2,3,4,5,6,7,8\n", "wrong-arguments 1:1"},
    {"spindle_word", "SPINDL/100,SLOWLY\n", "unsupported-word 1:12"},
    {"spindle_negative", "SPINDL/-5\n", "out-of-range 1:8"},
    {"after_end", "FEDRAT/9\nGOTO/0,0,0\nGOTO/1,0,0\nFINI\nGOTO/0,0,0\n", "word-after-end 5:1"},
    {"one_position", "GOTO/0,0,0\n", "no-motion 0:0"},
    {"no_position", "UNITS/MM\n", "no-motion 0:0"},
    {"circle_short", "CIRCLE/0,0,0,0,1\n", "wrong-arguments 1:1"},
    {"circle_axis", "CIRCLE/0,0,0,0,0,2,10\n", "axis-not-unit 1:14"},
    {"circle_radius", "CIRCLE/0,0,0,0,0,1,0\n", "out-of-range 1:20"},
    {"arc_off_circle", "FEDRAT/9\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,11,0\n", "bad-arc 4:1",
     "11.0000"},
    {"arc_off_plane", "FEDRAT/9\nGOTO/10,0,1\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,1\n", "bad-arc 4:1"},
    {"arc_first", "FEDRAT/9\nCIRCLE/0,0,0,0,0,1,10\nGOTO/10,0,0\nGOTO/0,0,0\n", "no-position 3:1"},
    {"arc_rapid", "GOTO/10,0,0\nRAPID\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0\n", "bad-arc 4:1"},
};
INSTANTIATE_TEST_SUITE_P(Programs, BadCl, testing::ValuesIn(kBad),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(ClReader, RandomBytesNeverCrashIt) {
  Rng rng(3);
  const std::string pieces[] = {"GOTO/",   "1",         ",",     "$", "$$", "\n",      "-",
                                ".5E",     "MULTAX/ON", "FROM/", " ", "/",  "CIRCLE/", "0,0,1",
                                "FEDRAT/", "RAPID",     "FINI",  "x", "\t", "PPRINT "};
  for (int trial = 0; trial < 3000; ++trial) {
    std::string text;
    for (int i = 0; i < 30; ++i) text += pieces[rng.next() % std::size(pieces)];
    Diagnostics diagnostics;
    const ClProgram p = parse_cl(text, "test.cl", diagnostics, as_nx());
    if (diagnostics.has_errors()) continue;
    for (const Move& move : p.moves) {
      ASSERT_TRUE(move.to.tip_W.allFinite()) << text;
      ASSERT_NEAR(move.to.axis_W.norm(), 1.0, 1e-12) << text;
    }
  }
}

TEST(ClReader, RandomStatementsNeverCrashIt) {
  const std::string pieces[] = {"GOTO/1,2,3\n",
                                "GOTO/4,2,3\n",
                                "GOTO/1,2,3,0,0,1\n",
                                "GOTO/-5,0,0,0,5,0,5,0,0\n",
                                "GODLTA/9,0,0\n",
                                "CIRCLE/0,2,3,0,0,1,1\n",
                                "CIRCLE/2.5,2,3,0,0,1,1.5,TIMES,1.5\n",
                                "INDIRV/0,1,0\n",
                                "INDIRP/1,9,3\n",
                                "TLON,GOFWD/(CIRCLE/2.5,2,3,1.5),ON,(LINE/2.5,2,3,4,2,3)\n",
                                "TLON,GOFWD/(CIRCLE/2.5,2,3,1.5),ON,2,INTOF,(LINE/2.5,2,3,1,2,3)\n",
                                "PSIS/(PLANE/0,0,1,3)\n",
                                "AUTOPS\n",
                                "CUTCOM/LEFT\n",
                                "CUTCOM/RIGHT,2,YZPLAN\n",
                                "CUTCOM/ON\n",
                                "CUTCOM/OFF\n",
                                "CUTTER/1.5\n",
                                "LOADTL/2\n",
                                "RAPID\n",
                                "GOHOME\n",
                                "RETRCT\n",
                                "CLEARP/XYPLAN,9\n",
                                "CLEARP/OFF\n",
                                "TRANS/1,1,1\n",
                                "ORIGIN/2,0,0\n",
                                "MSYS/1,0,0,0,1,0,0,0,1\n",
                                "$$*CATIA0\n$$ A\n$$ 0 1 0 5\n$$ 0 0 1 0\n$$ 1 0 0 0\n",
                                "$$*CATIA0\n",
                                "$$-> CSYS / 1,0,0,0,0,1,0,0,$\n0,0,1,0\n",
                                "$$-> CUTTER / 3\n",
                                "MULTAX/ON\n",
                                "MULTAX/OFF\n",
                                "TLAXIS/0,1,0\n",
                                "CYCLE/DRILL,RAPTO,3,FEDTO,-8,RTRCTO,AUTO\n",
                                "CYCLE/DEEP,DEPTH,5,CLEAR,2,STEP,3\n",
                                "CYCLE/OFF\n",
                                "DELAY/2\n",
                                "FEDRAT/9\n"};
  int clean = 0;
  for (uint64_t seed = 1; seed <= 6000; ++seed) {
    Rng rng(seed);
    std::string text = "FEDRAT/9\nCUTTER/1\n";
    for (int i = 0; i < 2 + static_cast<int>(seed % 8); ++i) text += pieces[rng.next() % std::size(pieces)];
    ClOptions options = as_nx();
    options.cutcom = seed % 3 == 0 ? ClPoints::kCentre : ClPoints::kContour;
    Diagnostics diagnostics;
    const ClProgram p = parse_cl(text, "test.cl", diagnostics, options);
    if (diagnostics.has_errors()) {
      for (const Diagnostic& one : diagnostics.list()) ASSERT_FALSE(one.fix.empty()) << format(one) << text;
      continue;
    }
    ++clean;
    for (size_t i = 0; i < p.moves.size(); ++i) {
      ASSERT_TRUE(p.moves[i].to.tip_W.allFinite()) << "seed " << seed << ":\n" << text;
      ASSERT_NEAR(p.moves[i].to.axis_W.norm(), 1.0, 1e-12) << "seed " << seed << ":\n" << text;
      const Vec3 before = i == 0 ? p.start.tip_W : p.moves[i - 1].to.tip_W;
      ASSERT_LT((p.moves[i].from.tip_W - before).norm(), 1e-9) << "seed " << seed << ":\n" << text;
    }
  }
  EXPECT_GT(clean, 100) << "else nothing was tested";
}

TEST(ClReader, AHundredThousandBlocks) {
  std::string text = "MULTAX/ON\nFEDRAT/1000,MMPM\n";
  for (int i = 0; i < 100000; ++i) {
    text +=
        "GOTO/" + std::to_string(0.001 * i) + ",20.123456,-3.654321,0.000000000,0.600000000,0.800000000\n";
  }
  Diagnostics diagnostics;
  const ClProgram p = parse_cl(text, "test.cl", diagnostics, as_nx());
  EXPECT_EQ(p.moves.size(), 99999U);
}

}  // namespace
}  // namespace swarf::program::cl_reader_test
