#include "measure/height_bounds.h"

#include <algorithm>
#include <cmath>

#include "stock/sweep/convex_motion.h"

namespace swarf::measure {
namespace {

/// Any tangent bounds: the last digits of the nearest instant are not worth their steps; mm.
constexpr double kCloseEnough = 1e-7;

/// A function of the work's points that lies below F over a whole sweep: the lesser of two linear ones.
struct Tangents {
  Vec3 at;                      ///< W, mm
  std::array<double, 2> value;  ///< at `at`, mm
  std::array<Vec3, 2> slope;    ///< W
};

struct Root {
  double height = -kNever;  ///< mm
  size_t corner = 0;        ///< where it is that low
};

/// A flat cell under a tangent that falls along its columns: the depth that may be cut is linear over the
/// cell, as its own depth is bounded by linear functions, and the least of them counts at each place.
std::optional<Root> root_of_flat(const DesignCell& cell, const Tangents& tangents, size_t end,
                                 const ColumnDepths& depths) {
  if (depths.own.empty()) return std::nullopt;
  std::vector<CornerHeights> bounds = depths.own;
  CornerHeights cut{};
  for (size_t k = 0; k < 3; ++k) {
    const CellCorner& corner = cell.corners[k];
    const double base =
        tangents.value[end] + tangents.slope[end].dot(corner.point - tangents.at) - kRoundingOfHeights;
    const double rise = tangents.slope[end].dot(corner.normal);
    if (!(rise < 0.0)) return std::nullopt;
    cut[k] = base / rise;
  }
  bounds.push_back(cut);
  return Root{-highest_left(bounds).height,
              static_cast<size_t>(std::max_element(cut.begin(), cut.end()) - cut.begin())};
}

/// Least value over barycentric l of sum_k l_k at_k - 1/2 sum over pairs l_j l_k bend_jk, bend_k of the side
/// from corner k: at a corner, on a side or, where the function is convex, inside.
double least_of_quadratic(const CornerHeights& at, const CornerHeights& bend) {
  double least = std::min({at[0], at[1], at[2]});
  for (size_t k = 0; k < 3; ++k) {
    const double step = at[(k + 1) % 3] - at[k];
    if (!(bend[k] > 2.0 * std::abs(step))) continue;
    const double t = 0.5 - step / bend[k];
    least = std::min(least, at[k] - 0.5 * bend[k] * t * t);
  }
  // g(x, y) = at_0 + p x + q y + 1/2 (bend_0 x^2 + 2 h x y + bend_2 y^2), x = l_1, y = l_2.
  const double p = at[1] - at[0] - 0.5 * bend[0], q = at[2] - at[0] - 0.5 * bend[2];
  const double h = 0.5 * (bend[0] + bend[2] - bend[1]);
  const double det = bend[0] * bend[2] - h * h;
  if (!(bend[0] > 0.0 && det > 0.0)) return least;
  const double x = (h * q - bend[2] * p) / det, y = (h * p - bend[0] * q) / det;
  if (x > 0.0 && y > 0.0 && x + y < 1.0) least = std::min(least, at[0] + 0.5 * (p * x + q * y));
  return least;
}

/// A curved cell under a tangent that falls along its columns: the tangent is quadratic over the cell. The
/// height at which it may first be cut; nothing where that lies deeper than is looked for.
std::optional<double> root_of_curved(const DesignCell& cell, const Tangents& tangents, size_t end,
                                     const ColumnDepths& depths) {
  CornerHeights base{}, bend{};
  double steepest = 0.0, flattest = kNever;
  for (size_t k = 0; k < 3; ++k) {
    const CellCorner& corner = cell.corners[k];
    base[k] = tangents.value[end] + tangents.slope[end].dot(corner.point - tangents.at);
    bend[k] = tangents.slope[end].dot(cell.bends[k]);
    const double falls = -tangents.slope[end].dot(corner.normal);
    steepest = std::max(steepest, falls + cell.turn);
    flattest = std::min(flattest, falls - cell.turn);
  }
  if (!(flattest > 0.0)) return std::nullopt;
  const double least = least_of_quadratic(base, bend) - cell.stray_mm - kRoundingOfHeights;
  const double height = least / (least < 0.0 ? flattest : steepest);
  if (-height > *std::min_element(depths.seen.begin(), depths.seen.end())) return std::nullopt;
  return height;
}

/// Of one end of the motion, as if the cell lay anywhere within its flatness.
Root root_of_thick(const DesignCell& cell, const Tangents& tangents, size_t end, const ColumnDepths& depths) {
  Root least{kNever, 0};
  for (size_t k = 0; k < 3; ++k) {
    // value + slope . (p + s n - at) - flatness - |s| turn: which branch of |s| holds the root, the sign at
    // s = 0 tells.
    const CellCorner& corner = cell.corners[k];
    const double base = tangents.value[end] + tangents.slope[end].dot(corner.point - tangents.at) -
                        cell.flatness_mm - kRoundingOfHeights;
    const double rise = tangents.slope[end].dot(corner.normal);
    if (base + kTouch - depths.seen[k] * (rise + cell.turn) < 0.0) return {-kNever, k};
    const double falls = base < 0.0 ? rise + cell.turn : rise - cell.turn;
    if (!(falls < 0.0)) continue;
    const double height = std::max(-depths.seen[k], -base / falls);
    if (height < least.height) least = {height, k};
  }
  return least;
}

/// Of one end of the motion.
Root root_of(const DesignCell& cell, const Tangents& tangents, size_t end, const ColumnDepths& depths) {
  if (const auto flat = root_of_flat(cell, tangents, end, depths)) return *flat;
  Root least = root_of_thick(cell, tangents, end, depths);
  if (cell.flatness_mm == 0.0) return least;
  if (const auto curved = root_of_curved(cell, tangents, end, depths))
    least.height = std::max(least.height, *curved);
  return least;
}

/// Height below which `tangents` stays above the cell's margin, as far down as the depths. One that is no
/// greater than `known` is not made any closer.
Root root_of(const DesignCell& cell, const Tangents& tangents, const ColumnDepths& depths,
             double known = -kNever) {
  const Root start = root_of(cell, tangents, 0, depths);
  if (start.height <= known) return start;
  const Root end = root_of(cell, tangents, 1, depths);
  return end.height < start.height ? end : start;
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
  const stock::Nearest nearest = stock::nearest_instant(piece, P, D, 0.0, 1.0, kCloseEnough);
  return {at,
          {nearest.floor, nearest.floor},
          {near.map.R0t.transpose() * nearest.normal, near.map.R1t.transpose() * nearest.normal}};
}

struct Support {
  double value = kNever;
  Vec2 point = Vec2::Zero();  ///< (rho, z)
};

/// max over the piece of direction . (rho, z) and where, by the dual: any two half planes that hold the piece
/// and whose normals have the direction between them bound it, and the least such bound is exact.
Support support_along(const cutter::ConvexPiece& piece, const Vec2& direction) {
  std::array<cutter::Face, 32> holds;
  size_t count = 0;
  const auto add = [&](const Vec2& normal, double offset) {
    if (count < holds.size()) holds[count++] = {normal, offset};
  };
  const auto cross = [](const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); };
  add({-1.0, 0.0}, 0.0);  // rho >= 0
  add({1.0, 0.0}, piece.radius);
  add({0.0, -1.0}, -piece.low);
  add({0.0, 1.0}, piece.high);
  for (const cutter::Face& face : piece.faces) add(face.normal, face.offset);
  for (const cutter::Round& round : piece.rounds) {
    const Vec2 toward = direction.normalized();
    for (const Vec2& normal : {round.from, round.to}) add(normal, normal.dot(round.centre) + round.radius);
    if (cross(round.from, toward) >= 0.0 && cross(toward, round.to) >= 0.0)
      return {direction.dot(round.centre) + round.radius * direction.norm(),
              round.centre + round.radius * toward};
  }
  Support least;
  for (size_t i = 0; i < count; ++i) {
    for (size_t j = 0; j < i; ++j) {
      const Vec2 &a = holds[i].normal, &b = holds[j].normal;
      const double det = cross(a, b);
      if (std::abs(det) < 1e-12) continue;
      const double l = cross(direction, b) / det, m = cross(a, direction) / det;
      const double value = l * holds[i].offset + m * holds[j].offset;
      if (l < 0.0 || m < 0.0 || value >= least.value) continue;
      least = {value, Vec2(holds[i].offset * b.y() - holds[j].offset * a.y(),
                           holds[j].offset * a.x() - holds[i].offset * b.x()) /
                          det};
    }
  }
  return least;
}

/// The plane of outward direction `down` (tool frame) that the piece touches and does not pass.
Tangents touching_plane(const cutter::ConvexPiece& piece, const NearSweep& near, const Vec3& at,
                        const Vec3& down) {
  const double most = support_along(piece, {down.head<2>().norm(), down.z()}).value;
  return {at,
          {down.dot(near.map.start(at)) - most, down.dot(near.map.end(at)) - most},
          {near.map.R0t.transpose() * down, near.map.R1t.transpose() * down}};
}

/// `down` with its sideways part turned to where the place stands about the cutter's axis as the axis is
/// nearest: the plane that touches the rim, or the flank, there, as square to the cell as it can be.
std::optional<Vec3> toward_rim(const NearSweep& near, const Vec3& at, const Vec3& down) {
  const Vec2 P = near.map.start(at).head<2>(), D = near.map.end(at).head<2>() - P;
  const double t = D.squaredNorm() > 0.0 ? std::clamp(-P.dot(D) / D.squaredNorm(), 0.0, 1.0) : 0.0;
  const Vec2 X = P + t * D;
  const double rho = X.norm();
  if (!(rho > 0.0)) return std::nullopt;
  const Vec2 radial = X / rho;
  const double sideways = std::max(0.0, radial.dot(down.head<2>()));
  const Vec3 turned(sideways * radial.x(), sideways * radial.y(), down.z());
  return turned.norm() > 0.0 ? std::optional<Vec3>(turned.normalized()) : std::nullopt;
}

/// How the way from the chord's centroid to a corner bends off at its two ends: -1/2 sum over pairs l_j l_k
/// M_jk by the share of the way, l = (1 - share) / 3 at the other corners.
std::array<Vec3, 2> bend_toward(const DesignCell& cell, size_t corner) {
  const Vec3 beside = cell.bends[corner] + cell.bends[(corner + 2) % 3],
             across = cell.bends[(corner + 1) % 3];
  return {(2.0 * across - beside) / 18.0, beside / 6.0};
}

/// The tangents at the place of the cell that the piece comes nearest to: from the centroid toward the corner
/// that looks lowest from there, to where the distance stops falling, as its slopes at both ends tell.
double height_by_motion(const DesignCell& cell, const NearSweep& near, const cutter::ConvexPiece& piece,
                        const ColumnDepths& depths, double enough) {
  const Vec3 centre = cell.centroid();
  const Tangents first = motion_tangents(piece, near, centre);
  const Root from_centre = root_of(cell, first, depths);
  if (from_centre.height > enough || cell.stray_mm > -enough) return from_centre.height;
  const Vec3 way = cell.corners[from_centre.corner].point - centre;
  const Tangents second = motion_tangents(piece, near, centre + way);
  double best = std::max(from_centre.height, root_of(cell, second, depths, from_centre.height).height);
  const std::array<Vec3, 2> bend = bend_toward(cell, from_centre.corner);
  const double falls = first.slope[0].dot(way + bend[0]), rises = second.slope[0].dot(way + bend[1]);
  if (best > enough || !(falls < 0.0 && rises > 0.0)) return best;
  const double share = falls / (falls - rises);
  const Tangents between = motion_tangents(piece, near, centre + share * way);
  return std::max(best, root_of(cell, between, depths, best).height);
}

double least_height(const DesignCell& cell, const NearSweep& near, const cutter::ConvexPiece& piece,
                    const ColumnDepths& depths, double enough) {
  const Vec3 centre = cell.centroid(), normal = cell.mean_normal();
  double best = -kNever;
  for (const cutter::Face& face : piece.faces) {
    if (face.normal.x() == 0.0)
      best = std::max(best, root_of(cell, face_tangents(face, near, centre), depths, best).height);
  }
  if (best > enough && best < kNever) return best;
  best = std::max(best, height_by_motion(cell, near, piece, depths, enough));
  if (best > enough) return best;
  // A rim has no tangent of its own: there its lowest point counts, and the point that is nearest.
  const Vec3 down = -(near.map.R0t * normal);
  best = std::max(best, root_of(cell, touching_plane(piece, near, centre, down), depths, best).height);
  if (best > enough) return best;
  if (const auto rim = toward_rim(near, centre, down))
    best = std::max(best, root_of(cell, touching_plane(piece, near, centre, *rim), depths, best).height);
  if (best > enough) return best;
  const Vec3 below = centre - cell.radius() * normal;
  best = std::max(best, root_of(cell, motion_tangents(piece, near, below), depths, best).height);
  if (best > enough || !(enough > 0.0)) return best;
  // Higher up the columns may pass beside what stands over them from below.
  const Vec3 above = centre + enough * normal;
  return std::max(best, root_of(cell, motion_tangents(piece, near, above), depths, best).height);
}

/// The part of the motion between two instants, as a sweep of its own.
NearSweep slice_of(const NearSweep& near, double from, double to) {
  NearSweep part = near;
  const auto map_at = [&](double t, Mat3& R, Vec3& tip) {
    R = (1.0 - t) * near.map.R0t + t * near.map.R1t;
    const Vec3 tip_in_tool = (1.0 - t) * near.map.start(Vec3::Zero()) + t * near.map.end(Vec3::Zero());
    tip = -R.inverse() * tip_in_tool;
  };
  map_at(from, part.map.R0t, part.map.tip0);
  map_at(to, part.map.R1t, part.map.tip1);
  return part;
}

/// As the cutter turns, one tangent loses up to turn * radius of the cell: the motion is halved until that is
/// little, where more is asked for.
double least_height_in_slices(const DesignCell& cell, const NearSweep& near, const cutter::ConvexPiece& piece,
                              const ColumnDepths& depths, double enough) {
  constexpr double kLittle = 1e-5;  // mm
  const double best = least_height(cell, near, piece, depths, enough);
  if (!near.turns || best > enough) return best;
  const double lost = (near.map.R1t - near.map.R0t).norm() * cell.radius();
  if (lost < kLittle || cell.stray_mm > -enough || (best > -kNever && best + 2.0 * lost < enough))
    return best;
  const double first = least_height_in_slices(cell, slice_of(near, 0.0, 0.5), piece, depths, enough);
  if (first <= best) return best;
  const double second = least_height_in_slices(cell, slice_of(near, 0.5, 1.0), piece, depths, enough);
  return std::max(best, std::min(first, second));
}

}  // namespace

double least_height(const DesignCell& cell, const NearSweep& near, const ColumnDepths& depths,
                    double enough) {
  double least = kNever;
  for (const cutter::ConvexPiece& piece : near.cutter->pieces) {
    least = std::min(least, least_height_in_slices(cell, near, piece, depths, enough));
    if (least == -kNever) break;
  }
  return least;
}

std::optional<Vec3> deepest_place(const DesignCell& cell, const NearSweep& near) {
  const Vec3 centre = cell.centroid(), down = -(near.map.R0t * cell.mean_normal());
  const double aside = down.head<2>().norm();
  double lowest = kNever;
  Vec3 place = centre;
  for (const cutter::ConvexPiece& piece : near.cutter->pieces) {
    const Vec3 P = near.map.start(centre), D = near.map.end(centre) - P;
    const stock::Nearest nearest = stock::nearest_instant(piece, P, D);
    if (nearest.value >= lowest) continue;
    lowest = nearest.value;
    const Support support = support_along(piece, {aside, down.z()});
    // A little within the rim, where the place's column is sure to meet the piece.
    constexpr double kWithin = 1e-5;  // mm
    const double rho = std::max(0.0, support.point.x() - kWithin);
    const Vec2 sideways = aside > 0.0 ? Vec2(rho / aside * down.head<2>()) : Vec2(Vec2::Zero());
    const Vec3 offset = Vec3(sideways.x(), sideways.y(), support.point.y()) - (P + nearest.t * D);
    place = centre + near.map.R0t.transpose() * offset;
  }
  // Barycentric coordinates of the place, seen along the cell's normal.
  const Vec3 &a = cell.corners[0].point, ab = cell.corners[1].point - a, ac = cell.corners[2].point - a;
  const Vec3 n = ab.cross(ac), at = place - a;
  const double area2 = n.squaredNorm();
  if (!(area2 > 0.0)) return std::nullopt;
  const Vec3 l(1.0 - at.cross(ac).dot(n) / area2 - ab.cross(at).dot(n) / area2, at.cross(ac).dot(n) / area2,
               ab.cross(at).dot(n) / area2);
  return l.minCoeff() > 0.0 ? std::optional(l) : std::nullopt;
}

bool stays_above(const CellCorner& corner, const NearSweep& near, double height_mm) {
  const Vec3 at = corner.point + height_mm * corner.normal;
  const Vec3 X0 = near.map.start(at), X1 = near.map.end(at);
  const Vec3 N0 = near.map.R0t * corner.normal, N1 = near.map.R1t * corner.normal;
  for (const cutter::ConvexPiece& piece : near.cutter->pieces) {
    // Below the bottom's plane at both ends, on a column that leaves on the tool's side.
    if (X0.z() < piece.low && X1.z() < piece.low && N0.z() >= 0.0 && N1.z() >= 0.0) continue;
    const stock::Nearest nearest = stock::nearest_instant(piece, X0, X1 - X0, 0.0, 1.0, kCloseEnough);
    const bool rises = nearest.normal.dot(N0) > 0.0 || nearest.normal.dot(N1) > 0.0;
    if (nearest.floor <= 0.0 || rises) return false;
  }
  return true;
}

}  // namespace swarf::measure
