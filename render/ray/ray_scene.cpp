#include "render/ray/ray_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <limits>

#include "base/check.h"
#include "render/figures/colour.h"

namespace swarf::render {
namespace {

/// Start of a secondary ray above its surface, as a share of the drawing's diagonal: some ten float spacings.
constexpr float kOffsetShare = 2e-6F;

struct Solid {
  const TriMesh* mesh;
  Material material;
  Eigen::Matrix3f rotation;
  std::vector<std::array<float, 3>> normals;
  std::vector<std::array<uint8_t, 4>> colours;
  std::vector<std::array<uint32_t, 3>> triangles;
};

Vec3f to_eigen(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}
Vec3f to_eigen(const Rgb& c, float scale) {
  return scale * Vec3f(c[0], c[1], c[2]);
}

RTCRayHit make_ray(const Vec3f& origin, const Vec3f& direction) {
  RTCRayHit ray{};
  ray.ray.org_x = origin.x();
  ray.ray.org_y = origin.y();
  ray.ray.org_z = origin.z();
  ray.ray.dir_x = direction.x();
  ray.ray.dir_y = direction.y();
  ray.ray.dir_z = direction.z();
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = ~0U;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return ray;
}

/// Bounds of what a scene holds; most rays past a lone part end here, at a tenth of the cost of asking
/// Embree.
struct Bounds {
  Vec3f lower = Vec3f::Constant(std::numeric_limits<float>::infinity());
  Vec3f upper = -lower;

  void add(const Vec3f& point, float radius) {
    lower = lower.cwiseMin((point.array() - radius).matrix());
    upper = upper.cwiseMax((point.array() + radius).matrix());
  }
  /// Slab test of a half line; a direction component of zero gives infinities that compare as they should,
  /// and the NaN of a ray within a slab's plane counts as a hit.
  bool missed_by(const Vec3f& origin, const Vec3f& direction) const {
    if (lower.x() > upper.x()) return true;  // nothing inside
    float enter = 0.0F, leave = std::numeric_limits<float>::infinity();
    for (int k = 0; k < 3; ++k) {
      const float inverse = 1.0F / direction[k];
      const float a = (lower[k] - origin[k]) * inverse, b = (upper[k] - origin[k]) * inverse;
      const float near = a < b ? a : b, far = a < b ? b : a;
      if (near > enter) enter = near;
      if (far < leave) leave = far;
    }
    return enter > leave * kBoundsSlack;
  }
  // The slab distances carry some float roundings each.
  static constexpr float kBoundsSlack = 1.00001F;
};

}  // namespace

struct RayScene::Embree {
  RTCDevice device = nullptr;
  RTCScene solids = nullptr, tubes = nullptr;
  std::vector<Solid> solid_data;
  std::vector<Vec3f> tube_colours;
  Bounds solid_bounds, tube_bounds;

  Embree();
  ~Embree();
  void add_solid(const DrawItem& item);
  void add_tube(const DrawLine& line, const Vec3& eye, double radius_per_mm);
  void attach(RTCScene scene, RTCGeometry geometry);
  Hit solid_hit(const RTCHit& hit) const;
};

RayScene::Embree::Embree() {
  // Embree builds its trees on the same TBB threads, so the process-wide limit holds for it too.
  device = rtcNewDevice(nullptr);
  SWARF_CHECK(device != nullptr, "Embree cannot open its device");
  solids = rtcNewScene(device);
  tubes = rtcNewScene(device);
  rtcSetSceneFlags(solids, RTC_SCENE_FLAG_ROBUST);  // no light through the edges between triangles
}

RayScene::Embree::~Embree() {
  rtcReleaseScene(solids);
  rtcReleaseScene(tubes);
  rtcReleaseDevice(device);
}

void RayScene::Embree::attach(RTCScene scene, RTCGeometry geometry) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

void RayScene::Embree::add_solid(const DrawItem& item) {
  SWARF_CHECK(item.mesh != nullptr, "a draw item without a mesh");
  const TriMesh& mesh = *item.mesh;
  if (mesh.triangles.empty()) return;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
  for (const auto& p : mesh.positions) {
    const Vec3f world = (item.X_world * Vec3(p[0], p[1], p[2])).cast<float>();
    solid_bounds.add(world, 0.0F);
    positions = std::copy_n(world.data(), 3, positions);
  }
  auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), mesh.triangles.size()));
  for (const auto& t : mesh.triangles) indices = std::copy_n(t.data(), 3, indices);
  attach(solids, geometry);
  solid_data.push_back({&mesh, item.material, item.X_world.linear().cast<float>(), mesh.normals, mesh.colours,
                        mesh.triangles});
}

void RayScene::Embree::add_tube(const DrawLine& line, const Vec3& eye, double radius_per_mm) {
  if (line.points.size() < 2) return;
  const size_t n = line.points.size();
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
  auto* vertices = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), n));
  for (const Vec3& p : line.points) {
    const Vec3f point = p.cast<float>();
    vertices = std::copy_n(point.data(), 3, vertices);
    *vertices = static_cast<float>(line.width_px * radius_per_mm * (p - eye).norm());
    tube_bounds.add(point, *vertices++);
  }
  auto* indices = static_cast<uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, sizeof(uint32_t), n - 1));
  for (uint32_t i = 0; i + 1 < n; ++i) *indices++ = i;
  attach(tubes, geometry);
  tube_colours.push_back(to_eigen(line.colour, 1.0F));
}

Hit RayScene::Embree::solid_hit(const RTCHit& hit) const {
  const Solid& solid = solid_data[hit.geomID];
  const auto& t = solid.triangles[hit.primID];
  const std::array<float, 3> weight{1.0F - hit.u - hit.v, hit.u, hit.v};
  Hit out;
  out.metalness = solid.material.metalness;
  out.roughness = solid.material.roughness;
  out.normal = out.face_normal;
  if (!solid.normals.empty()) {
    Vec3f n = Vec3f::Zero();
    for (size_t k = 0; k < 3; ++k) n += weight[k] * to_eigen(solid.normals[t[k]]);
    out.normal = solid.rotation * n;
  }
  out.colour = to_eigen(solid.material.colour, 1.0F);
  if (!solid.colours.empty()) {
    out.colour.setZero();
    for (size_t k = 0; k < 3; ++k) out.colour += to_eigen(linear_from_srgb8(solid.colours[t[k]]), weight[k]);
  }
  return out;
}

RayScene::RayScene(const DrawList& list, double tube_radius_per_mm) : embree_(std::make_unique<Embree>()) {
  for (const DrawItem& item : list.items) embree_->add_solid(item);
  for (const DrawLine& line : list.lines) embree_->add_tube(line, list.camera.eye, tube_radius_per_mm);
  rtcCommitScene(embree_->solids);
  rtcCommitScene(embree_->tubes);
}

RayScene::~RayScene() = default;

std::optional<Hit> RayScene::nearest(const Vec3f& origin, const Vec3f& direction, bool with_lines) const {
  RTCIntersectContext context;
  RTCRayHit ray = make_ray(origin, direction);
  if (!embree_->solid_bounds.missed_by(origin, direction)) {
    rtcInitIntersectContext(&context);
    rtcIntersect1(embree_->solids, &context, &ray);
  }
  const float solid_distance = ray.ray.tfar;
  const RTCHit solid = ray.hit;
  bool line = false;
  if (with_lines && !embree_->tube_bounds.missed_by(origin, direction)) {
    rtcInitIntersectContext(&context);
    rtcIntersect1(embree_->tubes, &context, &ray);
    line = ray.ray.tfar < solid_distance;
  }
  const RTCHit& hit = line ? ray.hit : solid;
  if (hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  Hit out;
  if (line) {
    out.line = true;
    out.colour = embree_->tube_colours[hit.geomID];
  } else {
    out = embree_->solid_hit(hit);
  }
  out.position = origin + ray.ray.tfar * direction;
  out.face_normal = Vec3f(hit.Ng_x, hit.Ng_y, hit.Ng_z).normalized();
  if (out.face_normal.dot(direction) > 0.0F) out.face_normal = -out.face_normal;
  const bool interpolated = !line && !embree_->solid_data[hit.geomID].normals.empty();
  out.normal = interpolated && out.normal.squaredNorm() > 0.0F ? out.normal.normalized() : out.face_normal;
  if (out.normal.dot(out.face_normal) < 0.0F) out.normal = -out.normal;
  return out;
}

bool RayScene::occluded(const Vec3f& origin, const Vec3f& direction) const {
  if (embree_->solid_bounds.missed_by(origin, direction)) return false;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray = make_ray(origin, direction).ray;
  rtcOccluded1(embree_->solids, &context, &ray);
  return ray.tfar < 0.0F;  // Embree's mark for "something is in the way"
}

float RayScene::offset() const {
  return embree_->solid_data.empty()
             ? 0.0F
             : kOffsetShare * (embree_->solid_bounds.upper - embree_->solid_bounds.lower).norm();
}

float RayScene::lowest_z() const {
  return embree_->solid_data.empty() ? 0.0F : embree_->solid_bounds.lower.z();
}

}  // namespace swarf::render
