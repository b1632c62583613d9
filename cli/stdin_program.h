// An NC program that comes through a pipe: swarf check -
#pragma once

#include <filesystem>
#include <vector>

#include "base/diagnostics.h"

namespace swarf::cli {

/// A copy of the standard input as a file, for readers that take files; it vanishes with this object.
class StdinProgram {
 public:
  /// Reads to the end. Throws InputError "cannot-write" where there is no room for it, "empty-file".
  StdinProgram();
  ~StdinProgram();
  StdinProgram(const StdinProgram&) = delete;
  StdinProgram& operator=(const StdinProgram&) = delete;

  std::string file() const { return file_.string(); }
  /// Messages call it "stdin".
  void name_places(std::vector<Diagnostic>& told) const;

 private:
  std::filesystem::path folder_, file_;
};

}  // namespace swarf::cli
