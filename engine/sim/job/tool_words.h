// Tools in a word each: "T1=6,T2=ball4,T3=drill5,T4=bull10r1", for a first look at a program.
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "cutter/cutter.h"

namespace swarf::sim {

/// The tools of a list that commas divide, in its order; each is [T<number>= or NAME=] and
///
///   6  flat6            flat end of D 6 mm           drill5  drill5a140   point angle 118 deg, or as given
///   ball4               ball end                     chamfer8a90          cone to a sharp point, included
///   angle bull10r1            flat end, corner radius 1    0.25in, ball0.5in    lengths in inches; mm
///   without a unit
///
/// A list of one may leave the name out: number 0 without a name, to be bound to what the program calls.
///
/// A word says nothing of what stands above the edges. So the flutes are taken to reach over all of the tool,
/// 60 mm and twice the diameter, up to the spindle's gauge line: neither shank nor holder can touch anything.
///
/// Errors ("bad-tool-word", at `where`): what is no such word, a diameter that is not above 0, a corner
/// radius that does not fit.
std::vector<cutter::Cutter> read_tool_words(const std::string& list, const SourceLocation& where,
                                            Diagnostics& diagnostics);

/// True where the flutes are all there is of the tool: it has nothing that could touch the stock without
/// cutting it.
bool is_bare(const cutter::Cutter& tool);

}  // namespace swarf::sim
