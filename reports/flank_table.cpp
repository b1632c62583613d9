#include "reports/flank_table.h"

#include <fmt/format.h>

#include <string>

#include "base/units.h"

namespace swarf::reports {

Table flank_table(const measure::FlankError& flank) {
  Table table;
  table.title = "Flank milling of this ruled surface (Chu et al., theory 5)";
  table.intro = fmt::format(
      "A cylinder of radius {:g} mm placed as in the paper: its axis one radius off both guide curves along "
      "their "
      "normals. The normals of a ruling differ by up to {:.4f} deg (at u = {:.4f}).",
      flank.cutter_radius_mm, deg_from_rad(flank.psi_max_rad), flank.psi_max_u);
  table.columns = {{"Motion of the axis"},
                   {"Too deep by, paper's placement", "µm", true},
                   {"Below which no feed goes, E18", "µm", true},
                   {"at u", "", true},
                   {"at v", "", true}};
  const std::string bound = fmt::format("{:.3f}", um_from_mm(flank.twist_bound_mm));
  const auto add = [&](const std::string& motion, double error_mm, double u, const std::string& v) {
    table.rows.push_back(
        {motion, fmt::format("{:.3f}", -um_from_mm(error_mm)), bound, fmt::format("{:.4f}", u), v});
  };
  add("standing", flank.standing_error_mm, flank.standing_u, "along the ruling");
  for (const measure::FlankRow& row : flank.rows) {
    add(row.blocks == 1 ? "1 block" : fmt::format("{} blocks", row.blocks), row.envelope.error_mm,
        row.envelope.u, fmt::format("{:.4f}", row.envelope.v));
  }
  add("on both guide curves at every instant", flank.continuous.error_mm, flank.continuous.u,
      fmt::format("{:.4f}", flank.continuous.v));
  table.notes = {
      "Blocks are equal in u and their two guide points move linearly; the deepest place of the whole "
      "surface "
      "against all blocks. The bound r(1-cos(psi/2)) is the paper's placement standing on a twisted ruling: "
      "feed adjustment cannot go below it (erratum E18), another placement can.",
      "These numbers are of the surface and the cutter; what this scene's own program left is under deepest "
      "gouge."};
  return table;
}

}  // namespace swarf::reports
