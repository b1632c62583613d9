// Display meshes of the cutter and its holder; the sweeps that cut use the exact cutter, not these.
#pragma once

#include <vector>

#include "base/frames.h"
#include "mesh/tri_mesh.h"

namespace swarf::render {

/// The outline of a tool in the half plane (rho, z), mm.
struct ToolFigure {
  std::vector<Vec2> flutes;  ///< from the axis at the tip to the end of the flutes, z never falling
  std::vector<Vec2> above;   ///< corners of neck and shank from there to the holder; may be empty
  int flute_count = 4;
};

/// The tool turned from its outline, with flutes of 30 degree helix milled into its cutting part. Tip at the
/// origin, axis +Z, right-hand cutting; the cutting edges lie on the outline. The flutes run out into the
/// shank, but go through where what follows is thinner than their ground.
TriMesh tool_mesh(const ToolFigure& figure);

/// A collet chuck: clamping nut, slim body, flange with the gripper groove. Nose centre at the origin, axis
/// +Z.
TriMesh holder_mesh(double diameter, double length);

}  // namespace swarf::render
