// Places that break a limit, put together from the cells of the proof. Internal to this folder.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "measure/design_cell.h"
#include "measure/metrics.h"

namespace swarf::measure {

/// The part of a cell whose values lie above a limit; values are linear between its corners.
struct RegionPiece {
  Vec3 centre;          ///< of the cell, mm
  double radius = 0.0;  ///< of the cell, mm
  double area_mm2 = 0.0, volume_mm3 = 0.0;
  double worst_mm = 0.0;
  Vec3 place;
  uint32_t block = 0xffffffffu;
};

/// Appends the piece of the cell above the limit; nothing when no corner lies above it.
void add_piece(const DesignCell& cell, const std::array<double, 3>& values_mm,
               const std::array<uint32_t, 3>& blocks, double limit_mm, std::vector<RegionPiece>& pieces);

/// Pieces that touch become one region; the worst first.
std::vector<Region> join_pieces(const std::vector<RegionPiece>& pieces);

}  // namespace swarf::measure
