#include <fmt/format.h>

#include <memory>

#include "cli/commands.h"
#include "cli/terminal.h"
#include "program/cl/writer.h"
#include "reports/pending_folder.h"
#include "sim/simulation.h"

namespace swarf::cli {
namespace {

struct PlanCommand {
  std::string scene, output;
  std::vector<std::string> overrides;
};

/// A move to `to` with the feed of the element it belongs to; 0: rapid.
void add_move(program::ClProgram& program, const ToolPose& to, double feed_mm_s) {
  if (program.start_line == 0) {
    program.start = to;
    program.start_line = 1;
    return;
  }
  program::Move move;
  move.from = program.moves.empty() ? program.start : program.moves.back().to;
  move.to = to;
  move.rapid = feed_mm_s == 0.0;
  move.feed_mm_s = feed_mm_s;
  move.tool = 0;
  program.moves.push_back(move);
}

/// The path as CL data: one GOTO for each control cycle in contact, for both ends of a free move.
program::ClProgram cl_program(const sim::Job& job, const toolpath::ToolPath& path,
                              const motion::Cycles& cycles) {
  const cutter::Cutter& c = job.scene.tools.front();
  program::ClProgram program;
  program.notes.push_back({"PARTNO", job.scene.name, 0});
  program.tools.push_back({c.number, {}, {}});
  program.cutters.push_back({{c.diameter_mm, c.corner_radius_mm}, 0, {}});
  int element = -1;
  motion::CycleReader reader(cycles);
  for (size_t k = 0; k < cycles.size(); ++k) {
    const motion::ToolSample& sample = reader.at(k).sample;
    const auto index = static_cast<size_t>(sample.element);
    const toolpath::SurfacePass* pass = path.elements.pass(index);
    const toolpath::DrivenPass* driven = path.elements.driven(index);
    const double feed = pass != nullptr ? pass->feed_mm_s : driven != nullptr ? driven->feed_mm_s : 0.0;
    if (sample.element != element && feed == 0.0) {
      const auto move = std::get<toolpath::FreeMove>(path.elements[index].what);
      add_move(program, move.to, move.feed_mm_s);
    }
    if (feed > 0.0 && sample.kind == motion::SampleKind::kCutting) add_move(program, sample.pose, feed);
    element = sample.element;
  }
  return program;
}

/// The text that -o takes: the scene's own path, or its CL file again, in mm, without cycles and systems.
std::string planned_text(const sim::Job& job, toolpath::ToolPath& path) {
  Diagnostics diagnostics;
  path = sim::job_path(job, diagnostics).path;
  print_diagnostics(diagnostics.list());
  if (job.cl) return program::write_cl(*job.cl);
  if (path.elements.hold_blocks()) {
    throw InputError("nothing-to-plan", {job.scene.file}, "the scene's program is an NC program",
                     fmt::format("run it: swarf run {}", job.scene.file));
  }
  TerminalProgress progress;
  motion::Cycles cycles(path.elements, sim::machines_by_tool(job), job.scene.tools.front(), job.scene.motion);
  cycles.walk([](std::span<const motion::Cycle>) {}, progress);
  return program::write_cl(cl_program(job, path, cycles));
}

int plan(const PlanCommand& options) {
  const sim::Job job = sim::load_job(options.scene, options.overrides);
  reports::check_output_file(options.output);
  toolpath::ToolPath path;
  const std::string text = planned_text(job, path);
  reports::write_text(options.output, text);
  fmt::print("{}: {} passes, {:.1f} mm in contact, {:.1f} mm of links\n", options.output, path.passes,
             path.pass_length_mm, path.link_length_mm);
  return kPass;
}

}  // namespace

void add_plan(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<PlanCommand>();
  CLI::App* command = app.add_subcommand(
      "plan",
      "Plan the tool path of a scene and write it as APT CL data; a CL file is written again, in mm, "
      "without cycles and coordinate systems");
  command->add_option("scene", options->scene, "scene.toml")->required();
  command->add_option("-o,--output", options->output, "CL file to write")->required();
  command
      ->add_option("--set", options->overrides,
                   "replace a key of the scene: --set toolpath.planner=lin_koren")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
  command->footer(R"(Example:
  swarf plan scenes/lin_koren_dome/scene.toml -o dome.cl --set toolpath.planner=lin_koren)");
  command->callback([options, &exit_code] { exit_code = plan(*options); });
}

}  // namespace swarf::cli
