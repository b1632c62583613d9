// Parallel loops with results that do not depend on the number of threads: fixed chunks, no shared sums.
#pragma once

#include <cstddef>
#include <functional>

namespace swarf {

/// Limits all parallel work of the process to `threads` (0: all cores). Call once, early.
void set_thread_count(int threads);
int thread_count();

/// Runs body(begin, end) over [0, n) in chunks of exactly `chunk` items (the last may be shorter).
/// Chunk borders depend on n and chunk only, never on the number of threads.
void parallel_chunks(size_t n, size_t chunk, const std::function<void(size_t begin, size_t end)>& body);

/// Runs the work on this thread. While it waits for parallel parts of it, the thread takes up nothing else:
/// for what is made once, behind a lock that such other work might wait for.
void isolated(const std::function<void()>& work);

}  // namespace swarf
