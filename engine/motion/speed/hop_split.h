// Hops over cells of which a few leave little acceleration, as beside a pole: parts that each take their own.
//
//   v ^      ____                 One change of speed with the least A and J of all cells is slow where a few
//     |     /    \      ___       of them are tight. At a node between a tight cell and its neighbours a law
//     |    /      \____/   \      may pass without acceleration; either side is a hop of its own, up and
//     +---+--------+--+-----+     down, with what its own cells leave at the speed that it reaches.
//     a         tight       b
//
// Corners between such hops are nodes as well: how fast they can be passed depends on how the hops are
// parted.
#pragma once

#include <span>
#include <vector>

#include "motion/speed/look_ahead.h"

namespace swarf::motion {

/// A place that is passed without acceleration: cells [begin, end), or the start of a cell when they are
/// none.
struct EvenNode {
  size_t begin = 0, end = 0;
  double speed = 0.0;
  double part_s = 0.0;  ///< time of the part from the node before, see part_hops()
};

/// Cells of a run by number, with a speed that is not to be exceeded in each.
struct SpeedOfCells {
  std::span<const PathCell> cells;
  std::span<const double> speed;
  const AxisLimits& limits;
};

/// The least time of one hop between two nodes that keeps the speeds of its cells: the lower its top speed,
/// the more they leave. Replaces `phases`; infinite where there is none.
double hop_between(const SpeedOfCells& of, const EvenNode& a, const EvenNode& b, std::vector<Phase>& phases);

/// No law between the nodes takes less time, s.
double least_time_between(const SpeedOfCells& of, const EvenNode& a, const EvenNode& b);

/// Adds nodes between the first and the last, which stay, and moves the speeds of all in between, as long as
/// that saves time. False where all that saves less than kPartGain of `before_s`: then the nodes mean
/// nothing. Each part keeps the speeds of its cells, and what they leave at those speeds (left_at): the
/// limits of the axes hold as they do in one hop.
bool part_hops(const SpeedOfCells& of, double before_s, std::vector<EvenNode>& nodes);

/// Share of the time that parts must save: less is not looked for.
inline constexpr double kPartGain = 0.03;

}  // namespace swarf::motion
