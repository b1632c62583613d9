// The loops of trimmed faces as chains of straight edges, which stop a tool for themselves.
//
// A loop is a polyline in the parameters: a chain of curves on the surface. Each is divided until its chord
// stays within kEdgeChord_mm of it, proven by the second derivatives: |C''| / 8 over the piece. So what stops
// the tool is moved by less than that, by what Face::chord_mm says, and by the rounding of coordinates to
// floats (4e-6 mm at 100 mm), times the slope of the cutter there in the height.
#pragma once

#include <vector>

#include "mesh/tri_mesh.h"
#include "position/patch_target.h"
#include "surface/face.h"

namespace swarf::position {

inline constexpr double kEdgeChord_mm = 5e-6;

/// Where an edge lies in the parameters of its patch.
struct EdgeSpan {
  int patch = -1;
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();
};

struct FaceEdges {
  TriMesh mesh;  ///< triangles without area: edge i from corner 0 to corner 1
  std::vector<EdgeSpan> spans;
};

/// Edges of all faces that have loops, with those parts of the square's border that lie inside the loops.
/// Throws InputError "too-many-edges" above `most`.
FaceEdges face_edges(const std::vector<surface::Face>& faces, size_t most = 4'000'000);

}  // namespace swarf::position
