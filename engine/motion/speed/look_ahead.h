// Look-ahead over a run of blocks: how fast each place is passed, from rest to rest.
//
// The path of all axes q(s) comes in cells with bounds of |q'|, |q''| and |q'''| per axis (run_path.h). With
// speed v, acceleration a and jerk j along s the axes move at (theory 1.3)
//     q' v,     q'' v^2 + q' a,     q''' v^3 + 3 q'' v a + q' j.
//
//  v ^        ______________            1. Keys: places of least speed. A corner's cell is passed evenly
//    |       /              \    __        (a = j = 0), so all that its axes can do serves the rounding.
//    |   ___/ A, J of the hop \__/  \    2. Between two keys a hop: up, along, down (s_curve.h), with what
//    |  /                            \      the cells in between leave for a and j at their speed.
//    +--k---k------------------k--k---k  3. A key that its neighbours cannot reach is dropped and its cell
//  joins the hop; a corner that would leave too little of A and J is passed slower instead.
//  4. Where a hop is too fast for a cell within, that cell's ends become keys, and again from 3.
//  5. Beside a pole, hops over cells that leave much and cells that leave little are parted, each part with
//  its own A and J (hop_split.h).
//
// All axis limits hold for every instant, and so for the differences of any samples: a difference of order n
// is the mean of the n-th derivative under a B-spline.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "kinematics/machine_model.h"
#include "motion/speed/s_curve.h"

namespace swarf::motion {

/// Limits of the axes that are planned with; unused entries are infinite.
struct AxisLimits {
  kinematics::AxisValues speed, acceleration, jerk;
};
/// Axis::rapid_max in rapid moves, where it is given.
double speed_limit(const kinematics::Axis& axis, bool rapid);
/// A little (kPlanned) below the machine's, so that rounding of the sampled positions stays within.
AxisLimits axis_limits(const kinematics::MachineModel& machine, bool rapid);
/// Share of the machine's limits that is planned with.
inline constexpr double kPlanned = 1.0 - 1e-6;
/// A cell's speed may be exceeded by this relative amount: rounding.
inline constexpr double kSpeedRounding = 1e-9;

/// A stretch of path with bounds that hold everywhere on it.
struct PathCell {
  double length = 0.0;                          ///< along s, above 0
  double speed = 0.0;                           ///< what feed and axes allow; see limit_speed()
  bool corner = false;                          ///< passed evenly
  bool stop = false;                            ///< comes to rest at its end
  bool uneven = false;                          ///< of a block whose axes turn unevenly, as beside a pole
  RampLimits tip;                               ///< of the path, from MotionOptions; infinite where none
  kinematics::AxisValues first, second, third;  ///< bounds of |q'|, |q''|, |q'''|
};

/// Lowers the cell's speed to what the axes can follow: corners use all of acceleration and jerk, other cells
/// keep a share for changes of speed.
void limit_speed(const AxisLimits& limits, PathCell& cell);

/// What a cell's axes leave for acceleration and jerk along s at speed v; not below 0.
RampLimits left_at(const PathCell& cell, double v, const AxisLimits& limits);

/// A phase and where it starts.
struct PlacedPhase {
  Phase phase;
  size_t cell = 0;      ///< the phase starts `offset` after the start of this cell
  double offset = 0.0;  ///< mm; may lie beyond the cell's end
};

/// How the first cell is entered.
struct PlanStart {
  double speed = 0.0;  ///< without acceleration
  /// PathCell::speed of the cell before; infinite where there is none.
  double top_before = std::numeric_limits<double>::infinity();
};

/// A place that is passed without acceleration: a plan may be cut in two there.
struct EvenPlace {
  size_t cell = 0;  ///< the place is the start of this cell, or the end of the last
  double speed = 0.0;
  size_t phases = 0;  ///< that come before it
};

struct CellPlan {
  std::vector<PlacedPhase> phases;
  std::vector<EvenPlace> places;  ///< by cell; the last one is the end, at rest
};

/// The time law over all cells, from their start to rest. None when no law starts as fast as that: only
/// where the start is not one of a plan that has seen these cells.
std::optional<CellPlan> plan_cells(const std::vector<PathCell>& cells, const AxisLimits& limits,
                                   const PlanStart& start = {});

}  // namespace swarf::motion
