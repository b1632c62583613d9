#include "sim/job/nc_job.h"

#include <fmt/format.h>

#include <utility>

#include "cutter/cutter.h"
#include "sim/job/tool_table.h"

namespace swarf::sim {
namespace {

/// The tools as the control knows them, in the scene's order.
std::vector<program::NcTool> control_tools(const std::vector<cutter::Cutter>& tools) {
  std::vector<program::NcTool> table;
  for (const cutter::Cutter& tool : tools) {
    table.push_back(
        {tool.number, tool.name, cutter::gauge_length(tool), tool.diameter_mm, tool.corner_radius_mm});
  }
  return table;
}

/// What [setup] says is in the spindle, or the only tool there is, where the program cuts without calling
/// any.
void set_start_tool(const Job& job, program::ControlSetup& setup, Diagnostics& diagnostics) {
  const SetupSettings& settings = job.scene.setup;
  if (settings.start_tool > 0 || !settings.start_tool_name.empty()) {
    setup.start_tool = tool_index(job.scene.tools, settings.start_tool, settings.start_tool_name);
    if (setup.start_tool < 0)
      diagnostics.error("unknown-tool", settings.start_tool_where, "the start tool is not among the tools",
                        fmt::format("the scene has {}", list_tools(job.scene.tools)));
  } else if (setup.tools.size() == 1 && setup.incomplete_tools.empty()) {
    setup.start_tool = 0;
    setup.start_tool_if_needed = true;
  }
}

program::ControlSetup control_setup(const Job& job, Diagnostics& diagnostics) {
  const SetupSettings& settings = job.scene.setup;
  program::ControlSetup setup;
  setup.machine = job.machine.model;
  setup.tools = control_tools(job.scene.tools);
  setup.incomplete_tools = job.scene.incomplete_tools;
  for (const auto& [number, axes] : settings.offsets) {
    setup.work_offsets[number] = axis_values(axes, setup.machine, false, diagnostics);
  }
  setup.kinematics_switch = job.scene.kinematics_switch;
  setup.builder_words = job.scene.builder_words;
  setup.presets = job.scene.presets;
  setup.unit_mm = settings.unit_mm ? settings.unit_mm : job.machine.program_unit_mm;
  setup.t_changes_tool = settings.t_changes_tool;
  setup.slot_ends = settings.slot_ends;
  setup.tip_without_length = settings.tip_without_length;
  if (setup.unit_mm.value_or(1.0) != 1.0 && job.scene.tool_table_file.ends_with(".tbl"))
    diagnostics.warning(
        "table-in-mm", {job.scene.tool_table_file, 0, 0},
        "the lengths and diameters of this table are read in mm, and programs are in inches here",
        "describe the tools as [[tool]] where the table counts in inches");
  set_start_tool(job, setup, diagnostics);
  if (settings.start) setup.start = axis_values(*settings.start, setup.machine, true, diagnostics);
  return setup;
}

class NoMoves final : public program::NcSink {
 public:
  bool move(const program::NcMove&) override { return true; }
};

}  // namespace

std::vector<program::AskedTool> asked_of_nc(const Job& job, Diagnostics& diagnostics) {
  program::ControlSetup setup = control_setup(job, diagnostics);
  setup.tools.clear();
  setup.start_tool = -1;
  setup.start_tool_if_needed = false;
  NoMoves sink;
  return program::run_nc(job.scene.program_file, job.scene.dialect, setup, sink, diagnostics).tools_asked;
}

toolpath::NcPath read_nc_program(const Job& job, Diagnostics& diagnostics) {
  const program::ControlSetup setup = control_setup(job, diagnostics);
  diagnostics.throw_if_errors();
  toolpath::NcPathSink sink;
  program::NcSummary summary =
      program::run_nc(job.scene.program_file, job.scene.dialect, setup, sink, diagnostics);
  diagnostics.throw_if_errors();
  return sink.finish(std::move(summary), diagnostics);
}

}  // namespace swarf::sim
