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

SWARF_KERNEL_INLINE void add_round(Extremes& out, const Lanes& lanes, const Place& at,
                                   const LanePiece::Round& round, const LaneQuery& query) {
  const LanePiece::Round r = round;
  const float up = kDepthAbove * query.half;
  for (int n = 0; n < kLanes; ++n) {
    const float dr = at.rho.lane[n] - r.centre_rho, dz = at.z.lane[n] - r.centre_z;
    const float length = kernel::max_of(std::sqrt(dr * dr + dz * dz), 1e-20F);
    const float from = dr * r.from_rho + dz * r.from_z, to = dr * r.to_rho + dz * r.to_z;
    const float end_rho = from > to ? r.from_rho : r.to_rho, end_z = from > to ? r.from_z : r.to_z;
    // Inside the wedge between its end normals the smaller of these is positive.
    const float inside = kernel::min_of(r.from_rho * dz - r.from_z * dr, dr * r.to_z - dz * r.to_rho);
    const float g_rho = inside > 0.0F ? dr / length : end_rho, g_z = inside > 0.0F ? dz / length : end_z;
    const float distance = dr * g_rho + dz * g_z - r.radius;
    out.add(n, excess_of(lanes, at, query, n, distance, g_rho, g_z), distance, distance + up * g_z);
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
  constexpr float kSlack = 2e-4F;  // mm; coordinates of up to a metre round to a third of it
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
  const float floor = query.floor, swallowed_to = -query.reach - kSlack;
  uint32_t open = 0, swallows = 0;
  for (int n = 0; n < kLanes; ++n) {
    const float above = extremes.above.lane[n] + kSlack;
    out.above.lane[n] = above;
    out.depth.lane[n] = -extremes.higher.lane[n];
    open |= above >= floor ? 1U << n : 0U;
    swallows |= extremes.value.lane[n] <= swallowed_to ? 1U << n : 0U;
  }
  out.open = open;
  out.swallows = swallows;
}

void judge_baseline(const Lanes& lanes, const LanePiece& piece, const LaneQuery& query, LaneAnswer& out) {
  judge(lanes, piece, query, out);
}

SWARF_X86_64_V3 void judge_v3(const Lanes& lanes, const LanePiece& piece, const LaneQuery& query,
                              LaneAnswer& out) {
  judge(lanes, piece, query, out);
}

SWARF_X86_64_V4_WIDE void judge_v4(const Lanes& lanes, const LanePiece& piece, const LaneQuery& query,
                                   LaneAnswer& out) {
  judge(lanes, piece, query, out);
}

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

std::span<const LaneKernelVariant> lane_kernel_variants() {
  static const std::vector<LaneKernelVariant> variants = runnable<LaneKernelVariant>(
      {"x86-64-v4", judge_v4}, {"x86-64-v3", judge_v3}, {"baseline", judge_baseline});
  return variants;
}

}  // namespace swarf::stock
