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

}  // namespace
}  // namespace swarf
