// An NC program as a tool path: one block per move, as the control executes it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "program/nc_program.h"
#include "toolpath/pass_counter.h"
#include "toolpath/tool_path.h"

namespace swarf::toolpath {

/// What was read besides the moves.
struct NcReading {
  program::NcSummary summary;
  std::vector<program::NcNote> notes;
  std::array<long, 4> feed_moves_by_law{};  ///< as the program has them; order of BlockLaw
  long rapids = 0;
  long moves_without_tool = 0;  ///< before the first tool stood in the spindle: left out of the path
};

/// What an NC program comes down to.
struct NcPath {
  ToolPath path;
  NcReading reading;
};

/// Makes elements of the moves. An arc under the joint law is one of standing rotary axes: it is handed on
/// under the law of the tip (kTcpAxes), which is the same motion. Moves that change nothing become none;
/// their dwell goes to the next. Passes are numbered as those of CL programs.
class NcPathSink final : public program::NcSink {
 public:
  bool move(const program::NcMove& move) override;
  void note(const program::NcNote& note) override { result_.reading.notes.push_back(note); }
  /// The path with its file names. Diagnostics: "no-tool-in-spindle" for a feed move without a tool, and for
  /// any move after the spindle was emptied again; "no-motion" for a program that moves no tool at all.
  NcPath finish(program::NcSummary summary, Diagnostics& diagnostics);

 private:
  struct Place {
    int file = 0, line = 0, column = 0;
  };
  NcPath result_;
  PassCounter passes_;
  double dwell_s_ = 0.0;  ///< of moves that became no element
  std::vector<Place> toolless_;
};

}  // namespace swarf::toolpath
