// The 256 cells: loops, and agreement between neighbours.
#include "stock/mesher/mesher_cell.h"

#include <gtest/gtest.h>

#include <bit>

namespace swarf::stock {
namespace {

uint16_t crossed_edges(int signs) {
  uint16_t edges = 0;
  for (int e = 0; e < kCellEdges; ++e) {
    const int low = edge_corner(e);
    if ((signs >> low & 1) != (signs >> (low + corner_step(e / 4)) & 1))
      edges = static_cast<uint16_t>(edges | 1 << e);
  }
  return edges;
}

TEST(MeshCell, EveryEdgeJoinsNeighbouringCorners) {
  int met = 0;
  for (int e = 0; e < kCellEdges; ++e) {
    const int low = edge_corner(e), high = low + corner_step(e / 4);
    EXPECT_EQ(std::popcount(static_cast<unsigned>(low ^ high)), 1);
    EXPECT_EQ(low & corner_step(e / 4), 0);
    met |= 1 << (8 * (e / 4) + low);
  }
  EXPECT_EQ(std::popcount(static_cast<unsigned>(met)), kCellEdges);
}

TEST(MeshCell, PatchesShareOutTheCrossedEdgesInLoops) {
  int most = 0;
  for (int signs = 0; signs < 256; ++signs) {
    for (int flipped = 0; flipped < 64; ++flipped) {
      const CellPatches patches = cell_patches(static_cast<CellSigns>(signs), static_cast<uint8_t>(flipped));
      unsigned all = 0;
      for (int p = 0; p < patches.count; ++p) {
        ASSERT_EQ(all & patches.edges[p], 0U) << signs << " flipped " << flipped;
        ASSERT_GE(std::popcount(patches.edges[p]), 3) << signs << " flipped " << flipped;
        all |= patches.edges[p];
      }
      ASSERT_EQ(all, crossed_edges(signs)) << signs << " flipped " << flipped;
      most = std::max(most, patches.count);
    }
  }
  EXPECT_EQ(most, kMaxPatches);
}

TEST(MeshCell, KnownCells) {
  EXPECT_EQ(cell_patches(0).count, 0);
  EXPECT_EQ(cell_patches(0xff).count, 0);
  EXPECT_EQ(cell_patches(0x01).count, 1);
  // Inside corners across a face and across the cell stay apart.
  EXPECT_EQ(cell_patches(1 << 0 | 1 << 3).count, 2);
  EXPECT_EQ(cell_patches(1 << 0 | 1 << 7).count, 2);
  // The outside corners of the complement are joined across the face.
  EXPECT_EQ(cell_patches(static_cast<CellSigns>(~(1 << 0 | 1 << 3))).count, 1);
  EXPECT_EQ(cell_patches(static_cast<CellSigns>(~(1 << 0 | 1 << 7))).count, 2);
  EXPECT_EQ(cell_patches(1 << 0 | 1 << 3 | 1 << 5 | 1 << 6).count, 4);
}

TEST(MeshCell, FlippingWhereBothArcsAreOnePatchPartsIt) {
  // Two outside corners across the lower x face, all else inside.
  const auto signs = static_cast<CellSigns>(~(1 << 0 | 1 << 3));
  EXPECT_EQ(twice_met_faces(signs), 1);
  EXPECT_EQ(cell_patches(signs, 1).count, 2);
  EXPECT_EQ(twice_met_faces(1 << 0 | 1 << 3), 0);
}

}  // namespace
}  // namespace swarf::stock
