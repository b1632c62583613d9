// CL data with other positions: the user's own text but for them.
#include <gtest/gtest.h>

#include "program/cl/rewrite.h"

namespace {

using namespace swarf;

const ToolPose kNew{Vec3(25.4, 2, 3), Vec3(0.6, 0, 0.8)};

std::string rewritten(const std::string& text, const std::map<int, ToolPose>& changed) {
  return program::rewrite_cl(text, "part.cl", changed);
}

program::ClProgram parsed(const std::string& text) {
  Diagnostics diagnostics;
  program::ClProgram program = program::parse_cl(text, "part.cl", diagnostics);
  EXPECT_FALSE(diagnostics.has_errors());
  return program;
}

TEST(ClRewrite, LeavesEverythingElseToTheByte) {
  const std::string head = "PARTNO/A  B\r\n$$ own comment\r\nUNITS/MM\r\nFEDRAT/100,MMPM\r\nGOTO/0,0,0\r\n";
  const std::string text =
      rewritten(head + "  GOTO/1,2,3 $$ here\r\nGOTO/4,5,6,0,0,1\r\nFINI\r\n", {{6, kNew}});
  EXPECT_EQ(text,
            head +
                "  GOTO/25.400000000,2.000000000,3.000000000,0.600000000,0.000000000,0.800000000 $$ here\r\n"
                "GOTO/4,5,6,0,0,1\r\nFINI\r\n");
}

/// What took the axis over from the changed statement says its own now.
TEST(ClRewrite, KeepsTheAxisOfWhatFollows) {
  const std::string text =
      rewritten("FEDRAT/100,MMPM\nGOTO/0,0,0\nGOTO/1,2,3\nGOTO/4,5,6\nGOTO/7,8,9\nFINI\n", {{3, kNew}});
  const program::ClProgram program = parsed(text);
  EXPECT_EQ(program.moves[0].to.axis_W, kNew.axis_W);
  EXPECT_EQ(program.moves[1].to.axis_W, Vec3::UnitZ());
  EXPECT_EQ(program.moves[2].to.axis_W, Vec3::UnitZ());
  EXPECT_NE(text.find("GOTO/7,8,9\n"), std::string::npos);
}

/// In the file's own unit and system; continued lines become empty ones.
TEST(ClRewrite, SpeaksTheFilesOwnCoordinates) {
  const std::string text = rewritten(
      "UNITS/INCHES\nFEDRAT/10,IPM\nMSYS/1,0,0,0,1,0,-1,0,0\nGOTO/0,0,0\nGOTO/1, $\n 2, $\n 3,0,0,1\nFINI\n",
      {{5, kNew}});
  const program::ClProgram program = parsed(text);
  EXPECT_LT((program.moves[0].to.tip_W - kNew.tip_W).norm(), 1e-6);
  EXPECT_LT((program.moves[0].to.axis_W - kNew.axis_W).norm(), 1e-8);
  EXPECT_EQ(program.moves[0].line, 5);
  EXPECT_NE(text.find("\n\n\nFINI"), std::string::npos) << text;
  EXPECT_EQ(program::positions_of(text, "part.cl").size(), 2U);
}

TEST(ClRewrite, RefusesWhatAnotherWordHolds) {
  const auto refused = [](const std::string& text, int line) {
    try {
      rewritten(text, {{line, kNew}});
      return std::string("written");
    } catch (const InputError& error) {
      return error.diagnostics.list().front().code;
    }
  };
  const std::string head = "$$ SWARF CL DATA\nFEDRAT/100,MMPM\nGOTO/5,0,0\n";
  EXPECT_EQ(refused(head + "CIRCLE/0,0,0,0,0,1,5\nGOTO/0,5,0\nFINI\n", 5), "block-fixed");
  EXPECT_EQ(refused(head + "GODLTA/1,0,0\nFINI\n", 4), "block-fixed");
  EXPECT_EQ(refused(head + "GOTO/6,0,0\nGODLTA/1,0,0\nFINI\n", 4), "block-fixed");  // it moves from there
  EXPECT_EQ(refused(head + "CYCLE/DRILL,DEPTH,5,CLEAR,2,MMPM,120\nGOTO/6,0,0\nCYCLE/OFF\nFINI\n", 5),
            "block-fixed");
  EXPECT_EQ(refused(head + "GOTO/6,0,0\nFINI\n", 4), "written");
}

}  // namespace
