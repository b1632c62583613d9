#include "fuzz/mutation.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <vector>

namespace swarf::test {
namespace {

size_t below(Rng& rng, size_t count) {
  return count == 0 ? 0 : static_cast<size_t>(rng.next() % count);
}

template <typename List>
auto one_of(Rng& rng, const List& list) {
  return list[below(rng, list.size())];
}

// ---- bytes

void flip_bits(std::string& bytes, Rng& rng) {
  for (size_t i = 1 + below(rng, 8); i > 0 && !bytes.empty(); --i) {
    char& byte = bytes[below(rng, bytes.size())];
    byte = static_cast<char>(static_cast<unsigned char>(byte) ^ (1U << below(rng, 8)));
  }
}

void overwrite_bytes(std::string& bytes, Rng& rng) {
  for (size_t i = 1 + below(rng, 4); i > 0 && !bytes.empty(); --i)
    bytes[below(rng, bytes.size())] = static_cast<char>(rng.next() & 255U);
}

void cut_off(std::string& bytes, Rng& rng) {
  bytes.resize(below(rng, bytes.size()));
}

void leave_out(std::string& bytes, Rng& rng) {
  bytes.erase(below(rng, bytes.size()), 1 + below(rng, rng.next() % 4 == 0 ? bytes.size() : 16));
}

void repeat_piece(std::string& bytes, Rng& rng) {
  const size_t at = below(rng, bytes.size());
  const std::string piece = bytes.substr(at, 1 + below(rng, 64));
  bytes.insert(below(rng, bytes.size()), piece);
}

/// In place of what was there, so that everything behind stays where it was.
void put_bytes(std::string& bytes, size_t at, const void* value, size_t size) {
  if (at + size <= bytes.size()) std::memcpy(&bytes[at], value, size);
}

void put_float(std::string& bytes, Rng& rng) {
  using Limits = std::numeric_limits<float>;
  constexpr std::array<float, 10> kValues{Limits::quiet_NaN(),
                                          Limits::infinity(),
                                          -Limits::infinity(),
                                          -0.0F,
                                          Limits::max(),
                                          Limits::lowest(),
                                          Limits::denorm_min(),
                                          1e20F,
                                          999999.0F,
                                          -1e6F};
  const float value = one_of(rng, kValues);
  put_bytes(bytes, below(rng, bytes.size()) & ~size_t{rng.next() % 2 == 0 ? 3U : 0U}, &value, sizeof(value));
}

void put_double(std::string& bytes, Rng& rng) {
  using Limits = std::numeric_limits<double>;
  constexpr std::array<double, 7> kValues{
      Limits::quiet_NaN(), Limits::infinity(), -0.0, Limits::max(), Limits::denorm_min(), 1e300, -1e12};
  const double value = one_of(rng, kValues);
  put_bytes(bytes, below(rng, bytes.size()), &value, sizeof(value));
}

void put_integer(std::string& bytes, Rng& rng) {
  constexpr std::array<uint32_t, 8> kValues{0, 1, 0xffffffffU, 0x7fffffffU, 0x80000000U, 0xffffU, 255, 65536};
  const uint32_t value = one_of(rng, kValues);
  put_bytes(bytes, below(rng, bytes.size()), &value, 1U << below(rng, 3));
}

void swap_byte_order(std::string& bytes, Rng& rng) {
  const size_t size = size_t{2} << below(rng, 3);
  const size_t begin = below(rng, bytes.size()),
               end = std::min(bytes.size(), begin + size * (1 + below(rng, 200)));
  for (size_t at = begin; at + size <= end; at += size)
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                 bytes.begin() + static_cast<std::ptrdiff_t>(at + size));
}

// ---- text; of a binary file its header is the text

/// Begin and end of the pieces that `is_part` holds together.
template <typename IsPart>
std::vector<std::pair<size_t, size_t>> pieces(const std::string& bytes, IsPart is_part) {
  std::vector<std::pair<size_t, size_t>> found;
  for (size_t at = 0; at < bytes.size();) {
    size_t end = at;
    while (end < bytes.size() && is_part(static_cast<unsigned char>(bytes[end]))) ++end;
    if (end > at) found.emplace_back(at, end - at);
    at = end + 1;
  }
  return found;
}

bool is_number_part(unsigned char c) {
  return std::isdigit(c) != 0 || c == '.' || c == '-' || c == '+';
}
bool is_word_part(unsigned char c) {
  return std::isgraph(c) != 0;
}
bool is_line_part(unsigned char c) {
  return c != '\n';
}

void replace_number(std::string& bytes, Rng& rng) {
  constexpr std::array<std::string_view, 30> kNumbers{"nan",
                                                      "inf",
                                                      "-inf",
                                                      "1e308",
                                                      "-1e308",
                                                      "1e400",
                                                      "-0",
                                                      "0",
                                                      "-1",
                                                      "1e-320",
                                                      "1e-9",
                                                      "1e12",
                                                      "999999",
                                                      "1e6",
                                                      "1e7",
                                                      "0.001",
                                                      "4294967295",
                                                      "4294967296",
                                                      "2147483648",
                                                      "-2147483649",
                                                      "1e38",
                                                      "1e39",
                                                      "99999999999999999999999",
                                                      "0x10",
                                                      "1,5",
                                                      "+-1",
                                                      "1e",
                                                      ".",
                                                      "",
                                                      "3.0000001"};
  const auto found = pieces(bytes, is_number_part);
  if (found.empty()) return;
  const auto [at, size] = one_of(rng, found);
  bytes.replace(at, size, one_of(rng, kNumbers));
}

void scale_number(std::string& bytes, Rng& rng) {
  const auto found = pieces(bytes, is_number_part);
  if (found.empty()) return;
  const auto [at, size] = one_of(rng, found);
  constexpr std::array<std::string_view, 6> kTails{"0", "000", "e9", "e-9", "00000000", "1"};
  bytes.insert(at + size, one_of(rng, kTails));
}

/// Another digit for one to three: most such files are still read, and hold odd values.
void change_digits(std::string& bytes, Rng& rng) {
  const auto found = pieces(bytes, [](unsigned char c) { return std::isdigit(c) != 0; });
  for (size_t i = 1 + below(rng, 3); i > 0 && !found.empty(); --i) {
    const auto [at, size] = one_of(rng, found);
    bytes[at + below(rng, size)] = static_cast<char>('0' + below(rng, 10));
  }
}

void replace_word(std::string& bytes, Rng& rng) {
  const auto found = pieces(bytes, is_word_part);
  if (found.empty()) return;
  const auto from = one_of(rng, found), to = one_of(rng, found);
  const std::string word = rng.next() % 4 == 0 ? "" : bytes.substr(from.first, from.second);
  bytes.replace(to.first, to.second, word);
}

void change_lines(std::string& bytes, Rng& rng) {
  const auto found = pieces(bytes, is_line_part);
  if (found.size() < 2) return;
  const auto a = one_of(rng, found), b = one_of(rng, found);
  const std::string line = bytes.substr(a.first, std::min(bytes.size() - a.first, a.second + 1));
  switch (rng.next() % 3) {
    case 0:
      bytes.erase(a.first, a.second + 1);
      break;
    case 1:
      bytes.insert(b.first, line);
      break;
    default:
      bytes.replace(b.first, b.second, bytes.substr(a.first, a.second));
      break;
  }
}

void put_odd_letters(std::string& bytes, Rng& rng) {
  const std::array<std::string, 14> odd{std::string(1, '\0'),
                                        "\r",
                                        "\xff\xfe",
                                        "\xc3",
                                        "\xef\xbb\xbf",
                                        "\"",
                                        "'",
                                        "[",
                                        "]]",
                                        "{",
                                        "#",
                                        "\\",
                                        "=",
                                        "\"\"\""};
  bytes.insert(below(rng, bytes.size() + 1), one_of(rng, odd));
}

constexpr std::array<void (*)(std::string&, Rng&), 19> kFaults{
    flip_bits,      overwrite_bytes, cut_off,        leave_out,      repeat_piece,
    put_float,      put_float,       put_double,     put_integer,    swap_byte_order,
    replace_number, replace_number,  replace_number, scale_number,   change_digits,
    change_digits,  replace_word,    change_lines,   put_odd_letters};

}  // namespace

std::string damaged(std::string bytes, Rng& rng) {
  const uint64_t most = rng.next() % 2 == 0 ? 1 : 4;
  for (uint64_t faults = 1 + rng.next() % most; faults > 0 && !bytes.empty(); --faults)
    one_of(rng, kFaults)(bytes, rng);
  return bytes;
}

}  // namespace swarf::test
