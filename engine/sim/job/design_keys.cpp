#include "sim/job/design_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "base/units.h"
#include "brep/model.h"
#include "sim/job/mesh_unit.h"
#include "sim/job/ruled_faces.h"
#include "surface/analytic.h"
#include "surface/nurbs.h"
#include "surface/polynomial.h"

namespace swarf::sim {
namespace {

constexpr Range kBelowRightAngle{-89.0, 89.0, false};

Vec3 read_vector(ConfigTable& table, const std::string& key,
                 const std::optional<std::vector<double>>& fallback = {}) {
  const std::vector<double> v = table.numbers(key, 3, fallback);
  return v.size() == 3 ? Vec3(v[0], v[1], v[2]) : Vec3::Zero();
}

/// Two rising numbers strictly inside (low, high) where asked for; {0, 1} after a complaint.
std::array<double, 2> read_interval(ConfigTable& table, const std::string& key, double low, double high,
                                    const std::optional<std::vector<double>>& fallback = {}) {
  const std::vector<double> v = table.numbers(key, 2, fallback);
  if (v.size() == 2 && v[0] < v[1] && v[0] >= low && v[1] <= high) return {v[0], v[1]};
  if (v.size() == 2) {
    table.error("out-of-range", key, fmt::format("'{}' is [{:g}, {:g}]", key, v[0], v[1]),
                fmt::format("write two rising numbers from {:g} to {:g}", low, high));
  }
  return {0.0, 1.0};
}

surface::MaterialSide read_side(ConfigTable& table) {
  const bool convex = table.choice("side", {"convex", "concave"}) != "concave";
  return convex ? surface::MaterialSide::kConvex : surface::MaterialSide::kConcave;
}

surface::Turn read_turn(ConfigTable& table, const std::string& base_key) {
  surface::Turn turn;
  turn.base_W = read_vector(table, base_key);
  const Vec3 axis = read_vector(table, "axis", std::vector<double>{0.0, 0.0, 1.0});
  if (axis.norm() > 0.0) {
    turn.axis_W = axis.normalized();
  } else {
    table.error("out-of-range", "axis", "'axis' has no direction", "write for example [0, 0, 1]");
  }
  const auto angle = read_interval(table, "angle_deg", -360.0, 360.0, std::vector<double>{0.0, 360.0});
  turn.from_rad = rad_from_deg(angle[0]);
  turn.to_rad = rad_from_deg(angle[1]);
  return turn;
}

surface::SurfacePtr read_plane(ConfigTable& table) {
  const Vec3 origin = read_vector(table, "origin_mm");
  const Vec3 along_u = read_vector(table, "along_u_mm"), along_v = read_vector(table, "along_v_mm");
  if (along_u.cross(along_v).norm() <= 1e-9 * along_u.norm() * along_v.norm()) {
    table.error("out-of-range", "along_u_mm", "'along_u_mm' and 'along_v_mm' span no plane",
                "give two edges of the face; their cross product points out of the material");
    return nullptr;
  }
  return std::make_shared<surface::PlaneSurface>(origin, along_u, along_v);
}

surface::SurfacePtr read_cone(ConfigTable& table, bool cylinder) {
  const surface::Turn turn = read_turn(table, "base_mm");
  const surface::MaterialSide side = read_side(table);
  const double radius = table.number(cylinder ? "radius_mm" : "base_radius_mm", kAboveZero);
  const double height = table.number("height_mm", kAboveZero);
  const double angle = cylinder ? 0.0 : rad_from_deg(table.number("half_angle_deg", kBelowRightAngle));
  if (radius <= 0.0 || height <= 0.0) return nullptr;
  if (radius - height * std::tan(angle) <= 0.0) {
    table.error("out-of-range", "height_mm", "the cone ends in its apex before this height",
                fmt::format("height_mm must be below {:.6g}", radius / std::tan(angle)));
    return nullptr;
  }
  return surface::cone_surface(turn, radius, angle, height, side);
}

surface::SurfacePtr read_sphere(ConfigTable& table) {
  const surface::Turn turn = read_turn(table, "centre_mm");
  const surface::MaterialSide side = read_side(table);
  const double radius = table.number("radius_mm", kAboveZero);
  auto polar = read_interval(table, "polar_deg", 0.0, 180.0);
  if (radius <= 0.0) return nullptr;
  // At a pole itself a normal cannot be taken from the parameters. Its nearest line of rays stands this far
  // from it: on a sphere of a metre that leaves out a cap of 2 um.
  constexpr double kNearestPole = 1e-4;  // deg
  for (double& angle : polar) angle = std::clamp(angle, kNearestPole, 180.0 - kNearestPole);
  return surface::sphere_surface(turn, radius, rad_from_deg(polar[0]), rad_from_deg(polar[1]), side);
}

surface::SurfacePtr read_hyperboloid(ConfigTable& table) {
  const surface::Turn turn = read_turn(table, "base_mm");
  surface::Hyperboloid shape;
  shape.distance = table.number("distance_mm", kAboveZero);
  shape.skew_rad = rad_from_deg(table.number("skew_deg", kBelowRightAngle));
  shape.cutter_radius = table.number("cutter_radius_mm", kAboveZero);
  const auto z = read_interval(table, "z_mm", -1e6, 1e6);
  if (shape.distance <= 0.0 || shape.cutter_radius <= 0.0 || !(z[0] < z[1])) return nullptr;  // said above
  if (shape.distance <= shape.cutter_radius) {
    table.error("out-of-range", "distance_mm", "the cutter reaches the axis: no core is left",
                "distance_mm must be above cutter_radius_mm");
    return nullptr;
  }
  return surface::hyperboloid_surface(turn, shape, z[0], z[1]);
}

/// A place of S where Su x Sv vanishes, on a grid that holds both guide curves.
bool has_normals(const surface::Surface& S) {
  constexpr int kNodes = 64;
  for (int i = 0; i <= kNodes; ++i) {
    for (const double v : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const surface::Derivatives d = S.derivatives(static_cast<double>(i) / kNodes, v);
      if (d.Su.cross(d.Sv).norm() <= 1e-9 * d.Su.norm() * d.Sv.norm()) return false;
    }
  }
  return true;
}

/// S(u,v) = (1-v) C0(u) + v C1(u), C0 and C1 polynomials in u.
surface::SurfacePtr read_ruled(ConfigTable& table) {
  std::vector<Vec3> c0 = table.points("guide0_mm"), c1 = table.points("guide1_mm");
  const bool out = table.choice("outward", {"u_cross_v", "v_cross_u"}) != "v_cross_u";
  if (c0.empty() || c1.empty()) return nullptr;
  const size_t count = std::max(c0.size(), c1.size());
  c0.resize(count, Vec3::Zero());
  c1.resize(count, Vec3::Zero());
  std::vector<Vec3> coefficients;
  for (size_t i = 0; i < count; ++i) {
    coefficients.push_back(c0[i]);
    coefficients.emplace_back(c1[i] - c0[i]);
  }
  auto ruled = std::make_shared<surface::PolynomialSurface>(static_cast<int>(count) - 1, 1,
                                                            std::move(coefficients), out ? 1 : -1);
  if (has_normals(*ruled)) return ruled;
  table.error("out-of-range", "guide1_mm", "the ruled surface has a place without a normal",
              "the guide curves must not stand still, meet, or run along their rulings");
  return nullptr;
}

/// A normal, or its limit where an edge has collapsed, everywhere on a grid that holds the edges.
bool has_limits(const surface::Surface& S) {
  constexpr int kNodes = 32;
  for (int n = 0; n < (kNodes + 1) * (kNodes + 1); ++n) {
    const Vec2 uv(static_cast<double>(n % (kNodes + 1)) / kNodes,
                  static_cast<double>(n / (kNodes + 1)) / kNodes);
    const surface::Derivatives d = S.derivatives(uv.x(), uv.y());
    if (surface::outward_normal(S, d, uv).norm() < 0.5) return false;
  }
  return true;
}

/// Two whole numbers from 1 on; {} after a complaint.
std::optional<std::array<int, 2>> read_pair(ConfigTable& table, const std::string& key, int least, int most) {
  const std::vector<double> v = table.numbers(key, 2);
  if (v.size() != 2) return {};
  for (const double x : v) {
    if (x == std::floor(x) && x >= least && x <= most) continue;
    table.error("out-of-range", key, fmt::format("'{}' is [{:g}, {:g}]", key, v[0], v[1]),
                fmt::format("write two whole numbers from {} to {}: along u, along v", least, most));
    return {};
  }
  return std::array<int, 2>{static_cast<int>(v[0]), static_cast<int>(v[1])};
}

/// A NURBS surface by degrees, numbers of poles, knots, poles and weights.
std::vector<surface::SurfacePtr> read_nurbs(ConfigTable& table) {
  constexpr int kMostPoles = 10000;
  const auto degree = read_pair(table, "degree", 1, surface::kMostNurbsDegree);
  const auto count = read_pair(table, "count", 2, kMostPoles);
  surface::NurbsData data;
  data.outward_sign = table.choice("outward", {"u_cross_v", "v_cross_u"}) != "v_cross_u" ? 1 : -1;
  data.poles = table.points("poles_mm");
  if (!degree || !count) return {};
  data.degree_u = (*degree)[0];
  data.degree_v = (*degree)[1];
  data.knots_u = table.numbers("knots_u", static_cast<size_t>((*count)[0] + data.degree_u + 1));
  data.knots_v = table.numbers("knots_v", static_cast<size_t>((*count)[1] + data.degree_v + 1));
  if (table.has("weights")) data.weights = table.numbers("weights", data.poles.size());
  if (data.poles.empty() || data.knots_u.empty() || data.knots_v.empty()) return {};  // said above
  const std::vector<std::string> problems = surface::nurbs_problems(data);
  for (const std::string& problem : problems)
    table.error("nurbs", "poles_mm", problem, "poles_mm in rows along v, one for each pole along u");
  if (!problems.empty()) return {};
  std::vector<surface::SurfacePtr> parts;
  for (const surface::NurbsPart& part : surface::smooth_parts(data)) {
    parts.push_back(part.surface);
    if (has_limits(*part.surface)) continue;
    table.error("out-of-range", "poles_mm", "the NURBS surface has a place without a normal",
                "rows and columns of poles must not run along each other");
    return {};
  }
  return parts;
}

surface::SurfacePtr read_analytic(ConfigTable& table, const std::string& kind) {
  if (kind == "plane") return read_plane(table);
  if (kind == "sphere") return read_sphere(table);
  if (kind == "hyperboloid") return read_hyperboloid(table);
  if (kind == "ruled") return read_ruled(table);
  return read_cone(table, kind == "cylinder");
}

}  // namespace

DesignSettings read_design(ConfigTable table, bool cl) {
  DesignSettings design;
  design.mesh_where = table.where();
  design.pitch_given = table.has("pitch_mm");
  design.pitch_mm = table.number("pitch_mm", kAboveZero, design.pitch_mm);
  if (!cl) return design;
  // A file says what it is for.
  const char* const open = table.has("mesh")      ? "mesh"
                           : table.has("step")    ? "step"
                           : table.has("surface") ? "surface"
                                                  : "none";
  design.name = table.choice("kind",
                             {"none", "surface", "plane", "cylinder", "cone", "sphere", "hyperboloid",
                              "ruled", "nurbs", "mesh", "step", "ruled_faces"},
                             open);
  if (design.name == "none" || design.name.empty()) {
    design.kind = DesignKind::kNone;
    return design;
  }
  design.sweep_tolerance_mm =
      table.number("sweep_tolerance_um", kAboveZero, um_from_mm(design.sweep_tolerance_mm)) * kMicrometre;
  if (design.name == "ruled_faces") {
    read_ruled_faces(table, design);
    return design;
  }
  if (design.name == "mesh" || design.name == "step") {
    design.kind = DesignKind::kMesh;
    design.mesh_file = table.text(design.name);
    design.mesh_where = table.where(design.name);
    // A CAD file is one by its name, whatever key it stands behind.
    if (brep::is_cad_file(design.mesh_file)) design.name = "step";
    design.mesh_key = design.name;
    design.placement = read_placement(table);
    if (design.name == "mesh") {
      const std::string unit = table.choice("mesh_unit", {"mm", "inch", "m"}, "mm");
      if (table.has("mesh_unit")) design.mesh_unit_mm = unit_mm_of(unit);
      refuse_second_unit(table, design.mesh_file);
    }
    if (design.name == "step")
      design.chord_mm = table.number("chord_um", kAboveZero, um_from_mm(design.chord_mm)) * kMicrometre;
    return design;
  }
  if (design.name == "surface") {
    design.kind = DesignKind::kSurface;
    design.surface_file = table.text("surface");
    return design;
  }
  design.kind = DesignKind::kAnalytic;
  if (design.name == "nurbs") {
    design.surfaces = read_nurbs(table);
  } else {
    design.surfaces.push_back(read_analytic(table, design.name));
  }
  return design;
}

}  // namespace swarf::sim
