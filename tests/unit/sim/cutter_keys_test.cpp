// [cutter] of a scene: each shape's keys, the defaults, and that no key of another shape slips through.
#include "sim/job/cutter_keys.h"

#include <gtest/gtest.h>

#include "base/units.h"
#include "cutter/profile.h"
#include "support/program_run.h"

namespace swarf::sim::cutter_keys_test {
namespace {

using cutter::Cutter;
using cutter::Shape;

struct Read {
  Cutter cutter;
  std::vector<Diagnostic> diagnostics;
};

Read read(const std::string& keys) {
  const std::string file = (test::fresh_folder("cutter_keys") / "scene.toml").string();
  test::write_text(file, "[cutter]\nlength_mm = 60\n" + keys);
  Diagnostics diagnostics;
  ConfigTable root = ConfigTable::load(file, {}, diagnostics);
  Read result;
  result.cutter = read_cutter(root.table("cutter"));
  root.finish();
  result.diagnostics = diagnostics.list();
  return result;
}

Cutter good(const std::string& keys) {
  const Read result = read(keys);
  EXPECT_TRUE(result.diagnostics.empty()) << keys << "\n" << format(result.diagnostics[0]);
  return result.cutter;
}

TEST(CutterKeys, WithoutAShapeTheCornerRadiusTells) {
  const std::string lengths = "diameter_mm = 10\nflute_length_mm = 25\n";
  EXPECT_EQ(good(lengths).shape, Shape::kFlat);
  EXPECT_EQ(good(lengths + "corner_radius_mm = 0").shape, Shape::kFlat);
  EXPECT_EQ(good(lengths + "corner_radius_mm = 2").shape, Shape::kBullNose);
  EXPECT_EQ(good(lengths + "corner_radius_mm = 5").shape, Shape::kBall);
}

TEST(CutterKeys, EachShapeHasItsOwn) {
  const std::string lengths = "diameter_mm = 10\nflute_length_mm = 25\n";
  EXPECT_EQ(good("shape = \"ball\"\n" + lengths).shape, Shape::kBall);
  const Cutter taper = good("shape = \"taper\"\ntaper_deg = 5\ncorner_radius_mm = 1\n" + lengths);
  EXPECT_DOUBLE_EQ(deg_from_rad(taper.taper_rad), 5.0);
  EXPECT_NEAR(taper.shank_diameter_mm, 2.0 * cutter::outline(taper).back().to.x(), 1e-12);
  EXPECT_DOUBLE_EQ(deg_from_rad(good("shape = \"drill\"\npoint_angle_deg = 118\n" + lengths).point_angle_rad),
                   118.0);
  EXPECT_EQ(
      good("shape = \"chamfer\"\npoint_angle_deg = 90\ntip_diameter_mm = 1\n" + lengths).tip_diameter_mm,
      1.0);
  const Cutter disc = good("shape = \"woodruff\"\ndiameter_mm = 20\nwidth_mm = 4\nshank_diameter_mm = 8");
  EXPECT_EQ(disc.flute_length_mm, 4.0);
  const Cutter apt = good(
      "shape = \"apt\"\nalpha_deg = 10\nbeta_deg = 20\ncorner_radius_mm = 1\ncorner_centre_mm = [4.2578, "
      "1.7662]\n" +
      lengths);
  EXPECT_NEAR(apt.corner_centre_mm->x(), cutter::apt_form(apt)->corner_centre().x(), 1e-4);
}

TEST(CutterKeys, ProfilesAreInlineOrArraysOfTables) {
  const Cutter one = good(
      "shape = \"profile\"\nshank_diameter_mm = 4\n"
      "profile = [{ to_mm = [0, 0] }, { to_mm = [4, 4], radius_mm = 4 }, { to_mm = [4, 20] }]");
  const Cutter other = good(
      "shape = \"profile\"\nshank_diameter_mm = 4\n[[cutter.profile]]\nto_mm = [0, 0]\n"
      "[[cutter.profile]]\nto_mm = [4, 4]\nradius_mm = 4\n[[cutter.profile]]\nto_mm = [4, 20]");
  for (const Cutter& c : {one, other}) {
    ASSERT_EQ(c.profile.size(), 3U);
    EXPECT_EQ(c.profile[1].radius_mm, 4.0);
    EXPECT_EQ(c.diameter_mm, 8.0);
    EXPECT_EQ(c.flute_length_mm, 20.0);
  }
}

TEST(CutterKeys, NeckAndHolder) {
  const std::string lengths = "diameter_mm = 10\nflute_length_mm = 25\n";
  const Cutter plain = good(lengths + "holder_diameter_mm = 30\nholder_length_mm = 45");
  ASSERT_EQ(plain.holder.size(), 1U);
  EXPECT_EQ(plain.holder[0].top_diameter_mm, 30.0);
  EXPECT_EQ(plain.shank_diameter_mm, 10.0);
  const Cutter stacked =
      good(lengths +
           "neck_diameter_mm = 9\nneck_length_mm = 10\nholder = [{ diameter_mm = 20, "
           "top_diameter_mm = 30, length_mm = 15 }, { diameter_mm = 40, length_mm = 50 }]");
  EXPECT_EQ(stacked.neck_length_mm, 10.0);
  ASSERT_EQ(stacked.holder.size(), 2U);
  EXPECT_EQ(stacked.holder[0].top_diameter_mm, 30.0);
  EXPECT_EQ(stacked.holder[1].top_diameter_mm, 40.0);
}

struct Bad {
  const char* keys;
  const char* code;
  int line;
};

TEST(CutterKeys, WhatIsWrongIsToldAtItsLine) {
  // Line 1 is [cutter], line 2 length_mm.
  const std::vector<Bad> list = {
      {"diameter_mm = 10\nflute_length_mm = 25\ntaper_deg = 5", "unknown-key", 5},
      {"shape = \"drill\"\ndiameter_mm = 10\nflute_length_mm = 25", "missing-key", 1},
      {"shape = \"drill\"\ndiameter_mm = 10\nflute_length_mm = 25\npoint_angle_deg = 118\ncorner_radius_mm = "
       "1",
       "unknown-key", 7},
      {"shape = \"woodruff\"\ndiameter_mm = 20\nwidth_mm = 4", "missing-key", 1},
      {"shape = \"woodruff\"\ndiameter_mm = 20\nwidth_mm = 4\nflute_length_mm = 4\nshank_diameter_mm = 8",
       "unknown-key", 6},
      {"diameter_mm = 10\nflute_length_mm = 70", "bad-cutter", 4},
      {"diameter_mm = 10\nflute_length_mm = 25\nneck_length_mm = 5", "missing-key", 1},
      {"diameter_mm = 10\nflute_length_mm = 25\nholder = 40", "wrong-type", 5},
      {"shape = \"profile\"\nshank_diameter_mm = 4\nprofile = [{ to_mm = [0, 0, 0] }, { to_mm = [4, 20] }]",
       "wrong-type", 5},
      {"shape = \"profile\"\nshank_diameter_mm = 4\nprofile = [{ to_mm = [0, 0] }, { to = [4, 20] }]",
       "unknown-key", 5},
  };
  for (const Bad& bad : list) {
    const Read result = read(bad.keys);
    bool found = false;
    for (const Diagnostic& d : result.diagnostics)
      found = found || (d.code == bad.code && d.where.line == bad.line);
    EXPECT_TRUE(found) << bad.keys << "\n"
                       << (result.diagnostics.empty() ? "" : format(result.diagnostics[0]));
  }
}

/// What is missing or no such number is told once, and nothing that follows from it.
TEST(CutterKeys, EachFaultOfALengthIsToldOnce) {
  const auto codes = [](const std::string& keys) {
    std::string all;
    for (const Diagnostic& one : read(keys).diagnostics) all += one.code + " ";
    return all;
  };
  EXPECT_EQ(codes(""), "missing-key missing-key ");  // diameter and flutes
  EXPECT_EQ(codes("diameter_mm = 10"), "missing-key ");
  EXPECT_EQ(codes("flute_length_mm = 25\ncorner_radius_mm = 2"), "missing-key ");
  EXPECT_EQ(codes("diameter_mm = -1\nflute_length_mm = 25"), "out-of-range ");
  EXPECT_EQ(codes("diameter_mm = \"x\"\nflute_length_mm = 25\ncorner_radius_mm = 2"), "wrong-type ");
  EXPECT_EQ(codes("diameter_mm = 10\nflute_length_mm = 25\ncorner_radius_mm = -2"), "out-of-range ");
  EXPECT_EQ(codes("shape = \"drill\"\ndiameter_mm = 10\nflute_length_mm = 25"), "missing-key ");
  EXPECT_EQ(codes("shape = \"taper\"\ndiameter_mm = 10\nflute_length_mm = 25"), "missing-key ");
}

}  // namespace
}  // namespace swarf::sim::cutter_keys_test
