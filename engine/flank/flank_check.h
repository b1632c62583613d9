// What makes a flank pass impossible, said before anything moves.
#pragma once

#include "base/diagnostics.h"
#include "flank/placement.h"

namespace swarf::flank {

/// Errors at `where`. The worst of 257 rulings and 9 places of each is named; where these find nothing the
/// first three are proven over the whole surface (flank_proof.h):
///   "no-ruling"         a ruling or a guide curve without length
///   "guides-opposed"    guide curves that run in opposite directions, or rulings that cross between them
///   "cutter-too-large"  the hollow of the surface is narrower than the cutter: where, and what radius fits
///   "flank-not-proven"  the surface is too near to turning over along a ruling to tell
///   "cutter-too-short"  the flank does not reach over the ruling: the greatest need of 257 rulings and what
///   lies
///                       higher between neighbours; two crests between three rulings are not told apart
void check_task(const FlankTask& task, const SourceLocation& where, Diagnostics& diagnostics);

}  // namespace swarf::flank
