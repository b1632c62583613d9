#include "mesh/ply_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <sstream>
#include <vector>

namespace swarf::mesh {
namespace {

enum class Format { kAscii, kLittleEndian, kBigEndian };

struct Element {
  std::string name;
  uint64_t count = 0;
  struct List {
    size_t count_bytes = 0, item_bytes = 0;
    size_t bytes_before = 0;  ///< scalar properties between the list before (or the start) and this one
  };
  std::vector<List> lists;
  size_t bytes_since_list = 0;  ///< scalar properties after the last list
};

struct Header {
  Format format = Format::kAscii;
  std::vector<Element> elements;
  size_t end = 0;  ///< offset of the body
};

/// 0 for a type that PLY does not know.
size_t type_bytes(const std::string& type) {
  static const std::map<std::string, size_t> kBytes{
      {"char", 1},   {"int8", 1},    {"uchar", 1},  {"uint8", 1},  {"short", 2}, {"int16", 2},
      {"ushort", 2}, {"uint16", 2},  {"int", 4},    {"int32", 4},  {"uint", 4},  {"uint32", 4},
      {"float", 4},  {"float32", 4}, {"double", 8}, {"float64", 8}};
  const auto found = kBytes.find(type);
  return found == kBytes.end() ? 0 : found->second;
}

bool add_property(std::istringstream& words, Element& element) {
  std::string type, count_type, item_type;
  words >> type;
  if (type != "list") {
    element.bytes_since_list += type_bytes(type);
    return type_bytes(type) > 0;
  }
  words >> count_type >> item_type;
  element.lists.push_back({type_bytes(count_type), type_bytes(item_type), element.bytes_since_list});
  element.bytes_since_list = 0;
  return type_bytes(count_type) > 0 && type_bytes(item_type) > 0;
}

/// False when the line is not one that a PLY header may have.
bool add_line(const std::string& line, Header& header) {
  std::istringstream words(line);
  std::string keyword, value;
  words >> keyword;
  if (keyword == "comment" || keyword == "obj_info" || keyword == "ply") return true;
  if (keyword == "format") {
    words >> value;
    header.format = value == "ascii"                  ? Format::kAscii
                    : value == "binary_little_endian" ? Format::kLittleEndian
                                                      : Format::kBigEndian;
    return value == "ascii" || value == "binary_little_endian" || value == "binary_big_endian";
  }
  if (keyword == "element") {
    header.elements.emplace_back();
    words >> header.elements.back().name >> header.elements.back().count;
    return !words.fail();
  }
  return keyword == "property" && !header.elements.empty() && add_property(words, header.elements.back());
}

std::optional<Header> parse_header(const std::string& bytes, std::string& reason) {
  Header header;
  for (size_t begin = 0;;) {
    const size_t end = bytes.find('\n', begin);
    if (end == std::string::npos) {
      reason = "the PLY header has no line 'end_header'";
      return {};
    }
    std::string line = bytes.substr(begin, end - begin);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (begin == 0 && line != "ply" && line != "PLY") {
      reason = "the file does not begin with 'ply'";
      return {};
    }
    begin = end + 1;
    if (line == "end_header") {
      header.end = begin;
      return header;
    }
    if (!add_line(line, header)) {
      reason = fmt::format("the PLY header has the line '{}'", line.substr(0, 60));
      return {};
    }
  }
}

/// A whole number of the body; `bytes` has it entirely.
uint64_t read_count(const std::string& bytes, size_t at, size_t size, Format format) {
  uint64_t value = 0;
  for (size_t i = 0; i < size; ++i) {
    const size_t byte = format == Format::kBigEndian ? i : size - 1 - i;
    value = value << 8U | static_cast<unsigned char>(bytes[at + byte]);
  }
  return value;
}

/// Moves `at` over one item of the element; false when the file ends before.
bool skip_item(const Element& element, const std::string& bytes, Format format, size_t& at) {
  for (const Element::List& list : element.lists) {
    at += list.bytes_before;
    if (at + list.count_bytes > bytes.size()) return false;
    const uint64_t items = read_count(bytes, at, list.count_bytes, format);
    at += list.count_bytes;
    if (items > (bytes.size() - at) / list.item_bytes) return false;
    at += items * list.item_bytes;
  }
  at += element.bytes_since_list;
  return at <= bytes.size();
}

bool binary_body_is_whole(const Header& header, const std::string& bytes) {
  size_t at = header.end;
  for (const Element& element : header.elements) {
    if (element.count > bytes.size()) return false;  // an item has a byte at least
    for (uint64_t i = 0; i < element.count; ++i) {
      if (!skip_item(element, bytes, header.format, at)) return false;
    }
  }
  return true;
}

/// Each item of an ascii body has a line of its own; the last one may lack its line feed.
bool ascii_body_is_whole(const Header& header, const std::string& bytes) {
  uint64_t needed = 0;
  for (const Element& element : header.elements) needed += element.count;
  const auto lines = std::count(bytes.begin() + static_cast<std::ptrdiff_t>(header.end), bytes.end(), '\n');
  const uint64_t unended = bytes.back() == '\n' ? 0 : 1;
  return static_cast<uint64_t>(lines) + unended >= needed;
}

}  // namespace

std::string check_ply_whole(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  std::string reason;
  const std::optional<Header> header = parse_header(bytes, reason);
  if (!header) return reason;
  const bool whole = header->format == Format::kAscii ? ascii_body_is_whole(*header, bytes)
                                                      : binary_body_is_whole(*header, bytes);
  return whole ? "" : "the file ends before everything that its header announces";
}

}  // namespace swarf::mesh
