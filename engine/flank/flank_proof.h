// What must hold everywhere on a ruled surface, proven by subdivision: a cell is done when the bounds of the
// surface's second derivatives (Surface::bend_bounds) show it, and is cut in two when they do not.
#pragma once

#include <optional>

#include "flank/placement.h"

namespace swarf::flank {

/// A place where it does not hold, or where it could not be shown.
struct WeakPlace {
  double u = 0.0, v = 0.0;
  bool shown = true;                        ///< false: the cells there have become too small, or too many
  double hollow_mm = 0.0, cutter_mm = 0.0;  ///< of narrow_place(): radius of the surface, of the ball there
};

/// Su x Sv at both ends of every ruling of the pass, overruns included, within 90 deg of each other and
/// nowhere zero: then the ruling and both guides have a length, and as Su x Sv is linear in v the surface
/// turns over nowhere between. None: proven.
std::optional<WeakPlace> turned_ruling(const FlankTask& task);

/// Across its rulings the design is nowhere hollower than the ball that touches it there. With the outward
/// normal n, F = Su.Sv, G = |Sv|^2 and W = Su x Sv the surface bends outwards by
///
///     k = G/|W|^2 (n.Suu - 2 F/G n.Suv),
///
/// and k rho <= 1 must hold. None: proven, for all of [0,1]^2.
std::optional<WeakPlace> narrow_place(const FlankTask& task);

}  // namespace swarf::flank
