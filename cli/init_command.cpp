#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <set>
#include <system_error>

#include "cli/commands.h"
#include "cli/job_flags.h"
#include "cli/shell_text.h"
#include "machine/machine_scene.h"
#include "machine/shipped.h"
#include "reports/pending_folder.h"
#include "sim/job/written_scene.h"

namespace swarf::cli {
namespace {

namespace fs = std::filesystem;

struct InitOptions {
  std::string program, folder = ".";
  JobWords job;
  std::vector<std::string> overrides;
};

void refuse_existing(const fs::path& file) {
  std::error_code problem;
  if (fs::exists(file, problem))
    throw InputError("output-in-the-way", {file.string()}, "this file is there already and would be lost",
                     "name another folder with -o, or take the file away");
}

/// machine.toml and its meshes into `folder`/machine; what the scene then says.
std::string copy_machine(const std::string& name, const fs::path& folder) {
  const std::string file = machine::machine_file(name);
  if (file == name || file.empty()) return name;
  const fs::path home = fs::path(file).parent_path(), to = folder / "machine";
  const std::set<std::string> kinds{".toml", ".ply", ".stl", ".obj"};
  fs::create_directories(to);
  for (const fs::directory_entry& entry : fs::directory_iterator(home)) {
    if (kinds.count(entry.path().extension().string()) == 0) continue;
    refuse_existing(to / entry.path().filename());
    fs::copy_file(entry.path(), to / entry.path().filename());
  }
  return "machine/machine.toml";
}

/// A path is written as seen from the scene.
std::string machine_key(const JobWords& words, const fs::path& folder) {
  if (words.machine.empty()) return "mill_3axis";
  const std::string copied = copy_machine(words.machine, folder);
  if (copied != words.machine) return copied;
  return fs::absolute(words.machine).lexically_proximate(fs::absolute(folder)).string();
}

int init(InitOptions options) {
  const fs::path folder = options.folder;
  refuse_existing(folder / "scene.toml");
  const bool example = options.program.empty();
  if (example) {
    options.program = (folder / "part.nc").string();
    refuse_existing(options.program);
    fs::create_directories(folder);
    reports::write_text(options.program, sim::example_program());
    if (options.job.tool.empty() && options.job.tools.empty()) options.job.tool = "6";
    if (options.job.stock.empty()) options.job.stock = "0,0,-10,60,60,0";
  }
  const sim::Job job = load_job(options.program, options.job, options.overrides);
  fs::create_directories(folder);
  const std::string text = sim::written_scene(job, folder, machine_key(options.job, folder));
  const std::string file = (folder / "scene.toml").lexically_normal().string();
  reports::write_text(file, text);
  if (example) fmt::print("{}: an example, a pocket and a slot\n", options.program);
  fmt::print("{}: what is assumed stands in its comments; run it: swarf run {}\n", file, shell_text({file}));
  return kPass;
}

}  // namespace

void add_init(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<InitOptions>();
  CLI::App* command = app.add_subcommand(
      "init", "Write a commented scene.toml that runs as it stands, for a program or with an example");
  command->add_option("program", options->program,
                      "NC program or CL data (default: an example is written too)");
  command->add_option("-o,--output", options->folder, "folder for scene.toml")->capture_default_str();
  add_job_flags(*command, options->job);
  add_parameter_flag(*command, options->overrides);
  command->footer(
      R"(A machine that is named by its name is copied into the folder, to be changed: machine/machine.toml with its meshes.

Examples:
  swarf init -o first                                        a first job with its program
  swarf init part.nc --tools T1=10,T2=drill5 -o job          the scene that these flags mean
  swarf init part.mpf --machine spinner_u5_620 --tools tools.toml -o job)");
  command->callback([options, &exit_code] { exit_code = init(*options); });
}

}  // namespace swarf::cli
