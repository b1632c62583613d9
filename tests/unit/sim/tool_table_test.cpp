// Tools of a scene: [cutter], [[tool]], tool tables in TOML and .tbl, and everything that can be wrong with
// them.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "sim/job/tool_table.h"
#include "support/program_run.h"

namespace swarf::sim::tool_table_test {
namespace {

namespace fs = std::filesystem;
using cutter::Cutter;
using cutter::Shape;

const std::string kMill = "diameter_mm = 10\nflute_length_mm = 25\nlength_mm = 60\n";
const std::string kDrill =
    "shape = \"drill\"\npoint_angle_deg = 118\ndiameter_mm = 8\nflute_length_mm = 40\nlength_mm = 80\n";

struct Read {
  std::vector<Cutter> tools;
  std::vector<Diagnostic> diagnostics;
  std::string text() const {
    std::string all;
    for (const Diagnostic& d : diagnostics) all += format(d) + "\n";
    return all;
  }
};

class ToolTable : public testing::Test {
 protected:
  void SetUp() override { folder_ = test::fresh_folder("tool_table"); }
  void TearDown() override { fs::remove_all(folder_); }

  std::string file(const std::string& name, const std::string& text) const {
    test::write_text(folder_ / name, text);
    return (folder_ / name).string();
  }
  Read read(const std::string& scene, const std::string& table = "") const {
    Diagnostics diagnostics;
    Read result;
    ConfigTable root = ConfigTable::load(file("scene.toml", scene), {}, diagnostics);
    if (!table.empty()) root.text("tool_table", "");
    result.tools = read_tools(root, table, diagnostics);
    root.finish();
    result.diagnostics = diagnostics.list();
    return result;
  }
  fs::path folder_;
};

std::string tool(const std::string& keys, const std::string& body) {
  return "[[tool]]\n" + keys + "\n" + body;
}

TEST_F(ToolTable, OneCutterIsToolOne) {
  const Read one = read("[cutter]\n" + kMill);
  ASSERT_TRUE(one.diagnostics.empty()) << one.text();
  ASSERT_EQ(one.tools.size(), 1U);
  EXPECT_EQ(one.tools[0].number, 1);
}

TEST_F(ToolTable, NumbersAndNames) {
  const Read all = read(tool("number = 3", kMill) + tool("name = \"DRILL_8\"", kDrill) +
                        tool("number = 7\nname = \"SLOT\"\nhand = \"left\"", kMill));
  ASSERT_TRUE(all.diagnostics.empty()) << all.text();
  ASSERT_EQ(all.tools.size(), 3U);
  EXPECT_EQ(tool_index(all.tools, 3, ""), 0);
  EXPECT_EQ(tool_index(all.tools, 0, "DRILL_8"), 1);
  EXPECT_EQ(tool_index(all.tools, 0, "SLOT"), 2);
  EXPECT_EQ(tool_index(all.tools, 4, ""), -1);
  EXPECT_EQ(tool_index(all.tools, 0, "drill_8"), -1);
  EXPECT_TRUE(all.tools[2].left_hand);
  EXPECT_EQ(list_tools(all.tools), "T3, DRILL_8, T7 (SLOT)");
}

TEST_F(ToolTable, GaugeLengthIsThatOfToolAndHolderUnlessGiven) {
  const Read all =
      read(tool("number = 1\nholder = [{ diameter_mm = 20, length_mm = 15 }, { diameter_mm = 40, "
                "length_mm = 50 }]",
                kMill) +
           tool("number = 2\ngauge_length_mm = 97.5", kMill));
  ASSERT_EQ(all.tools.size(), 2U) << all.text();
  EXPECT_DOUBLE_EQ(cutter::gauge_length(all.tools[0]), 60.0 + 15.0 + 50.0);
  EXPECT_DOUBLE_EQ(cutter::gauge_length(all.tools[1]), 97.5);
}

TEST_F(ToolTable, TomlTableAddsItsToolsBehindThoseOfTheScene) {
  const std::string table = file("tools.toml", tool("number = 2", kDrill));
  const Read all = read("tool_table = \"tools.toml\"\n" + tool("number = 1", kMill), table);
  ASSERT_TRUE(all.diagnostics.empty()) << all.text();
  ASSERT_EQ(all.tools.size(), 2U);
  EXPECT_EQ(all.tools[0].number, 1);
  EXPECT_EQ(all.tools[1].shape, Shape::kDrill);
}

TEST_F(ToolTable, TblLinesThatCannotBeAToolAreRefused) {
  for (const char* line : {"T2 Z80 D999999 ; ball", "T1e300 Z80 D6", "T-3 Z80 D6", "T1.5 Z80 D6"}) {
    const Read all = read("tool_table = \"tools.tbl\"\n", file("tools.tbl", std::string(line) + "\n"));
    EXPECT_NE(all.text().find("bad-tool-line"), std::string::npos) << line << "\n" << all.text();
  }
  // The scene's own description counts, not the shape that a .tbl would be taken for.
  const Read own = read("tool_table = \"tools.tbl\"\n" + tool("number = 2", kMill),
                        file("tools.tbl", "T2 Z3 D10 ; ball\n"));
  EXPECT_EQ(own.text().find("bad-tool-line"), std::string::npos) << own.text();
}

TEST_F(ToolTable, TblGivesLengthAndDiameterAndSaysWhatItAssumes) {
  const std::string table = file("tools.tbl",
                                 "; machine 1\n"
                                 "T1 P1 Z+81.5 D10 ;end mill\n"
                                 "\n"
                                 "t2 p2 d6.0 z70.25 X0 ;6 mm Ball nose\n");
  const Read all = read("tool_table = \"tools.tbl\"\n", table);
  ASSERT_EQ(all.tools.size(), 2U) << all.text();
  EXPECT_DOUBLE_EQ(cutter::gauge_length(all.tools[0]), 81.5);
  EXPECT_EQ(all.tools[0].shape, Shape::kFlat);
  EXPECT_EQ(all.tools[1].shape, Shape::kBall);
  EXPECT_DOUBLE_EQ(all.tools[1].corner_radius_mm, 3.0);
  for (const Cutter& c : all.tools) EXPECT_TRUE(cutter::validate(c).empty()) << cutter::call_name(c);
  ASSERT_EQ(all.diagnostics.size(), 2U) << all.text();
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(all.diagnostics[i].code, "tool-shape-assumed");
    EXPECT_EQ(all.diagnostics[i].severity, Severity::kWarning);
    EXPECT_EQ(all.diagnostics[i].where.line, i == 0 ? 2 : 4);
  }
}

/// As LinuxCNC itself writes its tables.
TEST_F(ToolTable, ATblMayHaveToolsThatCannotBeUsed) {
  const std::string table = file("tools.tbl",
                                 "T1 P1 Z80 D.125 ;a small one\n"
                                 "T2 P2 D0.0625 Z-10.5\n"
                                 "T3 P3 Z0 D3.175\n"
                                 "T4 P4 Z40\n"
                                 "T5 P5 D6\n"
                                 "T6 P6 X0.5 Y0 Z40 D6\n"
                                 "T7 P7 X0 Y0 Z+40.0 A0 B0 C0 U0 V0 W0 D+6.0 I0 J0 Q0 ;all words\n"
                                 "T0 P0\n");
  Diagnostics diagnostics;
  IncompleteTools incomplete;
  const std::vector<Cutter> tools = read_tool_table(table, diagnostics, &incomplete);
  EXPECT_FALSE(diagnostics.has_errors()) << Read{{}, diagnostics.list()}.text();
  ASSERT_EQ(tools.size(), 2U);
  EXPECT_EQ(tools[0].number, 1);
  EXPECT_DOUBLE_EQ(tools[0].diameter_mm, 0.125);
  EXPECT_EQ(tools[1].number, 7);
  ASSERT_EQ(incomplete.size(), 5U);
  EXPECT_NE(incomplete[2].find("tools.tbl:2: Z is -10.5 mm"), std::string::npos) << incomplete[2];
  EXPECT_NE(incomplete[4].find("no word D"), std::string::npos) << incomplete[4];
  EXPECT_NE(incomplete[6].find("offset X0.5"), std::string::npos) << incomplete[6];
}

TEST_F(ToolTable, ATomlEntryDescribesAToolOfTheTblAndTakesItsLength) {
  const std::string table = file("tools.tbl", "T2 P2 Z131.75 D8\n");
  const Read all = read("tool_table = \"tools.tbl\"\n" + tool("number = 2", kDrill), table);
  ASSERT_TRUE(all.diagnostics.empty()) << all.text();
  ASSERT_EQ(all.tools.size(), 1U);
  EXPECT_EQ(all.tools[0].shape, Shape::kDrill);
  EXPECT_DOUBLE_EQ(cutter::gauge_length(all.tools[0]), 131.75);
}

TEST_F(ToolTable, WhatIsWrongIsToldAtItsLine) {
  struct Bad {
    std::string scene, table, code, place;
  };
  const std::vector<Bad> list{
      {tool("", kMill), "", "tool-unnamed", "scene.toml:1:"},
      {tool("number = 1", kMill) + tool("number = 1", kDrill), "", "tool-twice", "scene.toml:6:"},
      {tool("name = \"A\"", kMill) + tool("number = 2\nname = \"A\"", kDrill), "", "tool-twice",
       "scene.toml:6:"},
      {tool("name = \"A,B\"", kMill), "", "bad-tool-name", "scene.toml:1:"},
      {tool("name = \"12\"", kMill), "", "bad-tool-name", "scene.toml:1:"},
      {"[cutter]\n" + kMill + tool("number = 1", kMill), "", "two-tool-sets", "scene.toml:"},
      {tool("number = 1\ngauge_length_mm = 0", kMill), "", "out-of-range", "scene.toml:3:"},
      {tool("number = 1\nhand = \"both\"", kMill), "", "unknown-choice", "scene.toml:3:"},
      {tool("number = 1\ntaper_deg = 3", kMill), "", "unknown-key", "scene.toml:3:"},
      {tool("number = 1", "diameter_mm = 10\nflute_length_mm = 70\nlength_mm = 60\n"), "", "bad-cutter",
       "scene.toml:4:"},
      {"", "", "missing-key", ""},
      {"", "T1 P1 Z80\n", "missing-tool-word", "t.tbl:1:"},
      {"", "T1 P1 D8\n", "missing-tool-word", "t.tbl:1:"},
      {"", "P1 Z80 D8\n", "missing-tool-word", "t.tbl:1:"},
      {"", "; nothing\n", "no-tools", "t.tbl"},
      {"", "T1 P1 Z80 D8\nT1 P2 Z90 D6\n", "tool-twice", "t.tbl:2:"},
      {"", "T1 P1 Z80 D8 K2\n", "bad-tool-line", "t.tbl:1:14"},
      {"", "T1 P1 Z D8\n", "bad-tool-line", "t.tbl:1:7"},
      {"", "T1 P1 Z80 Z81 D8\n", "bad-tool-line", "t.tbl:1:11"},
      {"", "T1 P1 Znan D8\n", "bad-tool-line", "t.tbl:1:7"},
      {"", "T1.5 P1 Z80 D8\n", "bad-tool-line", "t.tbl:1:"},
      {"", "T1 P1 Z80 D0\n", "bad-tool-line", "t.tbl:1:"},
      {"", "T1 P1 Z-80 D8\n", "bad-tool-line", "t.tbl:1:"},
      {"", "T1 P1 X2 Z80 D8\n", "unsupported-tool-offset", "t.tbl:1:"},
      {tool("number = 1", kMill), "T1 P1 Z80 D8\n", "tool-contradiction", "scene.toml:1:"},
      {tool("number = 1\ngauge_length_mm = 90", kMill), "T1 P1 Z80 D10\n", "tool-contradiction",
       "scene.toml:1:"},
  };
  for (const Bad& bad : list) {
    const std::string table = bad.table.empty() ? "" : file("t.tbl", bad.table);
    // A scene may not be empty.
    const bool only_table = bad.scene.empty() && !table.empty();
    const Read result = read(only_table ? "tool_table = \"t.tbl\"\n" : bad.scene, table);
    bool found = false;
    for (const Diagnostic& d : result.diagnostics)
      found = found || (d.code == bad.code && format(d).find(bad.place) != std::string::npos);
    EXPECT_TRUE(found) << bad.code << " expected of\n"
                       << bad.scene << bad.table << "\nbut came\n"
                       << result.text();
  }
}

}  // namespace
}  // namespace swarf::sim::tool_table_test
