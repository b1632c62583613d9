// Which moment of the program each frame of the movie shows.
#pragma once

#include <cstddef>
#include <vector>

#include "base/progress.h"
#include "motion/cycles/cycles.h"
#include "reports/machine_view.h"
#include "sim/job/scene.h"

namespace swarf::reports {

struct PlannedFrame {
  motion::Cycle cycle;
  size_t shot = 0;     ///< index into MovieSettings::shots
  double share = 0.0;  ///< of the shot, 0 at its first frame, 1 at its last
};

/// Cycles of one element that follow each other with one tool, cutting or not.
struct Stretch {
  size_t first = 0, end = 0;  ///< cycles [first, end)
  int element = 0, tool = 0;
  bool cutting = false;
};

/// So many cycle numbers, ascending, the first and the last frame near the ends: evenly by time, by block, or
/// over what is cut. None where speed is kCutting and nothing is cut.
std::vector<size_t> spread_frames(const std::vector<Stretch>& stretches, sim::MovieSpeed speed, size_t count);

/// All frames of the movie. Throws InputError at the shot: "place-unknown" for a line or time that the
/// program has not, "nothing-cut".
std::vector<PlannedFrame> plan_frames(const FinishedRun& run, Progress& progress);

}  // namespace swarf::reports
