#include "program/heidenhain/executor.h"

#include <fmt/format.h>

namespace swarf::program::nc::heidenhain {

Executor::Executor(nc::Control& control) : control_(control), flow_(control, parameters_) {
  control_.report.words = {
      "R0", "L .. FMAX", "L with F", "CC", "M136, FU", "TOOL CALL 5 Z S1000, then M3", "TOOL CALL"};
  control_.modal.feed_rule = nc::FeedRule::kAllAxes;
  control_.contour.set_entry(nc::CompensationEntry::kAcrossNext);
}

void Executor::run(const std::string& path) {
  flow_.open(path);
  while (const BlockText* text = flow_.next()) {
    BlockReader reader(*text, control_, parameters_);
    block(reader);
  }
  nc::finish(control_);
}

void Executor::block(BlockReader& reader) {
  reader.done();
  const size_t start = reader.offset();
  const nc::Place place = reader.place_of(start);
  control_.report.at(place.file, place.line, place.column);
  const std::string word(reader.letters());
  if (open_cycle_ != 0 && word != "CYCL") open_cycle_ = 0;
  if (!begun_ && word != "BEGIN") {
    reader.fail("missing-begin", start, "the program does not start with BEGIN PGM",
                "BEGIN PGM NAME MM (or INCH)");
  }
  struct MotionBlock {
    std::string_view word;
    void (Executor::*execute)(BlockReader&, size_t);
  };
  static constexpr MotionBlock kMotions[] = {{"L", &Executor::line},
                                             {"LN", &Executor::surface_line},
                                             {"LP", &Executor::polar_line},
                                             {"C", &Executor::circle},
                                             {"CR", &Executor::circle_by_radius},
                                             {"CT", &Executor::circle_tangential},
                                             {"CP", &Executor::polar_circle},
                                             {"SPL", &Executor::spline},
                                             {"APPR", &Executor::approach},
                                             {"DEP", &Executor::depart}};
  for (const MotionBlock& one : kMotions) {
    if (one.word != word) continue;
    reader.take_letters();
    return (this->*one.execute)(reader, start);
  }
  if (word == "RND" || word == "CHF") {
    reader.take_letters();
    return corner(reader, word == "RND", start);
  }
  if (word != "CC") no_open_corner(reader, start);
  if (word == "Q" || word == "QL" || word == "QR" || word == "QS") return assignment(reader);
  if (flow_.statement(reader)) return;
  reader.take_letters();
  if (!statement(reader, word, start))
    refuse_word(reader, start, word.empty() ? std::string(1, reader.peek()) : word);
}

bool Executor::statement(BlockReader& reader, std::string_view word, size_t start) {
  if (word == "CC") {
    pole(reader);
  } else if (word == "BEGIN") {
    begin_program(reader, start);
  } else if (word == "END") {
    if (!reader.take("PGM")) reader.fail("missing-word", start, "END without PGM", "END PGM NAME MM");
    reader.rest();
    flow_.end_of_program(reader);
  } else if (word == "FN") {
    function_number(reader, start);
  } else if (word == "TOOL") {
    if (reader.take("CALL")) {
      tool_call(reader);
    } else if (reader.take("DEF")) {
      tool_ready(reader);
    } else {
      reader.fail("missing-word", start, "TOOL without CALL or DEF", "TOOL CALL 5 Z S3000");
    }
  } else if (word == "BLK") {
    blank_form(reader);
  } else if (word == "CYCL") {
    if (reader.take("DEF")) {
      cycle_definition(reader);
    } else if (reader.take("CALL")) {
      cycle_call(reader, start);
    } else {
      reader.fail("missing-word", start, "CYCL without DEF or CALL", "CYCL DEF 200, CYCL CALL");
    }
  } else if (word == "PATTERN") {
    pattern_definition(reader, start);
  } else if (word == "PLANE") {
    plane(reader, start);
  } else if (word == "FUNCTION") {
    function_word(reader, start);
  } else if (word == "TRANS") {
    transform(reader, start);
  } else if (word == "STOP" || word == "M") {
    if (word == "STOP") control_.report.without_effect("STOP");
    if (word == "M") reader.move_to(start);
    const MotionWords words = read_motion_words(reader, kFunctionsAllowed | kTcpAllowed);
    if (words.has_function(136) || words.has_function(137)) feed_ = 0.0;
    functions_before(reader, words);
    finish_motion(reader, words);
  } else {
    return false;
  }
  return true;
}

void Executor::begin_program(BlockReader& reader, size_t start) {
  if (!reader.take("PGM"))
    reader.fail("missing-word", start, "BEGIN without PGM", "BEGIN PGM NAME MM (or INCH)");
  const std::string_view rest = reader.rest();
  const bool inch = rest.ends_with(" INCH"), mm = rest.ends_with(" MM");
  if (!inch && !mm)
    reader.fail("missing-word", start, "BEGIN PGM says neither MM nor INCH", "BEGIN PGM NAME MM (or INCH)");
  if (begun_ && control_.modal.inches() != inch) {
    reader.fail("unsupported-word", start, "a called program has the other unit",
                "write both programs in MM, or both in INCH");
  }
  begun_ = true;
  nc::set_inches(control_.modal, inch);
  parameters_.set_q(113, inch ? 1.0 : 0.0);
}

void Executor::assignment(BlockReader& reader) {
  const Parameters::Name name = Parameters::name(reader);
  if (!reader.take_char('=')) {
    reader.done();
    reader.fail("missing-word", reader.offset(), "'=' is missing here", "Q1 = Q2 + 10");
  }
  parameters_.assign(reader, name);
}

void Executor::function_number(BlockReader& reader, size_t start) {
  const long number = reader.whole_number(99);
  if (!reader.take_char(':'))
    reader.fail("missing-word", reader.offset(), "':' is missing here", "FN 0: Q1 = +10");
  if (number <= 8 || number == 13) return basic_function(reader, static_cast<int>(number));
  if (number <= 12) return flow_.conditional(reader, static_cast<int>(number));
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
    control_.report.without_effect(fmt::format("FN {}", number));
    control_.report.note(fmt::format("FN {}", number), reader.rest());
    return;
  }
  if (number >= 15 && number <= 38) {
    reader.fail("unsupported-word", start, fmt::format("FN {} is known, but not supported here", number),
                "FN 0 to FN 14, FN 16 and FN 38 are");
  }
  reader.fail("unknown-word", start, fmt::format("there is no FN {}", number), "FN 0 to FN 38");
}

}  // namespace swarf::program::nc::heidenhain
