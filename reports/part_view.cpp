#include "reports/part_view.h"

#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "base/units.h"
#include "measure/design_projection.h"
#include "measure/mesh_deviation.h"
#include "mesh/mesh_ops.h"
#include "render/figures/axis_fan.h"

namespace swarf::reports {
namespace {

/// Vertices of the level set's mesh lie within half a voxel of the true surface, cusps included.
constexpr double kReachVoxels = 0.6;
/// A vertex belongs to the machined face only if its own normal agrees with the design's: not a side wall
/// near it.
constexpr double kFaceCosine = 0.8;

Vec3 as_vec3(const std::array<float, 3>& a) {
  return {a[0], a[1], a[2]};
}

void take_measures(const FinishedRun& run, const stock::SurfaceDexels& dexels, TriMesh& mesh) {
  const measure::DesignProjection projection(dexels, kReachVoxels * run.stock.voxel_mm());
  parallel_chunks(mesh.positions.size(), 4096, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const auto foot = projection.project(as_vec3(mesh.positions[i]));
      if (!foot || as_vec3(mesh.normals[i]).dot(foot->normal) < kFaceCosine) continue;
      mesh.deviation_um[i] = static_cast<float>(um_from_mm(measure::height_at(dexels, foot->u, foot->v)));
      const uint32_t block = measure::block_at(dexels, foot->u, foot->v);
      // The blocks of CL and NC jobs are sweeps, not cycles, and mostly cut with the flank.
      if (block == stock::kUncut || run.job.scene.has_blocks()) continue;
      // The bottom of a flat end left this facet, so the tool's axis is its exact normal.
      const Vec3& axis = run.trajectory.samples[block].pose.axis_W;
      if (axis.dot(foot->normal) < kFaceCosine) continue;
      mesh.normals[i] = {static_cast<float>(axis.x()), static_cast<float>(axis.y()),
                         static_cast<float>(axis.z())};
    }
  });
}

void take_measures(const FinishedRun& run, TriMesh& mesh) {
  mesh.deviation_um.assign(mesh.positions.size(), std::numeric_limits<float>::quiet_NaN());
  if (run.job.design_mesh) {
    measure::deviation_from_mesh(mesh, *run.job.design_mesh, kReachVoxels * run.stock.voxel_mm());
    return;
  }
  for (const stock::SurfaceDexels& dexels : run.dexels) take_measures(run, dexels, mesh);
}

}  // namespace

TriMesh part_mesh(const FinishedRun& run) {
  TriMesh mesh = run.stock.mesh();
  take_measures(run, mesh);
  return mesh;
}

TriMesh shown_part(const FinishedRun& run, TriMesh closed) {
  mesh::split_creases(closed, kCreaseRad);
  take_measures(run, closed);
  return closed;
}

double deviation_scale_um(const sim::Job& job) {
  double allowed = job.scene.accept.scallop_band_um();
  const double digit = std::pow(10.0, std::floor(std::log10(allowed)));
  return std::ceil(allowed / digit - 0.2) * digit;
}

std::vector<render::DrawLine> fan_lines(const FinishedRun& run) {
  render::FanInput fan;
  int element = -1;
  for (const motion::ToolSample& sample : run.trajectory.samples) {
    if (sample.kind != motion::SampleKind::kCutting) continue;
    if (sample.element != element) {
      element = sample.element;
      fan.pass_starts.push_back(fan.points.size());
    }
    fan.points.push_back(sample.contact_W);
    fan.axes.push_back(sample.pose.axis_W);
  }
  return fan.points.empty() ? std::vector<render::DrawLine>{} : render::axis_fan(fan);
}

}  // namespace swarf::reports
