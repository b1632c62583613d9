#include "position/edge_rest.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace swarf::position {
namespace {

constexpr double kNowhere = -std::numeric_limits<double>::infinity();
/// Of Newton's steps: a height is flat about its place, which is left exact to some 1e-26 of this squared.
constexpr double kPlaceShare = 1e-13;
constexpr int kStepsMost = 60;
constexpr double kKink_mm = 1e-9;  // so near to where two pieces meet a contact counts as in their kink

double leg(double hypotenuse, double other) {
  return std::sqrt(std::max(0.0, (hypotenuse - other) * (hypotenuse + other)));
}

double height_at(const ToolProfile& profile, const Vec3& p) {
  const double rho = std::sqrt(p.x() * p.x() + p.y() * p.y());
  return p.z() - profile.height(std::min(rho, profile.radius()));
}

/// rho on an arc about centre_rho != 0 where an edge of slope s > 0 at distance d touches, between two rho of
/// which it touches beyond the first and within the second.
double touching_arc(const ProfilePiece& arc, double s, double d, double low, double high) {
  const double rs = arc.radius * s, ss = s * s;
  const auto across = [&](double rho) { return ss + (rho - d) * (rho + d) / (rho * rho); };
  double rho = std::clamp(arc.centre_rho + rs / std::sqrt(across(high)), low, high);
  for (int i = 0; i < kStepsMost; ++i) {
    const double q = across(rho), root = std::sqrt(q);
    const double value = rho - arc.centre_rho - rs / root;
    const double rise = 1.0 + rs * d * d / (rho * rho * rho * q * root);
    (value < 0.0 ? low : high) = rho;
    double next = rho - value / rise;
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    const double step = std::abs(next - rho);
    rho = next;
    if (step <= kPlaceShare * rho) break;
  }
  return rho;
}

/// The same for any piece: t.
double touching_piece(const ProfilePiece& piece, double s, double d, double low, double high) {
  if (piece.is_line()) return s * d / leg(piece.slope, s);
  if (piece.centre_rho == 0.0) return s * leg(piece.radius, d) / std::sqrt(1.0 + s * s);
  return leg(touching_arc(piece, s, d, std::hypot(d, low), std::hypot(d, high)), d);
}

/// t of the greatest f between low and high, both >= 0 and under the tool, of an edge of slope s >= 0.
double highest_place(const ToolProfile& profile, double s, double d, double low, double high) {
  for (const ProfilePiece& piece : profile.pieces()) {
    const double piece_end = leg(piece.to, d);
    const double end = std::min(high, piece_end);
    if (piece.to <= d || end <= low) continue;
    const double rho_end = end == piece_end ? piece.to : std::sqrt(d * d + end * end);
    if (s * rho_end >= piece.slope_at(rho_end) * end) {
      low = end;
      continue;
    }
    const double rho_low = std::max(piece.from, std::sqrt(d * d + low * low));
    const double turn = rho_low > 0.0 ? low / rho_low : 1.0;  // through the axis the edge runs outwards
    if (s <= piece.slope_at(rho_low) * turn) return low;
    return std::clamp(touching_piece(piece, s, d, low, end), low, end);
  }
  return low;
}

/// p is the lower end.
EdgeRest rest_on_rising(const ToolProfile& profile, const Vec3& p, const Vec3& q) {
  const Vec3 way = q - p;
  const double length = std::sqrt(way.x() * way.x() + way.y() * way.y());
  if (length == 0.0) return {rest_on_point(profile, q), 1.0};
  const double ex = way.x() / length, ey = way.y() / length;
  const double d = std::abs(ex * p.y() - ey * p.x());
  if (d > profile.radius()) return {kNowhere, 0.0};
  const double from = ex * p.x() + ey * p.y(), to = from + length, rim = leg(profile.radius(), d);
  if (to < -rim || from > rim) return {kNowhere, 0.0};
  if (to <= 0.0) return {height_at(profile, q), 1.0};
  const double t = highest_place(profile, way.z() / length, d, std::max(from, 0.0), std::min(to, rim));
  if (t == to) return {height_at(profile, q), 1.0};
  if (t == from) return {height_at(profile, p), 0.0};
  const double part = std::clamp((t - from) / length, 0.0, 1.0);
  return {std::min(height_at(profile, p + part * way), q.z()), part};
}

/// dw/drho on either side of rho; they differ in a kink and on the rim.
struct SlopeRange {
  double inner, outer;
};
SlopeRange slopes_at(const ToolProfile& profile, double rho) {
  const auto pieces = profile.pieces();
  size_t i = 0;
  while (i + 1 < pieces.size() && rho > pieces[i].to + kKink_mm) ++i;
  const double inner = pieces[i].slope_at(std::min(rho, pieces[i].to));
  if (rho < pieces[i].to - kKink_mm) return {inner, inner};
  const bool rim = i + 1 == pieces.size();
  return {inner, rim ? std::numeric_limits<double>::infinity()
                     : std::max(inner, pieces[i + 1].slope_at(pieces[i + 1].from))};
}

}  // namespace

double rest_on_point(const ToolProfile& profile, const Vec3& p) {
  const double square = p.x() * p.x() + p.y() * p.y();
  if (square > profile.radius() * profile.radius()) return kNowhere;
  return p.z() - profile.height(std::sqrt(square));
}

EdgeRest rest_on_edge(const ToolProfile& profile, const Vec3& p, const Vec3& q) {
  if (p.z() <= q.z()) return rest_on_rising(profile, p, q);
  EdgeRest rest = rest_on_rising(profile, q, p);
  rest.part = 1.0 - rest.part;
  return rest;
}

Vec2 gradient_at(const ToolProfile& profile, const Vec3& contact, const Vec3& along) {
  const Vec2 to = contact.head<2>(), way = along.head<2>();
  const double rho = to.norm(), length = way.norm();
  if (rho == 0.0) return Vec2::Zero();
  const SlopeRange range = slopes_at(profile, rho);
  double slope = range.inner;
  const double t = length > 0.0 ? std::abs(way.dot(to)) / length : 0.0;
  // In a kink the slope that balances the edge.
  if (range.outer > range.inner && t > 0.0)
    slope = std::clamp(std::abs(along.z()) / length * rho / t, range.inner, range.outer);
  return std::min(slope, kSteepestGradient) / rho * to;
}

}  // namespace swarf::position
