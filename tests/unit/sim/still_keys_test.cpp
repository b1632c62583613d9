// [stills] and [[stills.shot]].
#include "sim/job/still_keys.h"

#include <gtest/gtest.h>

#include <string>

namespace swarf::sim {
namespace {

StillSettings read_of(const std::string& text, Diagnostics& diagnostics) {
  ConfigTable root = ConfigTable::parse(text, "scene.toml", {}, diagnostics);
  StillSettings stills = read_stills(root.table("stills"));
  root.finish();
  return stills;
}

/// The one error, as "code line".
std::string still_fault(const std::string& text) {
  Diagnostics diagnostics;
  read_of(text, diagnostics);
  if (diagnostics.list().size() != 1) return std::to_string(diagnostics.list().size()) + " diagnostics";
  const Diagnostic& found = diagnostics.list().front();
  return found.code + " " + std::to_string(found.where.line);
}

TEST(StillKeys, WhatIsNotSaidIsLeftToTheKind) {
  Diagnostics diagnostics;
  const StillSettings stills = read_of("", diagnostics);
  EXPECT_TRUE(diagnostics.list().empty());
  EXPECT_FALSE(stills.labels);
  EXPECT_FALSE(stills.transparent);
  EXPECT_TRUE(stills.shots.empty());
}

TEST(StillKeys, ShotsHaveAKindACameraAndASection) {
  Diagnostics diagnostics;
  const StillSettings stills = read_of(
      "[stills]\nkinds = []\nlabels = false\ntransparent = true\n"
      "[[stills.shot]]\ncamera = \"left\"\n"
      "[[stills.shot]]\nkind = \"deviation\"\nsection = \"y=-2.5\"\n"
      "[[stills.shot]]\nsection_in = [[1, 0, 0], [0, 0, 4]]\n",
      diagnostics);
  EXPECT_TRUE(diagnostics.list().empty());
  EXPECT_EQ(stills.labels, false);
  EXPECT_TRUE(stills.transparent);
  EXPECT_TRUE(stills.any());
  ASSERT_EQ(stills.shots.size(), 3U);
  EXPECT_EQ(stills.shots[0].camera, "left");
  EXPECT_FALSE(stills.shots[0].section);
  EXPECT_EQ(stills.shots[1].section->point_W, Vec3(0, -2.5, 0));
  EXPECT_EQ(stills.shots[1].section->normal_W, Vec3(0, -1, 0));
  EXPECT_TRUE(stills.shots[2].section->point_W.isApprox(Vec3(25.4, 0, 0)));
  EXPECT_EQ(stills.shots[2].section->normal_W, Vec3(0, 0, 1));
}

TEST(StillKeys, FaultsAreToldAtTheirLine) {
  const std::string shot = "[[stills.shot]]\n";
  for (const char* plane :
       {"w=1", "x=", "x=nan", "x=inf", "x=1 mm", "1,2,3", "0,0,0,0,0,0", "0,0,0,1,0,nan", "0,0,0,1,0,0,7"})
    EXPECT_EQ(still_fault(shot + "section = \"" + plane + "\"\n"), "bad-section 2") << plane;
  EXPECT_EQ(still_fault(shot + "section_mm = [[0,0,0],[0,0,0]]\n"), "bad-section 2");
  EXPECT_EQ(still_fault(shot + "section = \"x=1\"\nsection_mm = [[0,0,0],[0,0,1]]\n"), "two-sections 3");
  EXPECT_EQ(still_fault(shot + "kind = \"fan\"\nsection = \"x\"\n"), "bad-section 3");
  EXPECT_EQ(still_fault(shot + "camera = \"drone\"\n"), "unknown-camera 2");
}

/// The code of what is thrown; "" for nothing.
std::string refusal(const std::string& shot, bool has_design) {
  Diagnostics diagnostics;
  const StillSettings stills = read_of("[[stills.shot]]\n" + shot, diagnostics);
  try {
    require_still_shots(stills, {Vec3(0, 0, -10), Vec3(40, 30, 0)}, has_design);
  } catch (const InputError& error) {
    const Diagnostic& found = error.diagnostics.list().front();
    return found.code + " " + std::to_string(found.where.line) + " " + found.fix;
  }
  return "";
}

TEST(StillShots, ThatShowNothingAreRefused) {
  EXPECT_EQ(refusal("section = \"x=20\"\n", false), "");
  EXPECT_EQ(refusal("section = \"x=40\"\n", false), "section-misses 1 the stock reaches x from 0 to 40 mm");
  EXPECT_EQ(refusal("section = \"0,0,5,1,0,1\"\n", false), "");
  EXPECT_EQ(refusal("section = \"0,0,50,1,0,1\"\n", false).substr(0, 14), "section-misses");
  EXPECT_EQ(refusal("kind = \"deviation\"\n", true), "");
  EXPECT_EQ(refusal("kind = \"deviation\"\n", false).substr(0, 18), "nothing-measured 1");
}

TEST(SectionWords, NameTheAxisWhereThereIsOne) {
  EXPECT_EQ(section_words(*section_named("z=-2.5")), "z = -2.5 mm");
  EXPECT_EQ(section_words(*section_named("1,2,3,0,0,-5")), "z = 3 mm");
  EXPECT_EQ(section_words(*section_named("1,2,3,3,0,4")), "plane through 1, 2, 3 mm, normal 0.6, 0, 0.8");
}

}  // namespace
}  // namespace swarf::sim
