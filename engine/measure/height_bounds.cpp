#include "measure/height_bounds.h"

#include <algorithm>
#include <cmath>

#include "stock/convex_motion.h"

namespace swarf::measure {
namespace {

/// mm: doubles of coordinates of some metres, a few operations each.
constexpr double kRounding = 1e-10;

/// A function of the work's points that lies below F over a whole sweep: the lesser of two linear ones.
struct Tangents {
  Vec3 at;                      ///< W, mm
  std::array<double, 2> value;  ///< at `at`, mm
  std::array<Vec3, 2> slope;    ///< W
};

/// Height below which `tangents` stays above the cell's margin, as far down as the depths.
double root_of(const DesignCell& cell, const Tangents& tangents, const std::array<double, 3>& depths_mm) {
  double least = kNever;
  for (size_t k = 0; k < 3; ++k) {
    const CellCorner& corner = cell.corners[k];
    for (int j = 0; j < 2; ++j) {
      // value + slope . (p + s n - at) - flatness - |s| turn, with its two branches of |s|.
      const double base = tangents.value[j] + tangents.slope[j].dot(corner.point - tangents.at) -
                          cell.flatness_mm - kRounding;
      const double rise = tangents.slope[j].dot(corner.normal);
      if (base + kTouch - depths_mm[k] * (rise + cell.turn) < 0.0) return -kNever;
      for (const double turn : {cell.turn, -cell.turn}) {
        if (rise + turn < 0.0) least = std::min(least, std::max(-depths_mm[k], -base / (rise + turn)));
      }
    }
  }
  return least;
}

Tangents face_tangents(const cutter::Face& face, const NearSweep& near, const Vec3& at) {
  // Faces square to the axis are linear in space: each end of the motion bounds what lies between.
  const Vec3 axis0 = face.normal.y() * near.map.R0t.row(2).transpose();
  const Vec3 axis1 = face.normal.y() * near.map.R1t.row(2).transpose();
  return {at,
          {axis0.dot(at - near.map.tip0) - face.offset, axis1.dot(at - near.map.tip1) - face.offset},
          {axis0, axis1}};
}

Tangents motion_tangents(const cutter::ConvexPiece& piece, const NearSweep& near, const Vec3& at) {
  const Vec3 P = near.map.start(at), D = near.map.end(at) - P;
  const stock::Nearest nearest = stock::nearest_instant(piece, P, D);
  return {at,
          {nearest.floor, nearest.floor},
          {near.map.R0t.transpose() * nearest.normal, near.map.R1t.transpose() * nearest.normal}};
}

double least_height(const DesignCell& cell, const NearSweep& near, const cutter::ConvexPiece& piece,
                    const std::array<double, 3>& depths_mm) {
  const Vec3 centre = cell.centroid(), normal = cell.mean_normal();
  double best = -kNever;
  for (const cutter::Face& face : piece.faces) {
    if (face.normal.x() == 0.0)
      best = std::max(best, root_of(cell, face_tangents(face, near, centre), depths_mm));
  }
  // Where a face's plane already passes below the cell's middle, the tangent there can only be looser.
  if (best > 0.0 && best < kNever) return best;
  best = std::max(best, root_of(cell, motion_tangents(piece, near, centre), depths_mm));
  if (!piece.is_cylinder() || best == -kNever) {
    const Vec3 below = centre - cell.radius() * normal;
    best = std::max(best, root_of(cell, motion_tangents(piece, near, below), depths_mm));
  }
  return best;
}

struct Line {
  Vec3 P, N;  ///< X(s) = P + s N in the tool's frame
};

Line line_at(const CellCorner& corner, const NearSweep& near, double t) {
  const Vec3 P0 = near.map.start(corner.point), P1 = near.map.end(corner.point);
  const Vec3 N0 = near.map.R0t * corner.normal, N1 = near.map.R1t * corner.normal;
  return {(1.0 - t) * P0 + t * P1, (1.0 - t) * N0 + t * N1};
}

struct Slope {
  double value, along;
};

Slope slope_on(const cutter::ConvexPiece& piece, const Line& line, double s) {
  const Vec3 X = line.P + s * line.N;
  const double rho = X.head<2>().norm();
  const cutter::Support support = cutter::support(piece, rho, X.z());
  const double sideways = rho > 0.0 ? support.normal.x() * X.head<2>().dot(line.N.head<2>()) / rho
                                    : support.normal.x() * line.N.head<2>().norm();
  return {support.value, sideways + support.normal.y() * line.N.z()};
}

/// Least s >= from with F <= kTouch - margin(s), margin = flatness + |s| turn: Newton's method on a convex
/// function from the left, which cannot overshoot; kNever when F turns up first.
double entry(const cutter::ConvexPiece& piece, const Line& line, double from, const DesignCell& cell) {
  constexpr int kMostSteps = 40;
  constexpr double kClose = 1e-9;  // mm
  double s = from;
  for (int step = 0; step < kMostSteps; ++step) {
    const Slope at = slope_on(piece, line, s);
    const double excess = at.value + cell.flatness_mm + std::abs(s) * cell.turn - kTouch;
    if (excess <= 0.0) return s;
    const double slope = at.along + (s < 0.0 ? -cell.turn : cell.turn);
    if (!(slope < 0.0)) return kNever;
    s += excess / -slope + (step > 3 ? kClose : 0.0);
  }
  return kNever;
}

}  // namespace

double least_height(const DesignCell& cell, const NearSweep& near, const std::array<double, 3>& depths_mm) {
  double least = kNever;
  for (const cutter::ConvexPiece& piece : near.cutter->pieces) {
    least = std::min(least, least_height(cell, near, piece, depths_mm));
    if (least == -kNever) break;
  }
  return least;
}

bool stays_above(const CellCorner& corner, const NearSweep& near, double height_mm) {
  const Vec3 at = corner.point + height_mm * corner.normal;
  const Vec3 X0 = near.map.start(at), X1 = near.map.end(at);
  const Vec3 N0 = near.map.R0t * corner.normal, N1 = near.map.R1t * corner.normal;
  for (const cutter::ConvexPiece& piece : near.cutter->pieces) {
    // Below the bottom's plane at both ends, on a column that leaves on the tool's side.
    if (X0.z() < piece.low && X1.z() < piece.low && N0.z() >= 0.0 && N1.z() >= 0.0) continue;
    const stock::Nearest nearest = stock::nearest_instant(piece, X0, X1 - X0);
    const bool rises = nearest.normal.dot(N0) > 0.0 || nearest.normal.dot(N1) > 0.0;
    if (nearest.floor <= 0.0 || rises) return false;
  }
  return true;
}

CornerHeights covered_from(const DesignCell& cell, const NearSweep& near, const cutter::ConvexPiece& piece,
                           const CornerHeights& from, const CornerHeights& tops) {
  const auto instant = [&](const Vec3& at) {
    const Vec3 P = near.map.start(at);
    return stock::nearest_instant(piece, P, near.map.end(at) - P).t;
  };
  const double mean = (from[0] + from[1] + from[2]) / 3.0;
  // A turning cutter's sweep need not be convex: all corners then are looked at in one instant.
  const double common = near.turns ? instant(cell.centroid() + mean * cell.mean_normal()) : 0.0;
  CornerHeights heights{kNever, kNever, kNever};
  for (size_t k = 0; k < 3; ++k) {
    const CellCorner& corner = cell.corners[k];
    const double t = near.turns ? common : instant(corner.point + from[k] * corner.normal);
    const Line line = line_at(corner, near, t);
    const double high = std::max(tops[k], from[k]);
    if (slope_on(piece, line, high).value > kTouch - (cell.flatness_mm + std::abs(high) * cell.turn))
      return {kNever, kNever, kNever};
    heights[k] = entry(piece, line, from[k], cell);
    if (heights[k] == kNever) return heights;
  }
  return heights;
}

CornerHeights outside_from(const DesignCell& cell, const Vec3& normal, double offset) {
  CornerHeights heights{kNever, kNever, kNever};
  for (size_t k = 0; k < 3; ++k) {
    const CellCorner& corner = cell.corners[k];
    const double rise = normal.dot(corner.normal) - cell.turn;
    const double lacking = offset + cell.flatness_mm + kRounding - normal.dot(corner.point);
    if (!(rise > 0.0)) return {kNever, kNever, kNever};
    // Below the design the margin grows the other way: the bound is taken at the design then.
    heights[k] = std::max(0.0, lacking / rise);
  }
  return heights;
}

double highest_left(const std::vector<CornerHeights>& sets) {
  std::vector<const CornerHeights*> whole;
  for (const CornerHeights& set : sets) {
    if (set[0] < kNever && set[1] < kNever && set[2] < kNever) whole.push_back(&set);
  }
  if (whole.empty()) return kNever;
  double highest = -kNever;
  // The maximum of a concave function that is linear in pieces stands at a corner of the pieces: a corner of
  // the cell, a place on an edge where two sets cross, or one inside where three do.
  const auto look_at = [&](const Vec3& l) {
    if (l.minCoeff() < -1e-12) return;
    double low = kNever;
    for (const CornerHeights* set : whole)
      low = std::min(low, l.x() * (*set)[0] + l.y() * (*set)[1] + l.z() * (*set)[2]);
    highest = std::max(highest, low);
  };
  for (int k = 0; k < 3; ++k) look_at(Vec3::Unit(k));
  for (size_t a = 0; a < whole.size(); ++a) {
    for (size_t b = 0; b < a; ++b) {
      const Vec3 d((*whole[a])[0] - (*whole[b])[0], (*whole[a])[1] - (*whole[b])[1],
                   (*whole[a])[2] - (*whole[b])[2]);
      for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3;
        if (d[k] * d[i] >= 0.0) continue;
        Vec3 l = Vec3::Zero();
        l[i] = d[k] / (d[k] - d[i]);
        l[k] = 1.0 - l[i];
        look_at(l);
      }
      for (size_t c = 0; c < b; ++c) {
        const Vec3 e((*whole[a])[0] - (*whole[c])[0], (*whole[a])[1] - (*whole[c])[1],
                     (*whole[a])[2] - (*whole[c])[2]);
        const Vec3 l = d.cross(e);
        const double sum = l.sum();
        if (sum != 0.0) look_at(l / sum);
      }
    }
  }
  return highest;
}

}  // namespace swarf::measure
