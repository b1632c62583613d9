#include "sim/job/fixture_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "base/units.h"
#include "mesh/mesh_check.h"
#include "mesh/mesh_io.h"
#include "mesh/mesh_ops.h"
#include "mesh/plain_solids.h"
#include "sim/job/mesh_unit.h"
#include "sim/job/scene.h"

namespace swarf::sim {
namespace {

constexpr std::array<std::pair<const char*, double>, 3> kMeshUnits{
    {{"mm", 1.0}, {"inch", 25.4}, {"m", 1000.0}}};
constexpr double kSmallestMm = 2.0,
                 kLargestMm = 5000.0;  // of a fixture: beyond it the unit is likely another

Vec3 read_triple(ConfigTable& table, const char* key, const Vec3& fallback) {
  const std::vector<double> read =
      table.numbers(key, 3, std::vector<double>{fallback.x(), fallback.y(), fallback.z()});
  return read.size() == 3 ? Vec3(read[0], read[1], read[2]) : fallback;
}

/// Without `kind` the solid's own key tells; keys that are not asked for are unknown.
std::string fixture_kind(ConfigTable& table) {
  if (!table.has("kind")) {
    if (table.has("mesh")) return "mesh";
    if (table.has("box_mm")) return "box";
  }
  return table.choice("kind", {"vice", "clamps", "chuck", "tombstone", "mesh", "box"});
}

machine::FixtureSolid read_solid(ConfigTable& table, bool mesh) {
  machine::FixtureSolid shape;
  if (!mesh) {
    const Box box = table.box("box_mm");
    if (box.size().minCoeff() > 0.0) mesh::add_box(shape.mesh, box);
    return shape;
  }
  shape.mesh_file = table.text("mesh");
  std::vector<std::string> names;
  for (const auto& [name, mm] : kMeshUnits) names.emplace_back(name);
  const std::string unit = table.choice("mesh_unit", names, "mm");
  for (const auto& [name, mm] : kMeshUnits)
    if (unit == name) shape.unit_mm = mm;
  refuse_second_unit(table, shape.mesh_file);
  return shape;
}

machine::Vice read_vice(ConfigTable& table) {
  machine::Vice shape;
  shape.along_y = table.choice("jaws", {"x", "y"}, "y") == "y";
  shape.grip_mm = table.number("grip_mm", {0.1, 1000.0}, shape.grip_mm);
  shape.jaw_width_mm = table.number("jaw_width_mm", {0.0, 2000.0}, shape.jaw_width_mm);
  shape.jaw_thickness_mm = table.number("jaw_thickness_mm", {1.0, 500.0}, shape.jaw_thickness_mm);
  return shape;
}

machine::Clamps read_clamps(ConfigTable& table) {
  machine::Clamps shape;
  shape.sides = table.choices("sides", {"x-", "x+", "y-", "y+"}, shape.sides);
  shape.reach_mm = table.number("reach_mm", {0.1, 500.0}, shape.reach_mm);
  shape.margin_mm = table.number("margin_mm", {0.0, 1000.0}, shape.margin_mm);
  return shape;
}

machine::Chuck read_chuck(ConfigTable& table) {
  machine::Chuck shape;
  shape.diameter_mm = table.number("diameter_mm", {10.0, 2000.0}, shape.diameter_mm);
  shape.grip_mm = table.number("grip_mm", {0.1, 1000.0}, shape.grip_mm);
  shape.grip_diameter_mm = table.number("grip_diameter_mm", {0.0, 2000.0}, shape.grip_diameter_mm);
  return shape;
}

machine::Tombstone read_tombstone(ConfigTable& table) {
  machine::Tombstone shape;
  shape.size_mm = read_triple(table, "size_mm", shape.size_mm);
  shape.foot_mm = table.number("foot_mm", {1.0, 500.0}, shape.foot_mm);
  if (shape.size_mm.minCoeff() <= 0.0 || shape.size_mm.z() <= shape.foot_mm)
    table.error("bad-fixture", "size_mm", "a tombstone has three lengths above 0 and is higher than its foot",
                "write size_mm = [120, 120, 300]");
  return shape;
}

/// Where a shape stands that does not follow the stock.
void read_place(ConfigTable& table, machine::Fixture& fixture) {
  fixture.on_part = table.choice("on", {"table", "part"}, "table") == "part";
  fixture.position_mm = read_triple(table, "position_mm", Vec3::Zero());
  const Vec3 turns = read_triple(table, "rotation_deg", Vec3::Zero());
  for (int i = 0; i < 3; ++i) fixture.rotation_rad[i] = rad_from_deg(turns[i]);
}

machine::Fixture read_fixture(ConfigTable table) {
  machine::Fixture fixture;
  fixture.where = table.where();
  const std::string kind = fixture_kind(table);
  fixture.name = table.text("name", kind);
  if (kind == "vice") {
    fixture.shape = read_vice(table);
  } else if (kind == "clamps") {
    fixture.shape = read_clamps(table);
  } else if (kind == "chuck") {
    fixture.shape = read_chuck(table);
  } else {
    if (kind == "tombstone")
      fixture.shape = read_tombstone(table);
    else
      fixture.shape = read_solid(table, kind == "mesh");
    read_place(table, fixture);
  }
  const Vec3 colour = read_triple(table, "colour", Vec3(0.35, 0.37, 0.40));
  if (colour.minCoeff() < 0.0 || colour.maxCoeff() > 1.0)
    table.error("out-of-range", "colour", "each of red, green and blue (linear) must be from 0 to 1",
                "colour = [0.35, 0.37, 0.4]");
  for (int i = 0; i < 3; ++i) fixture.colour[static_cast<size_t>(i)] = static_cast<float>(colour[i]);
  return fixture;
}

void check_size(const machine::Fixture& fixture, const std::string& file, const TriMesh& mesh,
                Diagnostics& diagnostics) {
  const double size = mesh::bounds(mesh).size().maxCoeff();
  if (size >= kSmallestMm && size <= kLargestMm) return;
  diagnostics.warning(
      "fixture-size", {file},
      fmt::format("'{}' is {:g} mm long, read in the unit that the scene says", fixture.name, size),
      "STL files name no unit: fixture.mesh_unit = \"mm\", \"inch\" or \"m\"");
}

void load_solid(machine::Fixture& fixture, Diagnostics& diagnostics) {
  if (mesh_file_of(fixture) == nullptr) return;
  auto* const shape = std::get_if<machine::FixtureSolid>(&fixture.shape);
  shape->mesh = mesh::load_mesh(shape->mesh_file);
  for (auto& p : shape->mesh.positions)
    for (float& value : p) value = static_cast<float>(value * shape->unit_mm);
  mesh::check_design_mesh(shape->mesh, shape->mesh_file, nullptr, diagnostics,
                          "fixture '" + fixture.name + "'");
  if (!diagnostics.has_errors()) check_size(fixture, shape->mesh_file, shape->mesh, diagnostics);
}

}  // namespace

std::vector<machine::Fixture> read_fixtures(ConfigTable& root) {
  std::vector<machine::Fixture> fixtures;
  if (!root.has("fixture")) return fixtures;
  for (const ConfigTable& table : root.tables("fixture")) {
    machine::Fixture fixture = read_fixture(table);
    const auto same = std::find_if(fixtures.begin(), fixtures.end(),
                                   [&](const machine::Fixture& other) { return other.name == fixture.name; });
    if (same != fixtures.end())
      root.error("two-fixtures", "fixture", fmt::format("two fixtures are called '{}'", fixture.name),
                 "findings name them: give each a name of its own");
    fixtures.push_back(std::move(fixture));
  }
  return fixtures;
}

std::string* mesh_file_of(machine::Fixture& fixture) {
  auto* const shape = std::get_if<machine::FixtureSolid>(&fixture.shape);
  return shape == nullptr || shape->mesh_file.empty() ? nullptr : &shape->mesh_file;
}

void place_fixtures(Job& job, const Vec3& table_M, Diagnostics& diagnostics) {
  const machine::HeldWork work{job.scene.stock.box_W, job.machine.model.X_MW, table_M};
  for (machine::Fixture& fixture : job.scene.fixtures) {
    load_solid(fixture, diagnostics);
    if (diagnostics.has_errors()) continue;
    TriMesh mesh = machine::fixture_mesh(fixture, work, diagnostics);
    if (mesh.triangles.empty()) continue;
    machine::add_fixture(job.machine, fixture, std::move(mesh));
  }
}

}  // namespace swarf::sim
