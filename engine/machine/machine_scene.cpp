#include "machine/machine_scene.h"

namespace swarf::machine {

std::vector<Pose> link_poses(const MachineScene& scene, const kinematics::AxisValues& q) {
  std::vector<Pose> poses(scene.links.size(), Pose::Identity());
  for (size_t i = 0; i < scene.links.size(); ++i) {
    const Link& link = scene.links[i];
    if (link.parent >= 0) poses[i] = poses[static_cast<size_t>(link.parent)];
    if (link.axis < 0) continue;
    poses[i] =
        poses[i] * kinematics::axis_motion(scene.model.axes[static_cast<size_t>(link.axis)], q[link.axis]);
  }
  return poses;
}

}  // namespace swarf::machine
