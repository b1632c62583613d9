#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "stock/level_set/stock_grid_internal.h"
#include "stock/mesher/mesher_vertex.h"

namespace swarf::stock {
namespace {

using Eigen::Vector3d;

/// A cube belongs to one sheet if its values differ from a linear function, and its slope from 1, by no more
/// than this (voxels); a sheet of radius r voxels differs by 1 / (8 r).
constexpr double kMisfit = 0.04;
/// Planes whose normals agree better than this are one sheet.
constexpr double kOneSheetCosine = 0.97;
/// Directions along which the planes disagree by less than this share are left to the crossings.
constexpr double kSingular = 0.015;
/// The meeting point fits if every sheet passes it within this distance.
constexpr double kMeetMisfit = 0.05;
/// A cell owns what lies within [-kEdgeShift, 1 - kEdgeShift): an edge in a lattice plane, where rounding
/// decides, then has one owner.
constexpr double kEdgeShift = 1e-3;
/// How far outside the cell the meeting point of crossed sheets may lie.
constexpr double kReach = 0.75;

Vector3d corner_place(int c) {
  return {static_cast<double>(c >> 2 & 1), static_cast<double>(c >> 1 & 1), static_cast<double>(c & 1)};
}

bool within(const Vector3d& x, double low, double high) {
  return x.minCoeff() >= low && x.maxCoeff() < high;
}

}  // namespace

KinkedCell::Plane KinkedCell::cube_plane(const float* low, const Vector3d& place) const {
  std::array<double, 8> v;
  double mean = 0.0, greatest = 0.0;
  for (int c = 0; c < 8; ++c) {
    v[c] = low[(c >> 2) * ValueBlock::kStrides[0] + (c >> 1 & 1) * ValueBlock::kStrides[1] + (c & 1)];
    mean += 0.125 * v[c];
    greatest = std::max(greatest, std::abs(v[c]));
  }
  Plane plane;
  plane.misfit = std::numeric_limits<double>::infinity();
  if (greatest >= kBandVoxels - 1e-4) return plane;
  for (int axis = 0; axis < 3; ++axis) {
    double sum = 0.0;
    for (int c = 0; c < 8; ++c) sum += (c & corner_step(axis)) != 0 ? v[c] : -v[c];
    plane.normal[axis] = 0.25 * sum;
  }
  const double slope = plane.normal.norm();
  plane.misfit = std::abs(slope - 1.0);
  if (plane.misfit > kMisfit) return plane;
  double residual = 0.0;
  for (int c = 0; c < 8; ++c) {
    const double linear = mean + plane.normal.dot(corner_place(c) - Vector3d::Constant(0.5));
    residual = std::max(residual, std::abs(v[c] - linear));
  }
  plane.misfit += residual;
  plane.normal /= slope;
  plane.offset = mean / slope - plane.normal.dot(place + Vector3d::Constant(0.5));
  return plane;
}

/// Each corner's plane is that of the best of its eight cubes, 27 cubes in all.
void KinkedCell::find_planes(const float* corner) {
  for (Plane& plane : planes_) plane.misfit = std::numeric_limits<double>::infinity();
  for (int n = 0; n < 27; ++n) {
    const std::array<int, 3> at{n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1};
    const float* low = corner + at[0] * ValueBlock::kStrides[0] + at[1] * ValueBlock::kStrides[1] + at[2];
    const Plane plane = cube_plane(low, Vector3d(at[0], at[1], at[2]));
    if (plane.misfit > kMisfit) continue;
    for (int c = 0; c < 8; ++c) {
      const bool touches = (c >> 2 & 1) - at[0] <= 1 && (c >> 2 & 1) - at[0] >= 0 &&
                           (c >> 1 & 1) - at[1] <= 1 && (c >> 1 & 1) - at[1] >= 0 && (c & 1) - at[2] <= 1 &&
                           (c & 1) - at[2] >= 0;
      if (touches && plane.misfit < planes_[c].misfit) planes_[c] = plane;
    }
  }
}

void KinkedCell::gather_sheets() {
  for (int c = 0; c < 8; ++c) {
    sheet_of_[c] = kNone;
    if (planes_[c].misfit > kMisfit) continue;
    for (int s = 0; s < sheet_count_ && sheet_of_[c] == kNone; ++s) {
      const Vector3d& sum = sheets_[s].normal;
      if (sum.dot(planes_[c].normal) > kOneSheetCosine * sum.norm()) sheet_of_[c] = s;
    }
    if (sheet_of_[c] == kNone) {
      sheet_of_[c] = sheet_count_;
      sheets_[sheet_count_++] = Plane();
    }
    // A cube that reaches a little over the border fits worse, and counts for little beside those that do
    // not.
    constexpr double kFloor = 1e-3;
    const double weight = 1.0 / ((planes_[c].misfit + kFloor) * (planes_[c].misfit + kFloor));
    sheets_[sheet_of_[c]].normal += weight * planes_[c].normal;
    sheets_[sheet_of_[c]].offset += weight * planes_[c].offset;
  }
  for (int s = 0; s < sheet_count_; ++s) {
    const double length = sheets_[s].normal.norm();
    sheets_[s].offset /= length;
    sheets_[s].normal /= length;
  }
}

KinkedCell::Crossing KinkedCell::find_crossing(int edge) const {
  const int axis = edge / 4, low = edge_corner(edge), high = low + corner_step(axis);
  const double f0 = sample_.value[low], f1 = sample_.value[high];
  Crossing crossing{f0 / (f0 - f1), sheet_of_[low] != kNone ? sheet_of_[low] : sheet_of_[high]};
  if (sheet_of_[low] == kNone || sheet_of_[high] == kNone || sheet_of_[low] == sheet_of_[high])
    return crossing;
  // The value follows the lower end's sheet up to where both sheets agree, then the upper end's.
  const double g0 = planes_[low].normal[axis], g1 = planes_[high].normal[axis];
  const double border = (f1 - g1 - f0) / (g0 - g1);
  if (border >= 0.0 && border <= 1.0) {
    const bool upper = (f0 + g0 * border < 0.0) == (f0 < 0.0);
    const double at = upper ? 1.0 - f1 / g1 : -f0 / g0;
    if (at >= 0.0 && at <= 1.0) return {at, sheet_of_[upper ? high : low]};
  }
  const bool upper = std::abs(f1 + g1 * (crossing.at - 1.0)) < std::abs(f0 + g0 * crossing.at);
  crossing.sheet = sheet_of_[upper ? high : low];
  return crossing;
}

KinkedCell::KinkedCell(const float* corner, const CellSample& sample) : sample_(sample) {
  find_planes(corner);
  gather_sheets();
  for (int e = 0; e < kCellEdges; ++e) {
    const int low = edge_corner(e);
    const bool crossed = (sample.value[low] < 0.0F) != (sample.value[low + corner_step(e / 4)] < 0.0F);
    if (crossed) crossings_[e] = find_crossing(e);
  }
}

/// Least squares over the planes; of all solutions the one nearest to `from`.
Vector3d KinkedCell::meeting_point(SheetSet sheets, const Vector3d& from, double& misfit) const {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  for (int s = 0; s < sheet_count_; ++s) {
    if ((sheets >> s & 1) == 0) continue;
    A += sheets_[s].normal * sheets_[s].normal.transpose();
    b -= sheets_[s].distance(from) * sheets_[s].normal;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(A);
  Vector3d x = from;
  for (int i = 0; i < 3; ++i) {
    if (eigen.eigenvalues()[i] < kSingular * eigen.eigenvalues()[2]) continue;
    x += eigen.eigenvectors().col(i).dot(b) / eigen.eigenvalues()[i] * eigen.eigenvectors().col(i);
  }
  misfit = 0.0;
  for (int s = 0; s < sheet_count_; ++s) {
    if ((sheets >> s & 1) != 0) misfit = std::max(misfit, std::abs(sheets_[s].distance(x)));
  }
  return x;
}

CellVertex KinkedCell::vertex(uint16_t edges, bool only) const {
  Vector3d mean = Vector3d::Zero();
  SheetSet crossed = 0;
  std::array<int, 8> votes{};
  for (unsigned rest = edges; rest != 0; rest &= rest - 1) {
    const int e = std::countr_zero(rest);
    mean += corner_place(edge_corner(e));
    mean[e / 4] += crossings_[e].at;
    if (crossings_[e].sheet == kNone) continue;
    crossed = static_cast<SheetSet>(crossed | 1 << crossings_[e].sheet);
    ++votes[crossings_[e].sheet];
  }
  mean /= std::popcount(edges);
  if (crossed == 0) return sample_.vertex(edges);
  const auto main = static_cast<int>(std::max_element(votes.begin(), votes.end()) - votes.begin());
  CellVertex vertex{mean.cast<float>(), sheets_[main].normal.cast<float>(), false};
  const auto take = [&](SheetSet sheets, double low, double high) {
    if (std::popcount(sheets) < 2) return false;
    double misfit = 0.0;
    const Vector3d x = meeting_point(sheets, mean, misfit);
    if (misfit > kMeetMisfit || !within(x, low, high)) return false;
    vertex.place = x.cast<float>();
    vertex.sharp = true;
    return true;
  };
  if (only) {
    const auto all = static_cast<SheetSet>((1 << sheet_count_) - 1);
    if (take(all, -kEdgeShift, 1.0 - kEdgeShift)) return vertex;
    for (int s = 0; s < sheet_count_; ++s) {
      const auto more = static_cast<SheetSet>(crossed | 1 << s);
      if (more != crossed && take(more, -kEdgeShift, 1.0 - kEdgeShift)) return vertex;
    }
  }
  take(crossed, -kReach, 1.0 + kReach);
  return vertex;
}

}  // namespace swarf::stock
