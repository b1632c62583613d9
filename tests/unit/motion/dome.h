// What the motion tests run on: DOME (theory 1.6), the curve of Eq. (8), the paper's machine (theory 1.5).
#pragma once

#include <memory>

#include "base/units.h"
#include "kinematics/machine_model.h"
#include "surface/polynomial.h"
#include "toolpath/tool_path.h"

namespace swarf::motion {

inline surface::SurfacePtr dome() {
  std::vector<Vec3> a(9, Vec3::Zero());
  a[0] = {-50, -40, 0};
  a[3] = {100, 0, 80};
  a[6] = {0, 0, -80};
  a[1] = {0, 80, 60};
  a[2] = {0, 0, -60};
  return std::make_shared<surface::PolynomialSurface>(2, 2, a, 1);
}

/// The curve of Eq. (8) in the plane z = 0 of a cylinder along z.
inline surface::SurfacePtr cylinder_of_eq8() {
  std::vector<Vec3> a(8, Vec3::Zero());
  a[0] = {10, 0, 0};
  a[2] = {0, 10, 0};
  a[4] = {10, 10, 0};
  a[6] = {10, 0, 0};
  a[1] = {0, 0, 10};
  return std::make_shared<surface::PolynomialSurface>(3, 1, a, 1);
}

/// A pass along u at constant v.
inline toolpath::SurfacePass iso_pass(surface::SurfacePtr surface, double v, double feed_mm_s) {
  toolpath::SurfacePass pass;
  pass.surface = std::move(surface);
  pass.curve = {true, CubicSpline::constant(v)};
  pass.feed_mm_s = feed_mm_s;
  return pass;
}

/// X = Rx(a){Rz(b)(P + R) + T}: both tables turn positively, R = (8,0,0), T = (0,96,120); XYZ move the head.
inline kinematics::MachineModel paper_machine() {
  using kinematics::Axis;
  using kinematics::AxisKind;
  using kinematics::Side;
  const double deg = rad_from_deg(1.0);
  const auto linear = [](const char* name, const Vec3& direction) {
    return Axis{
        name, AxisKind::kLinear, Side::kHead, direction, Vec3::Zero(), false, -500, 500, 500, 5000, 1e5, 0};
  };
  kinematics::MachineModel machine;
  machine.name = "paper";
  machine.axes = {linear("X", Vec3::UnitX()), linear("Y", Vec3::UnitY()), linear("Z", Vec3::UnitZ()),
                  Axis{"A", AxisKind::kRotary, Side::kTable, Vec3::UnitX(), Vec3::Zero(), true, -100 * deg,
                       100 * deg, 120 * deg, 1000 * deg, 2e4 * deg, 0},
                  Axis{"B", AxisKind::kRotary, Side::kTable, Vec3::UnitZ(), Vec3(0, 96, 120), true,
                       -3600 * deg, 3600 * deg, 180 * deg, 1500 * deg, 3e4 * deg, 0}};
  machine.table_chain = {3, 4};
  machine.head_chain = {0, 1, 2};
  machine.X_MW.translation() = Vec3(8, 96, 120);
  return machine;
}

inline ToolPose end_pose(const toolpath::SurfacePass& pass, double t, double radius) {
  const toolpath::CurvePoint at = curve_at(*pass.surface, pass.curve, t);
  const double direction = pass.t_end > pass.t_start ? 1.0 : -1.0;
  return toolpath::pose_in_contact(at.C, outward_normal(*pass.surface, at.surface),
                                   direction * at.dC.normalized(), pass.lead_rad, pass.tilt_rad, {radius});
}

/// Rapid, approach, pass, retract for each pass, with straight rapids between them.
inline toolpath::ToolPath path_of(const std::vector<toolpath::SurfacePass>& passes, double radius) {
  toolpath::ToolPath path;
  const auto lifted = [](ToolPose pose, double by) {
    pose.tip_W += by * pose.axis_W;
    return pose;
  };
  // Above the start of the first pass, not at the pole: there the rotary would have to turn at once.
  ToolPose at = lifted(end_pose(passes.front(), passes.front().t_start, radius), 60);
  const SourceLocation where{"test.nc", 11, 1};
  using toolpath::FreeMove;
  using toolpath::MoveKind;
  for (const toolpath::SurfacePass& pass : passes) {
    const ToolPose start = end_pose(pass, pass.t_start, radius);
    const ToolPose end = end_pose(pass, pass.t_end, radius);
    path.elements.push_back({FreeMove{MoveKind::kRapid, at, lifted(start, 20), 0.0}, 0, where});
    path.elements.push_back(
        {FreeMove{MoveKind::kApproach, lifted(start, 20), start, 0.5 * pass.feed_mm_s}, 0, where});
    path.elements.push_back({pass, 0, where});
    at = lifted(end, 20);
    path.elements.push_back({FreeMove{MoveKind::kRetract, end, at, 0.0}, 0, where});
  }
  path.passes = static_cast<int>(passes.size());
  return path;
}

}  // namespace swarf::motion
