// A convex part of the tool as a solid of revolution, with its exact distance on both sides of its surface.
//
//   z ^___          The corners of the profile, counter-clockwise from the axis to the axis; between two
//     |   \         corners the outline is straight. Inside, the distance is that of the nearest side,
//     |    |        outside that of the nearest point: both convex in space, so along a straight line
//     |____|        X(t) = P + t D of the tool's frame a bracket of tangents closes on the least one.
//     +-----> rho
#pragma once

#include <limits>
#include <vector>

#include "base/frames.h"
#include "cutter/convex_piece.h"

namespace swarf::stock {

class RevolvedPart {
 public:
  /// Heights in mm above the tip, low < high; radii not both 0.
  static RevolvedPart frustum(double low, double high, double low_radius, double high_radius);
  /// A piece of the flutes; rounds become chords inside them, at most kChordMm deep.
  explicit RevolvedPart(const cutter::ConvexPiece& piece);
  static constexpr double kChordMm = 5e-3;

  /// Signed distance in mm, negative inside, and its gradient (where it has a kink: one of them). Tool frame.
  struct Place {
    double value = 0.0;
    Vec3 normal = Vec3::UnitZ();
  };
  Place at(const Vec3& X) const;

  const std::vector<Vec2>& corners() const { return corners_; }
  double low() const { return corners_.front().y(); }
  double high() const { return corners_.back().y(); }
  double radius() const { return radius_; }

  /// Where a point that moves on X(t) = P + t D comes nearest, 0 <= t <= 1.
  struct Nearest {
    double t = 0.0;
    double value = 0.0;  ///< at t; never below the least distance
    double floor = 0.0;  ///< never above it
    /// A mean of gradients that the motion does not fall along: for every X
    ///   distance(X) >= floor + normal . (X - place).
    Vec3 normal = Vec3::UnitZ(), place = Vec3::Zero();
  };
  /// Looks until value - floor <= gap, or until the floor lies above `enough`.
  Nearest nearest(const Vec3& P, const Vec3& D, double gap,
                  double enough = std::numeric_limits<double>::infinity()) const;

 private:
  explicit RevolvedPart(const std::vector<Vec2>& corners);
  struct Side {
    Vec2 from, along, outward;
    double length;
  };
  std::vector<Vec2> corners_;
  std::vector<Side> sides_;
  double radius_ = 0.0;
};

}  // namespace swarf::stock
