#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cfenv>
#include <chrono>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "base/check.h"

namespace swarf {
namespace {

using Chunks = std::set<std::pair<size_t, size_t>>;

Chunks chunks_of(size_t n, size_t chunk) {
  Chunks chunks;
  std::mutex mutex;
  parallel_chunks(n, chunk, [&](size_t begin, size_t end) {
    const std::lock_guard lock(mutex);
    EXPECT_TRUE(chunks.emplace(begin, end).second) << "chunk " << begin << " ran twice";
  });
  return chunks;
}

/// Chunks compute as their caller does, whatever whoever started the other threads had set.
TEST(ParallelChunks, RoundAsTheirCaller) {
  const int before = std::fegetround();
  for (const int mode : {FE_UPWARD, FE_TOWARDZERO, FE_TONEAREST}) {
    std::fesetround(mode);
    std::atomic<int> others{0};
    parallel_chunks(64, 1, [&](size_t, size_t) {
      if (std::fegetround() != mode) ++others;
      std::this_thread::sleep_for(std::chrono::microseconds(50));  // long enough for others to help
    });
    EXPECT_EQ(others, 0) << "mode " << mode;
  }
  std::fesetround(before);
}

TEST(ParallelChunks, CoversEveryItemOnce) {
  for (const size_t n : {1U, 7U, 8U, 9U, 1000U}) {
    for (const size_t chunk : {1U, 8U, 5000U}) {
      std::vector<std::atomic<int>> seen(n);
      parallel_chunks(n, chunk, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) ++seen[i];
      });
      for (size_t i = 0; i < n; ++i)
        ASSERT_EQ(seen[i], 1) << "item " << i << " of " << n << ", chunk " << chunk;
    }
  }
}

TEST(ParallelChunks, BordersDoNotDependOnTheNumberOfThreads) {
  const Chunks expected = {{0, 4}, {4, 8}, {8, 10}};
  for (const int threads : {1, 2, 3, 0}) {
    set_thread_count(threads);
    EXPECT_EQ(chunks_of(10, 4), expected) << threads << " threads";
  }
  set_thread_count(0);
}

TEST(ParallelChunks, DoesNothingForNothing) {
  EXPECT_TRUE(chunks_of(0, 4).empty());
}

TEST(ParallelChunks, RefusesEmptyChunks) {
  EXPECT_THROW(parallel_chunks(3, 0, [](size_t, size_t) {}), InternalError);
}

TEST(ParallelChunks, HandsExceptionsToTheCaller) {
  const auto fail_at_8 = [](size_t begin, size_t) {
    if (begin == 8) throw std::runtime_error("chunk 8");
  };
  EXPECT_THROW(parallel_chunks(20, 4, fail_at_8), std::runtime_error);
}

TEST(ThreadCount, IsWhatWasSetAndAtLeastOne) {
  set_thread_count(1);
  EXPECT_EQ(thread_count(), 1);
  set_thread_count(0);
  EXPECT_GE(thread_count(), 1);
}

}  // namespace
}  // namespace swarf
