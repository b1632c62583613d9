#include "stock/level_set/convex_leaf_kernel.h"

#include <cmath>
#include <vector>

#include "stock/level_set/leaf_kernel.h"
#include "stock/sweep/sweep_distance.h"

namespace swarf::stock {
namespace {

using kernel::clamp01;
using kernel::max_of;
using kernel::min_of;

constexpr int kSlice = kLeafSide * kLeafSide;
/// Of three steps one halves the bracket: 96 leave nothing of it that a float could tell apart.
constexpr int kMostSteps = 96;
constexpr float kTiny = 1e-20F;

/// 64 voxels of one x-slice on their way: position at t = 0 and change up to t = 1.
struct Lines {
  alignas(64) float px[kSlice], py[kSlice], pz[kSlice], dx[kSlice], dy[kSlice], dz[kSlice];
};
/// One instant per voxel with F and its slope there.
struct Tangents {
  alignas(64) float t[kSlice], value[kSlice], slope[kSlice];
};

SWARF_KERNEL_INLINE void fill_lines(Lines& lines, const ConvexLeaf& m, int slice) {
  const float x = static_cast<float>(slice);
  const float ax = m.start[0] + m.start_step[0][0] * x, bx = m.end[0] + m.end_step[0][0] * x;
  const float ay = m.start[1] + m.start_step[0][1] * x, by = m.end[1] + m.end_step[0][1] * x;
  const float az = m.start[2] + m.start_step[0][2] * x, bz = m.end[2] + m.end_step[0][2] * x;
  for (int j = 0; j < kSlice; ++j) {
    const float y = static_cast<float>(j / kLeafSide);
    const float z = static_cast<float>(j % kLeafSide);
    lines.px[j] = ax + (m.start_step[1][0] * y + m.start_step[2][0] * z);
    lines.py[j] = ay + (m.start_step[1][1] * y + m.start_step[2][1] * z);
    lines.pz[j] = az + (m.start_step[1][2] * y + m.start_step[2][2] * z);
    lines.dx[j] = bx + (m.end_step[1][0] * y + m.end_step[2][0] * z) - lines.px[j];
    lines.dy[j] = by + (m.end_step[1][1] * y + m.end_step[2][1] * z) - lines.py[j];
    lines.dz[j] = bz + (m.end_step[1][2] * y + m.end_step[2][2] * z) - lines.pz[j];
  }
}

/// Coordinates in the half plane (rho, z) and the rates at which they change.
struct HalfPlane {
  alignas(64) float rho[kSlice], z[kSlice], rho_rate[kSlice];
};

SWARF_KERNEL_INLINE void raise_by_round(const HalfPlane& at, const Lines& lines, const ConvexLeaf& leaf,
                                        int n, Tangents& out) {
  const float cx = leaf.round[n].x, cz = leaf.round[n].z, radius = leaf.round[n].radius;
  const float fx = leaf.round[n].from_x, fz = leaf.round[n].from_z;
  const float tx = leaf.round[n].to_x, tz = leaf.round[n].to_z;
  for (int j = 0; j < kSlice; ++j) {
    const float u = at.rho[j] - cx, w = at.z[j] - cz;
    const float length = max_of(std::sqrt(u * u + w * w), kTiny);
    const bool within = (fx * w - fz * u >= 0.0F) & (u * tz - w * tx >= 0.0F);
    const bool lower = u * fx + w * fz > u * tx + w * tz;
    const float nx = within ? u / length : (lower ? fx : tx);
    const float nz = within ? w / length : (lower ? fz : tz);
    const float value = u * nx + w * nz - radius;
    const float slope = nx * at.rho_rate[j] + nz * lines.dz[j];
    const bool greater = value > out.value[j];
    out.value[j] = greater ? value : out.value[j];
    out.slope[j] = greater ? slope : out.slope[j];
  }
}

/// F and its slope at the instants out.t.
SWARF_KERNEL_INLINE void evaluate(const Lines& lines, const ConvexLeaf& leaf, Tangents& out) {
  constexpr float kNoPart = -1e30F;  // a leaf that no part bounds lies deep inside all along
  HalfPlane at;
  for (int j = 0; j < kSlice; ++j) {
    const float x = lines.px[j] + out.t[j] * lines.dx[j];
    const float y = lines.py[j] + out.t[j] * lines.dy[j];
    at.z[j] = lines.pz[j] + out.t[j] * lines.dz[j];
    at.rho[j] = std::sqrt(x * x + y * y);
    at.rho_rate[j] = (x * lines.dx[j] + y * lines.dy[j]) / max_of(at.rho[j], kTiny);
    out.value[j] = kNoPart;
    out.slope[j] = 0.0F;
  }
  for (int n = 0; n < leaf.faces; ++n) {
    const float nx = leaf.face[n].x, nz = leaf.face[n].z, offset = leaf.face[n].offset;
    for (int j = 0; j < kSlice; ++j) {
      const float value = nx * at.rho[j] + nz * at.z[j] - offset;
      const float slope = nx * at.rho_rate[j] + nz * lines.dz[j];
      const bool greater = value > out.value[j];
      out.value[j] = greater ? value : out.value[j];
      out.slope[j] = greater ? slope : out.slope[j];
    }
  }
  for (int n = 0; n < leaf.rounds; ++n) raise_by_round(at, lines, leaf, n, out);
}

/// Where n.x rho + n.z z is least on the line. With rho = sqrt((y^2 + cross^2) / A), y = A t + B, the slope
/// is n.x sqrt(A) y / sqrt(y^2 + cross^2) + n.z dz: its zero is y = -n.z dz cross / sqrt(n.x^2 A - n.z^2
/// dz^2).
SWARF_KERNEL_INLINE float least_of_normal(const MovingPoint<float>& m, float nx, float nz) {
  const float a = m.dx * m.dx + m.dy * m.dy;
  const float b = m.px * m.dx + m.py * m.dy;
  const float cross = std::abs(m.px * m.dy - m.py * m.dx);
  const float fall = -nz * m.dz;
  const float k = nx * nx * a - fall * fall;
  const float inner = clamp01((fall * cross / std::sqrt(max_of(k, kTiny)) - b) / max_of(a, kTiny));
  // The height alone decides, or rests with rho: then any t is right, the one nearest to the axis among them.
  const float outer = fall > 0.0F ? 1.0F : (fall < 0.0F ? 0.0F : clamp01(-b / max_of(a, kTiny)));
  return k > 0.0F ? inner : outer;
}

SWARF_KERNEL_INLINE float least_of_ball(const MovingPoint<float>& m, float centre_z) {
  const float d2 = m.dx * m.dx + m.dy * m.dy + m.dz * m.dz;
  return clamp01(-(m.px * m.dx + m.py * m.dy + (m.pz - centre_z) * m.dz) / max_of(d2, kTiny));
}

SWARF_KERNEL_INLINE MovingPoint<float> moving_point(const Lines& lines, int j) {
  return {lines.px[j], lines.py[j], lines.pz[j], lines.dx[j], lines.dy[j], lines.dz[j]};
}

/// The hull of the parts' minimisers. Returns how many voxels have more than one point in it.
SWARF_KERNEL_INLINE int make_brackets(const Lines& lines, const ConvexLeaf& leaf, Tangents& low,
                                      Tangents& high) {
  for (int j = 0; j < kSlice; ++j) {
    low.t[j] = 1.0F;
    high.t[j] = 0.0F;
  }
  for (int n = 0; n < leaf.normals; ++n) {
    const float nx = leaf.normal[n].x, nz = leaf.normal[n].z;
    for (int j = 0; j < kSlice; ++j) {
      const float t = least_of_normal(moving_point(lines, j), nx, nz);
      low.t[j] = min_of(low.t[j], t);
      high.t[j] = max_of(high.t[j], t);
    }
  }
  if (leaf.has_ball) {
    const float ball_z = leaf.ball_z;
    for (int j = 0; j < kSlice; ++j) {
      const float t = least_of_ball(moving_point(lines, j), ball_z);
      low.t[j] = min_of(low.t[j], t);
      high.t[j] = max_of(high.t[j], t);
    }
  }
  int wide = 0;
  for (int j = 0; j < kSlice; ++j) wide += high.t[j] > low.t[j] ? 1 : 0;
  return wide;
}

/// Chooses the next instant in each bracket (by crossing tangents, secant of the slopes or halving, in turn).
/// Returns the number of voxels whose value is still open; 0 also when the sweep can no longer raise any.
/// That shortcut apart, the number of steps does not look at the row, so that what a sweep writes is a
/// function of the sweep and the leaf alone and the order of sweeps cannot show.
SWARF_KERNEL_INLINE int next_instants(const Tangents& low, const Tangents& high, const float* row,
                                      float tolerance, float background, int kind, Tangents& next) {
  const float crossing = kind == 0 ? 1.0F : 0.0F, secant = kind == 1 ? 1.0F : 0.0F;
  const float middle = kind == 2 ? 0.5F : 0.0F;
  int open = 0, raising = 0;
  for (int j = 0; j < kSlice; ++j) {
    const float width = high.t[j] - low.t[j];
    const float change = max_of(high.slope[j] - low.slope[j], kTiny);
    const float step = (low.value[j] - high.value[j] + high.slope[j] * width) / change;
    const float floor = low.value[j] + low.slope[j] * step;
    const float least = min_of(low.value[j], high.value[j]);
    const bool falling = (low.slope[j] < 0.0F) & (high.slope[j] > 0.0F);
    const bool in_band = (floor < background) & (least > -background);
    open += (falling & in_band & (least - floor > tolerance)) ? 1 : 0;
    // The tolerance is above the rounding of the floor.
    raising += (falling ? floor : least) - tolerance < -row[j] ? 1 : 0;
    const float inside = crossing * step + width * (secant * (-low.slope[j] / change) + middle);
    next.t[j] = low.t[j] + min_of(max_of(inside, 0.0F), width);
  }
  return raising > 0 ? open : 0;
}

SWARF_KERNEL_INLINE void shrink(const Tangents& next, Tangents& low, Tangents& high) {
  for (int j = 0; j < kSlice; ++j) {
    const float t = next.t[j], value = next.value[j], slope = next.slope[j];
    const float low_t = low.t[j], low_value = low.value[j], low_slope = low.slope[j];
    const float high_t = high.t[j], high_value = high.value[j], high_slope = high.slope[j];
    low.t[j] = slope < 0.0F ? t : low_t;
    low.value[j] = slope < 0.0F ? value : low_value;
    low.slope[j] = slope < 0.0F ? slope : low_slope;
    high.t[j] = slope < 0.0F ? high_t : t;
    high.value[j] = slope < 0.0F ? high_value : value;
    high.slope[j] = slope < 0.0F ? high_slope : slope;
  }
}

SWARF_KERNEL_INLINE int cut_slice(float* row, const Lines& lines, const ConvexLeaf& leaf) {
  const float background = leaf.background, tolerance = leaf.tolerance;
  Tangents low, high, next;
  const int wide = make_brackets(lines, leaf, low, high);
  evaluate(lines, leaf, low);
  int evaluated = kSlice;
  if (wide > 0) {
    evaluate(lines, leaf, high);
    evaluated += kSlice;
    for (int step = 0; step < kMostSteps; ++step) {
      if (next_instants(low, high, row, tolerance, background, step % 3, next) == 0) break;
      evaluate(lines, leaf, next);
      evaluated += kSlice;
      shrink(next, low, high);
    }
  } else {
    high = low;
  }
  for (int j = 0; j < kSlice; ++j) {
    row[j] = max_of(row[j], min_of(-min_of(low.value[j], high.value[j]), background));
  }
  return evaluated;
}

SWARF_KERNEL_INLINE int cut_leaf(float* values, const ConvexLeaf& leaf, uint32_t slices) {
  int evaluated = 0;
  Lines lines;
  for (int x = 0; x < kLeafSide; ++x) {
    if ((slices >> x & 1U) == 0) continue;
    fill_lines(lines, leaf, x);
    evaluated += cut_slice(values + x * kSlice, lines, leaf);
  }
  return evaluated;
}

int cut_leaf_baseline(float* values, const ConvexLeaf& leaf, uint32_t slices) {
  return cut_leaf(values, leaf, slices);
}

SWARF_X86_64_V3 int cut_leaf_v3(float* values, const ConvexLeaf& leaf, uint32_t slices) {
  return cut_leaf(values, leaf, slices);
}

SWARF_X86_64_V4 int cut_leaf_v4(float* values, const ConvexLeaf& leaf, uint32_t slices) {
  return cut_leaf(values, leaf, slices);
}

}  // namespace

std::span<const ConvexKernelVariant> convex_kernel_variants() {
  static const std::vector<ConvexKernelVariant> variants = runnable<ConvexKernelVariant>(
      {"x86-64-v4", cut_leaf_v4}, {"x86-64-v3", cut_leaf_v3}, {"baseline", cut_leaf_baseline});
  return variants;
}

}  // namespace swarf::stock
