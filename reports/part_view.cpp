#include "reports/part_view.h"

#include <algorithm>

#include "mesh/mesh_ops.h"
#include "render/figures/axis_fan.h"
#include "sim/run/measured_mesh.h"

namespace swarf::reports {

namespace {

void measure_part(const FinishedRun& run, TriMesh& mesh) {
  sim::measure_mesh({run.job, run.cycles, run.dexels, run.carried, run.rays, run.stock.voxel_mm()}, mesh);
}

}  // namespace

TriMesh part_mesh(const FinishedRun& run) {
  TriMesh mesh = run.stock.mesh();
  measure_part(run, mesh);
  return mesh;
}

TriMesh shown_part(const FinishedRun& run, TriMesh closed) {
  mesh::split_creases(closed, kCreaseRad);
  measure_part(run, closed);
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
