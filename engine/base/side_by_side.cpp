#include "base/side_by_side.h"

#include <algorithm>
#include <deque>
#include <future>

#include "base/check.h"
#include "base/parallel.h"

namespace swarf {

void side_by_side(size_t n, size_t most, const std::function<void(size_t)>& work,
                  const std::function<void(size_t)>& done) {
  SWARF_CHECK(most > 0, "nothing would ever begin");
  const bool alone = std::min(most, static_cast<size_t>(thread_count())) == 1;
  std::deque<std::future<void>> running;
  size_t finished = 0;
  const auto take = [&] {
    running.front().get();
    running.pop_front();
    done(finished++);
  };
  for (size_t i = 0; i < n; ++i) {
    if (running.size() == most) take();
    running.push_back(
        std::async(alone ? std::launch::deferred : std::launch::async, [&work, i] { work(i); }));
    if (alone) take();
  }
  while (!running.empty()) take();
}

}  // namespace swarf
