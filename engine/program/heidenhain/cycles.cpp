// CYCL DEF and CYCL CALL: datum shifts, rotation, dwell, tilting, tolerance; drilling is only read here.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "program/heidenhain/steps.h"

namespace swarf::program::nc::heidenhain {
namespace {

struct CycleParameters {
  int number;
  std::vector<int> needed;
  std::vector<int> known;  ///< besides those needed
};

const std::vector<CycleParameters>& parameter_cycles() {
  static const std::vector<CycleParameters> cycles{
      {200, {200, 201, 206, 202, 203}, {210, 204, 211, 395}},
      {201, {200, 201, 206, 203}, {211, 208, 204}},
      {203, {200, 201, 206, 202, 203}, {210, 204, 212, 213, 205, 211, 208, 256, 395}},
      {205, {200, 201, 206, 202, 203}, {204, 212, 205, 258, 259, 257, 256, 211, 379, 253, 208, 395}},
      {206, {200, 201, 206, 203}, {211, 204}},
      {207, {200, 201, 239, 203}, {204}},
      {202, {200, 201, 206, 203}, {211, 208, 204, 214, 336}},
      {204, {200, 249, 250, 251, 252, 253, 254, 203, 214}, {255, 204, 336}},
      {208, {200, 201, 206, 334, 203, 335}, {204, 342, 351, 370}},
      {220, {216, 217, 244, 245, 246, 247, 241}, {200, 203, 204, 301, 365}},
      {221, {225, 226, 237, 238, 242, 243, 224}, {200, 203, 204, 301}},
      {240, {200, 343, 201, 206, 203}, {344, 211, 204, 342, 253}},
      {241,
       {200, 201, 206, 203},
       {211, 204, 379, 253, 208, 426, 427, 428, 429, 430, 435, 401, 202, 212, 205, 395}},
      {247, {339}, {}}};
  return cycles;
}

/// Cycles of the control that are not executed here.
bool known_cycle(int number) {
  constexpr int kOld[] = {3, 4, 5, 6, 12, 14, 15, 16, 17, 18, 20, 21, 22, 23, 24, 25, 27, 28, 29, 30, 39};
  return (number >= 200 && number <= 299) || (number >= 400 && number <= 499) ||
         (number >= 800 && number <= 899) || (number >= 1000 && number <= 1499) ||
         std::find(std::begin(kOld), std::end(kOld), number) != std::end(kOld);
}

/// Its Q parameters have their values from then on, as those of every cycle.
void builders_cycle(Parameters& parameters, BlockReader& reader) {
  while (!reader.done() && !reader.parameter_follows()) reader.skip();
  while (!reader.done()) {
    const Parameters::Name name = Parameters::name(reader);
    if (!reader.take_char('=')) reader.fail("missing-word", reader.offset(), "'=' is missing here", "Q200=2");
    parameters.set(name, reader.value());
  }
}

/// 19.1 A+0 B+45 C+0: spatial angles; without words, no tilted plane.
void tilt_cycle(Executor& executor, BlockReader& reader) {
  reader.done();
  const size_t start = reader.offset();
  if (reader.block().text.find("ABST") != std::string::npos ||
      reader.block().text.find("SET UP") != std::string::npos)
    reader.fail("unsupported-word", start, "whether cycle 19 turns the axes itself depends on the machine",
                "PLANE SPATIAL SPA+0 SPB+45 SPC+0 MOVE DIST50 F2000");
  const MotionWords words = read_motion_words(reader, kAxesAllowed | kFeedAllowed);
  const bool added = words.axes[3].incremental || words.axes[4].incremental || words.axes[5].incremental;
  if (words.any_linear() || words.feed != FeedWord::kNone || added)
    reader.fail("unsupported-word", start, "cycle 19 is supported with absolute A, B and C alone",
                "CYCL DEF 19.1 A+0 B+45 C+0");
  const Mat3 R = spatial_rotation(words.axes[3].value, words.axes[4].value, words.axes[5].value);
  tilt(executor, reader, R, words.any_rotary() && !R.isIdentity(0.0), start);
}

/// 32.1 T0.05, 32.2 HSC-MODE:1 TA0.5; 32.1 alone: the control's own tolerance.
void tolerance(nc::Control& control, BlockReader& reader, int part) {
  if (part > 1) {
    control.report.without_effect("CYCL DEF 32.2");
    control.report.note("CYCL DEF 32.2", reader.rest());
    return;
  }
  double width = 0.0;
  if (!reader.done()) {
    const size_t start = reader.offset();
    if (!reader.take("T")) refuse_word(reader, start, reader.take_letters());
    width = reader.value();
    if (!(width > 0.0)) reader.fail("out-of-range", start, "the tolerance is not above zero", "T0.05");
    reader.expect_end();
  }
  control.modal.corner_tolerance_mm = control.modal.mm(width);
}

/// Cycles 1 and 2: SET UP, DEPTH, PECKG, DWELL, F, or as German controls write them: ABST, TIEFE, ZUSTLG,
/// V.ZEIT; kept under the numbers of cycle 200.
void old_drilling(Drilling& drilling, BlockReader& reader, CycleNumber number) {
  reader.done();
  const size_t start = reader.offset();
  const std::string word(reader.take_letters());
  int key = 0;
  if (word == "SET") reader.take("UP"), key = Q::kClearance;
  if (word == "ABST") key = Q::kClearance;
  if (word == "DEPTH" || word == "TIEFE") key = Q::kDepth;
  if ((word == "PECKG" || word == "ZUSTLG") && number.number == 1) key = Q::kPeck;
  if (word == "DWELL" || (word == "V" && reader.take_char('.') && reader.take("ZEIT"))) key = Q::kDwellBelow;
  if (word == "F") key = Q::kFeed;
  if (key == 0) refuse_word(reader, start, word);
  const double value = reader.value();
  reader.expect_end();
  if (!drilling.cycle->q.emplace(key, value).second)
    reader.fail("word-twice", start, fmt::format("{} stands twice in this cycle", word), "keep one of them");
}

void old_cycle(Executor& executor, BlockReader& reader, CycleNumber number, size_t offset) {
  if (number.part == 0) {
    reader.rest();  // the cycle's name, in the language of the control
    executor.drilling.open_cycle = number.number;
    if (number.number <= 2) executor.drilling.cycle = Cycle{number.number, {}, offset};
    return;
  }
  if (executor.drilling.open_cycle != number.number)
    reader.fail("bad-cycle", offset,
                fmt::format("part {}.{} follows no {}.0", number.number, number.part, number.number),
                "write the parts of a cycle one after the other");
  switch (number.number) {
    case 7:
      return datum_shift(executor, reader);
    case 9: {
      if (!reader.value_follows()) reader.take_letters();
      if (reader.take_char('.')) reader.take_letters();
      reader.done();
      const size_t at = reader.offset();
      const double seconds = reader.value();
      reader.expect_end();
      if (!(seconds >= 0.0 && seconds <= 30000.0))
        reader.fail("out-of-range", at, fmt::format("{:g} s is no dwell", seconds), "0 to 30000 s");
      return nc::dwell(executor.control.report, executor.control.modal, seconds);
    }
    case 8:
      return mirror_image(executor, reader);
    case 10:
      return rotation(executor, reader);
    case 11:
      return scaling(executor, reader);
    case 26:
      return axis_scaling(executor, reader);
    case 13:  // the spindle turns to an angle
      executor.control.report.without_effect("CYCL DEF 13");
      reader.rest();
      return;
    case 19:
      return tilt_cycle(executor, reader);
    case 32:
      return tolerance(executor.control, reader, number.part);
    default:
      return old_drilling(executor.drilling, reader, number);
  }
}

/// Cycle 247: the work offset with this number. The control ends shift, mirror image, rotation and scaling
/// with it.
void preset(Executor& executor, BlockReader& reader, const Cycle& cycle) {
  const double number = cycle.q.at(Q::kPreset);
  const bool given =
      number >= 1.0 && number == std::floor(number) && number < 1e6 &&
      (number == 1.0 || executor.control.setup.work_offsets.count(static_cast<int>(number)) > 0);
  if (!given)
    reader.fail("unknown-offset", cycle.offset, fmt::format("there is no preset {:g}", number),
                "give the work offset with this number in the scene");
  if (executor.orientation.tilted)
    reader.fail("unsupported-word", cycle.offset,
                "a preset while the working plane is tilted is not supported",
                "write PLANE RESET STAY before it");
  nc::set_work_offset(executor.control, static_cast<int>(number));
  executor.frames.outer = Level();
  update_frame(executor);
}

/// CYCL DEF 200 NAME Q200=2 Q201=-20 ...; the values hold as Q parameters too.
void parameter_cycle(Executor& executor, BlockReader& reader, int number, size_t offset) {
  const auto& all = parameter_cycles();
  const auto& meant =
      *std::find_if(all.begin(), all.end(), [&](const CycleParameters& one) { return one.number == number; });
  Cycle cycle{number, {}, offset};
  // The cycle's name, in the language of the control, ends before the first Q parameter.
  while (!reader.done() && !reader.parameter_follows()) reader.skip();
  while (!reader.done()) {
    const size_t start = reader.offset();
    const Parameters::Name name = Parameters::name(reader);
    const auto in = [&](const std::vector<int>& list) {
      return std::find(list.begin(), list.end(), name.number) != list.end();
    };
    if (name.kind != 'Q' || (!in(meant.needed) && !in(meant.known)))
      reader.fail("unexpected-word", start,
                  fmt::format("{} is no parameter of cycle {}", Parameters::text_of(name), number),
                  "take it out");
    if (!reader.take_char('=')) reader.fail("missing-word", reader.offset(), "'=' is missing here", "Q200=2");
    double value = 0.0;
    const size_t at = (reader.done(), reader.offset());
    if (reader.take("FMAX") || reader.take("MAX")) {
      value = kRapidFeed;
      if (name.number != 208 && name.number != 253)
        reader.fail("unexpected-word", at, "FMAX is no value of this parameter", "write a number");
    } else if (reader.take("FAUTO") || reader.take("AUTO")) {
      value = executor.modes.tool_feed;
    } else {
      value = reader.value();
    }
    if (!cycle.q.emplace(name.number, value).second)
      reader.fail("word-twice", start,
                  fmt::format("{} stands twice in this cycle", Parameters::text_of(name)),
                  "keep one of them");
    executor.parameters.set_q(name.number, value);
  }
  for (const int needed : meant.needed) {
    if (cycle.q.count(needed) == 0)
      reader.fail("missing-word", offset, fmt::format("cycle {} needs Q{}", number, needed),
                  fmt::format("Q{}=...", needed));
  }
  if (number == 247) return preset(executor, reader, cycle);
  if (number == 220 || number == 221) return pattern_cycle(executor, reader, cycle);
  executor.drilling.cycle = cycle;
  executor.drilling.modal_call = false;
}

}  // namespace

void cycle_definition(Executor& executor, BlockReader& reader) {
  reader.done();
  const size_t offset = reader.offset();
  CycleNumber number;
  number.number = static_cast<int>(reader.whole_number_before_point(9999));
  if (reader.peek() == '.') {
    reader.skip();
    number.part = static_cast<int>(reader.whole_number(99));
  }
  const int old[] = {1, 2, 7, 8, 9, 10, 11, 13, 19, 26, 32};
  const bool is_old = std::find(std::begin(old), std::end(old), number.number) != std::end(old);
  if (is_old) {
    if (number.part < 0)
      reader.fail("missing-word", offset, "this cycle is written in parts", "CYCL DEF 7.0, CYCL DEF 7.1");
    return old_cycle(executor, reader, number, offset);
  }
  for (const CycleParameters& one : parameter_cycles()) {
    if (one.number == number.number) return parameter_cycle(executor, reader, number.number, offset);
  }
  if (executor.control.report.take_builder_word(fmt::format("CYCL DEF {}", number.number)))
    return builders_cycle(executor.parameters, reader);
  if (known_cycle(number.number))
    reader.fail("unsupported-word", offset,
                fmt::format("cycle {} is known, but not supported here", number.number),
                "1, 2, 7 to 11, 13, 19, 26, 32, 200 to 208, 220, 221, 240, 241 and 247 are");
  reader.fail("unknown-word", offset, fmt::format("there is no cycle {}", number.number),
              "CYCL DEF 200; a cycle of the machine's builder that moves nothing is named in builder_words");
}

/// CYCL CALL M3, CYCL CALL POS X+10 Y+20 Z+0 FMAX, CYCL CALL PAT FMAX.
void cycle_call(Executor& executor, BlockReader& reader, size_t start) {
  const bool pattern = reader.take("PAT"), at_position = !pattern && reader.take("POS");
  const unsigned feeds = pattern || at_position ? unsigned{kFeedAllowed} : 0u;
  const MotionWords words =
      read_motion_words(reader, kFunctionsAllowed | feeds | (at_position ? unsigned{kAxesAllowed} : 0u));
  functions_before(executor, reader, words);
  if (pattern) {
    nc::Motion motion = nc::Motion::kFeed;
    const double feed = feed_of(executor.control, executor.modes, reader, words, motion);
    call_pattern(executor, reader, motion, feed, start);
    return functions_after(executor, reader, words.functions);
  }
  if (at_position) {
    if (words.any_rotary() || words.axes[2])
      reader.fail("unsupported-word", start, "CYCL CALL POS is supported with X and Y alone",
                  "the height is the cycle's Q203");
    Element element;
    element.offset = start;
    element.target = target_of(executor.control, executor.modes, executor.frames, reader, words);
    element.place = executor.control.report.place;
    element.feed = feed_of(executor.control, executor.modes, reader, words, element.motion);
    element.target.column = element.place.column;
    element.from = present(executor.control, executor.path);
    element.to = end_of(executor.control, executor.path, element.target);
    if (element.target.any()) emit(executor, element);
  }
  run_cycle(executor, reader, start);
  functions_after(executor, reader, words.functions);
}

}  // namespace swarf::program::nc::heidenhain
