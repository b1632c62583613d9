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
  std::map<int, std::string> incomplete, assumed;
  bool lacks(int number, const std::string& words) const {
    const auto found = incomplete.find(number);
    return found != incomplete.end() && found->second.find(words) != std::string::npos;
  }
};

Read read(const std::string& file) {
  Read result;
  result.tools = read_tool_library(kFolder + file, result.incomplete, result.assumed);
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
  std::map<int, std::string> incomplete, assumed;
  try {
    read_tool_library((folder / name).string(), incomplete, assumed);
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
}

TEST(ToolLibrary, Iso13399BySymbols) {
  const Read library = read("catalogue.p21");
  ASSERT_EQ(library.tools.size(), 4U);
  const Cutter& mill = library.tools[0];
  EXPECT_EQ(mill.number, 1);
  EXPECT_EQ(mill.name, "EM-10-R1");
  EXPECT_EQ(mill.shape, Shape::kBullNose);
  EXPECT_EQ(mill.diameter_mm, 10.0);
  EXPECT_EQ(mill.corner_radius_mm, 1.0);
  EXPECT_EQ(mill.flute_length_mm, 22.0);
  EXPECT_EQ(mill.length_mm, 40.0);  // LPR, not OAL
  const Cutter& ball = library.tools[1];
  EXPECT_EQ(ball.shape, Shape::kBall);
  EXPECT_NEAR(ball.diameter_mm, 6.35, 1e-12);
  EXPECT_NEAR(ball.flute_length_mm, 19.05, 1e-12);
  EXPECT_NEAR(ball.length_mm, 63.5, 1e-12);
  const Cutter& drill = library.tools[2];
  EXPECT_EQ(drill.shape, Shape::kDrill);
  EXPECT_NEAR(drill.point_angle_rad, rad_from_deg(140.0), 1e-15);
  EXPECT_EQ(drill.shank_diameter_mm, 6.0);
  EXPECT_EQ(library.tools[3].shape, Shape::kFlat);
  EXPECT_EQ(library.tools[3].name, "");  // digits alone are a number
  EXPECT_EQ(library.assumed.count(1), 0U);
  EXPECT_NE(library.assumed.at(2).find("all of its 63.5 mm stand out"), std::string::npos);
  EXPECT_NE(library.assumed.at(4).find("its end is taken as flat"), std::string::npos);
}

TEST(ToolLibrary, WhatAnIso13399ToolLacksIsKeptForItsCall) {
  const Read library = read("catalogue.p21");
  EXPECT_EQ(library.incomplete.size(), 5U);
  EXPECT_TRUE(library.lacks(5, "TM-8: it cuts threads (TP)"));
  EXPECT_TRUE(library.lacks(6, "edges lean (KAPR 45 deg)"));
  EXPECT_TRUE(library.lacks(7, "no cutting length (APMX, LCF or LU)"));
  EXPECT_TRUE(library.lacks(8, "two values of DC"));
  EXPECT_TRUE(library.lacks(9, "the unit 'deg' of its DC"));
}

/// One item with one value; `name` of the value, `code` that of its property in a dictionary.
std::string one_value(const std::string& name, const std::string& code) {
  return "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n#1=UNIT('mm');\n#2=ITEM($,'A',$);\n#3=ITEM_VERSION(#2,$,'1'"
         ");\n"
         "#4=ITEM_DEFINITION((),#3,'1',$);\n#5=PLIB_PROPERTY_REFERENCE('" +
         code + "',$,'1');\n#6=PROPERTY((#1),$,'p',#5,$,'1');\n#7=NUMERICAL_VALUE('" + name +
         "',$,#1,10.);\n#8=PROPERTY_VALUE_REPRESENTATION(#6,$,$,#7,$);\n"
         "#9=PROPERTY_VALUE_ASSOCIATION($,#4,#8,$,$);\nENDSEC;\nEND-ISO-10303-21;\n";
}

TEST(ToolLibrary, Iso13399FilesThatCannotBeReadSayWhy) {
  const auto expect = [](const std::string& text, const std::string& words) {
    const std::string told = refusal("a.p21", text);
    EXPECT_NE(told.find("bad-tool-library"), std::string::npos) << text << told;
    EXPECT_NE(told.find(words), std::string::npos) << words << told;
  };
  expect(" ", "does not begin with ISO-10303-21");
  expect("{}", "does not begin with ISO-10303-21");
  expect("ISO-10303-21;", "no item of the file has a cutting diameter (DC)");
  expect(one_value("LF", "71D"), "no item of the file has a cutting diameter (DC)");
  // Known by its code in a dictionary alone: the codes are told, nothing is guessed.
  expect(one_value("value", "71D0"), "codes alone and no symbols (DC, RE, APMX ..): 71D0");
  expect("ISO-10303-21;\nDATA;\n#1=UNIT('mm", "a.p21:3:");
  expect("ISO-10303-21;\nDATA;\n#1=UNIT('mm'", "record #1 does not end");
  expect("ISO-10303-21;\nDATA;\n/* x", "comment does not end");
  expect("ISO-10303-21;\nDATA;\n#1=UNIT('mm');\n#1=UNIT('in');", "#1 is used twice");
  expect("ISO-10303-21;\nDATA;\n#=UNIT('mm');", "without the number of a record");
  expect("ISO-10303-21;\nDATA;\n#1 UNIT('mm');", "'=' is missing behind #1");
}

Read read_text_as(const std::string& name, const std::string& text) {
  const auto folder = test::fresh_folder("tool_library");
  test::write_text(folder / name, text);
  Read result;
  result.tools = read_tool_library((folder / name).string(), result.incomplete, result.assumed);
  return result;
}

TEST(ToolLibrary, TheCornerOfAnInsertIsNotThatOfItsBody) {
  std::string text = one_value("DC", "71D");
  text.replace(text.find("ENDSEC;\nEND"), 7,
               "#12=ITEM($,'I',$);\n#13=ITEM_VERSION(#12,$,'1');\n#14=ITEM_DEFINITION((),#13,'1',$);\n"
               "#17=NUMERICAL_VALUE('RE',$,#1,0.8);\n#18=PROPERTY_VALUE_REPRESENTATION(#6,$,$,#17,$);\n"
               "#19=PROPERTY_VALUE_ASSOCIATION($,#14,#18,$,$);\nENDSEC;");
  const Read library = read_text_as("a.p21", text);
  EXPECT_TRUE(library.tools.empty());
  EXPECT_TRUE(library.lacks(1, "that of an insert"));
}

TEST(ToolLibrary, TwoToolsOfOneNumberAreToldWhereItIsCalled) {
  const std::string tool =
      R"({"type": "flat end mill", "unit": "millimeters", "geometry": {"DC": 6, "LB": 30, "LCF": 20}, )"
      R"("post-process": {"number": 3}, "description": ")";
  const Read library = read_text_as("a.json", "{\"data\": [" + tool + "A\"}, " + tool + "B\"}]}");
  EXPECT_TRUE(library.tools.empty());
  EXPECT_TRUE(library.lacks(3, "data[0] (A) and data[1] (B) have this number both"));
}

}  // namespace
}  // namespace swarf::sim::tool_library_test
