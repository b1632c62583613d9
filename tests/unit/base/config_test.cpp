// Lengths in inches: one length in both units is one length; what is wrong is said in the unit that was
// written.
#include "base/config.h"

#include <gtest/gtest.h>

namespace swarf {
namespace {

struct Parsed {
  Diagnostics diagnostics;
  ConfigTable root;
  explicit Parsed(const std::string& text, const std::vector<std::string>& overrides = {})
      : root(ConfigTable::parse(text, "x.toml", overrides, diagnostics)) {}
  const Diagnostic& only_error() const {
    EXPECT_EQ(diagnostics.list().size(), 1u);
    static const Diagnostic none;
    return diagnostics.list().empty() ? none : diagnostics.list().front();
  }
};

TEST(ConfigUnits, EveryKindOfLengthIsReadInInches) {
  Parsed inches(
      "diameter_in = 0.25\nwhole_in = 2\nspeed_max_in_min = 100\njerk_in_s3 = 3.0\norigin_in = [1, -2.0, "
      "0.5]\n"
      "box_in = [[0, 0, -1], [4, 3, 0]]\nguide_in = [[1, 2, 3]]\n[start]\nX_in = 10\n");
  EXPECT_DOUBLE_EQ(inches.root.number("diameter_mm", kAboveZero), 6.35);
  EXPECT_DOUBLE_EQ(inches.root.number("whole_mm", kAboveZero), 50.8);
  EXPECT_DOUBLE_EQ(inches.root.number("speed_max_mm_min", kAboveZero), 2540.0);
  EXPECT_DOUBLE_EQ(inches.root.number("jerk_mm_s3", kAboveZero), 76.2);
  EXPECT_EQ(inches.root.numbers("origin_mm", 3), (std::vector<double>{25.4, -50.8, 12.7}));
  const Box box = inches.root.box("box_mm");
  EXPECT_TRUE(box.lower.isApprox(Vec3(0, 0, -25.4)) && box.upper.isApprox(Vec3(101.6, 76.2, 0)));
  EXPECT_TRUE(inches.root.points("guide_mm").front().isApprox(Vec3(25.4, 50.8, 76.2)));
  ConfigTable start = inches.root.table("start");
  EXPECT_TRUE(start.has("X_mm"));
  EXPECT_DOUBLE_EQ(start.number("X_mm", {}), 254.0);
  inches.root.finish();
  EXPECT_TRUE(inches.diagnostics.list().empty());
}

TEST(ConfigUnits, BothUnitsOfOneLengthAreRefused) {
  Parsed both("[cutter]\ndiameter_mm = 6.0\ndiameter_in = 0.25\n");
  both.root.table("cutter").number("diameter_mm", kAboveZero);
  both.root.finish();
  EXPECT_EQ(both.only_error().code, "two-units");
  EXPECT_EQ(both.only_error().where.line, 3);
  EXPECT_NE(both.only_error().text.find("'cutter.diameter_mm' and 'cutter.diameter_in'"), std::string::npos);
}

TEST(ConfigUnits, WhatIsWrongIsSaidInTheUnitThatWasWritten) {
  Parsed low("voxel_in = 0.001\n");
  low.root.number("voxel_mm", {0.254, 2.54});
  EXPECT_EQ(low.only_error().code, "out-of-range");
  EXPECT_EQ(low.only_error().text, "'voxel_in' is 0.001");
  EXPECT_EQ(low.only_error().fix, "it must be from 0.01 to 0.1");
  EXPECT_EQ(low.only_error().where.line, 1);
  Parsed row("origin_in = [1, 2]\n");
  row.root.numbers("origin_mm", 3);
  EXPECT_EQ(row.only_error().fix, "write origin_in = [a, b, c]");
}

TEST(ConfigUnits, MisspeltKeysAreSuggestedInTheirUnit) {
  Parsed inches("diamter_in = 1.0\n");
  inches.root.number("diameter_mm", kAboveZero, 1.0);
  inches.root.finish();
  EXPECT_EQ(inches.only_error().code, "unknown-key");
  EXPECT_EQ(inches.only_error().fix, "did you mean 'diameter_in'?");
  Parsed metric("diamter_mm = 1.0\n");
  metric.root.number("diameter_mm", kAboveZero, 1.0);
  metric.root.finish();
  EXPECT_EQ(metric.only_error().fix, "did you mean 'diameter_mm'?");
}

TEST(ConfigUnits, OnlyLengthsHaveInches) {
  Parsed others("angle_in = 1.0\nlimit_in = 2.0\n");
  others.root.number("angle_deg", {}, 0.0);
  others.root.number("limit_um", {}, 0.0);
  others.root.finish();
  EXPECT_EQ(others.diagnostics.list().size(), 2u);
}

TEST(ConfigOverrides, NumbersNeedNoDigitBeforeThePoint) {
  Parsed given("", {"pitch_mm=.1", "low_mm=-.5", "name=.a"});
  EXPECT_EQ(given.root.number("pitch_mm", kAboveZero), 0.1);
  EXPECT_EQ(given.root.number("low_mm", {}), -0.5);
  EXPECT_EQ(given.root.text("name"), ".a");
}

TEST(ConfigUnits, AnOverrideReplacesTheLengthInEitherUnit) {
  const std::string text = "[stock]\nvoxel_mm = 0.5\n";
  Parsed inches(text, {"stock.voxel_in=0.1"});
  EXPECT_DOUBLE_EQ(inches.root.table("stock").number("voxel_mm", kAboveZero), 2.54);
  Parsed back("[stock]\nvoxel_in = 0.5\n", {"stock.voxel_mm=0.1"});
  EXPECT_DOUBLE_EQ(back.root.table("stock").number("voxel_mm", kAboveZero), 0.1);
  Parsed wrong(text, {"stock.voxel_in=-1"});
  wrong.root.table("stock").number("voxel_mm", kAboveZero);
  EXPECT_EQ(wrong.only_error().where.file, "--set stock.voxel_in");
}

struct Overlaid {
  Diagnostics diagnostics;
  ConfigTable root;
  explicit Overlaid(const std::string& text, size_t index, const std::vector<std::string>& overrides = {})
      : root(ConfigTable::parse(text, "x.toml", overrides, diagnostics, [&] {
          static ConfigOverlay overlay;
          overlay = {"part", index, {"own", "way_mm"}, {{"cl", "nc"}}, {"joined"}};
          return &overlay;
        }())) {}
};

const char* const kOverlaid =
    "nc = 'all'\nfixed = 1\n[joined]\na = 1\nb_mm = 2\n[whole]\na = 1\nb = 2\n"
    "[[part]]\nown = 3\n[[part]]\ncl = 'second'\nway_in = 1\njoined = { b_in = 1 }\nwhole = { a = 5 }\n";

TEST(ConfigOverlays, OneOfAListTakesThePlaceOfWhatTheRootSays) {
  Overlaid first(kOverlaid, 0), second(kOverlaid, 1);
  EXPECT_EQ(first.root.text("nc"), "all");
  EXPECT_EQ(first.root.table("part").number("own", {}), 3.0);
  EXPECT_FALSE(first.root.is_list("part"));
  EXPECT_FALSE(second.root.has("nc")) << "of its group the root keeps none";
  EXPECT_EQ(second.root.text("cl"), "second");
  EXPECT_EQ(second.root.where("cl").line, 12) << "a place in the file still";
  EXPECT_EQ(second.root.number("fixed", {}), 1.0);
  EXPECT_EQ(second.root.table("part").number("way_mm", {}), 25.4);
  ConfigTable joined = second.root.table("joined"), whole = second.root.table("whole");
  EXPECT_EQ(joined.number("a", {}), 1.0);
  EXPECT_EQ(joined.number("b_mm", {}), 25.4) << "in the other unit";
  EXPECT_EQ(whole.number("a", {}), 5.0);
  EXPECT_FALSE(whole.has("b"));
  EXPECT_TRUE(second.diagnostics.list().empty());
}

TEST(ConfigOverlays, OverridesOfTheListComeBeforeAndOthersAfter) {
  Overlaid second(kOverlaid, 1, {"part[1].cl=before", "joined.a=7"});
  EXPECT_EQ(second.root.text("cl"), "before");
  EXPECT_EQ(second.root.table("joined").number("a", {}), 7.0);
  Overlaid replaced(kOverlaid, 1, {"part[1].cl=before", "cl=after"});
  EXPECT_EQ(replaced.root.text("cl"), "after");
}

TEST(ConfigOverlays, WhatIsUnknownIsToldAtItsPlace) {
  Overlaid one("[[part]]\nown = 1\nfxed = 2\npart = 3\n", 0);
  one.root.integer("fixed", 0, 9, 1);
  one.root.table("part").number("own", {});
  one.root.finish();
  ASSERT_EQ(one.diagnostics.list().size(), 2U);
  for (const Diagnostic& told : one.diagnostics.list()) {
    EXPECT_EQ(told.code, "unknown-key");
    EXPECT_TRUE(told.where.line == 3 || told.where.line == 4) << told.where.line;
  }
  Overlaid none("[[part]]\nown = 1\n", 5), table("[part]\nown = 1\n", 0);
  EXPECT_TRUE(none.root.is_list("part"));
  EXPECT_EQ(table.root.table("part").number("own", {}), 1.0) << "no list: as it stands";
}

}  // namespace
}  // namespace swarf
