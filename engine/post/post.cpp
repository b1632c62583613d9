#include "post/post.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "base/units.h"

namespace swarf::post {
namespace {

using kinematics::AxisKind;
using kinematics::Side;

/// Of the first reading: how much there is to do.
class Count final : public program::ClSink {
 public:
  void move(const program::Move& move) override { rapids += move.rapid ? 1 : 0; }
  void note(program::ClNote /*note*/) override {}
  long rapids = 0;
};

/// Tells the progress and passes on.
class Counted final : public program::ClSink {
 public:
  Counted(program::ClSink& next, Progress& progress) : next_(next), progress_(progress) {}
  void move(const program::Move& move) override {
    constexpr long kEvery = 1000;
    if (++moves_ % kEvery == 0) progress_.advance(static_cast<double>(moves_));
    if (!progress_.stop_requested()) next_.move(move);
  }
  void hole(const program::ClHole& hole) override { next_.hole(hole); }
  void note(program::ClNote note) override { next_.note(std::move(note)); }

 private:
  program::ClSink& next_;
  Progress& progress_;
  long moves_ = 0;
};

int rotaries(const kinematics::MachineModel& machine) {
  return static_cast<int>(std::count_if(machine.axes.begin(), machine.axes.end(),
                                        [](const auto& axis) { return axis.kind == AxisKind::kRotary; }));
}

bool swivels(const kinematics::MachineModel& machine) {
  return std::any_of(machine.axes.begin(), machine.axes.end(), [](const auto& axis) {
    return axis.kind == AxisKind::kRotary && axis.side == Side::kHead;
  });
}

/// Tools of the program as indices into the setup's, appended where there is no table.
std::vector<int> bind_tools(const program::ClProgram& program, bool table, std::vector<PostTool>& tools,
                            Diagnostics& diagnostics) {
  std::vector<int> bound;
  for (const program::ClTool& called : program.tools) {
    const auto found = std::find_if(tools.begin(), tools.end(), [&](const PostTool& one) {
      return called.number != 0 ? one.number == called.number : one.name == called.name;
    });
    if (found == tools.end() && table) {
      diagnostics.error("unknown-tool", called.where,
                        fmt::format("tool {} is not in the tool table",
                                    called.number != 0 ? std::to_string(called.number) : called.name),
                        "add it to the file of --tools");
    }
    if (found == tools.end() && !table) {
      tools.push_back({called.number, called.name, 0.0});
      bound.push_back(static_cast<int>(tools.size()) - 1);
    } else {
      bound.push_back(static_cast<int>(found - tools.begin()));
    }
  }
  diagnostics.throw_if_errors();
  return bound;
}

void check_lengths(const kinematics::MachineModel& machine, const std::string& file, bool tcp, bool table,
                   Diagnostics& diagnostics) {
  if (table || !machine.gauge_M) return;
  if (swivels(machine) && !tcp)
    throw InputError("tool-length", {file},
                     fmt::format("{} swivels the tool, and without TCP its axis values depend on the tool's "
                                 "length, which nobody has given",
                                 machine.name),
                     "give the tool table: --tools tools.toml");
  diagnostics.warning(
      "length-assumed", {file},
      "without a tool table the tools count as 0 mm long: the words of the program do not depend "
      "on it, but the travel of the axes has been judged with the tip at the gauge line",
      "give the tool table: --tools tools.toml");
}

FollowRules rules_of(const PostFormat& format, const PostOptions& options, bool tcp) {
  FollowRules rules;
  rules.tcp = tcp;
  rules.tip_mm = options.tip_mm;
  rules.axis_rad = options.axis_rad;
  rules.linear_half = half_digit_mm(format);
  rules.rotary_half = rad_from_deg(half_digit(format.numbers.rotary));
  rules.snap_rad = rules.rotary_half;
  return rules;
}

/// A name that every control takes: capitals, digits, _.
std::string program_name(const std::string& file) {
  std::string name;
  for (const char one : std::filesystem::path(file).stem().string())
    name += std::isalnum(static_cast<unsigned char>(one)) != 0
                ? static_cast<char>(std::toupper(static_cast<unsigned char>(one)))
                : '_';
  return name.empty() ? "PROGRAM" : name;
}

bool wants_tcp(const kinematics::MachineModel& machine, const PostFormat& format, const PostOptions& options,
               Diagnostics& diagnostics) {
  const bool can = rotaries(machine) > 0;
  const bool tcp = options.tcp.value_or(format.tcp_by_default && can && format.has_tcp());
  if (tcp && !format.has_tcp())
    throw InputError("no-tcp", {format.file}, fmt::format("{} has no words for TCP", format.name),
                     "give --no-tcp, or write [tcp] on and off");
  if (tcp && !can)
    throw InputError("no-tcp", {machine.name}, "the machine has no rotary axis: TCP would mean nothing",
                     "leave --tcp out");
  if (tcp && !format.tcp_warning.empty())
    diagnostics.warning("tcp-words", {format.file}, format.tcp_warning, "give --no-tcp");
  return tcp;
}

PlaneUse planes_of(const PostFormat& format, PlaneUse wished) {
  if (wished != PlaneUse::kNever && format.tilted_plane.on.empty())
    throw InputError("no-planes", {format.file},
                     fmt::format("{} has no words for tilted planes", format.name),
                     "leave --planes out, or write [tilted_plane] on and off");
  return wished;
}

void warn_of_rapids(const kinematics::MachineModel& machine, const std::string& file, long rapids,
                    Diagnostics& diagnostics) {
  if (machine.rapid != kinematics::RapidMotion::kDogLeg || rapids == 0) return;
  diagnostics.warning(
      "rapid-dog-leg", {file},
      fmt::format("{} does not drive rapids on straight lines: its {} rapids leave the way of the "
                  "CL data by more than the tolerance",
                  machine.name, rapids),
      "see where they go with swarf run");
}

program::ClProgram read(const std::string& file, const PostOptions& options, program::ClSink& sink,
                        Diagnostics& diagnostics) {
  if (options.cl_text == nullptr) return program::stream_cl(file, sink, diagnostics, options.cl);
  return program::stream_cl_text(*options.cl_text, file, sink, diagnostics, options.cl);
}

}  // namespace

PostAbilities abilities_of(const PostFormat& format) {
  PostAbilities can;
  const bool arcs = !format.motion.clockwise.empty() && !format.motion.counter_clockwise.empty();
  for (size_t i = 0; i < 3; ++i) can.planes.at(i) = arcs && !format.motion.plane.at(i).empty();
  can.helix = format.motion.helix;
  can.tcp_arcs = format.tcp_arcs;
  can.drill = !format.cycle.drill.empty();
  can.drill_dwell = !format.cycle.drill_dwell.empty();
  can.deep = !format.cycle.deep.empty();
  can.chip_break = !format.cycle.chip_break.empty();
  can.bore = !format.cycle.bore.empty();
  can.bore_dwell = !format.cycle.bore_dwell.empty();
  can.tap = !format.cycle.tap.empty();
  can.arc_digit_mm = 2.0 * half_digit_mm(format);
  const PlaneWords& plane = format.tilted_plane;
  can.plane = {plane.on.empty() ? PlaneUse::kNever : plane.use, plane.turns, format.numbers.rotary.decimals};
  return can;
}

PostResult post(const std::string& cl_file, const kinematics::MachineModel& machine, const PostFormat& format,
                const PostOptions& options, const Writer::Out& out, Progress& progress,
                Diagnostics& diagnostics) {
  PostResult result;
  result.tcp = wants_tcp(machine, format, options, diagnostics);
  const program::nc::WorkSpace words(machine);  // refuses axes that have no word
  const bool table = !options.tools.empty();
  check_lengths(machine, cl_file, result.tcp, table, diagnostics);
  progress.begin("reading the CL data", 1.0, "file");
  Count count;
  const program::ClProgram program = read(cl_file, options, count, diagnostics);
  diagnostics.throw_if_errors();
  progress.end();
  warn_of_rapids(machine, cl_file, count.rapids, diagnostics);

  PlannerSetup setup;
  setup.machine = machine;
  setup.tools = options.tools;
  const std::vector<int> bound = bind_tools(program, table, setup.tools, diagnostics);
  setup.rules = result.rules = rules_of(format, options, result.tcp);
  setup.abilities = abilities_of(format);
  if (options.planes) setup.abilities.plane.use = planes_of(format, *options.planes);
  setup.hooks = options.hooks;
  const ProgramNames names{program_name(cl_file), machine.name, cl_file};
  Writer writer(format, setup, names, out, diagnostics);
  Planner planner(
      setup, cl_file, [&](const PlannedStretch& planned) { writer.stretch(planned); }, diagnostics);
  planner.tool_of = [&](int tool) { return tool < 0 ? -1 : bound[static_cast<size_t>(tool)]; };
  progress.begin("writing the program", static_cast<double>(program.motions), "moves");
  writer.head();
  Counted counted(planner, progress);
  Diagnostics again;  // the same warnings a second time
  read(cl_file, options, counted, again);
  if (!progress.stop_requested()) planner.finish();
  writer.tail();
  progress.end();
  diagnostics.throw_if_errors();
  result.plan = planner.summary();
  result.written = writer.summary();
  result.choices = planner.choices();
  result.routes_dropped = planner.routes_dropped();
  return result;
}

}  // namespace swarf::post
