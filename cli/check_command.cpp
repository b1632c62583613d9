#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "base/config.h"
#include "cli/check_cl.h"
#include "cli/check_nc.h"
#include "cli/commands.h"
#include "cli/terminal.h"
#include "kinematics/round_trip.h"
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

/// A machine file that reads well is still wrong when its inverse does not lead back.
std::string check_machine(const std::string& file, int poses) {
  const machine::MachineScene machine = machine::load_machine(file);
  const kinematics::RoundTrip trip = kinematics::round_trip(machine.model, poses, 1);
  if (!trip.holds()) {
    throw InputError("no-inverse", {file, 0, 0},
                     fmt::format("of {} random poses {} have no solution and {} another one", trip.poses,
                                 trip.unsolved, trip.not_found),
                     "this is a fault of Swarf: please report it with the file");
  }
  return fmt::format(
      "machine is right: {}, {} axes, {} links\n"
      "  inverse: {} random poses, {} solutions, forward again within {:.2g} mm and {:.2g} rad",
      machine.model.name, machine.model.axes.size(), machine.links.size(), trip.poses, trip.branches,
      trip.tip_mm, trip.axis_rad);
}

/// --cutcom and --circle as they were given.
struct ClCheckOptions {
  std::string cutcom, circle;
};

program::ClOptions cl_options(const ClCheckOptions& given) {
  program::ClOptions options;
  if (!given.cutcom.empty())
    options.cutcom = given.cutcom == "centre" ? program::ClPoints::kCentre : program::ClPoints::kContour;
  if (!given.circle.empty()) options.circle_clockwise = given.circle == "clockwise";
  return options;
}

std::string check_file(const std::string& file, const NcCheckOptions& nc, const ClCheckOptions& cl,
                       int poses) {
  if (is_cl_file(file)) return check_cl(file, cl_options(cl));
  if (is_nc_program(file, nc)) return check_nc(file, nc);
  if (std::filesystem::path(file).extension() != ".toml") {
    const program::Program program = program::load_program(file);
    return fmt::format("program is right: {} blocks, {} surfaces, {} operations", program.blocks,
                       program.surfaces.size(), program.operations.size());
  }
  if (is_scene(file)) return check_scene(file);
  return check_machine(file, poses);
}

int check(const std::vector<std::string>& files, const NcCheckOptions& nc, const ClCheckOptions& cl,
          int poses) {
  int exit_code = kPass;
  for (const std::string& file : files) {
    try {
      fmt::print("{}: {}\n", file, check_file(file, nc, cl, poses));
    } catch (const InputError& error) {
      fmt::print(stderr, "{}\n", error.what());
      exit_code = kBadInput;
    }
  }
  return exit_code;
}

const char* const kCheckFooter =
    R"(What is printed for an NC program: the dialect and why, lines and moves, the way of the tip in feed and rapid moves,
times at the programmed feed, tools that cut, where it starts, extents of cut and axes, words without effect.
Every fault is told with file:line:column and what to do; the program is read up to its first one.

For CL data: writer and its mark, statements and moves, tools, start, extents, words without effect.

Where a program starts: no position is assumed. The first block after which every axis has a place starts it;
a program that feeds before that needs --home, or a scene with `start`.

Examples:
  swarf check part.ngc                                     three axes without limits
  swarf check part.mpf --machine assets/machines/spinner_u5_620/machine.toml --tools tools.toml --home
  swarf check part.nc --dialect fanuc                      when nothing in the text shows the dialect
  swarf check scene.toml machine.toml path.cls             scenes, machines and CL data

Exit codes: 0 all are right; 2 at least one is wrong.)";

}  // namespace

void add_check(CLI::App& app, int& exit_code) {
  auto files = std::make_shared<std::vector<std::string>>();
  auto nc = std::make_shared<NcCheckOptions>();
  auto cl = std::make_shared<ClCheckOptions>();
  auto poses = std::make_shared<int>(10000);
  CLI::App* command =
      app.add_subcommand("check",
                         "Parse and validate scenes and machines (.toml), programs (.nc, .ngc, "
                         ".mpf, .h) and CL data (.cls, .clt, .ncl, .apt, .cldata); run nothing");
  command->add_option("files", *files, "files to check")->required();
  command->add_option("--machine", nc->machine, "machine.toml that NC programs are read for");
  command->add_option("--dialect", nc->dialect,
                      "linuxcnc, fanuc, siemens or heidenhain; recognised when left out");
  command->add_option("--tools", nc->tools,
                      "tool table of NC programs: .toml with [[tool]], or LinuxCNC's .tbl");
  command->add_option(
      "--kinematics", nc->kinematics,
      "what LinuxCNC's M428 M429 M430 select on this machine: m430=identity, m428=tcp, start=tcp, ...");
  command
      ->add_option(
          "--function", nc->functions,
          "M function of the machine's builder that moves nothing (LinuxCNC, Fanuc): M68, \"M68=clamp C\"; "
          "once for each")
      ->allow_extra_args(false);
  command->add_flag("--home", nc->at_home, "NC programs start at the machine's home");
  command
      ->add_option("--cutcom", cl->cutcom,
                   "points of CL data under CUTCOM: of the cutter's centre, or of the part's contour")
      ->check(CLI::IsMember({"centre", "contour"}));
  command
      ->add_option("--circle", cl->circle,
                   "how CIRCLE of CL data runs about its vector; as its writer does when left out")
      ->check(CLI::IsMember({"clockwise", "counter_clockwise"}));
  command->add_option("--poses", *poses, "random poses that a machine's inverse must give back")
      ->check(CLI::Range(1, 100000000))
      ->capture_default_str();
  command->footer(kCheckFooter);
  command->callback([files, nc, cl, poses, &exit_code] { exit_code = check(*files, *nc, *cl, *poses); });
}

}  // namespace swarf::cli
