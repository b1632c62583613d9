// Meshes, lines and paths as glTF primitives, as floats or quantised.
#pragma once

#include <tiny_gltf.h>

#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "render/gltf/gltf_buffer.h"
#include "render/gltf/gltf_writer.h"
#include "render/gltf/quantise.h"

namespace swarf::render {

tinygltf::Value extras_value(const GltfExtras& extras);

/// Adds meshes and their materials to a model.
class GltfMeshes {
 public:
  GltfMeshes(tinygltf::Model& model, GltfBuffer& buffer, bool quantised)
      : model_(model), buffer_(buffer), quantised_(quantised) {}

  /// A mesh of the model, and the grid that its positions count on; none: mm.
  struct Placed {
    int mesh = -1;
    std::optional<PositionGrid> grid{};
  };
  /// Of a node that has one; equal meshes of one material are shared.
  Placed of_node(const GltfNode& node);
  /// Segments between points, unlit.
  struct LineGroup {
    std::vector<std::array<float, 3>> points;
    std::vector<uint32_t> segments;
  };
  Placed of_lines(const std::string& name, const Rgb& colour, const LineGroup& group);
  Placed of_path(const GltfPath& path);

  /// The farthest that any position was moved, mm.
  double position_error_mm() const { return position_error_mm_; }

 private:
  tinygltf::Primitive triangles(const TriMesh& mesh, const std::optional<PositionGrid>& grid);
  void add_deviation(const TriMesh& mesh, tinygltf::Primitive& primitive);
  int positions(std::span<const std::array<float, 3>> points, const std::optional<PositionGrid>& grid);
  int normals(const std::vector<std::array<float, 3>>& normals);
  int material_of(const std::string& name, const Material& material, bool vertex_colours);
  int unlit_material(const std::string& name, const Rgb& colour);
  int add_mesh(const std::string& name, tinygltf::Primitive primitive);
  std::optional<PositionGrid> grid_of(const Box& box);

  using MeshKey = std::tuple<const TriMesh*, Rgb, float, float>;
  tinygltf::Model& model_;
  GltfBuffer& buffer_;
  bool quantised_;
  double position_error_mm_ = 0.0;
  std::map<MeshKey, Placed> meshes_;
};

}  // namespace swarf::render
