#include "sim/job/cutter_keys.h"

#include <algorithm>
#include <utility>

#include "base/units.h"
#include "cutter/profile.h"

namespace swarf::sim {
namespace {

using cutter::Cutter;
using cutter::Shape;

double angle(ConfigTable& table, const char* key, std::optional<double> fallback_deg = {}) {
  return rad_from_deg(table.number(key, {-180.0, 180.0}, fallback_deg));
}

/// Lengths that shape and cutter both ask for: what is wrong with one is told once.
struct SharedLengths {
  ConfigTable& table;
  std::optional<double> read_diameter, read_corner;

  double diameter_mm() {
    if (!read_diameter) read_diameter = table.number("diameter_mm", kAboveZero);
    return *read_diameter;
  }
  double corner_mm() {
    if (!read_corner) read_corner = table.number("corner_radius_mm", kZeroOrMore, 0.0);
    return *read_corner;
  }
};

Shape read_shape(SharedLengths& lengths) {
  const std::vector<std::string> names = cutter::shape_names();
  if (lengths.table.has("shape")) {
    const std::string word = lengths.table.choice("shape", names, names.front());
    return static_cast<Shape>(std::find(names.begin(), names.end(), word) - names.begin());
  }
  const double corner = lengths.corner_mm();
  if (corner == 0.0) return Shape::kFlat;
  return corner == 0.5 * lengths.diameter_mm() ? Shape::kBall : Shape::kBullNose;
}

std::vector<cutter::ProfilePoint> read_profile(ConfigTable& table) {
  std::vector<cutter::ProfilePoint> points;
  for (ConfigTable& corner : table.tables("profile")) {
    const std::vector<double> to = corner.numbers("to_mm", 2);
    points.push_back({{to[0], to[1]}, corner.number("radius_mm", {}, 0.0)});
  }
  return points;
}

/// Diameter, corner radius and flute length, where the shape has them as keys.
void read_lengths(SharedLengths& lengths, Cutter& c) {
  c.diameter_mm = lengths.diameter_mm();
  c.flute_length_mm =
      lengths.table.number(c.shape == Shape::kWoodruff ? "width_mm" : "flute_length_mm", kAboveZero);
  if (c.shape != Shape::kDrill && c.shape != Shape::kChamfer) {
    c.corner_radius_mm = lengths.corner_mm();
  }
}

void read_shape_keys(ConfigTable& table, Cutter& c) {
  switch (c.shape) {
    case Shape::kTaper:
      c.taper_rad = angle(table, "taper_deg");
      return;
    case Shape::kChamfer:
      c.tip_diameter_mm = table.number("tip_diameter_mm", kZeroOrMore, 0.0);
      c.point_angle_rad = angle(table, "point_angle_deg");
      return;
    case Shape::kDrill:
      c.point_angle_rad = angle(table, "point_angle_deg");
      return;
    case Shape::kApt:
      c.alpha_rad = angle(table, "alpha_deg", 0.0);
      c.beta_rad = angle(table, "beta_deg", 0.0);
      if (table.has("corner_centre_mm")) {
        const std::vector<double> centre = table.numbers("corner_centre_mm", 2);
        c.corner_centre_mm = Vec2(centre[0], centre[1]);
      }
      return;
    default:
      return;
  }
}

/// As thick as the end of the flutes, where a shank can be.
std::optional<double> usual_shank(const Cutter& c) {
  if (c.shape == Shape::kWoodruff || c.shape == Shape::kProfile) return std::nullopt;
  const std::optional<cutter::AptForm> form = cutter::apt_form(c);
  const double diameter = form ? 2.0 * form->flank_end().x() : c.diameter_mm;
  return diameter > 0.0 ? diameter : c.diameter_mm;
}

std::vector<cutter::ToolSection> read_holder(ConfigTable& table) {
  cutter::ToolSection plain;
  if (!table.has("holder")) {
    plain.diameter_mm = table.number("holder_diameter_mm", kAboveZero, plain.diameter_mm);
    plain.top_diameter_mm = plain.diameter_mm;
    plain.length_mm = table.number("holder_length_mm", kAboveZero, plain.length_mm);
    return {plain};
  }
  std::vector<cutter::ToolSection> sections;
  for (ConfigTable& entry : table.tables("holder")) {
    cutter::ToolSection section;
    section.diameter_mm = entry.number("diameter_mm", kAboveZero);
    section.top_diameter_mm = entry.number("top_diameter_mm", kAboveZero, section.diameter_mm);
    section.length_mm = entry.number("length_mm", kAboveZero);
    sections.push_back(section);
  }
  return sections;
}

void read_tool_above(ConfigTable& table, Cutter& c) {
  c.length_mm = table.number("length_mm", kAboveZero);
  c.shank_diameter_mm = table.number("shank_diameter_mm", kAboveZero, usual_shank(c));
  if (table.has("neck_diameter_mm") || table.has("neck_length_mm")) {
    c.neck_diameter_mm = table.number("neck_diameter_mm", kAboveZero);
    c.neck_length_mm = table.number("neck_length_mm", kAboveZero);
  }
  c.holder = read_holder(table);
  if (table.has("gauge_length_mm")) c.gauge_length_mm = table.number("gauge_length_mm", kAboveZero);
}

void read_hand(ConfigTable& table, Cutter& c) {
  c.left_hand = table.choice("hand", {"right", "left"}, "right") == "left";
}

/// Whether a key that the shape needs is missing or no such number, which has been told: it reads as 0.
bool lacks_key(const ConfigTable& table, const Cutter& c) {
  if (c.length_mm == 0.0) return true;
  if (c.shape == Shape::kProfile) return false;
  const bool point = c.shape == Shape::kDrill || c.shape == Shape::kChamfer;
  return c.diameter_mm == 0.0 || c.flute_length_mm == 0.0 || (point && !table.has("point_angle_deg")) ||
         (c.shape == Shape::kTaper && !table.has("taper_deg"));
}

Cutter read_body(ConfigTable& table, Cutter c, const std::string& what) {
  SharedLengths lengths{table, {}, {}};
  c.shape = read_shape(lengths);
  if (c.shape == Shape::kProfile) {
    cutter::set_profile(c, read_profile(table));
  } else {
    read_lengths(lengths, c);
    read_shape_keys(table, c);
  }
  read_tool_above(table, c);
  read_hand(table, c);
  if (lacks_key(table, c)) return c;
  for (const cutter::Problem& problem : cutter::validate(c)) {
    table.error(
        "bad-cutter", problem.key, what + ": " + problem.text,
        problem.key == "profile"
            ? "profile = [{ to_mm = [0, 0] }, { to_mm = [5, 0] }, { to_mm = [5, 20] }] is a flat end; "
              "radius_mm makes a line an arc, below 0 a hollow one"
            : "mend this number, or what it is compared with");
  }
  return c;
}

}  // namespace

Cutter read_cutter(ConfigTable table) {
  Cutter c;
  c.number = table.integer("number", 0, 99999, 1);
  c.name = table.text("name", "");
  return read_body(table, std::move(c), "[cutter]");
}

Cutter read_tool(ConfigTable table) {
  Cutter c;
  c.number = table.integer("number", 0, 99999, 0);
  c.name = table.text("name", "");
  const std::string what = "[[tool]] " + cutter::call_name(c);
  return read_body(table, std::move(c), what);
}

}  // namespace swarf::sim
