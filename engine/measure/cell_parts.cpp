#include "measure/cell_parts.h"

namespace swarf::measure {

std::vector<CellPart> quarters_of(const Cell& cell, const std::array<Corner, 3>& middles) {
  const auto& c = cell.corners;
  const auto& e = cell.edges;
  const auto& o = cell.outer;
  return {{{c[0], middles[0], middles[2]},
           {e[0].first_half(), EdgePiece{}, e[2].second_half()},
           {o[0], false, o[2]}},
          {{middles[0], c[1], middles[1]},
           {e[0].second_half(), e[1].first_half(), EdgePiece{}},
           {o[0], o[1], false}},
          {{middles[2], middles[1], c[2]},
           {EdgePiece{}, e[1].second_half(), e[2].first_half()},
           {false, o[1], o[2]}},
          {{middles[0], middles[1], middles[2]}, {}, {}}};
}

std::vector<CellPart> halves_of(const Cell& cell, size_t side, const Corner& place) {
  const size_t next = (side + 1) % 3, opposite = (side + 2) % 3;
  const auto& c = cell.corners;
  const auto& e = cell.edges;
  const auto& o = cell.outer;
  return {
      {{c[side], place, c[opposite]}, {EdgePiece{}, EdgePiece{}, e[opposite]}, {o[side], false, o[opposite]}},
      {{place, c[next], c[opposite]}, {EdgePiece{}, e[next], EdgePiece{}}, {o[side], o[next], false}}};
}

}  // namespace swarf::measure
