// Values one behind the other in a row of bytes, for messages between processes of one program on one kind of
// machine: as they lie in memory, no portable format.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/check.h"

namespace swarf {

/// Leaves bytes that are overwritten at once as they are: messages have many megabytes.
template <typename T>
struct UninitialisedAllocator : std::allocator<T> {
  template <typename U>
  struct rebind {
    using other = UninitialisedAllocator<U>;
  };
  template <typename U>
  void construct(U* at) {
    ::new (static_cast<void*>(at)) U;
  }
  template <typename U, typename... Arguments>
  void construct(U* at, Arguments&&... arguments) {
    std::construct_at(at, std::forward<Arguments>(arguments)...);
  }
};

using Bytes = std::vector<std::byte, UninitialisedAllocator<std::byte>>;

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
  template <PlainValue T, typename Allocator>
  void add_list(const std::vector<T, Allocator>& values) {
    add(values.size());
    add_all(std::span(values));
  }
  void add_text(const std::string& text) {  // as a list of its characters
    add(text.size());
    add_all(std::span(text));
  }
  /// What follows may be looked at where it stands, as values of this type.
  template <PlainValue T>
  void align() {
    bytes_.resize((bytes_.size() + alignof(T) - 1) / alignof(T) * alignof(T), std::byte{0});
  }
  void reserve(size_t more) { bytes_.reserve(bytes_.size() + more); }  ///< so many bytes will be added
  size_t size() const { return bytes_.size(); }                        ///< so far
  Bytes take() { return std::move(bytes_); }  ///< all of it; the writer is empty then

 private:
  Bytes bytes_;  ///< so far
};

/// Reads what BytesWriter has written, in its order; more than is there is our own fault.
class BytesReader {
 public:
  /// `bytes` must outlive it.
  explicit BytesReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
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
  /// Of add_list() with bytes, where they stand.
  std::span<const std::byte> get_bytes() {
    const size_t number = count(1);
    return bytes_.subspan(std::exchange(at_, at_ + number), number);
  }
  /// Of BytesWriter::align() and add_all(), where they stand.
  template <PlainValue T>
  std::span<const T> look_at(size_t number) {
    at_ = (at_ + alignof(T) - 1) / alignof(T) * alignof(T);
    SWARF_CHECK(at_ <= bytes_.size() && number <= (bytes_.size() - at_) / sizeof(T),
                "a message is shorter than what it holds");
    const std::byte* const first = bytes_.data() + at_;
    SWARF_CHECK(reinterpret_cast<uintptr_t>(first) % alignof(T) == 0, "a message stands where values may");
    at_ += number * sizeof(T);
    return {reinterpret_cast<const T*>(first), number};
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

  std::span<const std::byte> bytes_;  ///< all of the message
  size_t at_ = 0;                     ///< of the next value
};

}  // namespace swarf
