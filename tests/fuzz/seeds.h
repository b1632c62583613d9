// Sound files that the fuzz test damages.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "fuzz/sandbox.h"

namespace swarf::test {

/// One kind of input: sound files and the loader that must survive damaged ones.
struct FuzzKind {
  std::string name;
  int share = 1;  ///< of all files
  struct Seed {
    std::string bytes;
    std::filesystem::path place;  ///< folder and ending of the damaged file: what it names lies there
    std::string ending;
  };
  std::vector<Seed> seeds;
  std::function<CaseResult(const std::string& path)> load;
};

/// All kinds; their files and what these name lie below `folder`.
std::vector<FuzzKind> fuzz_kinds(const std::filesystem::path& folder);

}  // namespace swarf::test
