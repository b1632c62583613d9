#include "base/side_by_side.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include "base/check.h"
#include "base/parallel.h"

namespace swarf {
namespace {

/// The most that were at work at one moment; all were done, and told of in order.
int most_at_once(size_t n, size_t most) {
  std::atomic<int> now{0}, highest{0};
  std::vector<std::atomic<int>> worked(n);
  std::vector<size_t> told;
  const std::thread::id caller = std::this_thread::get_id();
  side_by_side(
      n, most,
      [&](size_t i) {
        const int here = ++now;
        for (int seen = highest; here > seen && !highest.compare_exchange_weak(seen, here);) {
        }
        // The first two wait for each other where two may work at once, however late a thread begins.
        const bool waits = i < 2 && n > 1 && most > 1 && thread_count() > 1;
        for (int k = 0; waits && highest < 2 && k < 10'000; ++k)
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
        ++worked[i];
        --now;
      },
      [&](size_t i) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        EXPECT_EQ(worked[i], 1);
        told.push_back(i);
      });
  EXPECT_EQ(told.size(), n);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  return highest;
}

TEST(SideBySide, DoesAllAndTellsInOrder) {
  EXPECT_EQ(most_at_once(0, 2), 0);
  EXPECT_EQ(most_at_once(9, 1), 1);
  const int wide = std::min(thread_count(), 2);
  EXPECT_LE(most_at_once(9, 2), wide);
  EXPECT_EQ(most_at_once(2, 9), wide);
}

TEST(SideBySide, KeepsToOneThreadWhereNoMoreIsAllowed) {
  set_thread_count(1);
  const std::thread::id caller = std::this_thread::get_id();
  side_by_side(
      3, 2, [&](size_t) { EXPECT_EQ(std::this_thread::get_id(), caller); }, [](size_t) {});
  set_thread_count(0);
}

TEST(SideBySide, FinishesWhatBeganAndBeginsNoMoreAfterAFault) {
  std::atomic<int> begun{0}, ended{0};
  std::vector<size_t> told;
  const auto work = [&](size_t i) {
    ++begun;
    if (i == 1) throw std::runtime_error("one");
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ++ended;
  };
  EXPECT_THROW(side_by_side(100, 2, work, [&](size_t i) { told.push_back(i); }), std::runtime_error);
  EXPECT_EQ(told, std::vector<size_t>{0});
  EXPECT_EQ(begun, ended + 1);
  EXPECT_LE(begun, 3);
}

TEST(SideBySide, RefusesToBeginNothing) {
  EXPECT_THROW(side_by_side(
                   3, 0, [](size_t) {}, [](size_t) {}),
               InternalError);
}

}  // namespace
}  // namespace swarf
