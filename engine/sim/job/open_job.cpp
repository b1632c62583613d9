#include "sim/job/open_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/units.h"
#include "machine/shipped.h"
#include "mesh/mesh_ops.h"
#include "sim/job/design_place.h"
#include "sim/job/memory_limit.h"
#include "sim/job/nc_job.h"
#include "sim/job/tool_table.h"
#include "stock/stock.h"
#include "toolpath/cl_path.h"
#include "toolpath/feed_way.h"

namespace swarf::sim {
namespace {

constexpr double kMargin = 2.0;              // mm, of an automatic box
constexpr double kClampHeight = 100.0;       // mm, of "on_table"
constexpr double kFaceCells = 600e3;         // of an automatic voxel, over the faces of the box
constexpr double kMostMb = 2048.0;           // of the uncut block of an automatic voxel
constexpr double kShareOfTool = 1.0 / 20.0;  // of an automatic voxel

void assume(Job& job, std::string what, std::string value, std::string reason, std::string change) {
  job.scene.assumptions.push_back({std::move(what), std::move(value), std::move(reason), std::move(change)});
}

// ---- tools

using Asked = std::vector<program::AskedTool>;

std::string tool_spoken(const program::AskedTool& tool) {
  return tool.number > 0 || tool.name.empty() ? fmt::format("T{}", tool.number) : tool.name;
}

/// "T1 (line 4), T2 (line 20)".
std::string list_asked(const Asked& asked) {
  constexpr size_t kNamesMax = 8;
  std::string list;
  for (size_t i = 0; i < std::min(asked.size(), kNamesMax); ++i)
    list += fmt::format("{}{} (line {})", i > 0 ? ", " : "", tool_spoken(asked[i]), asked[i].line);
  if (asked.size() > kNamesMax) list += fmt::format(" and {} more", asked.size() - kNamesMax);
  return list;
}

/// "T1=6,T2=..".
std::string words_to_write(const Asked& asked) {
  std::string words;
  for (const program::AskedTool& tool : asked)
    words += fmt::format("{}{}={}", words.empty() ? "" : ",", tool_spoken(tool), words.empty() ? "6" : "..");
  return words;
}

/// What the program asks for; as far as it can be read without any tool.
Asked asked_tools(const Job& job) {
  Diagnostics ignored;  // the job itself reads the program, and reports
  if (job.scene.kind == ProgramKind::kNc) return asked_of_nc(job, ignored);
  Asked asked;
  try {
    for (const program::ClTool& tool :
         program::load_cl(job.scene.program_file, nullptr, job.scene.cl_options).tools)
      asked.push_back({tool.number, tool.name, tool.where.line});
  } catch (const InputError&) {
  }
  return asked;
}

void bind_only_tool(Job& job, const Asked& asked, Diagnostics& diagnostics) {
  cutter::Cutter& tool = job.scene.tools.front();
  if (asked.size() > 1) {
    diagnostics.error("unknown-tool", {job.scene.program_file},
                      fmt::format("one tool is described without its number, the program asks for {}: {}",
                                  asked.size(), list_asked(asked)),
                      fmt::format("say each: --tools {}; in a scene tools = \"...\"", words_to_write(asked)));
    return;
  }
  tool.number = asked.empty() ? 1 : asked[0].number;
  if (!asked.empty()) tool.name = asked[0].name;
}

void require_all(const Job& job, const Asked& asked, Diagnostics& diagnostics) {
  Asked missing;
  std::copy_if(asked.begin(), asked.end(), std::back_inserter(missing), [&](const program::AskedTool& tool) {
    return tool_index(job.scene.tools, tool.number, tool.name) < 0;
  });
  if (missing.empty()) return;
  diagnostics.error("unknown-tool", {job.scene.program_file, missing.front().line, 0},
                    fmt::format("the program asks for {}, and the list has {} only", list_asked(missing),
                                list_tools(job.scene.tools)),
                    fmt::format("add {} to it", words_to_write(missing)));
}

/// Planned paths have one tool and no program that calls it.
bool asks_for_tools(ProgramKind kind) {
  return kind == ProgramKind::kCl || kind == ProgramKind::kNc;
}

// ---- the path

/// What the reading of the program took for granted, in the same table.
void assume_reading(Job& job, const toolpath::NcReading& reading, const Diagnostics& told) {
  const auto said = [&](const char* code) {
    return std::any_of(told.list().begin(), told.list().end(),
                       [&](const Diagnostic& one) { return one.code == code; });
  };
  if (said("dialect-assumed"))
    assume(job, "Dialect", "the common core of ISO words (linuxcnc)", "nothing in the text names a control",
           "--dialect; dialect");
  if (said("units-assumed"))
    assume(job, "Unit", "mm", "neither G20 nor G21; in inches everything were 25.4 times as large",
           "--units; setup.units");
  if (said("start-tool-assumed"))
    assume(job, "Tool at start", reading.summary.start_tool, "", "--start-tool; setup.start_tool");
  if (reading.summary.tip_positions)
    assume(job, "Tool length", "positions are those of the tip",
           "the program cuts before it calls a length: the work offset is taken as measured with the tool",
           "call the length in the program (G43 H); setup.without_length = \"gauge_line\"");
}

void need_machine(const Job& job, const SourceLocation& where, Diagnostics& diagnostics) {
  diagnostics.error(
      "machine-needed", where,
      fmt::format("the program turns its tool or the table, and the machine {} has three linear axes",
                  job.machine.model.name),
      "name the machine with --machine, in a scene machine = \"...\": " + five_axis_machines());
}

/// Rotary words on the machine that nobody named.
[[noreturn]] void rethrow_with_machine(const Job& job, const InputError& error) {
  Diagnostics all;
  for (const Diagnostic& one : error.diagnostics.list()) {
    if (one.code == "axis-missing") {
      need_machine(job, one.where, all);
      throw InputError(all);
    }
  }
  throw error;
}

toolpath::FeedWay way_of_nc(Job& job) {
  Diagnostics told;
  try {
    const toolpath::NcPath nc = read_nc_program(job, told);
    told.throw_if_errors();
    assume_reading(job, nc.reading, told);
    return toolpath::feed_way(nc.path.elements);
  } catch (const InputError& error) {
    if (job.scene.machine_assumed) rethrow_with_machine(job, error);
    throw;
  }
}

toolpath::FeedWay way_of_cl(const Job& job, Diagnostics& diagnostics) {
  Diagnostics told;  // the run itself tells
  const toolpath::FeedWay way =
      toolpath::feed_way(toolpath::cl_path(*job.cl, job.scene.block_law, told, cl_tools(job)).elements);
  if (job.scene.machine_assumed && !way.upright) need_machine(job, {job.scene.program_file}, diagnostics);
  return way;
}

// ---- stock

double largest_radius(const std::vector<cutter::Cutter>& tools) {
  double radius = 0.0;
  for (const cutter::Cutter& tool : tools) radius = std::max(radius, tool.radius());
  return radius;
}

void fill_box(Job& job, const toolpath::FeedWay& way) {
  const double beyond = largest_radius(job.scene.tools) + kMargin;
  const double sideways = way.upright ? kMargin : beyond;
  Box box{way.box_W.lower - Vec3(beyond, beyond, sideways), way.box_W.upper + Vec3(beyond, beyond, 0.0)};
  const bool zero_is_top = way.upright && way.box_W.lower.z() < 0.0;
  if (zero_is_top) box.upper.z() = 0.0;
  // All at one depth: what lies above it was reached by rapids.
  const bool flat = !zero_is_top && way.box_W.size().z() < kMargin;
  if (flat) box.upper.z() += kMargin;
  std::string reason = fmt::format(
      "the feed moves' box, the largest tool's radius and {:g} mm around it, {:g} mm below; "
      "its top is {}",
      kMargin, sideways,
      zero_is_top ? "Z 0, below which it goes"
      : flat      ? "2 mm above them"
                  : "the highest of them");
  if (job.design_mesh) {
    const Box design = mesh::bounds(*job.design_mesh);
    box = {box.lower.cwiseMin(design.lower), box.upper.cwiseMax(design.upper)};
    reason += "; the design lies within it";
  }
  // To the next thousandth outwards: numbers that a person can read and write.
  constexpr double kStep = 1e-3, kRounding = 1e-6;
  // + 0 turns a zero that was rounded from below into one without a sign.
  box.lower = ((box.lower / kStep).array() + kRounding).floor() * kStep + 0.0;
  box.upper = ((box.upper / kStep).array() - kRounding).ceil() * kStep + 0.0;
  job.scene.stock.box_W = box;
  assume(job, "Stock", spoken_box(box), reason, "--stock x0,y0,z0,x1,y1,z1; stock.box_mm");
}

double rounded_down(double value) {
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::floor(value / digit) * digit;
}

void fill_voxel(Job& job) {
  StockSettings& stock = job.scene.stock;
  const Vec3 size = stock.box_W.size();
  double diameter = std::numeric_limits<double>::infinity();
  for (const cutter::Cutter& tool : job.scene.tools) diameter = std::min(diameter, tool.diameter_mm);
  const double by_tool = kShareOfTool * diameter;
  const double faces = stock.body_W().area_mm2();
  const double by_cells = std::sqrt(faces / kFaceCells);
  const double coarsest = 0.25 * std::min(diameter, size.minCoeff());
  double voxel = rounded_down(std::min(std::max(by_tool, by_cells), coarsest));
  const double limit = std::min(kMostMb, 0.5 * memory_limit_mb(job.scene)) * 1024.0 * 1024.0;
  bool by_memory = false;
  while (static_cast<double>(stock::Stock::memory_estimate(stock.body_W(), voxel)) > limit) {
    voxel *= 1.25;
    by_memory = true;
  }
  stock.voxel_mm = voxel;
  if (job.scene.movie.auto_voxel) job.scene.movie.voxel_mm = std::max(2.0 * voxel, by_cells);
  const std::string reason =
      by_memory
          ? fmt::format("a finer one needs more than {:.0f} MB for the uncut block", limit / 1024.0 / 1024.0)
      : by_cells > by_tool
          ? fmt::format(
                "{:g} cells over the faces of the block; a twentieth of the smallest tool would be {:.2g} mm",
                kFaceCells, by_tool)
          : fmt::format("a twentieth of the smallest tool, D {:g} mm", diameter);
  assume(job, "Voxel", fmt::format("{:g} mm", voxel), reason, "--voxel mm; stock.voxel_mm");
}

void fill_origin(Job& job) {
  Pose& X_MW = job.machine.model.X_MW;
  const Box& box = job.scene.stock.box_W;
  const Vec3 foot(box.centre().x(), box.centre().y(), box.lower.z());
  const Vec3 origin = X_MW.translation() - X_MW.linear() * foot + Vec3(0.0, 0.0, kClampHeight);
  X_MW.translation() = origin;
  assume(
      job, "Clamping",
      fmt::format("work origin at X {:.3f} Y {:.3f} Z {:.3f} mm of the machine", origin.x(), origin.y(),
                  origin.z()),
      fmt::format(
          "the middle of the stock's lower face {:g} mm above the machine's work origin, as a vice holds it",
          kClampHeight),
      "--origin x,y,z; setup.work_origin_mm");
}

void assume_machine(Job& job) {
  std::string travel;
  for (const kinematics::Axis& axis : job.machine.model.axes)
    travel += fmt::format("{}{} {:g} to {:g}", travel.empty() ? "" : ", ", axis.name, axis.min, axis.max);
  assume(job, "Machine", job.machine.model.name, fmt::format("none is named: the generic one, {} mm", travel),
         "--machine NAME or FILE.toml ('swarf machines' lists them); machine");
}

void assume_tools(Job& job) {
  for (size_t i = 0; job.scene.tools_in_words && i < job.scene.tools.size(); ++i) {
    const cutter::Cutter& tool = job.scene.tools[i];
    assume(job, cutter::call_name(tool), cutter::describe(tool),
           "a word says no more: flutes over the whole length; no shank, no holder, neither can touch",
           "--tools FILE: [[tool]] in TOML, or the tools of LinuxCNC, Fusion, FreeCAD or ISO 13399");
  }
}

}  // namespace

std::string five_axis_machines() {
  std::string list;
  for (const machine::ShippedMachine& one : machine::shipped_machines()) {
    const machine::MachineScene scene = machine::load_machine(one.file);
    if (scene.model.axes.size() <= 3) continue;
    list += fmt::format("{}{} (", list.empty() ? "" : ", ", one.name);
    for (const kinematics::Axis& axis : scene.model.axes) list += axis.name;
    list += ")";
  }
  return list;
}

void check_voxel(const StockSettings& stock, const std::vector<cutter::Cutter>& tools,
                 Diagnostics& diagnostics) {
  const auto fail = [&](const std::string& than, double size) {
    diagnostics.error("out-of-range", stock.voxel_where,
                      fmt::format("'stock.voxel_mm' is {:g}, {} {:g} mm{}", stock.voxel_mm, than, size,
                                  than == "the block is" ? " thick" : ""),
                      fmt::format("write at most {:.2g}, a tenth of that", 0.1 * size));
  };
  const double side = stock.box_W.size().minCoeff();
  if (side > 0.0 && stock.voxel_mm > side) return fail("the block is", side);
  for (const cutter::Cutter& tool : tools) {
    if (tool.diameter_mm > 0.0 && stock.voxel_mm > tool.diameter_mm)
      return fail(cutter::call_name(tool) + " has a diameter of", tool.diameter_mm);
  }
}

void bind_tools(Job& job, Diagnostics& diagnostics) {
  if (!job.scene.tools_in_words || !asks_for_tools(job.scene.kind)) return;
  const Asked asked = asked_tools(job);
  const cutter::Cutter& first = job.scene.tools.front();
  if (first.number == 0 && first.name.empty()) {
    bind_only_tool(job, asked, diagnostics);
  } else {
    require_all(job, asked, diagnostics);
  }
}

void fill_open(Job& job, Diagnostics& diagnostics) {
  const Scene& scene = job.scene;
  if (!job.machine.assumed_dynamics.empty())
    assume(job, "Axis dynamics", job.machine.assumed_dynamics, "machine.toml does not give them",
           "acceleration_max_.., jerk_max_.. of each [[axis]]");
  if (!asks_for_tools(scene.kind)) {
    if (scene.machine_assumed) assume_machine(job);
    if (scene.setup.on_table) fill_origin(job);
    return;
  }
  if (scene.machine_assumed) assume_machine(job);
  if (job.cl && job.cl->unit_assumed)
    assume(job, "Unit", "mm", "the file has no UNITS; in inches everything were 25.4 times as large",
           "--units; setup.units");
  assume_tools(job);
  if (scene.stock.auto_box || scene.setup.tip_without_length || scene.machine_assumed) {
    const toolpath::FeedWay way = job.cl ? way_of_cl(job, diagnostics) : way_of_nc(job);
    if (way.feeds == 0)
      diagnostics.error("nothing-to-cut", {scene.program_file}, "the program has no feed move",
                        "without one nothing is cut; give another program");
    if (diagnostics.has_errors()) return;
    if (scene.stock.auto_box) fill_box(job, way);
  }
  if (scene.stock.auto_voxel) {
    fill_voxel(job);
  } else if (scene.stock.auto_box) {
    check_voxel(scene.stock, scene.tools, diagnostics);
  }
  if (scene.setup.on_table) fill_origin(job);
  if (scene.assumptions.empty() || job.has_design()) return;
  assume(job, "Design", "none: what is left is not measured", "none is named",
         "--design part.stl; [design] mesh");
}

}  // namespace swarf::sim
