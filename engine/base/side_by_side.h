// Long pieces of work beside each other, for those whose own parallel parts leave processors idle.
#pragma once

#include <cstddef>
#include <functional>

namespace swarf {

/// Runs work(i) for each i of [0, n), begun in this order and `most` at once at the most, each on a thread of
/// its own that may have parallel parts: for what keeps one processor for long stretches. `done(i)` is called
/// in order, by the caller's thread. With one thread allowed the caller does it all. What an item throws
/// comes out at its turn: those that were begun are finished first, and no further one begins.
void side_by_side(size_t n, size_t most, const std::function<void(size_t)>& work,
                  const std::function<void(size_t)>& done);

}  // namespace swarf
