#include "toolpath/cl_path.h"

#include <gtest/gtest.h>

#include "base/units.h"

namespace swarf::toolpath {
namespace {

ToolPath path_of(const std::string& text, BlockLaw law, Diagnostics& diagnostics) {
  const program::ClProgram program = program::parse_cl(text, "test.cl", diagnostics, {{}, true, {}});
  return cl_path(program, law, diagnostics);
}

TEST(ClPath, OneBlockPerMoveAndNoneForAMoveThatChangesNothing) {
  Diagnostics diagnostics;
  const ToolPath path = path_of("FEDRAT/60\nGOTO/0,0,0\nGOTO/3,4,0\nGOTO/3,4,0\nRAPID\nGOTO/3,4,10\n",
                                BlockLaw::kTcp, diagnostics);
  ASSERT_EQ(path.elements.size(), 2U);
  EXPECT_TRUE(holds_blocks(path));
  EXPECT_EQ(path.elements[1].where.line, 6);
  EXPECT_DOUBLE_EQ(path.pass_length_mm, 5.0);
  EXPECT_DOUBLE_EQ(path.link_length_mm, 10.0);
}

TEST(ClPath, PassesEndAtRapidsAndCorners) {
  Diagnostics diagnostics;
  // A zigzag: two rows and the step between them, then a row after a rapid.
  const ToolPath path = path_of(
      "FEDRAT/60\nGOTO/0,0,0\nGOTO/5,0,0\nGOTO/10,1,0\nGOTO/10,2,0\nGOTO/0,2,0\nRAPID\nGOTO/0,4,0\nGOTO/"
      "9,4,0\n",
      BlockLaw::kTcp, diagnostics);
  std::vector<int> passes;
  for (const Element& element : path.elements) passes.push_back(std::get<BlockMove>(element.what).pass);
  EXPECT_EQ(passes, (std::vector<int>{0, 0, 1, 2, -1, 3}));
  EXPECT_EQ(path.passes, 4);
}

TEST(ClPath, AWholeCircleAndTheLongWayRound) {
  Diagnostics diagnostics;
  const ToolPath path = path_of(
      "FEDRAT/60\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0\n",
      BlockLaw::kTcp, diagnostics);
  ASSERT_EQ(path.elements.size(), 2U);
  EXPECT_DOUBLE_EQ(arc_angle(std::get<BlockMove>(path.elements[0].what)), 2 * kPi);
  EXPECT_NEAR(arc_angle(std::get<BlockMove>(path.elements[1].what)), 1.5 * kPi, 1e-12);
}

TEST(ClPath, RefusesWhatALawDoesNotSay) {
  const std::string arc = "FEDRAT/60\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0\n";
  const std::string reversal = "MULTAX/ON\nFEDRAT/60\nGOTO/0,0,0,0,0,1\nGOTO/1,0,0,0,0,-1\n";
  const auto first_code = [](const std::string& text, BlockLaw law) {
    Diagnostics diagnostics;
    path_of(text, law, diagnostics);
    return diagnostics.list().empty() ? std::string() : diagnostics.list().front().code;
  };
  EXPECT_EQ(first_code(arc, BlockLaw::kTcp), "");
  EXPECT_EQ(first_code(arc, BlockLaw::kJoint), "arc-needs-tcp");
  EXPECT_EQ(first_code(arc, BlockLaw::kEnds), "arc-needs-tcp");
  EXPECT_EQ(first_code(reversal, BlockLaw::kTcp), "axis-reversed");
  EXPECT_EQ(first_code(reversal, BlockLaw::kEnds), "axis-reversed");
  EXPECT_EQ(first_code(reversal, BlockLaw::kJoint), "");
}

}  // namespace
}  // namespace swarf::toolpath
