// A tree of bounding spheres over triangles (Kato et al., 2.1): a sphere looks the same from every side, so
// one tree serves every direction of the tool's axis.
//
// What stops a tool is bounded from above, over a whole sphere, by a tangent of the cutter's underside. For
// any line below w, w(rho) >= k rho - l, every point p holds the tip at m.p + l or below, where m = axis - k
// e and e is the direction from the axis to the sphere's centre. That is linear in p. So that it says much,
// each sphere is cut to a disc by two planes square to the mean normal of its triangles: m.p over the disc is
// m.centre + R |part of m square to n| + the thickness along n. With k near the slope of the surface this is
// within R^2 / (2 r) of the true height, where the sphere alone leaves R.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/frames.h"
#include "mesh/tri_mesh.h"
#include "position/rest.h"
#include "position/tool_profile.h"

namespace swarf::position {

/// Four spheres, each cut by two planes, around all triangles below them, side by side as they are looked at;
/// mm, rounded outwards. Fewer than four: those without triangles lie far away.
struct FourNodes {
  using Lanes = std::array<float, 4>;
  std::array<Lanes, 3> centre;
  Lanes radius;
  std::array<Lanes, 3> normal;    ///< of unit length to a float's rounding
  Lanes low, high;                ///< normal . (p - centre) lies between them
  Lanes top;                      ///< greatest z_W: exact, so that what is level with the tool is left out
  std::array<uint32_t, 4> first;  ///< of its triangles; of an inner one: its four below
  std::array<uint32_t, 4> count;  ///< of its triangles; 0: an inner one
};

/// A triangle of the mesh, where the tree has it.
struct TreeTriangle {
  std::array<std::array<float, 3>, 3> corners;  ///< mm
  uint32_t number;                              ///< in the mesh
};

/// Flat: nodes in the order of their making, triangles in the order of the leaves; some 70 bytes a triangle
/// with both. Each node is split in four at medians of the centres, across the longest side of their box, so
/// that the levels are at most 16. The same for any number of threads.
class SphereTree {
 public:
  /// Throws InputError "mesh-not-finite" and "mesh-too-large" (2^29 triangles).
  explicit SphereTree(const TriMesh& mesh);

  std::span<const FourNodes> nodes() const { return nodes_; }  ///< the first is the root; none: empty mesh
  /// With copies of the last one behind it, for corner_bounds.
  std::span<const TreeTriangle> triangles() const { return triangles_; }
  static constexpr size_t kLeafTriangles = 4;

 private:
  std::vector<FourNodes> nodes_;
  std::vector<TreeTriangle> triangles_;
};

/// Above every height at which a point of the four holds a tool on the line, each by a margin above rounding;
/// kBeside when it lies beside the tool.
using FourHeights = std::array<double, 4>;
void height_bounds(const ToolProfile& profile, const GuideLine& line, const FourNodes& nodes,
                   FourHeights& bounds);
inline constexpr double kBeside = -1e300;

/// The same for each of four triangles that follow each other (those behind the last are there, as copies of
/// it): by the tangent of the underside below its centre, which is linear, so that the corners decide.
void corner_bounds(const ToolProfile& profile, const GuideLine& line, const TreeTriangle* four,
                   FourHeights& bounds);

}  // namespace swarf::position
