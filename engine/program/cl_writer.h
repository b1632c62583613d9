// CL data as text again, for post-processors and other programs.
#pragma once

#include <string>

#include "program/cl_program.h"

namespace swarf::program {

/// The program in mm and in the work frame, without cycles and systems: parse_cl() gives the same moves back,
/// tips, axes and arcs to the last bit, feeds and speeds to rounding.
std::string write_cl(const ClProgram& program);

}  // namespace swarf::program
