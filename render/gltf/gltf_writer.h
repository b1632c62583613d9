// Binary glTF 2.0 of machines that move and parts that were measured.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "render/draw_list.h"

namespace swarf::render {

/// How numbers of meshes are kept; what reads it decides.
enum class GltfEncoding {
  kFloat,      ///< core glTF 2.0: any reader; the largest
  kQuantised,  ///< positions and normals in 16 bits (KHR_mesh_quantization): three.js, Blender
  kMeshopt     ///< the same, compressed (EXT_meshopt_compression): three.js with its decoder, no Blender
};

/// Text and numbers beside a node or a file.
using GltfExtras = std::map<std::string, std::variant<std::string, double>>;

/// A mesh that stands or moves. Poses lead from the mesh's frame to its parent's, or to the scene's.
struct GltfNode {
  std::string name;
  const TriMesh* mesh = nullptr;  ///< borrowed; null: a joint without a shape
  Material material;
  int parent = -1;              ///< index of an earlier node; -1: the scene
  std::vector<double> times_s;  ///< of its keys, strictly ascending; empty for a node that stands still
  std::vector<Pose> poses;      ///< one for each key, or exactly one (empty: identity) without keys
  /// One for each time: 0 hides the node and its children (a scale of zero, which holds until the next time).
  /// Empty: always shown.
  std::vector<uint8_t> shown{};
  GltfExtras extras{};
  /// When quantised, positions are rounded to the grid of this box (quantise.h), which must hold the mesh;
  /// none: of the mesh's own. Meshes that share an edge need one box.
  std::optional<Box> grid{};
};

/// A way with numbers at each point, as one line: attributes of one float each by their name ("_TIME_S"),
/// all as long as the points, and colours (sRGB) of the line that ends there.
struct GltfPath {
  std::string name;
  std::vector<std::array<float, 3>> points;  ///< mm
  std::vector<std::array<uint8_t, 4>> colours{};
  std::map<std::string, std::vector<float>> numbers{};
};

struct GltfCamera {
  std::string name;
  Camera camera;
};

struct GltfScene {
  std::vector<GltfNode> nodes;
  std::vector<DrawLine> lines;
  std::vector<GltfPath> paths{};
  std::vector<GltfCamera> cameras{};
  std::string clip = "program";  ///< name of the animation
  GltfExtras extras{};           ///< written to asset.extras
};

/// Writes one .glb. Scene units are mm with Z up; a root node turns them into glTF's metres with Y up.
///
/// Normals and colours are written where the mesh has them, colours as normalised 8-bit linear COLOR_0 (glTF
/// demands linear). `deviation_um` is the float attribute _DEVIATION_UM; when quantised, 16-bit _DEVIATION,
/// to be multiplied by the primitive's extras "deviation_um_per_unit" (within kScalarErrorUm), unless that
/// would be off by more. Lines of one name and colour are one unlit node of separate segments; paths are
/// floats in every encoding. asset.extras says how far quantising moves a position at most
/// ("position_error_um"). Written to a temporary name and renamed; throws InputError when the path cannot be
/// written.
void write_glb(const std::filesystem::path& path, const GltfScene& scene,
               GltfEncoding encoding = GltfEncoding::kFloat);

/// The bytes of such a file.
std::string glb_bytes(const GltfScene& scene, GltfEncoding encoding);

}  // namespace swarf::render
