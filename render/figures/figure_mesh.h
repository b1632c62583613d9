// Meshes made for pictures: the measured surface as a grid, bodies of revolution.
#pragma once

#include <span>
#include <vector>

#include "mesh/tri_mesh.h"

namespace swarf::render {

/// Mesh of a grid of points, index iv * nu + iu, nu and nv >= 2, with the given unit normals.
/// Each quad is split along the diagonal whose ends agree better in normal, so that ridges stay sharp; the
/// winding follows the normals; neighbouring quads share their vertices, so there are no cracks.
TriMesh surface_grid_mesh(int nu, int nv, std::span<const Vec3> positions, std::span<const Vec3> normals);

/// Revolves a profile of (radius, z) points in mm about +Z; segments >= 3. The profile runs so that the body
/// lies to its left when z points up and radius to the right: from the bottom centre outwards, up, and back
/// to the top centre. Normals are smooth where neighbouring profile segments turn by less than 30 degrees.
TriMesh revolved_profile(std::span<const Vec2> profile, int segments);

/// Cylinder from z = 0 to `length` with edges bevelled by `bevel` (0 < bevel < half of both), mm.
TriMesh cylinder_mesh(double diameter, double length, double bevel, int segments = 96);

}  // namespace swarf::render
