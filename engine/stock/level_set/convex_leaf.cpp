#include "stock/level_set/convex_leaf.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/piece_window.h"

namespace swarf::stock {
namespace {

constexpr double kSearchTolerance = 1e-5, kSearchRounding = 3e-7, kValueRounding = 1e-6;

/// The piece and the way of the leaf's centre past it: every part is convex along it, so greatest at an end.
struct Passage {
  Vec2 first, last;  ///< (rho, z) at both ends of the window
  double radius;     ///< of the leaf about its centre, with slack

  template <class Part>
  double greatest(const Part& part) const {
    return std::max(cutter::support(part, first).value, cutter::support(part, last).value) + radius;
  }
};

Vec2 half_plane(const Vec3& X) {
  return {X.head<2>().norm(), X.z()};
}

class NormalRange {
 public:
  /// Normals never point to the axis, so their y orders them.
  void add(const Vec2& normal) {
    if (!any_ || normal.y() < low_.y()) low_ = normal;
    if (!any_ || normal.y() > high_.y()) high_ = normal;
    any_ = true;
  }
  /// A leaf deep inside the piece all along has no parts; the flank's normal stands in.
  void write(ConvexLeaf& leaf) const {
    leaf.normals = leaf.has_ball && !any_ ? 0 : (low_ == high_ ? 1 : 2);
    leaf.normal[0] = {static_cast<float>(low_.x()), static_cast<float>(low_.y())};
    leaf.normal[1] = {static_cast<float>(high_.x()), static_cast<float>(high_.y())};
  }

 private:
  bool any_ = false;
  Vec2 low_{1.0, 0.0}, high_{1.0, 0.0};
};

/// A round about a point of the axis that begins at its pole is a ball, up to its upper normal.
bool is_ball(const cutter::Round& round) {
  return round.centre.x() == 0.0 && round.from.x() == 0.0;
}

/// Whether points of the leaf may lie beyond the round's upper normal. (-to.y, to.x) . (p - centre) tells the
/// side; without a negative factor of rho it is convex along the motion.
bool reaches_beyond(const cutter::Round& round, const Passage& passage) {
  const Vec2 side(std::max(-round.to.y(), 0.0), round.to.x());
  return passage.greatest(cutter::Face{side, side.dot(round.centre)}) > 0.0;
}

void keep_parts(const cutter::ConvexPiece& piece, const Passage& passage, double band, ConvexLeaf& leaf) {
  NormalRange normals;
  leaf.faces = leaf.rounds = 0;
  leaf.has_ball = false;
  leaf.ball_z = 0.0F;
  for (const cutter::Face& face : piece.faces) {
    if (passage.greatest(face) <= -band) continue;
    normals.add(face.normal);
    leaf.face[leaf.faces++] = {static_cast<float>(face.normal.x()), static_cast<float>(face.normal.y()),
                               static_cast<float>(face.offset)};
  }
  for (const cutter::Round& round : piece.rounds) {
    if (passage.greatest(round) <= -band) continue;
    leaf.round[leaf.rounds++] = {static_cast<float>(round.centre.x()), static_cast<float>(round.centre.y()),
                                 static_cast<float>(round.radius),     static_cast<float>(round.from.x()),
                                 static_cast<float>(round.from.y()),   static_cast<float>(round.to.x()),
                                 static_cast<float>(round.to.y())};
    if (is_ball(round) && !leaf.has_ball) {
      leaf.has_ball = true;
      leaf.ball_z = static_cast<float>(round.centre.y());
      if (reaches_beyond(round, passage)) normals.add(round.to);
    } else {
      normals.add(round.from);
      normals.add(round.to);
    }
  }
  normals.write(leaf);
}

void write_motion(const SweepMap& map, const LeafPlace& place, const Window& window, ConvexLeaf& leaf) {
  const Vec3 start = map.start(place.first_W), end = map.end(place.first_W);
  const auto at = [&](double t, double a, double b) { return static_cast<float>((1.0 - t) * a + t * b); };
  for (int c = 0; c < 3; ++c) {
    leaf.start[c] = at(window.low, start[c], end[c]);
    leaf.end[c] = at(window.high, start[c], end[c]);
    for (int a = 0; a < 3; ++a) {
      leaf.start_step[a][c] = at(window.low, map.R0t(c, a) * place.voxel_mm, map.R1t(c, a) * place.voxel_mm);
      leaf.end_step[a][c] = at(window.high, map.R0t(c, a) * place.voxel_mm, map.R1t(c, a) * place.voxel_mm);
    }
  }
}

}  // namespace

bool prepare_convex_leaf(const LeafPlace& place, const SweepMap& map, const cutter::ConvexPiece& piece,
                         ConvexLeaf& leaf) {
  SWARF_CHECK(piece.faces.size() <= kMostParts && piece.rounds.size() <= kMostParts,
              "a convex piece has at most 64 faces and 64 rounds");
  const double radius = leaf_radius(place.voxel_mm) + kReachSlack;
  const Vec3 centre = place.first_W + Vec3::Constant(0.5 * (kLeafSide - 1) * place.voxel_mm);
  const Vec3 P = map.start(centre), D = map.end(centre) - P;
  const Window window = time_in_reach(piece, P, D, radius + place.band_mm);
  if (window.empty()) return false;
  const Vec3 first = P + window.low * D, last = P + window.high * D;
  keep_parts(piece, {half_plane(first), half_plane(last), radius}, place.band_mm, leaf);
  write_motion(map, place, window, leaf);
  leaf.background = static_cast<float>(place.band_mm);
  const double scale = std::max(first.norm(), last.norm()) + radius;
  leaf.tolerance = static_cast<float>(kSearchTolerance + kSearchRounding * scale);
  return true;
}

int cut_leaf_by_piece(float* values, const LeafPlace& place, const SweepMap& map,
                      const cutter::ConvexPiece& piece, uint32_t slices) {
  ConvexLeaf leaf;
  if (!prepare_convex_leaf(place, map, piece, leaf)) return 0;
  static const ConvexKernel kernel = convex_kernel_variants().front().kernel;
  return kernel(values, leaf, slices);
}

double convex_kernel_error_mm(const cutter::ConvexPiece& piece, double voxel_mm, double band_mm) {
  const double reach = 2.0 * (leaf_radius(voxel_mm) + kReachSlack) + band_mm;
  const double scale =
      std::hypot(piece.radius + reach, std::max(std::abs(piece.low), std::abs(piece.high)) + reach);
  return kSearchTolerance + (kSearchRounding + kValueRounding) * scale;
}

}  // namespace swarf::stock
