// A 64-bit hash of results (FNV-1a by words): equal hashes mean bit-identical results.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

namespace swarf {

/// Depends on the order of what is added, and on how it is cut into words.
class Hash {
 public:
  void add(uint64_t word) {
    state_ = (state_ ^ word) * 0x100000001b3ULL;
    state_ ^= state_ >> 32;
  }
  /// By its bits: 0 and -0 differ.
  void add(double value) { add(std::bit_cast<uint64_t>(value)); }
  void add(float value) { add(uint64_t{std::bit_cast<uint32_t>(value)}); }
  uint64_t value() const { return state_; }
  /// 16 hexadecimal digits.
  std::string text() const;

 private:
  uint64_t state_ = 0xcbf29ce484222325ULL;
};

}  // namespace swarf
