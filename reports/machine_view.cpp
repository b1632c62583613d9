#include "reports/machine_view.h"

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

}  // namespace

MachineView::MachineView(const sim::Job& job) : job_(job) {
  const cutter::Cutter& c = job.scene.cutter;
  tool_ = render::tool_mesh(c.diameter_mm, c.flute_length_mm, c.shank_diameter_mm, c.length_mm);
  holder_ = render::holder_mesh(c.holder_diameter_mm, c.holder_length_mm);
}

Pose MachineView::work_pose(const kinematics::AxisValues& q) const {
  const auto link = static_cast<size_t>(job_.machine.work_link);
  return machine::link_poses(job_.machine, q)[link] * job_.machine.model.X_MW;
}

Pose MachineView::tool_pose(const kinematics::AxisValues& q) const {
  const auto link = static_cast<size_t>(job_.machine.tool_link);
  const kinematics::MachineModel& model = job_.machine.model;
  return machine::link_poses(job_.machine, q)[link] * standing_on(model.tip_M, model.tool_axis_M);
}

Pose MachineView::holder_in_tool() const {
  Pose pose = Pose::Identity();
  pose.translation() = Vec3(0.0, 0.0, job_.scene.cutter.length_mm);
  return pose;
}

std::vector<render::DrawItem> MachineView::items(const kinematics::AxisValues& q,
                                                 const TriMesh* stock_mesh) const {
  std::vector<render::DrawItem> list;
  const std::vector<Pose> poses = machine::link_poses(job_.machine, q);
  for (size_t i = 0; i < poses.size(); ++i) {
    const machine::Link& link = job_.machine.links[i];
    if (link.mesh.triangles.empty()) continue;
    list.push_back({&link.mesh, poses[i], {link.colour, link.metalness, link.roughness}});
  }
  const Pose X_MT = tool_pose(q);
  list.push_back({&tool_, X_MT, kToolMaterial});
  list.push_back({&holder_, X_MT * holder_in_tool(), kHolderMaterial});
  if (stock_mesh != nullptr) list.push_back({stock_mesh, work_pose(q), kStockMaterial, true});
  return list;
}

}  // namespace swarf::reports
