#include "sim/run/cut_identity.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/file.h"
#include "base/hash.h"
#include "base/units.h"
#include "cutter/profile.h"

namespace swarf::sim {
namespace {

constexpr const char* kAlgorithmPart = "cut algorithm";
constexpr const char* kBoxPart = "stock.box_mm";
constexpr const char* kShapePart = "raw stock";
constexpr const char* kVoxelPart = "stock.voxel_mm";
constexpr const char* kCutterPart = "cutter";
constexpr const char* kEarlierPart = "cuts of earlier set-ups";
constexpr const char* kAbsent = "(absent)";

void add(Hash& hash, const Vec2& v) {
  hash.add(v.x());
  hash.add(v.y());
}
void add(Hash& hash, const Vec3& v) {
  for (int a = 0; a < 3; ++a) hash.add(v[a]);
}

/// Name and content, so that a moved file is the same file. A job that was made in memory has none.
std::string file_text(const std::string& path) {
  std::error_code unreadable;
  const std::string name = std::filesystem::path(path).filename().string();
  if (!std::filesystem::exists(path, unreadable)) return name + " " + kAbsent;
  Hash hash;
  read_in_pieces(path, {"file-unreadable", "a file of the job cannot be read"}, [&](std::string_view piece) {
    for (const char c : piece) hash.add(uint64_t{static_cast<unsigned char>(c)});
  });
  return fmt::format("{} {}", name, hash.text());
}

/// Flutes as they are cut with; what stands above them, because it decides on contacts.
std::string cutter_text(const cutter::Cutter& c) {
  Hash hash;
  for (const cutter::OutlineElement& element : cutter::outline(c)) {
    add(hash, element.from);
    add(hash, element.to);
    hash.add(element.radius);
  }
  for (const double value :
       {c.flute_length_mm, c.neck_diameter_mm, c.neck_length_mm, c.shank_diameter_mm, c.length_mm})
    hash.add(value);
  for (const cutter::ToolSection& section : c.holder) {
    hash.add(section.diameter_mm);
    hash.add(section.top_diameter_mm);
    hash.add(section.length_mm);
  }
  return fmt::format("{} {}, outline and holder {}", cutter::call_name(c), cutter::describe(c), hash.text());
}

/// Which tool makes which sweeps; nothing new with one tool.
void add_tools(Hash& hash, const CutSweeps& sweeps) {
  for (size_t begin = 0, end = 0; begin < sweeps.size(); begin = end) {
    const int tool = sweeps.tool(begin);
    while (end < sweeps.size() && sweeps.tool(end) == tool) ++end;
    if (end - begin == sweeps.size()) return;
    hash.add(static_cast<uint64_t>(tool));
    hash.add(uint64_t{end - begin});
  }
}

std::string box_text(const Box& box) {
  return fmt::format("[[{}, {}, {}], [{}, {}, {}]]", box.lower.x(), box.lower.y(), box.lower.z(),
                     box.upper.x(), box.upper.y(), box.upper.z());
}

std::string interpolator_text(const Scene& scene) {
  const motion::MotionOptions& o = scene.motion;
  return fmt::format(
      "mode {} law {} orientation {} look-ahead {} period {} s acceleration {} jerk {} corners {} mm{}",
      static_cast<int>(o.mode), static_cast<int>(scene.block_law), static_cast<int>(o.orientation),
      o.look_ahead, o.period_s, o.path_acceleration_max, o.path_jerk_max, o.corner_tolerance_mm,
      scene.stock.cut_by == CutBy::kCycles ? ", cut by cycles" : "");
}

std::string toolpath_text(const Scene& scene) {
  const toolpath::PlanOptions& o = scene.toolpath;
  return fmt::format(
      "{} safe {} overrun {} clearance {} mm, chord tolerance {}", toolpath::planner_name(o.planner),
      o.safe_distance_mm, o.overrun_mm, o.rapid_clearance_mm,
      scene.chord_tolerance_mm ? fmt::format("{} mm", *scene.chord_tolerance_mm) : "of the program");
}

std::string motion_text(const CutSweeps& sweeps) {
  constexpr size_t kAtOnce = 4096;
  Hash hash;
  for (size_t begin = 0; begin < sweeps.size(); begin += kAtOnce) {
    for (const stock::Sweep& sweep : sweeps.part(begin, std::min(sweeps.size(), begin + kAtOnce))) {
      for (const ToolPose* pose : {&sweep.start, &sweep.end}) {
        add(hash, pose->tip_W);
        add(hash, pose->axis_W);
      }
      hash.add(uint64_t{sweep.block});
    }
  }
  add_tools(hash, sweeps);
  return fmt::format("{} sweeps {}", sweeps.size(), hash.text());
}

std::string value_of(const CutIdentity& identity, const std::string& name) {
  const auto part =
      std::find_if(identity.begin(), identity.end(), [&](const IdentityPart& p) { return p.name == name; });
  return part == identity.end() ? kAbsent : part->value;
}

}  // namespace

std::string tools_text(const std::vector<cutter::Cutter>& tools) {
  std::string text;
  for (const cutter::Cutter& tool : tools) text += (text.empty() ? "" : "; ") + cutter_text(tool);
  return text;
}

CutIdentity cut_identity(const Job& job, const CutSweeps& sweeps, const CarriedCuts& carried) {
  const Scene& scene = job.scene;
  return {{kAlgorithmPart, fmt::format("{}", kCutAlgorithm)},
          scene.stock.shape ? IdentityPart{kShapePart, scene.stock.shape->text()}
                            : IdentityPart{kBoxPart, box_text(scene.stock.box_W)},
          {kEarlierPart, carried.empty() ? kAbsent : carried.text()},
          {kVoxelPart, fmt::format("{}", scene.stock.voxel_mm)},
          {"stock.sweep_tolerance_um", fmt::format("{:g}", um_from_mm(scene.stock.sweep_tolerance_mm))},
          {kCutterPart, tools_text(scene.tools)},
          {"program", file_text(scene.program_file)},
          {"machine", file_text(scene.machine_file)},
          {"toolpath", toolpath_text(scene)},
          {"interpolator", interpolator_text(scene)},
          {kMotionPart, motion_text(sweeps)}};
}

std::vector<IdentityDifference> differences(const CutIdentity& before, const CutIdentity& now) {
  std::vector<IdentityDifference> found;
  for (const IdentityPart& part : now) {
    const std::string old = value_of(before, part.name);
    if (old == part.value || (part.name == kMotionPart && !found.empty())) continue;
    found.push_back({part.name, old, part.value});
  }
  return found;
}

bool needed_to_compare(const std::string& part_name) {
  return part_name == kAlgorithmPart || part_name == kBoxPart || part_name == kShapePart ||
         part_name == kEarlierPart || part_name == kVoxelPart || part_name == kCutterPart;
}

}  // namespace swarf::sim
