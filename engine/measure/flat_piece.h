// Convex parts of a facet, cut along planes. Internal to this folder.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "measure/surface_cells.h"

namespace swarf::measure {

/// The places p with normal . p = offset. The normal need not have length 1.
struct CutPlane {
  Vec3 normal = Vec3::UnitZ();
  double offset = 0.0;
  double height(const Vec3& p) const { return normal.dot(p) - offset; }
};

/// A flat convex polygon; corners counter-clockwise about the facet's normal, W, mm.
struct FlatPiece {
  static constexpr size_t kMostCorners = 12;
  std::array<Vec3, kMostCorners> points;
  size_t count = 0;

  FlatPiece() = default;
  explicit FlatPiece(const Corners& corners) : count(3) {
    for (size_t i = 0; i < 3; ++i) points[i] = corners[i];
  }
  std::span<const Vec3> corners() const { return {points.data(), count}; }
  Vec3 centre() const;    ///< the mean of the corners: inside
  double radius() const;  ///< from the centre to the farthest corner
  FlatPiece moved(const Vec3& by) const;
};

/// The parts below and above a plane. None where all corners lie no farther than `slack_mm` beyond it on one
/// side, or the parts would have too many corners.
std::optional<std::array<FlatPiece, 2>> cut(const FlatPiece& piece, const CutPlane& plane, double slack_mm);

/// The two halves on either side of the bisector of the corners that are farthest apart; where that gives too
/// many corners, on either side of a diagonal.
std::array<FlatPiece, 2> halves_of(const FlatPiece& piece);

}  // namespace swarf::measure
