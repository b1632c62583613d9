#include <fmt/format.h>

#include <array>
#include <utility>

#include "program/cl_interpreter.h"

namespace swarf::program {
namespace {

struct KindName {
  const char* word;
  ClCycleKind kind;
};
constexpr std::array kKinds{
    KindName{"DRILL", ClCycleKind::kDrill}, KindName{"FACE", ClCycleKind::kFace},
    KindName{"DEEP", ClCycleKind::kDeep},   KindName{"BRKCHP", ClCycleKind::kChipBreak},
    KindName{"BORE", ClCycleKind::kBore},   KindName{"TAP", ClCycleKind::kTap}};
constexpr const char* kForm =
    "write CYCLE/DRILL,DEPTH,20,MMPM,100,CLEAR,5 (kinds DRILL FACE DEEP BRKCHP BORE TAP; words DEPTH or "
    "FEDTO, "
    "a feed, CLEAR or RAPTO, RTRCTO, DWELL, STEP), or CYCLE/OFF";

bool is_feed(const std::string& word) {
  return word == "MMPM" || word == "MMPR" || word == "IPM" || word == "IPR" || word == "PERMIN" ||
         word == "PERREV";
}

}  // namespace

bool ClInterpreter::read_cycle_word(const ClStatement& s, size_t at, ClCycle& cycle) {
  const std::string& word = s.arguments[at].text;
  const ClArgument& value = s.arguments[at + 1];
  if (is_feed(word)) {
    cycle.feed_mm_s = feed_of(value, word);
    return cycle.feed_mm_s > 0.0;
  }
  if (word == "FEDTO") {
    // FEDTO is a height over the point, DEPTH a way into the material.
    cycle.depth_mm = -mm(value.value);
  } else if (word == "DEPTH") {
    cycle.depth_mm = mm(value.value);
  } else if (word == "CLEAR" || word == "RAPTO") {
    cycle.clear_mm = mm(value.value);
  } else if (word == "RTRCTO") {
    cycle.retract_mm = mm(value.value);
  } else if (word == "DWELL") {
    cycle.dwell_s = value.value;
  } else if (word == "STEP" || word == "INCR") {
    cycle.step_mm = mm(value.value);
  } else {
    fault("unsupported-word", s.arguments[at], fmt::format("CYCLE with '{}' is not followed", word), kForm);
    return false;
  }
  return true;
}

bool ClInterpreter::read_cycle(const ClStatement& s, ClCycle& cycle) {
  const KindName* kind = nullptr;
  for (const KindName& known : kKinds) {
    if (!s.arguments.empty() && s.arguments[0].text == known.word) kind = &known;
  }
  if (kind == nullptr || s.arguments.size() % 2 == 0) {
    fault(kind == nullptr ? "unsupported-word" : "wrong-arguments", s,
          kind == nullptr ? "this CYCLE is not followed" : "CYCLE has a word without its number", kForm);
    return false;
  }
  cycle.kind = kind->kind;
  constexpr double kNotGiven = -1.0;
  cycle.retract_mm = kNotGiven;
  for (size_t at = 1; at + 1 < s.arguments.size(); at += 2) {
    if (s.arguments[at].number || !s.arguments[at + 1].number) {
      fault("wrong-arguments", s.arguments[at], "CYCLE takes a word and a number by turns", kForm);
      return false;
    }
    if (!read_cycle_word(s, at, cycle)) return false;
  }
  if (cycle.retract_mm == kNotGiven) cycle.retract_mm = cycle.clear_mm;
  return cycle_fits(s, cycle);
}

bool ClInterpreter::cycle_fits(const ClStatement& s, const ClCycle& cycle) {
  const bool pecks = cycle.kind == ClCycleKind::kDeep || cycle.kind == ClCycleKind::kChipBreak;
  std::string what;
  if (!(cycle.depth_mm > 0.0)) what = fmt::format("its depth is {:g} mm", cycle.depth_mm);
  if (!(cycle.clear_mm > 0.0)) what = fmt::format("its clearance is {:g} mm", cycle.clear_mm);
  if (cycle.retract_mm < cycle.clear_mm)
    what = fmt::format("it retracts to {:g} mm, below its clearance of {:g} mm", cycle.retract_mm,
                       cycle.clear_mm);
  if (cycle.dwell_s < 0.0) what = fmt::format("it dwells for {:g} s", cycle.dwell_s);
  if (pecks && !(cycle.step_mm > kPeckGap))
    what = fmt::format("its step is {:g} mm, and {:g} mm are left free above the ground", cycle.step_mm,
                       kPeckGap);
  if (!(cycle.feed_mm_s > 0.0)) what = "it has no feed, and no FEDRAT stands before it";
  if (what.empty()) return true;
  fault("bad-cycle", s, "the cycle cannot be run: " + what, kForm);
  return false;
}

}  // namespace swarf::program
