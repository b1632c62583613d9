// The raw stock: the body that the sweeps cut, exactly. A box, a bar, a tube, an outline with a height, or a
// closed mesh. Level set, measuring rays and proofs all ask this one body where material was to begin with.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/frames.h"
#include "mesh/tri_mesh.h"

namespace swarf::stock {

/// A place of the raw stock's surface as a point sees it.
struct RawPoint {
  double distance_mm = std::numeric_limits<double>::infinity();  ///< Euclidean, < 0 in the material; exact
  Vec3 foot = Vec3::Zero();                                      ///< the nearest place
  Vec3 normal = Vec3::UnitZ();                                   ///< unit, there, out of the material
};

/// Material on a line, from one s to another; mm.
struct RawInterval {
  double low, high;
};

/// Between which values a linear function lies over a part of the surface; least > greatest: over none.
struct RawExtent {
  double least = std::numeric_limits<double>::infinity(), greatest = -std::numeric_limits<double>::infinity();
  bool empty() const { return least > greatest; }
};

/// A part of the surface in a ball lies between two parallel planes; of a flat part they are one.
struct RawFace {
  Vec3 normal;             ///< unit, out of the material
  double least, greatest;  ///< of normal . x over the part
  /// Places whose hull holds what of the part lies in the ball; none: that is not known.
  std::vector<Vec3> hull = {};
};

/// A solid or hollow cylinder.
struct RawTube {
  Vec3 base_W = Vec3::Zero();   ///< middle of its first end, mm
  Vec3 axis_W = Vec3::UnitZ();  ///< unit, to its other end
  double radius_mm = 0.0, inner_radius_mm = 0.0, length_mm = 0.0;
};

/// The inside of a closed polygon that does not cross itself, from one height to another.
struct RawOutline {
  std::vector<Vec2> points_mm;  ///< at least three, either way round; the last joins the first
  double low_mm = 0.0, high_mm = 0.0;
};

/// The thinnest wall that was met, and where.
struct ThinnestWall {
  double mm = std::numeric_limits<double>::infinity();
  Vec3 place_W = Vec3::Zero();
  double step_mm = 0.0;  ///< between the places; coarser than asked for where there would be too many
};

class RawBody;

/// A value: copies share one body that nobody changes.
class RawShape {
 public:
  static RawShape of_box(const Box& box_W);
  static RawShape of_tube(const RawTube& tube);
  static RawShape of_outline(const RawOutline& outline);
  /// Closed, turned outward, crossing itself nowhere (mesh/mesh_check.h): the caller has asked. `name`: what
  /// text() calls it, with the hash of its facets.
  static RawShape of_mesh(const TriMesh& mesh_W, const std::string& name);

  /// The same body where a frame F that it was described in stands in W: nothing is sampled. A box by quarter
  /// turns stays a box and a tube a tube, to the bit where the numbers allow it.
  RawShape moved(const Pose& X_WF) const;

  bool is_box() const { return is_box_; }
  /// The least box along the axes of W that holds it; of a box the box itself.
  const Box& box() const { return box_; }
  /// A closed mesh that holds it: of flat sides exactly, round ones are cut into flats that stand out by at
  /// most mesh::kRoundMm; the box around an outline of more corners than polygons are split into.
  TriMesh mesh_around() const;
  double volume_mm3() const;    ///< in closed form; of a mesh the sum over its facets
  double area_mm2() const;      ///< of its surface
  size_t memory_bytes() const;  ///< that a mesh takes with its trees, about
  /// Of several nearest places one. Nothing farther than `within_mm` is looked for: its distance is then
  /// +infinity.
  RawPoint at(const Vec3& point_W, double within_mm = std::numeric_limits<double>::infinity()) const;
  double distance_mm(const Vec3& point_W) const { return at(point_W).distance_mm; }
  /// All its material on the line point + s way, s from -infinity on, from low to high; `way_W` of length 1.
  /// A line that runs within kTouch of the surface counts as in the material, as one along the face of a box.
  std::vector<RawInterval> along(const Vec3& point_W, const Vec3& way_W) const;
  /// Bounds of direction . x over its surface in the ball: none of the surface there lies outside them. Sharp
  /// for flat parts and, with the ball's radius squared, for curved ones.
  RawExtent extent(const Vec3& centre_W, double radius_mm, const Vec3& direction) const;
  /// The parts of its surface in the ball, all of them, or nothing where they are more than kMostFaces.
  std::vector<RawFace> faces(const Vec3& centre_W, double radius_mm) const;
  static constexpr size_t kMostFaces = 48;
  /// On lines into the material from places of the surface about `step_mm` apart: what lies between them may
  /// be thinner. Parallel; the same for any number of threads.
  ThinnestWall thinnest_wall(double step_mm) const;
  /// "box", "cylinder ...": what it is with every number that determines it; of a mesh the hash of its
  /// facets.
  std::string text() const;

  static constexpr double kTouch = 1e-6;  ///< mm

 private:
  explicit RawShape(std::shared_ptr<const RawBody> body);

  std::shared_ptr<const RawBody> body_;
  Box box_;
  bool is_box_ = false;
};

/// What of the raw stock stands over a place of a design, along its normal (SurfaceDexels has the words).
struct RawColumn {
  /// Top of what stands on the design; less than 0 where the place lies outside: it lacks material down to
  /// the next, along the column or to the nearest place of the stock, whichever is nearer.
  double height_mm = 0.0;
  std::vector<RawInterval> above;  ///< further up
};
RawColumn raw_column(const RawShape& shape, const Vec3& point_W, const Vec3& normal_W);

}  // namespace swarf::stock
