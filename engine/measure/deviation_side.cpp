#include "measure/deviation_side.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/parallel.h"

namespace swarf::measure {
namespace {

constexpr size_t kFacetsPerTask = 512;
/// Points above the border of a patch that lie no farther beside it than this still see the patch; mm.
constexpr double kBorderSlack = 1e-4;
/// Cosine of normals that look the same way.
constexpr double kFacing = 0.2;
/// Normals that differ by more look another way: acos(kFacing) and a little for rounding, rad.
constexpr double kAway = 1.3694384 + 1e-6;
/// A point of the offset design that lies so much nearer to the design is not on its surface, mm.
constexpr double kInsideOffset = 1e-5;
/// Rounding of the guess that bounds a search.
constexpr double kGuessSlack = 1e-9;
/// A facet that is found again is no farther than this from where it was found first, mm.
constexpr double kSameFacet = 1e-6;
/// Distances below this are rounding of doubles, mm.
constexpr double kSideRounding = 1e-11;

/// A cone that holds the normals of all faces. If it is no wider than a half space, it also holds those of
/// edges and vertices, which are sums of them.
void bound_normals(const mesh::SignedDistance& patches, Vec3& axis, double& spread_rad) {
  const auto count = static_cast<uint32_t>(patches.mesh().triangles.size());
  Vec3 sum = Vec3::Zero();
  for (uint32_t t = 0; t < count; ++t) sum += patches.face_normal(t);
  if (sum.norm() == 0.0) return;
  double widest = 0.0;
  for (uint32_t t = 0; t < count; ++t) widest = std::max(widest, angle_between(sum, patches.face_normal(t)));
  if (widest >= 0.5 * kPi) return;
  axis = sum.normalized();
  spread_rad = widest;
}

/// The outward normal at a place of a curved facet.
Vec3 normal_of(const stock::DesignMesh& faces, uint32_t triangle, const Vec2& uv) {
  const surface::Surface& surface =
      *faces.under->surfaces[static_cast<size_t>(faces.under->facets[triangle].surface)];
  return surface::outward_normal(surface, surface.derivatives(uv.x(), uv.y()), uv);
}

/// The worst of its three vertices for each facet.
std::vector<double> errors_of_stock(const ComparisonInput& input) {
  std::vector<double> errors;
  if (input.stock_error.empty()) return errors;
  for (const auto& t : input.stock->mesh().triangles)
    errors.push_back(std::max({input.stock_error[t[0]], input.stock_error[t[1]], input.stock_error[t[2]]}));
  return errors;
}

/// Where the grid has rounded an edge, what that may be off: tips are cut off there, and what lies beside
/// them is as exact as elsewhere.
void add_edge_errors(const ComparisonInput& input, std::vector<double>& errors) {
  if (input.stock_edge.empty()) return;
  for (size_t f = 0; f < errors.size(); ++f) {
    for (const uint32_t v : input.stock->mesh().triangles[f]) {
      if (input.stock_edge[v] != 0) errors[f] = std::max(errors[f], input.edge);
    }
  }
}

/// TargetMesh::near_errors, but for those of edges.
std::vector<double> near_errors_of(const mesh::SignedDistance& mesh, const std::vector<double>& errors) {
  std::vector<double> near = errors;
  for (uint32_t t = 0; t < errors.size(); ++t) {
    if (errors[t] <= TargetMesh::kQuiet) continue;
    const Corners corners{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
    mesh.tree().each_near(centroid_of(corners), radius_of(corners) + TargetMesh::kReach * errors[t],
                          [&](uint32_t facet) { near[facet] = std::max(near[facet], errors[t]); });
  }
  return near;
}

double greatest_of(const std::vector<double>& errors) {
  return errors.empty() ? 0.0 : *std::max_element(errors.begin(), errors.end());
}

}  // namespace

ComparisonScene::ComparisonScene(const ComparisonInput& comparison) : input(comparison) {
  stock_errors = errors_of_stock(input);
  design_errors = input.design_errors;
  if (design_errors.empty() && input.design_error > 0.0)
    design_errors.assign(input.design->mesh().triangles.size(), input.design_error);
  stock_near_errors = near_errors_of(*input.stock, stock_errors);
  design_near_errors = near_errors_of(*input.design, design_errors);
  const double most_of_stock = greatest_of(stock_errors);
  add_edge_errors(input, stock_errors);
  add_edge_errors(input, stock_near_errors);
  stock = {input.stock, stock_errors, most_of_stock, stock_near_errors};
  design = {input.design, design_errors, greatest_of(design_errors), design_near_errors};
  if (!input.open_design) return;
  bound_normals(*input.design, normal_axis, normal_spread_rad);
  if (input.edge <= 0.0) return;
  border_mesh.positions = input.design->mesh().positions;
  const auto& across = input.design->across();
  for (uint32_t side = 0; side < across.size(); ++side) {
    if (across[side] != mesh::SignedDistance::kBorder) continue;
    const auto& t = input.design->mesh().triangles[side / 3];
    border_mesh.triangles.push_back({t[side % 3], t[(side + 1) % 3], t[(side + 1) % 3]});
  }
  border = std::make_unique<mesh::MeshDistance>(border_mesh);
}

bool ComparisonScene::faces_away(const Vec3& normal) const {
  return angle_between(normal, normal_axis) - normal_spread_rad > kAway;
}

DeviationSide::DeviationSide(const ComparisonScene& scene, bool on_design)
    : scene_(scene), in_(scene.input), on_design_(on_design) {}

bool DeviationSide::stock_edge(uint32_t triangle) const {
  if (in_.stock_edge.empty()) return false;
  const auto& t = in_.stock->mesh().triangles[triangle];
  return (in_.stock_edge[t[0]] | in_.stock_edge[t[1]] | in_.stock_edge[t[2]]) != 0;
}

bool DeviationSide::near_border(const Vec3& point) const {
  return scene_.border != nullptr && scene_.border->nearest(point, in_.edge).distance_mm <= in_.edge;
}

/// What lies within the rounding of an edge is put down to the grid; beyond it the whole of it counts.
void DeviationSide::discount(DeviationSample& sample) const {
  sample.counted = sample.edge && std::abs(sample.raw) <= in_.edge ? 0.0 : sample.raw;
}

/// Signed distance of a point from the faces over the design, of which the facets say `facets_mm`.
double DeviationSide::distance_to_faces(const Vec3& point, double facets_mm) const {
  if (in_.faces == nullptr || !std::isfinite(facets_mm)) return facets_mm;
  const stock::DesignMesh::Place place = in_.faces->nearest(point, std::abs(facets_mm) + kSameFacet);
  const bool clear = std::abs(facets_mm) > in_.design_error;
  if (!in_.faces->under->is_curved(place.triangle) && !clear) return facets_mm;
  const double side =
      clear ? facets_mm : (point - place.point).dot(normal_of(*in_.faces, place.triangle, place.uv));
  return std::copysign(place.distance_mm, side);
}

/// Signed distance from the stock of the place, moved by the allowance, over a point of the design's facets,
/// which itself is `facets_mm` away when moved.
double DeviationSide::distance_from_faces(const Vec3& point, double facets_mm) const {
  if (in_.faces == nullptr || !std::isfinite(facets_mm)) return facets_mm;
  const stock::DesignMesh::Place place = in_.faces->nearest(point, kSameFacet);
  if (!in_.faces->under->is_curved(place.triangle)) return facets_mm;
  const Vec3 target = place.point + in_.allowance * normal_of(*in_.faces, place.triangle, place.uv);
  return in_.stock->at(target).distance_mm;
}

DeviationSample DeviationSide::look_from_stock(uint32_t triangle, const Vec3& point, double within) const {
  const mesh::SignedPoint seen = in_.design->at(point, within);
  DeviationSample sample;
  sample.distance = seen.distance_mm;
  sample.facet = seen.triangle;
  sample.foot = seen.foot;
  sample.raw = distance_to_faces(point, seen.distance_mm) - in_.allowance;
  sample.error = own_error(triangle) + opposite().error(seen.triangle);
  if (in_.open_design &&
      (seen.beyond_mm > kBorderSlack || in_.stock->face_normal(triangle).dot(seen.normal) < kFacing)) {
    sample.state = CellState::kBeyond;
    return sample;
  }
  sample.edge = stock_edge(triangle) || near_border(seen.foot);
  return sample;
}

DeviationSample DeviationSide::look_from_design(uint32_t triangle, const Vec3& target, double within) const {
  const mesh::SignedPoint seen = in_.stock->at(target, within);
  DeviationSample sample;
  sample.distance = seen.distance_mm;
  sample.facet = seen.triangle;
  sample.foot = seen.foot;
  sample.raw =
      -distance_from_faces(target - in_.allowance * in_.design->face_normal(triangle), seen.distance_mm);
  sample.error = own_error(triangle) + opposite().error(seen.triangle);
  sample.edge =
      stock_edge(seen.triangle) || near_border(target - in_.allowance * in_.design->face_normal(triangle));
  if (in_.allowance > 0.0) {
    const double depth = in_.allowance - in_.design->at(target, in_.allowance).distance_mm;
    sample.inside = depth > kInsideOffset ? depth : 0.0;
  }
  return sample;
}

DeviationSample DeviationSide::look(uint32_t triangle, const Vec3& point, const DeviationSample* near) const {
  if (!on_design_ && in_.open_design && scene_.faces_away(in_.stock->face_normal(triangle))) {
    DeviationSample away;
    away.state = CellState::kBeyond;
    return away;
  }
  const Vec3 target = point + shift(triangle);
  double within = std::numeric_limits<double>::infinity();
  if (near != nullptr) {
    // The facet that a neighbour saw is hardly farther than the one to be found.
    const auto corner = [&](size_t i) { return other().corner(near->facet, i); };
    const Vec3 foot = mesh::closest_point_on_triangle(target, corner(0), corner(1), corner(2));
    within = (foot - target).norm() * (1.0 + kGuessSlack) + kGuessSlack;
  }
  DeviationSample sample =
      on_design_ ? look_from_design(triangle, target, within) : look_from_stock(triangle, target, within);
  if (std::abs(sample.raw) < kSideRounding) sample.raw = 0.0;
  if (in_.reach && std::abs(sample.distance) > *in_.reach && sample.state == CellState::kMeasured)
    sample.state = CellState::kFar;
  discount(sample);
  return sample;
}

SampledSide::SampledSide(const ComparisonScene& scene, bool on_design)
    : side(scene, on_design), cells(side.own()) {}

void SampledSide::sample() {
  for (size_t i = 0; i < cells.size(); ++i) {
    if (radius_of(cells.corners(i)) > side.pitch()) cells.halve(static_cast<uint32_t>(i));
  }
  samples.resize(cells.size());
  parallel_chunks(cells.size(), kFacetsPerTask, [&](size_t begin, size_t end) {
    const DeviationSample* last = nullptr;
    for (size_t i = begin; i < end; ++i) {
      if (!cells.is_leaf(i)) continue;
      samples[i] = side.look(cells[i].triangle, centroid_of(cells.corners(i)), last);
      if (samples[i].facet != DeviationSample::kUnseen) last = &samples[i];
    }
  });
}

double counted_of(const DeviationSample& sample, bool gouge) {
  if (sample.state != CellState::kMeasured || (!gouge && sample.inside > 0.0)) return 0.0;
  return std::max(0.0, gouge ? -sample.counted : sample.counted);
}

double SampledSide::worst(size_t cell, bool gouge) const {
  if (!cells.is_leaf(cell)) return 0.0;
  const auto found = findings[gouge ? 1 : 0].find(static_cast<uint32_t>(cell));
  const double own = counted_of(samples[cell], gouge);
  return found == findings[gouge ? 1 : 0].end() ? own : std::max(own, found->second.value);
}

Vec3 SampledSide::worst_place(size_t cell, bool gouge) const {
  const auto found = findings[gouge ? 1 : 0].find(static_cast<uint32_t>(cell));
  if (found != findings[gouge ? 1 : 0].end() && found->second.value > counted_of(samples[cell], gouge))
    return found->second.place;
  return centroid_of(cells.corners(cell));
}

}  // namespace swarf::measure
