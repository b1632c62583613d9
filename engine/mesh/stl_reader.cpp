#include "mesh/stl_reader.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "mesh/mesh_check.h"

namespace swarf::mesh {
namespace {

namespace fs = std::filesystem;

constexpr size_t kHeader = 84, kFacet = 50, kFacetNormal = 12;
constexpr size_t kFacetsPerRead = 1U << 16U;

}  // namespace

std::optional<TriMesh> read_binary_stl(const std::string& path) {
  std::error_code error;
  const uintmax_t size = fs::file_size(path, error);
  if (error || size < kHeader) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  char header[kHeader];
  file.read(header, kHeader);
  uint32_t facets = 0;
  std::memcpy(&facets, header + 80, sizeof(facets));  // little-endian, as every system we build for
  if (!file || facets == 0 || size != kHeader + uintmax_t{kFacet} * facets) return std::nullopt;
  std::vector<std::array<float, 3>> corners(size_t{3} * facets);
  std::vector<char> buffer(kFacet * std::min<size_t>(facets, kFacetsPerRead));
  for (size_t begin = 0; begin < facets; begin += kFacetsPerRead) {
    const size_t count = std::min<size_t>(kFacetsPerRead, facets - begin);
    if (!file.read(buffer.data(), static_cast<std::streamsize>(kFacet * count))) return std::nullopt;
    for (size_t i = 0; i < count; ++i) {
      std::memcpy(&corners[3 * (begin + i)], buffer.data() + kFacet * i + kFacetNormal, 36);
    }
  }
  const std::vector<uint32_t> numbers = position_numbers(corners);
  TriMesh mesh;
  mesh.triangles.reserve(facets);
  for (size_t c = 0; c < corners.size(); ++c) {
    if (numbers[c] == mesh.positions.size()) mesh.positions.push_back(corners[c]);
  }
  for (size_t i = 0; i < facets; ++i) {
    mesh.triangles.push_back({numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]});
  }
  return mesh;
}

}  // namespace swarf::mesh
