// Display meshes of the cutter and its holder; the sweeps that cut use the exact cutter, not these.
#pragma once

#include "mesh/tri_mesh.h"

namespace swarf::render {

/// A four-flute end mill with 30 degree helix and a plain shank, mm. Tip centre at the origin, axis +Z,
/// right-hand cutting. flute_length < length; the cutting edges reach exactly diameter / 2.
TriMesh tool_mesh(double diameter, double flute_length, double shank_diameter, double length);

/// A collet chuck: clamping nut, slim body, flange with the gripper groove. Nose centre at the origin, axis
/// +Z.
TriMesh holder_mesh(double diameter, double length);

}  // namespace swarf::render
