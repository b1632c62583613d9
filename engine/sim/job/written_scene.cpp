#include "sim/job/written_scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/units.h"
#include "program/dialects.h"
#include "sim/job/scene_text.h"

namespace swarf::sim {
namespace {

namespace fs = std::filesystem;

std::string commented_vector(const Vec3& v) {
  return fmt::format("[{}, {}, {}]", v.x(), v.y(), v.z());
}

std::string seen_from(const fs::path& folder, const std::string& file) {
  return toml_string(fs::absolute(file).lexically_proximate(fs::absolute(folder)).string());
}

std::string reason_of(const Job& job, const std::string& what) {
  for (const Assumption& one : job.scene.assumptions) {
    if (one.what == what) return "# assumed: " + one.reason + "\n";
  }
  return "";
}

std::string tool_text(const cutter::Cutter& tool) {
  std::string text = "\n[[tool]]\n";
  if (tool.number > 0) text += fmt::format("number = {}\n", tool.number);
  if (!tool.name.empty()) text += "name = " + toml_string(tool.name) + "\n";
  text += fmt::format("shape = \"{}\"\ndiameter_mm = {}\n", cutter::shape_name(tool.shape), tool.diameter_mm);
  if (tool.corner_radius_mm > 0.0) text += fmt::format("corner_radius_mm = {}\n", tool.corner_radius_mm);
  if (tool.point_angle_rad > 0.0)
    text += fmt::format("point_angle_deg = {:.12g}\n", deg_from_rad(tool.point_angle_rad));
  text += fmt::format("flute_length_mm = {}  # edges reach this far above the tip\n", tool.flute_length_mm);
  text += fmt::format("length_mm = {}  # tip to the holder's face\n", tool.length_mm);
  text += fmt::format("gauge_length_mm = {}  # tip to the spindle's gauge line\n", *tool.gauge_length_mm);
  return text +
         fmt::format(
             "holder = [{{ diameter_mm = {}, length_mm = {} }}]  # as thin as the tool: cannot touch\n",
             tool.holder.front().diameter_mm, tool.holder.front().length_mm);
}

std::string commented_tools(const Job& job, const fs::path& folder) {
  if (!job.scene.tool_table_file.empty())
    return "tool_table = " + seen_from(folder, job.scene.tool_table_file) + "\n";
  std::string text;
  for (const cutter::Cutter& tool : job.scene.tools) text += tool_text(tool);
  return text;
}

/// What stands before the first table.
std::string head_text(const Job& job, const fs::path& folder, const std::string& machine) {
  const Scene& scene = job.scene;
  const bool nc = scene.kind == ProgramKind::kNc;
  std::string text =
      "# Written by 'swarf init'. Run it: swarf run scene.toml\n"
      "# Change what is not so on your machine; scenes/README.md explains every key.\n";
  text += "title = " + toml_string(scene.title) + "\n";
  text += (nc ? "nc = " : "cl = ") + seen_from(folder, scene.program_file) + "\n";
  if (scene.dialect) text += fmt::format("dialect = \"{}\"\n", program::dialect_name(*scene.dialect));
  return text + "machine = " + toml_string(machine) +
         "  # a name that 'swarf machines' lists, or a machine.toml\n";
}

std::string parameters_text(const Job& job) {
  if (job.scene.presets.empty()) return "";
  std::string text = "\n[parameters]  # values before the program starts\n";
  for (const auto& [name, preset] : job.scene.presets)
    text += fmt::format("{} = {}\n", toml_string(name), preset.value);
  return text;
}

std::string commented_setup(const Job& job) {
  const SetupSettings& setup = job.scene.setup;
  const Vec3& origin = job.machine.model.X_MW.translation();
  std::string text = "\n[setup]\n" + reason_of(job, "Clamping");
  text += fmt::format("work_origin_mm = {}  # where G54 is zero, in the machine\n", commented_vector(origin));
  if (setup.tracut)
    text +=
        fmt::format("tracut = \"{}\"\n", *setup.tracut == program::ClTracut::kApply ? "apply" : "applied");
  if (setup.unit_mm) text += fmt::format("units = \"{}\"\n", *setup.unit_mm == 1.0 ? "mm" : "inch");
  if (job.scene.kind != ProgramKind::kNc) return text;
  if (setup.tip_without_length)
    text +=
        "without_length = \"tip\"  # positions of a program that calls no tool length; or \"gauge_line\"\n";
  if (setup.start_tool > 0) text += fmt::format("start_tool = {}\n", setup.start_tool);
  if (setup.t_changes_tool) text += "t_changes_tool = true\n";
  if (setup.slot_ends)
    text +=
        fmt::format("slot_ends = \"{}\"\n", *setup.slot_ends == program::SlotEnds::kEdge ? "edge" : "centre");
  return text;
}

std::string raw_text(const StockSettings& stock, const fs::path& folder) {
  if (stock.raw.kind == RawKind::kMesh) return "mesh = " + seen_from(folder, stock.raw.file) + "\n";
  if (stock.raw.kind == RawKind::kTube) {
    const stock::RawTube& tube = stock.raw.tube;
    const std::string inner =
        tube.inner_radius_mm > 0.0 ? fmt::format("inner_diameter_mm = {}, ", 2.0 * tube.inner_radius_mm) : "";
    return fmt::format("{} = {{ diameter_mm = {}, {}length_mm = {}, base_mm = {}, axis = {} }}\n",
                       stock.raw.key, 2.0 * tube.radius_mm, inner, tube.length_mm,
                       commented_vector(tube.base_W), commented_vector(tube.axis_W));
  }
  return fmt::format("box_mm = [{}, {}]\n", commented_vector(stock.box_W.lower),
                     commented_vector(stock.box_W.upper));
}

std::string commented_stock(const Job& job, const fs::path& folder) {
  const StockSettings& stock = job.scene.stock;
  return "\n[stock]\n" + reason_of(job, "Stock") + raw_text(stock, folder) + reason_of(job, "Voxel") +
         fmt::format("voxel_mm = {}\n", stock.voxel_mm);
}

std::string design_text(const Job& job, const fs::path& folder) {
  if (job.scene.design.kind != DesignKind::kMesh)
    return "\n[design]\nkind = \"none\"  # mesh = \"part.stl\": what is left is measured against it\n";
  return "\n[design]\n" + job.scene.design.mesh_key + " = " + seen_from(folder, job.scene.design.mesh_file) +
         "\n\n[accept]\n# gouge_max_um = 50  # a limit makes it a verdict\n"
         "# excess_max_um = 200  # material that may be left; without a limit 100, with roughing = true "
         "any\n";
}

std::string pictures_text(const Job& job) {
  std::string kinds;
  for (const std::string& kind : job.scene.stills.kinds)
    kinds += (kinds.empty() ? "" : ", ") + toml_string(kind);
  return fmt::format(
      "\n[movie]\nseconds = {}  # 10: a movie of ten seconds, which takes half a minute\nvoxel_mm = {}\n"
      "\n[stills]\nkinds = [{}]  # machine, part, deviation, fan\nsize = [{}, {}]\nsamples = {}\n",
      job.scene.movie.seconds, job.scene.movie.voxel_mm, kinds, job.scene.stills.size[0],
      job.scene.stills.size[1], job.scene.stills.samples);
}

}  // namespace

std::string written_scene(const Job& job, const fs::path& folder, const std::string& machine) {
  return head_text(job, folder, machine) + commented_tools(job, folder) + parameters_text(job) +
         commented_setup(job) + commented_stock(job, folder) + design_text(job, folder) + pictures_text(job);
}

std::string example_program() {
  return "(a pocket 40 x 30 and a slot, flat end D6; zero: corner of the upper face)\n"
         "G21 G17 G90 G94 G54\n"
         "T1 M6\n"
         "S8000 M3\n"
         "G0 X13 Y13\n"
         "Z2\n"
         "G1 Z-4 F300\n"
         "X47 F900\n"
         "Y18\n"
         "X13\n"
         "Y23\n"
         "X47\n"
         "Y28\n"
         "X13\n"
         "Y32\n"
         "X47\n"
         "Y37\n"
         "X13\n"
         "Y13\n"
         "G0 Z2\n"
         "G0 X-5 Y50\n"
         "Z-3\n"
         "G1 X65\n"
         "G0 Z50\n"
         "M5\n"
         "M2\n";
}

}  // namespace swarf::sim
