// A face: the part of a surface that its loops enclose, as CAD systems trim it.
#pragma once

#include <string>
#include <vector>

#include "surface/surface.h"

namespace swarf::surface {

/// A closed polyline in the parameters; the last place is not the first again.
using TrimLoop = std::vector<Vec2>;

/// How closely a loop follows its edge unless somebody says otherwise, mm: a flank of 7 degrees that stands
/// on the edge makes eight times as much height of it, which stays below .05 um.
inline constexpr double kLoopChord = 4e-6;

struct Face {
  SurfacePtr surface;
  /// (u,v) of the unit square; the outer one first and counter-clockwise, then the holes, clockwise. What
  /// they enclose outside the square does not belong to the face. None: the whole square.
  std::vector<TrimLoop> loops;
  double chord_mm = 0.0;  ///< the loops stray by no more from the edges, seen on the surface at the places
                          ///< tried (quarters of every segment)
  std::string name;       ///< of the file; may be empty
  int number = 0;         ///< from 1 on, in the order of the file; parts of one face share it
};

enum class Region { kInside, kOutside, kCrossing };

/// Answers for a face's loops: which parameters belong to it. Segments lie in strips of equal height.
class FaceDomain {
 public:
  explicit FaceDomain(const Face& face);

  /// Even number of crossings is outside, which asks nothing of the loops' directions. Exact for the polygon
  /// but for places within rounding of it.
  bool inside(const Vec2& uv) const;
  /// Of the closed rectangle; kCrossing where a segment touches it or the square's border passes through it.
  Region classify(const Vec2& low, const Vec2& high) const;
  bool is_trimmed() const { return !segments_.empty(); }

 private:
  struct Segment {
    Vec2 a, b;
  };
  size_t strip_of(double v) const;
  bool within_loops(const Vec2& uv) const;

  std::vector<Segment> segments_;
  std::vector<std::vector<uint32_t>> strips_;  ///< segments by what they meet
  double low_ = 0.0, height_ = 1.0;            ///< of the strips, v
};

/// A place where the next piece of a loop does not begin where the last one ends.
struct LoopGap {
  double gap_mm = 0.0;  ///< on the surface, the widest
  Vec3 place = Vec3::Zero();
};
/// Pieces one behind the other as a loop, each of at least two places; the end of one and the beginning of
/// the next become one place, the middle, whatever lies between them: the caller judges the gap.
LoopGap join_loop(const Surface& surface, const std::vector<std::vector<Vec2>>& pieces, TrimLoop& loop);

/// Turns the outer loop counter-clockwise and the holes clockwise; the one with the greatest area comes
/// first. False when a hole does not begin inside the outer loop.
bool orient_loops(std::vector<TrimLoop>& loops);

/// Area and what the face adds to the volume that a closed shell encloses, 1/3 of the integral of S . n.
struct FaceMeasure {
  double area_mm2 = 0.0, flux_mm3 = 0.0;
};
/// By Gauss' rule: along the loops' segments, and across from the square's side to them in pieces that end at
/// the surface's breaks (Green's theorem).
FaceMeasure measure_face(const Face& face);

}  // namespace swarf::surface
