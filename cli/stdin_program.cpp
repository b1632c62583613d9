#include "cli/stdin_program.h"

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <system_error>

namespace swarf::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStdin = "stdin";

fs::path fresh_folder() {
  std::string name = (fs::temp_directory_path() / "swarf_XXXXXX").string();
  if (mkdtemp(name.data()) != nullptr) return name;
  throw InputError("cannot-write", {name}, "the standard input cannot be kept here while it is read",
                   "set TMPDIR to a folder that may be written");
}

}  // namespace

StdinProgram::StdinProgram() : folder_(fresh_folder()), file_(folder_ / "stdin.nc") {
  std::ofstream copy(file_, std::ios::binary);
  if (std::cin.peek() != std::char_traits<char>::eof()) copy << std::cin.rdbuf();
  copy.close();
  std::error_code problem;
  const bool empty = fs::file_size(file_, problem) == 0;
  if (copy && !empty) return;
  fs::remove_all(folder_, problem);
  if (empty)
    throw InputError("empty-file", {kStdin}, "nothing came", "pipe a program into it, or name a file");
  throw InputError("cannot-write", {file_.string()},
                   "the standard input cannot be kept here while it is read",
                   "make room, or set TMPDIR to a folder with room");
}

StdinProgram::~StdinProgram() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void StdinProgram::name_places(std::vector<Diagnostic>& told) const {
  for (Diagnostic& one : told) {
    if (one.where.file == file_) one.where.file = kStdin;
  }
}

}  // namespace swarf::cli
