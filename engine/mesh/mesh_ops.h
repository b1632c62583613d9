// Operations on triangle meshes: normals, bounds, decimation to a stated and verified error.
#pragma once

#include "base/frames.h"
#include "base/placement.h"
#include "mesh/tri_mesh.h"

namespace swarf::mesh {

/// Bounding box of the positions, mm; the mesh must have at least one.
Box bounds(const TriMesh& mesh);

/// Moves a mesh to its place; one that moves loses its vertex normals.
void place(TriMesh& mesh, const Placement& placement);

/// Replaces the normals by angle-weighted means of the faces around each vertex (Thuermer & Wuethrich 1998).
/// Faces whose normals differ by more than `crease_rad` from the face at hand take no part, and a vertex that
/// then has several normals is split into copies that carry the same other attributes. Degenerate faces count
/// for nothing; a vertex that has only such faces gets (0, 0, 1).
void compute_vertex_normals(TriMesh& mesh, double crease_rad);

/// Makes a mesh with given normals fit for smooth shading: where a vertex normal differs by more than
/// `crease_rad` from the normal of one of its triangles, the triangle gets a copy of the vertex with the
/// area-weighted mean normal of those beside it that lie within the crease angle of each other. The copies
/// follow the vertices there were; positions stay, so the surface is the same but no longer closed by
/// indices: for display only. Parallel, same result for any number of threads.
void split_creases(TriMesh& mesh, double crease_rad);

/// Fewer triangles for the eye, fast: meshoptimizer's edge collapse, borders kept, where the mesh joins
/// others, and seams between normals too. `max_error_mm` bounds the collapse's own estimate (a mean over
/// planes), not a measured distance: nothing is to be measured on the result. Vertices that no triangle uses
/// any more are left out.
void thin_for_display(TriMesh& mesh, double max_error_mm);

/// A coarser mesh whose distance from every vertex of `mesh` is at most `max_error_mm` (> 0).
///
/// meshoptimizer's quadric edge collapse does the bulk; when what is left is small, OpenMesh's decimater
/// (quadrics, aspect ratio, normal flipping) goes on. The distance is then measured, independently of both,
/// from every original vertex to the exact nearest point of the result; where it is too much the result is
/// redone, around those vertices with a smaller budget and at last without any, and if no result passes the
/// mesh is returned unchanged. `reached_error` (may be null) receives
/// the measured distance, mm. Both methods keep a subset of the original vertices, so colours, deviations and
/// normals are carried unchanged; of vertices that coincide in position the first one's are kept. A closed
/// mesh stays closed, and becomes manifold: where sheets touch after their collapses, each has vertices of
/// its own at the same positions.
TriMesh decimate(const TriMesh& mesh, double max_error_mm, double* reached_error);

/// Puts triangles beside those that share their vertices, and vertices in the order of their first use
/// (meshoptimizer): the same triangles in another order, which draws faster and compresses better. Vertices
/// that no triangle uses are left out.
void order_for_display(TriMesh& mesh);

}  // namespace swarf::mesh
