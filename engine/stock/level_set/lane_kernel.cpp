#include "stock/level_set/lane_kernel.h"

#include <cmath>
#include <cstring>

#include "stock/sweep/sweep_distance.h"

namespace swarf::stock {
namespace {

/// Floats in one register; the attribute takes no template argument.
template <int kWidth>
struct FloatVector;
template <>
struct FloatVector<4> {
  using type = float __attribute__((vector_size(16)));
  using bits = int32_t __attribute__((vector_size(16)));
};
template <>
struct FloatVector<8> {
  using type = float __attribute__((vector_size(32)));
  using bits = int32_t __attribute__((vector_size(32)));
};
template <>
struct FloatVector<16> {
  using type = float __attribute__((vector_size(64)));
  using bits = int32_t __attribute__((vector_size(64)));
};

/// The arithmetic for kWidth lanes at a time: as many as one register of the instruction set holds. Wider
/// vectors than that the compiler takes apart into single floats.
template <int kWidth>
struct Judge {
  using V = typename FloatVector<kWidth>::type;

  struct Point {
    V x, y, z;
  };
  /// A face or round: value and gradient (rho, z).
  struct Bound {
    V value, rho, z;
  };
  static SWARF_KERNEL_INLINE V load(const LaneFloats& floats, int from) {
    V v;
    std::memcpy(&v, floats.lane + from, sizeof(v));
    return v;
  }
  static SWARF_KERNEL_INLINE V all(float value) { return V{} + value; }
  static SWARF_KERNEL_INLINE V max_of(V a, V b) { return a > b ? a : b; }
  static SWARF_KERNEL_INLINE V min_of(V a, V b) { return a < b ? a : b; }
  static SWARF_KERNEL_INLINE V root(V a) {
    V result;
    for (int n = 0; n < kWidth; ++n) result[n] = std::sqrt(a[n]);
    return result;
  }

  /// a where x is positive, else b. By the sign's bit: gcc takes comparisons of vectors that are wider than
  /// the baseline's apart, but for those that amount to a maximum.
  static SWARF_KERNEL_INLINE V choose(V x, V a, V b) {
    using Bits = typename FloatVector<kWidth>::bits;
    constexpr float kLeast = 1e-30F;
    constexpr int kSignBit = 31;
    const Bits other = reinterpret_cast<Bits>(x - kLeast) >> kSignBit;
    return reinterpret_cast<V>((reinterpret_cast<Bits>(a) & ~other) | (reinterpret_cast<Bits>(b) & other));
  }

  static SWARF_KERNEL_INLINE Point to_tool(const LaneFloats (&R)[3][3], const LaneFloats (&tip)[3], int from,
                                           const float* centre) {
    const V x = centre[0] - load(tip[0], from), y = centre[1] - load(tip[1], from),
            z = centre[2] - load(tip[2], from);
    const auto row = [&](int r) __attribute__((always_inline)) {
      return load(R[r][0], from) * x + load(R[r][1], from) * y + load(R[r][2], from) * z;
    };
    return {row(0), row(1), row(2)};
  }

  static SWARF_KERNEL_INLINE Bound round_bound(const LanePiece::Round& r, V rho, V z) {
    const V dr = rho - r.centre_rho, dz = z - r.centre_z;
    const V length = max_of(root(dr * dr + dz * dz), all(1e-20F));
    const V from = dr * r.from_rho + dz * r.from_z, to = dr * r.to_rho + dz * r.to_z;
    const V end_rho = choose(from - to, all(r.from_rho), all(r.to_rho)),
            end_z = choose(from - to, all(r.from_z), all(r.to_z));
    // Inside the wedge between its end normals the smaller of these is positive.
    const V inside = min_of(r.from_rho * dz - r.from_z * dr, dr * r.to_z - dz * r.to_rho);
    const V rho_n = choose(inside, dr / length, end_rho), z_n = choose(inside, dz / length, end_z);
    return {dr * rho_n + dz * z_n - r.radius, rho_n, z_n};
  }

  static SWARF_KERNEL_INLINE V magnitude(V a) { return max_of(a, -a); }

  /// Greatest excess of a linear bound with tool-frame gradient g over the floor's slope, within the leaf.
  static SWARF_KERNEL_INLINE V spread(const LaneFloats (&R)[3][3], int from, const Point& g,
                                      const LaneQuery& q) {
    V sum{};
    for (int c = 0; c < 3; ++c) {
      sum += magnitude(load(R[0][c], from) * g.x + load(R[1][c], from) * g.y + load(R[2][c], from) * g.z +
                       q.floor_slope[c]);
    }
    return q.half * sum;
  }
  /// The same for g = (0, 0, z).
  static SWARF_KERNEL_INLINE V spread(const LaneFloats (&R)[3][3], int from, float z, const LaneQuery& q) {
    V sum{};
    for (int c = 0; c < 3; ++c) sum += magnitude(load(R[2][c], from) * z + q.floor_slope[c]);
    return q.half * sum;
  }

  /// The leaf's centre in the tool frames at both ends, and the radial direction at half time.
  struct Place {
    Point P, Q;
    V rho, z, ux, uy;
  };
  static SWARF_KERNEL_INLINE Place place(const Lanes& lanes, int from, const float* centre) {
    const Point P = to_tool(lanes.R0t, lanes.tip0, from, centre);
    const Point Q = to_tool(lanes.R1t, lanes.tip1, from, centre);
    const V x = 0.5F * (P.x + Q.x), y = 0.5F * (P.y + Q.y);
    const V rho = root(x * x + y * y);
    const V inverse = 1.0F / max_of(rho, all(1e-20F));
    // On the axis 0 is a subgradient.
    return {P, Q, rho, 0.5F * (P.z + Q.z), x * inverse, y * inverse};
  }

  /// How far a face's or round's bound rises above the floor anywhere in the leaf.
  static SWARF_KERNEL_INLINE V above_floor(const Lanes& lanes, int from, const Place& at, const Bound& bound,
                                           const LaneQuery& query) {
    const Point g{bound.rho * at.ux, bound.rho * at.uy, bound.z};
    const V change = 0.5F * (g.x * (at.Q.x - at.P.x) + g.y * (at.Q.y - at.P.y) + g.z * (at.Q.z - at.P.z));
    return max_of(change + spread(lanes.R0t, from, g, query), spread(lanes.R1t, from, g, query) - change) -
           bound.value;
  }
  /// The same for a face at right angles to the axis.
  static SWARF_KERNEL_INLINE V above_floor(const Lanes& lanes, int from, const Place& at, float nz, V value,
                                           const LaneQuery& query) {
    const V change = (0.5F * nz) * (at.Q.z - at.P.z);
    return max_of(change + spread(lanes.R0t, from, nz, query), spread(lanes.R1t, from, nz, query) - change) -
           value;
  }

  /// What decides about the lanes.
  struct Verdicts {
    alignas(64) float above[kLanes], depth[kLanes];
  };

  static SWARF_KERNEL_INLINE void lanes_from(int from, const Lanes& lanes, const LanePiece& piece,
                                             const LaneQuery& query, Verdicts& verdicts, LaneAnswer& out) {
    const Place at = place(lanes, from, query.centre);
    const float up = kDepthAbove * query.half;
    V above = all(1e30F), value = all(-1e30F), higher = all(-1e30F);
    for (const LanePiece::Face& face : piece.faces) {
      const V distance = face.rho * at.rho + face.z * at.z - face.offset;
      const V excess = face.rho == 0.0F
                           ? above_floor(lanes, from, at, face.z, distance, query)
                           : above_floor(lanes, from, at, {distance, all(face.rho), all(face.z)}, query);
      above = min_of(above, excess);
      value = max_of(value, distance);
      higher = max_of(higher, distance + up * face.z);
    }
    for (const LanePiece::Round& round : piece.rounds) {
      const Bound bound = round_bound(round, at.rho, at.z);
      above = min_of(above, above_floor(lanes, from, at, bound, query));
      value = max_of(value, bound.value);
      higher = max_of(higher, bound.value + up * bound.z);
    }
    const V depth = -value, depth_above = -higher;
    std::memcpy(verdicts.above + from, &above, sizeof(above));
    std::memcpy(verdicts.depth + from, &depth, sizeof(depth));
    std::memcpy(out.depth.lane + from, &depth_above, sizeof(depth_above));
  }

  static SWARF_KERNEL_INLINE void all_lanes(const Lanes& lanes, const LanePiece& piece,
                                            const LaneQuery& query, LaneAnswer& out) {
    constexpr float kSlack = 2e-4F;  // mm; coordinates of up to a metre round to a third of it
    Verdicts verdicts;
    for (int from = 0; from < kLanes; from += kWidth) lanes_from(from, lanes, piece, query, verdicts, out);
    const float open_from = query.floor - kSlack, swallowed_from = query.reach + kSlack;
    uint32_t open = 0, swallows = 0;
    for (int n = 0; n < kLanes; ++n) {
      open |= verdicts.above[n] >= open_from ? 1U << n : 0U;
      swallows |= verdicts.depth[n] >= swallowed_from ? 1U << n : 0U;
    }
    out.open = open;
    out.swallows = swallows;
  }
};

void judge_baseline(const Lanes& lanes, const LanePiece& piece, const LaneQuery& query, LaneAnswer& out) {
  Judge<4>::all_lanes(lanes, piece, query, out);
}

SWARF_X86_64_V3 void judge_v3(const Lanes& lanes, const LanePiece& piece, const LaneQuery& query,
                              LaneAnswer& out) {
  Judge<8>::all_lanes(lanes, piece, query, out);
}

SWARF_X86_64_V4_WIDE void judge_v4(const Lanes& lanes, const LanePiece& piece, const LaneQuery& query,
                                   LaneAnswer& out) {
  Judge<16>::all_lanes(lanes, piece, query, out);
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
