// swarf check of CL data: read line by line, nothing simulated.
#pragma once

#include <string>

#include "cli/checked.h"
#include "program/cl/program.h"

namespace swarf::cli {

/// True for the endings of CL data: .cl .cls .clt .ncl .apt .aptsource .cldata, numbered versions of Creo
/// (.ncl.3) too.
bool is_cl_file(const std::string& file);

/// Reads the file and tells writer, statements, moves, paths, tools, start, extents and what was taken as
/// given. Memory does not grow with the file. Throws InputError.
Checked check_cl(const std::string& file, const program::ClOptions& options);

}  // namespace swarf::cli
