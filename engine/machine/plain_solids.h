// Boxes and cylinders as closed meshes, outward facets, for parts that are described by a few lengths.
#pragma once

#include "base/frames.h"
#include "mesh/tri_mesh.h"

namespace swarf::machine {

/// Twelve facets.
void add_box(TriMesh& mesh, const Box& box);

/// Upright, on its foot's centre; a prism of so many sides around it that it is nowhere more than 0.05 mm
/// thicker.
void add_cylinder(TriMesh& mesh, const Vec3& foot, double radius_mm, double height_mm);

void append(TriMesh& mesh, const TriMesh& more);

TriMesh moved(TriMesh mesh, const Pose& pose);

}  // namespace swarf::machine
