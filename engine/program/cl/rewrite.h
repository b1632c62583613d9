// CL data with other positions: the user's own file, but for the statements that give them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "program/cl/program.h"

namespace swarf::program {

/// Positions that may be given anew (ClPosition), in the order of the file. Throws InputError where the text
/// cannot be read.
std::vector<ClPosition> positions_of(const std::string& text, const std::string& file,
                                     const ClOptions& options = {});

/// The text with these positions, by line of their statements; every line keeps its number. What a statement
/// that says no axis takes over from a changed one before it is written out. Nine digits behind the point;
/// read again, every move ends where it is meant to within 1e-6 mm and 1e-6 rad, or InputError "block-fixed":
/// its words hold the pose some other way (an arc, a hole, GODLTA).
std::string rewrite_cl(const std::string& text, const std::string& file,
                       const std::map<int, ToolPose>& changed, const ClOptions& options = {});

}  // namespace swarf::program
