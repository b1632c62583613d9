#include "measure/bottom_planes.h"

#include <algorithm>
#include <cmath>

#include "measure/lane_numbers.h"
#include "measure/sweep_index.h"

namespace swarf::measure {
namespace {

enum Row : size_t { kStartAxis = 0, kStartTip = 3, kEndAxis = 6, kEndTip = 9, kBottom = 12, kTop = 13 };

/// Smaller than any divisor that counts.
constexpr double kTiny = 1e-300;

// T: numbers of so many sweeps (lane_numbers.h).

/// A pose of each sweep.
template <class T>
struct Poses {
  T ax, ay, az, tx, ty, tz;
};

template <class T>
SWARF_KERNEL_INLINE Poses<T> poses_of(const BottomPlanes::Rows& rows, size_t axis, size_t tip, size_t n) {
  return {load<T>(rows[axis] + n), load<T>(rows[axis + 1] + n), load<T>(rows[axis + 2] + n),
          load<T>(rows[tip] + n),  load<T>(rows[tip + 1] + n),  load<T>(rows[tip + 2] + n)};
}

/// Products of the axes with one vector; summed in Eigen's order.
template <class T>
SWARF_KERNEL_INLINE T along(const Poses<T>& poses, const double (&b)[3]) {
  return (poses.ax * b[0] + poses.ay * b[1]) + poses.az * b[2];
}
/// How high a point stands over the tips.
template <class T>
SWARF_KERNEL_INLINE T height_in(const Poses<T>& poses, const double (&point)[3]) {
  return (poses.ax * (point[0] - poses.tx) + poses.ay * (point[1] - poses.ty)) +
         poses.az * (point[2] - poses.tz);
}

/// height_bounds.cpp: least_of_quadratic.
template <class T>
SWARF_KERNEL_INLINE T lower_on_side(const T& least, const T& from, const T& to, const T& bend) {
  const T step = to - from, twice = 2.0 * size_of<T>(step);
  const T t = 0.5 - step / max_of<T>(bend, all_of<T>(kTiny));
  const T lowest = from - 0.5 * bend * t * t;
  return min_of<T>(bend > twice ? lowest : least, least);
}
template <class T>
SWARF_KERNEL_INLINE T lowest_of_quadratic(const T (&at)[3], const T (&bend)[3]) {
  T least = min_of<T>(min_of<T>(at[0], at[1]), at[2]);
  for (int k = 0; k < 3; ++k) least = lower_on_side<T>(least, at[k], at[(k + 1) % 3], bend[k]);
  const T p = at[1] - at[0] - 0.5 * bend[0], q = at[2] - at[0] - 0.5 * bend[2];
  const T h = 0.5 * (bend[0] + bend[2] - bend[1]);
  const T det = bend[0] * bend[2] - h * h, divisor = max_of<T>(det, all_of<T>(kTiny));
  const T x = (h * q - bend[2] * p) / divisor, y = (h * p - bend[0] * q) / divisor;
  // Above 0 where the place lies within and the function is convex.
  const T within = min_of<T>(min_of<T>(min_of<T>(1.0 - (x + y), x), y), min_of<T>(det, bend[0]));
  const T lowest = at[0] + 0.5 * (p * x + q * y);
  return min_of<T>(within > 0.0 ? lowest : least, least);
}

/// Of a plane of each sweep: what it is at the corners as if they lay in the chord's plane, and how it rises
/// along their normals.
template <class T>
struct Slopes {
  T base[3], rise[3];
};

/// height_bounds.cpp: root_of_thick.
template <class T>
SWARF_KERNEL_INLINE T thick_root(const PlainCell& cell, const Slopes<T>& plane) {
  const T untold = all_of<T>(kUntold);
  T least = -untold, told = -untold;
  for (int k = 0; k < 3; ++k) {
    const T base = plane.base[k] - cell.flatness - kRoundingOfHeights;
    const T steep = plane.rise[k] + cell.turn, flat = plane.rise[k] - cell.turn;
    told = min_of<T>(told, base + kTouch - cell.seen[k] * steep);
    const T falls = base < 0.0 ? steep : flat;
    const T height = max_of<T>(-base / min_of<T>(falls, all_of<T>(-kTiny)), all_of<T>(-cell.seen[k]));
    least = min_of<T>(falls < 0.0 ? height : least, least);
  }
  return told < 0.0 ? untold : least;
}

/// height_bounds.cpp: root_of_curved.
template <class T>
SWARF_KERNEL_INLINE T curved_root(const PlainCell& cell, const Slopes<T>& plane, const T (&bend)[3]) {
  const T untold = all_of<T>(kUntold);
  T steepest{}, flattest = -untold;
  for (int k = 0; k < 3; ++k) {
    steepest = max_of<T>(-plane.rise[k] + cell.turn, steepest);
    flattest = min_of<T>(-plane.rise[k] - cell.turn, flattest);
  }
  const T least = lowest_of_quadratic<T>(plane.base, bend) - cell.stray - kRoundingOfHeights;
  const T divisor = least < 0.0 ? flattest : steepest;
  const T height = least / max_of<T>(divisor, all_of<T>(kTiny));
  const T falling = flattest > 0.0 ? height : untold;
  const double deepest = std::min({cell.seen[0], cell.seen[1], cell.seen[2]});
  return falling < -deepest ? untold : falling;
}

/// The bottom plane of one end of the motions.
template <class T, bool kIsFlat>
SWARF_KERNEL_INLINE T root_of_bottom(const PlainCell& cell, const Poses<T>& poses, const T& bottom) {
  Slopes<T> plane;
  T bend[3];
  const T centre = bottom - height_in<T>(poses, cell.centre);
  for (int k = 0; k < 3; ++k) {
    plane.base[k] = centre - along<T>(poses, cell.from_centre[k]);
    plane.rise[k] = -along<T>(poses, cell.normal[k]);
    bend[k] = -along<T>(poses, cell.bend[k]);
  }
  const T thick = thick_root<T>(cell, plane);
  if constexpr (kIsFlat) return thick;
  return max_of<T>(curved_root<T>(cell, plane, bend), thick);
}

/// The same of the plane of the upper end, at the start: kUntold where a column reaches below it.
template <class T, bool kIsFlat>
SWARF_KERNEL_INLINE T with_top(const PlainCell& cell, const Poses<T>& poses, const T& top, const T& height) {
  const T untold = all_of<T>(kUntold), centre = height_in<T>(poses, cell.centre) - top;
  T lowest = -untold, flattest = -untold;
  for (int k = 0; k < 3; ++k) {
    const T rise = along<T>(poses, cell.normal[k]);
    const T base = centre + along<T>(poses, cell.from_centre[k]) - cell.flatness - kRoundingOfHeights;
    lowest = min_of<T>(lowest, base + kTouch - cell.seen[k] * (rise + cell.turn));
    flattest = min_of<T>(flattest, -rise - cell.turn);
  }
  const T below = lowest < 0.0 ? height : untold;
  if constexpr (kIsFlat) return below;
  return flattest > 0.0 ? untold : below;
}

template <int N, bool kIsFlat>
SWARF_KERNEL_INLINE void heights_over(const BottomPlanes::Rows& rows, size_t count, const PlainCell& cell,
                                      double* heights) {
  using T = Numbers<N>;
  const T untold = all_of<T>(kUntold);
  for (size_t n = 0; n < count; n += N) {
    const Poses<T> start = poses_of<T>(rows, kStartAxis, kStartTip, n),
                   end = poses_of<T>(rows, kEndAxis, kEndTip, n);
    const T bottom = load<T>(rows[kBottom] + n), top = load<T>(rows[kTop] + n);
    const T height = min_of<T>(root_of_bottom<T, kIsFlat>(cell, end, bottom),
                               root_of_bottom<T, kIsFlat>(cell, start, bottom));
    const T finite = height < -kUntold ? height : untold;
    const T told = with_top<T, kIsFlat>(cell, start, top, finite);
    store<T>(told, heights + n);
  }
}

template <int N>
SWARF_KERNEL_INLINE void over_cell(const BottomPlanes::Rows& rows, size_t count, const PlainCell& cell,
                                   double* heights) {
  if (cell.is_flat)
    heights_over<N, true>(rows, count, cell, heights);
  else
    heights_over<N, false>(rows, count, cell, heights);
}

/// Where the column rises to the plane of one end of the motions, or kUntold.
template <class T>
SWARF_KERNEL_INLINE T rise_to(const Poses<T>& poses, const T& bottom, const double (&point)[3],
                              const double (&normal)[3]) {
  constexpr double kFlattest = 0.01;
  const T steepness = along<T>(poses, normal), least = all_of<T>(kFlattest);
  const T height = (bottom - height_in<T>(poses, point)) / max_of<T>(steepness, least);
  return steepness > least ? height : all_of<T>(kUntold);
}

template <int N>
SWARF_KERNEL_INLINE void over_column(const BottomPlanes::Rows& rows, size_t count, const double (&point)[3],
                                     const double (&normal)[3], double* heights) {
  using T = Numbers<N>;
  for (size_t n = 0; n < count; n += N) {
    const T bottom = load<T>(rows[kBottom] + n);
    const T height = min_of<T>(rise_to<T>(poses_of<T>(rows, kStartAxis, kStartTip, n), bottom, point, normal),
                               rise_to<T>(poses_of<T>(rows, kEndAxis, kEndTip, n), bottom, point, normal));
    store<T>(height, heights + n);
  }
}

// One short function for each instruction set (instruction_sets.h).
void over_cell_baseline(const BottomPlanes::Rows& rows, size_t count, const PlainCell& cell,
                        double* heights) {
  over_cell<2>(rows, count, cell, heights);
}
SWARF_X86_64_V3 void over_cell_v3(const BottomPlanes::Rows& rows, size_t count, const PlainCell& cell,
                                  double* heights) {
  over_cell<4>(rows, count, cell, heights);
}
SWARF_X86_64_V4 void over_cell_v4(const BottomPlanes::Rows& rows, size_t count, const PlainCell& cell,
                                  double* heights) {
  over_cell<8>(rows, count, cell, heights);
}
void over_column_baseline(const BottomPlanes::Rows& rows, size_t count, const double (&point)[3],
                          const double (&normal)[3], double* heights) {
  over_column<2>(rows, count, point, normal, heights);
}
SWARF_X86_64_V3 void over_column_v3(const BottomPlanes::Rows& rows, size_t count, const double (&point)[3],
                                    const double (&normal)[3], double* heights) {
  over_column<4>(rows, count, point, normal, heights);
}
SWARF_X86_64_V4 void over_column_v4(const BottomPlanes::Rows& rows, size_t count, const double (&point)[3],
                                    const double (&normal)[3], double* heights) {
  over_column<8>(rows, count, point, normal, heights);
}

/// Of a cutter of one piece with a plane below and one above and no other face across its axis: both.
struct Ends {
  double bottom, top;
};
Ends planes_of_ends(const stock::CutterSolid& cutter) {
  Ends ends{lowest_z(cutter), kUntold};
  if (cutter.pieces.size() != 1) return ends;
  const cutter::ConvexPiece& piece = cutter.pieces.front();
  const cutter::Face *below = nullptr, *above = nullptr;
  for (const cutter::Face& face : piece.faces) {
    if (face.normal.x() != 0.0) continue;
    const cutter::Face*& side = face.normal.y() == -1.0 ? below : above;
    if (side != nullptr || std::abs(face.normal.y()) != 1.0) return ends;
    side = &face;
  }
  if (below != nullptr && above != nullptr && -below->offset == ends.bottom) ends.top = above->offset;
  return ends;
}

}  // namespace

PlainCell plain_cell(const DesignCell& cell, const ColumnDepths& depths) {
  PlainCell plain{};
  const Vec3 centre = cell.centroid();
  for (size_t c = 0; c < 3; ++c) {
    const auto axis = static_cast<Eigen::Index>(c);
    plain.centre[c] = centre[axis];
    for (size_t k = 0; k < 3; ++k) {
      plain.from_centre[k][c] = cell.corners[k].point[axis] - centre[axis];
      plain.normal[k][c] = cell.corners[k].normal[axis];
      plain.bend[k][c] = cell.bends[k][axis];
    }
  }
  plain.flatness = cell.flatness_mm;
  plain.stray = cell.stray_mm;
  plain.turn = cell.turn;
  for (size_t k = 0; k < 3; ++k) plain.seen[k] = depths.seen[k];
  plain.is_flat = cell.flatness_mm == 0.0;
  return plain;
}

void BottomPlanes::add(std::span<const uint32_t> numbers, std::span<const stock::Sweep> sweeps,
                       const SweepCutters& cutters) {
  const stock::CutterSolid* last = nullptr;
  Ends ends{};
  size_t n = count_;
  resize(count_ + numbers.size());
  for (const uint32_t number : numbers) {
    const ToolPose &start = sweeps[number].start, &end = sweeps[number].end;
    const stock::CutterSolid* cutter = &cutters[number];
    if (cutter != last) ends = planes_of_ends(*cutter);
    last = cutter;
    for (size_t c = 0; c < 3; ++c) {
      const auto axis = static_cast<Eigen::Index>(c);
      rows_[kStartAxis + c][n] = start.axis_W[axis];
      rows_[kStartTip + c][n] = start.tip_W[axis];
      rows_[kEndAxis + c][n] = end.axis_W[axis];
      rows_[kEndTip + c][n] = end.tip_W[axis];
    }
    rows_[kBottom][n] = ends.bottom;
    rows_[kTop][n] = ends.top;
    ++n;
  }
}

void BottomPlanes::repeat(std::span<const uint32_t> places) {
  const size_t first = count_;
  resize(first + places.size());
  for (std::vector<double>& row : rows_)
    for (size_t i = 0; i < places.size(); ++i) row[first + i] = row[places[i]];
}

std::span<const BottomPlaneVariant> bottom_plane_variants() {
  static const std::vector<BottomPlaneVariant> variants = runnable<BottomPlaneVariant>(
      {"x86-64-v4", over_cell_v4, over_column_v4}, {"x86-64-v3", over_cell_v3, over_column_v3},
      {"baseline", over_cell_baseline, over_column_baseline});
  return variants;
}

void column_heights(const CellCorner& at, const BottomPlanes::Rows& rows, size_t count,
                    std::vector<double>& heights) {
  static const ColumnHeights over_column = bottom_plane_variants().front().over_column;
  heights.resize(count + BottomPlanes::kMostLanes);
  const double point[3] = {at.point.x(), at.point.y(), at.point.z()};
  const double normal[3] = {at.normal.x(), at.normal.y(), at.normal.z()};
  over_column(rows, count, point, normal, heights.data());
}

void cell_heights(const DesignCell& cell, const ColumnDepths& depths, const BottomPlanes::Rows& rows,
                  size_t count, std::vector<double>& heights) {
  static const CellHeights over_cell = bottom_plane_variants().front().over_cell;
  heights.assign(count + BottomPlanes::kMostLanes, kUntold);
  const bool is_finite = std::isfinite(cell.turn) && std::isfinite(cell.flatness_mm);
  if (depths.own.empty() && is_finite) over_cell(rows, count, plain_cell(cell, depths), heights.data());
}

}  // namespace swarf::measure
