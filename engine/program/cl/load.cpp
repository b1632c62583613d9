#include <fmt/format.h>

#include <utility>

#include "program/cl/steps.h"
#include "program/letters/line_source.h"
#include "program/source_text.h"

namespace swarf::program {
namespace {

/// Moves and notes into the program itself.
class Collector final : public ClSink {
 public:
  void move(const Move& move) override { moves_.push_back(move); }
  void note(ClNote note) override { notes_.push_back(std::move(note)); }
  void give(ClProgram& program) {
    program.moves = std::move(moves_);
    program.notes = std::move(notes_);
  }

 private:
  std::vector<Move> moves_;
  std::vector<ClNote> notes_;
};

/// The lines of a file, in little memory.
class ClFile final : public ClLines {
 public:
  explicit ClFile(const std::string& path) : source_(path) {}
  bool next(std::string_view& line) override {
    if (!source_.next(line)) return false;
    for (size_t at = 0; at < line.size();) {
      if (static_cast<unsigned char>(line[at]) < 0x80) {
        ++at;
        continue;
      }
      const int length = utf8_length(line, at);
      if (length == 0) {
        throw InputError("not-text",
                         {source_.path(), static_cast<int>(source_.line_number()), nc::column_at(line, at)},
                         fmt::format("byte 0x{:02X} stands here, which is not UTF-8: this is not text",
                                     static_cast<unsigned>(static_cast<unsigned char>(line[at]))),
                         "save the program as plain ASCII or UTF-8 text");
      }
      at += static_cast<size_t>(length);
    }
    return true;
  }

 private:
  nc::LineSource source_;
};

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

ClProgram stream_cl_text(const std::string& text, const std::string& file, ClSink& sink,
                         Diagnostics& diagnostics, const ClOptions& options) {
  Reporter reporter(diagnostics, file);
  if (!check_text(text, reporter, "give CL data, for example GOTO/10,20,30 on a line")) return {};
  ClText lines(text);
  return cldata::run(file, options, sink, diagnostics, lines);
}

ClProgram parse_cl(const std::string& text, const std::string& file, Diagnostics& diagnostics,
                   const ClOptions& options) {
  Collector collector;
  ClProgram program = stream_cl_text(text, file, collector, diagnostics, options);
  collector.give(program);
  return program;
}

ClProgram stream_cl(const std::string& path, ClSink& sink, Diagnostics& diagnostics,
                    const ClOptions& options) {
  ClFile lines(path);
  return cldata::run(path, options, sink, diagnostics, lines);
}

ClProgram load_cl(const std::string& path, Diagnostics* warnings, const ClOptions& options) {
  Diagnostics diagnostics;
  Collector collector;
  ClProgram program = stream_cl(path, collector, diagnostics, options);
  diagnostics.throw_if_errors();
  if (warnings != nullptr) warnings->append(diagnostics);
  collector.give(program);
  return program;
}

}  // namespace swarf::program
