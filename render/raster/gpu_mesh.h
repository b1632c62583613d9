// Triangle meshes in GPU buffers.
#pragma once

#include <unordered_map>

#include "base/frames.h"
#include "render/draw_list.h"
#include "render/raster/gl_api.h"

namespace swarf::render {

/// One mesh as a vertex array; attributes 0 position, 1 normal, 2 colour (sRGB bytes).
struct GpuMesh {
  GLuint vertex_array = 0;
  GLuint buffers[4] = {};  ///< positions, normals, colours, indices
  GLsizei index_count = 0;
  GLsizei outside_count = 0;  ///< of them, the first: all but those of enclosed triangles
  bool has_colours = false;
  bool closed = false;                       ///< no way to see a triangle's back; known of static meshes only
  Box bounds;                                ///< in the mesh's frame
  uint64_t fingerprint = 0;                  ///< or DrawItem::revision
  const mesh::Enclosed* enclosed = nullptr;  ///< as it was sent
};

/// Meshes by their address. All calls need the context to be current.
class GpuMeshCache {
 public:
  explicit GpuMeshCache(const GlApi& gl) : gl_(gl) {}

  /// The item's mesh on the GPU, sent when it is new, dynamic, or no longer what was sent.
  const GpuMesh& get(const DrawItem& item);
  /// Frees the meshes that no call has asked for since the last collect().
  void collect();

 private:
  struct Entry {
    GpuMesh mesh;
    bool used = false;
  };
  void upload(const DrawItem& item, GpuMesh& target);

  const GlApi& gl_;
  std::unordered_map<const TriMesh*, Entry> entries_;
};

}  // namespace swarf::render
