// How deep the raw stock lacks material within a design, proven facet by facet of the raw stock.
//
// A point of the raw stock's surface that lies in the design at a depth d says that d is missing there: a
// pocket, a slit or a closed void. No point of a facet is deeper than g if the facet, moved out of the stock
// and shrunk so that none of its points goes farther than g, is clear of the design (tool_body.h has the same
// of a cutter). What is missing as a whole, with no surface of the stock in it, the measuring rays find.
#pragma once

#include "base/progress.h"
#include "proof/solid_design.h"

namespace swarf::proof {

struct MissingQuestion {
  const SolidDesign& design;
  const TriMesh& raw;       ///< closed, turned out of the material
  double limit_mm = 0.001;  ///< above 0: what is to be decided
  const Progress& progress;
};

struct MissingBound {
  double bound_mm = 0.0;      ///< no place of the raw stock's surface lies deeper in the design's facets
  Vec3 place = Vec3::Zero();  ///< of the raw stock, where the bound was loosest; W, mm
  double found_mm = 0.0;      ///< of the deepest place that was met; 0: none
  Vec3 foot = Vec3::Zero();   ///< the design's place nearest to it; W, mm
};

/// The chord of the design's facets is not included. Interrupted, it proves nothing.
MissingBound bound_missing(const MissingQuestion& question);

}  // namespace swarf::proof
