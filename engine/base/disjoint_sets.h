// Sets that are joined two by two; Galler & Fischer, An Improved Equivalence Algorithm, 1964.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace swarf {

/// Of the numbers 0 to count - 1, each alone at first. The root of a set is its smallest number, so that what
/// is made of the sets does not depend on the order in which they were joined.
class DisjointSets {
 public:
  explicit DisjointSets(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

  /// The number that stands for the set of n.
  uint32_t root(uint32_t n) {
    while (parent_[n] != n) n = parent_[n] = parent_[parent_[n]];
    return n;
  }
  /// Makes one set of those of a and b.
  void join(uint32_t a, uint32_t b) {
    const uint32_t ra = root(a), rb = root(b);
    parent_[std::max(ra, rb)] = std::min(ra, rb);
  }

 private:
  std::vector<uint32_t> parent_;
};

}  // namespace swarf
