#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "base/config.h"
#include "cli/commands.h"
#include "cli/terminal.h"
#include "sim/scene.h"
#include "toolpath/tool_path.h"

namespace swarf::cli {
namespace {

/// A scene names a program, a machine lists axes.
bool is_scene(const std::string& file) {
  Diagnostics diagnostics;
  const ConfigTable table = ConfigTable::load(file, {}, diagnostics);
  diagnostics.throw_if_errors();
  return table.has("program") || !table.has("axis");
}

std::string check_scene(const std::string& file) {
  const sim::Job job = sim::load_job(file, {});
  print_diagnostics(job.warnings);
  Diagnostics diagnostics;
  const toolpath::ToolPath path =
      toolpath::plan(job.program, job.scene.cutter, job.scene.toolpath, diagnostics);
  diagnostics.throw_if_errors();
  print_diagnostics(diagnostics.list());
  return fmt::format("scene is right: {} passes, {:.0f} mm in contact", path.passes, path.pass_length_mm);
}

std::string check_file(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
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

int check(const std::vector<std::string>& files) {
  int exit_code = kPass;
  for (const std::string& file : files) {
    try {
      fmt::print("{}: {}\n", file, check_file(file));
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
  CLI::App* command = app.add_subcommand(
      "check", "Parse and validate scenes and machines (.toml) and programs (.nc); run nothing");
  command->add_option("files", *files, "files to check")->required();
  command->callback([files, &exit_code] { exit_code = check(*files); });
}

}  // namespace swarf::cli
