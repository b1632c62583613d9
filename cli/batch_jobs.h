// jobs.toml: runs that belong together, for `swarf batch`.
#pragma once

#include <string>
#include <vector>

namespace swarf::cli {

struct BatchJob {
  std::string name;                    ///< of its folder in the results; unique
  std::string file;                    ///< scene, NC program or CL data, as a path from the working folder
  std::vector<std::string> arguments;  ///< further words of swarf run
};

struct Batch {
  std::string title;
  std::vector<BatchJob> jobs;  ///< at least one
};

/// Reads the file; patterns (*, ?, [..]) become a job for each file that they match, in alphabetical order.
/// Paths are relative to the file. Throws InputError with everything that is wrong: unknown keys, a pattern
/// without a match, two jobs of one name, an argument that batch itself gives.
Batch load_batch(const std::string& path);

}  // namespace swarf::cli
