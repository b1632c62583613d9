#include "reports/nc_report.h"

#include <fmt/format.h>

#include <numeric>

#include "reports/tools_table.h"

namespace swarf::reports {
namespace {

using toolpath::BlockLaw;

std::string base_name(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

std::string files_of(const program::NcSummary& summary) {
  std::string text;
  for (const std::string& file : summary.files) text += (text.empty() ? "" : ", ") + base_name(file);
  return text;
}

std::string rapid_kind(const sim::Job& job) {
  return job.machine.model.rapid == kinematics::RapidMotion::kDogLeg
             ? "dog-leg: each axis at its own speed (machine.toml)"
             : "linear: all axes arrive together (machine.toml)";
}

}  // namespace

std::string execution_modes(const toolpath::NcReading& reading) {
  std::string text;
  for (size_t i = 0; i < reading.feed_moves_by_law.size(); ++i) {
    const long count = reading.feed_moves_by_law.at(i);
    if (count == 0) continue;
    text += fmt::format("{}{}, {} blocks", text.empty() ? "" : "; ",
                        toolpath::law_name(static_cast<BlockLaw>(i)), count);
  }
  return text.empty() ? "no feed moves" : text;
}

FactGroup nc_facts(const sim::Job& job, const sim::Result& result) {
  const toolpath::NcReading& nc = *result.main.nc;
  return {"NC program",
          {{"Files", files_of(nc.summary)},
           {"Dialect",
            fmt::format("{}: {}", program::dialect_name(nc.summary.dialect), nc.summary.dialect_reason)},
           {"Start", nc.summary.start},
           {"Tool at the start", nc.summary.start_tool.empty() ? "none" : nc.summary.start_tool},
           {"Execution", execution_modes(nc)},
           {"Rapids", fmt::format("{}; {}", nc.rapids, rapid_kind(job))},
           {"Read", fmt::format("{} lines, {} blocks, {} moves", nc.summary.lines, nc.summary.blocks,
                                nc.summary.moves)}}};
}

std::vector<std::pair<std::string, std::string>> nc_lines(const sim::Job& job, const sim::Result& result) {
  const toolpath::NcReading& nc = *result.main.nc;
  std::string tools;
  const std::vector<double> times = time_by_tool(job, result);
  for (size_t i = 0; i < times.size(); ++i) {
    if (times[i] == 0.0) continue;
    tools += fmt::format("{}{} {:.1f} s", tools.empty() ? "" : ", ", cutter::call_name(job.scene.tools[i]),
                         times[i]);
  }
  return {{"dialect",
           fmt::format("{}: {}", program::dialect_name(nc.summary.dialect), nc.summary.dialect_reason)},
          {"path", fmt::format("{} feed moves of {:.0f} mm, {} rapids of {:.0f} mm",
                               std::accumulate(nc.feed_moves_by_law.begin(), nc.feed_moves_by_law.end(), 0L),
                               result.main.path.pass_length_mm, nc.rapids, result.main.path.link_length_mm)},
          {"execution", execution_modes(nc)},
          {"start", nc.summary.start},
          {"time", fmt::format("{:.1f} s ({} cycles of {:g} ms)", result.main.motion.statistics.time_s,
                               result.main.motion.statistics.ticks, job.scene.motion.period_s * 1e3)},
          {"tools", tools}};
}

std::vector<Check> nc_checks(const sim::Job& job, const sim::Result& result) {
  const toolpath::NcReading& nc = *result.main.nc;
  std::vector<Check> checks;
  if (!nc.summary.functions.empty()) {
    checks.push_back({"Functions of the program without effect on the geometry", "",
                      fmt::format("read, not simulated: {}", fmt::join(nc.summary.functions, ", ")),
                      State::kNotChecked});
  }
  if (nc.moves_without_tool > 0) {
    checks.push_back(
        {"Moves before the first tool", "",
         fmt::format("{} rapids with an empty spindle are left out of path and time", nc.moves_without_tool),
         State::kNotChecked});
  }
  if (!job.machine.tool_change_s)
    checks.push_back({"Time of tool changes", "",
                      "the machine does not say how long one takes (tool_change_s)", State::kNotChecked});
  return checks;
}

}  // namespace swarf::reports
