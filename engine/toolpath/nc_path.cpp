#include "toolpath/nc_path.h"

#include <string>
#include <utility>

namespace swarf::toolpath {
namespace {

using program::NcMove;

bool nc_stands_still(const NcMove& move) {
  return !move.arc && move.q_from == move.q_to && move.from.tip_W == move.to.tip_W &&
         move.from.axis_W == move.to.axis_W;
}

BlockMove block_of(const NcMove& move) {
  BlockMove block;
  block.from = move.from;
  block.to = move.to;
  block.arc = move.arc;
  block.law = move.arc && move.law == BlockLaw::kJoint ? BlockLaw::kTcpAxes : move.law;
  block.feed_mm_s = move.rapid ? 0.0 : move.feed_mm_s;
  block.duration_s = move.rapid ? 0.0 : move.duration_s;
  block.exact_stop = move.exact_stop;
  block.corner_tolerance_mm = move.corner_tolerance_mm;
  block.axes = AxisSpan{move.q_from, move.q_to};
  block.spindle_rpm = move.spindle_rpm;
  block.tool = move.tool;
  return block;
}

}  // namespace

bool NcPathSink::move(const NcMove& move) {
  if (move.tool < 0) {
    ++result_.reading.moves_without_tool;
    // Before the first tool the axes go where it is fetched; later the way between two cuts would be missing.
    if (!move.rapid || !result_.path.elements.empty())
      toolless_.push_back({move.file, move.line, move.column});
    return true;
  }
  dwell_s_ += move.dwell_s;
  if (nc_stands_still(move)) return true;
  if (move.rapid) {
    ++result_.reading.rapids;
  } else {
    ++result_.reading.feed_moves_by_law.at(static_cast<size_t>(move.law));
  }
  BlockMove block = block_of(move);
  block.dwell_s = std::exchange(dwell_s_, 0.0);
  block.pass = passes_.next(block);
  (is_rapid(block) ? result_.path.link_length_mm : result_.path.pass_length_mm) += tip_way(block);
  // The file's number, until its name is known.
  result_.path.elements.push_back({std::move(block), 0, {std::to_string(move.file), move.line, move.column}});
  return true;
}

NcPath NcPathSink::finish(program::NcSummary summary, Diagnostics& diagnostics) {
  result_.reading.summary = std::move(summary);
  const auto file = [&](int index) { return result_.reading.summary.files.at(static_cast<size_t>(index)); };
  result_.path.elements.rename_files([&](const std::string& number) { return file(std::stoi(number)); });
  if (!toolless_.empty()) {
    const Place& first = toolless_.front();
    diagnostics.error(
        "no-tool-in-spindle", {file(first.file), first.line, first.column},
        "the axes move here with an empty spindle, between or as cuts",
        "call a tool (T and M6) before the first feed move and keep one until the end, or say which one "
        "is in the spindle: start_tool in [setup] of the scene; t_changes_tool where T changes it "
        "without M6");
  }
  if (result_.path.elements.empty() && !diagnostics.has_errors()) {
    diagnostics.error("no-motion", {file(0)}, "the program moves no tool",
                      "a job needs at least one move with a tool in the spindle");
  }
  result_.path.planner = "nc";
  result_.path.passes = passes_.count();
  return std::move(result_);
}

}  // namespace swarf::toolpath
