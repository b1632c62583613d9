#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "base/config.h"
#include "cli/check_nc.h"
#include "cli/commands.h"
#include "cli/terminal.h"
#include "sim/simulation.h"

namespace swarf::cli {
namespace {

/// A scene names a program, a machine lists axes.
bool is_scene(const std::string& file) {
  Diagnostics diagnostics;
  const ConfigTable table = ConfigTable::load(file, {}, diagnostics);
  diagnostics.throw_if_errors();
  return table.has("program") || table.has("cl") || table.has("nc") || !table.has("axis");
}

std::string check_scene(const std::string& file) {
  const sim::Job job = sim::load_job(file, {});
  print_diagnostics(job.warnings);
  Diagnostics diagnostics;
  const toolpath::ToolPath path = sim::job_path(job, diagnostics);
  print_diagnostics(diagnostics.list());
  if (job.scene.has_blocks()) {
    return fmt::format("scene is right: {} blocks, {:.0f} mm of feed moves, {:.0f} mm of rapids",
                       path.elements.size(), path.pass_length_mm, path.link_length_mm);
  }
  return fmt::format("scene is right: {} passes, {:.0f} mm in contact", path.passes, path.pass_length_mm);
}

std::string check_file(const std::string& file, const NcCheckOptions& nc) {
  if (is_nc_program(file, nc)) return check_nc(file, nc);
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension == ".cl" || extension == ".cls" || extension == ".apt" || extension == ".cldata") {
    const program::ClProgram program = program::load_cl(file);
    return fmt::format("CL data is right: {} statements, {} moves", program.statements, program.moves.size());
  }
  if (extension != ".toml") {
    const program::Program program = program::load_program(file);
    return fmt::format("program is right: {} blocks, {} surfaces, {} operations", program.blocks,
                       program.surfaces.size(), program.operations.size());
  }
  if (is_scene(file)) return check_scene(file);
  const machine::MachineScene machine = machine::load_machine(file);
  return fmt::format("machine is right: {}, {} axes, {} links", machine.model.name, machine.model.axes.size(),
                     machine.links.size());
}

int check(const std::vector<std::string>& files, const NcCheckOptions& nc) {
  int exit_code = kPass;
  for (const std::string& file : files) {
    try {
      fmt::print("{}: {}\n", file, check_file(file, nc));
    } catch (const InputError& error) {
      fmt::print(stderr, "{}\n", error.what());
      exit_code = kBadInput;
    }
  }
  return exit_code;
}

}  // namespace

void add_check(CLI::App& app, int& exit_code) {
  auto files = std::make_shared<std::vector<std::string>>();
  auto nc = std::make_shared<NcCheckOptions>();
  CLI::App* command =
      app.add_subcommand("check",
                         "Parse and validate scenes and machines (.toml), programs (.nc, .ngc, "
                         ".mpf, .h) and CL data (.cl, .cls, .apt, .cldata); run nothing");
  command->add_option("files", *files, "files to check")->required();
  command->add_option("--machine", nc->machine, "machine.toml that NC programs are read for");
  command->add_option("--dialect", nc->dialect,
                      "linuxcnc, fanuc, siemens or heidenhain; recognised when left out");
  command->add_flag("--home", nc->at_home, "NC programs start at the machine's home");
  command->callback([files, nc, &exit_code] { exit_code = check(*files, *nc); });
}

}  // namespace swarf::cli
