// What makes a flank pass impossible, said before anything moves.
#pragma once

#include "base/diagnostics.h"
#include "flank/placement.h"

namespace swarf::flank {

/// Errors at `where`, on 257 rulings and 9 places of each; what lies between them is not looked at:
///   "no-ruling"         a ruling or a guide curve without length
///   "guides-opposed"    guide curves that run in opposite directions, or rulings that cross between them
///   "cutter-too-short"  the flank does not reach over the ruling
///   "cutter-too-large"  the hollow of the surface is narrower than the cutter: where, and what radius fits
void check_task(const FlankTask& task, const SourceLocation& where, Diagnostics& diagnostics);

}  // namespace swarf::flank
