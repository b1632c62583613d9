#include <fmt/format.h>

#include <memory>

#include "base/config.h"
#include "cli/commands.h"
#include "cli/job_flags.h"
#include "cli/terminal.h"
#include "machine/shipped.h"
#include "render/image_io.h"
#include "reports/overview.h"
#include "reports/pending_folder.h"
#include "sim/simulation.h"

namespace swarf::cli {
namespace {

struct ShowOptions {
  std::string file, output;
  JobWords job;
  std::vector<std::string> overrides;
  size_t setup = 0;  ///< 0: the scene has one
};

/// A machine lists axes.
bool is_machine(const std::string& file) {
  Diagnostics diagnostics;
  const ConfigTable table = ConfigTable::load(file, {}, diagnostics);
  diagnostics.throw_if_errors();
  return table.has("axis");
}

render::Image picture(const std::string& file, const ShowOptions& options) {
  if (!is_program_file(file) && is_machine(file))
    return reports::machine_overview(machine::load_machine(file));
  const sim::Job job = options.setup > 0 ? *load_setups(file, options.setup, options.overrides).back()
                                         : load_job(file, options.job, options.overrides);
  print_diagnostics(job.warnings);
  Diagnostics diagnostics;
  const toolpath::ToolPath path = sim::job_path(job, diagnostics).path;
  print_diagnostics(diagnostics.list());
  return reports::job_overview(job, path);
}

int show(const ShowOptions& options) {
  let_interrupts_end();
  reports::check_output_file(options.output);
  // "mill_3axis" as run --machine takes it.
  const std::string shipped = machine::machine_file(options.file);
  const bool by_name = !shipped.empty() && shipped != options.file;
  render::save_png(picture(by_name ? shipped : options.file, options), options.output);
  fmt::print("{}\n", options.output);
  return kPass;
}

}  // namespace

void add_show(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ShowOptions>();
  CLI::App* command =
      app.add_subcommand("show", "Draw a machine, a program or a scene in seconds, without simulating it");
  command
      ->add_option("file", options->file,
                   "machine.toml or the name of a shipped machine, program, scene.toml")
      ->required();
  command->add_option("-o,--output", options->output, "PNG file to write")->required();
  add_job_flags(*command, options->job);
  add_parameter_flag(*command, options->overrides);
  command->add_option("--setup", options->setup, "which of several [[setup]] of a scene")
      ->type_name("NUMBER")
      ->check(CLI::Range(1, 1000));
  command->footer(
      R"(A machine: its axes at zero, then its rotary axes at +30 degrees, with the work's origin. A program or scene: the
path in the stock, then the machine in the middle of it.

Examples:
  swarf show spinner_u5_620 -o machine.png
  swarf show my/machine.toml -o machine.png
  swarf show part.nc --tool 6 -o path.png)");
  command->callback([options, &exit_code] { exit_code = show(*options); });
}

}  // namespace swarf::cli
