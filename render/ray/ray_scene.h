// The drawing inside Embree: nearest hits with shading data, and shadow tests.
#pragma once

#include <memory>
#include <optional>

#include "render/draw_list.h"

namespace swarf::render {

using Vec3f = Eigen::Vector3f;

struct Hit {
  Vec3f position;
  Vec3f face_normal;  ///< unit, on the side the ray came from
  Vec3f normal;       ///< unit, interpolated from the vertices, on the same side
  Vec3f colour;       ///< linear
  float metalness = 0.0F, roughness = 1.0F;
  bool drawn = false;  ///< a tube of a DrawLine or the face of a section: its own colour, without shadows
};

/// Triangles of a drawing, without their looks, in a tree that further drawings of the same can share.
struct RayTree;
using RayTreePtr = std::shared_ptr<const RayTree>;

/// Geometry is copied; the list need not outlive the scene.
class RayScene {
 public:
  /// `tube_radius_per_mm`: radius of a line of width 1 px at 1 mm from the camera, mm. `kept`: a tree from an
  /// earlier drawing, or none yet: used where it holds just these triangles at these places, else given back
  /// and replaced.
  RayScene(const DrawList& list, double tube_radius_per_mm, RayTreePtr* kept = nullptr);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// Nearest hit of the solids, and of the lines too when `with_lines`.
  std::optional<Hit> nearest(const Vec3f& origin, const Vec3f& direction, bool with_lines) const;
  /// True if a solid lies on the half line.
  bool occluded(const Vec3f& origin, const Vec3f& direction) const;
  /// How far a ray must start off a surface so as not to meet it again, mm.
  float offset() const;
  /// Lowest z of the solids, mm; 0 without solids.
  float lowest_z() const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace swarf::render
