// Cutters as unions of convex solids of revolution, each given by what bounds it in the half plane (rho, z).
//
//   z ^   face, normal (1,0)          A face is the half plane  normal . p <= offset.
//     |     |                         A round is the part of a disc's outline between two outward normals:
//     |     |                            h(p) = max over unit n between `from` and `to` of (p - centre).n -
//     radius |    /  round
//     |___/                           The piece is F(p) = max over faces and rounds <= 0. With normals that
//     never
//     +------> rho                    point towards the axis (n.x() >= 0) F(hypot(x,y), z) is convex in
//     space.
//
// F is 1-Lipschitz, its zero level is exact; beyond a sharp edge it underestimates the Euclidean distance.
#pragma once

#include <vector>

#include "base/frames.h"

namespace swarf::cutter {

struct Face {
  Vec2 normal{1.0, 0.0};  ///< unit, (rho, z); normal.x() >= 0
  double offset = 0.0;    ///< mm
};

struct Round {
  Vec2 centre = Vec2::Zero();  ///< (rho, z), mm
  double radius = 0.0;         ///< mm, > 0
  Vec2 from{0.0, -1.0};        ///< unit outward normal at its lower end
  Vec2 to{1.0, 0.0};  ///< and at its upper end; counter-clockwise from `from`, by less than half a turn
};

struct ConvexPiece {
  std::vector<Face> faces;
  std::vector<Round> rounds;
  double radius = 0.0;           ///< greatest rho, mm
  double low = 0.0, high = 0.0;  ///< least and greatest z, mm

  /// A plain cylinder standing on z = 0: the flat end mill.
  static ConvexPiece cylinder(double radius, double height);
  bool is_cylinder() const;
};

/// What bounds the piece at a point: F in mm and its gradient, a unit vector in (rho, z).
struct Support {
  double value = 0.0;
  Vec2 normal{0.0, 0.0};
};
Support support(const ConvexPiece& piece, double rho, double z);

/// The same of one bound; p = (rho, z).
inline Support support(const Face& face, const Vec2& p) {
  return {face.normal.dot(p) - face.offset, face.normal};
}
Support support(const Round& round, const Vec2& p);

/// F at (rho, z), mm.
double signed_distance(const ConvexPiece& piece, double rho, double z);

}  // namespace swarf::cutter
