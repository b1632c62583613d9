#include "mesh/stl_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "mesh/mesh_check.h"
#include "mesh/mesh_source.h"

namespace swarf::mesh {
namespace {

namespace fs = std::filesystem;

constexpr size_t kHeader = 84, kFacet = 50, kFacetNormal = 12;
constexpr size_t kFacetsPerRead = 1U << 16U;
constexpr size_t kLookedAt = 512;  // bytes that tell text from binary

using StlCorners = std::vector<std::array<float, 3>>;  // three by three

TriMesh merged(const StlCorners& corners) {
  const std::vector<uint32_t> numbers = position_numbers(corners);
  TriMesh mesh;
  mesh.triangles.reserve(corners.size() / 3);
  for (size_t c = 0; c < corners.size(); ++c) {
    if (numbers[c] == mesh.positions.size()) mesh.positions.push_back(corners[c]);
  }
  for (size_t c = 0; c < corners.size(); c += 3) {
    mesh.triangles.push_back({numbers[c], numbers[c + 1], numbers[c + 2]});
  }
  return mesh;
}

/// Bytes of a binary file of so many facets.
uintmax_t binary_bytes(uint32_t facets) {
  return kHeader + uintmax_t{kFacet} * facets;
}

[[noreturn]] void refuse_corner(const std::string& path, size_t corner,
                                const std::array<float, 3>& position) {
  size_t axis = 0;
  while (axis < 2 && coordinate_fault("", position[axis]).empty()) ++axis;
  const size_t byte =
      kHeader + kFacet * (corner / 3) + kFacetNormal * (1 + corner % 3) + sizeof(float) * axis;
  const std::string what = fmt::format("{} of corner {} of facet {}", std::string("xyz").substr(axis, 1),
                                       corner % 3 + 1, corner / 3 + 1);
  refuse_mesh({path}, fmt::format("byte {}: {}", byte, coordinate_fault(what, position[axis])));
}

StlCorners read_facets(const std::string& path, std::ifstream& file, uint32_t facets) {
  StlCorners corners(size_t{3} * facets);
  std::vector<char> buffer(kFacet * std::min<size_t>(facets, kFacetsPerRead));
  for (size_t begin = 0; begin < facets; begin += kFacetsPerRead) {
    const size_t count = std::min<size_t>(kFacetsPerRead, facets - begin);
    if (!file.read(buffer.data(), static_cast<std::streamsize>(kFacet * count)))
      refuse_mesh({path}, "the file cannot be read to its end", "check the disk that the file is on");
    for (size_t i = 0; i < count; ++i) {
      std::memcpy(&corners[3 * (begin + i)], buffer.data() + kFacet * i + kFacetNormal, 36);
    }
  }
  const auto bad = std::find_if_not(corners.begin(), corners.end(), within_bounds);
  if (bad != corners.end()) refuse_corner(path, static_cast<size_t>(bad - corners.begin()), *bad);
  return corners;
}

/// A word of STL's text, in small or capital letters.
bool is_word(std::string_view word, std::string_view expected) {
  return std::equal(word.begin(), word.end(), expected.begin(), expected.end(),
                    [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

void expect(MeshText& text, std::string_view expected) {
  const std::string_view word = text.word();
  if (is_word(word, expected)) return;
  if (word.empty())
    text.refuse(fmt::format("the file ends where '{}' should stand: it is cut off", expected));
  text.refuse(fmt::format("'{}' stands where '{}' should", shown(word), expected));
}

/// What follows the word `facet`.
void read_text_facet(MeshText& text, StlCorners& corners) {
  text.skip_line();  // its normal follows from the corners
  expect(text, "outer");
  expect(text, "loop");
  for (int i = 0; i < 3; ++i) {
    expect(text, "vertex");
    const float x = text.coordinate("x"), y = text.coordinate("y"), z = text.coordinate("z");
    corners.push_back({x, y, z});
  }
  expect(text, "endloop");
  expect(text, "endfacet");
}

/// One or more solids, one after the other.
StlCorners read_text(const std::string& path, const std::string& bytes) {
  MeshText text(path, bytes);
  StlCorners corners;
  expect(text, "solid");
  for (;;) {
    text.skip_line();  // the name
    std::string_view word = text.word();
    for (; is_word(word, "facet"); word = text.word()) read_text_facet(text, corners);
    if (word.empty()) text.refuse("the file ends without 'endsolid': it is cut off");
    if (!is_word(word, "endsolid"))
      text.refuse(fmt::format("'{}' stands where 'facet' or 'endsolid' should", shown(word)));
    text.skip_line();
    word = text.word();
    if (word.empty()) return corners;
    if (!is_word(word, "solid"))
      text.refuse(fmt::format("'{}' stands after the end of a solid", shown(word)));
  }
}

bool looks_like_text(const std::string& bytes) {
  const size_t begin = std::min(bytes.find_first_not_of(" \t\r\n\xef\xbb\xbf"), bytes.size());
  const std::string_view start = std::string_view(bytes).substr(0, kLookedAt);
  return is_word(std::string_view(bytes).substr(begin, 5), "solid") && start.find('\0') == start.npos;
}

[[noreturn]] void refuse_size(const std::string& path, uintmax_t size, uint32_t facets) {
  if (size < kHeader) refuse_mesh({path}, fmt::format("{} bytes are no STL file", size));
  refuse_mesh({path}, fmt::format("bytes 80 to 83 announce {} facets, which is a file of {} bytes; it has {}",
                                  facets, binary_bytes(facets), size));
}

}  // namespace

TriMesh read_stl(const std::string& path) {
  std::error_code error;
  const uintmax_t size = fs::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  char header[kHeader]{};
  file.read(header, kHeader);
  uint32_t facets = 0;
  std::memcpy(&facets, header + 80, sizeof(facets));  // little-endian, as every system we build for
  if (!error && file && size <= kLargestFile && size == binary_bytes(facets))
    return merged(read_facets(path, file, facets));
  const std::string bytes = read_mesh_file(path);
  if (!looks_like_text(bytes)) refuse_size(path, size, facets);
  return merged(read_text(path, bytes));
}

}  // namespace swarf::mesh
