#include "reports/tools_table.h"

#include <fmt/format.h>

namespace swarf::reports {

std::vector<double> time_by_tool(const sim::Job& job, const sim::Result& result) {
  std::vector<double> times = result.main.motion.statistics.cycle.in_spindle_s;
  times.resize(job.scene.tools.size(), 0.0);
  return times;
}

Table tools_table(const sim::Job& job, const sim::Result& result) {
  Table table;
  table.title = "Tools";
  table.columns = {{"Tool"}, {"Cutter"}, {"Gauge line to tip", "mm", true}, {"Time", "s", true}};
  const std::vector<double> times = time_by_tool(job, result);
  for (size_t i = 0; i < times.size(); ++i) {
    const cutter::Cutter& tool = job.scene.tools[i];
    table.rows.push_back({cutter::call_name(tool), cutter::describe(tool),
                          job.machine.model.gauge_M ? fmt::format("{:.2f}", cutter::gauge_length(tool)) : "–",
                          times[i] > 0.0 ? fmt::format("{:.1f}", times[i]) : "not used"});
  }
  if (!job.machine.model.gauge_M) {
    table.notes = {
        "The machine has no gauge line: the tip stands where it says, whatever the tool's length."};
  }
  return table;
}

}  // namespace swarf::reports
