#include "sim/job/tool_bodies.h"

#include <map>
#include <string>

#include "cutter/profile.h"
#include "cutter/tool_walls.h"

namespace swarf::sim {
namespace {

using collision::ToolFrustum;

/// By the part's name.
std::map<std::string, std::vector<ToolFrustum>> parts_of(const cutter::Cutter& tool) {
  std::map<std::string, std::vector<ToolFrustum>> parts;
  const std::vector<Vec2> corners = cutter::sample_outline(cutter::outline(tool), kToolOutline);
  for (size_t i = 0; i + 1 < corners.size(); ++i) {
    const Vec2 &low = corners[i], &high = corners[i + 1];
    if (high.y() > low.y()) parts["flutes"].push_back({low.y(), high.y(), low.x(), high.x()});
  }
  for (const cutter::ToolWall& wall : cutter::tool_walls(tool))
    parts[wall.part].push_back({wall.low, wall.high, wall.low_radius, wall.high_radius});
  return parts;
}

}  // namespace

std::vector<collision::Body> tool_bodies(const Job& job) {
  std::vector<collision::Body> bodies;
  const std::vector<kinematics::MachineModel> machines = machines_by_tool(job);
  for (size_t i = 0; i < machines.size(); ++i) {
    const cutter::Cutter& tool = job.scene.tools[i];
    const std::string of = machines.size() > 1 ? " of " + cutter::call_name(tool) : "";
    for (const auto& [part, frustums] : parts_of(tool)) {
      bodies.push_back(collision::tool_body(job.machine, machines[i], part + of, frustums));
      bodies.back().tool = static_cast<int>(i);
    }
  }
  return bodies;
}

}  // namespace swarf::sim
