#include "program/cl/writer.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <utility>

#include "base/units.h"

namespace swarf::program {
namespace {

class Writer {
 public:
  explicit Writer(const ClProgram& program) : program_(program) {}

  std::string write() {
    line("$$ SWARF CL DATA");
    notes_until(0);
    line("UNITS/MM");
    line("MULTAX/ON");
    cutters_of(-1);
    if (!program_.moves.empty()) tool_of(program_.moves.front());
    if (program_.start_line > 0) go_to(program_.start);
    for (const Move& move : program_.moves) {
      notes_until(move.line);
      add(move);
    }
    notes_until(program_.statements + 1, true);
    line("FINI");
    return std::move(text_);
  }

 private:
  void line(const std::string& statement) {
    text_ += statement;
    text_ += '\n';
  }
  template <typename... Numbers>
  void numbers(const char* word, Numbers... values) {
    text_ += word;
    char separator = '/';
    (fmt::format_to(std::back_inserter(text_), "{}{}", std::exchange(separator, ','), values), ...);
    text_ += '\n';
  }

  void go_to(const ToolPose& pose) {
    const Vec3 &p = pose.tip_W, &a = pose.axis_W;
    numbers("GOTO", p.x(), p.y(), p.z(), a.x(), a.y(), a.z());
  }

  /// Notes that stand before this line of the text that was read.
  void notes_until(int before, bool all = false) {
    for (; note_ < program_.notes.size() && (all || program_.notes[note_].line < before); ++note_) {
      const ClNote& note = program_.notes[note_];
      if (note.word == "TOOL PATH") continue;  // written with its tool
      line(note.text.empty() ? note.word : fmt::format("{}/{}", note.word, note.text));
    }
  }

  void tool_of(const Move& move) {
    if (move.tool == tool_) return;
    tool_ = move.tool;
    const ClTool& tool = program_.tools[static_cast<size_t>(tool_)];
    line(tool.number != 0 ? fmt::format("LOADTL/{}", tool.number)
                          : fmt::format("TOOL PATH/PATH,TOOL,{}", tool.name));
    cutters_of(tool_);
  }

  void cutters_of(int tool) {
    for (const ClCutter& cutter : program_.cutters) {
      if (cutter.tool == tool) line(fmt::format("CUTTER/{}", fmt::join(cutter.parameters, ",")));
    }
  }

  void rates_of(const Move& move) {
    if (move.spindle_rpm != spindle_rpm_) {
      spindle_rpm_ = move.spindle_rpm;
      line(spindle_rpm_ == 0.0 ? "SPINDL/OFF"
                               : fmt::format("SPINDL/RPM,{},{}", std::abs(spindle_rpm_),
                                             spindle_rpm_ > 0.0 ? "CLW" : "CCLW"));
    }
    if (move.rapid) {
      line("RAPID");
    } else if (move.feed_mm_s != feed_mm_s_) {
      feed_mm_s_ = move.feed_mm_s;
      line(fmt::format("FEDRAT/MMPM,{}", mm_min_from_mm_s(feed_mm_s_)));
    }
  }

  void add(const Move& move) {
    tool_of(move);
    rates_of(move);
    if (move.dwell_s > 0.0) numbers("DELAY", move.dwell_s);
    if (move.arc) {
      const Vec3& c = move.arc->centre_W;
      const Vec3 n = -move.arc->normal_W;
      const Vec3 arm = move.from.tip_W - c;
      numbers("CIRCLE", c.x(), c.y(), c.z(), n.x(), n.y(), n.z(), (arm - arm.dot(n) * n).norm());
    }
    go_to(move.to);
  }

  const ClProgram& program_;
  std::string text_;
  size_t note_ = 0;
  int tool_ = -1;
  double feed_mm_s_ = 0.0, spindle_rpm_ = 0.0;
};

}  // namespace

std::string write_cl(const ClProgram& program) {
  return Writer(program).write();
}

}  // namespace swarf::program
