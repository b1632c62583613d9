#include "stock/lane_kernel.h"

#include <cmath>

#include "stock/sweep_distance.h"

namespace swarf::stock {
namespace {

using Lane = float[kLanes];

struct Points {
  alignas(64) float x[kLanes], y[kLanes], z[kLanes];
};

SWARF_KERNEL_INLINE void to_tool(Points& out, const float (&R)[3][3][kLanes], const float (&tip)[3][kLanes],
                                 const float* centre) {
  const float cx = centre[0], cy = centre[1], cz = centre[2];
  for (int n = 0; n < kLanes; ++n) {
    const float dx = cx - tip[0][n], dy = cy - tip[1][n], dz = cz - tip[2][n];
    out.x[n] = R[0][0][n] * dx + R[0][1][n] * dy + R[0][2][n] * dz;
    out.y[n] = R[1][0][n] * dx + R[1][1][n] * dy + R[1][2][n] * dz;
    out.z[n] = R[2][0][n] * dx + R[2][1][n] * dy + R[2][2][n] * dz;
  }
}

/// The outermost face or round of each lane and the next one: value and gradient (rho, z).
struct Outermost {
  alignas(64) float value[2][kLanes], rho[2][kLanes], z[2][kLanes];
};

SWARF_KERNEL_INLINE void insert(Outermost& o, int n, float value, float rho, float z) {
  const bool first = value > o.value[0][n];
  const bool second = value > o.value[1][n];
  o.value[1][n] = first ? o.value[0][n] : second ? value : o.value[1][n];
  o.rho[1][n] = first ? o.rho[0][n] : second ? rho : o.rho[1][n];
  o.z[1][n] = first ? o.z[0][n] : second ? z : o.z[1][n];
  o.value[0][n] = first ? value : o.value[0][n];
  o.rho[0][n] = first ? rho : o.rho[0][n];
  o.z[0][n] = first ? z : o.z[0][n];
}

SWARF_KERNEL_INLINE void add_face(Outermost& o, const Lane& rho, const Lane& z, const LanePiece::Face& face) {
  const float nr = face.rho, nz = face.z, offset = face.offset;
  for (int n = 0; n < kLanes; ++n) insert(o, n, nr * rho[n] + nz * z[n] - offset, nr, nz);
}

SWARF_KERNEL_INLINE void add_round(Outermost& o, const Lane& rho, const Lane& z, const LanePiece::Round& r) {
  const LanePiece::Round round = r;
  for (int n = 0; n < kLanes; ++n) {
    const float dr = rho[n] - round.centre_rho, dz = z[n] - round.centre_z;
    const float length = std::sqrt(dr * dr + dz * dz);
    const float inverse = 1.0F / kernel::max_of(length, 1e-20F);
    const bool within = (round.from_rho * dz - round.from_z * dr >= 0.0F) &
                        (dr * round.to_z - dz * round.to_rho >= 0.0F) & (length > 0.0F);
    const float from = dr * round.from_rho + dz * round.from_z, to = dr * round.to_rho + dz * round.to_z;
    const float nr = within ? dr * inverse : from > to ? round.from_rho : round.to_rho;
    const float nz = within ? dz * inverse : from > to ? round.from_z : round.to_z;
    insert(o, n, dr * nr + dz * nz - round.radius, nr, nz);
  }
}

/// Highest value that the bound of one face allows above the floor anywhere in the leaf.
SWARF_KERNEL_INLINE float above_floor(const Lanes& l, int n, const float* g, float value, float change,
                                      const LaneQuery& q) {
  float start = 0.0F, end = 0.0F;
  for (int c = 0; c < 3; ++c) {
    start +=
        std::abs(l.R0t[0][c][n] * g[0] + l.R0t[1][c][n] * g[1] + l.R0t[2][c][n] * g[2] + q.floor_slope[c]);
    end += std::abs(l.R1t[0][c][n] * g[0] + l.R1t[1][c][n] * g[1] + l.R1t[2][c][n] * g[2] + q.floor_slope[c]);
  }
  return kernel::max_of(change + q.half * start, q.half * end - change) - value;
}

SWARF_KERNEL_INLINE uint32_t packed(const uint8_t (&flags)[kLanes]) {
  uint32_t bits = 0;
  for (int n = 0; n < kLanes; ++n) bits |= static_cast<uint32_t>(flags[n]) << n;
  return bits;
}

SWARF_KERNEL_INLINE void judge(const Lanes& lanes, const LanePiece& piece, const LaneQuery& query,
                               LaneAnswer& out) {
  constexpr float kSlack = 2e-4F;  // mm; coordinates of up to a metre round to a third of it
  constexpr float kLowest = -1e30F;
  Points P, Q;
  to_tool(P, lanes.R0t, lanes.tip0, query.centre);
  to_tool(Q, lanes.R1t, lanes.tip1, query.centre);
  alignas(64) Lane rho, z;
  Outermost outer;
  for (int n = 0; n < kLanes; ++n) {
    const float x = 0.5F * (P.x[n] + Q.x[n]), y = 0.5F * (P.y[n] + Q.y[n]);
    rho[n] = std::sqrt(x * x + y * y);
    z[n] = 0.5F * (P.z[n] + Q.z[n]);
    for (int k = 0; k < 2; ++k) {
      outer.value[k][n] = kLowest;
      outer.rho[k][n] = 0.0F;
      outer.z[k][n] = 0.0F;
    }
  }
  for (const LanePiece::Face& face : piece.faces) add_face(outer, rho, z, face);
  for (const LanePiece::Round& round : piece.rounds) add_round(outer, rho, z, round);
  const LaneQuery q = query;
  uint8_t open[kLanes], swallows[kLanes];
  for (int n = 0; n < kLanes; ++n) {
    const float dx = Q.x[n] - P.x[n], dy = Q.y[n] - P.y[n], dz = Q.z[n] - P.z[n];
    const float inverse = 1.0F / kernel::max_of(rho[n], 1e-20F);
    // On the axis every direction is a subgradient; the zero of 0 * inverse is not, so x = 1 is taken there.
    const float ux = rho[n] > 0.0F ? 0.5F * (P.x[n] + Q.x[n]) * inverse : 1.0F;
    const float uy = 0.5F * (P.y[n] + Q.y[n]) * inverse;
    float least = 1e30F;
    for (int k = 0; k < 2; ++k) {
      const float g[3] = {outer.rho[k][n] * ux, outer.rho[k][n] * uy, outer.z[k][n]};
      const float change = 0.5F * (g[0] * dx + g[1] * dy + g[2] * dz);
      least = kernel::min_of(least, above_floor(lanes, n, g, outer.value[k][n], change, q));
    }
    open[n] = static_cast<uint8_t>(least + kSlack >= q.floor);
    swallows[n] = static_cast<uint8_t>(outer.value[0][n] + kSlack < -q.reach);
    out.distance[n] = outer.value[0][n];
  }
  out.open = packed(open);
  out.swallows = packed(swallows);
}

void judge_baseline(const Lanes& lanes, const LanePiece& piece, const LaneQuery& query, LaneAnswer& out) {
  judge(lanes, piece, query, out);
}

#ifdef SWARF_KERNEL_VARIANTS
__attribute__((target("arch=x86-64-v3"))) void judge_v3(const Lanes& lanes, const LanePiece& piece,
                                                        const LaneQuery& query, LaneAnswer& out) {
  judge(lanes, piece, query, out);
}
__attribute__((target("arch=x86-64-v4"))) void judge_v4(const Lanes& lanes, const LanePiece& piece,
                                                        const LaneQuery& query, LaneAnswer& out) {
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
