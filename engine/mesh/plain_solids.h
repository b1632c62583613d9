// Boxes, cylinders and prisms as closed meshes, outward facets, of what is described by a few lengths.
#pragma once

#include <vector>

#include "base/frames.h"
#include "mesh/tri_mesh.h"

namespace swarf::mesh {

/// Twelve facets.
void add_box(TriMesh& mesh, const Box& box);

/// A bar or tube from `base` along `axis` (unit). A prism that holds it and stands out of it by at most
/// kRoundMm: its outer sides touch the outer circle in their middles, its inner corners lie on the inner one.
void add_tube(TriMesh& mesh, const Vec3& base, const Vec3& axis, double radius_mm, double inner_radius_mm,
              double length_mm);
inline constexpr double kRoundMm = 0.05;

/// The inside of a polygon that does not cross itself, counter-clockwise, from one height to another; false,
/// with nothing added, where append_polygon() cannot split it.
bool add_prism(TriMesh& mesh, const std::vector<Vec2>& corners, double low, double high);

void append(TriMesh& mesh, const TriMesh& more);

TriMesh moved(TriMesh mesh, const Pose& pose);

}  // namespace swarf::mesh
