#include "base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>

#include "base/check.h"

namespace swarf {
namespace {

std::unique_ptr<tbb::global_control>& control() {
  static std::unique_ptr<tbb::global_control> instance;
  return instance;
}

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
  tbb::parallel_for(size_t{0}, count, [&](size_t i) { body(i * chunk, std::min(n, (i + 1) * chunk)); });
}

}  // namespace swarf
