// Where tests write: a folder of this process, so that no two of them meet, removed when it ends.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace swarf::test {

/// Made at the first call. With SWARF_KEEP_SCRATCH in the environment it stays.
inline const std::filesystem::path& scratch_folder() {
  struct Folder {
    pid_t owner = getpid();
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("swarf_test_" + std::to_string(owner));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() {
      std::error_code ignored;
      // A child that was forked off leaves its parent's folder alone.
      if (getpid() == owner && std::getenv("SWARF_KEEP_SCRATCH") == nullptr)
        std::filesystem::remove_all(path, ignored);
    }
  };
  static const Folder folder;
  return folder.path;
}

/// The same as text that a file name is written behind.
inline std::string scratch_text() {
  return scratch_folder().string() + "/";
}

}  // namespace swarf::test
