#include "cli/child_run.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "base/diagnostics.h"
#include "cli/commands.h"

namespace swarf::cli {
namespace {

constexpr const char* kThisProgram = "/proc/self/exe";

/// In the child, between fork and exec: nothing but calls that are safe in both. Does not return.
[[noreturn]] void become(char* const* words, int log) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGINT);
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  execv(kThisProgram, words);
  _exit(kInternalError);
}

}  // namespace

pid_t start_child(const std::vector<std::string>& words, const std::string& log) {
  const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0)
    throw InputError("cannot-write", {log}, fmt::format("this cannot be written: {}", std::strerror(errno)),
                     "check that the folder may be written and has space");
  std::vector<std::string> kept{"swarf"};
  kept.insert(kept.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  for (std::string& word : kept) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) become(pointers.data(), file);
  const int fault = errno;
  close(file);
  if (child < 0)
    throw InputError("cannot-start", {kThisProgram},
                     fmt::format("a run cannot be started: {}", std::strerror(fault)),
                     "free memory or processes, or take a smaller --at-once");
  return child;
}

void stop_child(pid_t child) {
  kill(child, SIGINT);
}

int exit_code_of(int wait_status) {
  return WIFEXITED(wait_status) ? WEXITSTATUS(wait_status) : 128 + WTERMSIG(wait_status);
}

}  // namespace swarf::cli
