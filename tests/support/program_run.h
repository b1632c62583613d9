// Runs the shipped program and collects what it printed.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "support/scratch.h"

namespace swarf::test {

struct ProgramRun {
  int exit_code = -1;
  std::string output;  ///< stdout and stderr together
};

/// A command of the shell.
inline ProgramRun run_command(const std::string& words) {
  const std::string command = "{ " + words + "; } 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot start " + command);
  ProgramRun run;
  std::array<char, 4096> buffer{};
  while (const size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe))
    run.output.append(buffer.data(), count);
  const int status = pclose(pipe);
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return run;
}

inline ProgramRun run_swarf(const std::string& arguments) {
  return run_command(std::string(SWARF_PROGRAM) + " " + arguments);
}

/// Limits of a scene so wide that the proof of them is short: for tests of something else, as it is most of a
/// run.
inline constexpr const char* kSoonProven =
    " --set accept.scallop_max_um=100 --set accept.excess_max_um=100 --set accept.gouge_max_um=100 ";

/// An empty folder of this test's own, below the system's temporary folder.
inline std::filesystem::path fresh_folder(const std::string& name) {
  const auto folder = scratch_folder() / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace swarf::test
