#include "mesh/mesh_io.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

#include "base/diagnostics.h"
#include "mesh/ply_check.h"
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

uint8_t byte_from_unit(float value) {
  return static_cast<uint8_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255.0F));
}

void append(const aiMesh& part, TriMesh& mesh) {
  const auto base = static_cast<uint32_t>(mesh.positions.size());
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& p = part.mVertices[i];
    mesh.positions.push_back({p.x, p.y, p.z});
    if (part.HasNormals()) {
      const aiVector3D& n = part.mNormals[i];
      mesh.normals.push_back({n.x, n.y, n.z});
    }
    if (part.HasVertexColors(0)) {
      const aiColor4D& c = part.mColors[0][i];
      mesh.colours.push_back(
          {byte_from_unit(c.r), byte_from_unit(c.g), byte_from_unit(c.b), byte_from_unit(c.a)});
    }
  }
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices != 3) continue;  // points and lines of the file are no surface
    mesh.triangles.push_back({base + face.mIndices[0], base + face.mIndices[1], base + face.mIndices[2]});
  }
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

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw InputError("mesh-unreadable", {path}, fmt::format("this is not a mesh: {}", reason),
                   "use STL, PLY or OBJ in mm");
}

TriMesh read_with_assimp(const std::string& path, const std::string& ending) {
  const std::string broken = ending == ".ply" ? check_ply_whole(path) : "";
  if (!broken.empty()) refuse(path, broken);
  Assimp::Importer importer;
  // The normals of STL are those of its facets: they say nothing new and would keep vertices apart.
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, ending == ".stl" ? int{aiComponent_NORMALS} : 0);
  const aiScene* scene =
      importer.ReadFile(path, aiProcess_RemoveComponent | aiProcess_Triangulate |
                                  aiProcess_JoinIdenticalVertices | aiProcess_PreTransformVertices);
  if (scene == nullptr) refuse(path, importer.GetErrorString());
  TriMesh mesh;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) append(*scene->mMeshes[i], mesh);
  if (mesh.normals.size() != mesh.positions.size()) mesh.normals.clear();
  if (mesh.colours.size() != mesh.positions.size()) mesh.colours.clear();
  return mesh;
}

}  // namespace

TriMesh load_mesh(const std::string& path) {
  if (!fs::is_regular_file(path)) {
    throw InputError("mesh-not-found", {path}, "the mesh file cannot be opened",
                     "check the path and its spelling");
  }
  const std::string ending = extension(path);
  std::optional<TriMesh> mesh = ending == ".stl" ? read_binary_stl(path) : std::nullopt;
  if (!mesh) mesh = read_with_assimp(path, ending);
  const auto broken = std::count_if(mesh->positions.begin(), mesh->positions.end(), [](const auto& p) {
    return !(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]));
  });
  if (mesh->triangles.empty()) refuse(path, "it has no triangles");
  if (broken > 0) {
    refuse(path, fmt::format("{} of its {} positions are not finite", broken, mesh->positions.size()));
  }
  return std::move(*mesh);
}

void save_mesh(const std::string& path, const TriMesh& mesh) {
  const std::string ending = extension(path);
  if (ending != ".stl" && ending != ".ply") {
    throw InputError("mesh-format", {path}, fmt::format("meshes are not written as '{}'", ending),
                     "name the file .stl or .ply");
  }
  const std::string bytes = ending == ".stl" ? stl_bytes(mesh) : ply_bytes(mesh);
  const std::string temporary = path + ".part";
  std::ofstream file(temporary, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  std::error_code failure;
  if (file) fs::rename(temporary, path, failure);
  if (!file || failure) {
    fs::remove(temporary, failure);
    throw InputError("cannot-write", {path}, "the file cannot be written",
                     "check that its folder exists and may be written");
  }
}

}  // namespace swarf::mesh
