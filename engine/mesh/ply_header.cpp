#include "mesh/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>
#include <utility>

#include "mesh/mesh_source.h"

namespace swarf::mesh {
namespace {

constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes{{{"char", PlyType::kInt8},
                                                                       {"int8", PlyType::kInt8},
                                                                       {"uchar", PlyType::kUint8},
                                                                       {"uint8", PlyType::kUint8},
                                                                       {"short", PlyType::kInt16},
                                                                       {"int16", PlyType::kInt16},
                                                                       {"ushort", PlyType::kUint16},
                                                                       {"uint16", PlyType::kUint16},
                                                                       {"int", PlyType::kInt32},
                                                                       {"int32", PlyType::kInt32},
                                                                       {"uint", PlyType::kUint32},
                                                                       {"uint32", PlyType::kUint32},
                                                                       {"float", PlyType::kFloat},
                                                                       {"float32", PlyType::kFloat},
                                                                       {"double", PlyType::kDouble},
                                                                       {"float64", PlyType::kDouble}}};

class HeaderReader {
 public:
  HeaderReader(const std::string& path, std::string_view bytes) : text_(path, bytes) {}

  PlyHeader run() {
    const std::string_view magic = text_.word_in_line();
    if (magic != "ply" && magic != "PLY") text_.refuse("the file does not begin with 'ply'");
    end_line();
    while (read_line()) end_line();
    if (!has_format_) text_.refuse("the header has no line 'format'");
    header_.lines = text_.where().line;
    end_line();
    header_.end = text_.at();
    return std::move(header_);
  }

 private:
  void end_line() {
    const std::string_view rest = text_.word_in_line();
    if (!rest.empty()) text_.refuse(fmt::format("'{}' is too much in this line", shown(rest)));
    text_.skip_line();
  }

  void skip_rest() {
    while (!text_.word_in_line().empty()) continue;
  }

  /// False at end_header.
  bool read_line() {
    const std::string_view word = text_.word();
    if (word == "end_header") return false;
    if (word.empty()) text_.refuse("the header has no line 'end_header': the file is cut off");
    if (word == "comment" || word == "obj_info") {
      skip_rest();
    } else if (word == "format") {
      read_format();
    } else if (word == "element") {
      read_element();
    } else if (word == "property") {
      read_property();
    } else {
      text_.refuse(fmt::format("'{}' is no word of a PLY header", shown(word)));
    }
    return true;
  }

  void read_format() {
    const std::string_view word = text_.word_in_line();
    if (word == "ascii") {
      header_.format = PlyFormat::kAscii;
    } else if (word == "binary_little_endian") {
      header_.format = PlyFormat::kLittleEndian;
    } else if (word == "binary_big_endian") {
      header_.format = PlyFormat::kBigEndian;
    } else {
      text_.refuse(fmt::format("'{}' is no format of PLY", shown(word)));
    }
    if (text_.word_in_line() != "1.0") text_.refuse("only version 1.0 of PLY is known");
    if (std::exchange(has_format_, true)) text_.refuse("the header has two lines 'format'");
  }

  void read_element() {
    PlyElement element;
    element.name = text_.word_in_line();
    element.line = text_.where().line;
    const std::string_view count = text_.word_in_line();
    const auto [stop, failure] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (failure != std::errc() || stop != count.data() + count.size())
      text_.refuse(fmt::format("'{}' is no number of items", shown(count)));
    for (const PlyElement& other : header_.elements) {
      if (other.name == element.name) text_.refuse(fmt::format("a second element '{}'", shown(element.name)));
    }
    header_.elements.push_back(std::move(element));
  }

  PlyType read_type() {
    const std::string_view word = text_.word_in_line();
    const auto* found =
        std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& type) { return type.first == word; });
    if (found == kTypes.end()) text_.refuse(fmt::format("'{}' is no type of PLY", shown(word)));
    return found->second;
  }

  PlyType read_whole_type() {
    const PlyType type = read_type();
    if (!is_whole_number(type)) text_.refuse("the length of a list must be a whole number");
    return type;
  }

  bool next_is_list() {
    MeshText ahead = text_;
    if (ahead.word_in_line() != "list") return false;
    text_ = ahead;
    return true;
  }

  void read_property() {
    if (header_.elements.empty()) text_.refuse("a property stands before any element");
    PlyProperty property;
    property.is_list = next_is_list();
    if (property.is_list) property.count_type = read_whole_type();
    property.type = read_type();
    property.name = text_.word_in_line();
    if (property.name.empty()) text_.refuse("the property has no name");
    PlyElement& element = header_.elements.back();
    for (const PlyProperty& other : element.properties) {
      if (other.name == property.name) text_.refuse(fmt::format("a second property '{}'", shown(other.name)));
    }
    element.properties.push_back(std::move(property));
  }

  MeshText text_;
  PlyHeader header_;
  bool has_format_ = false;
};

/// The body can hold what the header announces: no count makes us ask for memory beyond the file's size.
void check_counts(const std::string& path, const PlyHeader& header, uint64_t body) {
  uint64_t needed = 0;
  for (const PlyElement& element : header.elements) {
    const uint64_t item = element.least_bytes(header.format);
    const bool fits = element.count == 0 || (item > 0 && element.count <= (body - needed) / item);
    if (!fits) {
      refuse_mesh(
          {path, element.line, 1},
          fmt::format("{} items of '{}' cannot stand in the {} bytes after the header: the file is cut "
                      "off, or the count is wrong",
                      element.count, shown(element.name), body));
    }
    needed += element.count * item;
  }
}

}  // namespace

size_t ply_bytes(PlyType type) {
  constexpr std::array<size_t, 8> kBytes{1, 1, 2, 2, 4, 4, 4, 8};  // order of PlyType
  return kBytes.at(static_cast<size_t>(type));
}

bool is_whole_number(PlyType type) {
  return type != PlyType::kFloat && type != PlyType::kDouble;
}

uint64_t PlyElement::least_bytes(PlyFormat format) const {
  if (format == PlyFormat::kAscii) return properties.size();  // a digit each, and what parts them
  return std::accumulate(properties.begin(), properties.end(), uint64_t{0},
                         [](uint64_t sum, const PlyProperty& property) {
                           return sum + ply_bytes(property.is_list ? property.count_type : property.type);
                         });
}

PlyHeader read_ply_header(const std::string& path, std::string_view bytes) {
  PlyHeader header = HeaderReader(path, bytes).run();
  check_counts(path, header, bytes.size() - header.end);
  return header;
}

}  // namespace swarf::mesh
