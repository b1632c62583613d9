#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "base/config.h"
#include "cli/check_cl.h"
#include "cli/check_nc.h"
#include "cli/commands.h"
#include "cli/job_flags.h"
#include "cli/pipeline_files.h"
#include "cli/stdin_program.h"
#include "cli/terminal.h"
#include "kinematics/round_trip.h"
#include "post/post_format.h"
#include "program/dialects.h"
#include "reports/metrics_json.h"
#include "sim/simulation.h"

namespace swarf::cli {
namespace {

enum class TomlKind { kScene, kMachine, kPost };

/// A post has words for motion, a scene names a program, a machine lists axes.
TomlKind toml_kind(const std::string& file) {
  Diagnostics diagnostics;
  const ConfigTable table = ConfigTable::load(file, {}, diagnostics);
  diagnostics.throw_if_errors();
  if (table.has("dialect") && table.has("motion")) return TomlKind::kPost;
  const bool scene = table.has("program") || table.has("cl") || table.has("nc") || !table.has("axis");
  return scene ? TomlKind::kScene : TomlKind::kMachine;
}

Checked check_post(const std::string& file) {
  const post::PostFormat format = post::load_post(file);
  return {
      "post",
      fmt::format("post is right: {}, read back as {}; {}", format.name,
                  program::dialect_name(format.dialect),
                  format.has_tcp() ? "with words for TCP" : "without TCP"),
      {{"name", format.name}, {"dialect", program::dialect_name(format.dialect)}, {"tcp", format.has_tcp()}},
      {}};
}

/// What the machine cannot do, beyond what [accept] allows: the judge's own checks of the motion.
void find_motion_faults(const sim::Job& job, sim::MeasuredPath moved, Checked& checked) {
  for (const motion::MotionFinding& fault : moved.motion.findings) {
    const Diagnostic told{fault.code, fault.severity, fault.where, fault.text, ""};
    if (fault.severity != Severity::kError) checked.told.push_back(told);
  }
  sim::Result result;
  result.main = std::move(moved);
  for (const sim::Check& check : sim::judge_motion(job, result)) {
    checked.numbers[check.name] = sim::outcome_name(check.outcome);
    if (check.outcome != sim::Outcome::kFails) continue;
    const size_t before = checked.findings.size();
    for (const motion::MotionFinding& fault : result.main.motion.findings) {
      if (fault.severity == Severity::kError && sim::check_of(fault) == check.name)
        checked.findings.push_back({fault.code, fault.severity, fault.where, fault.text, ""});
    }
    if (checked.findings.size() == before)
      checked.findings.push_back({check.name, Severity::kError, {job.scene.file}, check.what, ""});
  }
}

/// Plans the path and moves the axes along it; cuts nothing.
Checked check_job(const std::string& file, const sim::Job& job) {
  Progress silent;
  sim::MeasuredPath moved = sim::move_tool(job, silent);
  const toolpath::ToolPath& path = moved.path;
  std::vector<Diagnostic> told = job.warnings;
  for (const sim::Assumption& one : job.scene.assumptions)
    told.push_back({"assumed", Severity::kNote, {file}, one.what + ": " + one.value, one.change});
  told.insert(told.end(), moved.warnings.begin(), moved.warnings.end());
  const nlohmann::ordered_json numbers{{"elements", path.elements.size()},
                                       {"passes", path.passes},
                                       {"feed_mm", path.pass_length_mm},
                                       {"link_mm", path.link_length_mm},
                                       {"time_s", moved.motion.statistics.time_s}};
  const std::string what =
      path.elements.hold_blocks()
          ? fmt::format("{} blocks, {:.0f} mm of feed moves, {:.0f} mm of rapids", path.elements.size(),
                        path.pass_length_mm, path.link_length_mm)
          : fmt::format("{} passes, {:.0f} mm in contact", path.passes, path.pass_length_mm);
  Checked checked{"scene", "", numbers, told};
  find_motion_faults(job, std::move(moved), checked);
  checked.text = checked.findings.empty()
                     ? "scene is right: " + what + "; within travel, reach and speed of the axes"
                     : "scene reads well: " + what + "; the machine cannot do it";
  checked.text += fmt::format("\n  driven    {:.3f} s with the scene's [interpolator]",
                              checked.numbers.at("time_s").get<double>());
  return checked;
}

/// Every set-up, one after the other.
Checked check_setups(const std::string& file, const std::vector<std::string>& overrides) {
  Checked all{"scene", "", {{"setups", nlohmann::ordered_json::array()}}, {}};
  for (const std::shared_ptr<const sim::Job>& job : load_setups(file, 0, overrides)) {
    const Checked one = check_job(file, *job);
    all.text += fmt::format("{}{}: {}", all.text.empty() ? "" : "\n", job->scene.title, one.text);
    nlohmann::ordered_json numbers{{"name", job->scene.setup.name}, {"right", one.findings.empty()}};
    numbers.update(one.numbers);
    all.numbers["setups"].push_back(numbers);
    all.told.insert(all.told.end(), one.told.begin(), one.told.end());
    all.findings.insert(all.findings.end(), one.findings.begin(), one.findings.end());
  }
  return all;
}

Checked check_scene(const std::string& file, const std::vector<std::string>& parameters) {
  std::vector<std::string> overrides;
  for (const std::string& one : parameters) overrides.push_back("parameters." + one);
  if (sim::count_setups(file, overrides) > 0) return check_setups(file, overrides);
  return check_job(file, sim::load_job(file, overrides));
}

/// A machine file that reads well is still wrong when its inverse does not lead back.
Checked check_machine(const std::string& file, int poses) {
  const machine::MachineScene machine = machine::load_machine(file);
  const kinematics::RoundTrip trip = kinematics::round_trip(machine.model, poses, 1);
  if (!trip.holds()) {
    throw InputError("no-inverse", {file, 0, 0},
                     fmt::format("of {} random poses {} have no solution and {} another one", trip.poses,
                                 trip.unsolved, trip.not_found),
                     "this is a fault of Swarf: please report it with the file");
  }
  const std::string text = fmt::format(
      "machine is right: {}, {} axes, {} links\n"
      "  inverse: {} random poses, {} solutions, forward again within {:.2g} mm and {:.2g} rad",
      machine.model.name, machine.model.axes.size(), machine.links.size(), trip.poses, trip.branches,
      trip.tip_mm, trip.axis_rad);
  return {"machine",
          text,
          {{"name", machine.model.name},
           {"axes", machine.model.axes.size()},
           {"links", machine.links.size()},
           {"poses", trip.poses},
           {"solutions", trip.branches},
           {"tip_error_max_mm", trip.tip_mm},
           {"axis_error_max_rad", trip.axis_rad}},
          {}};
}

/// Surfaces that a scene drives or measures: the file itself machines nothing.
Checked check_surfaces(const std::string& file) {
  const size_t count = program::load_surfaces(file).size();
  return {"surface_blocks",
          fmt::format("surfaces are right: {}; no block machines them, a scene takes them ([driven] surface, "
                      "[design] surface)",
                      count),
          {{"blocks", 0}, {"surfaces", count}, {"operations", 0}},
          {}};
}

bool lacks_operations(const InputError& error) {
  const std::vector<Diagnostic>& told = error.diagnostics.list();
  return std::all_of(told.begin(), told.end(), [](const Diagnostic& one) {
    return one.code == "no-operation" || one.severity != Severity::kError;
  });
}

Checked check_surface_blocks(const std::string& file) {
  program::Program program;
  try {
    program = program::load_program(file);
  } catch (const InputError& error) {
    if (!lacks_operations(error)) throw;
    return check_surfaces(file);
  }
  return {"surface_blocks",
          fmt::format("program is right: {} blocks, {} surfaces, {} operations", program.blocks,
                      program.surfaces.size(), program.operations.size()),
          {{"blocks", program.blocks},
           {"surfaces", program.surfaces.size()},
           {"operations", program.operations.size()}},
          {}};
}

/// --cutcom, --circle and --tracut as they were given.
struct ClCheckOptions {
  std::string cutcom, circle, tracut;
};

/// "mm", "inch"; "": not said.
std::optional<double> unit_mm(const std::string& word) {
  if (word.empty()) return std::nullopt;
  return word == "inch" ? 25.4 : 1.0;
}

program::ClOptions cl_options(const ClCheckOptions& given) {
  program::ClOptions options;
  if (!given.cutcom.empty())
    options.cutcom = given.cutcom == "centre" ? program::ClPoints::kCentre : program::ClPoints::kContour;
  if (!given.circle.empty()) options.circle_clockwise = given.circle == "clockwise";
  if (!given.tracut.empty())
    options.tracut = given.tracut == "apply" ? program::ClTracut::kApply : program::ClTracut::kApplied;
  return options;
}

struct CheckOptions {
  std::vector<std::string> files;
  NcCheckOptions nc;
  ClCheckOptions cl;
  int poses = 10000;
  bool json = false;
  PipelineFiles pipeline;
};

Checked check_file(const std::string& file, const CheckOptions& options) {
  if (is_cl_file(file)) {
    program::ClOptions cl = cl_options(options.cl);
    cl.unit_mm = unit_mm(options.nc.units);
    return check_cl(file, cl);
  }
  if (is_nc_program(file, options.nc)) return check_nc(file, options.nc);
  if (std::filesystem::path(file).extension() != ".toml") return check_surface_blocks(file);
  const TomlKind kind = toml_kind(file);
  if (kind == TomlKind::kPost) return check_post(file);
  return kind == TomlKind::kScene ? check_scene(file, options.nc.parameters)
                                  : check_machine(file, options.poses);
}

/// One object for each file; one that cannot be read has no kind, and its errors among the diagnostics.
nlohmann::ordered_json object_of(const std::string& file, const std::optional<Checked>& checked,
                                 const std::vector<Diagnostic>& told) {
  nlohmann::ordered_json object{{"file", file}, {"right", checked && checked->findings.empty()}};
  object["kind"] = checked ? nlohmann::ordered_json(checked->kind) : nlohmann::ordered_json();
  object["diagnostics"] = nlohmann::ordered_json::array();
  for (const Diagnostic& one : told) {
    object["diagnostics"].push_back({{"code", one.code},
                                     {"severity", reports::severity_name(one.severity)},
                                     {"file", one.where.file},
                                     {"line", one.where.line},
                                     {"column", one.where.column},
                                     {"text", one.text},
                                     {"fix", one.fix}});
  }
  if (checked) object.update(checked->numbers);
  return object;
}

/// What was found of one file, and whether it could be read.
struct FileCheck {
  std::optional<Checked> checked;
  std::vector<Diagnostic> told;
};

FileCheck check_readable(const std::string& file, const CheckOptions& options) {
  FileCheck found;
  try {
    found.checked = check_file(file, options);
    found.told = found.checked->findings;
    found.told.insert(found.told.end(), found.checked->told.begin(), found.checked->told.end());
  } catch (const InputError& error) {
    found.told = error.diagnostics.list();
  }
  return found;
}

/// "-": an NC program from the standard input.
FileCheck check_named(const std::string& name, const CheckOptions& options) {
  if (name != "-") return check_readable(name, options);
  try {
    const StdinProgram program;
    FileCheck found = check_readable(program.file(), options);
    program.name_places(found.told);
    return found;
  } catch (const InputError& error) {
    return {std::nullopt, error.diagnostics.list()};
  }
}

/// A flag that none of the files takes would be believed to have been followed. Throws InputError
/// "flag-of-other-kind".
void refuse_unused(const CheckOptions& options) {
  const auto is_toml = [](const std::string& file) {
    return std::filesystem::path(file).extension() == ".toml";
  };
  const bool any_cl = std::any_of(options.files.begin(), options.files.end(), is_cl_file);
  const bool any_nc = std::any_of(options.files.begin(), options.files.end(), [&](const std::string& file) {
    return !is_cl_file(file) && !is_toml(file);
  });
  const auto refuse = [](const char* flag, bool given, const char* of) {
    if (given)
      throw InputError("flag-of-other-kind", {flag},
                       fmt::format("{} is of {}, and none is among the files", flag, of), "leave it out");
  };
  const char* const cl = "CL data";
  const char* const nc = "NC programs";
  refuse("--cutcom", !any_cl && !options.cl.cutcom.empty(), cl);
  refuse("--circle", !any_cl && !options.cl.circle.empty(), cl);
  refuse("--tracut", !any_cl && !options.cl.tracut.empty(), cl);
  refuse("--units", !any_cl && !any_nc && !options.nc.units.empty(), "programs");
  if (any_nc) return;
  refuse("--machine", !options.nc.machine.empty(), nc);
  refuse("--dialect", !options.nc.dialect.empty(), nc);
  refuse("--tools", !options.nc.tools.empty(), nc);
  refuse("--home", options.nc.at_home, nc);
  refuse("--start-tool", options.nc.start_tool != 0, nc);
  refuse("--t-changes-tool", options.nc.t_changes_tool, nc);
  refuse("--slot-ends", !options.nc.slot_ends.empty(), nc);
  refuse("--kinematics", !options.nc.kinematics.empty(), nc);
  refuse("--builder-word", !options.nc.builder_words.empty(), nc);
}

int check(const CheckOptions& options, std::vector<reports::FileVerdict>& found) {
  refuse_unused(options);
  nlohmann::ordered_json objects = nlohmann::ordered_json::array();
  int exit_code = kPass;
  for (const std::string& file : options.files) {
    const auto [checked, told] = check_named(file, options);
    if (!checked) exit_code = kBadInput;
    if (checked && !checked->findings.empty() && exit_code == kPass) exit_code = kFindings;
    found.push_back({file, told});
    if (options.json) {
      objects.push_back(object_of(file, checked, told));
      continue;
    }
    print_diagnostics(told);
    if (checked) fmt::print("{}: {}\n", file, checked->text);
  }
  if (options.json) {
    const nlohmann::ordered_json all{
        {"schema", 1}, {"swarf", SWARF_VERSION}, {"right", exit_code == kPass}, {"files", objects}};
    fmt::print("{}\n", all.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  }
  return exit_code;
}

const char* const kCheckFooter =
    R"(What is printed for an NC program: the dialect and why, lines and moves, the way of the tip in feed and rapid moves,
times at the programmed feed, and with --machine the time and the travel of each axis as `swarf run` has them, to the
same cycle (look-ahead with the interpolator's defaults, which are printed; to have a scene's own settings, check
the scene; half a minute and a quarter of a gigabyte for a million moves; --no-drive leaves it out);
tools that cut, where it starts, extents of cut and axes, words without effect.
Every fault is told with file:line:column and what to do; the program is read up to its first one.

For CL data: writer and its mark, statements and moves, tools, start, extents, words without effect.

Where a program starts: no position is assumed. The first block after which every axis has a place starts it;
a program that feeds before that needs --home, or a scene with `start`.

Examples:
  swarf check part.ngc                                     three axes without limits
  swarf check part.mpf --machine assets/machines/spinner_u5_620/machine.toml --tools tools.toml --home
  swarf check part.nc --dialect fanuc                      named: not recognised from the text
  swarf check scene.toml machine.toml path.cls             scenes, machines and CL data
  post part.cls | swarf check - --dialect fanuc            a program through a pipe; what it calls lies in no folder
  swarf check --json *.nc --dialect fanuc                  for a pipeline: every file's numbers and diagnostics

Which dialect: words that only one has show it, comments do not. A text that shows none is read as the common core of
ISO words (linuxcnc), and one that cannot be read in its dialect in the next best; both are said.

A scene's path is planned and its axes are moved along it: moves out of travel or reach, or faster than an axis,
are findings. An NC program alone is held to the travel of --machine; how fast its axes go takes a scene.

Exit codes: 0 all are right; 1 at least one asks for what its machine cannot do; 2 at least one is wrong.)";

}  // namespace

void add_check(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand(
      "check",
      "Validate scenes, machines and posts (.toml), programs (.nc, .ngc, .mpf, .h) and CL data "
      "(.cls, .clt, .ncl, .apt, .cldata); move the axes of scenes, cut nothing");
  command->add_option("files", options->files, "files to check; -: an NC program from the standard input")
      ->required();
  command
      ->add_option("--machine", options->nc.machine,
                   "what NC programs are read for: a machine that 'swarf machines' lists, or machine.toml")
      ->type_name("NAME|FILE");
  command->add_option("--dialect", options->nc.dialect,
                      program::dialect_list(" or ") + "; recognised when left out");
  command->add_option("--tools", options->nc.tools,
                      "tools of NC programs: T1=6,T2=ball4, or a table: .toml with [[tool]], LinuxCNC's "
                      ".tbl, Fusion's .json, FreeCAD's .fctl, "
                      "ISO 13399's .p21");
  command->add_option(
      "--kinematics", options->nc.kinematics,
      "what LinuxCNC's M428 M429 M430 select on this machine: m430=identity, m428=tcp, start=tcp, ...");
  command
      ->add_option("--set-parameter", options->nc.parameters,
                   "a parameter's value before an NC program starts: 500=3.5 (#500), R1=2, Q5=1, NAME=3 (a "
                   "GUD); once for each")
      ->type_name("NAME=NUMBER")
      ->allow_extra_args(false);
  command
      ->add_option("--builder-word", options->nc.builder_words,
                   "what the machine's builder added and what moves nothing: M68, \"M68=clamp C\", \"CYCL "
                   "DEF 392\", the name of "
                   "a program (840D); once for each")
      ->allow_extra_args(false);
  bool& drive = options->nc.drive;
  command->add_flag_callback(
      "--no-drive", [&drive] { drive = false; },
      "with --machine: no time and travel by look-ahead, only at the programmed feed");
  command->add_flag("--home", options->nc.at_home, "NC programs start at the machine's home");
  command
      ->add_option(
          "--units", options->nc.units,
          "unit of NC programs that have neither G20 nor G21 (the machine's when left out), and of CL data "
          "without UNITS (mm)")
      ->check(CLI::IsMember({"mm", "inch"}));
  command->add_option("--start-tool", options->nc.start_tool,
                      "number of the tool that is in the spindle when an NC program starts");
  command->add_flag("--t-changes-tool", options->nc.t_changes_tool, "T changes the tool at once, without M6");
  command
      ->add_option("--slot-ends", options->nc.slot_ends,
                   "840D: RAD and AFSL of slots end at the slot's edge, or at the centre of its round end")
      ->check(CLI::IsMember({"edge", "centre"}));
  command
      ->add_option("--cutcom", options->cl.cutcom,
                   "points of CL data under CUTCOM: of the cutter's centre, or of the part's contour")
      ->check(CLI::IsMember({"centre", "contour"}));
  command
      ->add_option("--circle", options->cl.circle,
                   "how CIRCLE of CL data runs about its vector; as its writer does when left out")
      ->check(CLI::IsMember({"clockwise", "counter_clockwise"}));
  command
      ->add_option("--tracut", options->cl.tracut,
                   "positions behind TRACUT of CL data: apply its matrix, or it has been applied")
      ->check(CLI::IsMember({"apply", "applied"}));
  command->add_option("--poses", options->poses, "random poses that a machine's inverse must give back")
      ->check(CLI::Range(1, 100000000))
      ->capture_default_str();
  command->footer(kCheckFooter);
  command->add_flag("--json", options->json, "print one JSON object instead of text");
  add_pipeline_options(*command, options->pipeline);
  command->callback([options, &exit_code] {
    exit_code = with_pipeline_files(options->pipeline, "", [&](std::vector<reports::FileVerdict>& found) {
      return check(*options, found);
    });
  });
}

}  // namespace swarf::cli
