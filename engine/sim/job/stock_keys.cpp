#include "sim/job/stock_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"
#include "sim/job/mesh_unit.h"

namespace swarf::sim {
namespace {

constexpr std::array<const char*, 5> kShapes{"cylinder", "tube", "outline", "mesh", "from_run"};
/// An outline with more corners is a mesh: the distance to it looks at each of its sides.
constexpr size_t kMostCorners = 4096;

Vec3 vector_of(ConfigTable& table, const std::string& key, const Vec3& otherwise) {
  const std::vector<double> v =
      table.numbers(key, 3, std::vector<double>{otherwise.x(), otherwise.y(), otherwise.z()});
  return {v[0], v[1], v[2]};
}

stock::RawTube read_tube(ConfigTable table, bool hollow) {
  stock::RawTube tube;
  tube.radius_mm = 0.5 * table.number("diameter_mm", kAboveZero);
  if (hollow) {
    const double inner = table.number("inner_diameter_mm", kAboveZero);
    tube.inner_radius_mm = 0.5 * inner;
    if (tube.radius_mm > 0.0 && tube.inner_radius_mm >= tube.radius_mm) {
      table.error(
          "out-of-range", "inner_diameter_mm",
          fmt::format("the tube has no wall: {:g} mm inside, {:g} mm outside", inner, 2.0 * tube.radius_mm),
          fmt::format("write less than {:g}", 2.0 * tube.radius_mm));
    }
  }
  tube.length_mm = table.number("length_mm", kAboveZero);
  tube.base_W = vector_of(table, "base_mm", Vec3::Zero());
  const Vec3 axis = vector_of(table, "axis", Vec3::UnitZ());
  if (axis.norm() > 0.0) {
    tube.axis_W = axis.normalized();
  } else {
    table.error("out-of-range", "axis", "'axis' has no direction", "write for example [0, 0, 1]");
  }
  return tube;
}

stock::RawOutline read_outline(ConfigTable table) {
  stock::RawOutline outline;
  outline.points_mm = table.flat_points("points_mm");
  const std::vector<double> z = table.numbers("z_mm", 2);
  outline.low_mm = z[0];
  outline.high_mm = z[1];
  if (z[0] >= z[1] && table.has("z_mm")) {
    table.error("out-of-range", "z_mm", fmt::format("the stock is {:g} mm high", z[1] - z[0]),
                "write the lower end first, then the upper one");
  }
  const size_t corners = outline.points_mm.size();
  if (corners > 0 && (corners < 3 || corners > kMostCorners)) {
    table.error("out-of-range", "points_mm", fmt::format("the outline has {} corners", corners),
                fmt::format("write 3 to {} of them; a finer one is a mesh", kMostCorners));
  }
  return outline;
}

/// Quarter turns are exact.
Mat3 rotation_about(int axis, double deg) {
  const double quarters = deg / 90.0;
  double c = std::cos(rad_from_deg(deg)), s = std::sin(rad_from_deg(deg));
  if (quarters == std::floor(quarters)) {
    c = std::round(c);
    s = std::round(s);
  }
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Mat3 turn = Mat3::Identity();
  turn(u, u) = turn(v, v) = c;
  turn(v, u) = s;
  turn(u, v) = -s;
  return turn;
}

/// About the fixed axes, X first, then Y, then Z.
Pose pose_of(const Vec3& position, const Vec3& turn_deg) {
  Pose pose = Pose::Identity();
  for (int a = 0; a < 3; ++a) {
    if (turn_deg[a] == 0.0) continue;
    pose.linear() = rotation_about(a, turn_deg[a]) * pose.linear();
  }
  pose.translation() = position;
  return pose;
}

void read_mesh_keys(ConfigTable& table, RawSettings& raw) {
  raw.file = table.text("mesh");
  raw.unit_said = table.has("mesh_unit");
  const std::string unit = table.choice("mesh_unit", {"mm", "inch", "m"}, "mm");
  raw.unit_mm = unit_mm_of(unit);
  refuse_second_unit(table, raw.file);
  raw.X_WF = pose_of(vector_of(table, "mesh_position_mm", Vec3::Zero()),
                     vector_of(table, "mesh_rotation_deg", Vec3::Zero()));
}

void read_run_keys(ConfigTable& table, RawSettings& raw) {
  raw.file = table.text("from_run");
  raw.X_WF = read_pose(table.table("from_run_pose"));
}

std::string line_of(const SourceLocation& where) {
  if (where.line == 0) return where.file;
  return fmt::format("line {}:{}", where.line, where.column);
}

}  // namespace

Pose read_pose(ConfigTable table) {
  return pose_of(vector_of(table, "position_mm", Vec3::Zero()),
                 vector_of(table, "rotation_deg", Vec3::Zero()));
}

Placement read_placement(ConfigTable& table) {
  const Pose pose =
      pose_of(vector_of(table, "position_mm", Vec3::Zero()), vector_of(table, "rotation_deg", Vec3::Zero()));
  const std::string origin = table.choice("origin", {"work", "corner", "centre"}, "work");
  return {pose.linear(), pose.translation(),
          origin == "corner"   ? PartOrigin::kCorner
          : origin == "centre" ? PartOrigin::kCentre
                               : PartOrigin::kFile};
}

RawSettings read_raw(ConfigTable& table) {
  RawSettings raw;
  raw.where = table.where("box_mm");
  const bool box = table.has("box_mm") && !(table.is_text("box_mm"));
  bool first = !box;
  for (const char* key : kShapes) {
    if (!table.has(key)) continue;
    if (!first) {
      table.error("two-shapes", key,
                  fmt::format("the raw stock has two shapes: '{}' here and '{}' in {}", key, raw.key,
                              line_of(raw.where)),
                  "write one of box_mm, cylinder, tube, outline, mesh, from_run");
      continue;
    }
    first = false;
    raw.key = key;
    raw.where = table.where(key);
  }
  if (raw.key == "cylinder" || raw.key == "tube") {
    raw.kind = RawKind::kTube;
    raw.tube = read_tube(table.table(raw.key), raw.key == "tube");
  } else if (raw.key == "outline") {
    raw.kind = RawKind::kOutline;
    raw.outline = read_outline(table.table(raw.key));
  } else if (raw.key == "mesh") {
    raw.kind = RawKind::kMesh;
    read_mesh_keys(table, raw);
  } else if (raw.key == "from_run") {
    raw.kind = RawKind::kRun;
    read_run_keys(table, raw);
  }
  return raw;
}

}  // namespace swarf::sim
