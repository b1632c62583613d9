#include "cutter/convex_piece.h"

#include "base/plane_vectors.h"

#include <algorithm>
#include <limits>

namespace swarf::cutter {

Support support(const Round& round, const Vec2& p) {
  const Vec2 d = p - round.centre;
  const double length = d.norm();
  const bool within = length > 0.0 && cross(round.from, d) >= 0.0 && cross(d, round.to) >= 0.0;
  const Vec2 normal = within ? Vec2(d / length) : d.dot(round.from) > d.dot(round.to) ? round.from : round.to;
  return {d.dot(normal) - round.radius, normal};
}

ConvexPiece ConvexPiece::cylinder(double radius, double height) {
  return {{{{0.0, -1.0}, 0.0}, {{1.0, 0.0}, radius}, {{0.0, 1.0}, height}}, {}, radius, 0.0, height};
}

bool ConvexPiece::is_cylinder() const {
  if (!rounds.empty() || low != 0.0) return false;
  return std::all_of(faces.begin(), faces.end(),
                     [](const Face& face) { return face.normal.x() == 0.0 || face.normal.y() == 0.0; });
}

Support support(const ConvexPiece& piece, double rho, double z) {
  const Vec2 p(rho, z);
  Support greatest{-std::numeric_limits<double>::infinity(), Vec2::Zero()};
  const auto raise = [&](const Support& other) {
    if (other.value > greatest.value) greatest = other;
  };
  for (const Face& face : piece.faces) raise(support(face, p));
  for (const Round& round : piece.rounds) raise(support(round, p));
  return greatest;
}

double signed_distance(const ConvexPiece& piece, double rho, double z) {
  return support(piece, rho, z).value;
}

}  // namespace swarf::cutter
