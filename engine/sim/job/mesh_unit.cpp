#include "sim/job/mesh_unit.h"

#include <fmt/format.h>

#include <filesystem>

#include "mesh/mesh_io.h"

namespace swarf::sim {
namespace {

constexpr double kInchUnit = 25.4, kMetreUnit = 1000.0;  // mm

}  // namespace

double unit_mm_of(const std::string& word) {
  return word == "inch" ? kInchUnit : word == "m" ? kMetreUnit : 1.0;
}

void refuse_second_unit(ConfigTable& table, const std::string& file) {
  if (!table.has("mesh_unit") || !mesh::carries_unit(file)) return;
  table.error("unit-twice", "mesh_unit",
              fmt::format("'{}' says its own unit and is read in mm",
                          std::filesystem::path(file).filename().string()),
              "take mesh_unit out");
}

void suspect_unit(const MeshNamed& mesh, const Box& box, double tool_mm, Diagnostics& diagnostics) {
  const double longest = box.size().maxCoeff();
  if (longest >= tool_mm) return;
  const bool inches = longest * kInchUnit >= tool_mm;
  diagnostics.warning(
      "mesh-unit-suspicious", mesh.where,
      fmt::format("the {} is {:g} mm long, less than the tool's diameter of {:g} mm: its numbers may be {}, "
                  "{:g} times as large",
                  mesh.name, longest, tool_mm, inches ? "inches" : "metres", inches ? kInchUnit : kMetreUnit),
      fmt::format("{} = \"{}\"; without a scene --set {}={}", mesh.unit_key, inches ? "inch" : "m",
                  mesh.unit_key, inches ? "inch" : "m"));
}

}  // namespace swarf::sim
