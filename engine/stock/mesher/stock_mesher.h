// The surface mesh of a stock, made again only where the stock has changed.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "mesh/tri_mesh.h"
#include "stock/stock.h"

namespace swarf::stock {

/// Dual mesh of the stock's level set with sharp edges and corners (mesher_cell.h: topology, mesher_vertex.h:
/// where the vertices lie). Closed, manifold and oriented whatever was cut. A wall thinner than a voxel is
/// kept where it contains grid points and lost where it does not. Planes are exact, curved sheets of radius r
/// within voxel^2 / (8 r). Where sheets meet at more than 20 degrees the mesh has an edge: over 750 slots
/// turned at random (cutter radius 13 voxels) the true edge was never farther than 0.1 voxel from the mesh.
/// Besides the true edges, needles between vertices that nearly coincide may be turned by more than 30
/// degrees: at most 0.13 voxel high, over 0.1 voxel in 6 of those slots, for beside a curved sheet its plane
/// is known a voxel away. Flatter ridges are cut where the nearest vertex is, up to half a voxel beside them.
class StockMesher {
 public:
  /// Borrows the stock, which must not be destroyed or assigned to meanwhile (moving it elsewhere is
  /// allowed). `patch_side`: of a patch, leaf positions.
  explicit StockMesher(const Stock& stock, int patch_side = 4);
  ~StockMesher();
  StockMesher(StockMesher&&) noexcept;

  /// The whole surface, vertices with outward unit normals (on an edge that of one of its sides). Leaves that
  /// were cut since the last call, and those beside them, are meshed again; the result is the same as that of
  /// a new mesher, for any number of threads.
  TriMesh mesh();
  /// The same surface in patches, one for each cube of patch_side leaf positions, for those who draw it while
  /// it is cut: brings the leaves up to date and returns the numbers of the patches whose triangles are no
  /// longer those of the last call of mesh() or update(), ascending; of the first call all.
  std::vector<size_t> update();
  size_t patches() const;
  /// Triangles of one patch as of the last update(); it has its own vertices, and on its borders the same
  /// positions and normals as its neighbours. Empty where no surface passes.
  TriMesh patch(size_t number) const;
  /// Leaf positions along the stock's longest side.
  static int leaves_along(const Stock& stock);
  /// Leaves whose vertices the last call made again.
  size_t leaves_meshed() const;
  /// What is remembered between calls.
  size_t memory_bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace swarf::stock
