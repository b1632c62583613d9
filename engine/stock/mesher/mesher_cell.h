// Topology of the dual mesh: which sign-changing edges of a cell belong to one patch of the surface.
//
// A cell is the cube between eight grid points. Corner c = 4a + 2b + d lies at (a, b, d) of (x, y, z). Edge
// e = 4 axis + 2p + q runs along `axis`; p and q are its places on the two other axes, in the order x, y, z:
//
//         3-------7        z
//        /|      /|        |  y
//       1-------5 |        | /
//       | 2-----|-6        |/
//       |/      |/         0----x
//       0-------4
//
// The surface cuts a face of the cell in arcs, which join into loops around the cell: one loop, one patch,
// one vertex of the dual mesh. On a face whose signs alternate two ways of joining exist (Nielson & Hamann
// 1991); by default the arcs go around the inside corners. The mesh has one quad per sign-changing grid edge,
// and an edge of the mesh per arc; so it is a manifold unless both arcs of a face join the same patches on
// both sides, and such a face is flipped (Wenger, Isosurfaces, 2013, manifold dual marching cubes).
#pragma once

#include <array>
#include <cstdint>

namespace swarf::stock {

inline constexpr int kCellEdges = 12;
/// Loops of one cell; four is reached when the signs alternate everywhere.
inline constexpr int kMaxPatches = 4;

/// Bit c is set when corner c is inside.
using CellSigns = uint8_t;

struct CellPatches {
  int count = 0;
  std::array<uint16_t, kMaxPatches> edges{};  ///< bit e: the surface crosses edge e in this patch
};

/// The patches of a cell whose faces are joined by default.
const CellPatches& cell_patches(CellSigns signs);
/// The same with the faces of `flipped` (bit 2 axis + side) joined the other way.
CellPatches cell_patches(CellSigns signs, uint8_t flipped);
/// Faces (bit 2 axis + side) on which both arcs of the default belong to one patch: those that must be
/// flipped if the neighbour finds so as well.
uint8_t twice_met_faces(CellSigns signs);

/// Corner at the lower end of an edge.
int edge_corner(int edge);
/// Step of the corner's number along an axis.
constexpr int corner_step(int axis) {
  return 4 >> axis;
}

}  // namespace swarf::stock
