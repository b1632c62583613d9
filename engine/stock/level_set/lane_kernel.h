// Sixteen swept pieces against one leaf: which of them may still raise a value there, and where.
//
// F, the cutter's implicit function, is convex: with its gradient g at any point Xm,  F(X) >= F(Xm) + g.(X -
// Xm). In the tool frame a voxel x of the leaf stands at X(t, x), linear in t and in x, so what the sweep
// writes there,
//   -min over t of F(X(t, x))  <=  max over t = 0, 1 of  -F(Xm) - g.(X(t, x) - Xm),
// lies below the greater of two linear functions of x; g may be the gradient of any face or round of the
// cutter, because each of them lies below F. With Xm = the leaf's centre at half time the bound is tight.
//
// In single precision for a run of consecutive sweeps at once. Compiled like leaf_kernel.cpp. All comparisons
// carry a slack above the rounding, so a verdict never changes a bit of the stock.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cutter/convex_piece.h"
#include "stock/level_set/leaf_kernel.h"

namespace swarf::stock {

inline constexpr int kLanes = 16;
inline constexpr uint32_t kAllLanes = (1U << kLanes) - 1U;
/// One number of each lane.
struct alignas(kLanes * sizeof(float)) LaneFloats {
  float lane[kLanes];
};

/// Maps into the tool frame (sweep_map.h) by component, of a place relative to the run's origin: where it is
/// at half time, and how that changes from the start to the end. Lanes beyond the last sweep repeat it.
struct Lanes {
  LaneFloats middle[3][3], change[3][3];        ///< [row][column]
  LaneFloats middle_shift[3], change_shift[3];  ///< mm
  /// By how much the sum of the components of a direction in W that is fixed in the tool frame, by magnitude,
  /// may differ at both ends from that at half time.
  LaneFloats turn;
};

/// A convex piece by components.
struct LanePiece {
  struct Face {
    float rho, z, offset;
  };
  struct Round {
    float centre_rho, centre_z, radius, from_rho, from_z, to_rho, to_z;
  };
  std::vector<Face> faces;
  std::vector<Round> rounds;
};
LanePiece lane_piece(const cutter::ConvexPiece& piece);

/// The leaf and what is known of its values (LeafFloor).
struct LaneQuery {
  float centre[3];  ///< relative to the run's origin, mm
  float floor, floor_slope[3];
  float half;   ///< from the centre to the leaf's faces, mm
  float reach;  ///< from the centre to the farthest place where a distance matters, mm
};

/// Sweeps are sorted by how deep a place above the leaf lies in them, so many half leaves along the tool's
/// axis: there those that pass over the whole of it come before those that reach it with the rim, and leave
/// floors everywhere. Found by trying: at 0 leaves of a wavy surface are visited a fifth more often, below 0
/// far more.
inline constexpr float kDepthAbove = 1.5F;

struct LaneAnswer {
  uint32_t open;      ///< bit n: lane n may raise a value
  uint32_t swallows;  ///< bit n: every voxel of the leaf lies deeper inside lane n's cutter than the band
  LaneFloats above;   ///< open while the floor lies below this, mm
  LaneFloats depth;   ///< inside the cutter at half time (-F), mm, of a place above the leaf's centre
};

using LaneKernel = void (*)(const Lanes& lanes, const LanePiece& piece, const LaneQuery& query,
                            LaneAnswer& out);

/// Which of the lanes in `open` have the greatest depth; bit n: lane n.
using DeepestLanes = uint32_t (*)(const LaneAnswer& answer, uint32_t open);

/// A LeafBound of each lane, enlarged by what it rounds.
struct LaneBounds {
  struct Linear {
    LaneFloats start, end, start_step[3], end_step[3];
  };
  Linear of_face[2];  ///< outermost first
  LeafBound lane(uint32_t n) const;
};
using LaneBoundKernel = void (*)(const Lanes& lanes, const LanePiece& piece, const LaneQuery& query,
                                 LaneBounds& out);

struct LaneKernelVariant {
  const char* instruction_set;
  LaneKernel kernel;
  DeepestLanes deepest;
  LaneBoundKernel bounds;
};
/// The variants this processor can run, fastest first.
std::span<const LaneKernelVariant> lane_kernel_variants();

}  // namespace swarf::stock
