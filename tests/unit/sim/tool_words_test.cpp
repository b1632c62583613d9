// Tools in a word each, against what the words say.
#include "sim/job/tool_words.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/units.h"

namespace swarf::sim::tool_words_test {
namespace {

using cutter::Cutter;
using cutter::Shape;

std::vector<Cutter> read(const std::string& list) {
  Diagnostics diagnostics;
  std::vector<Cutter> tools = read_tool_words(list, {"test"}, diagnostics);
  diagnostics.throw_if_errors();
  return tools;
}

TEST(ToolWords, EachShape) {
  const std::vector<Cutter> tools =
      read("T1=6, T2=ball4,T3=drill5,T4=bull10r1,T12=chamfer8a90,T6=0.25in,FACE_63=flat63,t8=drill3a140");
  ASSERT_EQ(tools.size(), 8U);
  EXPECT_EQ(tools[0].shape, Shape::kFlat);
  EXPECT_EQ(tools[0].diameter_mm, 6.0);
  EXPECT_EQ(tools[1].shape, Shape::kBall);
  EXPECT_EQ(tools[1].corner_radius_mm, 2.0);
  EXPECT_EQ(tools[2].shape, Shape::kDrill);
  EXPECT_NEAR(tools[2].point_angle_rad, rad_from_deg(118.0), 1e-15);
  EXPECT_EQ(tools[3].shape, Shape::kBullNose);
  EXPECT_EQ(tools[3].corner_radius_mm, 1.0);
  EXPECT_EQ(tools[4].number, 12);
  EXPECT_EQ(tools[4].shape, Shape::kChamfer);
  EXPECT_EQ(tools[5].diameter_mm, 6.35);
  EXPECT_EQ(tools[6].name, "FACE_63");
  EXPECT_EQ(tools[6].number, 0);
  EXPECT_EQ(tools[7].number, 8);
  EXPECT_NEAR(tools[7].point_angle_rad, rad_from_deg(140.0), 1e-15);
  for (const Cutter& tool : tools) {
    EXPECT_TRUE(cutter::validate(tool).empty()) << cutter::describe(tool);
    EXPECT_TRUE(is_bare(tool));
    EXPECT_EQ(cutter::gauge_length(tool), 60.0 + 2.0 * tool.diameter_mm);
  }
}

TEST(ToolWords, OneMayGoWithoutANumber) {
  const std::vector<Cutter> tools = read("ball4mm");
  ASSERT_EQ(tools.size(), 1U);
  EXPECT_EQ(tools[0].number, 0);
  EXPECT_TRUE(tools[0].name.empty());
}

TEST(ToolWords, DigitsAloneAreTheNumber) {
  const std::vector<Cutter> tools = read("1=6,12=ball4");
  ASSERT_EQ(tools.size(), 2U);
  EXPECT_EQ(tools[0].number, 1);
  EXPECT_EQ(tools[1].number, 12);
}

TEST(ToolWords, ADiameterThatIsNoneIsToldOnce) {
  for (const char* list : {"T1=0", "T1=-6", "T1=1e9", "T1=100in"}) {
    Diagnostics diagnostics;
    EXPECT_TRUE(read_tool_words(list, {"test"}, diagnostics).empty()) << list;
    ASSERT_EQ(diagnostics.list().size(), 1U) << list;
    EXPECT_NE(diagnostics.list()[0].text.find("above 0 and at most 1000 mm"), std::string::npos) << list;
  }
}

TEST(ToolWords, AHolderIsNotBare) {
  EXPECT_FALSE(is_bare(Cutter{}));
}

TEST(ToolWords, WhatIsNoToolIsSaid) {
  for (const char* list : {"", "T1=", "T1=six", "6,4", "T1=bull10", "T1=bull10r9", "T1=0", "T1=-3", "=6",
                           "T1=6x", "T1=chamfer8", "T1=6,,T2=4", "T1=drill5a200", "T1=1e999", "T1=nan"}) {
    Diagnostics diagnostics;
    read_tool_words(list, {"test"}, diagnostics);
    EXPECT_TRUE(diagnostics.has_errors()) << list;
    for (const Diagnostic& one : diagnostics.list()) {
      EXPECT_EQ(one.code, "bad-tool-word") << list;
      EXPECT_NE(one.fix.find("T1=6"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace swarf::sim::tool_words_test
