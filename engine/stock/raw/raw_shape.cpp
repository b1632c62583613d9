#include "stock/raw/raw_shape.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/parallel.h"
#include "stock/raw/raw_body.h"

namespace swarf::stock {
namespace {

/// Crossings nearer to each other than this are one; mm.
constexpr double kSamePlace = 1e-9;
/// No stock reaches so far: crossings of a line that runs along a surface; mm.
constexpr double kFar = 1e7;

}  // namespace

RawShape::RawShape(std::shared_ptr<const RawBody> body)
    : body_(std::move(body)), box_(body_->box()), is_box_(body_->is_box()) {}

RawShape RawShape::of_box(const Box& box_W) {
  return RawShape(make_raw_box(box_W));
}
RawShape RawShape::of_tube(const RawTube& tube) {
  return RawShape(make_raw_tube(tube));
}
RawShape RawShape::of_outline(const RawOutline& outline) {
  return RawShape(make_raw_outline(outline));
}
RawShape RawShape::of_mesh(const TriMesh& mesh_W, const std::string& name) {
  return RawShape(make_raw_mesh(mesh_W, name));
}
RawShape RawShape::moved(const Pose& X_WF) const {
  std::shared_ptr<const RawBody> own = body_->moved(X_WF);
  return RawShape(own ? own : moved_body(body_, X_WF));
}

TriMesh RawShape::mesh_around() const {
  return body_->mesh_around();
}

double RawShape::volume_mm3() const {
  return body_->volume_mm3();
}
double RawShape::area_mm2() const {
  return body_->area_mm2();
}
size_t RawShape::memory_bytes() const {
  return body_->memory_bytes();
}
RawPoint RawShape::at(const Vec3& point_W, double within_mm) const {
  return body_->at(point_W, within_mm);
}
RawExtent RawShape::extent(const Vec3& centre_W, double radius_mm, const Vec3& direction) const {
  return body_->extent(centre_W, radius_mm, direction);
}
std::vector<RawFace> RawShape::faces(const Vec3& centre_W, double radius_mm) const {
  std::vector<RawFace> faces = body_->faces(centre_W, radius_mm);
  if (faces.size() > kMostFaces) faces.clear();
  return faces;
}
std::string RawShape::text() const {
  return body_->text();
}

/// Between two neighbouring crossings the line is all in the material or all outside: one place tells. So a
/// crossing too many does no harm, and none may be missing.
std::vector<RawInterval> RawShape::along(const Vec3& point_W, const Vec3& way_W) const {
  std::vector<double> crossings;
  body_->add_crossings(point_W, way_W, crossings);
  std::erase_if(crossings, [](double s) { return !(std::abs(s) < kFar); });
  std::sort(crossings.begin(), crossings.end());
  std::vector<RawInterval> material;
  for (size_t i = 0; i + 1 < crossings.size(); ++i) {
    const double low = crossings[i], high = crossings[i + 1];
    if (high - low <= kSamePlace || distance_mm(point_W + 0.5 * (low + high) * way_W) > kTouch) continue;
    if (!material.empty() && low - material.back().high <= kSamePlace) {
      material.back().high = high;
    } else {
      material.push_back({low, high});
    }
  }
  return material;
}

RawColumn raw_column(const RawShape& shape, const Vec3& point_W, const Vec3& normal_W) {
  // Designs lie on the surface of the stock often, and meshes in floats.
  constexpr double kOnFace = 1e-5;  // mm
  RawColumn column;
  bool stands = false;
  for (const RawInterval& one : shape.along(point_W, normal_W)) {
    if (one.low <= kOnFace) {
      column.height_mm = one.high;
      stands = true;
    } else {
      column.above.push_back(one);
    }
  }
  if (!stands || column.height_mm < 0.0) {
    const double lacking = -std::max(0.0, shape.distance_mm(point_W));
    column.height_mm = stands ? std::max(column.height_mm, lacking) : lacking;
  }
  return column;
}

ThinnestWall RawShape::thinnest_wall(double step_mm) const {
  constexpr double kMostPlaces = 1e5;
  constexpr double kInside = 1e-4;  // mm: where a line begins, below the surface
  constexpr size_t kPlacesPerTask = 64;
  ThinnestWall thinnest;
  thinnest.step_mm = std::max(step_mm, std::sqrt(area_mm2() / kMostPlaces));
  const std::vector<RawPlace> places = body_->places(thinnest.step_mm);
  std::vector<double> walls(places.size());
  parallel_chunks(places.size(), kPlacesPerTask, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) {
      walls[n] = thinnest.mm;
      for (const RawInterval& one : along(places[n].point_W, -places[n].normal_W)) {
        if (one.low <= kInside && one.high > kInside) walls[n] = one.high;
      }
    }
  });
  for (size_t n = 0; n < walls.size(); ++n) {
    if (walls[n] >= thinnest.mm) continue;
    thinnest.mm = walls[n];
    thinnest.place_W = places[n].point_W;
  }
  return thinnest;
}

}  // namespace swarf::stock
