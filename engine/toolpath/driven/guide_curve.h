// A guide curve in the plane square to the tool's axis: lines and spirals (an arc is a spiral that keeps its
// radius) one after the other. Where the pieces meet at an angle the tool path has a corner.
#pragma once

#include <vector>

#include "base/frames.h"

namespace swarf::toolpath {

/// From one point to another, or round a centre.
struct GuidePiece {
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();  ///< of a line
  bool round = false;
  Vec2 centre = Vec2::Zero();
  double radius_from = 0.0, radius_to = 0.0;  ///< mm, linear in the angle
  double angle_from = 0.0, sweep = 0.0;       ///< rad; sweep above 0: counter-clockwise
};
GuidePiece guide_line(const Vec2& from, const Vec2& to);
GuidePiece guide_spiral(const Vec2& centre, double radius_from, double radius_to, double angle_from,
                        double sweep);

class GuideCurve {
 public:
  /// At least one piece, each longer than 0; each begins where the one before has ended.
  explicit GuideCurve(std::vector<GuidePiece> pieces);

  /// The parameter runs from 0 to here. It is the length on lines and arcs, and near it on spirals.
  double end() const { return starts_.back(); }
  Vec2 point(double x) const;
  /// By the parameter: the derivative on the side of greater x.
  Vec2 tangent(double x) const;
  /// Parameters of the joints between pieces.
  std::vector<double> joints() const { return {starts_.begin() + 1, starts_.end() - 1}; }

 private:
  size_t piece_at(double x) const;
  std::vector<GuidePiece> pieces_;
  std::vector<double> starts_;  ///< of each piece, and the end of the last
};

}  // namespace swarf::toolpath
