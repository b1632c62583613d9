#include "base/input_file.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/diagnostics.h"

namespace swarf {
namespace {

namespace fs = std::filesystem;

/// What the path names, if it is neither a file, nor a folder, nor missing.
const char* special_kind(fs::file_type type) {
  switch (type) {
    case fs::file_type::character:
      return "a device";
    case fs::file_type::block:
      return "a disk";
    case fs::file_type::fifo:
      return "a pipe";
    case fs::file_type::socket:
      return "a socket";
    default:
      return nullptr;
  }
}

}  // namespace

void refuse_special_file(const std::string& path) {
  std::error_code ignored;
  const char* kind = special_kind(fs::status(path, ignored).type());
  if (kind == nullptr) return;
  throw InputError("no-regular-file", {path}, fmt::format("this is {}, no file", kind),
                   "name a file; what a pipe brings must be saved first");
}

}  // namespace swarf
