#include "mesh/scene_reader.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/frames.h"
#include "mesh/mesh_3mf.h"
#include "mesh/mesh_source.h"

namespace swarf::mesh {
namespace {

constexpr std::array kSceneEndings{".glb", ".gltf", ".dae", ".fbx", ".3mf", ".amf", ".off"};
constexpr double kMillimetresPerMetre = 1000.0;
constexpr double kMillimetresPerInch = 25.4;

/// A file's numbers in mm.
struct Measure {
  double millimetres = 1.0;
  bool y_up = false;
};

/// <amf unit="inch">; millimetres where it says nothing.
double unit_of_amf(const std::string& path, std::string_view text) {
  const size_t tag = text.find("<amf");
  if (tag == std::string_view::npos) {
    refuse_mesh({path}, "there is no <amf> in the file: compressed AMF is not read",
                "export the mesh again: AMF as text, STL, PLY or OBJ");
  }
  const std::string_view head = text.substr(tag, text.find('>', tag) - tag);
  const size_t key = head.find("unit");
  if (key == std::string_view::npos) return 1.0;
  const size_t open = head.find_first_of("\"'", key);
  const size_t close = open == std::string_view::npos ? open : head.find(head[open], open + 1);
  const std::string unit(close == std::string_view::npos ? "" : head.substr(open + 1, close - open - 1));
  static constexpr std::array<std::pair<const char*, double>, 6> kUnits{{{"millimeter", 1.0},
                                                                         {"inch", kMillimetresPerInch},
                                                                         {"feet", 12.0 * kMillimetresPerInch},
                                                                         {"meter", kMillimetresPerMetre},
                                                                         {"micron", 1e-3},
                                                                         {"micrometer", 1e-3}}};
  for (const auto& [name, millimetres] : kUnits)
    if (unit == name) return millimetres;
  refuse_mesh({path}, fmt::format("'{}' is no unit of an AMF file", shown(unit)));
}

/// The JSON of a .gltf or .glb must ask for nothing that is not read: quantised or compressed numbers would
/// come in as others.
void refuse_extensions(const std::string& path, std::string_view bytes) {
  constexpr size_t kHeader = 20;  // magic, version, length, length and type of the first chunk
  if (bytes.substr(0, 4) == "glTF") {
    uint32_t length = 0;
    if (bytes.size() >= kHeader) std::memcpy(&length, bytes.data() + 12, sizeof length);
    if (bytes.size() < kHeader || bytes.size() - kHeader < length)
      refuse_mesh({path}, "the glTF file ends within its first chunk");
    bytes = bytes.substr(kHeader, length);
  }
  const nlohmann::json model = nlohmann::json::parse(bytes, nullptr, false);
  if (!model.is_object()) refuse_mesh({path}, "the file is no glTF: its JSON cannot be read");
  if (model.contains("buffers") && model.at("buffers").is_array())
    for (const nlohmann::json& buffer : model.at("buffers")) {
      const auto uri = buffer.is_object() ? buffer.find("uri") : buffer.end();
      if (!buffer.is_object() || uri == buffer.end() || !uri->is_string()) continue;
      if (!uri->get_ref<const std::string&>().starts_with("data:"))
        refuse_mesh({path}, "the numbers of the glTF stand in another file, which the run could not keep",
                    "export it as one file: .glb");
    }
  const auto needed = model.find("extensionsRequired");
  if (needed == model.end() || !needed->is_array() || needed->empty()) return;
  refuse_mesh({path}, fmt::format("the glTF file needs {}, which is not read", shown(needed->front().dump())),
              "export it with floats: of a run, swarf export --encoding float");
}

Measure measure_of(const aiScene& scene, const std::string& path, const std::string& ending,
                   std::string_view bytes) {
  // The library turns what COLLADA says into metres and Y up, as glTF has them.
  if (ending == ".glb" || ending == ".gltf" || ending == ".dae") return {kMillimetresPerMetre, true};
  if (ending == ".amf") return {unit_of_amf(path, bytes), false};
  if (ending != ".fbx" || scene.mMetaData == nullptr) return {};
  double centimetres = 1.0;
  float single = 1.0F;
  if (!scene.mMetaData->Get("UnitScaleFactor", centimetres) &&
      scene.mMetaData->Get("UnitScaleFactor", single))
    centimetres = single;
  int32_t up = 1;
  scene.mMetaData->Get("UpAxis", up);
  return {10.0 * centimetres, up == 1};
}

class Joiner {
 public:
  Joiner(const std::string& path, const aiScene& scene, const Measure& measure)
      : path_(path), scene_(scene), whole_(Eigen::Scaling(measure.millimetres)) {
    if (measure.y_up)
      whole_ = Eigen::AngleAxisd(std::acos(0.0), Vec3::UnitX()) * whole_;  // a quarter turn: Y becomes Z
  }

  TriMesh join() {
    if (scene_.mRootNode != nullptr) add(*scene_.mRootNode, Eigen::Matrix4d::Identity());
    return std::move(mesh_);
  }

 private:
  void add(const aiNode& node, const Eigen::Matrix4d& parent) {
    Eigen::Matrix4d own;
    for (unsigned row = 0; row < 4; ++row)
      for (unsigned column = 0; column < 4; ++column) own(row, column) = node.mTransformation[row][column];
    const Eigen::Matrix4d place = parent * own;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) add(*scene_.mMeshes[node.mMeshes[i]], place);
    for (unsigned i = 0; i < node.mNumChildren; ++i) add(*node.mChildren[i], place);
  }

  void add(const aiMesh& mesh, const Eigen::Matrix4d& place) {
    const Eigen::Matrix4d all = whole_.matrix() * place;
    const bool mirrored = all.topLeftCorner<3, 3>().determinant() < 0.0;
    const auto first = static_cast<uint32_t>(mesh_.positions.size());
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& p = mesh.mVertices[i];
      const Eigen::Vector4d at = all * Eigen::Vector4d(p.x, p.y, p.z, 1.0);
      mesh_.positions.push_back(
          {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z())});
      if (!within_bounds(mesh_.positions.back()))
        refuse_mesh({path_}, fmt::format("vertex {} of mesh '{}' is not finite, or beyond {:g} mm", i,
                                         shown(mesh.mName.C_Str()), kFarthest));
    }
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices != 3) continue;  // points and lines
      std::array<uint32_t, 3> corners{};
      for (size_t k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= mesh.mNumVertices)
          refuse_mesh({path_}, fmt::format("facet {} of mesh '{}' names a vertex that is not there", i,
                                           shown(mesh.mName.C_Str())));
        corners.at(k) = first + face.mIndices[k];
      }
      if (mirrored) std::swap(corners[1], corners[2]);
      mesh_.triangles.push_back(corners);
    }
  }

  const std::string& path_;
  const aiScene& scene_;
  Eigen::Affine3d whole_;  ///< the file's numbers to mm and Z up
  TriMesh mesh_;
};

}  // namespace

bool is_scene_ending(const std::string& ending) {
  return std::find(kSceneEndings.begin(), kSceneEndings.end(), ending) != kSceneEndings.end();
}

std::string scene_endings() {
  return fmt::format("{}", fmt::join(kSceneEndings, ", "));
}

TriMesh read_scene_mesh(const std::string& path, const std::string& ending) {
  const std::string bytes = read_mesh_file(path);
  if (ending == ".3mf") return read_3mf(path);
  if (ending == ".glb" || ending == ".gltf") refuse_extensions(path, bytes);
  Assimp::Importer importer;
  const aiScene* const scene =
      importer.ReadFile(path, aiProcess_Triangulate | aiProcess_ValidateDataStructure);
  if (scene == nullptr)
    refuse_mesh({path}, fmt::format("the file cannot be read: {}", shown(importer.GetErrorString())));
  return Joiner(path, *scene, measure_of(*scene, path, ending, bytes)).join();
}

}  // namespace swarf::mesh
