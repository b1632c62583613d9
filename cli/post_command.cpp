#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/file.h"
#include "base/units.h"
#include "cli/commands.h"
#include "cli/number_flags.h"
#include "cli/posted_scene.h"
#include "cli/preferred.h"
#include "cli/shell_text.h"
#include "cli/terminal.h"
#include "machine/machine_scene.h"
#include "machine/shipped.h"
#include "post/post.h"
#include "post/preference.h"
#include "post/shipped.h"
#include "reports/avoidance_output.h"
#include "sim/job/scene_text.h"
#include "sim/job/tool_table.h"

namespace swarf::cli {
namespace {

using kinematics::AxisKind;

constexpr FileFault kProgramFault{"program-unwritable", "the program cannot be written"};

namespace fs = std::filesystem;

struct PostCommand {
  std::vector<std::string> overrides;
  bool avoid = false;
  std::string file, machine, post, dialect, tools, output, fixed_cl, cutcom, circle, tracut, planes, prefer,
      unit, cl_units;
  std::vector<double> work_origin;
  double work_rotation_deg = 0.0, tolerance_um = 10.0, axis_tolerance_deg = 0.1;
  bool tcp = false, no_tcp = false, json = false;
};

bool is_scene(const PostCommand& given) {
  return fs::path(given.file).extension() == ".toml";
}

post::PostFormat format_of(const PostCommand& given) {
  if (!given.post.empty() && !given.dialect.empty())
    throw InputError("two-posts", {"--post " + given.post}, "--post and --dialect both name the words",
                     "give one of them");
  const std::string name =
      given.post.empty() ? (given.dialect.empty() ? "fanuc" : given.dialect) : given.post;
  const std::string file = post::post_file(name);
  if (file.empty())
    throw InputError("unknown-post", {"--dialect " + name}, "no post is called so",
                     "choose " + post::shipped_list() + ", or give your own with --post my.toml");
  post::PostFormat format = post::load_post(file);
  return given.unit.empty() ? format : post::in_unit(std::move(format), given.unit == "inch");
}

machine::MachineScene machine_of(const PostCommand& given) {
  if (given.machine.empty())
    throw InputError("option-missing", {"--machine"}, "nothing says which machine the program is for",
                     "name one that 'swarf machines' lists, or a machine.toml");
  const std::string file = machine::machine_file(given.machine);
  if (file.empty())
    throw InputError("unknown-machine", {"--machine " + given.machine}, "no machine is called so",
                     "name a machine.toml, or one that 'swarf machines' lists");
  machine::MachineScene scene = machine::load_machine(file);
  Pose& X_MW = scene.model.X_MW;
  if (!given.work_origin.empty())
    X_MW.translation() = Vec3(given.work_origin[0], given.work_origin[1], given.work_origin[2]);
  if (given.work_rotation_deg != 0.0)
    X_MW.linear() =
        Eigen::AngleAxisd(rad_from_deg(given.work_rotation_deg), Vec3::UnitZ()).toRotationMatrix();
  return scene;
}

post::PostOptions options_of(const PostCommand& given, Diagnostics& told) {
  post::PostOptions options;
  if (given.tcp && given.no_tcp)
    throw InputError("tcp-twice", {"swarf post"}, "--tcp and --no-tcp contradict each other",
                     "give one of them");
  if (given.tcp || given.no_tcp) options.tcp = given.tcp;
  if (!given.planes.empty()) options.planes = post::plane_use(given.planes);
  options.tip_mm = given.tolerance_um * kMicrometre;
  options.axis_rad = rad_from_deg(given.axis_tolerance_deg);
  if (!given.cutcom.empty())
    options.cl.cutcom = given.cutcom == "centre" ? program::ClPoints::kCentre : program::ClPoints::kContour;
  if (!given.circle.empty()) options.cl.circle_clockwise = given.circle == "clockwise";
  if (!given.tracut.empty())
    options.cl.tracut = given.tracut == "apply" ? program::ClTracut::kApply : program::ClTracut::kApplied;
  if (!given.cl_units.empty()) options.cl.unit_mm = given.cl_units == "inch" ? 25.4 : 1.0;
  if (given.tools.empty()) return options;
  Diagnostics diagnostics;
  sim::IncompleteTools incomplete;
  for (const cutter::Cutter& one : sim::read_tool_table(given.tools, diagnostics, &incomplete)) {
    options.tools.push_back({one.number, one.name, cutter::gauge_length(one)});
    options.cl.tools.push_back({one.number, one.name, 0.5 * one.diameter_mm});
  }
  diagnostics.throw_if_errors();
  told.append(diagnostics);
  return options;
}

/// "2 min 05 s".
std::string spoken_time(double seconds) {
  const long whole = std::lround(seconds);
  return whole < 60 ? fmt::format("{:.1f} s", seconds)
                    : fmt::format("{} min {:02} s", whole / 60, whole % 60);
}

std::vector<std::pair<std::string, std::string>> table_of(const post::PostFormat& format,
                                                          const kinematics::MachineModel& machine,
                                                          const post::PostResult& result) {
  const post::PlanSummary& plan = result.plan;
  std::vector<std::pair<std::string, std::string>> rows{
      {"written",
       fmt::format("{} for {}, {}", format.name, machine.name, result.tcp ? "with TCP" : "without TCP")},
      {"blocks", fmt::format("{} lines for {} positions of the CL data", result.written.blocks, plan.points)},
      {"moves", fmt::format("{}, of them {} arcs, {} cycles, {} approaches, {} turns at rest{}", plan.steps,
                            plan.arcs, plan.holes, plan.approaches, plan.pole_turns,
                            plan.tilts > 0 ? fmt::format("; {} in tilted planes", plan.tilts) : "")},
      {"time", fmt::format("{}: feed {}, rapid {}, dwell {}; accelerations and tool changes not counted",
                           spoken_time(plan.feed_s + plan.rapid_s + plan.dwell_s), spoken_time(plan.feed_s),
                           spoken_time(plan.rapid_s), spoken_time(plan.dwell_s))}};
  for (size_t i = 0; i < machine.axes.size() && plan.points > 0; ++i) {
    const kinematics::Axis& axis = machine.axes[i];
    const bool rotary = axis.kind == AxisKind::kRotary;
    const auto row = static_cast<long>(i);
    const auto shown = [&](double value) { return rotary ? deg_from_rad(value) : value; };
    rows.emplace_back(fmt::format("axis {}", axis.name),
                      fmt::format("{:.3f} to {:.3f} {}, {:.3f} in all", shown(plan.low[row]),
                                  shown(plan.high[row]), rotary ? "deg" : "mm", shown(plan.travel[row])));
  }
  rows.emplace_back(
      "tip", fmt::format("at most {:.3f} um from the CL data ({:.3f} um of it the written digits), "
                         "proven{}; line {}",
                         um_from_mm(plan.deviation_mm), um_from_mm(plan.digits_mm),
                         result.tcp ? "; the control keeps it on its line"
                                    : fmt::format("; tolerance {:g} um", um_from_mm(result.rules.tip_mm)),
                         plan.deviation_line));
  if (plan.slowed > 0)
    rows.emplace_back("slowed", fmt::format("{} blocks, by the speed of an axis", plan.slowed));
  std::string words;
  for (const std::string& one : result.written.not_written) words += (words.empty() ? "" : " ") + one;
  if (!words.empty()) rows.emplace_back("not written", words);
  if (result.written.comments_changed > 0)
    rows.emplace_back("comments",
                      fmt::format("{} lost characters that the control does not take, or their end",
                                  result.written.comments_changed));
  return rows;
}

nlohmann::ordered_json json_of(const PostCommand& given, const post::PostFormat& format,
                               const kinematics::MachineModel& machine, const post::PostResult& result) {
  const post::PlanSummary& plan = result.plan;
  nlohmann::ordered_json json{{"schema", 1},
                              {"swarf", SWARF_VERSION},
                              {"file", given.file},
                              {"program", given.output},
                              {"post", format.name},
                              {"dialect", program::dialect_name(format.dialect)},
                              {"machine", machine.name},
                              {"tcp", result.tcp},
                              {"lines", result.written.blocks},
                              {"points", plan.points},
                              {"moves", plan.steps},
                              {"arcs", plan.arcs},
                              {"cycles", plan.holes},
                              {"tilted_planes", plan.tilts},
                              {"approaches", plan.approaches},
                              {"turns_at_rest", plan.pole_turns},
                              {"slowed", plan.slowed},
                              {"feed_s", plan.feed_s},
                              {"rapid_s", plan.rapid_s},
                              {"dwell_s", plan.dwell_s},
                              {"tip_deviation_um", um_from_mm(plan.deviation_mm)},
                              {"tip_digits_um", um_from_mm(plan.digits_mm)},
                              {"tolerance_um", um_from_mm(result.rules.tip_mm)},
                              {"not_written", result.written.not_written},
                              {"axes", nlohmann::ordered_json::array()}};
  for (size_t i = 0; i < machine.axes.size() && plan.points > 0; ++i) {
    const bool rotary = machine.axes[i].kind == AxisKind::kRotary;
    const auto row = static_cast<long>(i);
    const auto shown = [&](double value) { return rotary ? deg_from_rad(value) : value; };
    const std::string unit = rotary ? "deg" : "mm";
    json["axes"].push_back({{"name", machine.axes[i].name},
                            {"min_" + unit, shown(plan.low[row])},
                            {"max_" + unit, shown(plan.high[row])},
                            {"travel_" + unit, shown(plan.travel[row])}});
  }
  return json;
}

/// The scene that the flags mean, for --avoid beside CL data.
sim::SceneText scene_of(const PostCommand& given) {
  sim::JobFlags flags;
  flags.program_file = fs::absolute(given.file).string();
  flags.cl_data = true;
  const bool is_file = fs::path(given.machine).extension() == ".toml";
  flags.machine = is_file ? fs::absolute(given.machine).string() : given.machine;
  if (!given.tools.empty()) flags.tool_table = fs::absolute(given.tools).string();
  if (!given.work_origin.empty())
    flags.origin_M = Vec3(given.work_origin[0], given.work_origin[1], given.work_origin[2]);
  return {sim::scene_text(flags), given.file};
}

/// Keys of [post] that the flags replace.
std::vector<std::string> scene_overrides(const PostCommand& given) {
  std::vector<std::string> keys = given.overrides;
  const std::string words = given.post.empty() ? given.dialect : fs::absolute(given.post).string();
  if (!words.empty()) keys.push_back(fmt::format("post.words=\"{}\"", words));
  if (given.tcp || given.no_tcp) keys.push_back(fmt::format("post.tcp={}", given.tcp));
  if (!given.unit.empty()) keys.push_back(fmt::format("post.unit=\"{}\"", given.unit));
  if (!given.planes.empty()) keys.push_back(fmt::format("post.planes=\"{}\"", given.planes));
  if (!given.prefer.empty()) keys.push_back(fmt::format("post.prefer=\"{}\"", given.prefer));
  const PostCommand unsaid;
  if (!is_scene(given) || given.tolerance_um != unsaid.tolerance_um)
    keys.push_back(fmt::format("post.tolerance_um={}", given.tolerance_um));
  if (!is_scene(given) || given.axis_tolerance_deg != unsaid.axis_tolerance_deg)
    keys.push_back(fmt::format("post.axis_tolerance_deg={}", given.axis_tolerance_deg));
  if (given.work_rotation_deg != 0.0)
    keys.push_back(fmt::format("setup.work_rotation_deg={}", given.work_rotation_deg));
  if (!given.cutcom.empty()) keys.push_back(fmt::format("cutcom=\"{}\"", given.cutcom));
  if (!given.circle.empty()) keys.push_back(fmt::format("cl_circle=\"{}\"", given.circle));
  if (!given.cl_units.empty()) keys.push_back(fmt::format("setup.units=\"{}\"", given.cl_units));
  if (!given.tracut.empty()) keys.push_back(fmt::format("setup.tracut=\"{}\"", given.tracut));
  return keys;
}

/// What was written; `advice`: null without --fix.
int tell_posted(const PostCommand& given, const sim::Job& job, const PostedScene& posted,
                const avoidance::Advice* advice) {
  if (given.json) {
    nlohmann::ordered_json json{{"schema", 1},
                                {"swarf", SWARF_VERSION},
                                {"file", given.file},
                                {"program", given.output},
                                {"post", posted.post_name}};
    json["avoidance"] = reports::avoidance_json(posted.outcome, job);
    if (advice != nullptr) json["advice"] = reports::advice_json(*advice, given.fixed_cl);
    json["overrides"] = posted.overrides;
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return kPass;
  }
  if (manner().quiet) return kPass;
  fmt::print("{}\n", given.output);
  if (advice != nullptr) print_table(reports::advice_lines(*advice, given.fixed_cl));
  print_table(reports::avoidance_lines(posted.outcome, job));
  if (!is_scene(given)) return kPass;
  std::vector<std::string> words{"swarf", "run", given.file};
  for (const std::string& key : posted.overrides) words.insert(words.end(), {"--set", key});
  fmt::print("  proof: {}\n", shell_text(words));
  return kPass;
}

/// The same with changes of the path, where nothing else helps, and the CL data with them.
int post_with_advice(const PostCommand& given, const avoidance::Task& task, Progress& progress) {
  Diagnostics told;
  const std::optional<FixedScene> found = post_fixed_scene(
      task, {fs::absolute(given.fixed_cl).string(), fs::absolute(given.output).string()}, progress, told);
  print_diagnostics(told.list());
  if (!found) return kStopped;
  return tell_posted(given, found->job, found->posted, &found->advice);
}

/// The set-up, and what would be found on it.
int post_with_avoidance(const PostCommand& given) {
  if (given.output == "-")
    throw InputError("two-outputs", {"-o -"}, "a program that avoids collisions goes into a file",
                     "name it: -o part.nc");
  if (is_scene(given) && !(given.machine.empty() && given.tools.empty() && given.work_origin.empty()))
    throw InputError("flags-and-scene", {given.file}, "the scene says machine, tools and work origin itself",
                     "change its keys: --set setup.work_origin_mm=[0, 0, 100]");
  const std::vector<std::string> keys = scene_overrides(given);
  const auto load = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = keys;
    all.insert(all.end(), more.begin(), more.end());
    return is_scene(given) ? sim::load_job(given.file, all) : sim::load_job(scene_of(given), all);
  };
  const sim::Job job = load({});
  print_diagnostics(job.warnings);
  if (!job.cl || !job.scene.post)
    throw InputError("post-needs-cl", {given.file}, "the scene holds no CL data that could be written",
                     "a scene with cl = \"part.cls\" and no post.written");
  TerminalProgress progress;
  Diagnostics told;
  const std::string output = fs::absolute(given.output).string();
  if (!given.fixed_cl.empty()) return post_with_advice(given, {&job, load}, progress);
  const std::optional<PostedScene> found = post_scene({&job, load}, output, progress, told);
  print_diagnostics(told.list());
  if (!found) return kStopped;
  return tell_posted(given, job, *found, nullptr);
}
int run_post(const PostCommand& given) {
  if (is_scene(given) || given.avoid) return post_with_avoidance(given);
  if (!given.fixed_cl.empty())
    throw InputError("needs-scene", {"--fix"}, "--fix changes what collides, and nothing is looked at here",
                     "give a scene.toml, or --avoid");
  if (!given.overrides.empty())
    throw InputError("needs-scene", {"--set"}, "--set changes a key of a scene, and this is CL data",
                     "give a scene.toml, or --avoid");
  Diagnostics told;
  const post::PostFormat format = format_of(given);
  const machine::MachineScene scene = machine_of(given);
  post::PostOptions options = options_of(given, told);
  const bool to_stdout = given.output == "-";
  if (to_stdout && given.json)
    throw InputError("two-outputs", {"swarf post"}, "--json and -o - both want the standard output",
                     "name a file: -o part.nc");
  std::optional<NewFile> file;
  if (!to_stdout) file.emplace(given.output, kProgramFault);
  constexpr size_t kPiece = size_t{1} << 16U;
  std::string pending;
  const auto flush = [&] {
    if (to_stdout)
      std::fwrite(pending.data(), 1, pending.size(), stdout);
    else
      file->write(pending);
    pending.clear();
  };
  TerminalProgress progress;
  std::optional<Preferred> preferred;
  if (const auto wished = given.prefer.empty() ? format.prefer : post::preference(given.prefer))
    preferred.emplace(*wished, scene.model, options);
  const post::PostResult result = post::post(
      given.file, scene.model, format, options,
      [&](std::string_view text) {
        pending += text;
        if (pending.size() >= kPiece) flush();
      },
      progress, told);
  if (interrupted()) return kStopped;
  flush();
  if (file) file->move_into_place();
  if (preferred) preferred->compare(given.file, format, result);
  if (given.json) {
    nlohmann::ordered_json json = json_of(given, format, scene.model, result);
    if (preferred) json["choice"] = preferred->json();
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return kPass;
  }
  print_diagnostics(told.list());
  if (to_stdout || manner().quiet) return kPass;
  fmt::print("{}\n", given.output);
  print_table(table_of(format, scene.model, result));
  if (preferred) print_table(preferred->lines());
  return kPass;
}

const char* const kPostFooter =
    R"(What comes out: the CL data as the axes of this machine, in the words of its control. The tip stays within
--tolerance-um of the CL data's lines and arcs; the bound counts the digits that are written, and is proven.

With TCP (G43.4, TRAORI, M128) the program holds tips and rotary axes, and the control keeps the tip on its line;
blocks are added where the tool axis would stray by more than --axis-tolerance-deg. Without TCP it holds axis values:
blocks are added until the tip stays within the tolerance, and feeds of blocks that turn are inverse times (G93;
Heidenhain: an F of their own), so that the tip has its feed, or the slowest axis its speed limit.
LinuxCNC has TCP only where its INI file switches kinematics by M428 and M429: --tcp writes them.

Where the tool is out of the way (the start, a tool change, a RAPID behind a RAPID) another solution of the rotary
axes, or another turn, is taken if the moves that follow need it; the tool is then retracted along the machine's Z.
Elsewhere an axis that reaches the end of its travel is an error with its line. --prefer time, accuracy or travel looks
at all ways through the whole program (dynamic programming; a solution is held through each connected cut) and takes the
one with the least time, proven deviation of the tip, or slide movements; it tells why, stretch by stretch. The whole
plan is then held in memory, about a kilobyte for each block.

A scene brings the whole set-up: stock, fixtures, clamping, tools. Every way through it is then looked at for
collisions, the machine against the work as it has been cut so far: the other solution of the rotary axes is taken,
or the turn at a pole; where no way is free the clamping moves over the grid of [post.clamping], to the free place with
the least slide movements, and then tools are pulled out as far as [post.tool_reach] lets them. What cannot be
avoided is told with its line, and no program is written. swarf run of the scene does the same, and proves it.
With --fix OUT.cl the path is changed then, and where it gouges the design: block by block the smallest lead or tilt
(to .002 deg) that frees everything up to there, else the smallest lift, each proven over the whole motion; OUT.cl is
the file with these positions, for the CAM system, and -o its program.

Drilling cycles (CYCLE/DRILL ..) stay cycles: G81, CYCLE81, CYCL DEF 200. Where the tool stands across the control's
own Z they are written in a tilted working plane (G68.2, CYCLE800, PLANE SPATIAL); LinuxCNC has none, there they become
moves. --planes constant writes everything so that is cut with one direction of the tool (3+2 axes).

X Y Z count from the work's origin: G54 has to hold it, with rotary axes at zero.

Examples:
  swarf post part.cls --machine spinner_u5_620 --dialect siemens --tools tools.toml -o part.mpf
  swarf post part.cls --machine maho_600c --dialect heidenhain --no-tcp --tolerance-um 5 -o part.h
  swarf post part.cls --machine mill_3axis --post my_shop.toml -o part.nc        your own words
  swarf post scene.toml --dialect siemens -o part.mpf                            a whole set-up, free of collisions
  swarf post scene.toml --fix freed.cl -o part.nc                                the path changed where only that helps
  swarf post part.cls --machine mill_3axis --unit inch -o part.nc                G20, or INCH, G700
  swarf post part.cls --machine mikron_ucp710 -o - | less

To check what was written: swarf check part.mpf --machine spinner_u5_620 --tools tools.toml --dialect siemens
Exit codes: 0 written; 2 the CL data cannot be driven so, or cannot be read: no file is written or changed.)";

/// What CL data leaves open.
void add_cl_meanings(CLI::App& command, PostCommand& options) {
  command
      .add_option("--cutcom", options.cutcom,
                  "points of CL data under CUTCOM: of the cutter's centre, or of the part's contour")
      ->check(CLI::IsMember({"centre", "contour"}));
  command
      .add_option("--circle", options.circle,
                  "how CIRCLE of CL data runs about its vector; as its writer does when left out")
      ->check(CLI::IsMember({"clockwise", "counter_clockwise"}));
  command
      .add_option("--tracut", options.tracut,
                  "positions behind TRACUT of CL data: apply its matrix, or it has been applied")
      ->check(CLI::IsMember({"apply", "applied"}));
}

}  // namespace

void add_post(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<PostCommand>();
  CLI::App* command =
      app.add_subcommand("post", "Write CL data as an NC program for a machine and its control");
  command
      ->add_option("file", options->file,
                   "CL data (.cls, .clt, .ncl, .apt, .cldata), or a scene.toml with cl")
      ->required();
  command->add_option("--machine", options->machine, "a machine that 'swarf machines' lists, or machine.toml")
      ->type_name("NAME|FILE");
  command
      ->add_option("--fix", options->fixed_cl,
                   "where nothing else helps: the smallest lead, tilt or lift of each block that frees it; "
                   "CL data with them go here")
      ->type_name("OUT.cl");
  command->add_flag("--avoid", options->avoid,
                    "look at every way for collisions and take another one; as a scene always does");
  command
      ->add_option("--set", options->overrides,
                   "replace a key of the scene: --set \"post.clamping.count=[9, 9, 3]\"")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
  command->add_option("--dialect", options->dialect,
                      "the control's words: " + post::shipped_list() + " (fanuc when left out)");
  command->add_option("--post", options->post, "words of your own: a file as those in assets/posts")
      ->type_name("FILE");
  command->add_flag("--tcp", options->tcp,
                    "the control keeps the tip on its line; as the dialect has it when left out");
  command->add_flag("--no-tcp", options->no_tcp, "axis values: any control of these axes can drive them");
  command
      ->add_option("--prefer", options->prefer,
                   "choose the rotary solutions of the whole program by this, over all ways through it; "
                   "when left out, as the post says, or the first way that can be driven")
      ->check(CLI::IsMember({"time", "accuracy", "travel"}));
  command
      ->add_option("--planes", options->planes,
                   "tilted working planes (G68.2 ..): where a cycle needs one, wherever the tool keeps its "
                   "direction from rapid to rapid, or never; as the post has it when left out")
      ->check(CLI::IsMember({"never", "cycles", "constant"}));
  command->add_option("--cl-units", options->cl_units, "unit of CL data without UNITS; mm when left out")
      ->check(CLI::IsMember({"mm", "inch"}));
  command
      ->add_option("--unit", options->unit,
                   "unit of the program's lengths and feeds, with a digit more in inches; as the post has it "
                   "when left out (the shipped ones: mm)")
      ->check(CLI::IsMember({"mm", "inch"}));
  command
      ->add_option(
          "--tolerance-um", options->tolerance_um,
          "how far the tip may leave the CL data without TCP, written digits included; and the chords of "
          "arcs that the control cannot go")
      ->check(positive())
      ->capture_default_str();
  command
      ->add_option("--axis-tolerance-deg", options->axis_tolerance_deg,
                   "how far the tool axis may leave the great circle between two positions")
      ->check(positive())
      ->capture_default_str();
  command->add_option(
      "--tools", options->tools,
      "tool table with the lengths: .toml with [[tool]], LinuxCNC's .tbl, Fusion's .json, FreeCAD's .fctl");
  command
      ->add_option(
          "--work-origin", options->work_origin,
          "where the work's zero stands in the machine, mm; as the machine's file has it when left out")
      ->expected(3)
      ->type_name("X Y Z");
  command->add_option("--work-rotation-deg", options->work_rotation_deg, "the work turned about Z")
      ->capture_default_str();
  add_cl_meanings(*command, *options);
  command
      ->add_option(
          "-o,--output", options->output,
          "the program; -: the standard output, where a long program may end early: exit code 2 says so")
      ->required();
  command->add_flag("--json", options->json, "print one JSON object instead of text");
  command->footer(kPostFooter);
  command->callback([options, &exit_code] { exit_code = run_post(*options); });
}

}  // namespace swarf::cli
