// [design] kind = "ruled": the surface that its keys mean, and what is refused.
#include <gtest/gtest.h>

#include "measure/flank_error.h"
#include "sim/job/design_keys.h"
#include "support/program_run.h"

namespace swarf::sim::ruled_design_test {
namespace {

struct Read {
  DesignSettings design;
  std::vector<Diagnostic> diagnostics;
};

Read read(const std::string& keys) {
  const std::string file = (test::fresh_folder("ruled_design") / "scene.toml").string();
  test::write_text(file, "[design]\nkind = \"ruled\"\n" + keys);
  Diagnostics diagnostics;
  ConfigTable root = ConfigTable::load(file, {}, diagnostics);
  Read result;
  result.design = read_design(root.table("design"), true);
  root.finish();
  result.diagnostics = diagnostics.list();
  return result;
}

void expect_refused(const std::string& keys, const std::string& code) {
  const Read result = read(keys);
  ASSERT_EQ(result.diagnostics.size(), 1u) << keys;
  EXPECT_EQ(result.diagnostics[0].code, code) << keys << "\n" << format(result.diagnostics[0]);
  EXPECT_FALSE(result.diagnostics[0].fix.empty()) << keys;
}

TEST(RuledDesign, RowsAreCoefficientsOfTheGuideCurves) {
  const Read result = read(
      "guide0_mm = [[1, 2, 3], [60, 0, 0]]\n"
      "guide1_mm = [[0, -10, 30], [60, 20, 0], [0, 4, 1]]\noutward = \"v_cross_u\"\n");
  ASSERT_TRUE(result.diagnostics.empty()) << format(result.diagnostics[0]);
  const surface::Surface& S = *result.design.surfaces.front();
  EXPECT_TRUE(measure::is_ruled(S));
  EXPECT_EQ(S.outward_sign(), -1);
  const Vec3 c0(31, 2, 3), c1(30, 1, 30.25);  // u = 1/2
  EXPECT_LT((S.point(0.5, 0.0) - c0).norm(), 1e-12);
  EXPECT_LT((S.point(0.5, 1.0) - c1).norm(), 1e-12);
  EXPECT_LT((S.point(0.5, 0.25) - (0.75 * c0 + 0.25 * c1)).norm(), 1e-12);
}

TEST(RuledDesign, WhatIsRefused) {
  const std::string g0 = "guide0_mm = [[0, 0, 0], [60, 0, 0]]\n", out = "outward = \"u_cross_v\"\n";
  expect_refused(g0 + out, "missing-key");
  expect_refused(g0 + out + "guide1_mm = []\n", "wrong-type");
  expect_refused(g0 + out + "guide1_mm = [0, 0, 30]\n", "wrong-type");
  expect_refused(g0 + out + "guide1_mm = [[0, 0], [60, 0, 0]]\n", "wrong-type");
  expect_refused(g0 + out + "guide1_mm = [[0, 0, nan], [60, 0, 0]]\n", "wrong-type");
  expect_refused(g0 + "guide1_mm = [[0, 0, 30], [60, 0, 0]]\n", "missing-key");
  // Both guide curves the same line; a cone's apex is a curve that stands still.
  expect_refused(g0 + out + "guide1_mm = [[0, 0, 0], [60, 0, 0]]\n", "out-of-range");
  expect_refused(out + "guide0_mm = [[0, 0, 0]]\nguide1_mm = [[0, 0, 0], [60, 0, 0]]\n", "out-of-range");
}

}  // namespace
}  // namespace swarf::sim::ruled_design_test
