#include "reports/tools_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/tool_picture.h"

namespace swarf::reports {
namespace {

/// All operations of one tool.
sim::Operation together(const std::vector<sim::Operation>& operations, int tool) {
  sim::Operation sum{tool};
  for (const sim::Operation& one : operations) {
    if (one.tool != tool) continue;
    sum.feed_s += one.feed_s;
    sum.rapid_s += one.rapid_s;
    sum.dwell_s += one.dwell_s;
    sum.feed_mm += one.feed_mm;
    sum.deepest_mm = std::max(sum.deepest_mm, one.deepest_mm);
    sum.stick_out_mm = std::max(sum.stick_out_mm, one.stick_out_mm);
  }
  return sum;
}

std::string operation_seconds(double value) {
  return fmt::format("{:.1f}", value);
}

std::vector<std::string> tool_row(const cutter::Cutter& tool, const sim::Operation& use, bool gauge) {
  const bool used = use.total_s() > 0.0;
  const auto when_used = [&](const std::string& text) { return used ? text : std::string("–"); };
  return {cutter::call_name(tool),
          cutter::describe(tool),
          gauge ? fmt::format("{:.2f}", cutter::gauge_length(tool)) : "–",
          used ? operation_seconds(use.feed_s) : "not used",
          when_used(fmt::format("{:.2f}", 1e-3 * use.feed_mm)),
          when_used(fmt::format("{:.2f}", use.deepest_mm)),
          fmt::format("{:.1f}", tool.length_mm),
          when_used(fmt::format("{:.1f}", std::ceil(10.0 * use.stick_out_mm) / 10.0))};
}

}  // namespace

std::vector<double> time_by_tool(const sim::Job& job, const sim::Result& result) {
  std::vector<double> times = result.main.motion.statistics.cycle.in_spindle_s;
  times.resize(job.scene.tools.size(), 0.0);
  return times;
}

Table tools_table(const sim::Job& job, const sim::Result& result) {
  Table table;
  table.title = "Tools";
  table.columns = {{"Tool"},
                   {"Cutter"},
                   {"Gauge line to tip", "mm", true},
                   {"Feed", "s", true},
                   {"Feed way", "m", true},
                   {"Deepest", "mm", true},
                   {"Sticks out", "mm", true},
                   {"Enough", "mm", true}};
  const bool gauge = job.machine.model.gauge_M.has_value();
  for (size_t i = 0; i < job.scene.tools.size(); ++i) {
    const cutter::Cutter& tool = job.scene.tools[i];
    table.rows.push_back(tool_row(tool, together(result.main.operations, static_cast<int>(i)), gauge));
    table.pictures.push_back(tool_svg(tool));
  }
  table.notes = {
      "Deepest: of the tip below the faces of the block around the raw stock, along the tool's axis, in feed "
      "moves. Sticks out: tip to holder's face. Enough: the holder then stays out of that block over the "
      "whole motion; less may do where earlier cuts have made room."};
  if (!gauge)
    table.notes.emplace_back(
        "The machine has no gauge line: the tip stands where it says, whatever the tool's length.");
  return table;
}

Table cycle_time_table(const sim::Job& job, const sim::Result& result) {
  const std::vector<sim::Operation>& operations = result.main.operations;
  const std::optional<double> change = job.machine.tool_change_s;
  Table table;
  table.title = "Cycle time";
  table.columns = {{"Operation"},
                   {"Tool"},
                   {"From line", "", true},
                   {"Feed", "s", true},
                   {"Rapid", "s", true},
                   {"Dwell", "s", true},
                   {"Tool change", "s", true},
                   {"Together", "s", true}};
  sim::Operation all;
  double changes = 0.0;
  for (size_t i = 0; i < operations.size(); ++i) {
    const sim::Operation& one = operations[i];
    const double own = i > 0 ? change.value_or(0.0) : 0.0;  // the first tool is in the spindle at the start
    changes += own;
    all.feed_s += one.feed_s;
    all.rapid_s += one.rapid_s;
    all.dwell_s += one.dwell_s;
    table.rows.push_back(
        {fmt::format("{}", i + 1), cutter::call_name(job.scene.tools[static_cast<size_t>(one.tool)]),
         one.first_line > 0 ? fmt::format("{}", one.first_line) : "–", operation_seconds(one.feed_s),
         operation_seconds(one.rapid_s), operation_seconds(one.dwell_s),
         i == 0   ? "–"
         : change ? operation_seconds(own)
                  : "not known",
         operation_seconds(one.total_s() + own)});
  }
  table.rows.push_back({"All", "", "", operation_seconds(all.feed_s), operation_seconds(all.rapid_s),
                        operation_seconds(all.dwell_s),
                        change || operations.size() < 2 ? operation_seconds(changes) : "not known",
                        operation_seconds(all.total_s() + changes)});
  table.highlighted_row = static_cast<int>(operations.size());
  if (!change && operations.size() > 1)
    table.notes = {
        "The machine does not say how long a tool change takes (tool_change_s in machine.toml): it is left "
        "out; the ways to where tools are changed are in."};
  return table;
}

}  // namespace swarf::reports
