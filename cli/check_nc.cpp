#include "cli/check_nc.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>

#include "base/file.h"
#include "base/units.h"
#include "cli/job_flags.h"
#include "cli/nc_motion.h"
#include "cli/nc_totals.h"
#include "cli/terminal.h"
#include "machine/machine_scene.h"
#include "machine/shipped.h"
#include "program/dialects.h"
#include "program/nc_program.h"
#include "sim/job/open_job.h"
#include "sim/job/tool_table.h"
#include "sim/job/tool_words.h"

namespace swarf::cli {
namespace {

using kinematics::AxisKind;
using kinematics::AxisValues;

/// Three axes that go anywhere, for programs without rotary words.
kinematics::MachineModel plain_machine() {
  kinematics::MachineModel machine;
  machine.name = "XYZ without limits (no --machine was given)";
  const std::array<Vec3, 3> directions{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  for (size_t i = 0; i < 3; ++i) {
    kinematics::Axis axis;
    axis.name = std::string(1, "XYZ"[i]);
    axis.side = kinematics::Side::kHead;
    axis.direction_M = directions[i];
    axis.min = -std::numeric_limits<double>::infinity();
    axis.max = std::numeric_limits<double>::infinity();
    machine.axes.push_back(axis);
    machine.head_chain.push_back(static_cast<int>(i));
  }
  machine.gauge_M = Vec3::Zero();
  return machine;
}

std::string extent(double low, double high, bool linear) {
  const auto shown = [&](double q) { return linear ? q : deg_from_rad(q); };
  return fmt::format("{:.3f} to {:.3f} {}", shown(low), shown(high), linear ? "mm" : "deg");
}

/// "2 h 05 min 07 s", "12.34 s".
std::string spoken(double seconds) {
  if (seconds < 60.0) return fmt::format("{:.2f} s", seconds);
  const auto whole = static_cast<long>(std::llround(seconds));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min {:02} s", whole / 3600, whole / 60 % 60, whole % 60);
}

/// "1 arc", "3 arcs".
std::string counted(long count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string time_text(const NcTotals& totals) {
  return fmt::format(
      "feed {} at the programmed feed, dwells {}, rapids {}", spoken(totals.feed_s), spoken(totals.dwell_s),
      totals.rapids_timed ? spoken(totals.rapid_s) + " at the axes' rapid speeds; accelerations not counted"
                          : "not timed (give --machine)");
}

std::string tools_text(const program::ControlSetup& setup, const program::NcSummary& summary) {
  if (setup.tools.empty()) return "not looked up, lengths are taken as 0 mm (give --tools)";
  std::string text;
  for (const int index : summary.tools_used) {
    const program::NcTool& tool = setup.tools[static_cast<size_t>(index)];
    text += text.empty() ? "" : ", ";
    text += tool.number > 0 ? fmt::format("T{}", tool.number) : "";
    if (!tool.name.empty()) text += fmt::format("{}\"{}\"", tool.number > 0 ? " " : "", tool.name);
    text += fmt::format(" (D {:g} mm, length {:g} mm)", tool.diameter_mm, tool.length_mm);
  }
  return text.empty() ? "none cuts" : text;
}

std::string places_text(const program::ControlSetup& setup, const NcTotals& totals) {
  std::string text;
  if (!totals.cut_W.isEmpty()) {
    for (int i = 0; i < 3; ++i) {
      text += fmt::format("\n  {:<9} {} {}", i == 0 ? "cuts" : "", "XYZ"[i],
                          extent(totals.cut_W.min()[i], totals.cut_W.max()[i], true));
    }
    text += ", the tip in the work";
  }
  for (size_t i = 0; i < setup.machine.axes.size(); ++i) {
    const kinematics::Axis& axis = setup.machine.axes[i];
    const auto index = static_cast<long>(i);
    text += fmt::format("\n  {:<9} {} {}", i == 0 ? "axes" : "", axis.name,
                        extent(totals.low[index], totals.high[index], axis.kind == AxisKind::kLinear));
  }
  return text;
}

std::optional<program::Dialect> chosen(const std::string& file, const std::string& name) {
  if (name.empty()) return std::nullopt;
  if (const auto dialect = program::dialect_of(name)) return dialect;
  throw InputError("unknown-dialect", {file, 0, 0}, fmt::format("'{}' is no dialect", name),
                   "choose " + program::dialect_list(" or "));
}

/// Reads "m430=identity" and its like.
program::KinematicsSwitch kinematics_of(const std::string& file, const std::vector<std::string>& words) {
  program::KinematicsSwitch kinematics;
  const std::array<std::pair<const char*, std::optional<program::Kinematics>*>, 4> keys{
      {{"start", &kinematics.start},
       {"m428", &kinematics.m428},
       {"m429", &kinematics.m429},
       {"m430", &kinematics.m430}}};
  for (const std::string& word : words) {
    bool known = false;
    for (const auto& [key, value] : keys) {
      for (const auto choice : {program::Kinematics::kIdentity, program::Kinematics::kTcp}) {
        if (word != fmt::format("{}={}", key, program::kinematics_name(choice))) continue;
        *value = choice;
        known = true;
      }
    }
    if (!known)
      throw InputError("bad-option", {file, 0, 0}, fmt::format("--kinematics {} is not understood", word),
                       "write start, m428, m429 or m430, then =identity or =tcp: --kinematics m430=identity");
  }
  return kinematics;
}

/// Reads "M68" and "M68=clamp C".
program::BuilderWords builder_words_of(const std::string& file, const std::vector<std::string>& given) {
  program::BuilderWords words;
  for (const std::string& one : given) {
    const size_t equals = std::min(one.find('='), one.size());
    const std::string word = program::builder_word(one.substr(0, equals));
    if (word.empty())
      throw InputError("bad-option", {file, 0, 0}, fmt::format("--builder-word {} is not understood", one),
                       "write M68, \"CYCL DEF 392\" or the name of a program, and =what it does if you like");
    words[word] = equals < one.size() ? one.substr(equals + 1) : "of the machine's builder";
  }
  return words;
}

/// G10 L70 opens a surface: that is a program of surface blocks.
bool has_surface_blocks(const std::string& file) {
  refuse_special_file(file);
  std::ifstream stream(file, std::ios::binary);
  std::string head(size_t{1} << 16, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<size_t>(stream.gcount()));
  std::erase_if(head, [](unsigned char c) { return std::isspace(c) != 0; });
  return head.find("G10L7") != std::string::npos || head.find("G06.3") != std::string::npos;
}

std::vector<program::NcTool> tools_of(const std::string& table, sim::IncompleteTools& incomplete,
                                      Diagnostics& told) {
  Diagnostics diagnostics;
  std::vector<program::NcTool> tools;
  const bool words = table.find('=') != std::string::npos && !std::filesystem::exists(table);
  const std::vector<cutter::Cutter> cutters =
      words ? sim::read_tool_words(table, {"--tools " + table}, diagnostics)
            : sim::read_tool_table(table, diagnostics, &incomplete);
  for (const cutter::Cutter& one : cutters)
    tools.push_back({one.number, one.name, cutter::gauge_length(one), one.diameter_mm, one.corner_radius_mm});
  diagnostics.throw_if_errors();
  told.append(diagnostics);
  return tools;
}

/// What is in the spindle before the first block: --start-tool, or the only tool of the table where the
/// program cuts without calling any.
void set_start_tool(const std::string& file, const NcCheckOptions& options, program::ControlSetup& setup) {
  if (options.start_tool == 0) {
    setup.start_tool_if_needed = setup.tools.size() == 1 && setup.incomplete_tools.empty();
    setup.start_tool = setup.start_tool_if_needed ? 0 : -1;
    return;
  }
  const auto found = std::find_if(setup.tools.begin(), setup.tools.end(), [&](const program::NcTool& tool) {
    return tool.number == options.start_tool;
  });
  if (found == setup.tools.end())
    throw InputError("unknown-tool", {file, 0, 0},
                     fmt::format("--start-tool {} is not in the tool table", options.start_tool),
                     "name its number, and the table with --tools");
  setup.start_tool = static_cast<int>(found - setup.tools.begin());
}

/// Machine, tools and what else stands in the control before the first block.
program::ControlSetup setup_of(const std::string& file, const NcCheckOptions& options,
                               Diagnostics& diagnostics) {
  program::ControlSetup setup;
  if (options.machine.empty()) {
    setup.machine = plain_machine();
  } else {
    const std::string named = machine::machine_file(options.machine);
    if (named.empty())
      throw InputError("unknown-machine", {"--machine " + options.machine}, "no machine is called so",
                       "name a machine.toml, or one that 'swarf machines' lists");
    const machine::MachineScene scene = machine::load_machine(named);
    setup.machine = scene.model;
    setup.unit_mm = scene.program_unit_mm;
  }
  if (!options.units.empty()) setup.unit_mm = options.units == "inch" ? 25.4 : 1.0;
  if (options.at_home) {
    AxisValues home = AxisValues::Zero();
    for (size_t i = 0; i < setup.machine.axes.size(); ++i)
      home[static_cast<long>(i)] = setup.machine.axes[i].home;
    setup.start = home;
  }
  setup.kinematics_switch = kinematics_of(file, options.kinematics);
  setup.builder_words = builder_words_of(file, options.builder_words);
  setup.presets = presets_of(options.parameters);
  if (!options.tools.empty()) setup.tools = tools_of(options.tools, setup.incomplete_tools, diagnostics);
  if (setup.unit_mm.value_or(1.0) != 1.0 && options.tools.ends_with(".tbl"))
    diagnostics.warning(
        "table-in-mm", {options.tools, 0, 0},
        "the lengths and diameters of this table are read in mm, and programs are in inches here",
        "give the tools as .toml with [[tool]] where the table counts in inches");
  set_start_tool(file, options, setup);
  setup.t_changes_tool = options.t_changes_tool;
  if (!options.slot_ends.empty())
    setup.slot_ends = options.slot_ends == "edge" ? program::SlotEnds::kEdge : program::SlotEnds::kCentre;
  return setup;
}

/// Where the program turns what the plain machine has not: which of the shipped ones do.
void name_machines(const std::string& file, Diagnostics& diagnostics) {
  const std::vector<Diagnostic>& told = diagnostics.list();
  if (std::none_of(told.begin(), told.end(),
                   [](const Diagnostic& one) { return one.code == "axis-missing"; }))
    return;
  diagnostics.note("machine-needed", {file, 0, 0},
                   "--machine NAME; those that turn and come with swarf: " + sim::five_axis_machines());
}

nlohmann::ordered_json tools_json(const program::ControlSetup& setup, const program::NcSummary& summary) {
  nlohmann::ordered_json tools = nlohmann::ordered_json::array();
  for (const int index : summary.tools_used) {
    const program::NcTool& tool = setup.tools[static_cast<size_t>(index)];
    tools.push_back({{"number", tool.number},
                     {"name", tool.name},
                     {"diameter_mm", tool.diameter_mm},
                     {"length_mm", tool.length_mm}});
  }
  return tools;
}

nlohmann::ordered_json axes_json(const program::ControlSetup& setup, const NcTotals& totals) {
  nlohmann::ordered_json axes = nlohmann::ordered_json::array();
  for (size_t i = 0; i < setup.machine.axes.size(); ++i) {
    const kinematics::Axis& axis = setup.machine.axes[i];
    const double low = totals.low[static_cast<long>(i)], high = totals.high[static_cast<long>(i)];
    if (axis.kind == AxisKind::kLinear)
      axes.push_back({{"name", axis.name}, {"min_mm", low}, {"max_mm", high}});
    else
      axes.push_back({{"name", axis.name}, {"min_deg", deg_from_rad(low)}, {"max_deg", deg_from_rad(high)}});
  }
  return axes;
}

/// What the text says, as numbers; null where there is none.
nlohmann::ordered_json numbers_of(const program::ControlSetup& setup, const program::NcSummary& summary,
                                  const NcTotals& totals) {
  using Json = nlohmann::ordered_json;
  const auto box = [&] {
    Json sides = Json::object();
    for (int i = 0; i < 3; ++i)
      sides[std::string(1, "xyz"[i])] = {totals.cut_W.min()[i], totals.cut_W.max()[i]};
    return sides;
  };
  const bool moves = totals.feeds + totals.rapids > 0;
  return {{"dialect", program::dialect_name(summary.dialect)},
          {"dialect_reason", summary.dialect_reason},
          {"files", summary.files},
          {"lines", summary.lines},
          {"blocks", summary.blocks},
          {"feed_moves", totals.feeds},
          {"arcs", totals.arcs},
          {"rapids", totals.rapids},
          {"feed_mm", totals.feed_mm},
          {"rapid_mm", totals.rapid_mm},
          {"feed_s", totals.feed_s},
          {"dwell_s", totals.dwell_s},
          {"rapid_s", totals.rapids_timed ? Json(totals.rapid_s) : Json()},
          {"tools", tools_json(setup, summary)},
          {"machine", setup.machine.name},
          {"start", summary.start},
          {"start_tool", summary.start_tool.empty() ? Json() : Json(summary.start_tool)},
          {"cut_mm", totals.cut_W.isEmpty() ? Json() : box()},
          {"axes", moves ? axes_json(setup, totals) : Json()},
          {"out_of_travel", totals.out_of_travel.empty() ? Json() : Json(totals.out_of_travel)},
          {"no_effect", summary.functions}};
}

std::string extension_of(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace

bool is_nc_program(const std::string& file, const NcCheckOptions& options) {
  const std::string extension = extension_of(file);
  if (program::is_dialect_ending(extension)) return true;
  if (extension == ".toml" || extension.starts_with(".cl") || extension == ".apt") return false;
  return !options.machine.empty() || !options.dialect.empty() || !options.tools.empty() ||
         !has_surface_blocks(file);
}

Checked check_nc(const std::string& file, const NcCheckOptions& options) {
  Diagnostics diagnostics;
  const program::ControlSetup setup = setup_of(file, options, diagnostics);
  NcTotals totals(setup.machine);
  NcMotionSink motion(setup, totals);
  const bool drives = options.drive && !options.machine.empty();
  program::NcSink& sink = drives ? static_cast<program::NcSink&>(motion) : totals;
  const program::NcSummary summary =
      program::run_nc(file, chosen(file, options.dialect), setup, sink, diagnostics);
  if (options.machine.empty()) name_machines(file, diagnostics);
  diagnostics.throw_if_errors();
  totals.hours.refuse_too_long(summary.files);
  const std::optional<motion::MotionStatistics> driven = drives ? motion.drive(summary) : std::nullopt;
  std::string text = fmt::format(
      "NC program {}\n"
      "  dialect   {} ({})\n"
      "  read      {}, {} with words, {}\n"
      "  moves     {} ({}), {}\n"
      "  path      feed {:.3f} mm, rapid {:.3f} mm, of the tip\n"
      "  time      {}\n"
      "  tools     {}\n"
      "  machine   {}\n"
      "  start     {}",
      totals.out_of_travel.empty() ? "is right" : "reads well, the machine cannot do it",
      program::dialect_name(summary.dialect), summary.dialect_reason, counted(summary.lines, "line"),
      counted(summary.blocks, "block"), counted(static_cast<long>(summary.files.size()), "file"),
      counted(totals.feeds, "feed move"), counted(totals.arcs, "arc"), counted(totals.rapids, "rapid"),
      totals.feed_mm, totals.rapid_mm, time_text(totals), tools_text(setup, summary), setup.machine.name,
      summary.start.empty() ? "no motion" : summary.start);
  if (!summary.start_tool.empty()) text += "\n            " + summary.start_tool;
  if (totals.feeds + totals.rapids > 0) text += places_text(setup, totals);
  if (driven) text += motion_text(*driven, setup.machine);
  if (drives && motion.too_many())
    text += fmt::format("\n  driven    not: the program has more than {} moves; its run drives them",
                        NcMotionSink::kMovesMost);
  if (!totals.out_of_travel.empty()) text += "\n  finding   " + totals.out_of_travel;
  if (!summary.functions.empty()) {
    text += "\n  no effect on the geometry:";
    for (const std::string& word : summary.functions) text += " " + word + ";";
  }
  Checked checked{"nc", text, numbers_of(setup, summary, totals), diagnostics.list()};
  checked.numbers["driven"] = driven ? motion_json(*driven, setup.machine) : nlohmann::ordered_json();
  if (!totals.out_of_travel.empty())
    checked.findings.push_back(
        {"travel",
         Severity::kError,
         {file, totals.out_of_travel_line, 0},
         totals.out_of_travel,
         "a program alone stands with its work offsets at the machine's zero: a scene says where "
         "the work is; or clamp it elsewhere, or move less far"});
  return checked;
}

}  // namespace swarf::cli
