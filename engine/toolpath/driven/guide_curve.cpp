#include "toolpath/driven/guide_curve.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"

namespace swarf::toolpath {
namespace {

double length_of(const GuidePiece& piece) {
  if (!piece.round) return (piece.to - piece.from).norm();
  return 0.5 * (piece.radius_from + piece.radius_to) * std::abs(piece.sweep);
}

/// Point and derivative by the share t of the piece.
std::pair<Vec2, Vec2> at_share(const GuidePiece& piece, double t) {
  if (!piece.round) return {piece.from + t * (piece.to - piece.from), piece.to - piece.from};
  const double angle = piece.angle_from + t * piece.sweep;
  const double radius = piece.radius_from + t * (piece.radius_to - piece.radius_from);
  const Vec2 out(std::cos(angle), std::sin(angle)), round(-out.y(), out.x());
  return {piece.centre + radius * out,
          (piece.radius_to - piece.radius_from) * out + radius * piece.sweep * round};
}

}  // namespace

GuidePiece guide_line(const Vec2& from, const Vec2& to) {
  GuidePiece piece;
  piece.from = from;
  piece.to = to;
  return piece;
}

GuidePiece guide_spiral(const Vec2& centre, double radius_from, double radius_to, double angle_from,
                        double sweep) {
  GuidePiece piece;
  piece.round = true;
  piece.centre = centre;
  piece.radius_from = radius_from;
  piece.radius_to = radius_to;
  piece.angle_from = angle_from;
  piece.sweep = sweep;
  return piece;
}

GuideCurve::GuideCurve(std::vector<GuidePiece> pieces) : pieces_(std::move(pieces)), starts_{0.0} {
  SWARF_CHECK(!pieces_.empty(), "a guide curve without pieces");
  for (const GuidePiece& piece : pieces_) starts_.push_back(starts_.back() + length_of(piece));
}

size_t GuideCurve::piece_at(double x) const {
  const auto next = std::upper_bound(starts_.begin() + 1, starts_.end() - 1, x);
  return static_cast<size_t>(next - starts_.begin()) - 1;
}

Vec2 GuideCurve::point(double x) const {
  const size_t i = piece_at(x);
  return at_share(pieces_[i], (x - starts_[i]) / (starts_[i + 1] - starts_[i])).first;
}

Vec2 GuideCurve::tangent(double x) const {
  const size_t i = piece_at(x);
  const double length = starts_[i + 1] - starts_[i];
  return at_share(pieces_[i], (x - starts_[i]) / length).second / length;
}

}  // namespace swarf::toolpath
