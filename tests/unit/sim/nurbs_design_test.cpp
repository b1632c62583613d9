// [design] kind = "nurbs": the surface that its keys mean, and what is refused.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/job/design_keys.h"
#include "support/program_run.h"

namespace swarf::sim::nurbs_design_test {
namespace {

struct Read {
  DesignSettings design;
  std::vector<Diagnostic> diagnostics;
};

Read read(const std::string& keys) {
  const std::string file = (test::fresh_folder("nurbs_design") / "scene.toml").string();
  test::write_text(file, "[design]\nkind = \"nurbs\"\noutward = \"u_cross_v\"\n" + keys);
  Diagnostics diagnostics;
  ConfigTable root = ConfigTable::load(file, {}, diagnostics);
  Read result;
  result.design = read_design(root.table("design"), true);
  root.finish();
  result.diagnostics = diagnostics.list();
  return result;
}

/// A quarter of a cylinder, radius 20 about y.
const std::string kQuarter =
    "degree = [2, 1]\ncount = [3, 2]\nknots_u = [0, 0, 0, 1, 1, 1]\nknots_v = [0, 0, 1, 1]\n"
    "poles_mm = [[20, 0, 0], [20, 30, 0], [20, 0, 20], [20, 30, 20], [0, 0, 20], [0, 30, 20]]\n";
const std::string kWeights = "weights = [1, 1, 0.7071067811865476, 0.7071067811865476, 1, 1]\n";

std::string code_of(std::string keys, const std::string& from, const std::string& to) {
  const size_t at = keys.find(from);
  EXPECT_NE(at, std::string::npos);
  const Read result = read(keys.replace(at, from.size(), to));
  EXPECT_FALSE(result.diagnostics.empty()) << keys;
  if (result.diagnostics.empty()) return "";
  EXPECT_FALSE(result.diagnostics[0].fix.empty());
  return result.diagnostics[0].code;
}

TEST(NurbsDesign, IsTheSurfaceOfItsPolesAndWeights) {
  const Read result = read(kQuarter + kWeights);
  ASSERT_TRUE(result.diagnostics.empty()) << format(result.diagnostics[0]);
  ASSERT_EQ(result.design.surfaces.size(), 1U);
  for (const double u : {0.0, 0.3, 0.5, 1.0}) {
    const Vec3 P = result.design.surfaces[0]->point(u, 0.25);
    EXPECT_NEAR(std::hypot(P.x(), P.z()), 20, 1e-12);
    EXPECT_NEAR(P.y(), 7.5, 1e-12);
  }
}

TEST(NurbsDesign, ACreaseMakesItTwo) {
  const Read result = read(
      "degree = [1, 1]\ncount = [3, 2]\nknots_u = [0, 0, 1, 2, 2]\nknots_v = [0, 0, 1, 1]\n"
      "poles_mm = [[0, 0, 0], [0, 9, 0], [10, 0, 0], [10, 9, 0], [20, 0, 5], [20, 9, 5]]\n");
  ASSERT_TRUE(result.diagnostics.empty()) << format(result.diagnostics[0]);
  EXPECT_EQ(result.design.surfaces.size(), 2U);
}

TEST(NurbsDesign, WhatIsRefused) {
  const std::string all = kQuarter + kWeights;
  EXPECT_EQ(code_of(all, "degree = [2, 1]", "degree = [12, 1]"), "out-of-range");
  EXPECT_EQ(code_of(all, "degree = [2, 1]", "degree = [1.5, 1]"), "out-of-range");
  EXPECT_EQ(code_of(all, "count = [3, 2]", "count = [3, 1]"), "out-of-range");
  EXPECT_EQ(code_of(all, "knots_v = [0, 0, 1, 1]", "knots_v = [0, 1, 1]"), "wrong-type");
  EXPECT_EQ(code_of(all, "knots_v = [0, 0, 1, 1]", "knots_v = [0, 0, 1, 0]"), "nurbs");
  EXPECT_EQ(code_of(all, "weights = [1,", "weights = [0,"), "nurbs");
  EXPECT_EQ(code_of(all, ", [0, 30, 20]]", "]"), "wrong-type") << "six weights for five poles";
}

}  // namespace
}  // namespace swarf::sim::nurbs_design_test
