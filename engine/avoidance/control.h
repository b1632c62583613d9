// CONTROL of Kruth et al.: the post plans, the simulation looks, and what neither solution of the rotary axes
// can avoid is answered by their Table 2: another clamping position (A), then a longer tool (B).
//
//   0. tool parts against the material as the CL data cut it: the same on every machine       -> B
//   1. for each clamping position of the grid the least sum of slide movements, over all ways through the
//      program, without looking at collisions: a lower bound
//   2. in the order of these bounds: full turn of the table, then the program with collisions
//   (CollisionJudge);
//      a position whose bound is not below the best valid one needs no simulation (branch and bound)
//   3. none is valid: B for the tool that it failed with, and again from 0; if there is no B either, the
//   position
//      that came farthest is told, and why each other failed
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "avoidance/trial.h"
#include "base/progress.h"
#include "post/post.h"
#include "sim/job/scene.h"

namespace swarf::avoidance {

enum class PositionState { kUntried, kOffTravel, kNoFullTurn, kCollides, kWorse, kValid };
const char* state_name(PositionState state);

/// A clamping position of the grid.
struct Position {
  Vec3 origin_M = Vec3::Zero();
  PositionState state = PositionState::kUntried;
  double bound_mm = 0.0;   ///< slides at the least; infinity: it cannot be driven at all
  double slides_mm = 0.0;  ///< of a valid one
  double time_s = 0.0;     ///< without accelerations
  std::string why;
  int line = 0;   ///< CL line that the program came to
  int tool = -1;  ///< index into Scene::tools that it failed with
  std::vector<Remedy> remedies;
};

struct Outcome {
  bool found = false;
  std::vector<Position> positions;
  size_t best = 0;                  ///< of the positions
  std::vector<double> extended_mm;  ///< by tool of the scene
  std::vector<Attempt> attempts;    ///< in their order; the last one is the program where one was found
  size_t simulations = 0;           ///< programs that were looked at for collisions
  /// Of the dynamic programming over all ways beside the backtracking at the best position, s.
  double backtrack_time_s = 0.0, best_time_s = 0.0;
  post::Preference preferred = post::Preference::kTime;  ///< what the best of all ways has least of
  long routes_dropped = 0;
};

/// What is to be avoided, and how scenes are loaded again with other values of their keys.
struct Task {
  const sim::Job* job = nullptr;  ///< of CL data, with scene.post
  std::function<sim::Job(const std::vector<std::string>& overrides)> load;
};

/// Throws InputError for CL data that cannot be posted at all.
Outcome control(const Task& task, Progress& progress);

/// Keys of the scene that make it the scene of the outcome, for --set. `written`: file of the NC program.
std::vector<std::string> overrides_of(const Outcome& outcome, const std::string& written,
                                      const std::string& dialect);

/// Writes the program of a found outcome as the scene's post has it.
post::PostResult write_program(const Task& task, const Outcome& outcome, const post::PostFormat& format,
                               const post::Writer::Out& out, Progress& progress, Diagnostics& diagnostics);

/// That came farthest of those that failed; null: none failed.
const Attempt* farthest_attempt(const Outcome& outcome);

/// Why there is no program, as diagnostics: the least bad position first.
Diagnostics diagnostics_of(const Outcome& outcome, const sim::Job& job);

}  // namespace swarf::avoidance
