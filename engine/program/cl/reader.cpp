#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "program/cl/steps.h"

namespace swarf::program::cldata {
namespace {

/// CL words that other versions of APT have and this reader does not follow, and what to do about them.
struct Refused {
  std::string_view word;
  const char* why;  ///< "": not followed, no more to say
  const char* fix;
};
constexpr const char* kWrite = "post the file without it, or write its motion as GOTO";
constexpr std::array kRefused{
    Refused{"ROTABL",
            "turns an axis of a machine that the file does not describe: neither which way nor about which "
            "point, "
            "and whether the positions behind it lie in the part or beside the turned table is the "
            "post-processor's choice",
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

struct Word {
  const char* name;
  void (*handler)(ClState&, const ClStatement&);
};

void end(ClState& cl, const ClStatement& /*s*/) {
  cl.path.ended = true;
}

/// The most frequent words first.
std::span<const Word> words() {
  static constexpr Word kWords[] = {{"GOTO", go_to},
                                    {"CIRCLE", circle},
                                    {"MOVARC", move_arc},
                                    {"FEDRAT", feed_rate},
                                    {"RAPID", rapid},
                                    {"INDIRV", direction},
                                    {"TLON", tool_on},
                                    {"MOVNRB", nurbs},
                                    {"PAINT", note},
                                    {"PPRINT", pprint},
                                    {"GODLTA", go_delta},
                                    {"FROM", from},
                                    {"GOHOME", go_home},
                                    {"CYCLE", cycle},
                                    {"DELAY", delay},
                                    {"INSERT", note},
                                    {"REMARK", note},
                                    {"PARTNO", note},
                                    {"COOLNT", note},
                                    {"SPINDL", spindle},
                                    {"MULTAX", multi_axis},
                                    {"TLAXIS", tool_axis},
                                    {"LOADTL", load_tool},
                                    {"LOAD", load},
                                    {"SELECT", load},
                                    {"TOOL PATH", tool_path},
                                    {"TLDATA", tool_data},
                                    {"CUTTER", cutter},
                                    {"TOOLNO", note},
                                    {"TPRINT", note},
                                    {"CUTCOM", cutter_compensation},
                                    {"MSYS", system},
                                    {"CSYS", work_system},
                                    {"MCS", matrix_system},
                                    {"ORIGIN", origin},
                                    {"TRANS", translation},
                                    {"TRACUT", transformed_cut},
                                    {"SET", set_mode},
                                    {"MODE", mode},
                                    {"UNITS", units},
                                    {"UNIT", units},
                                    {"TRNTYP", transformation},
                                    {"SETUP", note},
                                    {"MACHIN", note},
                                    {"CSI_TOOL_PATH", note},
                                    {"CSI_SET_PATH_PARAM", note},
                                    {"CSI_SET_FLUTE_LENGTH", note},
                                    {"CSI_SET_EXTENSION_LENGTH", note},
                                    {"INDIRP", direction},
                                    {"PSIS", part_surface},
                                    {"AUTOPS", part_surface},
                                    {"CLEARP", clearance_plane},
                                    {"RETRCT", retract},
                                    {"INTOL", tolerance},
                                    {"OUTTOL", tolerance},
                                    {"TOLER", tolerance},
                                    {"AUXFUN", auxiliary},
                                    {"OPSKIP", note},
                                    {"LEADER", note},
                                    {"SEQNO", note},
                                    {"DISPLY", note},
                                    {"STOP", note},
                                    {"OPSTOP", note},
                                    {"REWIND", note},
                                    {"END-OF-PATH", note},
                                    {"END", note},
                                    {"FINI", end}};
  return kWords;
}

void refuse_word(Reporter& reporter, const ClStatement& statement) {
  const auto refused = std::find_if(kRefused.begin(), kRefused.end(),
                                    [&](const Refused& one) { return one.word == statement.word; });
  if (refused != kRefused.end()) {
    const std::string why =
        *refused->why == '\0' ? "is a known CL word, but this version does not follow it" : refused->why;
    fault(reporter, "unsupported-word", statement, fmt::format("{} {}", statement.word, why), refused->fix);
    return;
  }
  std::vector<std::string> known;
  for (const Word& entry : words()) known.emplace_back(entry.name);
  const std::string nearest = nearest_name(statement.word, known);
  fault(reporter, "unknown-word", statement, fmt::format("{} is not a word of CL data", statement.word),
        nearest.empty()
            ? "take it out where it moves nothing; engine/program/README.md lists the words that are read"
            : fmt::format("did you mean {}?", nearest));
}

void take(ClState& cl, const ClStatement& statement) {
  if (cl.systems.catia_lines > 0) {
    fault(cl.reporter, "bad-system", statement, "$$*CATIA0 is not complete here",
          "give the name of the system, then three rows of four numbers, each behind $$");
    cl.systems.catia_lines = 0;
  }
  if (cl.nurbs && inside_nurbs(cl, statement)) return;
  if (statement.word != "GOTO") cl.arcs.rounded.reset();
  for (const Word& entry : words()) {
    if (statement.word == entry.name) return entry.handler(cl, statement);
  }
  refuse_word(cl.reporter, statement);
}

void finish(ClState& cl) {
  if (cl.nurbs) {
    cl.reporter.error("bad-nurbs", cl.nurbs->line, cl.nurbs->column, "this MOVNRB curve does not end",
                      "write MOVNRB/OFF behind its last point");
  }
  if (cl.reporter.errors() > 0 || cl.program.motions > 0) return;
  cl.reporter.error(
      "no-motion", 0, 0,
      cl.path.positioned ? "the program has one position and no move" : "the program has no position",
      "give at least two positions with GOTO");
}

}  // namespace

void fault(Reporter& reporter, const char* code, const ClStatement& at, std::string text, std::string fix) {
  reporter.error(code, at.line, at.column, std::move(text), std::move(fix));
}

void fault(Reporter& reporter, const char* code, const ClArgument& at, std::string text, std::string fix) {
  reporter.error(code, at.line, at.column, std::move(text), std::move(fix));
}

void remark(ClProgram& program, std::string text) {
  auto& remarks = program.remarks;
  if (std::find(remarks.begin(), remarks.end(), text) == remarks.end()) remarks.push_back(std::move(text));
}

bool all_numbers(Reporter& reporter, const ClStatement& s, const char* form) {
  for (const ClArgument& argument : s.arguments) {
    if (argument.number) continue;
    fault(reporter, "wrong-arguments", argument,
          fmt::format("{} takes numbers, '{}' is none", s.word, argument.text),
          fmt::format("write {}", form));
    return false;
  }
  return true;
}

bool numbers(Reporter& reporter, const ClStatement& s, size_t few, size_t many, const char* form) {
  if (!all_numbers(reporter, s, form)) return false;
  const size_t count = s.arguments.size();
  if (count == few || count == many) return true;
  fault(reporter, "wrong-arguments", s, fmt::format("{} has {} numbers", s.word, count),
        fmt::format("write {}", form));
  return false;
}

bool fits(const ClStatement& s, std::string_view pattern) {
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

bool unit_vector(Reporter& reporter, const ClStatement& s, size_t first, const char* what, Vec3& unit) {
  const Vec3 given(s.arguments[first].value, s.arguments[first + 1].value, s.arguments[first + 2].value);
  const double length = given.norm();
  if (std::abs(length - 1.0) > kAxisLengthTolerance) {
    fault(reporter, "axis-not-unit", s.arguments[first],
          fmt::format("the {} ({:g}, {:g}, {:g}) has length {:.6g}", what, given.x(), given.y(), given.z(),
                      length),
          fmt::format("write a vector of length 1 (within {:g})", kAxisLengthTolerance));
    return false;
  }
  unit = given / length;
  return true;
}

ClProgram run(const std::string& file, const ClOptions& options, ClSink& sink, Diagnostics& diagnostics,
              ClLines& lines) {
  ClState cl(file, options, sink, diagnostics);
  ClScanner scanner(lines);
  ClStatement statement;
  try {
    while (scanner.next(statement, cl.reporter)) {
      if (statement.comment()) {
        comment(cl, statement);
        continue;
      }
      ++cl.program.statements;
      if (cl.path.ended) {
        cl.reporter.error("word-after-end", statement.line, statement.column,
                          fmt::format("{} stands after FINI", statement.word),
                          "FINI ends the program: remove what follows, or the FINI");
        break;
      }
      take(cl, statement);
    }
    if (cl.compensation.contour) cl.compensation.contour->flush();
  } catch (const InputError& error) {
    // Faults of the cutter compensation and of the file itself end the program where they stand.
    for (const Diagnostic& one : error.diagnostics.list())
      cl.reporter.error(one.code, one.where.line, one.where.column, one.text, one.fix);
    return std::move(cl.program);
  }
  if (!scanner.any_text()) {
    cl.reporter.error("empty-file", 0, 0, "the program is empty",
                      "give CL data, for example GOTO/10,20,30 on a line");
    return std::move(cl.program);
  }
  finish(cl);
  return std::move(cl.program);
}

}  // namespace swarf::program::cldata
