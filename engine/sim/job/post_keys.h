// The [post] table of a scene: its CL data become an NC program for the scene's machine, without collisions.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/config.h"

namespace swarf::sim {

/// Clamping positions that may be tried: a grid about the one that the scene says, as a table's slots give
/// it.
struct ClampingGrid {
  Vec3 step_mm = Vec3::Constant(10.0);  ///< in M
  std::array<int, 3> count{1, 1, 1};    ///< odd counts hold the scene's own position
  size_t size() const { return static_cast<size_t>(count[0] * count[1] * count[2]); }
};

/// By how much tools may be pulled out of their holders, or pushed in.
struct ToolReach {
  double step_mm = 5.0;
  double most_mm = 0.0;   ///< 0: not at all
  double least_mm = 0.0;  ///< 0 or less
};

struct PostSettings {
  std::string post = "fanuc";  ///< a shipped post, or a file
  std::optional<bool> tcp;     ///< none: as the post has it
  double tolerance_mm = 0.01;
  double axis_tolerance_rad = 0.0;
  bool best_routes = false;  ///< dynamic programming instead of the paper's backtracking
  /// What the best of all ways has least of, and where tilted planes are written; "": as the post has it.
  std::string prefer, planes;
  std::string unit;           ///< "mm" or "inch" of what is written; "": as the post has it
  double clearance_mm = 0.0;  ///< gaps of this or less count as collisions
  ClampingGrid grid;
  ToolReach reach;
  std::string written;              ///< the program that has been written: it is simulated instead; "": none
  std::vector<double> extended_mm;  ///< by tool of the scene
};

/// Reads the table; `tools`: how many the scene has.
PostSettings read_post(ConfigTable table, size_t tools);

}  // namespace swarf::sim
