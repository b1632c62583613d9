// Where the vertices of the dual mesh lie. Lengths here are voxels, places are relative to the cell's corner
// 0.
//
// The level set is the greatest or least of several sheets (the faces of the block, the surfaces that tools
// left), each an exact distance of slope 1. Hence
//   1. Away from the sheets' borders the surface is smooth: the mean of the crossings of the cell's edges is
//      drawn onto the zero of a trilinear interpolation corrected by second differences. Exact for planes,
//      third order for curved sheets.
//   2. A second difference above kKink betrays a border. Then every corner is given the plane of the sheet it
//      belongs to, from the best of the eight cubes of grid points around it: one that lies in one sheet only
//      is linear and has slope 1. The vertex goes to the point nearest to all these planes (a quadric's least
//      value nearest to the mean of the crossings; Ju, Losasso, Schaefer, Warren 2002), if that lies in the
//      cell.
//   3. If it does not, only the sheets count that the cell's edges cross.
// Known limit: sheets that meet twice within a voxel (walls and grooves thinner than that) leave no cube to
// one sheet alone; there the vertex stays at the mean of the crossings.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "stock/mesher/mesher_cell.h"

namespace swarf::stock {

/// The values of a leaf, one grid point before and two after it along each axis, in voxels, z fastest.
struct ValueBlock {
  static constexpr int kSide = 11;
  static constexpr std::array<int, 3> kStrides{kSide * kSide, kSide, 1};
  /// Place of grid point (i, j, k) of the leaf, each in [-1, 9].
  static constexpr int index(int i, int j, int k) { return ((i + 1) * kSide + j + 1) * kSide + k + 1; }

  alignas(64) std::array<float, kSide * kSide * kSide> values;
};

struct CellVertex {
  Eigen::Vector3f place;
  Eigen::Vector3f normal;  ///< of one sheet; unit, outward
  bool sharp = false;      ///< sheets meet here
};

/// Values, slopes and second differences at the corners of a cell.
struct CellSample {
  alignas(32) std::array<float, 8> value;
  alignas(32) std::array<std::array<float, 8>, 3> slope;  ///< central differences
  alignas(32) std::array<std::array<float, 8>, 3> bend;   ///< second differences

  /// `corner` points at the value of corner 0 in a ValueBlock.
  explicit CellSample(const float* corner);
  /// Whether sheets meet near the cell.
  bool kinked() const;
  /// Zero along an edge by linear interpolation, from its lower end.
  float crossing(int edge) const;
  /// Vertex of the patch that crosses these edges, all of one sheet.
  CellVertex vertex(uint16_t edges) const;
};

/// A cell near a border of sheets.
class KinkedCell {
 public:
  /// `corner` points at the value of corner 0 in a ValueBlock.
  KinkedCell(const float* corner, const CellSample& sample);
  /// Zero along an edge whose ends may belong to different sheets, from its lower end.
  double crossing(int edge) const { return crossings_[edge].at; }
  /// Vertex of the patch that crosses these edges; `only` when the cell has no other patch.
  CellVertex vertex(uint16_t edges, bool only) const;

 private:
  static constexpr int kNone = -1;
  /// normal . x + offset = 0, x from corner 0.
  struct Plane {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    double offset = 0.0;
    double misfit = 0.0;
    double distance(const Eigen::Vector3d& x) const { return normal.dot(x) + offset; }
  };
  struct Crossing {
    double at = 0.0;
    int sheet = kNone;
  };
  using SheetSet = uint8_t;

  Plane cube_plane(const float* low, const Eigen::Vector3d& place) const;
  void find_planes(const float* corner);
  void gather_sheets();
  Crossing find_crossing(int edge) const;
  Eigen::Vector3d meeting_point(SheetSet sheets, const Eigen::Vector3d& from, double& misfit) const;

  const CellSample& sample_;
  std::array<Plane, 8> planes_;    ///< of each corner; misfit above the limit: unknown
  std::array<int, 8> sheet_of_{};  ///< of each corner, or kNone
  std::array<Plane, 8> sheets_;    ///< distinct planes
  int sheet_count_ = 0;
  std::array<Crossing, kCellEdges> crossings_;
};

}  // namespace swarf::stock
