// Places that break a limit, put together from the cells of the proof. Internal to this folder.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "measure/design_cell.h"
#include "measure/metrics.h"

namespace swarf::measure {

/// What lies above a limit, of a cell or of a root cell.
struct RegionPart {
  double area_mm2 = 0.0, volume_mm3 = 0.0;
  double worst_mm = 0.0;
  Vec3 place = Vec3::Zero();  ///< of the worst, mm
  uint32_t block = 0xffffffffu;

  void add(const RegionPart& other);
};

/// Where a cell lies, mm.
struct CellDisc {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
};

/// The part of a cell whose values lie above a limit; values are linear between its corners.
struct RegionPiece {
  RegionPart part;
  CellDisc disc;
  bool near_rim = false;  ///< a piece of the next root cell may touch it
};

/// The pieces of one root cell, joined where they touch. Its neighbours' can go on from the pieces near its
/// rim alone, so no others are kept.
struct RootRegions {
  struct Rim {
    CellDisc disc;
    size_t part;
  };
  std::vector<RegionPart> parts;
  std::vector<Rim> rim;
};

/// Appends the piece of the cell above the limit; nothing when no corner lies above it.
void add_piece(const DesignCell& cell, const std::array<double, 3>& values_mm,
               const std::array<uint32_t, 3>& blocks, double limit_mm, bool near_rim,
               std::vector<RegionPiece>& pieces);

/// Those of one root cell.
RootRegions join_pieces(const std::vector<RegionPiece>& pieces);

/// Parts that touch become one region; the worst first.
std::vector<Region> join_roots(const std::vector<const RootRegions*>& roots);

}  // namespace swarf::measure
