#include "reports/part_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "base/units.h"
#include "measure/design_projection.h"
#include "measure/mesh_deviation.h"
#include "measure/seen_surface.h"
#include "mesh/mesh_ops.h"
#include "render/figures/axis_fan.h"

namespace swarf::reports {
namespace {

/// Vertices of the level set's mesh lie within half a voxel of the true surface, cusps included.
constexpr double kReachVoxels = 0.6;
/// A facet that the bottom of a flat end has left turns no farther from the design.
constexpr double kFaceCosine = 0.8;

Vec3 as_vec3(const std::array<float, 3>& a) {
  return {a[0], a[1], a[2]};
}

/// The tool's axis in each cycle of a surface job. The blocks of CL and NC jobs are sweeps, not cycles, and
/// mostly cut with the flank.
std::vector<Vec3> axes_of(const FinishedRun& run) {
  std::vector<Vec3> axes;
  if (run.job.scene.has_blocks()) return axes;
  axes.reserve(run.cycles.size());
  motion::CycleReader reader(run.cycles);
  for (size_t k = 0; k < run.cycles.size(); ++k) axes.push_back(reader.at(k).sample.pose.axis_W);
  return axes;
}

void take_measures(const FinishedRun& run, const stock::SurfaceDexels& dexels, TriMesh& mesh) {
  const std::vector<Vec3> axes = axes_of(run);
  const measure::SeenSurface seen(dexels, kReachVoxels * run.stock.voxel_mm());
  parallel_chunks(mesh.positions.size(), 4096, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const auto here = seen.at(as_vec3(mesh.positions[i]), as_vec3(mesh.normals[i]));
      if (!here) continue;
      const auto deviation = static_cast<float>(um_from_mm(here->deviation_mm));
      // Where two surfaces of the design see one point, the worse of both.
      if (!(std::abs(deviation) < std::abs(mesh.deviation_um[i]))) mesh.deviation_um[i] = deviation;
      const measure::Foot& foot = here->foot;
      const uint32_t block = measure::block_at(dexels, foot.u, foot.v);
      if (!here->on_face || block == stock::kUncut || axes.empty()) continue;
      // The bottom of a flat end left this facet, so the tool's axis is its exact normal.
      const Vec3& axis = axes[block];
      if (axis.dot(foot.normal) < kFaceCosine) continue;
      mesh.normals[i] = {static_cast<float>(axis.x()), static_cast<float>(axis.y()),
                         static_cast<float>(axis.z())};
    }
  });
}

/// The farthest that any ray's material ends from the design, mm.
double greatest_height(const FinishedRun& run) {
  double greatest = 0.0;
  for (const stock::SurfaceDexels& dexels : run.dexels) {
    for (const double height : dexels.heights_mm()) greatest = std::max(greatest, std::abs(height));
  }
  return greatest;
}

void take_measures(const FinishedRun& run, TriMesh& mesh) {
  mesh.deviation_um.assign(mesh.positions.size(), std::numeric_limits<float>::quiet_NaN());
  if (run.job.design_mesh) {
    const double reach = greatest_height(run) + kReachVoxels * run.stock.voxel_mm();
    measure::deviation_from_mesh(mesh, *run.job.design_mesh, reach);
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

render::DeviationScale deviation_scale(const sim::Job& job) {
  const sim::AcceptLimits& accept = job.scene.accept;
  const double above = std::max(accept.scallop_max_um.value_or(0.0), accept.excess_max_um.value_or(0.0));
  return {accept.gouge_band_um(), above > 0.0 ? above : accept.scallop_band_um()};
}

std::vector<render::DrawLine> fan_lines(const FinishedRun& run) {
  render::FanInput fan;
  int element = -1;
  // All cycles of a short program, enough of a long one.
  const size_t shown = run.last_shown() - run.first_shown() + 1;
  const bool all = shown <= motion::CycleLimits{}.kept;
  for (const motion::Cycle& cycle : run.shown_cycles(all ? shown : 2 * motion::Cycles::kSpreadLeast)) {
    const motion::ToolSample& sample = cycle.sample;
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
