#include "sim/run/measured_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "base/units.h"
#include "measure/design_projection.h"
#include "measure/mesh_deviation.h"
#include "measure/seen_surface.h"

namespace swarf::sim {
namespace {

/// Vertices of the level set's mesh lie within half a voxel of the true surface, cusps included.
constexpr double kReachVoxels = 0.6;
/// A facet that the bottom of a flat end has left turns no farther from the design.
constexpr double kFaceCosine = 0.8;

Vec3 as_vec3(const std::array<float, 3>& a) {
  return {a[0], a[1], a[2]};
}

/// The tool's axis in each cycle of planned passes. Blocks are sweeps, not cycles, and mostly cut with the
/// flank.
std::vector<Vec3> axes_of(const MeasuredPart& part) {
  std::vector<Vec3> axes;
  if (!part.set_normals || !normals_need_cycles(part.job)) return axes;
  axes.reserve(part.cycles.size());
  motion::CycleReader reader(part.cycles);
  for (size_t k = 0; k < part.cycles.size(); ++k) axes.push_back(reader.at(k).sample.pose.axis_W);
  return axes;
}

void measure_by_rays(const MeasuredPart& part, const stock::SurfaceDexels& dexels, TriMesh& mesh) {
  const std::vector<Vec3> axes = axes_of(part);
  const measure::SeenSurface seen(dexels, kReachVoxels * part.voxel_mm);
  parallel_chunks(mesh.positions.size(), 4096, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const auto here = seen.at(as_vec3(mesh.positions[i]), as_vec3(mesh.normals[i]));
      if (!here) continue;
      const auto deviation = static_cast<float>(um_from_mm(here->deviation_mm));
      // Where two surfaces of the design see one point, the worse of both.
      if (!(std::abs(deviation) < std::abs(mesh.deviation_um[i]))) mesh.deviation_um[i] = deviation;
      const measure::Foot& foot = here->foot;
      const uint32_t block = measure::block_at(dexels, foot.u, foot.v);
      // Sweeps of the job come first and are its cycles; those behind them are of earlier set-ups.
      if (!here->on_face || block >= axes.size()) continue;
      // The bottom of a flat end left this facet, so the tool's axis is its exact normal.
      const Vec3& axis = axes[block];
      if (axis.dot(foot.normal) < kFaceCosine) continue;
      mesh.normals[i] = {static_cast<float>(axis.x()), static_cast<float>(axis.y()),
                         static_cast<float>(axis.z())};
    }
  });
}

/// The farthest that any ray's material ends from the design, mm.
double greatest_height(const MeasuredPart& part) {
  double greatest = 0.0;
  for (const stock::SurfaceDexels& dexels : part.dexels) {
    for (const double height : dexels.heights_mm()) greatest = std::max(greatest, std::abs(height));
  }
  return greatest;
}

}  // namespace

bool normals_need_cycles(const Job& job) {
  // Sweeps of driven passes are pieces of cycles: what they leave keeps the mesh's own normals.
  return job.scene.stock.cut_by == CutBy::kPasses && job.driven == nullptr;
}

void measure_mesh(const MeasuredPart& part, TriMesh& mesh) {
  mesh.deviation_um.assign(mesh.positions.size(), std::numeric_limits<float>::quiet_NaN());
  if (part.job.design_mesh) {
    const double reach = greatest_height(part) + kReachVoxels * part.voxel_mm;
    measure::deviation_from_mesh(mesh, *part.job.design_mesh, reach);
    return;
  }
  for (const stock::SurfaceDexels& dexels : part.dexels) measure_by_rays(part, dexels, mesh);
}

}  // namespace swarf::sim
