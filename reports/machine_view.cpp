#include "reports/machine_view.h"

#include <algorithm>

#include "cutter/profile.h"
#include "cutter/tool_walls.h"
#include "render/figures/figure_mesh.h"
#include "render/figures/tool_mesh.h"

namespace swarf::reports {
namespace {

/// Rotation that turns +Z onto the axis.
Pose standing_on(const Vec3& tip, const Vec3& axis) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), axis).toRotationMatrix();
  pose.translation() = tip;
  return pose;
}

/// Below this share of the diameter nobody sees the corners of a drawn arc.
constexpr double kArcTolerance = 5e-4;

int drawn_flutes(cutter::Shape shape) {
  if (shape == cutter::Shape::kDrill) return 2;
  return shape == cutter::Shape::kWoodruff ? 8 : 4;
}

render::ToolFigure tool_figure(const cutter::Cutter& c) {
  render::ToolFigure figure;
  figure.flutes = cutter::sample_outline(cutter::outline(c), kArcTolerance * c.diameter_mm);
  figure.flute_count = drawn_flutes(c.shape);
  for (const cutter::ToolWall& wall : cutter::tool_walls(c)) {
    if (wall.low >= c.length_mm) break;  // the holder is drawn by itself
    figure.above.emplace_back(wall.low_radius, wall.low);
    figure.above.emplace_back(wall.high_radius, wall.high);
  }
  return figure;
}

/// One cylinder is drawn as a collet chuck of that size; anything else as it is described.
TriMesh holder_figure(const cutter::Cutter& c) {
  const cutter::ToolSection& first = c.holder.front();
  if (c.holder.size() == 1 && first.diameter_mm == first.top_diameter_mm) {
    return render::holder_mesh(first.diameter_mm, first.length_mm);
  }
  std::vector<Vec2> corners{Vec2::Zero()};
  const auto add = [&](double radius, double z) {
    if (corners.back() != Vec2(radius, z)) corners.emplace_back(radius, z);
  };
  double z = 0.0;
  for (const cutter::ToolSection& section : c.holder) {
    add(0.5 * section.diameter_mm, z);
    z += section.length_mm;
    add(0.5 * section.top_diameter_mm, z);
  }
  add(0.0, z);
  return render::revolved_profile(corners, 96);
}

}  // namespace

std::vector<motion::Cycle> FinishedRun::shown_cycles(size_t count) const {
  if (!window) return cycles.spread(count);
  const size_t many = std::min(count, window->size());
  std::vector<motion::Cycle> shown;
  motion::CycleReader reader(cycles);
  for (size_t i = 0; i < many; ++i)
    shown.push_back(reader.at(window->first + (many == 1 ? 0 : (window->size() - 1) * i / (many - 1))));
  return shown;
}

MachineView::MachineView(const sim::Job& job) : job_(job) {
  const std::vector<kinematics::MachineModel> machines = sim::machines_by_tool(job);
  for (size_t i = 0; i < machines.size(); ++i) {
    const cutter::Cutter& tool = job.scene.tools[i];
    figures_.push_back({render::tool_mesh(tool_figure(tool)), holder_figure(tool), machines[i]});
  }
}

Pose MachineView::work_pose(const kinematics::AxisValues& q) const {
  const auto link = static_cast<size_t>(job_.machine.work_link);
  return machine::link_poses(job_.machine, q)[link] * job_.machine.model.X_MW;
}

Pose MachineView::tool_pose(const kinematics::AxisValues& q, size_t tool) const {
  const auto link = static_cast<size_t>(job_.machine.tool_link);
  const kinematics::MachineModel& model = figures_[tool].machine;
  return machine::link_poses(job_.machine, q)[link] * standing_on(model.tip_M, model.tool_axis_M);
}

Pose MachineView::holder_in_tool(size_t tool) const {
  Pose pose = Pose::Identity();
  pose.translation() = Vec3(0.0, 0.0, job_.scene.tools[tool].length_mm);
  return pose;
}

std::vector<render::DrawItem> MachineView::items(const kinematics::AxisValues& q, size_t tool,
                                                 const TriMesh* stock_mesh) const {
  std::vector<render::DrawItem> list;
  const std::vector<Pose> poses = machine::link_poses(job_.machine, q);
  for (size_t i = 0; i < poses.size(); ++i) {
    const machine::Link& link = job_.machine.links[i];
    if (link.mesh.triangles.empty()) continue;
    list.push_back({&link.mesh, poses[i], {link.colour, link.metalness, link.roughness}});
    list.back().sectioned = link.fixture;
  }
  const Pose X_MT = tool_pose(q, tool);
  list.push_back({&cutter(tool), X_MT, kToolMaterial});
  list.push_back({&holder(tool), X_MT * holder_in_tool(tool), kHolderMaterial});
  if (stock_mesh == nullptr) return list;
  list.push_back({stock_mesh, work_pose(q), kStockMaterial, true});
  list.back().sectioned = true;
  return list;
}

}  // namespace swarf::reports
