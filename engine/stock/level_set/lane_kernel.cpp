#include "stock/level_set/lane_kernel.h"

#include <cmath>

#include "stock/sweep/sweep_distance.h"

namespace swarf::stock {
namespace {

/// The leaf's centre in the tool frame at half time, the radial direction there, and its change during the
/// sweep.
struct Place {
  LaneFloats rho, z, ux, uy, dx, dy, dz;
};

SWARF_KERNEL_INLINE float component(const LaneFloats (&map)[3], const LaneFloats& shift, const float* centre,
                                    int n) {
  return map[0].lane[n] * centre[0] + map[1].lane[n] * centre[1] +
         (map[2].lane[n] * centre[2] + shift.lane[n]);
}

SWARF_KERNEL_INLINE void find_place(Place& at, const Lanes& lanes, const float* centre) {
  const float own[3] = {centre[0], centre[1], centre[2]};
  for (int n = 0; n < kLanes; ++n) {
    const float x = component(lanes.middle[0], lanes.middle_shift[0], own, n);
    const float y = component(lanes.middle[1], lanes.middle_shift[1], own, n);
    const float rho = std::sqrt(x * x + y * y);
    const float inverse = 1.0F / kernel::max_of(rho, 1e-20F);
    at.rho.lane[n] = rho;
    // On the axis 0 is a subgradient.
    at.ux.lane[n] = x * inverse;
    at.uy.lane[n] = y * inverse;
    at.z.lane[n] = component(lanes.middle[2], lanes.middle_shift[2], own, n);
    at.dx.lane[n] = component(lanes.change[0], lanes.change_shift[0], own, n);
    at.dy.lane[n] = component(lanes.change[1], lanes.change_shift[1], own, n);
    at.dz.lane[n] = component(lanes.change[2], lanes.change_shift[2], own, n);
  }
}

/// What a lane's distances round to at most, mm. Sixteen roundings count: of centre and map as they are
/// converted, of the products and sums of the three components, and of their product with a gradient.
struct Rounding {
  float of_centre;

  SWARF_KERNEL_INLINE explicit Rounding(const LaneQuery& query)
      : of_centre(2.0F *
                  (std::abs(query.centre[0]) + std::abs(query.centre[1]) + std::abs(query.centre[2]))) {}
  SWARF_KERNEL_INLINE float operator()(const Place& at, int n) const {
    constexpr float kRoundings = 16.0F * 6e-8F;
    return kRoundings * (of_centre + at.rho.lane[n] + std::abs(at.z.lane[n]));
  }
};

/// Over all faces and rounds: the least of how far their bounds rise above the floor anywhere in the leaf,
/// the greatest of their values at half time, and of those above the leaf.
struct Extremes {
  LaneFloats above, value, higher;

  SWARF_KERNEL_INLINE void add(int n, float excess, float distance, float distance_above) {
    above.lane[n] = kernel::min_of(above.lane[n], excess);
    value.lane[n] = kernel::max_of(value.lane[n], distance);
    higher.lane[n] = kernel::max_of(higher.lane[n], distance_above);
  }
};

/// What the bound of a face or round with distance and gradient (g_rho, g_z) at half time has over the floor.
/// With the gradient in W at half time; that at both ends differs from it by `turn` at most.
SWARF_KERNEL_INLINE float excess_of(const Lanes& lanes, const Place& at, const LaneQuery& query, int n,
                                    float distance, float g_rho, float g_z) {
  const float gx = g_rho * at.ux.lane[n], gy = g_rho * at.uy.lane[n];
  const float change = gx * at.dx.lane[n] + gy * at.dy.lane[n] + g_z * at.dz.lane[n];
  float sum = lanes.turn.lane[n];
  for (int c = 0; c < 3; ++c) {
    sum += std::abs(lanes.middle[0][c].lane[n] * gx + lanes.middle[1][c].lane[n] * gy +
                    (lanes.middle[2][c].lane[n] * g_z + query.floor_slope[c]));
  }
  return 0.5F * std::abs(change) + query.half * sum - distance;
}

SWARF_KERNEL_INLINE void add_slanted(Extremes& out, const Lanes& lanes, const Place& at,
                                     const LanePiece::Face& face, const LaneQuery& query) {
  const float g_rho = face.rho, g_z = face.z, offset = face.offset, up = kDepthAbove * query.half;
  for (int n = 0; n < kLanes; ++n) {
    const float distance = g_rho * at.rho.lane[n] + g_z * at.z.lane[n] - offset;
    out.add(n, excess_of(lanes, at, query, n, distance, g_rho, g_z), distance, distance + up * g_z);
  }
}

/// A face along the axis.
SWARF_KERNEL_INLINE void add_flank(Extremes& out, const Lanes& lanes, const Place& at, float radius,
                                   const LaneQuery& query) {
  for (int n = 0; n < kLanes; ++n) {
    const float distance = at.rho.lane[n] - radius;
    out.add(n, excess_of(lanes, at, query, n, distance, 1.0F, 0.0F), distance, distance);
  }
}

/// A face at right angles to the axis that looks down.
SWARF_KERNEL_INLINE void add_bottom(Extremes& out, const Lanes& lanes, const Place& at, float offset,
                                    const LaneQuery& query) {
  const float up = kDepthAbove * query.half;
  for (int n = 0; n < kLanes; ++n) {
    const float distance = -at.z.lane[n] - offset;
    float sum = lanes.turn.lane[n];
    for (int c = 0; c < 3; ++c) sum += std::abs(lanes.middle[2][c].lane[n] - query.floor_slope[c]);
    out.add(n, 0.5F * std::abs(at.dz.lane[n]) + query.half * sum - distance, distance, distance - up);
  }
}

/// One that looks up: the cutter's upper end, of which little comes near the surface. Bounded for any
/// attitude.
SWARF_KERNEL_INLINE void add_top(Extremes& out, const Place& at, float offset, const LaneQuery& query) {
  constexpr float kOfDiagonal = 1.7321F;
  float sum = kOfDiagonal;
  for (const float slope : query.floor_slope) sum += std::abs(slope);
  const float most = query.half * sum, up = kDepthAbove * query.half;
  for (int n = 0; n < kLanes; ++n) {
    const float distance = at.z.lane[n] - offset;
    out.add(n, 0.5F * std::abs(at.dz.lane[n]) + most - distance, distance, distance + up);
  }
}

/// How far a place lies outside of a face or round, and the gradient of that.
struct Support {
  float distance, g_rho, g_z;
};
SWARF_KERNEL_INLINE Support support_of(const LanePiece::Round& r, float rho, float z) {
  const float dr = rho - r.centre_rho, dz = z - r.centre_z;
  const float length = kernel::max_of(std::sqrt(dr * dr + dz * dz), 1e-20F);
  const float from = dr * r.from_rho + dz * r.from_z, to = dr * r.to_rho + dz * r.to_z;
  const float end_rho = from > to ? r.from_rho : r.to_rho, end_z = from > to ? r.from_z : r.to_z;
  // Inside the wedge between its end normals the smaller of these is positive.
  const float inside = kernel::min_of(r.from_rho * dz - r.from_z * dr, dr * r.to_z - dz * r.to_rho);
  const float g_rho = inside > 0.0F ? dr / length : end_rho, g_z = inside > 0.0F ? dz / length : end_z;
  return {dr * g_rho + dz * g_z - r.radius, g_rho, g_z};
}

SWARF_KERNEL_INLINE void add_round(Extremes& out, const Lanes& lanes, const Place& at,
                                   const LanePiece::Round& round, const LaneQuery& query) {
  const LanePiece::Round r = round;
  const float up = kDepthAbove * query.half;
  for (int n = 0; n < kLanes; ++n) {
    const Support s = support_of(r, at.rho.lane[n], at.z.lane[n]);
    out.add(n, excess_of(lanes, at, query, n, s.distance, s.g_rho, s.g_z), s.distance,
            s.distance + up * s.g_z);
  }
}

SWARF_KERNEL_INLINE void add_face(Extremes& out, const Lanes& lanes, const Place& at,
                                  const LanePiece::Face& face, const LaneQuery& query) {
  if (face.z == 0.0F) {
    add_flank(out, lanes, at, face.offset, query);
  } else if (face.rho != 0.0F) {
    add_slanted(out, lanes, at, face, query);
  } else if (face.z < 0.0F) {
    add_bottom(out, lanes, at, face.offset, query);
  } else {
    add_top(out, at, face.offset, query);
  }
}

SWARF_KERNEL_INLINE void judge(const Lanes& lanes, const LanePiece& piece, const LaneQuery& asked,
                               LaneAnswer& out) {
  constexpr float kSlack = 2e-5F;  // mm; what the leaf's own extent, floor and slope round to
  const LaneQuery query = asked;   // a local: the answer could alias it, which would stop vectorisation
  Place at;
  find_place(at, lanes, query.centre);
  Extremes extremes;
  for (int n = 0; n < kLanes; ++n) {
    extremes.above.lane[n] = 1e30F;
    extremes.value.lane[n] = extremes.higher.lane[n] = -1e30F;
  }
  for (const LanePiece::Face& face : piece.faces) add_face(extremes, lanes, at, face, query);
  for (const LanePiece::Round& round : piece.rounds) add_round(extremes, lanes, at, round, query);
  const Rounding rounding(query);
  const float floor = query.floor, swallowed_to = -query.reach;
  uint32_t verdicts = 0;  // joined: the bits of lanes are brought together one number at a time
  for (int n = 0; n < kLanes; ++n) {
    const float slack = kSlack + rounding(at, n);
    const float above = extremes.above.lane[n] + slack;
    out.above.lane[n] = above;
    out.depth.lane[n] = -extremes.higher.lane[n];
    const uint32_t open = above >= floor ? 1U << n : 0U;
    const uint32_t swallows = extremes.value.lane[n] + slack <= swallowed_to ? 1U << (n + kLanes) : 0U;
    verdicts |= open | swallows;
  }
  out.open = verdicts & kAllLanes;
  out.swallows = verdicts >> kLanes;
}

SWARF_KERNEL_INLINE uint32_t find_deepest(const LaneAnswer& answer, uint32_t open) {
  LaneFloats depth;
  for (int n = 0; n < kLanes; ++n) depth.lane[n] = (open >> n & 1U) != 0 ? answer.depth.lane[n] : -1e30F;
  float most = -1e30F;
  for (int n = 0; n < kLanes; ++n) most = kernel::max_of(most, depth.lane[n]);
  uint32_t deepest = 0;
  for (int n = 0; n < kLanes; ++n) deepest |= depth.lane[n] >= most ? 1U << n : 0U;
  return deepest & open;
}

/// Of each lane the faces or rounds that lie outermost.
struct Outermost {
  LaneFloats distance, g_rho, g_z;

  SWARF_KERNEL_INLINE void set(int n, const Support& support) {
    distance.lane[n] = support.distance;
    g_rho.lane[n] = support.g_rho;
    g_z.lane[n] = support.g_z;
  }
};

/// The outermost two.
struct TwoOutermost {
  Outermost first, second;

  SWARF_KERNEL_INLINE void add(int n, const Support& s) {
    const float d = first.distance.lane[n], r = first.g_rho.lane[n], z = first.g_z.lane[n];
    const bool over = s.distance > d, under = s.distance <= second.distance.lane[n];
    const Support lower{over ? d : s.distance, over ? r : s.g_rho, over ? z : s.g_z};
    first.set(n, {over ? s.distance : d, over ? s.g_rho : r, over ? s.g_z : z});
    second.set(n, {under ? second.distance.lane[n] : lower.distance,
                   under ? second.g_rho.lane[n] : lower.g_rho, under ? second.g_z.lane[n] : lower.g_z});
  }
};

SWARF_KERNEL_INLINE void find_outermost(TwoOutermost& out, const LanePiece& piece, const Place& at) {
  constexpr float kNone = -1e30F;
  for (int n = 0; n < kLanes; ++n) {
    out.first.set(n, {kNone, 0.0F, 0.0F});
    out.second.set(n, {kNone, 0.0F, 0.0F});
  }
  for (const LanePiece::Face& face : piece.faces) {
    const float rho = face.rho, z = face.z, offset = face.offset;
    for (int n = 0; n < kLanes; ++n) out.add(n, {rho * at.rho.lane[n] + z * at.z.lane[n] - offset, rho, z});
  }
  for (const LanePiece::Round& round : piece.rounds) {
    const LanePiece::Round r = round;
    for (int n = 0; n < kLanes; ++n) out.add(n, support_of(r, at.rho.lane[n], at.z.lane[n]));
  }
}

/// From the leaf's first voxel, per voxel.
SWARF_KERNEL_INLINE void set_linear(LaneBounds::Linear& out, const Lanes& lanes, const Place& at,
                                    const Outermost& face, const LaneQuery& query) {
  constexpr float kHalfLeaf = 0.5F * (kLeafSide - 1);
  const float half = query.half, voxel = half / kHalfLeaf;
  const Rounding rounding_of(query);
  for (int n = 0; n < kLanes; ++n) {
    const float g_rho = face.g_rho.lane[n], gz = face.g_z.lane[n];
    const float gx = g_rho * at.ux.lane[n], gy = g_rho * at.uy.lane[n];
    const float change = 0.5F * (gx * at.dx.lane[n] + gy * at.dy.lane[n] + gz * at.dz.lane[n]);
    const float rounding = rounding_of(at, n);
    float start = rounding + change - face.distance.lane[n], end = rounding - change - face.distance.lane[n];
    for (int a = 0; a < 3; ++a) {
      const float middle =
          lanes.middle[0][a].lane[n] * gx + lanes.middle[1][a].lane[n] * gy + lanes.middle[2][a].lane[n] * gz;
      const float turn = 0.5F * (lanes.change[0][a].lane[n] * gx + lanes.change[1][a].lane[n] * gy +
                                 lanes.change[2][a].lane[n] * gz);
      out.start_step[a].lane[n] = voxel * (turn - middle);
      out.end_step[a].lane[n] = -voxel * (turn + middle);
      start -= half * (turn - middle);
      end += half * (turn + middle);
    }
    out.start.lane[n] = start;
    out.end.lane[n] = end;
  }
}

SWARF_KERNEL_INLINE void bound(const Lanes& lanes, const LanePiece& piece, const LaneQuery& asked,
                               LaneBounds& out) {
  const LaneQuery query = asked;
  Place at;
  find_place(at, lanes, query.centre);
  TwoOutermost two;
  find_outermost(two, piece, at);
  set_linear(out.of_face[0], lanes, at, two.first, query);
  set_linear(out.of_face[1], lanes, at, two.second, query);
}

// NOLINTBEGIN(bugprone-macro-parentheses): an attribute cannot stand in parentheses
#define SWARF_LANE_VARIANT(name, attribute)                                                       \
  attribute void judge_##name(const Lanes& lanes, const LanePiece& piece, const LaneQuery& query, \
                              LaneAnswer& out) {                                                  \
    judge(lanes, piece, query, out);                                                              \
  }                                                                                               \
  attribute uint32_t deepest_##name(const LaneAnswer& answer, uint32_t open) {                    \
    return find_deepest(answer, open);                                                            \
  }                                                                                               \
  attribute void bound_##name(const Lanes& lanes, const LanePiece& piece, const LaneQuery& query, \
                              LaneBounds& out) {                                                  \
    bound(lanes, piece, query, out);                                                              \
  }

SWARF_LANE_VARIANT(baseline, )
SWARF_LANE_VARIANT(v3, SWARF_X86_64_V3)
SWARF_LANE_VARIANT(v4, SWARF_X86_64_V4_WIDE)
#undef SWARF_LANE_VARIANT
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace

LanePiece lane_piece(const cutter::ConvexPiece& piece) {
  LanePiece out;
  const auto f = [](double value) { return static_cast<float>(value); };
  for (const cutter::Face& face : piece.faces) {
    out.faces.push_back({f(face.normal.x()), f(face.normal.y()), f(face.offset)});
  }
  for (const cutter::Round& r : piece.rounds) {
    out.rounds.push_back({f(r.centre.x()), f(r.centre.y()), f(r.radius), f(r.from.x()), f(r.from.y()),
                          f(r.to.x()), f(r.to.y())});
  }
  return out;
}

LeafBound LaneBounds::lane(uint32_t n) const {
  LeafBound bound;
  for (int face = 0; face < 2; ++face) {
    const Linear& from = of_face[face];
    LeafBound::Linear& to = bound.of_face[face];
    to.start = from.start.lane[n];
    to.end = from.end.lane[n];
    for (int a = 0; a < 3; ++a) {
      to.start_step[a] = from.start_step[a].lane[n];
      to.end_step[a] = from.end_step[a].lane[n];
    }
  }
  return bound;
}

std::span<const LaneKernelVariant> lane_kernel_variants() {
  static const std::vector<LaneKernelVariant> variants = runnable<LaneKernelVariant>(
      {"x86-64-v4", judge_v4, deepest_v4, bound_v4}, {"x86-64-v3", judge_v3, deepest_v3, bound_v3},
      {"baseline", judge_baseline, deepest_baseline, bound_baseline});
  return variants;
}

}  // namespace swarf::stock
