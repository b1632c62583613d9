#include "cli/compare_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "sim/judge/limit_text.h"

namespace swarf::cli {
namespace {

using nlohmann::ordered_json;
using Rows = std::vector<std::pair<std::string, std::string>>;

/// Regions that the table names; JSON has more.
constexpr size_t kNamedRegions = 5;

std::string place_text(const Vec3& p) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f}) mm", p.x(), p.y(), p.z());
}

ordered_json place_json(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

template <typename Value>
ordered_json or_null(const std::optional<Value>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

double unmeasured(const measure::PartComparison& result) {
  return result.stock.unmeasured_mm2 + result.design.unmeasured_mm2;
}

sim::Check judge_extreme(const char* name, const char* subject, double limit_um,
                         const measure::DeviationExtreme& extreme) {
  sim::Check check{name, subject};
  check.unit = "um";
  check.limit = limit_um;
  check.value = extreme.um;
  check.bound = extreme.bound_um;
  check.what =
      fmt::format("{} {} um, proven {} um, at most {} um", name, sim::text_beside(extreme.um, limit_um),
                  sim::text_beside(extreme.bound_um, limit_um), sim::limit_text(limit_um));
  check.outcome = extreme.um > limit_um         ? sim::Outcome::kFails
                  : extreme.bound_um > limit_um ? sim::Outcome::kNotProven
                                                : sim::Outcome::kHolds;
  if (check.outcome == sim::Outcome::kNotProven) {
    check.reason = fmt::format("not proven below {} um: proven {} um at {}", sim::limit_text(limit_um),
                               sim::text_beside(extreme.bound_um, limit_um), place_text(extreme.bound_place));
  }
  return check;
}

ordered_json check_json(const sim::Check& check) {
  return {{"name", check.name},
          {"unit", check.unit},
          {"limit", or_null(check.limit)},
          {"value", or_null(check.value)},
          {"bound", or_null(check.bound)},
          {"outcome", sim::outcome_name(check.outcome)},
          {"holds", check.outcome == sim::Outcome::kHolds},
          {"reason", check.reason}};
}

ordered_json region_json(const measure::DeviationRegion& region) {
  return {{"kind", region.gouge ? "gouge" : "excess"}, {"worst_um", region.worst_um},
          {"place_mm", place_json(region.place)},      {"on", region.on_design ? "design" : "stock"},
          {"stock_area_mm2", region.stock_area_mm2},   {"design_area_mm2", region.design_area_mm2},
          {"volume_mm3", or_null(region.volume_mm3)}};
}

ordered_json side_json(const measure::SideSummary& side) {
  return {{"area_mm2", side.area_mm2},           {"samples", side.samples},
          {"proof_samples", side.proof_samples}, {"beyond_design_mm2", side.beyond_mm2},
          {"rounded_edges_mm2", side.edge_mm2},  {"unmeasured_mm2", side.unmeasured_mm2}};
}

ordered_json surface_json(const measure::PartComparison& r) {
  ordered_json regions = ordered_json::array();
  for (const auto& region : r.regions) regions.push_back(region_json(region));
  return {{"excess_max_um", r.excess.um},
          {"excess_bound_um", r.excess.bound_um},
          {"excess_place_mm", place_json(r.excess.place)},
          {"gouge_max_um", r.gouge.um},
          {"gouge_bound_um", r.gouge.bound_um},
          {"gouge_place_mm", place_json(r.gouge.place)},
          {"unmeasured_area_mm2", unmeasured(r)},
          {"within_tolerance_pct", r.within_tolerance_pct},
          {"mean_um", r.mean_um},
          {"mean_abs_um", r.mean_abs_um},
          {"rms_um", r.rms_um},
          {"region_count", r.region_count},
          {"regions", regions}};
}

std::string extreme_text(const measure::DeviationExtreme& extreme) {
  if (extreme.um == 0.0) return fmt::format("none; proven below {:.3f} um", extreme.bound_um);
  return fmt::format("{:.3f} um at {}; proven below {:.3f} um", extreme.um, place_text(extreme.place),
                     extreme.bound_um);
}

std::string region_text(const measure::DeviationRegion& region) {
  return fmt::format("{} {:.3f} um at {}, {:.3f} mm2 of the stock, {:.3f} mm2 of the design{}",
                     region.gouge ? "gouge" : "excess", region.worst_um, place_text(region.place),
                     region.stock_area_mm2, region.design_area_mm2,
                     region.volume_mm3 ? fmt::format(", {:.4g} mm3", *region.volume_mm3) : "");
}

/// Of an earlier stock, whose grid is compared as it is: what no number here includes.
std::string grids_text(const ComparedStock& stock, const ComparedDesign& design) {
  const std::string own = stock.voxel_mm > 0.0
                              ? fmt::format("voxels of {:g} mm, off by up to {:.3f} um, against ",
                                            stock.voxel_mm, um_from_mm(stock.greatest_error_mm()))
                              : "";
  return fmt::format("; {}voxels of {:g} mm, off by up to {:.3f} um, and more at sharp edges: not included",
                     own, design.voxel_mm, um_from_mm(design.grid_error_mm));
}

std::string accuracy_text(const ComparedStock& stock, const ComparedDesign& design,
                          const measure::ComparisonInput& input, const measure::PartComparison& result) {
  std::string text = fmt::format("a sample within {:.3g} mm of every point", input.pitch);
  if (input.design_error > 0.0)
    text +=
        fmt::format("; {}facets within {:.3f} um of the design",
                    input.faces != nullptr ? "samples on its faces, " : "", um_from_mm(input.design_error));
  if (design.grid) {
    text += grids_text(stock, design);
  } else if (stock.voxel_mm > 0.0) {
    text += fmt::format("; voxels of {:g} mm, off by up to {:.3f} um, which the proven numbers include",
                        stock.voxel_mm, result.grid_error_um);
  }
  return text;
}

void add_areas(const measure::ComparisonInput& input, const measure::PartComparison& r, Rows& rows) {
  if (r.stock.beyond_mm2 > 0.0) {
    rows.emplace_back("not compared",
                      fmt::format("{:.2f} mm2 of the stock lie beyond the design's patches or "
                                  "face another way",
                                  r.stock.beyond_mm2));
  }
  if (unmeasured(r) > 0.0) {
    rows.emplace_back(
        "not measured",
        fmt::format("{:.2f} mm2 of the stock and {:.2f} mm2 of the design lie farther away than "
                    "{:g} mm",
                    r.stock.unmeasured_mm2, r.design.unmeasured_mm2, *input.reach));
  }
  if (r.stock.edge_mm2 + r.design.edge_mm2 > 0.0) {
    rows.emplace_back(
        "edges",
        fmt::format("{:.2f} mm2 of the stock and {:.2f} mm2 of the design lie at edges "
                    "that the grid rounds: up to {:.2f} um there; {:g} um and less are put down "
                    "to the grid and in no number, more counts wholly (--edge-mm)",
                    r.stock.edge_mm2, r.design.edge_mm2, r.edge_greatest_um, um_from_mm(input.edge)));
  }
}

ordered_json alignment_json(const measure::Alignment& aligned) {
  ordered_json rows = ordered_json::array();
  for (int r = 0; r < 4; ++r) {
    ordered_json row = ordered_json::array();
    for (int c = 0; c < 4; ++c) row.push_back(aligned.X_design_stock.matrix()(r, c));
    rows.push_back(row);
  }
  return {{"matrix_mm", rows},
          {"points", aligned.points},
          {"steps", aligned.steps},
          {"rms_before_um", um_from_mm(aligned.rms_before_mm)},
          {"rms_um", um_from_mm(aligned.rms_mm)}};
}

}  // namespace

std::string alignment_text(const measure::Alignment& aligned) {
  const Eigen::AngleAxisd turn(aligned.X_design_stock.linear());
  const Vec3 &shift = aligned.X_design_stock.translation(), &axis = turn.axis();
  return fmt::format(
      "turned by {:.5f} deg about ({:.4f}, {:.4f}, {:.4f}) through the origin, then moved by ({:.4f}, "
      "{:.4f}, "
      "{:.4f}) mm; {} points, rms {:.4g} um before, {:.4g} um after",
      deg_from_rad(turn.angle()), axis.x(), axis.y(), axis.z(), shift.x(), shift.y(), shift.z(),
      aligned.points, um_from_mm(aligned.rms_before_mm), um_from_mm(aligned.rms_mm));
}

std::vector<sim::Check> judge_comparison(const measure::ComparisonInput& input,
                                         const measure::PartComparison& result,
                                         const ComparedPieces& pieces) {
  std::vector<sim::Check> checks{
      judge_extreme("excess", "Highest excess", um_from_mm(input.excess), result.excess),
      judge_extreme("gouge", "Deepest gouge", um_from_mm(input.gouge), result.gouge)};
  sim::Check area{"unmeasured_area", "Area not measured"};
  area.unit = "mm2";
  area.limit = 0.0;
  area.value = unmeasured(result);
  area.what = fmt::format("{:.3f} mm2 not measured", unmeasured(result));
  area.outcome = unmeasured(result) > 0.0 ? sim::Outcome::kFails : sim::Outcome::kHolds;
  checks.push_back(std::move(area));
  checks.push_back(pieces_check(pieces));
  return checks;
}

namespace {

ordered_json pieces_json(const ComparedPieces& pieces) {
  ordered_json loose = ordered_json::array();
  for (const SolidPiece& piece : pieces.loose())
    loose.push_back({{"volume_mm3", piece.volume_mm3}, {"place_mm", place_json(piece.middle)}});
  return {{"stock", pieces.stock.size()}, {"design", pieces.design.size()}, {"loose", loose}};
}

/// Errors that no number of the comparison includes; null: the design is no grid.
ordered_json grids_json(const ComparedStock& stock, const ComparedDesign& design) {
  if (!design.grid) return nullptr;
  return {{"stock_error_um", um_from_mm(stock.greatest_error_mm())},
          {"design_voxel_mm", design.voxel_mm},
          {"design_error_um", um_from_mm(design.grid_error_mm)}};
}

}  // namespace

std::string comparison_json(const ComparedStock& stock, const ComparedDesign& design,
                            const measure::ComparisonInput& input, const measure::PartComparison& result,
                            const std::vector<sim::Check>& checks,
                            const std::optional<measure::Alignment>& aligned, const ComparedPieces& pieces) {
  ordered_json list = ordered_json::array();
  for (const sim::Check& check : checks) list.push_back(check_json(check));
  return ordered_json{
             {"schema", 1},
             {"verdict", sim::passes(checks) ? "pass" : "findings"},
             {"checks", list},
             {"surface", surface_json(result)},
             {"volume",
              {{"excess_mm3", or_null(result.excess_mm3)},
               {"gouge_mm3", or_null(result.gouge_mm3)},
               {"difference_mm3", or_null(result.difference_mm3)}}},
             {"pieces", pieces_json(pieces)},
             {"alignment", aligned ? alignment_json(*aligned) : ordered_json(nullptr)},
             {"stock", side_json(result.stock)},
             {"design", side_json(result.design)},
             {"accuracy",
              {{"pitch_mm", input.pitch},
               {"allowance_mm", input.allowance},
               {"facet_error_um", um_from_mm(input.design_error)},
               {"voxel_mm", stock.voxel_mm > 0.0 ? ordered_json(stock.voxel_mm) : ordered_json(nullptr)},
               {"grid_error_um", result.grid_error_um},
               {"grids_not_included", grids_json(stock, design)},
               {"edge_mm", input.edge},
               {"edge_max_um", result.edge_greatest_um}}}}
             .dump(2) +
         "\n";
}

Rows comparison_rows(const ComparedStock& stock, const ComparedDesign& design,
                     const measure::ComparisonInput& input, const measure::PartComparison& r,
                     const ComparedPieces& pieces) {
  Rows rows{{"stock", fmt::format("{:.2f} mm2 against the design, {} samples", r.stock.area_mm2,
                                  r.stock.samples + r.stock.proof_samples)},
            {"design", fmt::format("{:.2f} mm2 against the stock, {} samples", r.design.area_mm2,
                                   r.design.samples + r.design.proof_samples)},
            {"accuracy", accuracy_text(stock, design, input, r)}};
  if (input.allowance > 0.0)
    rows.emplace_back("allowance", fmt::format("{:g} mm left on purpose, all round", input.allowance));
  if (const std::string loose = loose_text(pieces); !loose.empty()) rows.emplace_back("pieces", loose);
  add_areas(input, r, rows);
  rows.emplace_back("excess", extreme_text(r.excess));
  rows.emplace_back("gouge", extreme_text(r.gouge));
  rows.emplace_back("mean",
                    fmt::format("{:.3f} um absolute, {:.3f} um rms, by area", r.mean_abs_um, r.rms_um));
  rows.emplace_back("tolerance",
                    fmt::format("{:.2f} % of the area within -{:g} .. +{:g} um", r.within_tolerance_pct,
                                um_from_mm(input.gouge), um_from_mm(input.excess)));
  if (r.excess_mm3) {
    rows.emplace_back("volume",
                      fmt::format("{:.5g} mm3 too much, {:.5g} mm3 missing; stock - design {:.5g} mm3",
                                  *r.excess_mm3, *r.gouge_mm3, *r.difference_mm3));
  }
  for (size_t i = 0; i < std::min(kNamedRegions, r.regions.size()); ++i)
    rows.emplace_back(
        i == 0 ? fmt::format("{} region{}", r.region_count, r.region_count == 1 ? "" : "s") : "",
        region_text(r.regions[i]));
  return rows;
}

}  // namespace swarf::cli
