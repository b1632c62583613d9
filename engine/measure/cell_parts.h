// How a cell of the branch and bound is divided. Internal to the proof of a root cell (root_proof.h).
#pragma once

#include <array>
#include <vector>

#include "measure/rest_bound.h"

namespace swarf::measure {

struct CellPart {
  std::array<Corner, 3> corners;
  CellEdges edges;
  std::array<bool, 3> outer;  ///< as of Cell
};

/// By places on its sides, from corner k to the next: its own middles, or where its edges have theirs.
std::vector<CellPart> quarters_of(const Cell& cell, const std::array<Corner, 3>& middles);

/// By a place on one side and the corner opposite. The sides have no edges of their own.
std::vector<CellPart> halves_of(const Cell& cell, size_t side, const Corner& place);

}  // namespace swarf::measure
