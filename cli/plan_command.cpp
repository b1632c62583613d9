#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "base/units.h"
#include "cli/commands.h"
#include "cli/terminal.h"
#include "sim/simulation.h"

namespace swarf::cli {
namespace {

struct PlanCommand {
  std::string scene, output;
  std::vector<std::string> overrides;
};

void append_goto(std::string& text, const ToolPose& pose) {
  const Vec3& p = pose.tip_W;
  const Vec3& a = pose.axis_W;
  text += fmt::format("GOTO/{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f}\n", p.x(), p.y(), p.z(), a.x(), a.y(),
                      a.z());
}

/// The path as APT CL data: one GOTO for each control cycle in contact, for both ends of a free move.
std::string cl_text(const sim::Job& job, const toolpath::ToolPath& path,
                    const motion::Trajectory& trajectory) {
  const cutter::Cutter& c = job.scene.cutter;
  std::string text = fmt::format("PARTNO/{}\nUNITS/MM\nLOADTL/{}\nCUTTER/{:g},{:g}\nMULTAX/ON\n",
                                 job.scene.name, c.number, c.diameter_mm, c.corner_radius_mm);
  int element = -1;
  for (const motion::ToolSample& sample : trajectory.samples) {
    const bool cutting = sample.kind == motion::SampleKind::kCutting;
    if (sample.element != element) {
      element = sample.element;
      const toolpath::Element& entry = path.elements[static_cast<size_t>(element)];
      if (const auto* move = std::get_if<toolpath::FreeMove>(&entry.what)) {
        text += move->feed_mm_s > 0.0 ? fmt::format("FEDRAT/{:.3f},MMPM\n", mm_min_from_mm_s(move->feed_mm_s))
                                      : "RAPID\n";
        append_goto(text, move->to);
      } else {
        text += fmt::format("FEDRAT/{:.3f},MMPM\n",
                            mm_min_from_mm_s(std::get<toolpath::SurfacePass>(entry.what).feed_mm_s));
      }
    }
    if (cutting) append_goto(text, sample.pose);
  }
  return text + "FINI\n";
}

int plan(const PlanCommand& options) {
  const sim::Job job = sim::load_job(options.scene, options.overrides);
  if (job.cl) {
    throw InputError("nothing-to-plan", {options.scene}, "the scene's program is CL data already",
                     fmt::format("run it: swarf run {}", options.scene));
  }
  Diagnostics diagnostics;
  const toolpath::ToolPath path = sim::job_path(job, diagnostics);
  print_diagnostics(diagnostics.list());
  TerminalProgress progress;
  const motion::MotionResult motion =
      motion::interpolate(path, job.machine.model, job.scene.cutter, job.scene.motion, progress);
  const std::string text = cl_text(job, path, motion.trajectory);
  const std::string temporary = options.output + ".part";
  {
    std::ofstream file(temporary, std::ios::binary);
    file << text;
    if (!file.flush())
      throw InputError("cannot-write", {options.output}, "the file cannot be written",
                       "check folder and rights");
  }
  std::filesystem::rename(temporary, options.output);
  fmt::print("{}: {} passes, {:.1f} mm in contact, {:.1f} mm of links\n", options.output, path.passes,
             path.pass_length_mm, path.link_length_mm);
  return kPass;
}

}  // namespace

void add_plan(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<PlanCommand>();
  CLI::App* command = app.add_subcommand("plan", "Plan the tool path of a scene and write it as APT CL data");
  command->add_option("scene", options->scene, "scene.toml")->required();
  command->add_option("-o,--output", options->output, "CL file to write")->required();
  command
      ->add_option("--set", options->overrides,
                   "replace a key of the scene: --set toolpath.planner=lin_koren")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
  command->callback([options, &exit_code] { exit_code = plan(*options); });
}

}  // namespace swarf::cli
