// Tool libraries of Fusion and FreeCAD: files in the manner of each, and what each of their tools comes to.
#include "sim/job/tool_library.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/units.h"
#include "support/program_run.h"

namespace swarf::sim::tool_library_test {
namespace {

using cutter::Cutter;
using cutter::Shape;

const std::string kFolder = SWARF_SOURCE_DIR "/tests/data/tools/";

struct Read {
  std::vector<Cutter> tools;
  std::map<int, std::string> incomplete;
  bool lacks(int number, const std::string& words) const {
    const auto found = incomplete.find(number);
    return found != incomplete.end() && found->second.find(words) != std::string::npos;
  }
};

Read read(const std::string& file) {
  Read result;
  result.tools = read_tool_library(kFolder + file, result.incomplete);
  return result;
}

TEST(ToolLibrary, FusionInMillimetresAndInches) {
  const Read library = read("fusion.json");
  ASSERT_EQ(library.tools.size(), 4U);
  const Cutter& mill = library.tools[0];
  EXPECT_EQ(mill.number, 1);
  EXPECT_EQ(mill.shape, Shape::kFlat);
  EXPECT_EQ(mill.diameter_mm, 10.0);
  EXPECT_EQ(mill.flute_length_mm, 22.0);
  EXPECT_EQ(mill.length_mm, 40.0);
  ASSERT_EQ(mill.holder.size(), 2U);
  EXPECT_EQ(mill.holder[0].top_diameter_mm, 32.0);
  EXPECT_EQ(cutter::gauge_length(mill), 95.0);
  const Cutter& ball = library.tools[1];
  EXPECT_EQ(ball.shape, Shape::kBall);
  EXPECT_NEAR(ball.diameter_mm, 6.35, 1e-12);
  EXPECT_NEAR(ball.length_mm, 38.1, 1e-12);
  EXPECT_EQ(library.tools[2].shape, Shape::kBullNose);
  EXPECT_EQ(library.tools[2].corner_radius_mm, 1.5);
  EXPECT_EQ(library.tools[3].shape, Shape::kDrill);
  EXPECT_NEAR(library.tools[3].point_angle_rad, rad_from_deg(118.0), 1e-15);
}

TEST(ToolLibrary, WhatAFusionToolLacksIsKeptForItsCall) {
  const Read library = read("fusion.json");
  EXPECT_EQ(library.incomplete.size(), 3U);
  EXPECT_TRUE(library.lacks(5, "no diameter (geometry.DC)"));
  EXPECT_TRUE(library.lacks(6, "no unit"));
  EXPECT_TRUE(library.lacks(7, "'lollipop mill'"));
}

TEST(ToolLibrary, FreeCadReadsItsBits) {
  const Read library = read("Library/shop.fctl");
  ASSERT_EQ(library.tools.size(), 3U);
  EXPECT_EQ(library.tools[0].diameter_mm, 6.0);
  EXPECT_EQ(library.tools[0].flute_length_mm, 20.0);
  EXPECT_EQ(library.tools[1].shape, Shape::kDrill);
  EXPECT_EQ(library.tools[1].number, 2);
  EXPECT_EQ(library.tools[2].shape, Shape::kBullNose);
  EXPECT_EQ(library.tools[2].corner_radius_mm, 1.5);
  EXPECT_NEAR(library.tools[2].flute_length_mm, 25.4, 1e-12);
  EXPECT_TRUE(library.lacks(4, "Diameter has no unit ('6.0')"));
  EXPECT_TRUE(library.lacks(5, "neither beside the library nor in ../Bit"));
  EXPECT_TRUE(library.lacks(6, "'slittingsaw'"));
  const Read bit = read("Bit/mill_6.fctb");
  ASSERT_EQ(bit.tools.size(), 1U);
  EXPECT_EQ(bit.tools[0].number, 1);
}

TEST(ToolLibrary, KnowsTheFilesThatItIsMadeOf) {
  const auto parts = tool_library_parts(kFolder + "Library/shop.fctl");
  ASSERT_EQ(parts.size(), 5U);  // gone.fctb is not there
  EXPECT_EQ(parts[0].first, "mill_6.fctb");
  EXPECT_TRUE(std::filesystem::is_regular_file(parts[0].second));
  EXPECT_TRUE(tool_library_parts(kFolder + "fusion.json").empty());
}

std::string refusal(const std::string& name, const std::string& text) {
  const auto folder = test::fresh_folder("tool_library");
  test::write_text(folder / name, text);
  std::map<int, std::string> incomplete;
  try {
    read_tool_library((folder / name).string(), incomplete);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ToolLibrary, WhatIsNoLibraryIsRefused) {
  EXPECT_NE(refusal("a.json", "[1, 2]").find("bad-tool-library"), std::string::npos);
  EXPECT_NE(refusal("a.json", "{ \"data\": ").find("bad-tool-library"), std::string::npos);
  EXPECT_NE(refusal("a.json", "{ \"tools\": [] }").find("\"data\""), std::string::npos);
  EXPECT_NE(refusal("a.fctl", "{ \"data\": [] }").find("\"tools\""), std::string::npos);
  EXPECT_NE(refusal("a.p21", "ISO-10303-21;").find("ISO 13399"), std::string::npos);
}

}  // namespace
}  // namespace swarf::sim::tool_library_test
