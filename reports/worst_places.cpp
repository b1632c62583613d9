// add_worst_places(): the extremes of the measuring rays as vertices of the mesh that is looked at.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/units.h"
#include "reports/review_models.h"

namespace swarf::reports {
namespace {

/// The level set's mesh is nearer to the true surface; farther away is another surface.
constexpr double kNearVoxels = 2.0;

/// Of the rays: the lowest that a cut has reached, and the highest material, above gaps too.
struct RayExtremes {
  std::optional<WorstPlace> lowest, highest;
};

RayExtremes extremes_of(const FinishedRun& run) {
  RayExtremes found;
  for (const stock::SurfaceDexels& dexels : run.dexels) {
    const std::vector<double>& heights = dexels.heights_mm();
    const auto raise = [&](uint32_t ray, double height) {
      if (!found.highest || height > found.highest->deviation_mm)
        found.highest = WorstPlace{dexels.points()[ray], height};
    };
    for (uint32_t i = 0; i < heights.size(); ++i) {
      raise(i, heights[i]);
      if (dexels.blocks()[i] != stock::kUncut && (!found.lowest || heights[i] < found.lowest->deviation_mm))
        found.lowest = WorstPlace{dexels.points()[i], heights[i]};
    }
    dexels.each_above([&](uint32_t ray, const stock::MaterialAbove& m) {
      if (m.high - m.low >= stock::kSliver) raise(ray, m.high);
    });
  }
  return found;
}

/// Where the material ends over, or below, a place of the design: along the normal of the ray that stands
/// nearest to it and has seen about as much.
Vec3 on_part(const FinishedRun& run, const WorstPlace& worst) {
  if (worst.end_W) return *worst.end_W;
  Vec3 normal = Vec3::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (const stock::SurfaceDexels& dexels : run.dexels) {
    std::vector<double> unlike(dexels.points().size());
    for (size_t i = 0; i < unlike.size(); ++i)
      unlike[i] = std::abs(dexels.heights_mm()[i] - worst.deviation_mm);
    dexels.each_above([&](uint32_t ray, const stock::MaterialAbove& m) {
      unlike[ray] = std::min(unlike[ray], std::abs(m.high - worst.deviation_mm));
    });
    for (size_t i = 0; i < unlike.size(); ++i) {
      const double off = (dexels.points()[i] - worst.place_W).norm() + unlike[i];
      if (off >= least) continue;
      least = off;
      normal = dexels.normals()[i];
    }
  }
  return worst.place_W + worst.deviation_mm * normal;
}

Vec3 point_of(const TriMesh& mesh, uint32_t vertex) {
  const auto& p = mesh.positions[vertex];
  return {p[0], p[1], p[2]};
}

/// Barycentric coordinates of the point of the triangle that is nearest to `p`; inside, or on its border.
Vec3 nearest_in_triangle(const Vec3& p, const std::array<Vec3, 3>& t) {
  const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
  const double d00 = ab.dot(ab), d01 = ab.dot(ac), d11 = ac.dot(ac), d20 = ap.dot(ab), d21 = ap.dot(ac);
  const double area = d00 * d11 - d01 * d01;
  if (area > 0.0) {
    const double v = (d11 * d20 - d01 * d21) / area, w = (d00 * d21 - d01 * d20) / area;
    if (v >= 0.0 && w >= 0.0 && v + w <= 1.0) return {1.0 - v - w, v, w};
  }
  Vec3 best(1.0, 0.0, 0.0);
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const auto a = static_cast<size_t>(k), b = static_cast<size_t>(next);
    const Vec3 edge = t[b] - t[a];
    const double share =
        edge.squaredNorm() > 0.0 ? std::clamp((p - t[a]).dot(edge) / edge.squaredNorm(), 0.0, 1.0) : 0.0;
    const double off = (p - t[a] - share * edge).norm();
    if (off >= least) continue;
    least = off;
    best.setZero();
    best[k] = 1.0 - share;
    best[next] = share;
  }
  return best;
}

struct Foot {
  size_t triangle = 0;
  Vec3 weights = Vec3::Zero();
  double distance_mm = std::numeric_limits<double>::infinity();
};

enum class Triangles { kMeasured, kAll };

Foot foot_of(const TriMesh& mesh, const Vec3& place, Triangles among) {
  Foot best;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    if (among == Triangles::kMeasured && std::any_of(corners.begin(), corners.end(), [&](uint32_t v) {
          return std::isnan(mesh.deviation_um[v]);
        }))
      continue;
    const std::array<Vec3, 3> at{point_of(mesh, corners[0]), point_of(mesh, corners[1]),
                                 point_of(mesh, corners[2])};
    // No point of the triangle is nearer than its first corner less its longest side.
    const double reach = std::sqrt(std::max((at[1] - at[0]).squaredNorm(), (at[2] - at[0]).squaredNorm()));
    if ((place - at[0]).norm() - reach > best.distance_mm) continue;
    const Vec3 weights = nearest_in_triangle(place, at);
    const double off = (place - weights[0] * at[0] - weights[1] * at[1] - weights[2] * at[2]).norm();
    if (off < best.distance_mm) best = {t, weights, off};
  }
  return best;
}

/// Wide enough that the place is found by who looks for the extreme vertex, far too small to be seen, mm.
constexpr double kRingMm = 0.02;

Vec3 weighted(const std::vector<std::array<float, 3>>& values, const std::array<uint32_t, 3>& corners,
              const Vec3& weights) {
  Vec3 sum = Vec3::Zero();
  for (size_t k = 0; k < 3; ++k) {
    const auto& v = values[corners[k]];
    sum += weights[static_cast<int>(k)] * Vec3(v[0], v[1], v[2]);
  }
  return sum;
}

/// A new vertex of a triangle, with what is interpolated there.
uint32_t add_inside(TriMesh& mesh, const std::array<uint32_t, 3>& corners, const Vec3& weights) {
  const Eigen::Vector3f p = weighted(mesh.positions, corners, weights).cast<float>();
  const Eigen::Vector3f n = weighted(mesh.normals, corners, weights).normalized().cast<float>();
  double um = 0.0;
  for (size_t k = 0; k < 3; ++k) um += weights[static_cast<int>(k)] * mesh.deviation_um[corners[k]];
  mesh.positions.push_back({p.x(), p.y(), p.z()});
  mesh.normals.push_back({n.x(), n.y(), n.z()});
  mesh.deviation_um.push_back(static_cast<float>(um));
  return static_cast<uint32_t>(mesh.positions.size() - 1);
}

/// The triangle gets a vertex with the height, and around it a ring that keeps what the triangle showed: one
/// place does not colour a facet of 100 mm.
void divide(TriMesh& mesh, const Foot& foot, double height_mm) {
  const std::array<uint32_t, 3> corners = mesh.triangles[foot.triangle];
  double widest = 0.0;
  for (size_t k = 0; k < 3; ++k)
    widest = std::max(widest, (point_of(mesh, corners[k]) - point_of(mesh, corners[(k + 1) % 3])).norm());
  const double share = std::min(0.5, kRingMm / std::max(widest, kRingMm));
  std::array<uint32_t, 3> ring{};
  for (size_t k = 0; k < 3; ++k)
    ring[k] =
        add_inside(mesh, corners, (1.0 - share) * foot.weights + share * Vec3::Unit(static_cast<int>(k)));
  const uint32_t vertex = add_inside(mesh, corners, foot.weights);
  mesh.deviation_um[vertex] = static_cast<float>(um_from_mm(height_mm));
  mesh.triangles[foot.triangle] = {ring[0], ring[1], vertex};
  mesh.triangles.push_back({ring[1], ring[2], vertex});
  mesh.triangles.push_back({ring[2], ring[0], vertex});
  for (size_t k = 0; k < 3; ++k) {
    const size_t next = (k + 1) % 3;
    mesh.triangles.push_back({corners[k], corners[next], ring[next]});
    mesh.triangles.push_back({corners[k], ring[next], ring[k]});
  }
}

/// Where no vertex around the place was measured: a measured triangle on it, too small to be seen.
void mark(TriMesh& mesh, const Foot& foot, double height_mm) {
  constexpr double kShare = 1e-4;  // of the triangle below it
  const std::array<uint32_t, 3> corners = mesh.triangles[foot.triangle];
  Vec3 place = Vec3::Zero();
  for (size_t k = 0; k < 3; ++k) place += foot.weights[static_cast<int>(k)] * point_of(mesh, corners[k]);
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (const uint32_t corner : corners) {
    const Eigen::Vector3f p = (place + kShare * (point_of(mesh, corner) - place)).cast<float>();
    mesh.positions.push_back({p.x(), p.y(), p.z()});
    mesh.normals.push_back(mesh.normals[corner]);
    mesh.deviation_um.push_back(static_cast<float>(um_from_mm(height_mm)));
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
}

}  // namespace

void add_worst_places(const FinishedRun& run, std::span<const WorstPlace> places, TriMesh& mesh) {
  if (mesh.deviation_um.empty() || mesh.normals.empty()) return;
  std::vector<WorstPlace> all(places.begin(), places.end());
  const auto known = [&](double sign) {
    return std::any_of(places.begin(), places.end(),
                       [&](const WorstPlace& one) { return one.end_W && sign * one.deviation_mm > 0.0; });
  };
  const RayExtremes rays = extremes_of(run);
  if (rays.lowest && !known(-1.0)) all.push_back(*rays.lowest);
  if (rays.highest && !known(1.0)) all.push_back(*rays.highest);
  if (all.empty()) return;
  const auto highest = std::max_element(
      all.begin(), all.end(), [](const auto& a, const auto& b) { return a.deviation_mm < b.deviation_mm; });
  const auto most = static_cast<float>(um_from_mm(highest->deviation_mm));
  for (float& um : mesh.deviation_um)
    if (um > most) um = most;
  const double near = kNearVoxels * run.stock.voxel_mm();
  for (const WorstPlace& one : all) {
    const Vec3 place = on_part(run, one);
    const Foot foot = foot_of(mesh, place, Triangles::kMeasured);
    const Foot any = foot.distance_mm <= near ? Foot{} : foot_of(mesh, place, Triangles::kAll);
    if (any.distance_mm <= near) mark(mesh, any, one.deviation_mm);
    if (foot.distance_mm <= near) divide(mesh, foot, one.deviation_mm);
  }
}

}  // namespace swarf::reports
