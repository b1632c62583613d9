// The machine as a scene graph: links with meshes that move with the axes.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "kinematics/machine_model.h"
#include "mesh/tri_mesh.h"

namespace swarf::machine {

/// A rigid part. Its mesh is drawn in the machine frame with all axes at zero.
struct Link {
  std::string name;
  int parent = -1;  ///< index into MachineScene::links; -1: the floor
  int axis = -1;    ///< index into MachineModel::axes of the axis between parent and this link; -1: fixed
  TriMesh mesh;     ///< may be empty
  std::array<float, 3> colour{0.7F, 0.7F, 0.7F};  ///< linear RGB 0..1
  float metalness = 0.0F, roughness = 0.6F;
  bool fixture = false;  ///< holds the work; not the machine's own (fixture.h)
};

struct MachineScene {
  kinematics::MachineModel model;
  std::vector<Link> links;                ///< parents before children
  int work_link = -1;                     ///< the link that carries the work
  int tool_link = -1;                     ///< the link that carries the tool
  std::string file;                       ///< machine.toml it came from
  std::string assumed_dynamics;           ///< accelerations and jerks that the file leaves out; "": none
  std::optional<double> tool_change_s;    ///< chip to chip, beyond the way to where tools are changed
  std::optional<double> program_unit_mm;  ///< `units` that programs without G20 and G21 are in: 1 or 25.4
};

/// Reads machine.toml and its meshes. Throws InputError with every problem found: a cycle, a missing
/// limit, an unknown axis letter, a mesh that is not there, an unknown key (with the nearest known one).
MachineScene load_machine(const std::string& path);

/// Pose of each link relative to its home drawing, X_M(link moved) <- M(home), at axis values q.
std::vector<Pose> link_poses(const MachineScene& scene, const kinematics::AxisValues& q);

}  // namespace swarf::machine
