// An iterator over anything that is asked by number: what it gives out is made anew each time.
#pragma once

#include <cstddef>
#include <iterator>
#include <utility>

namespace swarf {

/// Over row[0], row[1], ..; the row must outlive it and stay where it is.
template <typename Row>
class IndexIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = decltype(std::declval<const Row&>()[size_t{0}]);
  using difference_type = std::ptrdiff_t;
  using pointer = void;
  using reference = value_type;

  IndexIterator(const Row& row, size_t at) : row_(&row), at_(at) {}
  value_type operator*() const { return (*row_)[at_]; }
  IndexIterator& operator++() {
    ++at_;
    return *this;
  }
  IndexIterator operator++(int) {
    const IndexIterator before = *this;
    ++at_;
    return before;
  }
  bool operator==(const IndexIterator& other) const { return at_ == other.at_; }

 private:
  const Row* row_;
  size_t at_;
};

}  // namespace swarf
