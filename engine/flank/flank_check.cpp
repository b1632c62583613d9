#include "flank/flank_check.h"

#include <fmt/format.h>

#include <cmath>

#include "base/minima.h"
#include "flank/flank_proof.h"
#include "surface/curvature.h"

namespace swarf::flank {
namespace {

constexpr int kRulings = 256;
constexpr int kPlaces = 8;
constexpr double kNoLength = 1e-9;

std::string place_of(const surface::Surface& S, double u, double v) {
  const Vec3 p = S.point(u, v);
  return fmt::format("u = {:.4f}, v = {:.3f}, ({:.3f}, {:.3f}, {:.3f}) mm", u, v, p.x(), p.y(), p.z());
}

/// Both ends of every ruling; Su x Sv is linear in v, so nothing between them escapes.
bool check_rulings(const FlankTask& task, const SourceLocation& where, Diagnostics& diagnostics) {
  const surface::Surface& S = *task.surface;
  for (int i = 0; i <= kRulings; ++i) {
    const double u = task.u_low + (task.u_high - task.u_low) * i / kRulings;
    const surface::Derivatives a = S.derivatives(u, 0.0), b = S.derivatives(u, 1.0);
    if (a.Sv.norm() < kNoLength || a.Su.norm() < kNoLength || b.Su.norm() < kNoLength) {
      diagnostics.error(
          "no-ruling", where,
          fmt::format("{} has no length at {}", a.Sv.norm() < kNoLength ? "the ruling" : "a guide curve",
                      place_of(S, u, a.Su.norm() < kNoLength ? 0.0 : 1.0)),
          "flank milling needs two curves that never meet and never stand still");
      return false;
    }
    const Vec3 w0 = a.Su.cross(a.Sv), w1 = b.Su.cross(b.Sv);
    if (w0.dot(w1) > kNoLength * w0.norm() * w1.norm()) continue;
    diagnostics.error(
        "guides-opposed", where,
        fmt::format("the surface turns over along its ruling at {}: its normals at both ends differ by 90 "
                    "deg or more",
                    place_of(S, u, 0.5)),
        "let both guide curves run the same way and pair their points so that rulings do not cross");
    return false;
  }
  return true;
}

/// What 257 rulings have not shown.
void prove_rulings(const FlankTask& task, const SourceLocation& where, Diagnostics& diagnostics) {
  const std::optional<WeakPlace> weak = turned_ruling(task);
  if (!weak) return;
  const std::string place = place_of(*task.surface, weak->u, weak->v);
  if (weak->shown)
    diagnostics.error(
        "guides-opposed", where,
        fmt::format("the surface turns over along its ruling at {}, between rulings where it does "
                    "not",
                    place),
        "let both guide curves run the same way and pair their points so that rulings do not cross");
  else
    diagnostics.error("flank-not-proven", where,
                      fmt::format("near {} it cannot be shown that the surface does not turn over along its "
                                  "rulings",
                                  place),
                      "guide curves without cusps, whose normals stay well within 90 deg of each other");
}

/// Up to where a flank must reach at u, mm above the tip.
double needed_reach(const FlankTask& task, double u) {
  const ToolPose pose = pose_at(task, u);
  const surface::Surface& S = *task.surface;
  const surface::Derivatives d = S.derivatives(u, 1.0);
  const Vec3 normal = surface::outward_normal(S, d);
  const Vec3 upper = d.S + ball_radius(task.profile, task.profile.high) * normal;
  return (upper - pose.tip_W).dot(pose.axis_W);
}

void check_reach(const FlankTask& task, const SourceLocation& where, Diagnostics& diagnostics) {
  const Minimum most = greatest_sampled([&](double u) { return needed_reach(task, u); }, 0.0, 1.0, kRulings);
  const double needed = most.value, at = most.at;
  if (needed <= task.profile.high) return;
  diagnostics.error(
      "cutter-too-short", where,
      fmt::format("the flank reaches {:.3f} mm up from the tip, the ruling at {} needs {:.3f} mm",
                  task.profile.high, place_of(*task.surface, at, 1.0), needed),
      fmt::format("a cutter with flutes {:.3f} mm longer, or flank.tip_below_mm smaller",
                  needed - task.profile.high));
}

/// What the places looked at have not shown.
void prove_hollows(const FlankTask& task, const SourceLocation& where, Diagnostics& diagnostics) {
  const std::optional<WeakPlace> weak = narrow_place(task);
  if (!weak) return;
  const std::string place = place_of(*task.surface, weak->u, weak->v);
  diagnostics.error(
      "cutter-too-large", where,
      fmt::format("{} {:.3f} mm at {}, the cutter has {:.3f} mm there",
                  weak->shown ? "the surface is hollow with radius"
                              : "it cannot be shown that the surface is less hollow than with radius",
                  weak->hollow_mm, place, weak->cutter_mm),
      fmt::format("a radius below {:.3f} mm fits", weak->hollow_mm));
}

void check_hollows(const FlankTask& task, const SourceLocation& where, Diagnostics& diagnostics) {
  const surface::Surface& S = *task.surface;
  double least_room = 0.0, fits = 0.0, is = 0.0, at_u = 0.0, at_v = 0.0;
  for (int i = 0; i <= kRulings; ++i) {
    for (int j = 0; j <= kPlaces; ++j) {
      const double u = static_cast<double>(i) / kRulings, v = static_cast<double>(j) / kPlaces;
      const surface::Derivatives d = S.derivatives(u, v);
      const surface::Shape shape = surface::shape_at(d, S.outward_sign());
      const Vec2 across = shape.in_tangent(shape.normal.cross(d.Sv).normalized());
      const double concave = -surface::normal_curvature(shape, across);
      if (concave <= 0.0) continue;
      const double radius = ball_radius(task.profile, task.tip_below_mm + v * d.Sv.norm());
      const double room = 1.0 / concave - radius;
      if (room >= least_room) continue;
      least_room = room, fits = 1.0 / concave, is = radius, at_u = u, at_v = v;
    }
  }
  if (least_room >= 0.0) return prove_hollows(task, where, diagnostics);
  diagnostics.error("cutter-too-large", where,
                    fmt::format("the surface is hollow with radius {:.3f} mm at {}, the cutter has {:.3f} mm "
                                "there",
                                fits, place_of(S, at_u, at_v), is),
                    fmt::format("a radius below {:.3f} mm fits", fits));
}

}  // namespace

void check_task(const FlankTask& task, const SourceLocation& where, Diagnostics& diagnostics) {
  if (!check_rulings(task, where, diagnostics)) return;
  prove_rulings(task, where, diagnostics);
  if (diagnostics.has_errors()) return;
  check_hollows(task, where, diagnostics);
  if (!diagnostics.has_errors()) check_reach(task, where, diagnostics);
}

}  // namespace swarf::flank
