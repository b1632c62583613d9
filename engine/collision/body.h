// Rigid bodies that ride on the links of a machine, each with a tree of boxes over its primitives.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "collision/convex_shape.h"
#include "machine/machine_scene.h"
#include "mesh/tri_mesh.h"

namespace swarf::collision {

enum class BodyKind { kLink, kFixture, kStock, kPart, kToolPart };

/// A box around some primitives of a body.
struct BodyNode {
  Vec3 centre = Vec3::Zero(), half = Vec3::Zero();  ///< mm, home drawing
  double radius = 0.0;                              ///< of the ball around the box
  int32_t child = -1;      ///< index of the first of two children that stand side by side; -1: a leaf
  uint32_t primitive = 0;  ///< of a leaf: triangles first, then solids
};

/// Everything lies in the home drawing: in M with all axes of the machine at zero, in mm.
struct Body {
  std::string name;
  BodyKind kind = BodyKind::kLink;
  int link = -1;  ///< index into MachineScene::links of the link that it rides on; -1: the floor
  int tool =
      -1;  ///< it is there only while this tool is in the spindle (motion::ToolSample::tool); -1: always
  /// The triangles bound a solid: a body wholly inside it counts as contact. An open mesh is a sheet: only
  /// its surface is met.
  bool closed = false;
  std::vector<Triangle> triangles;
  std::vector<RevolvedSolid> solids;
  std::vector<BodyNode> nodes;  ///< the root first; none: the body is empty and far from everything
  std::vector<Vec3> shells;     ///< a point of every connected part of the surface, and of every solid

  size_t primitives() const { return triangles.size() + solids.size(); }
};

/// A body from a mesh, which `placed` carries into the home drawing. Throws InputError "body-not-finite" for
/// NaN and infinite positions and "body-index" for triangles of vertices that are not there.
Body mesh_body(std::string name, BodyKind kind, int link, const TriMesh& mesh,
               const Pose& placed = Pose::Identity());
/// The same from convex solids of revolution, a part of a tool: shank, neck, holder. Throws InputError
/// "body-bad-profile".
Body solid_body(std::string name, BodyKind kind, int link, std::vector<RevolvedSolid> solids_M);

/// The links of the machine that have a mesh and are wanted, by their indices; all of them where nothing is
/// said.
std::vector<Body> link_bodies(const machine::MachineScene& scene,
                              const std::function<bool(int link)>& wanted = {});
/// What is clamped on the work link, drawn in W.
Body work_body(const machine::MachineScene& scene, std::string name, BodyKind kind, const TriMesh& mesh_W);

/// A part of a tool between two heights.
struct ToolFrustum {
  double low = 0.0, high = 0.0;                ///< mm above the tip, low < high
  double low_radius = 0.0, high_radius = 0.0;  ///< mm, not both 0
};
/// A part of the tool on the tool link. `with_tool`: scene.model with this tool's length
/// (kinematics::with_tool).
Body tool_body(const machine::MachineScene& scene, const kinematics::MachineModel& with_tool,
               std::string name, std::span<const ToolFrustum> frustums);

/// Whether a point of the home drawing lies in the material of a closed body, by the winding of its triangles
/// (winding.h), which shells that overlap do not disturb, or in one of its solids.
bool holds_point(const Body& body, const Vec3& point);

}  // namespace swarf::collision
