// An iterator over anything that is asked by number: what it gives out is made anew each time.
//
// Rows of a long program are kept packed and unpacked one by one (toolpath/elements.h,
// motion/blocks/block_motions.h). Nothing that a reference could point to stands anywhere, so it gives values
// and is an input iterator: good for range-based loops and for algorithms that read once from first to last.
#pragma once

#include <cstddef>
#include <iterator>
#include <utility>

namespace swarf {

/// Over row[0], row[1], ..; the row must outlive it and stay where it is. Equal iterators stand at one place;
/// those of different rows are not to be compared.
template <typename Row>
class IndexIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = decltype(std::declval<const Row&>()[size_t{0}]);
  using difference_type = std::ptrdiff_t;
  using pointer = void;
  using reference = value_type;

  /// At row[at]; the number of elements is the end.
  IndexIterator(const Row& row, size_t at) : row_(&row), at_(at) {}
  value_type operator*() const { return (*row_)[at_]; }
  IndexIterator& operator++() { return ++at_, *this; }
  IndexIterator operator++(int) { return {*row_, at_++}; }
  bool operator==(const IndexIterator& other) const { return at_ == other.at_; }

 private:
  const Row* row_;
  size_t at_;
};

}  // namespace swarf
