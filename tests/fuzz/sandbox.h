// Cases that may crash, hang or eat memory, run in children of this process.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace swarf::test {

/// The number that a variable of the environment gives.
uint64_t from_environment(const char* name, uint64_t otherwise);

struct SandboxFailure {
  uint64_t number = 0;  ///< of the case
  std::string what;     ///< "signal 11", "no end after 10 s", or what the case said
};

struct SandboxCounts {
  uint64_t accepted = 0, refused = 0;
};

/// What a case found: the input was read, it was refused as input is refused, or something that must not be.
enum class CaseOutcome { kAccepted, kRefused, kWrong };
struct CaseResult {
  CaseOutcome outcome = CaseOutcome::kAccepted;
  std::string what;  ///< of kWrong
};

/// Runs cases `begin` to `end` in forked children, one after the other in each, with 4 GB of address space
/// and 10 s for each case. A child that ends early costs its case only: the next one goes on behind it.
std::vector<SandboxFailure> run_in_sandbox(uint64_t begin, uint64_t end,
                                           const std::function<CaseResult(uint64_t)>& run_case,
                                           SandboxCounts& counts,
                                           std::chrono::seconds time = std::chrono::seconds(10));

}  // namespace swarf::test
