#include "reports/design_view.h"

#include <algorithm>

#include "mesh/mesh_ops.h"
#include "reports/part_view.h"
#include "stock/rays/ray_field.h"

namespace swarf::reports {
namespace {

constexpr double kDesignChord = 0.01;    // mm, along u and along v
constexpr double kDesignError = 0.02;    // mm, of a mesh that is made lighter
constexpr double kDesignPitches = 64.0;  // steps across the stock where the design is flat

void add_patch(const surface::SurfacePtr& surface, double pitch_mm, TriMesh& mesh) {
  const stock::RayFieldPtr field = stock::rays_on_surface(surface, pitch_mm, kDesignChord);
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (const Vec3& p : field->points) {
    const Eigen::Vector3f place = p.cast<float>();
    mesh.positions.push_back({place.x(), place.y(), place.z()});
  }
  for (const auto& t : field->triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

}  // namespace

DisplayMesh shown_design(const sim::Job& job) {
  DisplayMesh shown;
  if (job.design_mesh != nullptr) {
    shown.mesh = mesh::decimate(*job.design_mesh, kDesignError, &shown.error_mm);
    if (job.design_under != nullptr) shown.error_mm += job.design_under->chord_mm;
  } else if (!job.design.empty()) {
    const double pitch = job.scene.stock.box_W.size().norm() / kDesignPitches;
    for (const surface::SurfacePtr& surface : job.design) add_patch(surface, pitch, shown.mesh);
    shown.error_mm = 2.0 * kDesignChord;  // a facet's middle is off by both chords together
  }
  shown.mesh.deviation_um.clear();
  shown.mesh.colours.clear();
  if (!shown.mesh.triangles.empty()) mesh::compute_vertex_normals(shown.mesh, kCreaseRad);
  return shown;
}

}  // namespace swarf::reports
