// Alarms of theory 1.6 that need the cutter, in the user's words.
#pragma once

#include "base/diagnostics.h"
#include "program/surface_blocks/program.h"
#include "toolpath/pass_family.h"

namespace swarf::toolpath {

/// One operation with what its messages name.
struct OperationContext {
  const program::Operation* operation;
  int surface_number;
  double diameter_mm;
};

/// Looks for places where the flat end gouges (saddle or concave, lean missing or too small) over the pass
/// parameters 0..1 x [w_low, w_high] and reports the worst one ("saddle-or-concave"). True when there is
/// none.
bool check_gouging(const Area& area, double w_low, double w_high, const OperationContext& context,
                   Diagnostics& diagnostics);

/// A lean that is a mere tilt would cut with the corner: needs lead ("tilt-without-lead"). True when it is
/// fine.
bool check_lean(const Area& area, const OperationContext& context, Diagnostics& diagnostics);

/// Refuses a scallop so small that the passes could not be counted ("too-many-passes"). True when it is fine.
bool check_pass_count(const Area& area, const OperationContext& context, Diagnostics& diagnostics);

/// Reports what ended a family early ("interval-beyond-cutter", "path-folds"), and notes where the surface
/// does not continue beyond its edges ("no-overrun", "no-continuation").
void report_family(const Area& area, const Family& family, const OperationContext& context,
                   Diagnostics& diagnostics);

}  // namespace swarf::toolpath
