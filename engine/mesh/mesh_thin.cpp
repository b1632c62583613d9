// thin_for_display(): one round of meshoptimizer.
#include <meshoptimizer.h>

#include <cstddef>

#include "mesh/mesh_ops.h"

namespace swarf::mesh {
namespace {

template <typename Attribute>
void keep_used(std::vector<Attribute>& values, const std::vector<uint32_t>& place, size_t used) {
  if (values.empty()) return;
  meshopt_remapVertexBuffer(values.data(), values.data(), values.size(), sizeof(values[0]), place.data());
  values.resize(used);
}

}  // namespace

void thin_for_display(TriMesh& mesh, double max_error_mm) {
  if (mesh.triangles.empty()) return;
  uint32_t* indices = mesh.triangles.front().data();
  const float* positions = mesh.positions.front().data();
  constexpr size_t kStride = sizeof(mesh.positions[0]);
  const float extent = meshopt_simplifyScale(positions, mesh.positions.size(), kStride);
  if (!(extent > 0.0F)) return;
  std::vector<uint32_t> left(3 * mesh.triangles.size());
  left.resize(meshopt_simplify(left.data(), indices, left.size(), positions, mesh.positions.size(), kStride,
                               0, static_cast<float>(max_error_mm) / extent, meshopt_SimplifyLockBorder,
                               nullptr));
  std::vector<uint32_t> place(mesh.positions.size());
  const size_t used =
      meshopt_optimizeVertexFetchRemap(place.data(), left.data(), left.size(), mesh.positions.size());
  mesh.triangles.resize(left.size() / 3);
  if (!left.empty())
    meshopt_remapIndexBuffer(mesh.triangles.front().data(), left.data(), left.size(), place.data());
  keep_used(mesh.positions, place, used);
  keep_used(mesh.normals, place, used);
  keep_used(mesh.colours, place, used);
  keep_used(mesh.deviation_um, place, used);
}

}  // namespace swarf::mesh
