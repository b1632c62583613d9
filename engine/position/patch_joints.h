// Borders of surface patches that do not meet their neighbours, before anything moves.
//
// A place on a border is asked for the nearest place of all other patches, and of the far half of its own,
// which a closed one meets again: exactly, by the tree of cells and Newton's steps on the surface. Within
// kJoined_mm they are joined; within `reach` the way there is parted by the border's normal:
//
//          step  along it: the neighbour lies higher or lower
//       ______
//      |        gap   square to it, away from its own patch: the tip sinks in
//  ____|
//
// Farther off the part ends. Places lie kJointStep_mm apart: what opens and closes between two is not seen.
// Trimmed patches are not looked at: their loops have neighbours (brep::Edge::gap_mm).
#pragma once

#include <vector>

#include "position/patch_cells.h"

namespace swarf::position {

/// Closer faces are what CAD systems call joined, mm.
inline constexpr double kJoined_mm = 1e-3;
inline constexpr double kJointStep_mm = 0.5;

/// A place of a border that faces another patch, or its own other end, and does not meet it.
struct OpenJoint {
  int patch = 0, other = 0;  ///< as the patches are counted
  Vec3 at = Vec3::Zero();    ///< on the border, mm
  Vec3 to = Vec3::Zero();    ///< from there to the nearest place of the other
  double gap_mm = 0.0;       ///< of `to` square to the border's normal
  double step_mm = 0.0;      ///< along it; above 0: the other lies higher, out of the material
};

/// All of them, in the order of patches and of their borders. `reach`: mm. Throws as cell_tree does.
std::vector<OpenJoint> open_joints(const std::vector<Patch>& patches, double reach);

}  // namespace swarf::position
