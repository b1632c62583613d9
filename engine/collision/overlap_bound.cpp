#include "collision/overlap_bound.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <span>

#include "base/angles.h"
#include "collision/greatest_depth.h"

namespace swarf::collision {
namespace {

constexpr int kDiveLevels = 40, kDiveEvery = 4;

/// A part of a surface, in its body's home drawing.
struct SurfacePiece {
  int32_t node = -1;                ///< a box of the body's tree; its primitives lie in the ball
  std::array<Vec3, 8> corners;      ///< or those of a triangle or a patch, which lies in their hull
  size_t count = 0;                 ///< of corners
  bool whole = false;               ///< a triangle as it was given
  Vec3 middle = Vec3::Zero();       ///< on the surface, but for a box's
  double radius = 0.0;              ///< of the ball about the middle that holds all of it, mm
  uint32_t solid = 0, segment = 0;  ///< of a patch
  double u0 = 0.0, u1 = 1.0, turn0 = 0.0, turn1 = kTurn;
};

/// A piece of body b (or of a: `of_a`) over a span of poses.
struct DepthCell {
  double upper = 0.0;  ///< mm
  double move = 0.0;   ///< mm that its places move at most
  double from = 0.0, to = 0.0;
  bool of_a = false;
  SurfacePiece piece;
  bool operator<(const DepthCell& other) const { return upper < other.upper; }
};

void close_piece(SurfacePiece& piece) {
  for (size_t i = 0; i < piece.count; ++i)
    piece.radius = std::max(piece.radius, (piece.corners[i] - piece.middle).norm());
}

SurfacePiece triangle_piece(const Triangle& triangle) {
  SurfacePiece piece;
  std::copy(triangle.begin(), triangle.end(), piece.corners.begin());
  piece.count = 3;
  piece.middle = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
  close_piece(piece);
  return piece;
}

/// The profile with its ends on the axis, so that bottom and top are sides like the others.
std::vector<Vec2> closed_profile(const RevolvedSolid& solid) {
  std::vector<Vec2> profile = solid.corners;
  profile.insert(profile.begin(), Vec2(0.0, profile.front().y()));
  profile.emplace_back(0.0, profile.back().y());
  return profile;
}

Vec3 on_solid(const RevolvedSolid& solid, const Vec2& at, double turn, double wider = 1.0) {
  const Vec3 x = solid.axis.unitOrthogonal(), y = solid.axis.cross(x);
  return solid.foot + at.y() * solid.axis + wider * at.x() * (std::cos(turn) * x + std::sin(turn) * y);
}

/// A quarter of a turn at most. Each arc lies between its ends and the tangent of its middle.
void shape_patch(const Body& body, SurfacePiece& patch) {
  const RevolvedSolid& solid = body.solids[patch.solid];
  const std::vector<Vec2> profile = closed_profile(solid);
  const Vec2 &a = profile[patch.segment], way = profile[patch.segment + 1] - a;
  const double half = 0.5 * (patch.turn1 - patch.turn0), wider = 1.0 / std::cos(half);
  const Vec2 low = a + patch.u0 * way, high = a + patch.u1 * way;
  patch.count = 8;
  patch.corners = {on_solid(solid, low, patch.turn0, wider),  on_solid(solid, low, patch.turn1, wider),
                   on_solid(solid, high, patch.turn0, wider), on_solid(solid, high, patch.turn1, wider),
                   on_solid(solid, low, patch.turn0),         on_solid(solid, low, patch.turn1),
                   on_solid(solid, high, patch.turn0),        on_solid(solid, high, patch.turn1)};
  patch.middle = on_solid(solid, 0.5 * (low + high), patch.turn0 + half);
  patch.radius = 0.0;
  close_piece(patch);
}

void add_patches(const Body& body, uint32_t solid, std::vector<SurfacePiece>& pieces) {
  const size_t segments = body.solids[solid].corners.size() + 1;
  for (uint32_t segment = 0; segment < segments; ++segment)
    for (int quarter = 0; quarter < 4; ++quarter) {
      SurfacePiece patch;
      patch.solid = solid;
      patch.segment = segment;
      patch.turn0 = 0.25 * kTurn * quarter;
      patch.turn1 = 0.25 * kTurn * (quarter + 1);
      shape_patch(body, patch);
      if (patch.radius > 0.0) pieces.push_back(patch);
    }
}

void add_box(const Body& body, int32_t node, std::vector<SurfacePiece>& pieces) {
  const BodyNode& box = body.nodes[static_cast<size_t>(node)];
  SurfacePiece piece;
  piece.node = node;
  piece.middle = box.centre;
  piece.radius = box.radius;
  pieces.push_back(piece);
}

void halve_triangle(const SurfacePiece& piece, std::vector<SurfacePiece>& pieces) {
  const auto& c = piece.corners;
  size_t longest = 0;
  for (size_t i = 1; i < 3; ++i)
    if ((c[(i + 1) % 3] - c[i]).norm() > (c[(longest + 1) % 3] - c[longest]).norm()) longest = i;
  const Vec3 &a = c[longest], &b = c[(longest + 1) % 3], &tip = c[(longest + 2) % 3], middle = 0.5 * (a + b);
  pieces.push_back(triangle_piece({a, middle, tip}));
  pieces.push_back(triangle_piece({middle, b, tip}));
}

void halve_patch(const Body& body, const SurfacePiece& piece, std::vector<SurfacePiece>& pieces) {
  SurfacePiece first = piece, second = piece;
  const double along = (piece.corners[2] - piece.corners[0]).norm();
  const double across =
      std::max((piece.corners[1] - piece.corners[0]).norm(), (piece.corners[3] - piece.corners[2]).norm());
  if (along > across) {
    first.u1 = second.u0 = 0.5 * (piece.u0 + piece.u1);
  } else {
    first.turn1 = second.turn0 = 0.5 * (piece.turn0 + piece.turn1);
  }
  for (SurfacePiece* const half : {&first, &second}) {
    shape_patch(body, *half);
    pieces.push_back(*half);
  }
}

std::vector<SurfacePiece> parts_of(const Body& body, const SurfacePiece& piece) {
  std::vector<SurfacePiece> parts;
  if (piece.node < 0) {
    piece.count == 3 ? halve_triangle(piece, parts) : halve_patch(body, piece, parts);
    return parts;
  }
  const BodyNode& box = body.nodes[static_cast<size_t>(piece.node)];
  if (box.child >= 0) {
    add_box(body, box.child, parts);
    add_box(body, box.child + 1, parts);
  } else if (box.primitive < body.triangles.size()) {
    parts.push_back(triangle_piece(body.triangles[box.primitive]));
    parts.back().whole = true;
  } else {
    add_patches(body, box.primitive - static_cast<uint32_t>(body.triangles.size()), parts);
  }
  return parts;
}

class DepthSearch {
 public:
  DepthSearch(const Encounter& pair, const BodyDepth& in_a, const BodyDepth& in_b, PathStretch poses)
      : pair_(pair),
        in_a_(in_a),
        in_b_(in_b),
        most_in_a_(greatest_depth(*pair.a)),
        most_in_b_(greatest_depth(*pair.b)),
        poses_(poses) {}

  DepthRange run(size_t first, size_t last, size_t budget) {
    std::vector<DepthCell> roots;
    for (const bool of_a : {false, true}) {
      const Body& body = of_a ? *pair_.a : *pair_.b;
      std::vector<SurfacePiece> pieces;
      if (!body.nodes.empty()) add_box(body, 0, pieces);
      for (const SurfacePiece& piece : pieces)
        look_at({0.0, 0.0, static_cast<double>(first), static_cast<double>(last), of_a, piece}, roots);
    }
    for (DepthCell& root : roots) cells_.push(std::move(root));
    for (size_t round = 0; !cells_.empty() && looked_ < budget; ++round) {
      if (cells_.top().upper <= found_.seen_mm + kDepthTolerance) break;
      const DepthCell cell = cells_.top();
      cells_.pop();
      follow(cell, round % kDiveEvery == 0 ? kDiveLevels : 1);
    }
    found_.bound_mm = std::max(found_.seen_mm, done_);
    if (!cells_.empty()) found_.bound_mm = std::max(found_.bound_mm, cells_.top().upper);
    return found_;
  }

 private:
  /// Over whole ways a chord and its stray, within one way the way itself.
  AxisSegment axes_over(double from, double to) {
    const auto first = static_cast<size_t>(from), last = static_cast<size_t>(std::ceil(to));
    AxisSegment axes;
    axes.q0 = axes_at(from);
    axes.q1 = axes_at(to);
    if (last - first <= 1) return axes;
    const auto [known, is_new] = strays_.try_emplace({first, last}, AxisValues::Zero());
    for (size_t k = first + 1; is_new && k < last; ++k) {
      const double share = (static_cast<double>(k) - from) / (to - from);
      known->second = known->second.cwiseMax((poses_[k].q - axes.at(share)).cwiseAbs());
    }
    axes.stray = known->second;
    return axes;
  }

  AxisValues axes_at(double at) const {
    const auto way = std::min(static_cast<size_t>(at), poses_.size() - 1);
    const double share = at - static_cast<double>(way);
    if (share <= 0.0 || way + 1 >= poses_.size()) return poses_[way].q;
    return (1.0 - share) * poses_[way].q + share * poses_[way + 1].q;
  }

  /// A pose that occurs.
  static double middle_of(double from, double to) {
    const double middle = 0.5 * (from + to);
    return std::ceil(to) - std::floor(from) > 1.0 ? std::floor(middle) : middle;
  }

  /// Appends it where something in it may be deeper than what has been seen.
  void look_at(DepthCell cell, std::vector<DepthCell>& open) {
    ++looked_;
    const SurfacePiece& piece = cell.piece;
    const RelativeMotion& motion = cell.of_a ? pair_.a_from_b : pair_.b_from_a;
    const BodyDepth& in = cell.of_a ? in_b_ : in_a_;
    const AxisSegment axes = axes_over(cell.from, cell.to);
    const MotionBounds bounds = motion.bounds(axes, piece.middle, piece.radius);
    const double middle = middle_of(cell.from, cell.to);
    const AxisValues q = axes_at(middle);
    const Vec3 place = motion.pose(q) * piece.middle;
    const double share = cell.to > cell.from ? (middle - cell.from) / (cell.to - cell.from) : 0.5;
    cell.move = bounds.speed * std::max(share, 1.0 - share) + 2.0 * bounds.slack(0.0);
    const double depth = in.signed_depth(place);
    const double most = cell.of_a ? most_in_b_ : most_in_a_;
    cell.upper = std::min(depth + piece.radius + cell.move, most);
    if (piece.node < 0) {
      tell(depth, q, place, cell.of_a, middle);
      for (size_t i = 0; piece.whole && i < piece.count; ++i) {
        const Vec3 corner = motion.pose(q) * piece.corners[i];
        tell(in.signed_depth(corner), q, corner, cell.of_a, middle);
      }
      if (cell.upper > found_.seen_mm + kDepthTolerance)
        cell.upper = std::min(cell.upper, corner_bound(cell, in, place, axes) + bounds.slack(0.125));
    }
    if (cell.upper <= found_.seen_mm + kDepthTolerance) {
      done_ = std::max(done_, cell.upper);
    } else {
      open.push_back(std::move(cell));
    }
  }

  /// Splits the cell, then the part that promises most, and so on: what is seen early spares the rest.
  void follow(DepthCell cell, int levels) {
    for (int level = 0; level < levels; ++level) {
      std::vector<DepthCell> parts = split(cell);
      if (parts.empty()) return;
      std::iter_swap(std::max_element(parts.begin(), parts.end()), parts.end() - 1);
      cell = std::move(parts.back());
      parts.pop_back();
      for (DepthCell& part : parts) cells_.push(std::move(part));
    }
    cells_.push(std::move(cell));
  }

  double corner_bound(const DepthCell& cell, const BodyDepth& in, const Vec3& middle,
                      const AxisSegment& axes) const {
    const RelativeMotion& motion = cell.of_a ? pair_.a_from_b : pair_.b_from_a;
    const Pose first = motion.pose(axes.q0), last = motion.pose(axes.q1);
    std::array<Vec3, 16> points;
    for (size_t i = 0; i < cell.piece.count; ++i) {
      points[2 * i] = first * cell.piece.corners[i];
      points[2 * i + 1] = last * cell.piece.corners[i];
    }
    return in.hull_bound(middle, std::span(points).first(2 * cell.piece.count));
  }

  void tell(double depth, const AxisValues& q, const Vec3& place, bool of_a, double at) {
    if (depth <= found_.seen_mm) return;
    found_.seen_mm = depth;
    found_.place_M = link_pose(*pair_.scene, of_a ? pair_.b->link : pair_.a->link, q) * place;
    found_.at = at;
  }

  std::vector<DepthCell> split(const DepthCell& cell) {
    std::vector<DepthCell> open;
    const double middle = middle_of(cell.from, cell.to);
    if (cell.move > cell.piece.radius && middle > cell.from) {
      look_at({0.0, 0.0, cell.from, middle, cell.of_a, cell.piece}, open);
      look_at({0.0, 0.0, middle, cell.to, cell.of_a, cell.piece}, open);
      return open;
    }
    for (const SurfacePiece& part : parts_of(cell.of_a ? *pair_.a : *pair_.b, cell.piece))
      look_at({0.0, 0.0, cell.from, cell.to, cell.of_a, part}, open);
    return open;
  }

  const Encounter& pair_;
  const BodyDepth &in_a_, &in_b_;
  double most_in_a_, most_in_b_;  ///< mm, whatever stands in them
  PathStretch poses_;
  DepthRange found_;
  size_t looked_ = 0;
  double done_ = 0.0;  ///< greatest upper bound of what was looked at no further, mm
  std::priority_queue<DepthCell> cells_;
  std::map<std::pair<size_t, size_t>, AxisValues> strays_;
};

}  // namespace

DepthRange depth_over(const Encounter& pair, const BodyDepth& in_a, const BodyDepth& in_b, PathStretch poses,
                      size_t first, size_t last, size_t budget) {
  return DepthSearch(pair, in_a, in_b, poses).run(first, last, budget);
}

Depth deepest_overlap(const Encounter& pair, const BodyDepth& in_a, const BodyDepth& in_b,
                      const AxisValues& q) {
  PathPose still;
  still.q = q;
  const DepthRange found = depth_over(pair, in_a, in_b, {&still, 1}, 0, 0, kStandingPieces);
  return {found.seen_mm, found.place_M};
}

}  // namespace swarf::collision
