// Values one behind the other in a row of bytes, for messages between processes of one program on one kind of
// machine: as they lie in memory, no portable format.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "base/check.h"

namespace swarf {

using Bytes = std::vector<std::byte>;

template <typename T>
concept PlainValue = std::is_trivially_copyable_v<T>;

class BytesWriter {
 public:
  template <PlainValue T>
  void add(const T& value) {  // one
    add_all(std::span(&value, 1));
  }
  /// The values without their number.
  template <PlainValue T>
  void add_all(std::span<const T> values) {
    const size_t at = bytes_.size();  // behind what is there
    bytes_.resize(at + values.size_bytes());
    if (!values.empty()) std::memcpy(bytes_.data() + at, values.data(), values.size_bytes());
  }
  /// Their number, then the values.
  template <PlainValue T>
  void add_list(const std::vector<T>& values) {
    add(values.size());
    add_all(std::span(values));
  }
  void add_text(const std::string& text) {  // as a list of its characters
    add(text.size());
    add_all(std::span(text));
  }
  size_t size() const { return bytes_.size(); }  ///< so far
  Bytes take() { return std::move(bytes_); }     ///< all of it; the writer is empty then

 private:
  Bytes bytes_;  ///< so far
};

/// Reads what BytesWriter has written, in its order; more than is there is our own fault.
class BytesReader {
 public:
  /// `bytes` must outlive it.
  explicit BytesReader(const Bytes& bytes) : bytes_(bytes) {}
  bool at_end() const { return at_ == bytes_.size(); }  ///< nothing is left

  template <PlainValue T>
  T get() {  // of add()
    T value;
    get_all(std::span(&value, 1));
    return value;
  }
  template <PlainValue T>
  void get_all(std::span<T> values) {  // of add_all()
    SWARF_CHECK(bytes_.size() - at_ >= values.size_bytes(), "a message is shorter than what it holds");
    if (!values.empty()) std::memcpy(values.data(), bytes_.data() + at_, values.size_bytes());
    at_ += values.size_bytes();
  }
  template <PlainValue T>
  std::vector<T> get_list() {  // of add_list()
    std::vector<T> values(count(sizeof(T)));
    get_all(std::span(values));
    return values;
  }
  std::string get_text() {  // of add_text()
    std::string text(count(1), '\0');
    get_all(std::span(text));
    return text;
  }

 private:
  size_t count(size_t each) {  // that stands next; no more than there is room for
    const auto number = get<size_t>();
    SWARF_CHECK(number <= (bytes_.size() - at_) / each, "a message is shorter than what it holds");
    return number;
  }

  const Bytes& bytes_;  ///< all of the message
  size_t at_ = 0;       ///< of the next value
};

}  // namespace swarf
