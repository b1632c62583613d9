// What every reader asks of a path before it opens it.
#pragma once

#include <string>

namespace swarf {

/// Throws InputError "no-regular-file" for what is there but is no file with an end: a device, a pipe, a
/// socket. Opening or reading those may wait for ever. A missing file and a folder are left to the reader,
/// which knows what ought to be there.
void refuse_special_file(const std::string& path);

}  // namespace swarf
