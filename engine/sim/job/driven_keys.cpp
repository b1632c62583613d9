#include "sim/job/driven_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/units.h"

namespace swarf::sim {
namespace {

toolpath::GuideMode mode_of(const std::string& word) {
  if (word == "contour") return toolpath::GuideMode::kContour;
  if (word == "spiral") return toolpath::GuideMode::kSpiral;
  if (word == "guide") return toolpath::GuideMode::kGuide;
  return toolpath::GuideMode::kScan;
}

void read_area(ConfigTable& table, DrivenSettings& driven) {
  const std::vector<Vec2> corners = table.flat_points("area_mm");
  driven.area_said = true;
  if (corners.size() == 2 && (corners[1] - corners[0]).minCoeff() > 0.0) {
    driven.plan.area = {corners[0], corners[1]};
    return;
  }
  table.error("out-of-range", "area_mm", "'area_mm' is no rectangle",
              "write its lower and its upper corner: area_mm = [[-20, -10], [20, 10]]");
}

void read_spiral(ConfigTable& table, toolpath::DrivenPlan& plan) {
  const std::vector<double> centre = table.numbers("centre_mm", 2);
  const std::vector<double> radius = table.numbers("radius_mm", 2);
  if (centre.size() == 2) plan.centre = {centre[0], centre[1]};
  if (radius.size() != 2) return;
  plan.radius_from_mm = radius[0];
  plan.radius_to_mm = radius[1];
  if (radius[0] < 0.0 || radius[1] < 0.0 || radius[0] + radius[1] <= 0.0)
    table.error("out-of-range", "radius_mm", fmt::format("'radius_mm' is [{:g}, {:g}]", radius[0], radius[1]),
                "write the radius that the spiral begins with and the one that it ends with");
}

/// A fixed axis, or one that follows the part with lead and tilt.
void read_axis(ConfigTable& table, toolpath::DrivenPlan& plan) {
  constexpr Range kLean{-89.0, 89.0};
  plan.follows = table.has("lead_deg") || table.has("tilt_deg");
  plan.lead_rad = rad_from_deg(plan.follows ? table.number("lead_deg", kLean, 0.0) : 0.0);
  plan.tilt_rad = rad_from_deg(plan.follows ? table.number("tilt_deg", kLean, 0.0) : 0.0);
  if (plan.follows) plan.axis_smooth_mm = table.number("axis_smooth_mm", kAboveZero, 4.0);
  if (!table.has("axis")) return;
  if (plan.follows)
    table.error("two-axes", "axis", "the tool cannot keep 'axis' and follow the part with lead and tilt",
                "keep 'axis', or 'lead_deg' and 'tilt_deg'");
  const std::vector<double> axis = table.numbers("axis", 3);
  if (axis.size() != 3) return;
  const Vec3 given(axis[0], axis[1], axis[2]);
  if (given.norm() > 0.0)
    plan.axis_W = given.normalized();
  else
    table.error("out-of-range", "axis", "'axis' has no length",
                "write the way from the tip to the spindle: [0, 0, 1]");
}

void read_file(ConfigTable& table, DrivenSettings& driven) {
  const char* named = nullptr;
  for (const char* key : {"mesh", "step", "surface", "by_design"}) {
    if (!table.has(key)) continue;
    if (named != nullptr)
      table.error("two-parts", named, fmt::format("the scene names a {} and a {} as its part", named, key),
                  "keep one of them");
    else
      named = key;
  }
  const std::string key = named == nullptr ? "surface" : named;
  driven.mesh = key == "mesh";
  driven.step = key == "step";
  driven.by_design = key == "by_design" && table.boolean(key, true);
  if (key != "by_design") driven.file = table.text(key);
  if (driven.step)
    driven.chord_mm = table.number("chord_um", kAboveZero, um_from_mm(driven.chord_mm)) * kMicrometre;
}

/// What an operator does during the run: pass, seconds since it began, per cent of the feed.
void read_override(ConfigTable& table, toolpath::DrivenPlan& plan) {
  constexpr double kMostShare = 2.0;
  for (const Vec3& row : table.points("override")) {
    const toolpath::OverrideChange change{static_cast<int>(row.x()) - 1, row.y(), 0.01 * row.z()};
    const bool sound = row.x() == std::floor(row.x()) && row.x() >= 1.0 && row.y() >= 0.0 &&
                       change.share >= 0.0 && change.share <= kMostShare;
    if (!sound) {
      table.error(
          "out-of-range", "override",
          fmt::format("'override' has the row [{:g}, {:g}, {:g}]", row.x(), row.y(), row.z()),
          "write pass (from 1), seconds since it began, per cent of the feed from 0 to 200: [3, 0.2, 50]");
      return;
    }
    plan.overrides.push_back(change);
  }
  std::stable_sort(plan.overrides.begin(), plan.overrides.end(),
                   [](const auto& a, const auto& b) { return a.at_s < b.at_s; });
  std::map<int, double> last;
  for (const toolpath::OverrideChange& change : plan.overrides) last[change.pass] = change.share;
  for (const auto& [pass, share] : last) {
    if (share > 0.0) continue;
    table.error("feed-held", "override", fmt::format("pass {} is held and never goes on", pass + 1),
                "write a later row of the pass with more than 0 %");
  }
}

/// Two tolerances, as the paper's comparison has them.
void read_comparison(ConfigTable& table, DrivenSettings& driven) {
  for (const double um : table.numbers("compare_cam_um", 2)) {
    if (um > 0.0)
      driven.compare_mm.push_back(um * kMicrometre);
    else
      table.error("out-of-range", "compare_cam_um", fmt::format("a tolerance of {:g} um", um),
                  "write two above 0: compare_cam_um = [10, 1]");
  }
}

}  // namespace

DrivenSettings read_driven(ConfigTable table) {
  DrivenSettings driven;
  toolpath::DrivenPlan& plan = driven.plan;
  driven.where = table.where("mode");
  read_file(table, driven);
  plan.mode = mode_of(table.choice("mode", {"scan", "contour", "spiral", "guide"}, "scan"));
  const bool one_curve = plan.mode == toolpath::GuideMode::kGuide;
  if (!one_curve) plan.interval_mm = table.number("interval_mm", kAboveZero);
  plan.feed_mm_s = mm_s_from_mm_min(table.number("feed_mm_min", kAboveZero));
  plan.spindle_rpm = table.number("spindle_rpm", kZeroOrMore, 0.0);
  plan.chord_tolerance_mm = table.number("chord_tolerance_um", kAboveZero, 0.1) * kMicrometre;
  if (plan.mode == toolpath::GuideMode::kScan) {
    plan.angle_rad = rad_from_deg(table.number("angle_deg", {-180.0, 180.0}, 0.0));
    plan.zigzag = table.boolean("zigzag", true);
  }
  if (plan.mode == toolpath::GuideMode::kSpiral) read_spiral(table, plan);
  if (one_curve) plan.guide = table.flat_points("guide_mm");
  if (table.has("area_mm")) read_area(table, driven);
  if (table.has("floor_mm")) driven.floor_mm = table.number("floor_mm", {});
  read_axis(table, plan);
  plan.cam_tolerance_mm = table.number("cam_tolerance_um", kZeroOrMore, 0.0) * kMicrometre;
  plan.safe_distance_mm = table.number("safe_distance_mm", kAboveZero, plan.safe_distance_mm);
  plan.rapid_clearance_mm = table.number("rapid_clearance_mm", kAboveZero, plan.rapid_clearance_mm);
  if (table.has("compare_cam_um")) read_comparison(table, driven);
  if (table.has("override")) read_override(table, plan);
  return driven;
}

}  // namespace swarf::sim
