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

 private:
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
      : input_(input), places_(input.design), part_(part), starts_(part.positions.size()) {}

  void measure() {
    const double beside = kBeside * input_.slack_mm;
    std::vector<uint8_t> on_face(starts_.size(), 0);
    parallel_chunks(starts_.size(), kVerticesPerTask, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        const Vec3 p = as_vec3(part_.positions[i]), normal = as_vec3(part_.normals[i]);
        const DesignPlace place = places_.at(p, normal, beside);
        const double height = place.height_of(p);
        const double aside = (p - place.point - height * place.normal).norm();
        on_face[i] = place.normal.dot(normal) >= kFaceCosine && aside <= input_.slack_mm ? 1 : 0;
        starts_[i] = {static_cast<uint32_t>(i), place.point, place.normal, height};
      }
    });
    std::vector<VertexRay> rays;
    for (size_t i = 0; i < starts_.size(); ++i)
      if (on_face[i] != 0) rays.push_back(starts_[i]);
    const std::vector<double> ends = ends_of(input_, rays, input_.design.design);
    for (size_t n = 0; n < rays.size(); ++n) values_.set(rays[n], ends[n], ends[n]);
    measure_rest();
  }

 private:
  /// What is not on a face: along its own normal.
  void measure_rest() {
    std::vector<VertexRay> rays;
    for (uint32_t i = 0; i < starts_.size(); ++i) {
      if (!std::isnan(part_.deviation_um[i])) continue;
      rays.push_back(along_own_normal(part_, i, input_.slack_mm));
    }
    const std::vector<double> ends = ends_of(input_, rays, nullptr);
    std::vector<double> distances(rays.size(), kNotFound);
    parallel_chunks(rays.size(), kVerticesPerTask, [&](size_t begin, size_t end) {
      for (size_t n = begin; n < end; ++n) {
        if (std::isnan(ends[n])) continue;
        const Vec3 p = rays[n].point + ends[n] * rays[n].normal;
        const DesignPlace place = places_.at(p, rays[n].normal, 0.0);
        distances[n] = std::copysign(place.distance_mm, place.height_of(p));
      }
    });
    for (size_t n = 0; n < rays.size(); ++n) values_.set(rays[n], ends[n], distances[n]);
  }

  const VertexRayInput& input_;
  DesignPlaces places_;
  TriMesh& part_;
  VertexValues values_{part_};
  std::vector<VertexRay> starts_;
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
