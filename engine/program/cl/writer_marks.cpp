#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include "program/cl/interpreter.h"

namespace swarf::program {
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

const char* writer_name(ClWriter writer) {
  switch (writer) {
    case ClWriter::kSwarf:
      return "Swarf";
    case ClWriter::kNx:
      return "NX";
    case ClWriter::kCreo:
      return "Creo";
    case ClWriter::kCatia:
      return "CATIA";
    case ClWriter::kMastercam:
      return "Mastercam";
    case ClWriter::kCamWorks:
      return "SolidWorks CAM";
    case ClWriter::kMakino:
      return "Makino";
    case ClWriter::kUnknown:
      break;
  }
  return "unknown";
}

void ClInterpreter::mark(ClWriter writer, const std::string& what, const ClStatement& s) {
  // What Swarf writes has been read: its words mean what they say, whoever's they are.
  if (program_.writer == writer || program_.writer == ClWriter::kSwarf) return;
  if (program_.writer == ClWriter::kUnknown) {
    program_.writer = writer;
    program_.writer_reason = fmt::format("{} on line {}", what, s.line);
    return;
  }
  fault("writer-contradiction", s,
        fmt::format("{} is a mark of {}, and the file was taken for one of {} ({})", what,
                    writer_name(writer), writer_name(program_.writer), program_.writer_reason),
        "give one file of one system: what CIRCLE and other words mean differs between them");
}

std::optional<double> ClInterpreter::circle_sense() const {
  if (options_.circle_clockwise) return *options_.circle_clockwise ? -1.0 : 1.0;
  switch (program_.writer) {
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

void ClInterpreter::comment(const ClStatement& s) {
  if (s.word == "$$->CSYS") return creo_system(s);
  if (s.word == "$$->CUTTER") {
    mark(ClWriter::kCreo, "$$-> CUTTER", s);
    return cutter(s);
  }
  if (s.word != "$$") {
    mark(ClWriter::kCreo, s.word, s);
    // Creo says itself what its points are under CUTCOM.
    if (s.word == "$$->CUTCOM_GEOMETRY_TYPE" && s.text == "OUTPUT_ON_CENTER")
      file_cutcom_ = ClPoints::kCentre;
    return;
  }
  if (catia_lines_ > 0) return catia_system(s);
  const std::string text = plain(s.text);
  if (text.starts_with("*CATIA0")) catia_lines_ = 4;
  for (const Mark& one : kMarks) {
    const bool found = one.begins ? text.starts_with(one.text) : text.find(one.text) != std::string::npos;
    if (!found || (!one.begins && positioned_)) continue;
    mark(one.writer, fmt::format("\"{}\"", one.text), s);
    return;
  }
}

void ClInterpreter::pprint(const ClStatement& s) {
  const std::string text = positioned_ ? std::string() : plain(s.text);
  if (text.starts_with("APTCL-SPEC,MAKINO")) mark(ClWriter::kMakino, "APTCL-SPEC,MAKINO", s);
  for (const std::string_view name : {"CAMWORKS", "SOLIDWORKS CAM"}) {
    if (text.find(name) != std::string::npos) mark(ClWriter::kCamWorks, std::string(name), s);
  }
  note(s);
}

}  // namespace swarf::program
