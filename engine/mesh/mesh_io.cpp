#include "mesh/mesh_io.h"

#include <fmt/format.h>

#include <iterator>

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <limits>
#include <new>
#include <unordered_map>

#include "base/diagnostics.h"
#include "base/file.h"
#include "base/hash.h"
#include "mesh/mesh_3mf.h"
#include "mesh/mesh_source.h"
#include "mesh/obj_reader.h"
#include "mesh/ply_reader.h"
#include "mesh/scene_reader.h"
#include "mesh/stl_reader.h"

namespace swarf::mesh {
namespace {

namespace fs = std::filesystem;

std::string extension(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return ending;
}

/// Bytes of one value, as the machine stores it: both formats are little-endian, and so is every system we
/// build for.
template <typename T>
void put(std::string& out, const T& value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

std::string stl_bytes(const TriMesh& mesh) {
  std::string out(80, ' ');
  std::memcpy(out.data(), "swarf, mm", 9);
  put(out, static_cast<uint32_t>(mesh.triangles.size()));
  const auto corner = [&](uint32_t v) { return Eigen::Vector3f(mesh.positions[v].data()); };
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3f a = corner(t[0]);
    const Eigen::Vector3f normal = (corner(t[1]) - a).cross(corner(t[2]) - a).normalized();
    for (int i = 0; i < 3; ++i) put(out, normal[i]);
    for (const uint32_t v : t) put(out, mesh.positions[v]);
    put(out, uint16_t{0});
  }
  return out;
}

std::string ply_bytes(const TriMesh& mesh) {
  std::string out = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment swarf, mm\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n",
      mesh.positions.size());
  if (!mesh.normals.empty()) out += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!mesh.colours.empty())
    out += "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n";
  if (!mesh.deviation_um.empty()) out += "property float deviation_um\n";
  out += fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                     mesh.triangles.size());
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    put(out, mesh.positions[i]);
    if (!mesh.normals.empty()) put(out, mesh.normals[i]);
    if (!mesh.colours.empty()) put(out, mesh.colours[i]);
    if (!mesh.deviation_um.empty()) put(out, mesh.deviation_um[i]);
  }
  for (const auto& triangle : mesh.triangles) {
    put(out, uint8_t{3});
    put(out, triangle);
  }
  return out;
}

/// What makes two vertices one: place, normal and colour, as bits.
using VertexKey = std::array<uint32_t, 7>;

struct VertexHash {
  size_t operator()(const VertexKey& key) const {
    Hash hash;
    for (const uint32_t word : key) hash.add(uint64_t{word});
    return hash.value();
  }
};

VertexKey key_of(const TriMesh& mesh, uint32_t v) {
  VertexKey key{};
  const auto bits = [](float value) {
    return std::bit_cast<uint32_t>(value + 0.0F);
  };  // -0 and 0 are one place
  for (size_t i = 0; i < 3; ++i) key.at(i) = bits(mesh.positions[v].at(i));
  for (size_t i = 0; i < 3 && !mesh.normals.empty(); ++i) key.at(3 + i) = bits(mesh.normals[v].at(i));
  if (!mesh.colours.empty()) std::memcpy(&key[6], mesh.colours[v].data(), sizeof(uint32_t));
  return key;
}

/// Equal vertices as one, in the order of the file; those that no triangle uses left out.
TriMesh tidied(const TriMesh& mesh) {
  constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();
  std::vector<bool> used(mesh.positions.size(), false);
  for (const auto& t : mesh.triangles) {
    for (const uint32_t v : t) used.at(v) = true;
  }
  TriMesh tidy;
  std::unordered_map<VertexKey, uint32_t, VertexHash> known;
  known.reserve(mesh.positions.size());
  std::vector<uint32_t> numbers(mesh.positions.size(), kUnused);
  for (uint32_t v = 0; v < numbers.size(); ++v) {
    if (!used[v]) continue;
    const auto [found, fresh] =
        known.try_emplace(key_of(mesh, v), static_cast<uint32_t>(tidy.positions.size()));
    numbers[v] = found->second;
    if (!fresh) continue;
    tidy.positions.push_back(mesh.positions[v]);
    if (!mesh.normals.empty()) tidy.normals.push_back(mesh.normals[v]);
    if (!mesh.colours.empty()) tidy.colours.push_back(mesh.colours[v]);
  }
  tidy.triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    tidy.triangles.push_back({numbers[t[0]], numbers[t[1]], numbers[t[2]]});
  }
  return tidy;
}

/// A normal of no direction says nothing; the mesh then has none, and who needs them takes the facets'.
void drop_empty_normals(TriMesh& mesh) {
  const bool empty = std::any_of(mesh.normals.begin(), mesh.normals.end(),
                                 [](const auto& n) { return n[0] == 0.0F && n[1] == 0.0F && n[2] == 0.0F; });
  if (empty) mesh.normals.clear();
}

TriMesh read_by_ending(const std::string& path) {
  const std::string ending = extension(path);
  if (ending == ".stl") return read_stl(path);
  TriMesh mesh;
  if (ending == ".ply") {
    mesh = read_ply(path);
  } else if (ending == ".obj") {
    mesh = read_obj(path);
  } else if (is_scene_ending(ending)) {
    mesh = read_scene_mesh(path, ending);
  } else {
    refuse_mesh({path}, fmt::format("'{}' is no ending of a mesh file that is read", shown(ending)));
  }
  drop_empty_normals(mesh);
  return tidied(mesh);
}

/// Never empty: it begins with its unit.
std::string obj_text(const TriMesh& mesh) {
  std::string text = "# millimetres\n";
  const auto out = std::back_inserter(text);
  for (const auto& p : mesh.positions) fmt::format_to(out, "v {} {} {}\n", p[0], p[1], p[2]);
  for (const auto& n : mesh.normals) fmt::format_to(out, "vn {} {} {}\n", n[0], n[1], n[2]);
  for (const auto& t : mesh.triangles) {
    const uint32_t a = t[0] + 1, b = t[1] + 1, c = t[2] + 1;  // counted from 1
    if (mesh.normals.empty())
      fmt::format_to(out, "f {} {} {}\n", a, b, c);
    else
      fmt::format_to(out, "f {0}//{0} {1}//{1} {2}//{2}\n", a, b, c);
  }
  return text;
}

}  // namespace

bool carries_unit(const std::string& path) {
  const std::string ending = extension(path);
  return is_scene_ending(ending) && ending != ".off";
}

TriMesh load_mesh(const std::string& path) {
  refuse_special_file(path);
  if (!fs::is_regular_file(path)) {
    throw InputError("mesh-not-found", {path}, "the mesh file cannot be opened",
                     "check the path and its spelling");
  }
  try {
    TriMesh mesh = read_by_ending(path);
    if (mesh.triangles.empty()) refuse_mesh({path}, "the mesh has no triangles");
    return mesh;
  } catch (const std::bad_alloc&) {
    throw InputError("out-of-memory", {path}, "there is not enough memory for this mesh",
                     "make the mesh coarser, or free memory");
  }
}

void save_mesh(const std::string& path, const TriMesh& mesh) {
  const std::string ending = extension(path);
  const std::string bytes = ending == ".stl"   ? stl_bytes(mesh)
                            : ending == ".ply" ? ply_bytes(mesh)
                            : ending == ".obj" ? obj_text(mesh)
                            : ending == ".3mf" ? bytes_3mf(mesh, path)
                                               : "";
  if (bytes.empty()) {
    throw InputError("mesh-format", {path}, fmt::format("meshes are not written as '{}'", ending),
                     "name the file .stl, .ply, .obj or .3mf");
  }
  replace_file(path, bytes, {"cannot-write", "the mesh cannot be written"});
}

}  // namespace swarf::mesh
