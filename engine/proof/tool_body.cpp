#include "proof/tool_body.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"

namespace swarf::proof {
namespace {

using cutter::ConvexPiece;
using cutter::Face;

/// Half planes whose intersection holds the piece's half profile: its faces, and tangents of its rounds.
std::vector<Face> half_planes(const ConvexPiece& piece, double outward_mm) {
  std::vector<Face> planes = piece.faces;
  for (const cutter::Round& round : piece.rounds) {
    const double first = std::atan2(round.from.y(), round.from.x()),
                 last = std::atan2(round.to.y(), round.to.x());
    const double turn = last >= first ? last - first : last - first + 2.0 * M_PI;
    const double step = 2.0 * std::sqrt(2.0 * outward_mm / round.radius);
    const int count = std::max(1, static_cast<int>(std::ceil(turn / std::min(step, 0.5))));
    for (int i = 0; i <= count; ++i) {
      const double angle = first + turn * i / count;
      const Vec2 normal(std::cos(angle), std::sin(angle));
      planes.push_back({normal, round.centre.dot(normal) + round.radius});
    }
  }
  return planes;
}

/// Corners of the polygon in rho >= 0 that the half planes leave, in order of height.
std::vector<Vec2> polygon_of(const std::vector<Face>& planes, double radius, double low, double high) {
  std::vector<Vec2> polygon{{0.0, low}, {radius, low}, {radius, high}, {0.0, high}};
  for (const Face& plane : planes) {
    std::vector<Vec2> kept;
    for (size_t k = 0; k < polygon.size(); ++k) {
      const Vec2 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
      const double da = plane.normal.dot(a) - plane.offset, db = plane.normal.dot(b) - plane.offset;
      if (da <= 0.0) kept.push_back(a);
      if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) kept.push_back(a + da / (da - db) * (b - a));
    }
    polygon = std::move(kept);
  }
  std::stable_sort(polygon.begin(), polygon.end(),
                   [](const Vec2& a, const Vec2& b) { return a.y() < b.y(); });
  return polygon;
}

bool is_top(const Face& face) {
  return face.normal.y() > 1.0 - 1e-12;
}

/// Whether the outline has no sharp corner but the rim of its upper end: neighbouring half planes turn by no
/// more than rounds of radius `least_mm` and more explain.
bool is_smooth(const ConvexPiece& piece, double least_mm) {
  constexpr double kSame = 1e-6;
  std::vector<Vec2> from, to;  // normals where bounds begin and end, as the outline goes up
  for (const Face& face : piece.faces) {
    if (is_top(face)) continue;
    from.push_back(face.normal);
    to.push_back(face.normal);
  }
  for (const cutter::Round& round : piece.rounds) {
    if (round.radius < least_mm) return false;
    from.push_back(round.from);
    to.push_back(round.to);
  }
  const auto has_before = [&](const Vec2& normal) {
    if ((normal - Vec2(0.0, -1.0)).norm() < kSame) return true;
    return std::any_of(to.begin(), to.end(), [&](const Vec2& end) { return (end - normal).norm() < kSame; });
  };
  // A face is its own end; what comes before it must be another bound.
  for (size_t i = 0; i < from.size(); ++i) {
    const bool is_face = i < piece.faces.size() && (from[i] - to[i]).norm() < kSame;
    if (!is_face && !has_before(from[i])) return false;
    if (!is_face) continue;
    bool joined = (from[i] - Vec2(0.0, -1.0)).norm() < kSame;
    for (size_t k = 0; k < to.size(); ++k) joined = joined || (k != i && (to[k] - from[i]).norm() < kSame);
    if (!joined) return false;
  }
  return true;
}

collision::RevolvedSolid solid_of(std::vector<Vec2> corners) {
  return {Vec3::Zero(), Vec3::UnitZ(), std::move(corners)};
}

/// Nearer to the axis by `inward` and to the middle of its height by up to `along`: an undercut holds it from
/// above too.
collision::RevolvedSolid shrunk(collision::RevolvedSolid body, double inward, double along) {
  const double middle = 0.5 * (body.corners.front().y() + body.corners.back().y());
  const double half = std::max(along, body.corners.back().y() - middle);
  for (Vec2& corner : body.corners)
    corner = {std::max(0.0, corner.x() - inward), middle + (corner.y() - middle) * (1.0 - along / half)};
  return body;
}

/// How far faces may go in, of a depth, so that the rim of the upper end stays within it: a flank that leans
/// leaves its rim farther off than the flank itself.
double rim_share(const ConvexPiece& piece) {
  constexpr double kOnRim = 1e-9;  // mm
  double rim = piece.radius, share = 1.0;
  const auto radius_at_top = [&](const Face& face) {
    return (face.offset - face.normal.y() * piece.high) / face.normal.x();
  };
  const auto leans = [](const Face& face) { return !is_top(face) && face.normal.x() > 0.0; };
  for (const Face& face : piece.faces)
    if (leans(face)) rim = std::min(rim, radius_at_top(face));
  for (const Face& face : piece.faces)
    if (leans(face) && radius_at_top(face) <= rim + kOnRim) share = std::min(share, face.normal.x());
  return share;
}

/// A tip on the axis, under a cone.
bool is_pointed(const std::vector<Vec2>& outline) {
  constexpr double kFlat = 1e-9;  // mm
  return outline.size() > 1 && outline[0].x() == 0.0 && outline[1].y() > outline[0].y() + kFlat;
}

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 way = b - a;
  const double length2 = way.squaredNorm();
  const double share = length2 > 0.0 ? std::clamp((p - a).dot(way) / length2, 0.0, 1.0) : 0.0;
  return (p - a - share * way).norm();
}

/// From the corners of an outline but its tip to a smaller outline within it: the farthest, mm.
double farthest_corner(const std::vector<Vec2>& outline, const std::vector<Vec2>& within) {
  double farthest = 0.0;
  for (size_t i = 1; i < outline.size(); ++i) {
    if (outline[i].x() == 0.0) continue;  // of the upper end
    double nearest = (outline[i] - within.front()).norm();
    for (size_t k = 0; k + 1 < within.size(); ++k)
      nearest = std::min(nearest, distance_to_segment(outline[i], within[k], within[k + 1]));
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

/// How a pointed piece is made smaller: rounds stand out by `outward`, the point's cone goes in by as much of
/// `g` as corners allow, other faces by a share of that. All mm.
struct PointedReduction {
  double outward = 0.0, g = 0.0, flank_share = 1.0;
};
constexpr std::array<double, 2> kFlankShares{1.0, 0.1};

/// The faces of a piece with a tip moved inwards so far that every corner is within g of what is left, and
/// the axis under it. A point of the cone over the foot of the new tip is within g of the new cone; the piece
/// below, whose hull the old tip and that ring span, is within g of the axis. Empty: nothing is left.
ReducedBody pointed_body(const ConvexPiece& piece, const std::vector<Vec2>& outline,
                         const PointedReduction& by) {
  const Vec2& tip = outline[0];
  const Vec2 cone = outline[1] - tip;
  const Vec2 cone_normal = Vec2(cone.y(), -cone.x()).normalized();
  const std::vector<Face> planes = half_planes(piece, by.outward);
  const auto moved_in = [&](double mm) {
    std::vector<Face> inner = planes;
    for (Face& plane : inner) {
      if (is_top(plane)) continue;
      constexpr double kSame = 1e-9;
      plane.offset -= (plane.normal - cone_normal).norm() < kSame ? mm : by.flank_share * mm;
    }
    return polygon_of(inner, piece.radius + 1.0, piece.low - 1.0, piece.high);
  };
  // Corners move in proportion; a second look keeps the proof whatever the shape is.
  const std::vector<Vec2> first = moved_in(by.g);
  if (first.empty()) return {};
  const double scale = std::min(1.0, (1.0 - 1e-9) * by.g / farthest_corner(outline, first));
  const std::vector<Vec2> inner = moved_in(scale * by.g);
  if (inner.empty() || !is_pointed(inner) || farthest_corner(outline, inner) > by.g) return {};
  // The foot of the new tip must lie on the cone.
  if ((inner[0] - tip).dot(cone) > cone.squaredNorm()) return {};
  const double lowest = std::min(tip.y() + by.g, inner[0].y());
  return {solid_of(inner), solid_of({{0.0, lowest}, inner[0]})};
}

}  // namespace

collision::RevolvedSolid piece_body(const ConvexPiece& piece, double outward_mm) {
  return solid_of(
      polygon_of(half_planes(piece, outward_mm), piece.radius + 1.0, piece.low - 1.0, piece.high));
}

std::vector<ReducedBody> reduced_bodies(const ConvexPiece& piece, double g_mm) {
  const double outward = kOutwardShare * g_mm, g = (1.0 - kOutwardShare) * g_mm;
  std::vector<ReducedBody> bodies;
  if (is_smooth(piece, g_mm)) {
    std::vector<Face> planes = half_planes(piece, outward);
    for (Face& plane : planes)
      if (!is_top(plane)) plane.offset -= rim_share(piece) * g;
    std::vector<Vec2> corners = polygon_of(planes, piece.radius + 1.0, piece.low - 1.0, piece.high);
    if (!corners.empty()) bodies.push_back({solid_of(std::move(corners))});
  }
  const collision::RevolvedSolid whole = piece_body(piece, outward);
  if (whole.corners.empty()) return bodies;
  if (is_pointed(whole.corners)) {
    for (const double share : kFlankShares) {
      ReducedBody body = pointed_body(piece, whole.corners, {outward, g, share});
      if (!body.empty()) bodies.push_back(std::move(body));
    }
  }
  // Never along one direction alone: a floor and a flank that are touched would not be left.
  for (const double degrees : {45.0, 5.0, 85.0, 22.5, 67.5}) {
    const double angle = rad_from_deg(degrees);
    bodies.push_back({shrunk(whole, g * std::cos(angle), g * std::sin(angle))});
  }
  return bodies;
}

}  // namespace swarf::proof
