#include "reports/part_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/units.h"
#include "mesh/mesh_ops.h"
#include "mesh/shown_field.h"
#include "render/figures/axis_fan.h"
#include "sim/run/measured_mesh.h"

namespace swarf::reports {

namespace {

sim::MeasuredPart measured_part(const FinishedRun& run) {
  return {run.job, run.cycles, run.dexels, run.carried, run.rays, run.stock.voxel_mm()};
}

}  // namespace

TriMesh part_mesh(const FinishedRun& run) {
  TriMesh mesh = run.stock.mesh();
  sim::measure_mesh(measured_part(run), mesh);
  return mesh;
}

namespace {

/// Triangles that face against the normals of their corners. Decimation leaves such folds in flat places:
/// they lie upside down on others.
std::vector<uint32_t> folds(const TriMesh& mesh) {
  constexpr double kAgainst = -0.3;  // of a sum of three: corners on an edge have normals of both sides
  const auto vec = [](const std::array<float, 3>& a) { return Vec3(a[0], a[1], a[2]); };
  std::vector<uint32_t> found;
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    const Vec3 a = vec(mesh.positions[t[0]]);
    const Vec3 facing = (vec(mesh.positions[t[1]]) - a).cross(vec(mesh.positions[t[2]]) - a);
    const Vec3 sum = vec(mesh.normals[t[0]]) + vec(mesh.normals[t[1]]) + vec(mesh.normals[t[2]]);
    if (facing.dot(sum) < kAgainst * facing.norm()) found.push_back(i);
  }
  return found;
}

/// Of their corners, each once.
void turn_normals(TriMesh& mesh, const std::vector<uint32_t>& triangles) {
  std::vector<uint8_t> turned(mesh.positions.size(), 0);
  for (const uint32_t triangle : triangles)
    for (const uint32_t v : mesh.triangles[triangle]) {
      if (std::exchange(turned[v], 1) != 0) continue;
      for (float& n : mesh.normals[v]) n = -n;
    }
}

/// Where rays end whose neighbours have found another deviation.
std::vector<Vec3> changes_between_rays(const std::vector<stock::SurfaceDexels>& dexels,
                                       const render::DeviationScale& scale, double allowed_um,
                                       double near_mm) {
  constexpr size_t kMost = 2000;  // evenly over all
  std::vector<Vec3> ends;
  for (const stock::SurfaceDexels& rays : dexels) {
    const auto shown = [&](uint32_t ray) {
      return std::clamp(um_from_mm(rays.heights_mm()[ray]), -scale.below_um, scale.above_um);
    };
    for (const auto& [a, b] : rays.field().edges) {
      if (std::abs(shown(a) - shown(b)) <= allowed_um) continue;
      for (const uint32_t ray : {a, b})
        if (std::abs(rays.heights_mm()[ray]) <= near_mm)
          ends.push_back(rays.points()[ray] + rays.heights_mm()[ray] * rays.normals()[ray]);
    }
  }
  if (ends.size() <= kMost) return ends;
  std::vector<Vec3> some;
  for (size_t k = 0; k < kMost; ++k) some.push_back(ends[k * ends.size() / kMost]);
  return some;
}

/// The part whose design are facets or CAD faces. Folds are measured as what they lie on.
TriMesh divided_part(const FinishedRun& run, TriMesh closed, size_t most_vertices, double* colours_off) {
  const std::vector<uint32_t> folded = folds(closed);
  mesh::split_creases(closed, kCreaseRad);
  turn_normals(closed, folded);
  const sim::MeshMeasure measure(measured_part(run));
  const render::DeviationScale scale = deviation_scale(run.job, run.dexels);
  const render::ColourError error(scale);
  mesh::ShownField field{[&](TriMesh& places) { measure.measure(places); },
                         [&](const std::array<float, 3>& um, const Vec3& shares, float truth) {
                           return error(um, shares, truth);
                         },
                         scale.above_um};
  field.most_vertices = run.dexels.empty() ? 0 : most_vertices;
  field.near_mm = run.stock.voxel_mm();
  if (field.most_vertices > 0)
    field.known_changes = changes_between_rays(run.dexels, scale, error.allowed_um(), field.near_mm);
  mesh::show_field(field, closed);
  if (colours_off != nullptr) {
    constexpr size_t kPlaces = 2000;
    const mesh::ShownAgreement found = mesh::shown_agreement(field, closed, kPlaces);
    *colours_off = static_cast<double>(found.wrong) / static_cast<double>(std::max<size_t>(found.seen, 1));
  }
  turn_normals(closed, folds(closed));
  return closed;
}

}  // namespace

TriMesh shown_part(const FinishedRun& run, TriMesh closed, size_t most_vertices, double* colours_off) {
  if (run.job.design_mesh != nullptr) return divided_part(run, std::move(closed), most_vertices, colours_off);
  mesh::split_creases(closed, kCreaseRad);
  sim::measure_mesh(measured_part(run), closed);
  if (colours_off != nullptr) *colours_off = std::numeric_limits<double>::quiet_NaN();
  return closed;
}

namespace {

/// |Height| within which this share of the area lies that some sweep has cut, um.
double greatest_usual_um(const std::vector<stock::SurfaceDexels>& dexels, double share) {
  std::vector<std::pair<double, double>> heights;  // and areas
  double all = 0.0;
  for (const stock::SurfaceDexels& one : dexels)
    for (size_t n = 0; n < one.heights_mm().size(); ++n) {
      if (one.blocks()[n] == stock::kUncut) continue;
      const double area = one.field().areas_mm2.empty() ? 1.0 : one.field().areas_mm2[n];
      heights.emplace_back(std::abs(um_from_mm(one.heights_mm()[n])), area);
      all += area;
    }
  std::sort(heights.begin(), heights.end());
  double sum = 0.0;
  for (const auto& [um, area] : heights) {
    sum += area;
    if (sum >= share * all) return um;
  }
  return 0.0;
}

/// 1, 2 or 5 times a power of ten, not less.
double rounded_up(double um) {
  const double ten = std::pow(10.0, std::floor(std::log10(um)));
  constexpr double kRounding = 1.0 - 1e-9;
  for (const double step : {1.0, 2.0, 5.0})
    if (um * kRounding <= step * ten) return step * ten;
  return 10.0 * ten;
}

}  // namespace

render::DeviationScale deviation_scale(const sim::Job& job, const std::vector<stock::SurfaceDexels>& dexels) {
  const sim::AcceptLimits& accept = job.scene.accept;
  if (job.design_mesh == nullptr) {
    const double above = std::max(accept.scallop_max_um.value_or(0.0), accept.excess_max_um.value_or(0.0));
    return {accept.gouge_band_um(), above > 0.0 ? above : accept.scallop_band_um()};
  }
  const double limit = std::max({accept.scallop_max_um.value_or(0.0), accept.excess_max_um.value_or(0.0),
                                 accept.gouge_max_um.value_or(0.0)});
  if (limit > 0.0) return limit;
  constexpr double kUsual = 0.98;
  return rounded_up(std::max(greatest_usual_um(dexels, kUsual), kLeastScaleUm));
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
