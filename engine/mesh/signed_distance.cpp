#include "mesh/signed_distance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/angles.h"
#include "base/check.h"
#include "base/units.h"
#include "mesh/mesh_check.h"

namespace swarf::mesh {
namespace {

/// The welded mesh as floats again: its points were floats.
TriMesh welded_part(const TriMesh& mesh) {
  const WeldedMesh welded = weld(mesh);
  TriMesh part;
  part.positions.reserve(welded.points.size());
  for (const Vec3& p : welded.points) {
    const Eigen::Vector3f f = p.cast<float>();
    part.positions.push_back({f.x(), f.y(), f.z()});
  }
  part.triangles = welded.triangles;
  return part;
}

/// A vertex lies on a side if it is no farther than this share of its length: floats put it beside.
constexpr double kOnSide = 1e-6;
constexpr uint32_t kNoArea = 0xffffffffU;

/// Per facet its number among those with area, or kNoArea.
std::vector<uint32_t> number_sound(const TriMesh& mesh) {
  std::vector<uint32_t> numbers;
  numbers.reserve(mesh.triangles.size());
  uint32_t count = 0;
  const auto point = [&](uint32_t v) {
    return Vec3(mesh.positions[v][0], mesh.positions[v][1], mesh.positions[v][2]);
  };
  for (const auto& t : mesh.triangles) {
    const Vec3 a = point(t[0]);
    const bool sound = (point(t[1]) - a).cross(point(t[2]) - a).squaredNorm() > 0.0;
    numbers.push_back(sound ? count++ : kNoArea);
  }
  return numbers;
}

/// Facets without area that hang together, by the first of them.
uint32_t seam_root(std::vector<uint32_t>& root, uint32_t i) {
  while (root[i] != i) i = root[i] = root[root[i]];
  return i;
}

double segment_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  return (a + std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0) * along - p).norm();
}

double angle_at(const Vec3& apex, const Vec3& a, const Vec3& b) {
  return angle_between(a - apex, b - apex);
}

}  // namespace

SignedDistance::SignedDistance(const TriMesh& mesh) {
  const TriMesh welded = welded_part(mesh);
  const std::vector<uint32_t> number = number_sound(welded);
  mesh_.positions = welded.positions;
  for (uint32_t t = 0; t < number.size(); ++t) {
    if (number[t] != kNoArea) mesh_.triangles.push_back(welded.triangles[t]);
  }
  SWARF_CHECK(!mesh_.triangles.empty(), "distances need a mesh with area");
  tree_ = std::make_unique<MeshDistance>(mesh_);
  face_normals_.reserve(mesh_.triangles.size());
  for (uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    const Vec3 a = corner(t, 0);
    face_normals_.push_back((corner(t, 1) - a).cross(corner(t, 2) - a).normalized());
  }
  join_sides(welded, number);
  add_vertex_normals();
  add_seam_normals();
}

SignedDistance::SignedDistance(const TriMesh& mesh, double error_mm) : SignedDistance(mesh) {
  error_mm_ = error_mm;
}

void SignedDistance::join_sides(const TriMesh& welded, const std::vector<uint32_t>& number) {
  if (mesh_.triangles.size() == welded.triangles.size()) {
    across_ = facets_across(mesh_.triangles);
    return;
  }
  const std::vector<uint32_t> across = facets_across(welded.triangles);
  std::vector<uint32_t> root(number.size());
  std::iota(root.begin(), root.end(), 0U);
  for (uint32_t side = 0; side < across.size(); ++side) {
    const uint32_t other = across[side];
    if (other == kBorder || number[side / 3] != kNoArea || number[other] != kNoArea) continue;
    const uint32_t a = seam_root(root, side / 3), b = seam_root(root, other);
    root[std::max(a, b)] = std::min(a, b);
  }
  across_.assign(3 * mesh_.triangles.size(), kBorder);
  std::unordered_map<uint32_t, uint32_t> seam_of_root;
  for (uint32_t side = 0; side < across.size(); ++side) {
    const uint32_t own = number[side / 3], other = across[side];
    if (own == kNoArea || other == kBorder) continue;
    const uint32_t place = 3 * own + side % 3;
    across_[place] = number[other];
    if (number[other] != kNoArea) continue;
    const auto [seam, is_new] =
        seam_of_root.try_emplace(seam_root(root, other), static_cast<uint32_t>(seams_.size()));
    if (is_new) seams_.emplace_back();
    seams_[seam->second].push_back(place);
    seam_of_[place] = seam->second;
    across_[place] = kSeam;
  }
}

/// A vertex within another facet's long side lies on that facet as well, which has half a turn there.
void SignedDistance::add_seam_normals() {
  for (const std::vector<uint32_t>& seam : seams_) {
    const auto place = [&](uint32_t side, size_t i) { return corner(side / 3, (side % 3 + i) % 3); };
    Vec3 low = place(seam.front(), 0), high = low;
    for (const uint32_t side : seam) {
      low = low.cwiseMin(place(side, 0));
      high = high.cwiseMax(place(side, 0));
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    std::vector<std::pair<double, uint32_t>> vertices;  // in order along the longest extent
    for (const uint32_t side : seam)
      vertices.emplace_back(place(side, 0)[axis], mesh_.triangles[side / 3][side % 3]);
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const uint32_t side : seam) {
      const Vec3 a = place(side, 0), b = place(side, 1);
      const auto from = std::lower_bound(vertices.begin(), vertices.end(),
                                         std::pair{std::min(a[axis], b[axis]), uint32_t{0}});
      for (auto v = from; v != vertices.end() && v->first <= std::max(a[axis], b[axis]); ++v) {
        const auto& f = mesh_.positions[v->second];
        const Vec3 p(f[0], f[1], f[2]);
        const double along = (p - a).dot(b - a) / (b - a).squaredNorm();
        if (along <= 0.0 || along >= 1.0 || segment_distance(p, a, b) > kOnSide * (b - a).norm()) continue;
        vertex_normals_[v->second] += kPi * face_normals_[side / 3];
      }
    }
  }
}

/// The facet on the other side of a seam at a point of it.
const Vec3& SignedDistance::normal_across_seam(uint32_t side, const Vec3& point) const {
  uint32_t best = side;
  double least = std::numeric_limits<double>::infinity();
  const Vec3 along = corner(side / 3, (side % 3 + 1) % 3) - corner(side / 3, side % 3);
  for (const uint32_t other : seams_[seam_of_.at(side)]) {
    const Vec3 a = corner(other / 3, other % 3), b = corner(other / 3, (other % 3 + 1) % 3);
    // The surface is oriented: what lies opposite runs the other way.
    if (other == side || along.dot(b - a) >= 0.0) continue;
    const double distance = segment_distance(point, a, b);
    if (distance >= least) continue;
    least = distance;
    best = other;
  }
  return face_normals_[best / 3];
}

void SignedDistance::add_vertex_normals() {
  vertex_normals_.assign(mesh_.positions.size(), Vec3::Zero());
  on_border_.assign(mesh_.positions.size(), 0);
  for (uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t v = mesh_.triangles[t][i];
      vertex_normals_[v] +=
          angle_at(corner(t, i), corner(t, (i + 1) % 3), corner(t, (i + 2) % 3)) * face_normals_[t];
      if (across_[3 * size_t{t} + i] != kBorder) continue;
      on_border_[v] = on_border_[mesh_.triangles[t][(i + 1) % 3]] = 1;
    }
  }
}

Vec3 SignedDistance::corner(uint32_t triangle, size_t place) const {
  const auto& p = mesh_.positions[mesh_.triangles[triangle][place]];
  return {p[0], p[1], p[2]};
}

Vec3 SignedDistance::pseudo_normal(const NearestPoint& nearest, bool& border) const {
  const uint32_t t = nearest.triangle;
  const auto edge = [&](size_t side) -> Vec3 {
    const uint32_t other = across_[3 * size_t{t} + side];
    if (other == kSeam)
      return face_normals_[t] + normal_across_seam(3 * t + static_cast<uint32_t>(side), nearest.point);
    border = other == kBorder;
    return border ? face_normals_[t] : Vec3(face_normals_[t] + face_normals_[other]);
  };
  const auto vertex = [&](size_t place) -> Vec3 {
    const uint32_t v = mesh_.triangles[t][place];
    border = on_border_[v] != 0;
    return vertex_normals_[v];
  };
  border = false;
  switch (nearest.feature) {
    case Feature::kFace:
      return face_normals_[t];
    case Feature::kEdgeAB:
      return edge(0);
    case Feature::kEdgeBC:
      return edge(1);
    case Feature::kEdgeCA:
      return edge(2);
    case Feature::kA:
      return vertex(0);
    case Feature::kB:
      return vertex(1);
    case Feature::kC:
      return vertex(2);
  }
  return face_normals_[t];
}

bool SignedDistance::winds_around(const Vec3& p) const {
  std::call_once(lines_once_, [&] { lines_ = std::make_unique<MeshLines>(mesh_); });
  return lines_->winding(p) > 0.5;
}

SignedPoint SignedDistance::at(const Vec3& p, double within_mm) const {
  const NearestPoint nearest = tree_->nearest(p, within_mm);
  SignedPoint result;
  if (std::isinf(nearest.distance_mm)) return result;
  bool border = false;
  const Vec3 normal = pseudo_normal(nearest, border);
  const double length = normal.norm();
  result.foot = nearest.point;
  result.triangle = nearest.triangle;
  result.normal = length > 0.0 ? Vec3(normal / length) : face_normals_[nearest.triangle];
  const Vec3 away = p - nearest.point;
  const double height = away.dot(result.normal);
  const bool inside = nearest.distance_mm > error_mm_ ? winds_around(p) : height < 0.0;
  result.distance_mm = inside ? -nearest.distance_mm : nearest.distance_mm;
  if (border) result.beyond_mm = (away - height * result.normal).norm();
  return result;
}

}  // namespace swarf::mesh
