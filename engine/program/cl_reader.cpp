#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "program/cl_interpreter.h"
#include "program/source_text.h"

namespace swarf::program {

namespace {

/// CL words that other versions of APT have and this reader does not follow.
constexpr std::array kUnsupported{"ROTABL", "ROTATE", "ORIGIN", "GOHOME", "ARCSLP", "CLAMP", "MODE",
                                  "TOOLNO", "TRANS",  "GOFWD",  "GOLFT",  "GORGT",  "TLON",  "THREAD",
                                  "TURRET", "PREFUN", "AUXFUN", "COPY",   "INDEX"};

}  // namespace

ClInterpreter::ClInterpreter(const std::string& file, Diagnostics& diagnostics)
    : reporter_(diagnostics, file) {
  program_.file = file;
}

ClProgram ClInterpreter::run(const std::string& text) {
  if (!check_text(text, reporter_, "give CL data, for example GOTO/10,20,30 on a line")) return {};
  ClScanner scanner(text);
  ClStatement statement;
  while (scanner.next(statement, reporter_)) {
    ++program_.statements;
    if (ended_) {
      reporter_.error("word-after-end", statement.line, statement.column,
                      fmt::format("{} stands after FINI", statement.word),
                      "FINI ends the program: remove what follows, or the FINI");
      break;
    }
    take(statement);
  }
  finish();
  return std::move(program_);
}

/// The most frequent words first.
std::span<const ClInterpreter::Word> ClInterpreter::words() {
  using C = ClInterpreter;
  static constexpr Word kWords[] = {
      {"GOTO", &C::go_to},       {"CIRCLE", &C::circle},     {"FEDRAT", &C::feed_rate},
      {"RAPID", &C::rapid},      {"MOVNRB", &C::nurbs},      {"PAINT", &C::note},
      {"PPRINT", &C::note},      {"GODLTA", &C::go_delta},   {"FROM", &C::from},
      {"CYCLE", &C::cycle},      {"DELAY", &C::delay},       {"INSERT", &C::note},
      {"REMARK", &C::note},      {"PARTNO", &C::note},       {"COOLNT", &C::note},
      {"SPINDL", &C::spindle},   {"MULTAX", &C::multi_axis}, {"LOADTL", &C::load_tool},
      {"LOAD", &C::load},        {"SELECT", &C::load},       {"TOOL PATH", &C::tool_path},
      {"TLDATA", &C::tool_data}, {"CUTTER", &C::cutter},     {"CUTCOM", &C::cutter_compensation},
      {"MSYS", &C::system},      {"CSYS", &C::system},       {"SET", &C::set_mode},
      {"UNITS", &C::units},      {"MACHIN", &C::note},       {"INTOL", &C::note},
      {"OUTTOL", &C::note},      {"STOP", &C::note},         {"OPSTOP", &C::note},
      {"REWIND", &C::note},      {"END-OF-PATH", &C::note},  {"FINI", &C::end}};
  return kWords;
}

void ClInterpreter::take(const ClStatement& statement) {
  if (nurbs_ && inside_nurbs(statement)) return;
  for (const Word& entry : words()) {
    if (statement.word == entry.name) return (this->*entry.handler)(statement);
  }
  if (std::find(kUnsupported.begin(), kUnsupported.end(), statement.word) != kUnsupported.end()) {
    fault("unsupported-word", statement,
          fmt::format("{} is a known CL word, but this version does not follow it", statement.word),
          "post the file without it, or write its motion as GOTO");
    return;
  }
  std::vector<std::string> known;
  for (const Word& entry : words()) known.emplace_back(entry.name);
  const std::string nearest = nearest_name(statement.word, known);
  fault("unknown-word", statement, fmt::format("{} is not a word of CL data", statement.word),
        nearest.empty() ? fmt::format("known are {}", fmt::join(known, ", "))
                        : fmt::format("did you mean {}?", nearest));
}

void ClInterpreter::fault(const char* code, const ClStatement& at, std::string text, std::string fix) {
  reporter_.error(code, at.line, at.column, std::move(text), std::move(fix));
}

void ClInterpreter::fault(const char* code, const ClArgument& at, std::string text, std::string fix) {
  reporter_.error(code, at.line, at.column, std::move(text), std::move(fix));
}

bool ClInterpreter::numbers(const ClStatement& s, size_t few, size_t many, const char* form) {
  for (const ClArgument& argument : s.arguments) {
    if (argument.number) continue;
    fault("wrong-arguments", argument, fmt::format("{} takes numbers, '{}' is none", s.word, argument.text),
          fmt::format("write {}", form));
    return false;
  }
  const size_t count = s.arguments.size();
  if (count == few || count == many) return true;
  fault("wrong-arguments", s, fmt::format("{} has {} numbers", s.word, count), fmt::format("write {}", form));
  return false;
}

bool ClInterpreter::unit_vector(const ClStatement& s, size_t first, const char* what, Vec3& unit) {
  const Vec3 given(s.arguments[first].value, s.arguments[first + 1].value, s.arguments[first + 2].value);
  const double length = given.norm();
  if (std::abs(length - 1.0) > kAxisLengthTolerance) {
    fault("axis-not-unit", s.arguments[first],
          fmt::format("the {} ({:g}, {:g}, {:g}) has length {:.6g}", what, given.x(), given.y(), given.z(),
                      length),
          fmt::format("write a vector of length 1 (within {:g})", kAxisLengthTolerance));
    return false;
  }
  unit = given / length;
  return true;
}

void ClInterpreter::finish() {
  if (nurbs_) {
    reporter_.error("bad-nurbs", nurbs_->line, nurbs_->column, "this MOVNRB curve does not end",
                    "write MOVNRB/OFF behind its last point");
  }
  if (reporter_.errors() > 0 || !program_.moves.empty()) return;
  reporter_.error("no-motion", 0, 0,
                  positioned_ ? "the program has one position and no move" : "the program has no position",
                  "give at least two positions with GOTO");
}

ClProgram parse_cl(const std::string& text, const std::string& file, Diagnostics& diagnostics) {
  return ClInterpreter(file, diagnostics).run(text);
}

ClProgram load_cl(const std::string& path, Diagnostics* warnings) {
  Diagnostics diagnostics;
  ClProgram program = parse_cl(read_file(path), path, diagnostics);
  diagnostics.throw_if_errors();
  if (warnings != nullptr) warnings->append(diagnostics);
  return program;
}

}  // namespace swarf::program
