#include "mesh/mesh_distance.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/check.h"
#include "base/parallel.h"

namespace swarf::mesh {
namespace {

/// Roundings of a coordinate on its way through Embree's box test (the point's own, the box's, the
/// difference, its square and the sum), in units of the largest coordinate's last place; with room to spare.
constexpr double kRoundings = 16.0;
constexpr double kFloatEpsilon = std::numeric_limits<float>::epsilon();

Vec3 closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b, double& t) {
  const Vec3 ab = b - a;
  const double length_squared = ab.squaredNorm();
  t = length_squared == 0.0 ? 0.0 : std::clamp((p - a).dot(ab) / length_squared, 0.0, 1.0);
  return a + t * ab;
}

/// Nearest of the three edges' points: for triangles without area.
Vec3 closest_on_edges(const Vec3& p, const std::array<Vec3, 3>& corners, Feature& feature) {
  constexpr std::array<Feature, 3> kEdges{Feature::kEdgeAB, Feature::kEdgeBC, Feature::kEdgeCA};
  constexpr std::array<Feature, 3> kCorners{Feature::kA, Feature::kB, Feature::kC};
  Vec3 best = Vec3::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < 3; ++i) {
    double t = 0.0;
    const Vec3 q = closest_on_segment(p, corners[i], corners[(i + 1) % 3], t);
    if ((q - p).squaredNorm() >= least) continue;
    least = (q - p).squaredNorm();
    best = q;
    feature = t == 0.0 ? kCorners[i] : t == 1.0 ? kCorners[(i + 1) % 3] : kEdges[i];
  }
  return best;
}

/// One device for the process; Embree works on the same TBB threads as everything else.
RTCDevice device() {
  static const RTCDevice shared = [] {
    const RTCDevice made = rtcNewDevice(nullptr);
    SWARF_CHECK(made != nullptr, "Embree cannot open its device");
    return made;
  }();
  return shared;
}

}  // namespace

Vec3 closest_point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, Feature* feature) {
  Feature unused{};
  Feature& found = feature != nullptr ? *feature : unused;
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  found = Feature::kA;
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  found = Feature::kB;
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  found = Feature::kC;
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  const double area = va + vb + vc;
  if (!(area > 0.0) || va <= 0.0 || vb <= 0.0 || vc <= 0.0) return closest_on_edges(p, {a, b, c}, found);
  found = Feature::kFace;
  return a + (vb / area) * ab + (vc / area) * ac;
}

struct MeshDistance::Tree {
  explicit Tree(const TriMesh& design) : mesh(design) {}

  const TriMesh& mesh;
  RTCScene scene = nullptr;
  double slack_mm = 0.0;  ///< by which Embree's boxes may be off

  Vec3 vertex(uint32_t triangle, size_t corner) const {
    const auto& p = mesh.positions[mesh.triangles[triangle][corner]];
    return {p[0], p[1], p[2]};
  }
  void build();
  RTCPointQuery query(const Vec3& p, double radius_mm) const;
  float radius(double mm, const Vec3& p) const {
    const double wide = mm * (1.0 + kRoundings * kFloatEpsilon) + slack_mm +
                        kRoundings * kFloatEpsilon * p.cwiseAbs().maxCoeff();
    constexpr double kLargest = std::numeric_limits<float>::max();
    return wide >= kLargest ? std::numeric_limits<float>::infinity() : static_cast<float>(wide);
  }
};

void MeshDistance::Tree::build() {
  scene = rtcNewScene(device());
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
  float largest = 0.0F;
  for (const auto& p : mesh.positions) {
    for (const float value : p) largest = std::max(largest, std::abs(value));
    positions = std::copy_n(p.data(), 3, positions);
  }
  slack_mm = kRoundings * kFloatEpsilon * largest;
  auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), mesh.triangles.size()));
  for (const auto& t : mesh.triangles) indices = std::copy_n(t.data(), 3, indices);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
}

RTCPointQuery MeshDistance::Tree::query(const Vec3& p, double radius_mm) const {
  RTCPointQuery query{};
  query.x = static_cast<float>(p.x());
  query.y = static_cast<float>(p.y());
  query.z = static_cast<float>(p.z());
  query.radius = radius(radius_mm, p);
  return query;
}

MeshDistance::MeshDistance(const TriMesh& mesh) : tree_(std::make_unique<Tree>(mesh)) {
  if (!mesh.triangles.empty()) tree_->build();
}

MeshDistance::~MeshDistance() {
  if (tree_->scene != nullptr) rtcReleaseScene(tree_->scene);
}

NearestPoint MeshDistance::nearest(const Vec3& p, double within_mm) const {
  struct Search {
    const Tree& tree;
    const Vec3& p;
    double best;  ///< squared
    NearestPoint found;

    static bool visit(RTCPointQueryFunctionArguments* arguments) {
      auto& self = *static_cast<Search*>(arguments->userPtr);
      const uint32_t t = arguments->primID;
      Feature feature{};
      const Vec3 q = closest_point_on_triangle(self.p, self.tree.vertex(t, 0), self.tree.vertex(t, 1),
                                               self.tree.vertex(t, 2), &feature);
      const double squared = (q - self.p).squaredNorm();
      const bool first = std::isinf(self.found.distance_mm);
      if (squared > self.best || (squared == self.best && !first && t > self.found.triangle)) return false;
      self.best = squared;
      self.found = {q, std::sqrt(squared), t, feature};
      const float radius = self.tree.radius(self.found.distance_mm, self.p);
      if (radius >= arguments->query->radius) return false;
      arguments->query->radius = radius;
      return true;
    }
  };
  Search search{*tree_, p, within_mm * within_mm, {}};
  search.found.distance_mm = std::numeric_limits<double>::infinity();
  if (tree_->scene == nullptr) return search.found;
  RTCPointQuery query = tree_->query(p, within_mm);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(tree_->scene, &query, &context, Search::visit, &search);
  return search.found;
}

void MeshDistance::each_near(const Vec3& p, double radius_mm,
                             const std::function<void(uint32_t)>& visit) const {
  if (tree_->scene == nullptr) return;
  RTCPointQuery query = tree_->query(p, radius_mm);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  const auto call = [](RTCPointQueryFunctionArguments* arguments) {
    (*static_cast<const std::function<void(uint32_t)>*>(arguments->userPtr))(arguments->primID);
    return false;
  };
  // Embree passes the pointer through; what it points to is not changed.
  rtcPointQuery(tree_->scene, &query, &context, call, const_cast<std::function<void(uint32_t)>*>(&visit));
}

std::vector<double> distances(std::span<const std::array<float, 3>> points, const TriMesh& mesh) {
  constexpr size_t kChunk = 2048;
  const MeshDistance distance(mesh);
  std::vector<double> all(points.size());
  parallel_chunks(points.size(), kChunk, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      all[i] = distance.nearest({points[i][0], points[i][1], points[i][2]}).distance_mm;
  });
  return all;
}

}  // namespace swarf::mesh
