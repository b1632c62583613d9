// The separate pieces of material of two solids that are compared.
#pragma once

#include <string>
#include <vector>

#include "base/frames.h"
#include "cli/compare_inputs.h"
#include "sim/check.h"

namespace swarf::cli {

/// A body whose surface hangs together.
struct SolidPiece {
  double volume_mm3 = 0.0;     ///< inside its outer surface
  Vec3 middle = Vec3::Zero();  ///< of its box, mm
};

struct ComparedPieces {
  std::vector<SolidPiece> stock, design;  ///< the largest first; the design's are empty where it is open

  /// The stock is in more pieces than the design: all but the largest that the design accounts for.
  std::vector<SolidPiece> loose() const;
};

/// Grids break off crumbs at sharp edges: pieces of a .vdb below eight of its voxels are none.
ComparedPieces pieces_between(const ComparedStock& stock, const ComparedDesign& design);

/// "2 pieces, the design is 1: loose is 12.5 mm3 around (1, 2, 3) mm"; "" where none is loose.
std::string loose_text(const ComparedPieces& pieces);

/// Fails where a piece is loose.
sim::Check pieces_check(const ComparedPieces& pieces);

}  // namespace swarf::cli
