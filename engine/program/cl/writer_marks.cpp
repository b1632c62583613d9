#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include "program/cl/steps.h"

namespace swarf::program::cldata {
namespace {

struct Mark {
  std::string_view text;  ///< in capitals
  bool begins;            ///< the comment begins with it
  ClWriter writer;
};
/// Comments that only one system writes.
constexpr std::array kMarks{
    Mark{"SWARF CL DATA", true, ClWriter::kSwarf},     Mark{"* PRO/CLFILE", true, ClWriter::kCreo},
    Mark{"*PRO/CLFILE", true, ClWriter::kCreo},        Mark{"*CATIA0", true, ClWriter::kCatia},
    Mark{"CATIA APT VERSION", true, ClWriter::kCatia}, Mark{"MACHINE GROUP-", true, ClWriter::kMastercam},
    Mark{"CAMWORKS", false, ClWriter::kCamWorks},      Mark{"SOLIDWORKS CAM", false, ClWriter::kCamWorks}};

/// In capitals, runs of blanks as one.
std::string plain(std::string_view text) {
  std::string found;
  for (const char c : text) {
    const bool blank = c == ' ' || c == '\t';
    if (!blank || (!found.empty() && found.back() != ' '))
      found += blank ? ' ' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return found;
}

}  // namespace

void mark(Reporter& reporter, ClProgram& program, ClWriter writer, const std::string& what,
          const ClStatement& s) {
  // What Swarf writes has been read: its words mean what they say, whoever's they are.
  if (program.writer == writer || program.writer == ClWriter::kSwarf) return;
  if (program.writer == ClWriter::kUnknown) {
    program.writer = writer;
    program.writer_reason = fmt::format("{} on line {}", what, s.line);
    return;
  }
  fault(reporter, "writer-contradiction", s,
        fmt::format("{} is a mark of {}, and the file was taken for one of {} ({})", what,
                    writer_name(writer), writer_name(program.writer), program.writer_reason),
        "give one file of one system: what CIRCLE and other words mean differs between them");
}

std::optional<double> circle_sense(const ClOptions& options, const ClProgram& program) {
  if (options.circle_clockwise) return *options.circle_clockwise ? -1.0 : 1.0;
  switch (program.writer) {
    case ClWriter::kSwarf:
    case ClWriter::kNx:
    case ClWriter::kMakino:
      return -1.0;
    case ClWriter::kCreo:
      return 1.0;
    case ClWriter::kCatia:
    case ClWriter::kMastercam:
    case ClWriter::kCamWorks:
    case ClWriter::kUnknown:
      break;
  }
  return std::nullopt;
}

void comment(ClState& cl, const ClStatement& s) {
  if (s.word == "$$->CSYS") return creo_system(cl, s);
  if (s.word == "$$->CUTTER") {
    mark(cl.reporter, cl.program, ClWriter::kCreo, "$$-> CUTTER", s);
    return cutter(cl, s);
  }
  if (s.word != "$$") {
    mark(cl.reporter, cl.program, ClWriter::kCreo, s.word, s);
    // Creo says itself what its points are under CUTCOM.
    if (s.word == "$$->CUTCOM_GEOMETRY_TYPE" && s.text == "OUTPUT_ON_CENTER")
      cl.compensation.file_cutcom = ClPoints::kCentre;
    return;
  }
  if (cl.systems.catia_lines > 0) return catia_system(cl, s);
  const std::string text = plain(s.text);
  if (text.starts_with("*CATIA0")) cl.systems.catia_lines = 4;
  for (const Mark& one : kMarks) {
    const bool found = one.begins ? text.starts_with(one.text) : text.find(one.text) != std::string::npos;
    if (!found || (!one.begins && cl.path.positioned)) continue;
    mark(cl.reporter, cl.program, one.writer, fmt::format("\"{}\"", one.text), s);
    return;
  }
}

void pprint(ClState& cl, const ClStatement& s) {
  const std::string text = cl.path.positioned ? std::string() : plain(s.text);
  if (text.starts_with("APTCL-SPEC,MAKINO"))
    mark(cl.reporter, cl.program, ClWriter::kMakino, "APTCL-SPEC,MAKINO", s);
  for (const std::string_view name : {"CAMWORKS", "SOLIDWORKS CAM"}) {
    if (text.find(name) != std::string::npos)
      mark(cl.reporter, cl.program, ClWriter::kCamWorks, std::string(name), s);
  }
  note(cl, s);
}

}  // namespace swarf::program::cldata
