// Where the files in a run's input/ come from and what they held, so that a later command knows whether the
// run would be the same again.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace swarf::reports {

/// The list of sources that stands in an input/ folder.
inline constexpr const char* kSourcesFile = "sources.json";

/// Adds files, by their full paths with checksums of what they hold now, to the list in `input`. Throws
/// InputError "file-unreadable" and "cannot-write".
void add_sources(const std::filesystem::path& input, const std::vector<std::filesystem::path>& files);

/// What has changed since the run was made, in a few words with the file's name; "" when every source, those
/// of all its set-ups too, holds what it held. A folder without a list has changed: nothing is known of it.
std::string changed_source(const std::filesystem::path& run_folder);

}  // namespace swarf::reports
