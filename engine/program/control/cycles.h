// Canned drilling cycles and curves: blocks that expand into several moves.
#pragma once

#include "program/control/control.h"
#include "program/control/curve.h"
#include "program/control/drill_cycle.h"

namespace swarf::program::nc {

/// One hole, at the target's place in the plane: the positions of the cycle's moves along the plane's normal.
void drill(Control& control, const DrillCycle& cycle, const Target& hole);
/// A parametric curve (NURBS, polynomial) as straight moves whose chords miss it by at most `tolerance_mm`.
void curve(Control& control, const Curve& curve, double tolerance_mm);

}  // namespace swarf::program::nc
