// Results are replaced whole or not at all: a folder is written beside its final place and moved there when
// complete.
#pragma once

#include <filesystem>
#include <string>

namespace swarf::reports {

/// Exists next to its target until move_into_place(); otherwise it vanishes with this object.
class PendingFolder {
 public:
  explicit PendingFolder(const std::string& target);
  ~PendingFolder();
  PendingFolder(const PendingFolder&) = delete;
  PendingFolder& operator=(const PendingFolder&) = delete;

  /// Path of a file inside the pending folder.
  std::string file(const std::string& name) const;
  std::string path() const { return pending_.string(); }
  /// Takes the target's place; what stood there is removed last.
  void move_into_place();

 private:
  std::filesystem::path target_, pending_;
};

/// Refuses a folder that holds anything but an earlier result, known by the file `mark`. Throws InputError.
void check_output_folder(const std::string& folder, const std::string& mark);

/// Writes a whole small file; throws std::runtime_error when it cannot.
void write_text(const std::string& path, const std::string& text);

}  // namespace swarf::reports
