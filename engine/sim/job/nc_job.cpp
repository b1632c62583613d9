#include "sim/job/nc_job.h"

#include <utility>

#include "cutter/cutter.h"

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

program::ControlSetup control_setup(const Job& job, Diagnostics& diagnostics) {
  const SetupSettings& settings = job.scene.setup;
  program::ControlSetup setup;
  setup.machine = job.machine.model;
  setup.tools = control_tools(job.scene.tools);
  for (const auto& [number, axes] : settings.offsets) {
    setup.work_offsets[number] = axis_values(axes, setup.machine, false, diagnostics);
  }
  setup.kinematics_switch = job.scene.kinematics_switch;
  setup.builder_words = job.scene.builder_words;
  if (settings.start) setup.start = axis_values(*settings.start, setup.machine, true, diagnostics);
  return setup;
}

}  // namespace

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
