#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "program/cl/steps.h"

namespace swarf::program::cldata {
namespace {

struct KindName {
  const char* word;
  ClCycleKind kind;
};
constexpr std::array kKinds{KindName{"DRILL", ClCycleKind::kDrill},      KindName{"FACE", ClCycleKind::kFace},
                            KindName{"CSINK", ClCycleKind::kFace},       KindName{"DEEP", ClCycleKind::kDeep},
                            KindName{"BRKCHP", ClCycleKind::kChipBreak}, KindName{"BORE", ClCycleKind::kBore},
                            KindName{"REAM", ClCycleKind::kBore},        KindName{"TAP", ClCycleKind::kTap}};
constexpr const char* kForm =
    "write CYCLE/DRILL,DEPTH,20,MMPM,100,CLEAR,5 (kinds DRILL FACE CSINK DEEP BRKCHP BORE REAM TAP; words "
    "DEPTH or FEDTO, a feed, CLEAR or RAPTO, RTRCTO or RETURN, DWELL, STEP), CYCLE/ON with the words that "
    "change, or CYCLE/OFF";
constexpr double kNotGiven = -1.0;

bool is_feed(const std::string& word) {
  static constexpr std::array kUnits{"MMPM", "MMPR", "IPM", "IPR", "PERMIN", "PERREV"};
  return std::find(kUnits.begin(), kUnits.end(), word) != kUnits.end();
}

bool read_retract(Reporter& reporter, ClSystems& systems, const ClStatement& s, size_t& at, ClCycle& cycle) {
  const ClArgument& value = s.arguments[at + 1];
  const bool manual = at + 2 < s.arguments.size() && s.arguments[at + 2].text == "MANUAL";
  if (value.text == "AUTO") {
    // NX: back to where the tool stood before the cycle; the posts that NX ships make G98 of it.
    cycle.retract_to_start = true;
  } else if (!value.number) {
    fault(reporter, "wrong-arguments", value,
          fmt::format("{} is followed by '{}'", s.arguments[at].text, value.text), kForm);
    return false;
  } else if (s.arguments[at].text == "RETURN" && value.value == 0.0) {
    fault(reporter, "unsupported-word", value, "RETURN,0 goes back to a plane that only the operation knows",
          "write RETURN with a distance above the hole");
    return false;
  } else {
    cycle.retract_mm = systems.mm(value.value);
    cycle.retract_to_start = false;
  }
  at += manual ? 3 : 2;
  return true;
}

bool read_cycle_word(Reporter& reporter, ClSystems& systems, ClRates& feed, const ClStatement& s, size_t& at,
                     ClCycle& cycle) {
  const ClArgument& key = s.arguments[at];
  const std::string& word = key.text;
  if (key.number || at + 1 == s.arguments.size()) {
    fault(reporter, "wrong-arguments", key, "CYCLE takes a word and a number by turns", kForm);
    return false;
  }
  if (word == "RTRCTO" || word == "RETURN") return read_retract(reporter, systems, s, at, cycle);
  const ClArgument& value = s.arguments[at + 1];
  const bool known = is_feed(word) || word == "FEDTO" || word == "DEPTH" || word == "CLEAR" ||
                     word == "RAPTO" || word == "DWELL" || word == "STEP" || word == "INCR" ||
                     word == "STPECK" || word == "SUBPECK";
  if (!known) {
    fault(reporter, "unsupported-word", key, fmt::format("CYCLE with '{}' is not followed", word), kForm);
    return false;
  }
  if (!value.number) {
    fault(reporter, "wrong-arguments", value, fmt::format("{} is followed by '{}'", word, value.text), kForm);
    return false;
  }
  at += 2;
  if (is_feed(word)) {
    cycle.feed_mm_s = feed_of(reporter, systems, feed, value, word);
    return cycle.feed_mm_s > 0.0;
  }
  // FEDTO is a height over the point, DEPTH a way into the material.
  if (word == "FEDTO") cycle.depth_mm = -systems.mm(value.value);
  if (word == "DEPTH") cycle.depth_mm = systems.mm(value.value);
  if (word == "CLEAR") cycle.arrive_mm = systems.mm(value.value);
  if (word == "RAPTO") cycle.clear_mm = systems.mm(value.value);
  if (word == "DWELL") cycle.dwell_s = value.value;
  if (word == "STEP" || word == "INCR" || word == "SUBPECK") cycle.step_mm = systems.mm(value.value);
  if (word == "STPECK") cycle.first_step_mm = systems.mm(value.value);
  return true;
}

/// CYCLE/kind,z,feed,unit,[t,]r[,i] of Creo (cycle_format fixed): depth, feed, threads per inch of TAP,
/// clearance, step of DEEP.
bool read_fixed_cycle(ClState& cl, const ClStatement& s, ClCycle& cycle) {
  const std::vector<ClArgument>& a = s.arguments;
  const bool tap = cycle.kind == ClCycleKind::kTap, deep = cycle.kind == ClCycleKind::kDeep;
  const bool form =
      cl.program.writer == ClWriter::kCreo &&
      fits(s, fmt::format("{} ## {} {}", a[0].text, a.size() > 3 ? a[3].text : "", tap || deep ? "##" : "#"));
  if (!form || !is_feed(a[3].text)) {
    fault(cl.reporter, "wrong-arguments", s, "CYCLE takes a word and a number by turns", kForm);
    return false;
  }
  cycle.depth_mm = cl.systems.mm(a[1].value);
  cycle.feed_mm_s = feed_of(cl.reporter, cl.systems, cl.feed, a[2], a[3].text);
  cycle.clear_mm = cl.systems.mm(a[tap ? 5 : 4].value);
  if (deep) cycle.step_mm = cl.systems.mm(a[5].value);
  return cycle.feed_mm_s > 0.0;
}

/// The kind, or NX's DRILL with DEEP or BRKCHP behind it; ON: the words of the cycle before. `at`: of the
/// first word after it.
bool read_cycle_kind(Reporter& reporter, ClDrilling& drilling, const ClStatement& s, size_t& at,
                     ClCycle& cycle) {
  at = 1;
  const auto word = [&](size_t i) { return i < s.arguments.size() ? s.arguments[i].text : std::string(); };
  if (word(0) == "ON") {
    if (drilling.cycle_words) cycle = *drilling.cycle_words;
    if (!drilling.cycle_words)
      fault(reporter, "bad-cycle", s, "CYCLE/ON changes the words of a cycle, and none stands before it",
            kForm);
    return drilling.cycle_words.has_value();
  }
  const auto* kind = std::find_if(kKinds.begin(), kKinds.end(),
                                  [&](const KindName& known) { return word(0) == known.word; });
  if (kind == kKinds.end()) {
    fault(reporter, "unsupported-word", s, "this CYCLE is not followed", kForm);
    return false;
  }
  cycle.kind = kind->kind;
  cycle.retract_mm = cycle.arrive_mm = cycle.clear_mm = kNotGiven;
  if (word(0) == "DRILL" && (word(1) == "DEEP" || word(1) == "BRKCHP")) {
    cycle.kind = word(1) == "DEEP" ? ClCycleKind::kDeep : ClCycleKind::kChipBreak;
    at = 2;
  }
  return true;
}

/// False with a fault when the cycle contradicts itself.
bool cycle_fits(Reporter& reporter, const ClStatement& s, const ClCycle& cycle) {
  const bool pecks = cycle.kind == ClCycleKind::kDeep || cycle.kind == ClCycleKind::kChipBreak;
  std::string what;
  if (!(cycle.depth_mm > 0.0)) what = fmt::format("its depth is {:g} mm", cycle.depth_mm);
  if (!(cycle.clear_mm > 0.0)) what = fmt::format("its clearance is {:g} mm", cycle.clear_mm);
  if (cycle.retract_mm < cycle.clear_mm)
    what = fmt::format("it retracts to {:g} mm, below its clearance of {:g} mm", cycle.retract_mm,
                       cycle.clear_mm);
  if (cycle.dwell_s < 0.0) what = fmt::format("it dwells for {:g} s", cycle.dwell_s);
  if (cycle.first_step_mm != 0.0 && !(cycle.first_step_mm > kPeckGap))
    what = fmt::format("its first step is {:g} mm, and {:g} mm are left free above the ground",
                       cycle.first_step_mm, kPeckGap);
  if (pecks && !(cycle.step_mm > kPeckGap))
    what = fmt::format("its step is {:g} mm, and {:g} mm are left free above the ground", cycle.step_mm,
                       kPeckGap);
  if (!(cycle.feed_mm_s > 0.0)) what = "it has no feed, and no FEDRAT stands before it";
  if (what.empty()) return true;
  fault(reporter, "bad-cycle", s, "the cycle cannot be run: " + what, kForm);
  return false;
}

}  // namespace

bool read_cycle(ClState& cl, const ClStatement& s, ClCycle& cycle) {
  size_t at = 0;
  if (!read_cycle_kind(cl.reporter, cl.drilling, s, at, cycle)) return false;
  if (at < s.arguments.size() && s.arguments[at].number) {
    if (!read_fixed_cycle(cl, s, cycle)) return false;
  } else {
    while (at < s.arguments.size()) {
      if (!read_cycle_word(cl.reporter, cl.systems, cl.feed, s, at, cycle)) return false;
    }
  }
  cl.drilling.cycle_words = cycle;
  const bool both = cycle.arrive_mm != kNotGiven && cycle.clear_mm != kNotGiven;
  if (both && cl.program.writer != ClWriter::kCreo) {
    fault(cl.reporter, "bad-cycle", s,
          "the cycle has CLEAR and RAPTO: Creo counts RAPTO from CLEAR, others from the hole",
          "write one of them");
    return false;
  }
  if (both) cycle.clear_mm = cycle.arrive_mm - cycle.clear_mm;  // Creo: further down in rapid
  if (cycle.arrive_mm == kNotGiven) cycle.arrive_mm = std::max(0.0, cycle.clear_mm);
  if (cycle.clear_mm == kNotGiven) cycle.clear_mm = cycle.arrive_mm;
  if (cycle.retract_mm == kNotGiven) cycle.retract_mm = cycle.arrive_mm;
  return cycle_fits(cl.reporter, s, cycle);
}

}  // namespace swarf::program::cldata
