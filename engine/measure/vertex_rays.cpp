#include "measure/vertex_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/parallel.h"
#include "base/units.h"
#include "mesh/mesh_distance.h"

namespace swarf::measure {
namespace {

/// Of the slack: of the facets beside an edge the one that agrees with a vertex may be farther by this.
constexpr double kBeside = 0.25;
/// Of a distance: a place so much straight below a point has the point over its face.
constexpr double kStraightOver = 0.9;
/// Places of two facets are one, mm, and so are normals with this cosine.
constexpr double kSameFoot = 1e-6, kSameNormal = 0.99999;
constexpr size_t kVerticesPerTask = 1024;
constexpr double kNotFound = std::numeric_limits<double>::quiet_NaN();

Vec3 as_vec3(const std::array<float, 3>& a) {
  return {a[0], a[1], a[2]};
}

/// A place of the design as a point sees it.
struct DesignPlace {
  Vec3 point = Vec3::Zero(), normal = Vec3::Zero();
  double distance_mm = std::numeric_limits<double>::infinity();

  double height_of(const Vec3& p) const { return (p - point).dot(normal); }
};

/// Finds places of a design by the facets that are near.
class DesignPlaces {
 public:
  explicit DesignPlaces(const stock::RayField& field)
      : sheets_(*field.sheets), design_(*field.design), facet_of_(design_.mesh.triangles.size(), kNone) {
    for (uint32_t f = 0; f < sheets_.sources.size(); ++f) facet_of_[sheets_.sources[f]] = f;
  }

  /// The nearest place, or one that is farther by `margin_mm` at most if its normal agrees with `normal`.
  DesignPlace at(const Vec3& p, const Vec3& normal, double margin_mm) const {
    const stock::DesignMesh::Place near = design_.nearest(p);
    DesignPlace best = seen_at(near, p);
    if (best.normal.dot(normal) >= kFaceCosine) return best;
    bool agrees = false;
    design_.distance.each_near(p, near.distance_mm + margin_mm, [&](uint32_t triangle) {
      const DesignPlace place = seen_at(design_.nearest_on(triangle, p), p);
      if (place.distance_mm > near.distance_mm + margin_mm) return;
      const bool also = place.normal.dot(normal) >= kFaceCosine;
      if (also < agrees || (also == agrees && !(place.distance_mm < best.distance_mm))) return;
      agrees = also;
      best = place;
    });
    return best;
  }

  /// The distance from the design, outside of it > 0, mm.
  double signed_distance(const Vec3& p) const {
    const stock::DesignMesh::Place near = design_.nearest(p);
    const double height = seen_at(near, p).height_of(p);
    if (std::abs(height) >= kStraightOver * near.distance_mm) return std::copysign(near.distance_mm, height);
    return distance_from_edge(near, height, p);
  }

 private:
  /// Where the nearest place lies on an edge or at a corner, the sum of the normals that meet there decides
  /// on which side the point is: one of them alone says nothing of a point in its own plane. Nearer to the
  /// edge of CAD faces than its facets stray, a point that is over one face and under another is as high as
  /// over that whose plane is nearer.
  double distance_from_edge(const stock::DesignMesh::Place& near, double height, const Vec3& p) const {
    const double stray = edge_stray(near.triangle), beside = kSameFoot + stray;
    std::vector<Vec3> normals;
    Vec3 sum = Vec3::Zero();
    double low = height, high = height;
    design_.distance.each_near(p, near.distance_mm + beside, [&](uint32_t triangle) {
      const DesignPlace place = seen_at(design_.nearest_on(triangle, p), p);
      if (!(place.distance_mm <= near.distance_mm + beside) ||
          (place.point - near.point).norm() > kSameFoot + 2.0 * beside)
        return;
      low = std::min(low, place.height_of(p));
      high = std::max(high, place.height_of(p));
      if (std::any_of(normals.begin(), normals.end(),
                      [&](const Vec3& one) { return one.dot(place.normal) > kSameNormal; }))
        return;
      normals.push_back(place.normal);
      sum += place.normal;
    });
    if (near.distance_mm <= stray && low <= 0.0 && high >= 0.0) return -low < high ? low : high;
    return std::copysign(near.distance_mm, normals.empty() ? height : (p - near.point).dot(sum));
  }

  /// How far the edge of a facet is from that of its face at most, mm.
  double edge_stray(uint32_t triangle) const {
    if (design_.under == nullptr) return 0.0;
    return design_.under->is_curved(triangle) ? design_.under->chord_mm : design_.under->edge_mm;
  }

  static constexpr uint32_t kNone = 0xffffffffU;

  /// Of a facet without area none: infinitely far away.
  DesignPlace seen_at(const stock::DesignMesh::Place& place, const Vec3& p) const {
    const uint32_t facet = facet_of_[place.triangle];
    if (facet == kNone) return {};
    const stock::FacetPlace on =
        sheets_.is_curved(facet) ? sheets_.place_at(facet, place.uv) : sheets_.nearest(facet, p, 0.0, p);
    return {on.point, on.normal, place.distance_mm};
  }

  const stock::FacetSheets& sheets_;
  const stock::DesignMesh& design_;
  std::vector<uint32_t> facet_of_;  ///< of each triangle
};

/// A ray for a vertex: where it begins, and how far along it the vertex is.
struct VertexRay {
  uint32_t vertex = 0;
  Vec3 point = Vec3::Zero(), normal = Vec3::Zero();
  double height_mm = 0.0;
};

/// Where rays end in material nearest to their vertices; NaN where that is farther away than the slack.
std::vector<double> ends_of(const VertexRayInput& input, const std::vector<VertexRay>& rays,
                            const std::shared_ptr<const stock::DesignMesh>& design) {
  std::vector<double> ends(rays.size(), kNotFound), tops;
  std::vector<Vec3> points, normals;
  for (const VertexRay& ray : rays) {
    points.push_back(ray.point);
    normals.push_back(ray.normal);
    tops.push_back(std::max(ray.height_mm, 0.0) + input.slack_mm);
  }
  stock::SurfaceDexels dexels(
      stock::rays_at(std::move(points), std::move(normals), design, input.design.pitch_mm), input.raw, tops);
  input.cut(dexels);
  if (design != nullptr) dexels.limit_depths();
  const auto take = [&](size_t n, double end) {
    const double off = std::abs(end - rays[n].height_mm);
    if (end < tops[n] && off <= input.slack_mm && !(off >= std::abs(ends[n] - rays[n].height_mm)))
      ends[n] = end;
  };
  for (size_t n = 0; n < rays.size(); ++n) take(n, dexels.heights_mm()[n]);
  dexels.each_above([&](uint32_t n, const stock::MaterialAbove& m) {
    if (m.high - m.low >= stock::kSliver) take(n, m.high);
  });
  return ends;
}

/// What rays have found, as it is set.
class VertexValues {
 public:
  explicit VertexValues(TriMesh& part) : part_(part) {}
  /// `end`: of the ray; NaN: nothing was found.
  void set(const VertexRay& ray, double end, double mm) {
    if (std::isnan(end)) return;
    part_.deviation_um[ray.vertex] = static_cast<float>(um_from_mm(mm));
  }

 private:
  TriMesh& part_;
};

VertexRay along_own_normal(const TriMesh& part, uint32_t vertex, double slack_mm) {
  const Vec3 normal = as_vec3(part.normals[vertex]).normalized();
  return {vertex, as_vec3(part.positions[vertex]) - slack_mm * normal, normal, slack_mm};
}

class VertexRays {
 public:
  VertexRays(const VertexRayInput& input, TriMesh& part)
      : input_(input), places_(input.design), part_(part) {}

  void measure() {
    std::vector<VertexRay> rays;
    for (uint32_t i = 0; i < part_.positions.size(); ++i)
      rays.push_back(along_own_normal(part_, i, input_.slack_mm));
    measure_distances(rays, nullptr);
    measure_over_design();
  }

 private:
  /// Where the rays end in material, and how far that is from the design.
  void measure_distances(const std::vector<VertexRay>& rays,
                         const std::shared_ptr<const stock::DesignMesh>& design) {
    const std::vector<double> ends = ends_of(input_, rays, design);
    std::vector<double> distances(rays.size(), kNotFound);
    parallel_chunks(rays.size(), kVerticesPerTask, [&](size_t begin, size_t end) {
      for (size_t n = begin; n < end; ++n)
        if (!std::isnan(ends[n]))
          distances[n] = places_.signed_distance(rays[n].point + ends[n] * rays[n].normal);
    });
    for (size_t n = 0; n < rays.size(); ++n) values_.set(rays[n], ends[n], distances[n]);
  }

  /// What no ray along its own normal has found, but lies over a face of the design: along that face's.
  void measure_over_design() {
    std::vector<VertexRay> rays;
    const double beside = kBeside * input_.slack_mm;
    for (uint32_t i = 0; i < part_.positions.size(); ++i) {
      if (!std::isnan(part_.deviation_um[i])) continue;
      const Vec3 p = as_vec3(part_.positions[i]), normal = as_vec3(part_.normals[i]);
      const DesignPlace place = places_.at(p, normal, beside);
      const double height = place.height_of(p);
      const double aside = (p - place.point - height * place.normal).norm();
      if (place.normal.dot(normal) >= kFaceCosine && aside <= input_.slack_mm)
        rays.push_back({i, place.point, place.normal, height});
    }
    measure_distances(rays, input_.design.design);
  }

  const VertexRayInput& input_;
  DesignPlaces places_;
  TriMesh& part_;
  VertexValues values_{part_};
};

}  // namespace

void deviation_by_vertex_rays(const VertexRayInput& input, TriMesh& part) {
  SWARF_CHECK(input.design.design != nullptr, "a parametric design has a grid of rays (seen_surface.h)");
  SWARF_CHECK(part.normals.size() == part.positions.size(), "rays follow normals");
  part.deviation_um.assign(part.positions.size(), std::numeric_limits<float>::quiet_NaN());
  VertexRays(input, part).measure();
}

void deviation_by_vertex_rays(const VertexRayInput& input, const SeenSurface& seen,
                              std::span<const uint32_t> vertices, TriMesh& part) {
  std::vector<VertexRay> over, own;
  VertexValues values(part);
  for (const uint32_t i : vertices) {
    const auto foot = seen.foot_of(as_vec3(part.positions[i]));
    if (foot && foot->normal.dot(as_vec3(part.normals[i])) >= kFaceCosine)
      over.push_back({i, seen.dexels().surface().point(foot->u, foot->v), foot->normal, foot->height_mm});
    else
      own.push_back(along_own_normal(part, i, input.slack_mm));
  }
  const std::vector<double> tops = ends_of(input, over, nullptr);
  for (size_t n = 0; n < over.size(); ++n) {
    if (std::isnan(tops[n])) own.push_back(along_own_normal(part, over[n].vertex, input.slack_mm));
    values.set(over[n], tops[n], tops[n]);
  }
  const std::vector<double> ends = ends_of(input, own, nullptr);
  for (size_t n = 0; n < own.size(); ++n) {
    if (std::isnan(ends[n])) continue;
    const auto foot = seen.foot_of(own[n].point + ends[n] * own[n].normal);
    if (foot) values.set(own[n], ends[n], foot->height_mm);
  }
}

}  // namespace swarf::measure
