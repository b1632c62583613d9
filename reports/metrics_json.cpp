#include "reports/metrics_json.h"

#include "reports/avoidance_output.h"
#include "reports/driven_output.h"
#include "reports/flank_output.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "base/units.h"
#include "reports/review_findings.h"
#include "reports/tools_table.h"
#include "sim/run/worn_fixtures.h"

namespace swarf::reports {
namespace {

using Json = nlohmann::ordered_json;

/// Line of the program that an element comes from; null for none.
Json line_json(const sim::Result& result, int element) {
  if (element < 0) return nullptr;
  return result.main.path.elements.line(static_cast<size_t>(element));
}

Json assumptions_json(const sim::Assumptions& assumptions) {
  Json list = Json::array();
  for (const sim::Assumption& one : assumptions)
    list.push_back(
        {{"what", one.what}, {"value", one.value}, {"reason", one.reason}, {"change", one.change}});
  return list;
}

Json number_or_null(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// From tool change to tool change.
Json operations_json(const sim::Job& job, const sim::Result& result) {
  Json list = Json::array();
  for (const sim::Operation& one : result.main.operations)
    list.push_back({{"tool", cutter::call_name(job.scene.tools[static_cast<size_t>(one.tool)])},
                    {"line", one.first_line},
                    {"feed_s", one.feed_s},
                    {"rapid_s", one.rapid_s},
                    {"dwell_s", one.dwell_s},
                    {"feed_mm", one.feed_mm},
                    {"deepest_mm", one.deepest_mm},
                    {"stick_out_mm", one.stick_out_mm}});
  return list;
}

Json motion_json(const sim::Job& job, const sim::Result& result) {
  const motion::MotionStatistics& motion = result.main.motion.statistics;
  return {{"ticks", motion.ticks},
          {"time_s", motion.time_s},
          {"time_feed_s", motion.cycle.feed_s},
          {"time_rapid_s", motion.cycle.rapid_s},
          {"time_dwell_s", motion.cycle.dwell_s},
          {"time_by_tool_s", motion.cycle.by_tool_s},
          {"tool_change_s", number_or_null(job.machine.tool_change_s)},
          {"operations", operations_json(job, result)},
          {"corner_tolerance_mm", job.scene.motion.corner_tolerance_mm},
          {"corner_deviation_max_mm", motion.corner_deviation_max_mm},
          {"corner_deviation_line", line_json(result, motion.corner_element)},
          {"tip_error_other_mode_max_mm", motion.other_mode.tip_error_max_mm},
          {"tip_error_other_mode_line", line_json(result, motion.other_mode.element)},
          {"tip_error_other_mode_share", motion.other_mode.share},
          {"fast_rotary_threshold_deg_mm", deg_from_rad(job.scene.motion.fast_rotary_rad_mm)},
          {"swing_threshold_deg", deg_from_rad(job.scene.motion.swing_rad)},
          {"path_length_mm", motion.path_length_mm},
          {"feed_error_max_rel", motion.feed_error_max_rel},
          {"feed_min_mm_s", motion.feed_min_mm_s},
          {"chord_error_max_um", um_from_mm(motion.chord_error_max_mm)},
          {"orientation_error_max_deg", deg_from_rad(motion.orientation_error_max_rad)},
          {"tick_ns_median", motion.tick_ns_median},
          {"tick_ns_p999", motion.tick_ns_p999}};
}

Json kinematics_json(const sim::Job& job, const motion::MotionStatistics& motion) {
  Json axes = Json::array();
  for (size_t i = 0; i < motion.axes.size(); ++i) {
    const motion::AxisStatistics& axis = motion.axes[i];
    const bool rotary = job.machine.model.axes[i].kind == kinematics::AxisKind::kRotary;
    const auto shown = [&](double value) { return rotary ? deg_from_rad(value) : value; };
    axes.push_back({{"name", axis.name},
                    {"unit", rotary ? "deg" : "mm"},
                    {"min", shown(axis.min)},
                    {"max", shown(axis.max)},
                    {"travel", shown(axis.travel)},
                    {"speed_max", shown(axis.speed_max)},
                    {"accel_max", shown(axis.acceleration_max)},
                    {"jerk_max", shown(axis.jerk_max)},
                    {"time_at_speed_limit_s", axis.time_at_speed_limit_s}});
  }
  return {{"fk_ik_error_max_um", um_from_mm(motion.fk_ik_error_max_mm)},
          {"singular_ticks", motion.singular_ticks},
          {"pole_distance_min_deg", deg_from_rad(motion.pole_distance_min_rad)},
          {"tip_error_max_mm", motion.tip_error_max_mm},
          {"axes", axes}};
}

Json cut_stock_json(const sim::Job& job, const sim::Result& result) {
  const stock::CutStatistics& cut = result.stock->statistics();
  return {{"voxel_mm", job.scene.stock.voxel_mm},
          {"blocks", cut.sweeps},
          {"blocks_resumed", result.cut.resumed_from},
          {"seconds", cut.seconds},
          {"blocks_per_s", cut.seconds > 0.0 ? static_cast<double>(cut.sweeps) / cut.seconds : 0.0},
          {"voxel_updates", cut.voxel_updates},
          {"sweep_error_bound_um", um_from_mm(result.sweep_bound_mm)},
          {"volume_removed_mm3", result.volume_removed_mm3},
          {"volume_left_mm3", result.volume_left_mm3},
          {"volume_error_bound_mm3", result.volume_error_bound_mm3},
          {"hash", fmt::format("{:016x}", result.stock->hash())},
          {"start_hash", fmt::format("{:016x}", result.start_hash)}};
}

/// What earlier set-ups have cut before the program's first sweep; null: there were none.
Json earlier_json(const sim::Job& job, const sim::Result& result) {
  const sim::CarriedCuts& carried = *result.main.carried;
  if (job.earlier.empty()) return nullptr;
  Json names = Json::array();
  for (const std::string& where : carried.stock.where) names.push_back(where);
  return {{"cut", names}, {"blocks", carried.stock.sweeps.size()}, {"cuts", carried.text()}};
}

/// What was there before any cut, where it is no box.
Json raw_json(const stock::RawShape& raw) {
  const Box& box = raw.box();
  const auto corner = [](const Vec3& p) { return Json{p.x(), p.y(), p.z()}; };
  return {{"shape", raw.text()},
          {"volume_mm3", raw.volume_mm3()},
          {"box_mm", {corner(box.lower), corner(box.upper)}}};
}

Json stock_json(const sim::Job& job, const sim::Result& result) {
  Json json = cut_stock_json(job, result);
  json["earlier"] = earlier_json(job, result);
  if (job.scene.stock.shape) json["raw"] = raw_json(*job.scene.stock.shape);
  return json;
}

/// The worst regions with the line of the program that cut them; 0 where no block did.
Json regions_json(const sim::Result& result, const std::vector<measure::Region>& regions) {
  Json list = Json::array();
  const std::vector<sim::SweepSource>& sources = result.main.rays.sources;
  for (const measure::Region& region : regions) {
    int line = 0;
    if (region.block < sources.size()) {
      line = result.main.path.elements.line(static_cast<size_t>(sources[region.block].element));
    }
    list.push_back({{"worst_um", region.worst_um},
                    {"area_mm2", region.area_mm2},
                    {"volume_mm3", region.volume_mm3},
                    {"x_mm", region.place.x()},
                    {"y_mm", region.place.y()},
                    {"z_mm", region.place.z()},
                    {"line", line}});
  }
  return list;
}

/// None: null.
Json ridge_json(const measure::Ridge* ridge) {
  if (ridge == nullptr) return nullptr;
  return {{"height_um", ridge->height_um},
          {"x_mm", ridge->point.x()},
          {"y_mm", ridge->point.y()},
          {"z_mm", ridge->point.z()}};
}

/// The deepest or the highest place of all and where the material ends there; no such place: null.
Json extreme_json(const char* name, double um, const Vec3& end) {
  if (!(um > 0.0)) return nullptr;
  return {{name, um}, {"x_mm", end.x()}, {"y_mm", end.y()}, {"z_mm", end.z()}};
}

/// Not proven: null.
Json bound_json(const std::optional<measure::Bound>& bound) {
  return bound ? Json(bound->um) : Json(nullptr);
}

Json surface_json(const measure::SurfaceMetrics& surface) {
  return {{"area_mm2", surface.area_mm2},
          {"scallop_max_um", surface.scallop_max_um},
          {"scallop_bound_um", bound_json(surface.scallop_bound)},
          {"scallop_mean_um", surface.scallop_mean_um},
          {"scallop_p05_um", surface.scallop_p05_um},
          {"scallop_p95_um", surface.scallop_p95_um},
          {"scallop_theory_um", surface.scallop_theory_um},
          {"ridges", surface.ridges},
          {"gouge_max_um", surface.gouge_max_um},
          {"gouge_bound_um", bound_json(surface.gouge_bound)},
          {"gouge_area_mm2", surface.gouge_area_mm2},
          {"stock_missing_um", surface.missing_max_um},
          {"excess_max_um", surface.excess_max_um},
          {"excess_bound_um", bound_json(surface.excess_bound)},
          {"unmeasured_area_mm2", surface.unmeasured_area_mm2},
          {"within_tolerance_pct", surface.within_tolerance_pct},
          {"samples", surface.samples},
          {"uncut_samples", surface.uncut_samples},
          {"overhung_samples", surface.overhung_samples},
          {"gouge_regions", surface.gouge_regions},
          {"excess_regions", surface.excess_regions}};
}

/// Without a design nothing is measured, and a 0 would read as a perfect part: the names stay, their values
/// are null. Counts are 0.
Json unmeasured(Json values) {
  for (auto& [name, value] : values.items()) {
    if (!value.is_number_integer()) value = nullptr;
  }
  return values;
}

Json comparison_json(const std::vector<sim::ComparisonRow>& rows) {
  Json list = Json::array();
  for (const sim::ComparisonRow& row : rows) {
    list.push_back({{"name", row.name},
                    {"used", row.used},
                    {"passes", row.passes},
                    {"pass_length_mm", row.pass_length_mm},
                    {"link_length_mm", row.link_length_mm},
                    {"time_s", row.time_s},
                    {"feed_error_max_rel", row.feed_error_max_rel},
                    {"chord_error_max_um", um_from_mm(row.chord_error_max_mm)},
                    {"orientation_error_max_deg", deg_from_rad(row.orientation_error_max_rad)},
                    {"surface", surface_json(row.surface)}});
  }
  return list;
}

Json cross_check_json(const std::optional<measure::CrossCheck>& compared) {
  const measure::CrossCheck check = compared.value_or(measure::CrossCheck());
  const Json json = {{"mean_abs_um", check.mean_abs_um}, {"p99_um", check.p99_um}, {"max_um", check.max_um},
                     {"bound_um", check.bound_um},       {"holds", check.holds},   {"samples", check.samples},
                     {"excluded", check.excluded}};
  return compared ? json : unmeasured(json);
}

/// A row of blocks in contact: first and last line, first contact, deepest place.
Json event_json(const toolpath::ToolPath& path, const sim::ContactEvent& event) {
  const auto line = [&](int element) { return path.elements.line(static_cast<size_t>(element)); };
  return {{"part", event.part},
          {"line", line(event.first.element)},
          {"last_line", line(event.last_element)},
          {"t_s", event.first.t_s},
          {"depth_mm", event.depth_mm},
          {"deepest_line", line(event.deepest.element)},
          {"deepest_t_s", event.deepest.t_s},
          {"deepest_mm", {event.deepest_W.x(), event.deepest_W.y(), event.deepest_W.z()}}};
}

Json collisions_json(const sim::Result& result) {
  const sim::ToolClearance& clearance = result.clearance;
  Json json{{"count", clearance.events.size()},
            {"checked_sweeps", clearance.checked_sweeps},
            {"found_from_mm", clearance.sees_mm}};
  // Beyond the band gaps are only known to be larger.
  const bool known = clearance.nearest_mm < clearance.band_mm;
  json["near_miss_min_mm"] = known ? Json(clearance.nearest_mm) : Json(nullptr);
  json["near_miss_above_mm"] = clearance.band_mm;
  json["events"] = Json::array();
  for (const sim::ContactEvent& event : clearance.events)
    json["events"].push_back(event_json(result.main.path, event));
  return json;
}

Json contact_json(const toolpath::ToolPath& path, const std::string& a, const std::string& b,
                  const collision::ContactEvent& event) {
  const auto line = [&](int element) { return path.elements.line(static_cast<size_t>(element)); };
  return {{"a", a},
          {"b", b},
          {"line", line(event.first_element)},
          {"last_line", line(event.last_element)},
          {"t_s", event.first.time_s},
          {"depth_seen_mm", event.depth_mm},
          {"depth_bound_mm", event.depth_bound_mm},
          {"deepest_machine_mm", {event.deepest_M.x(), event.deepest_M.y(), event.deepest_M.z()}},
          {"place_machine_mm", {event.point_a.x(), event.point_a.y(), event.point_a.z()}}};
}

/// One pair of bodies: how near they come, null beyond what is looked for.
Json pair_json(const toolpath::ToolPath& path, const sim::MachineContacts& contacts,
               const collision::PairFindings& pair) {
  const collision::NearMiss& near = pair.near_miss;
  Json json{{"a", contacts.bodies[pair.a].name},
            {"b", contacts.bodies[pair.b].name},
            {"contacts", pair.contact_count()}};
  json["near_miss_mm"] = near.within ? Json(near.upper) : Json(nullptr);
  json["near_miss_bound_mm"] = near.lower;
  json["line"] =
      near.within ? Json(path.elements.line(static_cast<size_t>(near.place.element))) : Json(nullptr);
  json["t_s"] = near.within ? Json(near.place.time_s) : Json(nullptr);
  return json;
}

/// What came to the raw stock, against what was left of it; null: nothing did.
Json stock_contacts_json(const toolpath::ToolPath& path, const sim::MachineContacts& contacts) {
  if (!contacts.as_cut) return nullptr;
  const sim::StockContacts& stock = *contacts.as_cut;
  Json json{{"came_to_raw", stock.suspects},
            {"contacts", stock.count(sim::StockVerdict::kContact)},
            {"open", stock.count(sim::StockVerdict::kOpen)},
            {"gaps_seen_mm", stock.seen_mm},
            {"looks", stock.looks},
            {"events", Json::array()}};
  for (const sim::StockEvent& event : stock.events) {
    const collision::PairFindings& pair = contacts.findings.pairs[event.suspect.pair];
    const auto line = [&](int element) { return path.elements.line(static_cast<size_t>(element)); };
    json["events"].push_back(
        {{"body", contacts.bodies[contacts.beside_stock(pair)].name},
         {"outcome", event.verdict == sim::StockVerdict::kContact ? "contact" : "open"},
         {"line", line(event.first.element)},
         {"last_line", line(event.last_element)},
         {"t_s", event.first.time_s},
         {"depth_seen_mm", event.depth_mm},
         {"place_machine_mm", {event.place_M.x(), event.place_M.y(), event.place_M.z()}}});
    if (event.verdict == sim::StockVerdict::kContact)
      json["events"].back()["first_machine_mm"] = {event.first_M.x(), event.first_M.y(), event.first_M.z()};
  }
  return json;
}

Json machine_contacts_json(const sim::Job& job, const sim::Result& result) {
  if (!result.main.contacts) return nullptr;
  const sim::MachineContacts& contacts = *result.main.contacts;
  Json json{{"count", contacts.contacts() + contacts.stock_contacts()},
            {"stock", stock_contacts_json(result.main.path, contacts)},
            {"near_miss_above_mm", contacts.near_miss_mm},
            {"pairs", Json::array()},
            {"left_out", Json::array()},
            {"without_mesh", contacts.without_mesh},
            {"without_mesh_pairs", Json::array()},
            {"events", Json::array()},
            {"fixtures_cut", Json::array()}};
  for (const auto& [a, b] : contacts.without_mesh_pairs)
    json["without_mesh_pairs"].push_back({{"a", a}, {"b", b}});
  for (const sim::WornFixture& worn : sim::worn_fixtures(job, result))
    json["fixtures_cut"].push_back({{"name", worn.name}, {"removed_mm3", worn.removed_mm3}});
  const collision::PairFindings* const nearest = contacts.nearest();
  json["near_miss_min_mm"] = nearest == nullptr ? Json(nullptr) : Json(nearest->near_miss.upper);
  for (const collision::PairFindings& pair : contacts.findings.pairs) {
    json["pairs"].push_back(pair_json(result.main.path, contacts, pair));
    if (contacts.with_stock(pair)) continue;
    for (const collision::ContactEvent& event : pair.contacts)
      json["events"].push_back(
          contact_json(result.main.path, contacts.bodies[pair.a].name, contacts.bodies[pair.b].name, event));
  }
  for (const collision::LeftOutPair& pair : contacts.findings.left_out) {
    if (pair.reason == collision::PairReason::kRigid) continue;
    json["left_out"].push_back({{"a", contacts.bodies[pair.a].name},
                                {"b", contacts.bodies[pair.b].name},
                                {"reason", collision::text_of(pair.reason)}});
  }
  return json;
}

Json flank_json(const measure::FlankError& flank) {
  Json rows = Json::array();
  for (const measure::FlankRow& row : flank.rows) {
    rows.push_back({{"blocks", row.blocks},
                    {"envelope_error_mm", row.envelope.error_mm},
                    {"u", row.envelope.u},
                    {"v", row.envelope.v}});
  }
  return {
      {"cutter_radius_mm", flank.cutter_radius_mm},       {"psi_max_deg", deg_from_rad(flank.psi_max_rad)},
      {"twist_bound_mm", flank.twist_bound_mm},           {"static_error_mm", flank.standing_error_mm},
      {"continuous_error_mm", flank.continuous.error_mm}, {"rows", rows}};
}

Json checks_json(const std::vector<sim::Check>& checks) {
  Json list = Json::array();
  for (const sim::Check& check : checks) {
    list.push_back({{"name", check.name},
                    {"outcome", sim::outcome_name(check.outcome)},
                    {"unit", check.unit},
                    {"limit", number_or_null(check.limit)},
                    {"value", number_or_null(check.value)},
                    {"bound", number_or_null(check.bound)},
                    {"text", check.what},
                    {"reason", check.reason}});
  }
  return list;
}

Json not_judged_json(const std::vector<sim::Check>& checks) {
  Json list = Json::array();
  for (const sim::Check& check : checks) {
    if (check.outcome == sim::Outcome::kNotJudged)
      list.push_back({{"name", check.name}, {"reason", check.reason}});
  }
  return list;
}

/// A direction without a great circle has no deviation from it: null.
Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json count_or_null(const std::optional<int>& count) {
  return count ? Json(*count) : Json(nullptr);
}

Json circle_json(const toolpath::ToolPath& path, const motion::CircleError& circle) {
  const auto line = [&](int element) { return path.elements.line(static_cast<size_t>(element)); };
  return {{"deviation_circle_max_mm", circle.value_mm},
          {"block_line", line(circle.element)},
          {"u_at_max", circle.u},
          {"chord_mm", circle.chord_mm},
          {"radius_mm", circle.radius_mm},
          {"blocks", circle.blocks()},
          {"first_line", line(circle.first)},
          {"last_line", line(circle.last)}};
}

/// Of the block that linear axes lead farthest from its segment; `law` is the one it runs under.
Json singularity_json(const toolpath::ToolPath& path, const motion::SingularityScan& scan) {
  const motion::BlockSingularity& worst = scan.worst.front();
  const toolpath::Element& element = path.elements[static_cast<size_t>(worst.pole.element)];
  const toolpath::BlockLaw law = std::get<toolpath::BlockMove>(element.what).law;
  const kinematics::TrajectoryError& error = worst.error;
  const int nearest_line = path.elements.line(static_cast<size_t>(scan.nearest.element));
  return {{"circle", scan.circle ? circle_json(path, *scan.circle) : Json(nullptr)},
          {"block_line", element.where.line},
          {"law", toolpath::law_name(law)},
          {"tip_error_mm", law == toolpath::BlockLaw::kJoint ? error.segment.value : 0.0},
          {"deviation_line_max_mm", error.line.value},
          {"u_at_max", error.line.u},
          {"analytic_max_mm", worst.analytic.value},
          {"analytic_u_at_max", worst.analytic.u},
          {"deviation_segment_max_mm", error.segment.value},
          {"segment_u_at_max", error.segment.u},
          {"bound_mm", error.bound_mm},
          {"overshoot_mm", error.beyond.value},
          {"path_length_mm", error.length_mm},
          {"programmed_length_mm", error.chord_mm},
          {"orientation_deviation_max_deg", number_or_null(deg_from_rad(error.orientation_rad))},
          {"outer_axis", scan.outer_axis},
          {"outer_swing_deg", deg_from_rad(worst.pole.outer_swing_rad)},
          {"linearise_tolerance_mm", scan.tolerance_mm},
          {"linearised_blocks", count_or_null(worst.greedy)},
          {"linearised_blocks_equal", count_or_null(worst.equal)},
          {"pole_distance_min_deg", deg_from_rad(scan.nearest.pole_distance_rad)},
          {"pole_block_line", nearest_line},
          {"singular_cone_deg", deg_from_rad(worst.pole.cone_rad)},
          {"blocks", scan.blocks},
          {"blocks_in_cone", scan.in_cone},
          {"rapids_not_measured", scan.rapids},
          {"arcs_not_measured", scan.arcs},
          {"unreachable_not_measured", scan.unreachable}};
}

/// Tools of the scene with the time that each stood in the spindle.
Json tools_json(const sim::Job& job, const sim::Result& result) {
  const std::vector<double> times = time_by_tool(job, result);
  Json list = Json::array();
  for (size_t i = 0; i < times.size(); ++i) {
    const cutter::Cutter& tool = job.scene.tools[i];
    list.push_back({{"number", tool.number},
                    {"name", tool.name},
                    {"cutter", cutter::describe(tool)},
                    {"gauge_length_mm", cutter::gauge_length(tool)},
                    {"time_s", times[i]}});
  }
  return list;
}

Json nc_json(const sim::Job& job, const toolpath::NcReading& nc) {
  Json laws = Json::object();
  for (size_t i = 0; i < nc.feed_moves_by_law.size(); ++i) {
    laws[toolpath::law_name(static_cast<toolpath::BlockLaw>(i))] = nc.feed_moves_by_law.at(i);
  }
  const bool dog_leg = job.machine.model.rapid == kinematics::RapidMotion::kDogLeg;
  return {{"dialect", program::dialect_name(nc.summary.dialect)},
          {"dialect_reason", nc.summary.dialect_reason},
          {"files", nc.summary.files.size()},
          {"lines", nc.summary.lines},
          {"blocks", nc.summary.blocks},
          {"moves", nc.summary.moves},
          {"start", nc.summary.start},
          {"start_tool", nc.summary.start_tool.empty() ? Json() : Json(nc.summary.start_tool)},
          {"feed_moves", laws},
          {"rapids", nc.rapids},
          {"rapid_motion", dog_leg ? "dog_leg" : "linear"},
          {"moves_without_tool", nc.moves_without_tool},
          {"not_simulated", nc.summary.functions}};
}

Json bad_cuts_json(const sim::Result& result) {
  const auto count = [&](bool rapid) {
    const auto& cuts = result.cut.state.bad_cuts;
    return std::count_if(cuts.begin(), cuts.end(), [&](const sim::BadCut& cut) {
      return (cut.kind == sim::BadCutKind::kRapid) == rapid;
    });
  };
  Json events = Json::array();
  for (const sim::BadCut& cut : result.cut.state.bad_cuts) {
    events.push_back(event_json(result.main.path, cut.event));
    events.back()["kind"] = cut.kind == sim::BadCutKind::kRapid           ? "rapid"
                            : cut.kind == sim::BadCutKind::kSpindleStands ? "spindle_stopped"
                                                                          : "spindle_reversed";
  }
  return {{"rapids_in_material", count(true)}, {"spindle_wrong", count(false)}, {"events", events}};
}

/// Null without a budget.
Json budget_json(const sim::Job& job, const sim::Result& result) {
  const double seconds = job.scene.output.budget_s;
  return seconds > 0.0 ? Json{{"seconds", seconds}, {"left_out", result.left_out}} : Json();
}

}  // namespace

std::string json_text(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

std::string metrics_json(const sim::Job& job, const sim::Result& result, const RenderStatistics& render,
                         const avoidance::Outcome* avoidance) {
  const motion::MotionStatistics& motion = result.main.motion.statistics;
  const auto measured = [&](Json values) {
    return job.has_design() ? std::move(values) : unmeasured(std::move(values));
  };
  Json json{{"schema", 1},
            {"swarf", SWARF_VERSION},
            {"scene", job.scene.name},
            {"verdict", sim::passes(result) ? "pass" : "findings"},
            {"verdict_text", sim::verdict_sentence(result.checks)},
            {"checks", checks_json(result.checks)},
            {"not_judged", not_judged_json(result.checks)},
            {"assumptions", assumptions_json(job.scene.assumptions)},
            {"budget", budget_json(job, result)},
            {"motion", motion_json(job, result)},
            {"kinematics", kinematics_json(job, motion)},
            {"stock", stock_json(job, result)},
            {"surface", measured(surface_json(result.main.surface))},
            {"gouges", regions_json(result, result.main.surface.gouges)},
            {"excesses", regions_json(result, result.main.surface.excesses)},
            {"deepest_gouge",
             extreme_json("depth_um", result.main.surface.gouge_max_um, result.main.surface.gouge_bottom)},
            {"highest_material",
             extreme_json("height_um", result.main.surface.excess_max_um, result.main.surface.excess_top)},
            {"highest_ridge", ridge_json(highest_ridge(result))},
            {"cross_check", cross_check_json(result.cross_check)},
            {"planners", comparison_json(result.planners)},
            {"interpolators", comparison_json(result.modes)},
            {"collisions", collisions_json(result)},
            {"machine_contacts", machine_contacts_json(job, result)},
            {"bad_cuts", bad_cuts_json(result)},
            {"tools", tools_json(job, result)},
            {"render", {{"frames", render.frames}, {"frame_ms_median", render.frame_ms_median}}},
            {"self_checks",
             {{"stock_map", result.cut.map_checks},
              {"stock_voxels", result.cut.voxel_checks},
              {"stock_broken", result.cut.broken_invariant}}},
            {"memory_predicted_mb", result.memory.peak_mb},
            {"memory_stock_predicted_mb", result.memory.stock_mb},
            {"memory_peak_mb", peak_memory_mb()}};
  if (result.main.nc) json["program"] = nc_json(job, *result.main.nc);
  if (result.flank) json["flank"] = flank_json(*result.flank);
  if (result.singularity) json["singularity"] = singularity_json(result.main.path, *result.singularity);
  if (result.flank_milling) json["flank_milling"] = flank_milling_json(job, result);
  if (result.driven) json["driven"] = driven_json(result);
  if (avoidance != nullptr) json["avoidance"] = avoidance_json(*avoidance, job);
  return json_text(json);
}

}  // namespace swarf::reports
