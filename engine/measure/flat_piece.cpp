#include "measure/flat_piece.h"

#include <algorithm>
#include <cmath>

namespace swarf::measure {
namespace {

/// Both parts share what lies on the plane.
struct Parts {
  std::array<FlatPiece, 2> piece;
  bool fits = true;

  void add(size_t side, const Vec3& p) {
    FlatPiece& to = piece[side];
    if (to.count == FlatPiece::kMostCorners) {
      fits = false;
      return;
    }
    to.points[to.count++] = p;
  }
};

/// Any convex polygon of four corners or more, along the diagonal of two corners that are half way round.
std::array<FlatPiece, 2> along_diagonal(const FlatPiece& piece) {
  std::array<FlatPiece, 2> parts;
  const size_t middle = piece.count / 2;
  for (size_t i = 0; i <= middle; ++i) parts[0].points[parts[0].count++] = piece.points[i];
  for (size_t i = middle; i <= piece.count; ++i)
    parts[1].points[parts[1].count++] = piece.points[i % piece.count];
  return parts;
}

}  // namespace

Vec3 FlatPiece::centre() const {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : corners()) sum += p;
  return sum / static_cast<double>(count);
}

double FlatPiece::radius() const {
  const Vec3 middle = centre();
  double squared = 0.0;
  for (const Vec3& p : corners()) squared = std::max(squared, (p - middle).squaredNorm());
  return std::sqrt(squared);
}

FlatPiece FlatPiece::moved(const Vec3& by) const {
  FlatPiece there = *this;
  for (size_t i = 0; i < count; ++i) there.points[i] += by;
  return there;
}

std::optional<std::array<FlatPiece, 2>> cut(const FlatPiece& piece, const CutPlane& plane, double slack_mm) {
  const double length = plane.normal.norm();
  if (!(length > 0.0)) return std::nullopt;
  std::array<double, FlatPiece::kMostCorners> heights{};
  double least = 0.0, most = 0.0;
  for (size_t i = 0; i < piece.count; ++i) {
    heights[i] = plane.height(piece.points[i]) / length;
    least = std::min(least, heights[i]);
    most = std::max(most, heights[i]);
  }
  if (least >= -slack_mm || most <= slack_mm) return std::nullopt;
  Parts parts;
  for (size_t i = 0; i < piece.count; ++i) {
    const size_t next = (i + 1) % piece.count;
    const Vec3 &p = piece.points[i], &q = piece.points[next];
    if (heights[i] <= 0.0) parts.add(0, p);
    if (heights[i] >= 0.0) parts.add(1, p);
    if (heights[i] * heights[next] >= 0.0) continue;
    const Vec3 between = p + heights[i] / (heights[i] - heights[next]) * (q - p);
    parts.add(0, between);
    parts.add(1, between);
  }
  if (!parts.fits || parts.piece[0].count < 3 || parts.piece[1].count < 3) return std::nullopt;
  return parts.piece;
}

std::array<FlatPiece, 2> halves_of(const FlatPiece& piece) {
  size_t from = 0, to = 1;
  double farthest = -1.0;
  for (size_t i = 0; i < piece.count; ++i) {
    for (size_t k = i + 1; k < piece.count; ++k) {
      const double away = (piece.points[k] - piece.points[i]).squaredNorm();
      if (away <= farthest) continue;
      farthest = away;
      from = i;
      to = k;
    }
  }
  if (piece.count == 3) {
    const Vec3 middle = 0.5 * (piece.points[from] + piece.points[to]);
    FlatPiece first = piece, second = piece;
    first.points[to] = middle;
    second.points[from] = middle;
    return {first, second};
  }
  const Vec3 along = piece.points[to] - piece.points[from];
  const CutPlane bisector{along, along.dot(0.5 * (piece.points[to] + piece.points[from]))};
  const auto parts = cut(piece, bisector, 0.0);
  return parts ? *parts : along_diagonal(piece);
}

}  // namespace swarf::measure
