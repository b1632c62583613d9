// The share of one leaf in the surface mesh: the vertices of its 512 cells and the quads of its grid edges.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/frames.h"
#include "stock/mesher/mesher_vertex.h"

namespace swarf::stock {

struct LeafVertex {
  std::array<float, 3> position;  ///< mm
  std::array<float, 3> normal;
  uint16_t edges;  ///< of its cell, those that its patch crosses
  bool sharp;
  bool operator==(const LeafVertex&) const = default;
};

/// A grid edge whose ends differ in sign; `cell` has the edge at its corner 0.
struct LeafEdge {
  uint16_t cell;
  uint8_t axis;
  bool upward;     ///< the inside is at the lower end
  float crossing;  ///< from the lower end, voxels
  bool operator==(const LeafEdge&) const = default;
};

/// A vertex as seen from a leaf: bits 16 to 18 say on which axes (x = 4, y = 2, z = 1) its leaf is the one
/// before, the lower 16 bits are its number there.
using VertexRef = uint32_t;

struct LeafMesh {
  static constexpr uint16_t kNoVertex = 0xffff;

  std::array<uint16_t, 512> first;   ///< of each cell (64 i + 8 j + k), its first vertex or kNoVertex
  std::vector<LeafVertex> vertices;  ///< in order of cells
  std::vector<LeafEdge> edges;       ///< in order of cells, then axes
  std::vector<std::array<VertexRef, 3>>
      triangles;  ///< two for each edge, counter-clockwise seen from outside
};

/// Vertices and edges from the values; `origin_W` is the leaf's first grid point, mm. False (and `mesh`
/// unchanged) when the surface passes no cell of the leaf.
bool place_vertices(const ValueBlock& block, const Vec3& origin_W, double voxel_mm, LeafMesh& mesh);

/// Triangles of the leaf's edges. `around[n]` is the leaf that VertexRef calls n, around[0] the leaf itself;
/// those that an edge needs have vertices.
void join_vertices(const std::array<const LeafMesh*, 8>& around, const Vec3& origin_W, double voxel_mm,
                   LeafMesh& mesh);

}  // namespace swarf::stock
