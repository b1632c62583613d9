// What `swarf --version` prints.
#pragma once

#include <string>

namespace swarf::cli {

/// Version, commit of the source, and the libraries whose versions decide what comes out, a line each.
std::string version_text();

}  // namespace swarf::cli
