// order_for_display(): meshoptimizer's orders for the vertex cache and for fetching vertices.
#include <meshoptimizer.h>

#include "mesh/mesh_ops.h"

namespace swarf::mesh {
namespace {

template <typename Attribute>
void reorder(std::vector<Attribute>& values, const std::vector<unsigned>& places, size_t used) {
  if (values.empty()) return;
  meshopt_remapVertexBuffer(values.data(), values.data(), values.size(), sizeof(Attribute), places.data());
  values.resize(used);
}

}  // namespace

void order_for_display(TriMesh& mesh) {
  if (mesh.triangles.empty()) return;
  unsigned* indices = mesh.triangles.front().data();
  const size_t count = 3 * mesh.triangles.size(), vertices = mesh.positions.size();
  meshopt_optimizeVertexCache(indices, indices, count, vertices);
  std::vector<unsigned> places(vertices);
  const size_t used = meshopt_optimizeVertexFetchRemap(places.data(), indices, count, vertices);
  meshopt_remapIndexBuffer(indices, indices, count, places.data());
  reorder(mesh.positions, places, used);
  reorder(mesh.normals, places, used);
  reorder(mesh.colours, places, used);
  reorder(mesh.deviation_um, places, used);
}

}  // namespace swarf::mesh
