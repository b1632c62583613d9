// The one judge: what counts, what is loosened only in writing, and what is never green.
#include "sim/judge/judge.h"
#include "sim/judge/limit_text.h"
#include "sim/judge/unlimited_gouge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "sim/judge/findings.h"
#include "sim/simulation.h"

namespace swarf::sim {
namespace {

/// A CL job with a plane as its design and a gouge limit; nothing wrong with it.
class Judge : public testing::Test {
 protected:
  void SetUp() override {
    job_.scene.kind = ProgramKind::kCl;
    job_.scene.file = "scene.toml";
    job_.scene.program_file = "path.cl";
    job_.design.push_back(nullptr);  // the judge only asks whether there is one
    job_.scene.accept.gouge_max_um = 1.0;
    toolpath::BlockMove move;
    move.feed_mm_s = 5.0;
    move.spindle_rpm = 8000.0;
    result_.main.path.elements.push_back({move, 0, {"path.cl", 0, 0}});
    result_.main.surface.gouge_max_um = 0.2;
    result_.main.surface.gouge_bound = measure::Bound{0.25, {}};
    result_.cross_check = compared(3.0, 4.0, true);
  }

  static measure::CrossCheck compared(double max_um, double bound_um, bool holds) {
    measure::CrossCheck check;
    check.max_um = max_um;
    check.bound_um = bound_um;
    check.holds = holds;
    check.samples = 100;
    return check;
  }
  void find(BadCutKind kind) {
    result_.cut.state.bad_cuts.push_back({kind, {"flutes", 0, {}, 0, 0.5, {}, Vec3::Zero()}});
  }
  void fault(const char* code) {
    motion::MotionFinding finding;
    finding.code = code;
    result_.main.motion.findings.push_back(finding);
  }

  /// Judges, and holds findings and verdict to the list.
  Check judged(const std::string& name) {
    result_.checks = judge(job_, result_);
    result_.findings = find_faults(job_, result_);
    for (const Check& check : result_.checks) {
      const bool breaks = check.outcome == Outcome::kFails || check.outcome == Outcome::kNotProven;
      const bool told = std::any_of(result_.findings.begin(), result_.findings.end(), [&](const Finding& f) {
        return f.check == check.name && f.severity == Severity::kError;
      });
      EXPECT_EQ(breaks, told) << check.name;
      EXPECT_TRUE(check.outcome != Outcome::kNotJudged || !check.reason.empty()) << check.name;
    }
    const bool errors = std::any_of(result_.findings.begin(), result_.findings.end(),
                                    [](const Finding& f) { return f.severity == Severity::kError; });
    EXPECT_EQ(passes(result_), !errors);
    const Check* found = find_check(result_.checks, name);
    EXPECT_NE(found, nullptr) << name;
    return found != nullptr ? *found : Check{};
  }
  Outcome outcome(const std::string& name) { return judged(name).outcome; }

  Job job_;
  Result result_;
};

TEST_F(Judge, PassesACleanRunAndSaysWhatItDidNotLookAt) {
  EXPECT_EQ(outcome("gouge"), Outcome::kHolds);
  EXPECT_TRUE(passes(result_));
  const std::string sentence = verdict_sentence(result_.checks);
  EXPECT_TRUE(sentence.starts_with("PASS: ")) << sentence;
  EXPECT_NE(sentence.find("not judged: "), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("excess, scallop (no limit in [accept])"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("machine parts (the machine has no meshes"), std::string::npos) << sentence;
}

TEST_F(Judge, ARunThatWasNotFinishedDoesNotPass) {
  EXPECT_FALSE(passes(Result{}));
}

TEST_F(Judge, WhatNoToolAndNoAxisMayDoCountsUnlessItIsLoosenedInWriting) {
  struct Case {
    const char* name;
    int* limit;
  };
  AcceptLimits& accept = job_.scene.accept;
  result_.clearance.events.resize(2);
  find(BadCutKind::kRapid);
  find(BadCutKind::kRapid);
  find(BadCutKind::kSpindleStands);
  find(BadCutKind::kSpindleReversed);
  for (const char* code : {"travel", "unreachable", "axis-speed", "axis-speed"}) fault(code);
  for (const Case& one : {Case{"collisions", &accept.collisions},
                          {"rapids_in_material", &accept.rapids_in_material},
                          {"spindle_wrong", &accept.spindle_wrong},
                          {"travel", &accept.travel},
                          {"axis_speed", &accept.axis_speed}}) {
    EXPECT_EQ(judged(one.name).value, 2.0) << one.name;
    EXPECT_EQ(outcome(one.name), Outcome::kFails) << one.name;
    *one.limit = 1;
    EXPECT_EQ(outcome(one.name), Outcome::kFails) << one.name;
    *one.limit = 2;
    EXPECT_EQ(outcome(one.name), Outcome::kHolds) << one.name;
  }
  EXPECT_TRUE(passes(result_)) << verdict_sentence(result_.checks);
  // Loosened is not hidden: the findings stay, as warnings.
  EXPECT_EQ(result_.findings.size(), 10U);
}

TEST_F(Judge, AGougeWithinItsLimitButABoundBeyondItIsNotProven) {
  result_.main.surface.gouge_bound = measure::Bound{1.31, {1.0, 2.0, 3.0}};
  const Check check = judged("gouge");
  EXPECT_EQ(check.outcome, Outcome::kNotProven);
  EXPECT_FALSE(passes(result_));
  EXPECT_NE(check.reason.find("not proven below 1 um: proven 1.310 um at (1.000, 2.000, 3.000)"),
            std::string::npos)
      << check.reason;
  EXPECT_NE(result_.findings.front().text.find("not proven below 1 um"), std::string::npos);
  EXPECT_FALSE(result_.findings.front().fix.empty());
  result_.main.surface.gouge_bound->um = 0.999;
  EXPECT_EQ(outcome("gouge"), Outcome::kHolds);
  EXPECT_EQ(judged("gouge").bound, 0.999);
}

TEST_F(Judge, NumbersReadOnTheSideOfTheirLimitOnWhichTheyAre) {
  job_.scene.accept.gouge_max_um = 1.001;
  result_.main.surface.gouge_bound = measure::Bound{1.0014, {}};
  const Check open = judged("gouge");
  EXPECT_EQ(open.outcome, Outcome::kNotProven);
  EXPECT_NE(open.reason.find("not proven below 1.001 um: proven 1.0014 um"), std::string::npos)
      << open.reason;
  EXPECT_NE(result_.findings.front().fix.find("allow 1.002 um"), std::string::npos)
      << result_.findings.front().fix;
  job_.scene.accept.gouge_max_um = 1.0015;
  result_.main.surface.gouge_max_um = 1.00151;
  const Check broken = judged("gouge");
  EXPECT_EQ(broken.outcome, Outcome::kFails);
  EXPECT_NE(broken.what.find("1.002 um"), std::string::npos) << broken.what;
  job_.scene.accept.gouge_max_um = 1.002;
  result_.main.surface.gouge_max_um = 1.00201;
  EXPECT_NE(judged("gouge").what.find("1.00201 um"), std::string::npos) << judged("gouge").what;
}

TEST(LimitText, IsThatOfItsWriterAndOfACalculationSixDigits) {
  EXPECT_EQ(limit_text(10.05), "10.05");
  EXPECT_EQ(limit_text(0.0), "0");
  EXPECT_EQ(limit_text(1.0000001), "1.0000001");
  EXPECT_EQ(limit_text(9.388836393590777), "9.38884");
}

TEST_F(Judge, AProofThatWasStoppedIsToldAsStopped) {
  result_.main.surface.gouge_bound.reset();
  result_.stopped = true;
  const Check check = judged("gouge");
  EXPECT_EQ(check.outcome, Outcome::kNotProven);
  EXPECT_NE(check.reason.find("the run was stopped"), std::string::npos) << check.reason;
  ASSERT_FALSE(result_.findings.empty());
  EXPECT_EQ(result_.findings.front().fix.find("pitch"), std::string::npos) << result_.findings.front().fix;
}

TEST_F(Judge, RaysAloneProveNothing) {
  result_.main.surface.gouge_bound.reset();
  EXPECT_EQ(outcome("gouge"), Outcome::kNotProven);
  EXPECT_FALSE(passes(result_));
  EXPECT_NE(judged("gouge").reason.find("not proven below 1 um"), std::string::npos);
}

TEST_F(Judge, WithoutADesignNothingOfTheSurfaceIsJudged) {
  job_.design.clear();
  result_.cross_check.reset();
  for (const char* name : {"gouge", "excess", "scallop", "uncut", "stock_and_rays"}) {
    const Check check = judged(name);
    EXPECT_EQ(check.outcome, Outcome::kNotJudged) << name;
    EXPECT_FALSE(check.value.has_value()) << name;
    EXPECT_EQ(check.reason, "no design") << name;
  }
  EXPECT_NE(
      verdict_sentence(result_.checks).find("gouge, excess, scallop, uncut, stock and rays (no design)"),
      std::string::npos)
      << verdict_sentence(result_.checks);
}

TEST_F(Judge, AMeshIsNotComparedWithTheLevelSetAndSaysSo) {
  job_.design.clear();
  job_.design_mesh = std::make_shared<TriMesh>();
  result_.cross_check.reset();
  EXPECT_EQ(outcome("stock_and_rays"), Outcome::kNotJudged);
}

TEST_F(Judge, ASilentProgramIsNotCheckedForItsSpindle) {
  toolpath::BlockMove block = result_.main.path.elements.block(0);
  block.spindle_rpm.reset();
  result_.main.path.elements = toolpath::Elements({{block, 0, {"path.cl", 0, 0}}});
  const Check check = judged("spindle_wrong");
  EXPECT_EQ(check.outcome, Outcome::kNotJudged);
  EXPECT_FALSE(check.value.has_value());
  EXPECT_NE(verdict_sentence(result_.checks).find("spindle wrong (the program does not say when it turns)"),
            std::string::npos);
}

TEST_F(Judge, FailedChecksOfItselfFailTheRun) {
  result_.cut.broken_invariant = "8 (values differ)";
  EXPECT_EQ(outcome("stock_invariants"), Outcome::kFails);
  result_.cut.broken_invariant.clear();
  result_.cross_check = compared(5.0, 4.0, false);
  EXPECT_EQ(outcome("stock_and_rays"), Outcome::kFails);
  result_.cross_check = compared(3.0, 4.0, true);
  result_.main.motion.statistics.fk_ik_error_max_mm = std::nan("");
  EXPECT_EQ(outcome("round_trip"), Outcome::kFails);
}

TEST_F(Judge, AFailedCrossCheckIsNotHiddenByAnotherSurface) {
  const auto both = measure::combine({compared(5.0, 4.0, false), compared(9.0, 10.0, true)});
  ASSERT_TRUE(both.has_value());
  EXPECT_FALSE(both->holds);
  EXPECT_EQ(both->max_um, 5.0);
  EXPECT_EQ(both->samples, 200U);
  const auto turned = measure::combine({compared(9.0, 10.0, true), compared(5.0, 4.0, false)});
  EXPECT_EQ(turned->max_um, 5.0);
  EXPECT_FALSE(measure::combine({}).has_value());
  EXPECT_FALSE(measure::combine({measure::CrossCheck{}}).has_value()) << "nothing was compared";
}

/// Flutes all the way up.
cutter::Cutter bare(int number) {
  cutter::Cutter tool;
  tool.number = number;
  tool.flute_length_mm = tool.length_mm;
  tool.holder = {{tool.diameter_mm, tool.diameter_mm, 1.0}};
  return tool;
}

TEST_F(Judge, OfToolsAtWorkThatHaveNeitherShankNorHolderTheVerdictSaysWhich) {
  toolpath::BlockMove second = result_.main.path.elements.block(0);
  second.tool = 1;
  const auto two_tools = [&] {
    toolpath::Elements elements = result_.main.path.elements;
    elements.push_back({second, 0, {"path.cl", 0, 0}});
    return elements;
  };
  job_.scene.tools = {cutter::Cutter{}, bare(2)};
  EXPECT_EQ(outcome("collisions"), Outcome::kHolds);
  EXPECT_EQ(judged("collisions").unseen, "") << "T2 does not move";
  const toolpath::Elements first_alone = result_.main.path.elements;
  result_.main.path.elements = two_tools();
  EXPECT_EQ(outcome("collisions"), Outcome::kHolds);
  EXPECT_NE(verdict_sentence(result_.checks).find("; not looked at: shank and holder of T2 (none are known)"),
            std::string::npos)
      << verdict_sentence(result_.checks);
  EXPECT_NE(judged("collisions").reason.find("not looked at: shank and holder of T2"), std::string::npos);
  // A tool with a holder that only lies in the magazine makes nothing looked at.
  job_.scene.tools = {bare(1), cutter::Cutter{}};
  result_.main.path.elements = first_alone;
  EXPECT_EQ(outcome("collisions"), Outcome::kNotJudged);
}

TEST_F(Judge, WhereAToolOfFlutesAloneIsBuriedItsUpperEndIsAContact) {
  job_.scene.tools = {bare(1)};
  EXPECT_EQ(outcome("collisions"), Outcome::kNotJudged);
  result_.clearance.events.resize(1);
  result_.clearance.events.front().part = "holder";
  EXPECT_EQ(outcome("collisions"), Outcome::kFails);
}

TEST_F(Judge, WhatAnAssumedBlockIsFreeOfSaysThatItIsAssumed) {
  job_.scene.stock.auto_box = true;
  EXPECT_EQ(outcome("rapids_in_material"), Outcome::kHolds);
  EXPECT_NE(verdict_sentence(result_.checks)
                .find("rapids in material: contacts of 0.000 mm and more with the "
                      "block that is assumed"),
            std::string::npos)
      << verdict_sentence(result_.checks);
}

TEST(Verdict, ChecksThatSeeByDifferentMeansAreNotToldAsOne) {
  const auto held = [](const char* name, const char* covers) {
    Check check{name, name};
    check.outcome = Outcome::kHolds;
    check.covers = covers;
    return check;
  };
  const std::vector<Check> checks = {held("collisions", "contacts of 0.200 mm and more"),
                                     held("rapids_in_material", "contacts of 0.200 mm and more"),
                                     held("flank_limit", "rays 0.5 mm apart")};
  EXPECT_EQ(
      verdict_sentence(checks),
      "PASS: 3 checks hold (collisions, rapids in material: contacts of 0.200 mm and more; flank limit: "
      "rays 0.5 mm apart)");
}

TEST_F(Judge, WithoutALimitTheGreaterOfGougeAndMissingMaterialFails) {
  const auto fails = [](double gouge_um, double missing_um) {
    measure::SurfaceMetrics surface;
    surface.gouge_max_um = gouge_um;
    surface.missing_max_um = missing_um;
    return unlimited_gouge(surface);
  };
  EXPECT_EQ(fails(100.0, 10.0), UnlimitedGouge::kNone);
  EXPECT_EQ(fails(100.1, 10.0), UnlimitedGouge::kCut);
  EXPECT_EQ(fails(50.0, 20.0), UnlimitedGouge::kMissing);
  EXPECT_EQ(fails(5000.0, 20.0), UnlimitedGouge::kCut);
  EXPECT_EQ(fails(5000.0, 5000.0), UnlimitedGouge::kMissing) << "what is missing counts as a gouge too";
  EXPECT_EQ(fails(4000.0, 6870.0), UnlimitedGouge::kMissing);
}

}  // namespace
}  // namespace swarf::sim
