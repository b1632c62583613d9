// Commands as text that a shell takes back.
#pragma once

#include <string>
#include <vector>

namespace swarf::cli {

/// The words with a space between them, each quoted for a POSIX shell where it needs to be.
std::string shell_text(const std::vector<std::string>& words);

}  // namespace swarf::cli
