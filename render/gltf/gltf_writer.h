// Binary glTF 2.0 of machines that move and parts that were measured.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "render/draw_list.h"

namespace swarf::render {

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
};

struct GltfScene {
  std::vector<GltfNode> nodes;
  std::vector<DrawLine> lines;
  std::map<std::string, std::string> extras;  ///< written to asset.extras
};

/// Writes one .glb. Scene units are mm with Z up; a root node turns them into glTF's metres with Y up.
/// Normals and colours are written where the mesh has them, colours as normalised 8-bit linear COLOR_0 (glTF
/// demands linear), `deviation_um` as the float attribute _DEVIATION_UM. Lines of one name and colour are
/// one unlit node of separate segments. Written to a temporary name and renamed; throws InputError when the
/// path cannot be written.
void write_glb(const std::filesystem::path& path, const GltfScene& scene);

}  // namespace swarf::render
