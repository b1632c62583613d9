#include "render/ray/ray_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/check.h"
#include "render/figures/colour.h"

namespace swarf::render {
namespace {

/// Start of a secondary ray above its surface, as a share of the drawing's diagonal: some ten float spacings.
constexpr float kOffsetShare = 2e-6F;

struct Solid {
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

}  // namespace

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

namespace {

/// The part of a half line that lies on the kept side of a section.
struct Kept {
  float from = 0.0F, to = std::numeric_limits<float>::infinity();  ///< from > to: nothing
  bool through_plane = false;                                      ///< it begins on the plane
};

Kept kept_part(const SectionPlane& plane, const Vec3f& origin, const Vec3f& direction) {
  const double above = plane.normal.dot(origin.cast<double>() - plane.point);
  const double rise = plane.normal.dot(direction.cast<double>());
  const auto at_plane = static_cast<float>(-above / rise);
  if (above > 0.0) return rise < 0.0 ? Kept{at_plane, Kept{}.to, true} : Kept{1.0F, 0.0F};
  return rise > 0.0 ? Kept{0.0F, at_plane} : Kept{};
}

/// Attached to the scene, which alone holds it from here on.
void attach(RTCScene scene, RTCGeometry geometry) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

Vec3f placed(const DrawItem& item, const std::array<float, 3>& p) {
  return (item.X_world * Vec3(p[0], p[1], p[2])).cast<float>();
}

/// What is looked up at a hit, in the order of geomID.
using Items = std::vector<const DrawItem*>;

}  // namespace

struct RayTree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<std::array<size_t, 2>> sizes;  ///< vertices and triangles, by geomID
  Bounds bounds;

  RayTree(RTCDevice on, const Items& items);
  ~RayTree();
  RayTree(const RayTree&) = delete;
  RayTree& operator=(const RayTree&) = delete;
  void add(const DrawItem& item);
  bool holds(const Items& items) const;
};

RayTree::RayTree(RTCDevice on, const Items& items) : device(on), scene(rtcNewScene(on)) {
  rtcRetainDevice(device);
  // No light through the edges between triangles.
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  for (const DrawItem* item : items) add(*item);
  rtcCommitScene(scene);
}

RayTree::~RayTree() {
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
}

void RayTree::add(const DrawItem& item) {
  const TriMesh& mesh = *item.mesh;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
  for (const auto& p : mesh.positions) {
    const Vec3f world = placed(item, p);
    bounds.add(world, 0.0F);
    positions = std::copy_n(world.data(), 3, positions);
  }
  auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), mesh.triangles.size()));
  for (const auto& t : mesh.triangles) indices = std::copy_n(t.data(), 3, indices);
  attach(scene, geometry);
  sizes.push_back({mesh.positions.size(), mesh.triangles.size()});
}

/// Compared number by number, which takes a hundredth of the time that a tree does.
bool RayTree::holds(const Items& items) const {
  if (items.size() != sizes.size()) return false;
  for (size_t i = 0; i < items.size(); ++i) {
    const TriMesh& mesh = *items[i]->mesh;
    if (sizes[i] != std::array{mesh.positions.size(), mesh.triangles.size()}) return false;
    RTCGeometry geometry = rtcGetGeometry(scene, static_cast<unsigned>(i));
    const auto* indices =
        static_cast<const uint32_t*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_INDEX, 0));
    for (const auto& t : mesh.triangles)
      if (!std::equal(t.begin(), t.end(), std::exchange(indices, indices + 3))) return false;
    const auto* positions =
        static_cast<const float*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0));
    for (const auto& p : mesh.positions) {
      const Vec3f world = placed(*items[i], p);
      if (!std::equal(world.data(), world.data() + 3, std::exchange(positions, positions + 3))) return false;
    }
  }
  return true;
}

namespace {

/// Meshes in a tree.
struct Solids {
  RayTreePtr tree;
  std::vector<Solid> data;  ///< by geomID
};

/// `kept` as in RayScene's constructor.
Solids solids_of(RTCDevice device, const Items& items, RayTreePtr* kept) {
  Solids solids;
  for (const DrawItem* item : items)
    solids.data.push_back({item->material, item->X_world.linear().cast<float>(), item->mesh->normals,
                           item->mesh->colours, item->mesh->triangles});
  if (items.empty()) kept = nullptr;
  if (kept != nullptr && *kept && (*kept)->holds(items)) {
    solids.tree = *kept;
    return solids;
  }
  if (kept != nullptr) kept->reset();  // before the next one, so that there is room for one only
  solids.tree = std::make_shared<RayTree>(device, items);
  if (kept != nullptr) *kept = solids.tree;
  return solids;
}

}  // namespace

struct RayScene::Embree {
  RTCDevice device = nullptr;
  RTCScene tubes = nullptr;
  Solids whole, opened;  ///< opened: cut open by the section
  std::optional<SectionPlane> section;
  std::vector<Vec3f> tube_colours;
  Bounds tube_bounds;

  Embree(const DrawList& list, RayTreePtr* kept);
  ~Embree();
  void add_tube(const DrawLine& line, const Vec3& eye, double radius_per_mm);
  void look_inside(RTCRayHit& ray, std::optional<Hit>& hit) const;
};

RayScene::Embree::Embree(const DrawList& list, RayTreePtr* kept) : section(list.section) {
  Items closed, cut;
  for (const DrawItem& item : list.items) {
    SWARF_CHECK(item.mesh != nullptr, "a draw item without a mesh");
    if (!item.mesh->triangles.empty()) (section && item.sectioned ? cut : closed).push_back(&item);
  }
  // Embree builds its trees on the same TBB threads, so the process-wide limit holds for it too.
  device = rtcNewDevice(nullptr);
  SWARF_CHECK(device != nullptr, "Embree cannot open its device");
  tubes = rtcNewScene(device);
  whole = solids_of(device, closed, kept);
  opened = solids_of(device, cut, closed.empty() ? kept : nullptr);
}

RayScene::Embree::~Embree() {
  rtcReleaseScene(tubes);
  rtcReleaseDevice(device);
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

namespace {

Vec3f normal_of(const RTCHit& hit) {
  return Vec3f(hit.Ng_x, hit.Ng_y, hit.Ng_z).normalized();
}

/// Material, colour and the vertices' normal at a hit.
Hit shading_of(const RTCHit& hit, const std::vector<Solid>& solids) {
  const Solid& solid = solids[hit.geomID];
  const auto& t = solid.triangles[hit.primID];
  const std::array<float, 3> weight{1.0F - hit.u - hit.v, hit.u, hit.v};
  Hit out;
  out.metalness = solid.material.metalness;
  out.roughness = solid.material.roughness;
  out.face_normal = out.normal = normal_of(hit);
  if (!solid.normals.empty()) {
    Vec3f n = Vec3f::Zero();
    for (size_t k = 0; k < 3; ++k) n += weight[k] * to_eigen(solid.normals[t[k]]);
    if (n.squaredNorm() > 0.0F) out.normal = (solid.rotation * n).normalized();
  }
  out.colour = to_eigen(solid.material.colour, 1.0F);
  if (!solid.colours.empty()) {
    out.colour.setZero();
    for (size_t k = 0; k < 3; ++k) out.colour += to_eigen(linear_from_srgb8(solid.colours[t[k]]), weight[k]);
  }
  return out;
}

bool found(const RTCRayHit& ray) {
  return ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

void trace(RTCScene scene, RTCRayHit& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
}

}  // namespace

/// What is nearer than ray.tfar behind the section: the first surface there, or the face of the cut where the
/// first surface is met from within, so that the ray has entered the body through the plane.
void RayScene::Embree::look_inside(RTCRayHit& ray, std::optional<Hit>& hit) const {
  const Vec3f origin(ray.ray.org_x, ray.ray.org_y, ray.ray.org_z);
  const Vec3f direction(ray.ray.dir_x, ray.ray.dir_y, ray.ray.dir_z);
  if (opened.tree->bounds.missed_by(origin, direction)) return;
  const Kept kept = kept_part(*section, origin, direction);
  if (kept.from >= std::min(kept.to, ray.ray.tfar)) return;
  RTCRayHit inside = make_ray(origin, direction);
  inside.ray.tnear = kept.from;
  // A body that ends behind what hides it is cut by the plane before.
  inside.ray.tfar = kept.through_plane ? kept.to : std::min(kept.to, ray.ray.tfar);
  trace(opened.tree->scene, inside);
  if (!found(inside)) return;
  if (kept.through_plane && normal_of(inside.hit).dot(direction) > 0.0F) {
    const Vec3f normal = section->normal.cast<float>();
    ray.ray.tfar = kept.from;
    hit = Hit{{}, normal, normal, to_eigen(kCutFace, 1.0F)};
    hit->drawn = true;
  } else if (inside.ray.tfar < ray.ray.tfar) {
    ray.ray.tfar = inside.ray.tfar;
    hit = shading_of(inside.hit, opened.data);
  }
}

RayScene::RayScene(const DrawList& list, double tube_radius_per_mm, RayTreePtr* kept)
    : embree_(std::make_unique<Embree>(list, kept)) {
  for (const DrawLine& line : list.lines) embree_->add_tube(line, list.camera.eye, tube_radius_per_mm);
  rtcCommitScene(embree_->tubes);
}

RayScene::~RayScene() = default;

std::optional<Hit> RayScene::nearest(const Vec3f& origin, const Vec3f& direction, bool with_lines) const {
  RTCRayHit ray = make_ray(origin, direction);
  std::optional<Hit> out;
  if (!embree_->whole.tree->bounds.missed_by(origin, direction)) {
    trace(embree_->whole.tree->scene, ray);
    if (found(ray)) out = shading_of(ray.hit, embree_->whole.data);
  }
  if (embree_->section) embree_->look_inside(ray, out);
  if (with_lines && !embree_->tube_bounds.missed_by(origin, direction)) {
    const float solid_distance = ray.ray.tfar;
    trace(embree_->tubes, ray);
    if (ray.ray.tfar < solid_distance) {
      out = Hit{{}, normal_of(ray.hit), normal_of(ray.hit), embree_->tube_colours[ray.hit.geomID]};
      out->drawn = true;
    }
  }
  if (!out) return out;
  out->position = origin + ray.ray.tfar * direction;
  if (out->face_normal.dot(direction) > 0.0F) out->face_normal = -out->face_normal;
  if (out->normal.dot(out->face_normal) < 0.0F) out->normal = -out->normal;
  return out;
}

bool RayScene::occluded(const Vec3f& origin, const Vec3f& direction) const {
  const auto meets = [&](const Solids& solids, const Kept& part) {
    if (part.from >= part.to || solids.tree->bounds.missed_by(origin, direction)) return false;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = make_ray(origin, direction).ray;
    ray.tnear = part.from;
    ray.tfar = part.to;
    rtcOccluded1(solids.tree->scene, &context, &ray);
    return ray.tfar < 0.0F;  // Embree's mark for "something is in the way"
  };
  if (meets(embree_->whole, {})) return true;
  return embree_->section && meets(embree_->opened, kept_part(*embree_->section, origin, direction));
}

float RayScene::offset() const {
  Bounds all = embree_->whole.tree->bounds;
  if (embree_->opened.tree->bounds.lower.x() <= embree_->opened.tree->bounds.upper.x()) {
    all.add(embree_->opened.tree->bounds.lower, 0.0F);
    all.add(embree_->opened.tree->bounds.upper, 0.0F);
  }
  return all.lower.x() <= all.upper.x() ? kOffsetShare * (all.upper - all.lower).norm() : 0.0F;
}

float RayScene::lowest_z() const {
  const float lowest =
      std::min(embree_->whole.tree->bounds.lower.z(), embree_->opened.tree->bounds.lower.z());
  return std::isfinite(lowest) ? lowest : 0.0F;
}

}  // namespace swarf::render
