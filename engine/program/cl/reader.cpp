#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "program/cl/interpreter.h"

namespace swarf::program {
namespace {

/// CL words that other versions of APT have and this reader does not follow, and what to do about them.
struct Refused {
  std::string_view word;
  const char* why;  ///< "": not followed, no more to say
  const char* fix;
};
constexpr const char* kWrite = "post the file without it, or write its motion as GOTO";
constexpr std::array kRefused{
    Refused{
        "ROTABL",
        "turns the table, and whether the positions behind it lie in the part or beside the turned table is "
        "the post-processor's choice",
        "output tool axes (MULTAX/ON and GOTO/x,y,z,i,j,k) instead of table turns"},
    Refused{"ROTATE", "turns an axis of one post-processor's machine", "output tool axes under MULTAX/ON"},
    Refused{"CALSUB", "calls a subroutine of the machine", "output the path without subroutines"},
    Refused{"DEFSUB", "begins a subroutine of the machine", "output the path without subroutines"},
    Refused{"ENDSUB", "ends a subroutine of the machine", "output the path without subroutines"},
    Refused{"COPY", "repeats statements in another place", "output the repeated path in full"},
    Refused{"INDEX", "marks statements that COPY repeats", "output the repeated path in full"},
    Refused{"PREFUN", "writes a G word of one control", "write what it does in CL words"},
    Refused{"PPFUN", "is a function of one post-processor", "write what it does in CL words"},
    Refused{"CLDIST", "is a clearance that each post-processor uses in its own way",
            "write CLEAR with the distance into each CYCLE"},
    Refused{"ARCSLP", "", kWrite},
    Refused{"CLAMP", "", kWrite},
    Refused{"GOFWD", "", kWrite},
    Refused{"GOLFT", "", kWrite},
    Refused{"GORGT", "", kWrite},
    Refused{"GOBACK", "", kWrite},
    Refused{"TLLFT", "", kWrite},
    Refused{"TLRGT", "", kWrite},
    Refused{"THREAD", "", kWrite},
    Refused{"TURRET", "", kWrite},
    Refused{"DMIS", "", kWrite},
    Refused{"PROBE", "", kWrite}};

}  // namespace

ClInterpreter::ClInterpreter(const std::string& file, const ClOptions& options, ClSink& sink,
                             Diagnostics& diagnostics)
    : options_(options), sink_(sink), reporter_(diagnostics, file) {
  program_.file = file;
}

ClProgram ClInterpreter::run(ClLines& lines) {
  ClScanner scanner(lines);
  ClStatement statement;
  try {
    while (scanner.next(statement, reporter_)) {
      if (statement.comment()) {
        comment(statement);
        continue;
      }
      ++program_.statements;
      if (ended_) {
        reporter_.error("word-after-end", statement.line, statement.column,
                        fmt::format("{} stands after FINI", statement.word),
                        "FINI ends the program: remove what follows, or the FINI");
        break;
      }
      take(statement);
    }
    if (compensation_) compensation_->flush();
  } catch (const InputError& error) {
    // Faults of the cutter compensation and of the file itself end the program where they stand.
    for (const Diagnostic& one : error.diagnostics.list())
      reporter_.error(one.code, one.where.line, one.where.column, one.text, one.fix);
    return std::move(program_);
  }
  if (!scanner.any_text()) {
    reporter_.error("empty-file", 0, 0, "the program is empty",
                    "give CL data, for example GOTO/10,20,30 on a line");
    return std::move(program_);
  }
  finish();
  return std::move(program_);
}

/// The most frequent words first.
std::span<const ClInterpreter::Word> ClInterpreter::words() {
  using C = ClInterpreter;
  static constexpr Word kWords[] = {{"GOTO", &C::go_to},
                                    {"CIRCLE", &C::circle},
                                    {"MOVARC", &C::move_arc},
                                    {"FEDRAT", &C::feed_rate},
                                    {"RAPID", &C::rapid},
                                    {"INDIRV", &C::direction},
                                    {"TLON", &C::tool_on},
                                    {"MOVNRB", &C::nurbs},
                                    {"PAINT", &C::note},
                                    {"PPRINT", &C::pprint},
                                    {"GODLTA", &C::go_delta},
                                    {"FROM", &C::from},
                                    {"GOHOME", &C::go_home},
                                    {"CYCLE", &C::cycle},
                                    {"DELAY", &C::delay},
                                    {"INSERT", &C::note},
                                    {"REMARK", &C::note},
                                    {"PARTNO", &C::note},
                                    {"COOLNT", &C::note},
                                    {"SPINDL", &C::spindle},
                                    {"MULTAX", &C::multi_axis},
                                    {"TLAXIS", &C::tool_axis},
                                    {"LOADTL", &C::load_tool},
                                    {"LOAD", &C::load},
                                    {"SELECT", &C::load},
                                    {"TOOL PATH", &C::tool_path},
                                    {"TLDATA", &C::tool_data},
                                    {"CUTTER", &C::cutter},
                                    {"TOOLNO", &C::note},
                                    {"TPRINT", &C::note},
                                    {"CUTCOM", &C::cutter_compensation},
                                    {"MSYS", &C::system},
                                    {"CSYS", &C::system},
                                    {"MCS", &C::matrix_system},
                                    {"ORIGIN", &C::origin},
                                    {"TRANS", &C::translation},
                                    {"TRACUT", &C::transformed_cut},
                                    {"SET", &C::set_mode},
                                    {"MODE", &C::mode},
                                    {"UNITS", &C::units},
                                    {"MACHIN", &C::note},
                                    {"CSI_TOOL_PATH", &C::note},
                                    {"CSI_SET_PATH_PARAM", &C::note},
                                    {"INDIRP", &C::direction},
                                    {"PSIS", &C::part_surface},
                                    {"AUTOPS", &C::part_surface},
                                    {"CLEARP", &C::clearance_plane},
                                    {"RETRCT", &C::retract},
                                    {"INTOL", &C::tolerance},
                                    {"OUTTOL", &C::tolerance},
                                    {"TOLER", &C::tolerance},
                                    {"AUXFUN", &C::auxiliary},
                                    {"OPSKIP", &C::note},
                                    {"LEADER", &C::note},
                                    {"SEQNO", &C::note},
                                    {"DISPLY", &C::note},
                                    {"STOP", &C::note},
                                    {"OPSTOP", &C::note},
                                    {"REWIND", &C::note},
                                    {"END-OF-PATH", &C::note},
                                    {"END", &C::note},
                                    {"FINI", &C::end}};
  return kWords;
}

void ClInterpreter::take(const ClStatement& statement) {
  if (catia_lines_ > 0) {
    fault("bad-system", statement, "$$*CATIA0 is not complete here",
          "give the name of the system, then three rows of four numbers, each behind $$");
    catia_lines_ = 0;
  }
  if (nurbs_ && inside_nurbs(statement)) return;
  if (statement.word != "GOTO") rounded_.reset();
  for (const Word& entry : words()) {
    if (statement.word == entry.name) return (this->*entry.handler)(statement);
  }
  refuse_word(statement);
}

void ClInterpreter::refuse_word(const ClStatement& statement) {
  const auto refused = std::find_if(kRefused.begin(), kRefused.end(),
                                    [&](const Refused& one) { return one.word == statement.word; });
  if (refused != kRefused.end()) {
    const std::string why =
        *refused->why == '\0' ? "is a known CL word, but this version does not follow it" : refused->why;
    fault("unsupported-word", statement, fmt::format("{} {}", statement.word, why), refused->fix);
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

void ClInterpreter::remark(std::string text) {
  auto& remarks = program_.remarks;
  if (std::find(remarks.begin(), remarks.end(), text) == remarks.end()) remarks.push_back(std::move(text));
}

bool ClInterpreter::all_numbers(const ClStatement& s, const char* form) {
  for (const ClArgument& argument : s.arguments) {
    if (argument.number) continue;
    fault("wrong-arguments", argument, fmt::format("{} takes numbers, '{}' is none", s.word, argument.text),
          fmt::format("write {}", form));
    return false;
  }
  return true;
}

bool ClInterpreter::numbers(const ClStatement& s, size_t few, size_t many, const char* form) {
  if (!all_numbers(s, form)) return false;
  const size_t count = s.arguments.size();
  if (count == few || count == many) return true;
  fault("wrong-arguments", s, fmt::format("{} has {} numbers", s.word, count), fmt::format("write {}", form));
  return false;
}

bool ClInterpreter::fits(const ClStatement& s, std::string_view pattern) {
  size_t at = 0;
  while (!pattern.empty()) {
    if (pattern[0] == ' ') {
      pattern.remove_prefix(1);
      continue;
    }
    if (at == s.arguments.size()) return false;
    const ClArgument& argument = s.arguments[at++];
    const size_t length = pattern[0] == '#' ? 1 : std::min(pattern.find(' '), pattern.size());
    if (argument.number != (pattern[0] == '#')) return false;
    if (!argument.number && argument.text != pattern.substr(0, length)) return false;
    pattern.remove_prefix(length);
  }
  return at == s.arguments.size();
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
  if (reporter_.errors() > 0 || program_.motions > 0) return;
  reporter_.error("no-motion", 0, 0,
                  positioned_ ? "the program has one position and no move" : "the program has no position",
                  "give at least two positions with GOTO");
}

}  // namespace swarf::program
