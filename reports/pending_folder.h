// Results are replaced whole or not at all: a folder is written beside its final place and moved there when
// complete.
#pragma once

#include <filesystem>
#include <string>

namespace swarf::reports {

/// Exists next to its target until move_into_place(); otherwise it vanishes with this object.
class PendingFolder {
 public:
  /// Throws InputError "cannot-write" when nothing can be written there.
  explicit PendingFolder(const std::string& target);
  ~PendingFolder();
  PendingFolder(const PendingFolder&) = delete;
  PendingFolder& operator=(const PendingFolder&) = delete;

  /// Path of a file inside the pending folder.
  std::string file(const std::string& name) const;
  std::string path() const { return pending_.string(); }
  /// Takes the target's place; what stood there is removed last, except for files whose names are not
  /// swarf's: they stay in the folder.
  void move_into_place();
  /// Gives what was written a place beside the target ("<target>.incomplete"), which is not touched; returns
  /// it. For results that could not all be written.
  std::string keep_incomplete();

 private:
  std::filesystem::path target_, pending_;
};

/// Refuses, before any work, a folder that cannot be written or that holds anything but an earlier result,
/// known by the file `mark`: a file, a mount point, the current folder, a place without room for `bytes`.
/// Throws InputError "output-in-the-way" or "cannot-write".
void check_output_folder(const std::string& folder, const std::string& mark, double bytes = 0.0);

/// Refuses, before any work, a file that cannot be written: its folder is missing or may not be written, or a
/// folder stands in its place. Throws InputError "cannot-write". "" is no file and no error.
void check_output_file(const std::string& path);

/// Writes a whole small file: to a temporary name, then renamed. Throws InputError "cannot-write" with the
/// reason.
void write_text(const std::string& path, const std::string& text);

}  // namespace swarf::reports
