// CL data as text again, for post-processors and other programs.
#pragma once

#include <string>

#include "program/cl/program.h"

namespace swarf::program {

/// The program in mm and in the work frame, without cycles, systems and compensation of the contour:
/// parse_cl() gives the same moves back, tips, axes and arcs to the last bit, feeds and speeds to rounding.
/// CUTCOM of files whose points are the cutter's centre is written as it stood, to be read with the same
/// ClOptions.
std::string write_cl(const ClProgram& program);

}  // namespace swarf::program
