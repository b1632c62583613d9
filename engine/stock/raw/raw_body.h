// What a form of raw stock must answer. Internal to this folder.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "stock/raw/raw_shape.h"

namespace swarf::stock {

/// A place of the surface and the unit normal out of the material there.
struct RawPlace {
  Vec3 point_W, normal_W;
};

class RawBody {
 public:
  RawBody() = default;
  virtual ~RawBody() = default;
  RawBody(const RawBody&) = delete;
  RawBody& operator=(const RawBody&) = delete;

  virtual Box box() const = 0;
  /// Places of it whose hull holds it; of a body that is moved elsewhere by moved() itself nobody asks.
  virtual std::vector<Vec3> corners() const { return {}; }
  /// The same body elsewhere, in its own form where it has one there; null: moved_body() serves.
  virtual std::shared_ptr<const RawBody> moved(const Pose& /*X_VW*/) const { return nullptr; }
  virtual bool is_box() const { return false; }
  virtual double volume_mm3() const = 0;
  virtual double area_mm2() const = 0;
  virtual size_t memory_bytes() const { return 0; }
  virtual RawPoint at(const Vec3& point_W, double within_mm) const = 0;
  /// Appends every s at which the line passes the surface, in no order; values at which it does not may be
  /// among them.
  virtual void add_crossings(const Vec3& point_W, const Vec3& way_W,
                             std::vector<double>& crossings) const = 0;
  virtual RawExtent extent(const Vec3& centre_W, double radius_mm, const Vec3& direction) const = 0;
  /// As RawShape::faces; what is more than kMostFaces need not be there.
  virtual std::vector<RawFace> faces(const Vec3& centre_W, double radius_mm) const = 0;
  /// Places of the surface, about `step_mm` apart, from each of which a wall is measured inwards; a few where
  /// the form knows its thinnest.
  virtual std::vector<RawPlace> places(double step_mm) const = 0;
  /// As RawShape::mesh_around.
  virtual TriMesh mesh_around() const = 0;
  /// What it is, with every number that determines it.
  virtual std::string text() const = 0;
};

std::shared_ptr<const RawBody> make_raw_box(const Box& box_W);
std::shared_ptr<const RawBody> make_raw_tube(const RawTube& tube);
std::shared_ptr<const RawBody> make_raw_outline(const RawOutline& outline);
std::shared_ptr<const RawBody> make_raw_mesh(const TriMesh& mesh_W, const std::string& name);
/// `body` in the frame F, asked in W; itself where the two are one. For bodies that know their corners.
std::shared_ptr<const RawBody> moved_body(std::shared_ptr<const RawBody> body, const Pose& X_WF);

/// Widens an extent.
inline void include(RawExtent& extent, double value) {
  extent.least = std::min(extent.least, value);
  extent.greatest = std::max(extent.greatest, value);
}

}  // namespace swarf::stock
