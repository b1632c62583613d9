#include "stock/lane_kernel.h"

#include <cmath>
#include <cstring>

#include "stock/sweep_distance.h"

namespace swarf::stock {
namespace {

using V = LaneVector;
using Mask = int32_t __attribute__((vector_size(kLanes * sizeof(int32_t))));

SWARF_KERNEL_INLINE V max_of(V a, V b) {
  return a > b ? a : b;
}
SWARF_KERNEL_INLINE V min_of(V a, V b) {
  return a < b ? a : b;
}
SWARF_KERNEL_INLINE V magnitude(V a) {
  return max_of(a, -a);
}
SWARF_KERNEL_INLINE V root(V a) {
  V result;
  for (int n = 0; n < kLanes; ++n) result[n] = std::sqrt(a[n]);
  return result;
}

struct Point {
  V x, y, z;
};

SWARF_KERNEL_INLINE Point to_tool(const V (&R)[3][3], const V (&tip)[3], const float* centre) {
  const V dx = centre[0] - tip[0], dy = centre[1] - tip[1], dz = centre[2] - tip[2];
  return {R[0][0] * dx + R[0][1] * dy + R[0][2] * dz, R[1][0] * dx + R[1][1] * dy + R[1][2] * dz,
          R[2][0] * dx + R[2][1] * dy + R[2][2] * dz};
}

/// A face or round: value and gradient (rho, z).
struct Bound {
  V value, rho, z;
};
/// The outermost one of each lane and the next.
struct Outermost {
  Bound first, second;
};
// Each comparison stands where it is used: kept as a variable it would leave the mask registers.
SWARF_KERNEL_INLINE void insert(Outermost& o, const Bound& b) {
  const V a = o.first.value;
  const Bound rest{b.value > a ? a : b.value, b.value > a ? o.first.rho : b.rho,
                   b.value > a ? o.first.z : b.z};
  o.first = {b.value > a ? b.value : a, b.value > a ? b.rho : o.first.rho, b.value > a ? b.z : o.first.z};
  const V c = o.second.value;
  o.second = {rest.value > c ? rest.value : c, rest.value > c ? rest.rho : o.second.rho,
              rest.value > c ? rest.z : o.second.z};
}

SWARF_KERNEL_INLINE Bound face_bound(const LanePiece::Face& face, V rho, V z) {
  const V zero{};
  return {face.rho * rho + face.z * z - face.offset, zero + face.rho, zero + face.z};
}

SWARF_KERNEL_INLINE Bound round_bound(const LanePiece::Round& r, V rho, V z) {
  const V zero{};
  const V dr = rho - r.centre_rho, dz = z - r.centre_z;
  const V length = root(dr * dr + dz * dz);
  const V inverse = 1.0F / max_of(length, zero + 1e-20F);
  const Mask within =
      (r.from_rho * dz - r.from_z * dr >= 0.0F) & (dr * r.to_z - dz * r.to_rho >= 0.0F) & (length > 0.0F);
  const V from = dr * r.from_rho + dz * r.from_z, to = dr * r.to_rho + dz * r.to_z;
  const Mask lower = from > to;
  const V nr = within ? dr * inverse : (lower ? zero + r.from_rho : zero + r.to_rho);
  const V nz = within ? dz * inverse : (lower ? zero + r.from_z : zero + r.to_z);
  return {dr * nr + dz * nz - r.radius, nr, nz};
}

/// Greatest excess of a linear bound with tool-frame gradient g over the floor's slope, within the leaf.
SWARF_KERNEL_INLINE V spread(const V (&R)[3][3], const Point& g, const LaneQuery& q) {
  V sum{};
  for (int c = 0; c < 3; ++c) {
    sum += magnitude(R[0][c] * g.x + R[1][c] * g.y + R[2][c] * g.z + q.floor_slope[c]);
  }
  return q.half * sum;
}

/// Bit n: a[n] >= level.
SWARF_KERNEL_INLINE uint32_t at_least(V a, float level) {
  alignas(sizeof(V)) float value[kLanes];
  std::memcpy(value, &a, sizeof(value));
  int32_t bits = 0;
  for (int n = 0; n < kLanes; ++n) bits += value[n] >= level ? 1 << n : 0;
  return static_cast<uint32_t>(bits);
}

SWARF_KERNEL_INLINE void judge(const Lanes& lanes, const LanePiece& piece, const LaneQuery& query,
                               LaneAnswer& out) {
  constexpr float kSlack = 2e-4F;  // mm; coordinates of up to a metre round to a third of it
  const V zero{};
  const Point P = to_tool(lanes.R0t, lanes.tip0, query.centre),
              Q = to_tool(lanes.R1t, lanes.tip1, query.centre);
  const V x = 0.5F * (P.x + Q.x), y = 0.5F * (P.y + Q.y), z = 0.5F * (P.z + Q.z);
  const V rho = root(x * x + y * y);
  const Bound lowest{zero - 1e30F, zero, zero};
  Outermost outer{lowest, lowest};
  for (const LanePiece::Face& face : piece.faces) insert(outer, face_bound(face, rho, z));
  for (const LanePiece::Round& round : piece.rounds) insert(outer, round_bound(round, rho, z));
  // On the axis every direction is a subgradient.
  const V inverse = 1.0F / max_of(rho, zero + 1e-20F);
  const V ux = rho > 0.0F ? x * inverse : zero + 1.0F, uy = y * inverse;
  const auto above_floor = [&](const Bound& bound) {
    const Point g{bound.rho * ux, bound.rho * uy, bound.z};
    const V change = 0.5F * (g.x * (Q.x - P.x) + g.y * (Q.y - P.y) + g.z * (Q.z - P.z));
    return max_of(change + spread(lanes.R0t, g, query), spread(lanes.R1t, g, query) - change) - bound.value;
  };
  const V above = min_of(above_floor(outer.first), above_floor(outer.second));
  out.open = at_least(above, query.floor - kSlack);
  out.swallows = at_least(-outer.first.value, query.reach + kSlack);
  out.depth = -outer.first.value;
}

void judge_baseline(const Lanes& lanes, const LanePiece& piece, const LaneQuery& query, LaneAnswer& out) {
  judge(lanes, piece, query, out);
}

#ifdef SWARF_KERNEL_VARIANTS
__attribute__((target("arch=x86-64-v3"))) void judge_v3(const Lanes& lanes, const LanePiece& piece,
                                                        const LaneQuery& query, LaneAnswer& out) {
  judge(lanes, piece, query, out);
}
__attribute__((target("arch=x86-64-v4,prefer-vector-width=512"))) void judge_v4(const Lanes& lanes,
                                                                                const LanePiece& piece,
                                                                                const LaneQuery& query,
                                                                                LaneAnswer& out) {
  judge(lanes, piece, query, out);
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
