#include "measure/mesh_deviation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "base/units.h"
#include "measure/design_projection.h"
#include "mesh/mesh_distance.h"

namespace swarf::measure {
namespace {

constexpr double kFaceCosine = 0.8;  // of the angle between the stock's normal and the design's
constexpr size_t kChunk = 4096;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

Vec3 as_vec3(const std::array<float, 3>& a) {
  return {a[0], a[1], a[2]};
}

/// Mean of the triangle's vertex normals, weighted by the point's barycentric coordinates.
Vec3 normal_at(const TriMesh& mesh, const mesh::NearestPoint& nearest) {
  const auto& corners = mesh.triangles[nearest.triangle];
  const Vec3 a = as_vec3(mesh.positions[corners[0]]);
  const Vec3 ab = as_vec3(mesh.positions[corners[1]]) - a;
  const Vec3 ac = as_vec3(mesh.positions[corners[2]]) - a;
  const Vec3 ap = nearest.point - a;
  const Vec3 n = ab.cross(ac);
  const double area = n.squaredNorm();
  const double wb = area > 0.0 ? ap.cross(ac).dot(n) / area : 0.0;
  const double wc = area > 0.0 ? ab.cross(ap).dot(n) / area : 0.0;
  return (1.0 - wb - wc) * as_vec3(mesh.normals[corners[0]]) + wb * as_vec3(mesh.normals[corners[1]]) +
         wc * as_vec3(mesh.normals[corners[2]]);
}

}  // namespace

void deviation_from_surface(TriMesh& stock, const stock::SurfaceDexels& design, double reach_mm,
                            double edge_mm) {
  const DesignProjection projection(design, reach_mm);
  stock.deviation_um.resize(stock.positions.size(), kUnknown);
  parallel_chunks(stock.positions.size(), kChunk, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const auto foot = projection.project(as_vec3(stock.positions[i]));
      if (!foot || foot->to_edge_mm < edge_mm) continue;
      if (as_vec3(stock.normals[i]).dot(foot->normal) < kFaceCosine) continue;
      stock.deviation_um[i] = static_cast<float>(um_from_mm(foot->height_mm));
    }
  });
}

void deviation_from_mesh(TriMesh& stock, const TriMesh& design, double reach_mm) {
  const mesh::MeshDistance distance(design);
  stock.deviation_um.assign(stock.positions.size(), kUnknown);
  parallel_chunks(stock.positions.size(), kChunk, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const Vec3 p = as_vec3(stock.positions[i]);
      const mesh::NearestPoint nearest = distance.nearest(p);
      if (nearest.distance_mm > reach_mm) continue;
      const bool outside = (p - nearest.point).dot(normal_at(design, nearest)) >= 0.0;
      stock.deviation_um[i] =
          static_cast<float>(um_from_mm(outside ? nearest.distance_mm : -nearest.distance_mm));
    }
  });
}

DeviationSummary summarise(const TriMesh& stock, const MeasureLimits& limits) {
  DeviationSummary summary;
  size_t within = 0;
  double sum = 0.0, squares = 0.0;
  for (const float value : stock.deviation_um) {
    if (std::isnan(value)) {
      ++summary.unmeasured;
      continue;
    }
    const double um = value;
    ++summary.measured;
    summary.excess_max_um = std::max(summary.excess_max_um, um);
    summary.gouge_max_um = std::max(summary.gouge_max_um, -um);
    sum += std::abs(um);
    squares += um * um;
    if (um >= -um_from_mm(limits.gouge_mm) && um <= um_from_mm(limits.scallop_mm)) ++within;
  }
  if (summary.measured == 0) return summary;
  const auto count = static_cast<double>(summary.measured);
  summary.mean_abs_um = sum / count;
  summary.rms_um = std::sqrt(squares / count);
  summary.within_tolerance_pct = 100.0 * static_cast<double>(within) / count;
  return summary;
}

}  // namespace swarf::measure
