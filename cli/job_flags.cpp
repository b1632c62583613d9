#include "cli/job_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/file.h"
#include "cli/check_cl.h"
#include "cli/check_nc.h"
#include "cli/number_flags.h"
#include "program/dialects.h"
#include "sim/job/open_job.h"

namespace swarf::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTakes =
    "a scene (scene.toml), an NC program (.nc .ngc .tap .gcode .mpf .h .eia ..) or CL data (.cls .clt .ncl "
    ".apt "
    ".cldata); 'swarf init part.nc --tool 6' writes a scene";

void require_file(const std::string& file) {
  std::error_code problem;
  if (file == "-")
    throw InputError("file-not-found", {"-"},
                     "a program through a pipe has no file that the results can name",
                     "save it first: cat > part.nc; 'swarf check -' reads a pipe");
  if (file.empty())
    throw InputError("file-not-found", {"swarf"}, "no file is named", fmt::format("name {}", kTakes));
  if (fs::is_directory(file, problem))
    throw InputError("file-not-found", {file}, "this is a folder",
                     fs::exists(fs::path(file) / "scene.toml", problem)
                         ? "name " + (fs::path(file) / "scene.toml").string()
                         : fmt::format("name {}", kTakes));
  if (!fs::exists(file, problem))
    throw InputError("file-not-found", {file}, "there is no such file",
                     fmt::format("check the path and its spelling; it takes {}", kTakes));
}

void set_tools(const JobWords& words, sim::JobFlags& flags) {
  std::error_code problem;
  flags.tools = words.tool;
  if (words.tools.empty()) return;
  if (fs::is_regular_file(words.tools, problem)) {
    flags.tool_table = words.tools;
  } else if (words.tools.find('=') != std::string::npos) {
    flags.tools = words.tools;
  } else {
    throw InputError("bad-tool-list", {"--tools " + words.tools},
                     "this is neither a file nor a list of tools",
                     "write --tools T1=6,T2=ball4,T3=drill5, or name a tool table");
  }
}

}  // namespace

void add_job_flags(CLI::App& command, JobWords& words) {
  const char* const group = "A program without a scene";
  CLI::Option* tool =
      command
          .add_option("--tool", words.tool,
                      "its only tool: 6 (flat end, D 6 mm), ball4, bull10r1, drill5, chamfer8a90, 0.25in")
          ->type_name("WORD")
          ->group(group);
  command
      .add_option("--tools", words.tools,
                  "its tools: T1=6,T2=ball4,T3=drill5, or a tool table (.toml, .tbl of LinuxCNC, .json of "
                  "Fusion, .fctl of FreeCAD, .p21 of ISO 13399)")
      ->type_name("LIST|FILE")
      ->excludes(tool)
      ->group(group);
  command
      .add_option(
          "--stock", words.stock,
          "raw stock in the work frame: lower and upper corner of a block; cyl,D,L or tube,D,d,L from the "
          "origin down; a closed mesh in mm (casting.stl); auto: a block around the path")
      ->type_name("X0,Y0,Z0,X1,Y1,Z1")
      ->group(group);
  command
      .add_option("--machine", words.machine,
                  "a machine that 'swarf machines' lists, or machine.toml (default: mill_3axis)")
      ->type_name("NAME|FILE")
      ->group(group);
  command
      .add_option("--design", words.design,
                  "what the part is measured against: STEP or IGES (.step .stp .igs .iges), or a closed mesh "
                  "in mm (.stl .ply "
                  ".obj .3mf)")
      ->group(group);
  command.add_option("--voxel", words.voxel_mm, "cells of the stock (default: by tool, block and memory)")
      ->type_name("MM")
      ->check(positive())
      ->group(group);
  command
      .add_option("--origin", words.origin,
                  "where the work's origin stands in the machine (default: the stock on the table)")
      ->type_name("X,Y,Z")
      ->group(group);
  command
      .add_option("--units", words.units,
                  "unit of a program that has neither G20 nor G21, of CL data without UNITS")
      ->check(CLI::IsMember({"mm", "inch"}))
      ->group(group);
  command
      .add_option("--dialect", words.dialect, program::dialect_list(" or ") + "; recognised when left out")
      ->check(CLI::IsMember(program::dialect_names()))
      ->group(group);
  command
      .add_option("--start-tool", words.start_tool, "number of the tool that is in the spindle at the start")
      ->check(positive())
      ->group(group);
  command.add_flag("--t-changes-tool", words.t_changes_tool, "T changes the tool at once, without M6")
      ->group(group);
  command
      .add_option("--slot-ends", words.slot_ends,
                  "840D: RAD, AFSL of slots end at edge or round end's centre")
      ->check(CLI::IsMember({"edge", "centre"}))
      ->group(group);
  command
      .add_option("--tracut", words.tracut,
                  "positions behind TRACUT of CL data: apply its matrix, or it has been applied")
      ->check(CLI::IsMember({"apply", "applied"}))
      ->group(group);
}

std::vector<std::string> given_words(const JobWords& words) {
  std::vector<std::string> given;
  const auto add = [&](const char* flag, const std::string& value) {
    if (!value.empty()) given.insert(given.end(), {flag, value});
  };
  add("--tool", words.tool);
  add("--tools", words.tools);
  add("--stock", words.stock);
  add("--machine", words.machine);
  add("--design", words.design);
  add("--voxel", words.voxel_mm > 0.0 ? fmt::format("{}", words.voxel_mm) : "");
  add("--origin", words.origin);
  add("--units", words.units);
  add("--dialect", words.dialect);
  add("--start-tool", words.start_tool > 0 ? fmt::format("{}", words.start_tool) : "");
  if (words.t_changes_tool) given.emplace_back("--t-changes-tool");
  add("--slot-ends", words.slot_ends);
  add("--tracut", words.tracut);
  return given;
}

namespace {

/// A flag that says what programs of the other kind leave open would be believed to have been followed.
void refuse_other_kind(const std::string& file, bool cl_data, const std::vector<std::string>& given) {
  const auto refuse = [&](const std::string& flag) {
    if (std::find(given.begin(), given.end(), flag) == given.end()) return;
    throw InputError(
        "flag-of-other-kind", {flag},
        cl_data ? fmt::format("{} says what an NC program leaves open, and {} is CL data", flag, file)
                : fmt::format("{} says what CL data leave open, and {} is an NC program", flag, file),
        "leave it out");
  };
  if (!cl_data) return refuse("--tracut");
  for (const char* flag : {"--dialect", "--start-tool", "--t-changes-tool", "--slot-ends"}) refuse(flag);
}

}  // namespace

bool is_program_file(const std::string& file) {
  return fs::path(file).extension() != ".toml";
}

sim::JobFlags job_flags(const std::string& program_file, const JobWords& words) {
  sim::JobFlags flags;
  flags.program_file = program_file;
  if (is_cl_file(program_file)) {
    flags.cl_data = true;
  } else if (!is_nc_program(program_file, {})) {
    throw InputError(
        "needs-scene", {program_file}, "surface blocks (G10 L70) need a scene: they are planned for it",
        "write scene.toml with program, machine, [cutter] and [stock]; scenes/lin_koren_dome has one");
  }
  refuse_other_kind(program_file, flags.cl_data, given_words(words));
  set_tools(words, flags);
  if (!words.stock.empty() && words.stock != "auto") sim::take_stock(words.stock, flags);
  if (words.voxel_mm > 0.0) flags.voxel_mm = words.voxel_mm;
  if (!words.origin.empty()) flags.origin_M = sim::parse_vector("--origin", words.origin);
  flags.machine = words.machine;
  flags.design = words.design;
  flags.units = words.units;
  flags.dialect = words.dialect;
  flags.start_tool = words.start_tool;
  flags.t_changes_tool = words.t_changes_tool;
  flags.slot_ends = words.slot_ends;
  flags.tracut = words.tracut;
  return flags;
}

program::Presets presets_of(const std::vector<std::string>& given) {
  program::Presets presets;
  for (const std::string& one : given) {
    const size_t equals = std::min(one.find('='), one.size() - 1);
    const char* const end = one.data() + one.size();
    program::Preset preset{0.0, {"--set-parameter " + one}};
    const auto [next, failure] = std::from_chars(one.data() + equals + 1, end, preset.value);
    const std::string name = program::preset_name(one.substr(0, equals));
    if (name.empty() || failure != std::errc() || next != end || !std::isfinite(preset.value))
      throw InputError("bad-option", preset.where, "this is no parameter with its number",
                       "write --set-parameter 500=3.5, R1=2 or Q5=1");
    if (!presets.emplace(name, preset).second)
      throw InputError("given-twice", preset.where, fmt::format("{} has a value already", name),
                       "give it once");
  }
  return presets;
}

void add_parameter_flag(CLI::App& command, std::vector<std::string>& overrides) {
  command
      .add_option_function<std::vector<std::string>>(
          "--set-parameter",
          [&overrides](const std::vector<std::string>& given) {
            for (const auto& [name, preset] : presets_of(given))
              overrides.push_back(fmt::format("parameters.{}={}", name, preset.value));
          },
          "a parameter's value before an NC program starts: 500=3.5 (#500), R1=2, Q5=1, NAME=3 (a GUD); "
          "[parameters] of a scene; once for each")
      ->type_name("NAME=NUMBER")
      ->expected(1)
      ->take_all();
}

namespace {

constexpr const char* kFlags = "flags";

/// The flag that says a line of the scene which the flags mean: "--stock 0,0,-10,40,30,0".
std::string flag_of(std::string_view line, bool of_design, const std::vector<std::string>& given) {
  const std::string_view key = line.substr(0, line.find(' '));
  const auto is = [&](std::initializer_list<const char*> keys) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  const auto value_of = [&](const char* flag) -> std::string {
    const auto found = std::find(given.begin(), given.end(), flag);
    return found == given.end() || found + 1 == given.end() ? "" : fmt::format("{} {}", flag, *(found + 1));
  };
  if (is({"tools"})) return value_of("--tool") + value_of("--tools");
  if (is({"tool_table"})) return value_of("--tools");
  if (is({"machine"})) return value_of("--machine");
  if (is({"start_tool"})) return value_of("--start-tool");
  if (is({"work_origin_mm"})) return value_of("--origin");
  if (is({"voxel_mm"})) return value_of("--voxel");
  if (is({"mesh", "step"}) && of_design) return value_of("--design");
  return is({"box_mm", "mesh", "cylinder", "tube"}) ? value_of("--stock") : "";
}

/// Places in that scene become the flags.
std::vector<Diagnostic> at_flags(std::vector<Diagnostic> told, const std::string& text,
                                 const JobWords& words) {
  const std::vector<std::string> given = given_words(words);
  for (Diagnostic& one : told) {
    if (one.where.file != kFlags || one.where.line == 0) continue;
    size_t begin = 0;
    for (int line = 1; line < one.where.line && begin != text.npos; ++line)
      begin = std::min(text.find('\n', begin), text.size() - 1) + 1;
    const bool of_design = text.substr(0, begin).find("[design]") != text.npos;
    const std::string flag = flag_of(std::string_view(text).substr(begin), of_design, given);
    one.where = {flag.empty() ? kFlags : flag};
  }
  return told;
}

sim::Job load_flags(const std::string& text, const JobWords& words,
                    const std::vector<std::string>& overrides) {
  try {
    sim::Job job = sim::load_job(sim::SceneText{text, kFlags}, overrides);
    job.warnings = at_flags(std::move(job.warnings), text, words);
    return job;
  } catch (const InputError& error) {
    Diagnostics told;
    for (Diagnostic& one : at_flags(error.diagnostics.list(), text, words)) {
      if (one.severity == Severity::kError)
        told.error(one.code, one.where, one.text, one.fix);
      else if (one.severity == Severity::kWarning)
        told.warning(one.code, one.where, one.text, one.fix);
      else
        told.note(one.code, one.where, one.text);
    }
    throw InputError(told);
  }
}

}  // namespace

size_t count_setups(const std::string& file, const std::vector<std::string>& overrides) {
  require_file(file);
  refuse_special_file(file);
  return is_program_file(file) ? 0 : sim::count_setups(file, overrides);
}

std::vector<std::shared_ptr<const sim::Job>> load_setups(const std::string& file, size_t last,
                                                         const std::vector<std::string>& overrides) {
  const size_t count = count_setups(file, overrides);
  if (last > count)
    throw InputError("no-such-set-up", {file},
                     count == 0 ? std::string("the scene has one set-up, not a list of them")
                                : fmt::format("the scene has {} set-ups", count),
                     count == 0 ? std::string("leave --setup out") : fmt::format("--setup 1 to {}", count));
  return sim::load_setups(file, std::vector<std::vector<std::string>>(last > 0 ? last : count, overrides));
}

sim::Job load_job(const std::string& file, const JobWords& words, const std::vector<std::string>& overrides) {
  require_file(file);
  refuse_special_file(file);
  if (is_program_file(file)) return load_flags(sim::scene_text(job_flags(file, words)), words, overrides);
  const std::vector<std::string> given = given_words(words);
  if (!given.empty())
    throw InputError("flags-and-scene", {file},
                     fmt::format("{} stands beside a scene, which says it itself", given[0]),
                     "write it into the scene, or replace a key: --set stock.voxel_mm=0.1");
  return sim::load_job(file, overrides);
}

}  // namespace swarf::cli
