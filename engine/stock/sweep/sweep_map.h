// One sweep as a map: where a fixed point of the work stands in the tool's frame while the cutter passes.
//
//   X(t) = (1-t) X_start(x) + t X_end(x),  t in [0,1],  X_start = R0' (x - tip0),  X_end = R1' (x - tip1)
//
// z of the tool frame is the tool axis. The turn about the axis is free (the cutter is a solid of
// revolution); R1 is R0 turned by the smallest rotation that brings one axis onto the other. X(t) is a
// weighted mean of two rigid maps, so the map x -> X(t) never stretches: distances in the tool frame are
// 1-Lipschitz in x.
#pragma once

#include "base/frames.h"
#include "stock/sweep/sweep.h"

namespace swarf::stock {

struct SweepMap {
  Mat3 R0t, R1t;    ///< rows: the tool frame's x, y, z in W
  Vec3 tip0, tip1;  ///< W, mm

  Vec3 start(const Vec3& point_W) const { return R0t * (point_W - tip0); }
  Vec3 end(const Vec3& point_W) const { return R1t * (point_W - tip1); }
};

SweepMap sweep_map(const Sweep& sweep);

/// Greatest distance in mm between the sweep's linear tool-frame motion and the rigid motion (tip on a
/// straight line, axis turning evenly) for points within `lever_mm` of the tip: |X''|/8 with X'' = theta^2
/// lever + 2 theta |tip1 - tip0|.
double motion_bound(const SweepMap& map, double lever_mm);
double motion_bound(const Sweep& sweep, double lever_mm);

}  // namespace swarf::stock
