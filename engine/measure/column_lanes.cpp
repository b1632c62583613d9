#include "measure/column_lanes.h"

#include <cmath>
#include <limits>
#include <vector>

#include "measure/height_bounds.h"
#include "measure/lane_numbers.h"

namespace swarf::measure {
namespace {

using T = Numbers<4>;

struct Points {
  T x, y, z;
};

SWARF_KERNEL_INLINE T square_roots(const T& x) {
  T root;
  for (int i = 0; i < 4; ++i) root[i] = std::sqrt(x[i]);
  return root;
}

SWARF_KERNEL_INLINE Points points_of(const std::array<ColumnNumbers, 3>& points) {
  return {load<T>(points[0].lane), load<T>(points[1].lane), load<T>(points[2].lane)};
}
SWARF_KERNEL_INLINE Points between(const Points& start, const Points& end, const T& t) {
  return {(1.0 - t) * start.x + t * end.x, (1.0 - t) * start.y + t * end.y, (1.0 - t) * start.z + t * end.z};
}

/// Of each column; summed as Eigen sums a product: two rows at once by columns, the third by halves.
SWARF_KERNEL_INLINE void turn(const double* R, const Points& v, std::array<ColumnNumbers, 3>& turned) {
  for (size_t row = 0; row < 2; ++row)
    store<T>((R[row] * v.x + R[3 + row] * v.y) + R[6 + row] * v.z, turned[row].lane);
  store<T>(R[2] * v.x + (R[5] * v.y + R[8] * v.z), turned[2].lane);
}

SWARF_KERNEL_INLINE void columns_of(const stock::SweepMap& map, const std::array<CellCorner, 3>& columns,
                                    ColumnLanes& lanes) {
  const auto gather = [&](const Vec3 CellCorner::*part, int c) {
    const double first = (columns[0].*part).data()[c];
    return T{first, (columns[1].*part).data()[c], (columns[2].*part).data()[c], first};
  };
  const double *tip0 = map.tip0.data(), *tip1 = map.tip1.data();
  const T x = gather(&CellCorner::point, 0), y = gather(&CellCorner::point, 1),
          z = gather(&CellCorner::point, 2);
  const Points ways{gather(&CellCorner::normal, 0), gather(&CellCorner::normal, 1),
                    gather(&CellCorner::normal, 2)};
  turn(map.R0t.data(), {x - tip0[0], y - tip0[1], z - tip0[2]}, lanes.foot_at_start);
  turn(map.R1t.data(), {x - tip1[0], y - tip1[1], z - tip1[2]}, lanes.foot_at_end);
  turn(map.R0t.data(), ways, lanes.way_at_start);
  turn(map.R1t.data(), ways, lanes.way_at_end);
}

SWARF_KERNEL_INLINE bool any_below(const T& a, const T& b) {
  const auto below = a < b;
  return (below[0] | below[1] | below[2]) != 0;
}

/// cutter::Support.
struct LaneSupport {
  T value, rho, z;

  SWARF_KERNEL_INLINE void raise(const T& other, const T& normal_rho, const T& normal_z) {
    rho = other > value ? normal_rho : rho;
    z = other > value ? normal_z : z;
    value = other > value ? other : value;
  }
};

SWARF_KERNEL_INLINE void raise(LaneSupport& support, const cutter::Round& round, const T& rho, const T& z) {
  const double *from = round.from.data(), *to = round.to.data();
  const T dr = rho - round.centre.data()[0], dz = z - round.centre.data()[1];
  const T length = square_roots(dr * dr + dz * dz);
  const T along_from = dr * from[0] + dz * from[1], along_to = dr * to[0] + dz * to[1];
  const T end_rho = along_from > along_to ? all_of<T>(from[0]) : all_of<T>(to[0]);
  const T end_z = along_from > along_to ? all_of<T>(from[1]) : all_of<T>(to[1]);
  // Below 0 beside the round.
  const T within = min_of<T>(from[0] * dz - from[1] * dr, dr * to[1] - dz * to[0]);
  const T normal_rho = within < 0.0 ? end_rho : dr / length, normal_z = within < 0.0 ? end_z : dz / length;
  const T n_rho = length > 0.0 ? normal_rho : end_rho, n_z = length > 0.0 ? normal_z : end_z;
  support.raise(dr * n_rho + dz * n_z - round.radius, n_rho, n_z);
}

SWARF_KERNEL_INLINE LaneSupport support_of(const cutter::ConvexPiece& piece, const T& rho, const T& z) {
  LaneSupport support{all_of<T>(-std::numeric_limits<double>::infinity()), T{}, T{}};
  for (const cutter::Face& face : piece.faces) {
    const double n_rho = face.normal.data()[0], n_z = face.normal.data()[1];
    support.raise(n_rho * rho + n_z * z - face.offset, all_of<T>(n_rho), all_of<T>(n_z));
  }
  for (const cutter::Round& round : piece.rounds) raise(support, round, rho, z);
  return support;
}

/// X(s) = P + s N in the tool's frame.
struct Lines {
  Points P, N;
  T sideways;  ///< of N
};

struct Slope {
  T value, along;
};
SWARF_KERNEL_INLINE Slope slope_on(const cutter::ConvexPiece& piece, const Lines& lines, const T& s) {
  const T x = lines.P.x + s * lines.N.x, y = lines.P.y + s * lines.N.y, z = lines.P.z + s * lines.N.z;
  const T rho = square_roots(x * x + y * y);
  const LaneSupport support = support_of(piece, rho, z);
  T sideways{};
  // Where the planes across the axis decide, none of the columns waits for a quotient.
  if (any_below(T{}, size_of<T>(support.rho))) {
    const T out = x * lines.N.x + y * lines.N.y;
    sideways = rho > 0.0 ? support.rho * out / rho : support.rho * lines.sideways;
  }
  return {support.value, sideways + support.z * lines.N.z};
}

/// Least s >= from with F <= kTouch - margin(s); infinite when F turns up first.
SWARF_KERNEL_INLINE T entry(const cutter::ConvexPiece& piece, const Lines& lines, const T& from,
                            const ColumnMargin& margin) {
  constexpr int kMostSteps = 40;
  constexpr double kClose = 1e-9;  // mm
  const T never = all_of<T>(std::numeric_limits<double>::infinity()), turn = all_of<T>(margin.turn);
  T s = from, open{};
  for (int step = 0; step < kMostSteps; ++step) {
    const Slope at = slope_on(piece, lines, s);
    const T excess = at.value + margin.aside + margin.stray + size_of<T>(s) * margin.turn - kTouch;
    const T slope = at.along + (s < 0.0 ? -turn : turn);
    const T next = s + (excess / -slope + (step > 3 ? kClose : 0.0));
    const T falling = slope < 0.0 ? next : never;
    // What has arrived stays where it is, and so does what has turned up.
    s = excess <= 0.0 ? s : falling;
    open = s < never ? excess : T{};
    if (!any_below(T{}, open)) return s;
  }
  return open > 0.0 ? never : s;
}

SWARF_KERNEL_INLINE void covered(const cutter::ConvexPiece& piece, const ColumnLanes& lanes,
                                 const ColumnNumbers& instants, const ColumnNumbers& from_s,
                                 const ColumnNumbers& tops, const ColumnMargin& margin,
                                 ColumnNumbers& heights) {
  const T t = load<T>(instants.lane), from = load<T>(from_s.lane);
  Lines lines{between(points_of(lanes.foot_at_start), points_of(lanes.foot_at_end), t),
              between(points_of(lanes.way_at_start), points_of(lanes.way_at_end), t), T{}};
  lines.sideways = square_roots(lines.N.x * lines.N.x + lines.N.y * lines.N.y);
  const T never = all_of<T>(std::numeric_limits<double>::infinity());
  const T high = max_of<T>(load<T>(tops.lane), from);
  // Looked at beside the entry, not before it: neither waits for the other.
  const T within = margin.aside + margin.stray + size_of<T>(high) * margin.turn;
  const T at_top = slope_on(piece, lines, high).value;
  const T entered = entry(piece, lines, from, margin);
  const T up_to_top = at_top > kTouch - within ? never : entered;
  store<T>(high > from ? up_to_top : entered, heights.lane);
}

// One short function for each instruction set (instruction_sets.h).
void columns_baseline(const stock::SweepMap& map, const std::array<CellCorner, 3>& columns,
                      ColumnLanes& lanes) {
  columns_of(map, columns, lanes);
}
SWARF_X86_64_V3 void columns_v3(const stock::SweepMap& map, const std::array<CellCorner, 3>& columns,
                                ColumnLanes& lanes) {
  columns_of(map, columns, lanes);
}
SWARF_X86_64_V4 void columns_v4(const stock::SweepMap& map, const std::array<CellCorner, 3>& columns,
                                ColumnLanes& lanes) {
  columns_of(map, columns, lanes);
}
void covered_baseline(const cutter::ConvexPiece& piece, const ColumnLanes& lanes,
                      const ColumnNumbers& instants, const ColumnNumbers& from, const ColumnNumbers& tops,
                      const ColumnMargin& margin, ColumnNumbers& heights) {
  covered(piece, lanes, instants, from, tops, margin, heights);
}
SWARF_X86_64_V3 void covered_v3(const cutter::ConvexPiece& piece, const ColumnLanes& lanes,
                                const ColumnNumbers& instants, const ColumnNumbers& from,
                                const ColumnNumbers& tops, const ColumnMargin& margin,
                                ColumnNumbers& heights) {
  covered(piece, lanes, instants, from, tops, margin, heights);
}
SWARF_X86_64_V4 void covered_v4(const cutter::ConvexPiece& piece, const ColumnLanes& lanes,
                                const ColumnNumbers& instants, const ColumnNumbers& from,
                                const ColumnNumbers& tops, const ColumnMargin& margin,
                                ColumnNumbers& heights) {
  covered(piece, lanes, instants, from, tops, margin, heights);
}

}  // namespace

std::span<const ColumnLanesVariant> column_lanes_variants() {
  static const std::vector<ColumnLanesVariant> variants = runnable<ColumnLanesVariant>(
      {"x86-64-v4", columns_v4, covered_v4}, {"x86-64-v3", columns_v3, covered_v3},
      {"baseline", columns_baseline, covered_baseline});
  return variants;
}

}  // namespace swarf::measure
