// The header of a PLY file: which elements follow, and what each of their items holds.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace swarf::mesh {

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

size_t ply_bytes(PlyType type);
bool is_whole_number(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat;  ///< of the value, or of each value of the list
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;  ///< of lists
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;
  int line = 0;  ///< of the header
  std::vector<PlyProperty> properties;

  /// The fewest bytes of one item.
  uint64_t least_bytes(PlyFormat format) const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  size_t end = 0;  ///< offset of the body, bytes
  int lines = 0;   ///< of the header
};

/// Throws InputError with the line of what is wrong. Every count is one that the file's bytes can hold.
PlyHeader read_ply_header(const std::string& path, std::string_view bytes);

}  // namespace swarf::mesh
