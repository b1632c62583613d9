#include "sim/job/mesh_unit.h"

#include <fmt/format.h>

namespace swarf::sim {
namespace {

constexpr double kInchUnit = 25.4, kMetreUnit = 1000.0;  // mm

}  // namespace

double unit_mm_of(const std::string& word) {
  return word == "inch" ? kInchUnit : word == "m" ? kMetreUnit : 1.0;
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
