#include "stock/lane_kernel.h"

#include <cmath>
#include <cstring>

#include "stock/sweep_distance.h"

namespace swarf::stock {
namespace {

/// Floats in one register; the attribute takes no template argument.
template <int kWidth>
struct FloatVector;
template <>
struct FloatVector<4> {
  using type = float __attribute__((vector_size(16)));
};
template <>
struct FloatVector<8> {
  using type = float __attribute__((vector_size(32)));
};
template <>
struct FloatVector<16> {
  using type = float __attribute__((vector_size(64)));
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
  /// The outermost one of each lane and the next.
  struct Outermost {
    Bound first, second;
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

  static SWARF_KERNEL_INLINE Point to_tool(const LaneFloats (&R)[3][3], const LaneFloats (&tip)[3], int from,
                                           const float* centre) {
    const V x = centre[0] - load(tip[0], from), y = centre[1] - load(tip[1], from),
            z = centre[2] - load(tip[2], from);
    const auto row = [&](int r) __attribute__((always_inline)) {
      return load(R[r][0], from) * x + load(R[r][1], from) * y + load(R[r][2], from) * z;
    };
    return {row(0), row(1), row(2)};
  }

  // Each comparison stands where it is used: kept as a variable it would leave the mask registers.
  static SWARF_KERNEL_INLINE void insert(Outermost& o, const Bound& b) {
    const V a = o.first.value;
    const Bound rest{b.value > a ? a : b.value, b.value > a ? o.first.rho : b.rho,
                     b.value > a ? o.first.z : b.z};
    o.first = {b.value > a ? b.value : a, b.value > a ? b.rho : o.first.rho, b.value > a ? b.z : o.first.z};
    const V c = o.second.value;
    o.second = {rest.value > c ? rest.value : c, rest.value > c ? rest.rho : o.second.rho,
                rest.value > c ? rest.z : o.second.z};
  }

  static SWARF_KERNEL_INLINE Bound face_bound(const LanePiece::Face& face, V rho, V z) {
    return {face.rho * rho + face.z * z - face.offset, all(face.rho), all(face.z)};
  }

  static SWARF_KERNEL_INLINE Bound round_bound(const LanePiece::Round& r, V rho, V z) {
    const V dr = rho - r.centre_rho, dz = z - r.centre_z;
    const V length = max_of(root(dr * dr + dz * dz), all(1e-20F));
    const V from = dr * r.from_rho + dz * r.from_z, to = dr * r.to_rho + dz * r.to_z;
    const V end_rho = from > to ? all(r.from_rho) : all(r.to_rho),
            end_z = from > to ? all(r.from_z) : all(r.to_z);
    // Inside the wedge between its end normals the smaller of these is positive.
    const V inside = min_of(r.from_rho * dz - r.from_z * dr, dr * r.to_z - dz * r.to_rho);
    const V rho_n = inside > 0.0F ? dr / length : end_rho, z_n = inside > 0.0F ? dz / length : end_z;
    return {dr * rho_n + dz * z_n - r.radius, rho_n, z_n};
  }

  /// Greatest excess of a linear bound with tool-frame gradient g over the floor's slope, within the leaf.
  static SWARF_KERNEL_INLINE V spread(const LaneFloats (&R)[3][3], int from, const Point& g,
                                      const LaneQuery& q) {
    V sum{};
    for (int c = 0; c < 3; ++c) {
      const V slope = load(R[0][c], from) * g.x + load(R[1][c], from) * g.y + load(R[2][c], from) * g.z;
      sum += max_of(slope + q.floor_slope[c], -slope - q.floor_slope[c]);
    }
    return q.half * sum;
  }

  static SWARF_KERNEL_INLINE auto bits_of_lanes() {
    decltype(V{} >= V{}) bits;
    for (int n = 0; n < kWidth; ++n) bits[n] = 1 << n;
    return bits;
  }
  /// Bit n: a[n] >= level.
  static SWARF_KERNEL_INLINE uint32_t at_least(V a, float level) {
    int32_t flag[kWidth];
    const auto flags = (a >= level) & bits_of_lanes();
    std::memcpy(flag, &flags, sizeof(flag));
    int32_t bits = 0;
    for (int n = 0; n < kWidth; ++n) bits += flag[n];
    return static_cast<uint32_t>(bits);
  }

  static SWARF_KERNEL_INLINE void lanes_from(int from, const Lanes& lanes, const LanePiece& piece,
                                             const LaneQuery& query, LaneAnswer& out) {
    constexpr float kSlack = 2e-4F;  // mm; coordinates of up to a metre round to a third of it
    const Point P = to_tool(lanes.R0t, lanes.tip0, from, query.centre);
    const Point Q = to_tool(lanes.R1t, lanes.tip1, from, query.centre);
    const V x = 0.5F * (P.x + Q.x), y = 0.5F * (P.y + Q.y), z = 0.5F * (P.z + Q.z);
    const V rho = root(x * x + y * y);
    const Bound lowest{all(-1e30F), V{}, V{}};
    Outermost outer{lowest, lowest};
    for (const LanePiece::Face& face : piece.faces) insert(outer, face_bound(face, rho, z));
    for (const LanePiece::Round& round : piece.rounds) insert(outer, round_bound(round, rho, z));
    // On the axis every direction is a subgradient.
    const V inverse = 1.0F / max_of(rho, all(1e-20F));
    const V ux = rho > 0.0F ? x * inverse : all(1.0F), uy = y * inverse;
    const auto above_floor = [&](const Bound& bound) __attribute__((always_inline)) {
      const Point g{bound.rho * ux, bound.rho * uy, bound.z};
      const V change = 0.5F * (g.x * (Q.x - P.x) + g.y * (Q.y - P.y) + g.z * (Q.z - P.z));
      return max_of(change + spread(lanes.R0t, from, g, query), spread(lanes.R1t, from, g, query) - change) -
             bound.value;
    };
    const V above = min_of(above_floor(outer.first), above_floor(outer.second));
    const V depth = -outer.first.value;
    out.open |= at_least(above, query.floor - kSlack) << from;
    out.swallows |= at_least(depth, query.reach + kSlack) << from;
    std::memcpy(out.depth.lane + from, &depth, sizeof(depth));
  }

  static SWARF_KERNEL_INLINE void all_lanes(const Lanes& lanes, const LanePiece& piece,
                                            const LaneQuery& query, LaneAnswer& out) {
    out.open = out.swallows = 0;
    for (int from = 0; from < kLanes; from += kWidth) lanes_from(from, lanes, piece, query, out);
  }
};

void judge_baseline(const Lanes& lanes, const LanePiece& piece, const LaneQuery& query, LaneAnswer& out) {
  Judge<4>::all_lanes(lanes, piece, query, out);
}

#ifdef SWARF_KERNEL_VARIANTS
__attribute__((target("arch=x86-64-v3"))) void judge_v3(const Lanes& lanes, const LanePiece& piece,
                                                        const LaneQuery& query, LaneAnswer& out) {
  Judge<8>::all_lanes(lanes, piece, query, out);
}
__attribute__((target("arch=x86-64-v4,prefer-vector-width=512"))) void judge_v4(const Lanes& lanes,
                                                                                const LanePiece& piece,
                                                                                const LaneQuery& query,
                                                                                LaneAnswer& out) {
  Judge<16>::all_lanes(lanes, piece, query, out);
}
#endif

std::vector<LaneKernelVariant> supported_variants() {
  std::vector<LaneKernelVariant> variants;
#ifdef SWARF_KERNEL_VARIANTS
  if (__builtin_cpu_supports("x86-64-v4")) variants.push_back({"x86-64-v4", judge_v4});
  if (__builtin_cpu_supports("x86-64-v3")) variants.push_back({"x86-64-v3", judge_v3});
#endif
  variants.push_back({"baseline", judge_baseline});
  return variants;
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
  static const std::vector<LaneKernelVariant> variants = supported_variants();
  return variants;
}

}  // namespace swarf::stock
