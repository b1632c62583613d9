// Damaged files of every kind through the loaders: read or refused as input, never a crash, a hang, or a few
// bytes that make us ask for gigabytes.
//
//   SWARF_FUZZ_FILES   how many in all (2000; the full test is 20000)
//   SWARF_FUZZ_SEED    another start of the random numbers (1)
// A case that fails is kept as a file and named by seed, kind and number.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "base/diagnostics.h"
#include "fuzz/mutation.h"
#include "fuzz/sandbox.h"
#include "fuzz/seeds.h"
#include "support/program_run.h"

namespace swarf::test {
namespace {

namespace fs = std::filesystem;

/// The damaged file of a case, written where what it names can be found.
fs::path write_case(const FuzzKind& kind, uint64_t seed, uint64_t number) {
  Rng rng(seed * 0x9e3779b97f4a7c15ULL + number * 0x2545f4914f6cdd1dULL + kind.name.size() * 977 +
          kind.name[0]);
  const FuzzKind::Seed& from = kind.seeds[number % kind.seeds.size()];
  const fs::path path = from.place / ("case" + from.ending);
  write_text(path, damaged(from.bytes, rng));
  return path;
}

/// Everything but InputError would end the program with "internal error".
CaseResult guarded(const FuzzKind& kind, const std::string& path) {
  try {
    return kind.load(path);
  } catch (const InputError& error) {
    for (const Diagnostic& one : error.diagnostics.list()) {
      if (one.text.empty() || one.code.empty()) return {CaseOutcome::kWrong, "a refusal without a reason"};
    }
    return {CaseOutcome::kRefused, ""};
  } catch (const std::exception& error) {
    return {CaseOutcome::kWrong, std::string("exception: ") + error.what()};
  }
}

TEST(FuzzLoaders, DamagedFilesAreReadOrRefused) {
  const uint64_t files = from_environment("SWARF_FUZZ_FILES", 2000),
                 seed = from_environment("SWARF_FUZZ_SEED", 1);
  const fs::path folder = fresh_folder("fuzz_loaders"),
                 failed = fs::temp_directory_path() / "swarf_fuzz_failures";
  const std::vector<FuzzKind> kinds = fuzz_kinds(folder);
  int shares = 0;
  for (const FuzzKind& kind : kinds) shares += kind.share;
  uint64_t total = 0;
  for (const FuzzKind& kind : kinds) {
    const uint64_t count = (files * static_cast<uint64_t>(kind.share) + static_cast<uint64_t>(shares) - 1) /
                           static_cast<uint64_t>(shares);
    SandboxCounts counts;
    const auto failures = run_in_sandbox(
        0, count, [&](uint64_t n) { return guarded(kind, write_case(kind, seed, n).string()); }, counts);
    for (const SandboxFailure& failure : failures) {
      fs::create_directories(failed);
      const fs::path path = write_case(kind, seed, failure.number);
      const fs::path kept = failed / (kind.name + "_" + std::to_string(seed) + "_" +
                                      std::to_string(failure.number) + path.extension().string());
      fs::copy_file(path, kept, fs::copy_options::overwrite_existing);
      ADD_FAILURE() << kind.name << " case " << failure.number << " of seed " << seed << ": " << failure.what
                    << "; kept as " << kept;
    }
    std::cout << kind.name << ": " << count << " files, " << counts.accepted << " read, " << counts.refused
              << " refused, " << failures.size() << " failed\n";
    // A test whose files are all refused at their first byte would test nothing behind it.
    EXPECT_GT(counts.refused, count / 20) << kind.name;
    total += count;
  }
  EXPECT_GE(total, files);
  fs::remove_all(folder);
}

/// The sandbox itself sees what it is there for.
TEST(FuzzSandbox, TellsCrashesHangsMemoryAndWrongAnswersApart) {
  SandboxCounts counts;
  const auto failures = run_in_sandbox(
      0, 6,
      [](uint64_t n) -> CaseResult {
        if (n == 1) std::abort();
        if (n == 2) return {CaseOutcome::kRefused, ""};
        if (n == 3) return {CaseOutcome::kWrong, "wrong"};
        if (n == 4) {
          for (volatile bool forever = true; forever;) continue;
        }
        return {};
      },
      counts, std::chrono::seconds(1));
  ASSERT_EQ(failures.size(), 3U);
  EXPECT_EQ(failures[0].number, 1U);
  EXPECT_EQ(failures[0].what, "signal 6");
  EXPECT_EQ(failures[1].what, "wrong");
  EXPECT_EQ(failures[2].number, 4U);
  EXPECT_EQ(failures[2].what, "no end after 1 s");
  EXPECT_EQ(counts.accepted, 2U);
  EXPECT_EQ(counts.refused, 1U);
}

}  // namespace
}  // namespace swarf::test
