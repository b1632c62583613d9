#include "base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <memory>

#include "base/check.h"

namespace swarf {
namespace {

std::unique_ptr<tbb::global_control>& control() {
  static std::unique_ptr<tbb::global_control> instance;
  return instance;
}

#ifdef __SANITIZE_THREAD__
constexpr bool kThreadSanitizer = true;
#else
constexpr bool kThreadSanitizer = false;
#endif

/// TBB is not instrumented: the thread sanitizer does not see that a loop starts behind what was written
/// before it, and that its chunks are finished when it returns. This pair says so, and orders no chunk
/// against another, so that races between chunks are still found.
class LoopOrder {
 public:
  void started() {
    if (kThreadSanitizer) begun_.store(true, std::memory_order_release);
  }
  void chunk_begins() const {
    if (kThreadSanitizer) static_cast<void>(begun_.load(std::memory_order_acquire));
  }
  void chunk_ends() {
    if (kThreadSanitizer) ended_.fetch_add(1, std::memory_order_release);
  }
  void returned() const {
    if (kThreadSanitizer) static_cast<void>(ended_.load(std::memory_order_acquire));
  }

 private:
  std::atomic<bool> begun_{false};
  std::atomic<size_t> ended_{0};
};

}  // namespace

void set_thread_count(int threads) {
  control().reset();
  if (threads > 0) {
    control() = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                      static_cast<size_t>(threads));
  }
}

int thread_count() {
  return static_cast<int>(
      std::min<size_t>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism),
                       static_cast<size_t>(tbb::info::default_concurrency())));
}

void parallel_chunks(size_t n, size_t chunk, const std::function<void(size_t, size_t)>& body) {
  SWARF_CHECK(chunk > 0, "a chunk has at least one item");
  const size_t count = (n + chunk - 1) / chunk;
  LoopOrder order;
  order.started();
  // Else the other threads round, and treat numbers near zero, as whoever started them did: Embree's do not
  // know denormal ones.
  tbb::task_group_context as_here(tbb::task_group_context::bound, tbb::task_group_context::default_traits |
                                                                      tbb::task_group_context::fp_settings);
  tbb::parallel_for(
      size_t{0}, count,
      [&](size_t i) {
        order.chunk_begins();
        body(i * chunk, std::min(n, (i + 1) * chunk));
        order.chunk_ends();
      },
      as_here);
  order.returned();
}

void isolated(const std::function<void()>& work) {
  tbb::this_task_arena::isolate(work);
}

}  // namespace swarf
