#include "cutter/convex_piece.h"

#include <algorithm>
#include <limits>

namespace swarf::cutter {
namespace {

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double distance(const Round& round, const Vec2& p) {
  const Vec2 d = p - round.centre;
  const bool within = cross(round.from, d) >= 0.0 && cross(d, round.to) >= 0.0;
  return (within ? d.norm() : std::max(d.dot(round.from), d.dot(round.to))) - round.radius;
}

}  // namespace

ConvexPiece ConvexPiece::cylinder(double radius, double height) {
  return {{{{0.0, -1.0}, 0.0}, {{1.0, 0.0}, radius}, {{0.0, 1.0}, height}}, {}, radius, 0.0, height};
}

bool ConvexPiece::is_cylinder() const {
  if (!rounds.empty() || low != 0.0) return false;
  return std::all_of(faces.begin(), faces.end(),
                     [](const Face& face) { return face.normal.x() == 0.0 || face.normal.y() == 0.0; });
}

double signed_distance(const ConvexPiece& piece, double rho, double z) {
  const Vec2 p(rho, z);
  double value = -std::numeric_limits<double>::infinity();
  for (const Face& face : piece.faces) value = std::max(value, face.normal.dot(p) - face.offset);
  for (const Round& round : piece.rounds) value = std::max(value, distance(round, p));
  return value;
}

}  // namespace swarf::cutter
