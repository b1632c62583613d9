#include "fuzz/sandbox.h"

#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <stdexcept>
#include <thread>

namespace swarf::test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLook{2};
constexpr rlim_t kMemory = rlim_t{4} << 30U;

/// Seen by the child and by us.
struct Shared {
  std::atomic<uint64_t> at, accepted, refused, wrong;
  char what[200];
};
static_assert(std::atomic<uint64_t>::is_always_lock_free);

/// The address sanitizer needs terabytes of address space that it never fills.
void limit_memory() {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  const rlimit limit{kMemory, kMemory};
  setrlimit(RLIMIT_AS, &limit);
#endif
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
}

[[noreturn]] void run_child(Shared& shared, uint64_t end,
                            const std::function<CaseResult(uint64_t)>& run_case) {
  limit_memory();
  for (; shared.at < end; ++shared.at) {
    const CaseResult result = run_case(shared.at);
    if (result.outcome == CaseOutcome::kWrong) {
      std::snprintf(shared.what, sizeof(shared.what), "%s", result.what.c_str());
      shared.wrong = 1;
      _exit(1);
    }
    ++(result.outcome == CaseOutcome::kAccepted ? shared.accepted : shared.refused);
  }
  _exit(0);
}

/// "" when the child came to its end.
std::string wait_for(pid_t child, const Shared& shared, std::chrono::seconds time) {
  uint64_t last = shared.at;
  auto since = Clock::now();
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (shared.at != last) {
      last = shared.at;
      since = Clock::now();
    } else if (Clock::now() - since > time) {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      return "no end after " + std::to_string(time.count()) + " s";
    }
    std::this_thread::sleep_for(kLook);
  }
  if (WIFSIGNALED(status)) return "signal " + std::to_string(WTERMSIG(status));
  if (shared.wrong != 0) return shared.what;
  return WEXITSTATUS(status) == 0 ? "" : "exit " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

uint64_t from_environment(const char* name, uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

std::vector<SandboxFailure> run_in_sandbox(uint64_t begin, uint64_t end,
                                           const std::function<CaseResult(uint64_t)>& run_case,
                                           SandboxCounts& counts, std::chrono::seconds time) {
  void* memory = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("no shared memory");
  Shared& shared = *new (memory) Shared{};
  shared.at = begin;
  std::vector<SandboxFailure> failures;
  while (shared.at < end) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("cannot fork");
    if (child == 0) run_child(shared, end, run_case);
    const std::string what = wait_for(child, shared, time);
    if (what.empty()) continue;
    failures.push_back({shared.at, what});
    shared.wrong = 0;
    ++shared.at;
  }
  counts.accepted += shared.accepted;
  counts.refused += shared.refused;
  munmap(memory, sizeof(Shared));
  return failures;
}

}  // namespace swarf::test
