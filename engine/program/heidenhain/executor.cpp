#include "program/heidenhain/dialect.h"
#include "program/heidenhain/steps.h"

#include <fmt/format.h>

namespace swarf::program::nc::heidenhain {
namespace {

void assignment(Parameters& parameters, BlockReader& reader) {
  const Parameters::Name name = Parameters::name(reader);
  if (!reader.take_char('=')) {
    reader.done();
    reader.fail("missing-word", reader.offset(), "'=' is missing here", "Q1 = Q2 + 10");
  }
  parameters.assign(reader, name);
}

void begin_program(nc::Control& control, Parameters& parameters, Modes& modes, BlockReader& reader,
                   size_t start) {
  if (!reader.take("PGM"))
    reader.fail("missing-word", start, "BEGIN without PGM", "BEGIN PGM NAME MM (or INCH)");
  const std::string_view rest = reader.rest();
  const bool inch = rest.ends_with(" INCH"), mm = rest.ends_with(" MM");
  if (!inch && !mm)
    reader.fail("missing-word", start, "BEGIN PGM says neither MM nor INCH", "BEGIN PGM NAME MM (or INCH)");
  if (modes.begun && control.modal.inches() != inch) {
    reader.fail("unsupported-word", start, "a called program has the other unit",
                "write both programs in MM, or both in INCH");
  }
  modes.begun = true;
  nc::set_inches(control.modal, inch);
  parameters.set_q(113, inch ? 1.0 : 0.0);
}

/// FN 17: SYSWRITE ID420 NR0 IDX0=Q1. What it changes stands in tables of the control.
void write_system_data(nc::Control& control, BlockReader& reader, size_t start) {
  const std::string what(reader.rest());
  control.report.without_effect(fmt::format("FN 17: {} (data of the control)", what));
  control.report.note("FN 17", what);
  control.report.warn_once(
      "system-data-written", reader.column(start),
      fmt::format("FN 17: {} writes data of the control, which are not simulated: offsets "
                  "and kinematics stay what they are",
                  what),
      "write them as TRANS DATUM, cycle 247 or M128 where they move the path");
}

/// FN 18: SYSREAD Q1 = ID50 NR4 IDX0. The value is the machine's: the parameter has none from here on, and a
/// block that reads it is refused.
void read_system_data(nc::Control& control, Parameters& parameters, BlockReader& reader, size_t start) {
  reader.take("SYSREAD");
  const Parameters::Name name = Parameters::name(reader);
  if (!reader.take_char('='))
    reader.fail("missing-word", reader.offset(), "'=' is missing here", "FN 18: SYSREAD Q1 = ID50 NR4 IDX0");
  const std::string what(reader.rest());
  parameters.forget(name);
  control.report.without_effect(fmt::format("FN 18: {} (data of the control)", what));
  control.report.note("FN 18", what);
  control.report.warn_once(
      "system-data-read", reader.column(start),
      fmt::format("FN 18 reads {} of the control, which is not known here: {} has no value", what,
                  Parameters::text_of(name)),
      "assign the parameter where its value matters");
}

/// TCH PROBE 408 .. Q321=..: what it measures is not in the program. The cycle's own parameters hold; those
/// of results have no value from here on.
void probe(nc::Control& control, Parameters& parameters, BlockReader& reader, size_t start) {
  reader.done();
  const size_t at = reader.offset();
  const long number = reader.whole_number_before_point(9999);
  const std::string word = fmt::format("TCH PROBE {}", number);
  control.report.without_effect(word);
  control.report.warn_once("probing", reader.column(start),
                           fmt::format("{} measures on the machine: its moves and what it sets (datum, tool "
                                       "data, results in Q parameters) are not simulated",
                                       word),
                           "give the datum as it is after measuring in the scene, or post without probing");
  constexpr int kFirstResult = 110, kLastResult = 199;
  for (int result = kFirstResult; result <= kLastResult; ++result) {
    if (result < 113 || result > 114) parameters.forget({'Q', result});  // Q113, Q114: unit, tool length
  }
  reader.move_to(at);
  while (!reader.done() && !reader.parameter_follows()) reader.skip();
  while (!reader.done()) {
    const Parameters::Name name = Parameters::name(reader);
    if (!reader.take_char('=')) {  // TCH PROBE 0.0 REF. PLANE Q5 X-: the result goes there
      parameters.forget(name);
      break;
    }
    if (name.kind == 'S')
      reader.text_value();
    else if (!reader.take("FMAX") && !reader.take("MAX") && !reader.take("FAUTO"))
      parameters.set(name, reader.value());
  }
  reader.rest();
}

void function_number(nc::Control& control, Flow& flow, Parameters& parameters, BlockReader& reader,
                     size_t start) {
  const long number = reader.whole_number(99);
  if (!reader.take_char(':'))
    reader.fail("missing-word", reader.offset(), "':' is missing here", "FN 0: Q1 = +10");
  if (number <= 8 || number == 13) return basic_function(reader, static_cast<int>(number));
  if (number <= 12) return flow.conditional(reader, static_cast<int>(number));
  if (number == 14) {
    reader.take("ERROR");
    reader.take_char('=');
    reader.done();
    const size_t at = reader.offset();
    const long error = reader.whole_value(0, 9999);
    reader.expect_end();
    reader.fail("program-error", at, fmt::format("the program stops with its own error {} (FN 14)", error),
                "see what the program checks before this block");
  }
  if (number == 16 || number == 38) {
    control.report.without_effect(fmt::format("FN {}", number));
    control.report.note(fmt::format("FN {}", number), reader.rest());
    return;
  }
  if (number == 17) return write_system_data(control, reader, start);
  if (number == 18) return read_system_data(control, parameters, reader, start);
  if (number >= 15 && number <= 38) {
    reader.fail("unsupported-word", start, fmt::format("FN {} is known, but not supported here", number),
                "FN 0 to FN 14, FN 16 to FN 18 and FN 38 are");
  }
  reader.fail("unknown-word", start, fmt::format("there is no FN {}", number), "FN 0 to FN 38");
}

bool statement(Executor& executor, BlockReader& reader, std::string_view word, size_t start) {
  if (word == "CC") {
    pole(executor.control, executor.path, executor.frames, reader);
  } else if (word == "BEGIN") {
    begin_program(executor.control, executor.parameters, executor.modes, reader, start);
  } else if (word == "END") {
    if (!reader.take("PGM")) reader.fail("missing-word", start, "END without PGM", "END PGM NAME MM");
    reader.rest();
    executor.flow.end_of_program(reader);
  } else if (word == "FN") {
    function_number(executor.control, executor.flow, executor.parameters, reader, start);
  } else if (word == "TOOL") {
    if (reader.take("CALL")) {
      tool_call(executor, reader);
    } else if (reader.take("DEF")) {
      tool_ready(executor.control, executor.modes, reader);
    } else {
      reader.fail("missing-word", start, "TOOL without CALL or DEF", "TOOL CALL 5 Z S3000");
    }
  } else if (word == "BLK") {
    blank_form(executor.control, reader);
  } else if (word == "CYCL") {
    if (reader.take("DEF")) {
      cycle_definition(executor, reader);
    } else if (reader.take("CALL")) {
      cycle_call(executor, reader, start);
    } else {
      reader.fail("missing-word", start, "CYCL without DEF or CALL", "CYCL DEF 200, CYCL CALL");
    }
  } else if (word == "TCH") {
    if (!reader.take("PROBE")) reader.fail("missing-word", start, "TCH without PROBE", "TCH PROBE 408");
    probe(executor.control, executor.parameters, reader, start);
  } else if (word == "PATTERN") {
    pattern_definition(executor.control, executor.drilling, reader, start);
  } else if (word == "PLANE") {
    plane(executor, reader, start);
  } else if (word == "FUNCTION") {
    function_word(executor.control, executor.modes, executor.orientation, reader, start);
  } else if (word == "TRANS") {
    transform(executor, reader, start);
  } else if (word == "STOP" || word == "M") {
    if (word == "STOP") executor.control.report.without_effect("STOP");
    if (word == "M") reader.move_to(start);
    const MotionWords words = read_motion_words(reader, kFunctionsAllowed | kTcpAllowed);
    if (words.has_function(136) || words.has_function(137)) executor.modes.feed = 0.0;
    functions_before(executor, reader, words);
    finish_motion(executor, reader, words);
  } else {
    return false;
  }
  return true;
}

void block(Executor& executor, BlockReader& reader) {
  reader.done();
  const size_t start = reader.offset();
  const nc::Place place = reader.place_of(start);
  executor.control.report.at(place.file, place.line, place.column);
  const std::string word(reader.letters());
  if (executor.drilling.open_cycle != 0 && word != "CYCL") executor.drilling.open_cycle = 0;
  if (!executor.modes.begun && word != "BEGIN") {
    reader.fail("missing-begin", start, "the program does not start with BEGIN PGM",
                "BEGIN PGM NAME MM (or INCH)");
  }
  struct MotionBlock {
    std::string_view word;
    void (*execute)(Executor&, BlockReader&, size_t);
  };
  static constexpr MotionBlock kMotions[] = {
      {"L", line},          {"LN", surface_line},     {"LP", polar_line},
      {"C", circle},        {"CR", circle_by_radius}, {"CT", circle_tangential},
      {"CP", polar_circle}, {"SPL", spline},          {"APPR", approach},
      {"DEP", depart}};
  for (const MotionBlock& one : kMotions) {
    if (one.word != word) continue;
    reader.take_letters();
    return one.execute(executor, reader, start);
  }
  if (word == "RND" || word == "CHF") {
    reader.take_letters();
    return corner(executor.control, executor.path, executor.frames, reader, word == "RND", start);
  }
  if (word != "CC") no_open_corner(executor.path, reader, start);
  if (word == "Q" || word == "QL" || word == "QR" || word == "QS")
    return assignment(executor.parameters, reader);
  if (executor.flow.statement(reader)) return;
  reader.take_letters();
  if (!statement(executor, reader, word, start))
    refuse_word(reader, start, word.empty() ? std::string(1, reader.peek()) : word);
}

}  // namespace

Executor::Executor(nc::Control& machine) : control(machine), flow(machine, parameters) {
  control.report.words = {
      "R0", "L .. FMAX", "L with F", "CC", "M136, FU", "TOOL CALL 5 Z S1000, then M3", "TOOL CALL"};
  parameters.set_presets(machine.setup.presets);
  control.modal.feed_rule = nc::FeedRule::kAllAxes;
  control.contour.set_entry(nc::CompensationEntry::kAcrossNext);
}

void run(const std::string& path, nc::Control& control) {
  Executor executor(control);
  executor.flow.open(path);
  while (const BlockText* text = executor.flow.next()) {
    BlockReader reader(*text, executor.control, executor.parameters);
    block(executor, reader);
  }
  nc::finish(executor.control);
}

}  // namespace swarf::program::nc::heidenhain
