// How a path is interpolated.
#pragma once

#include <string>
#include <vector>

#include "base/units.h"

namespace swarf::motion {

enum class Mode {
  kTaylor1,  ///< "taylor1": Lin & Koren Eq. (5), u += V T / |C'|
  kSurface,  ///< "surface": Taylor 2 and two Newton steps on the chord, the production rule
  kOffline,  ///< "offline": straight segments by chord tolerance, what a CAM system would have written
};

/// The tool axis along an off-line segment whose ends carry exact normals.
enum class OfflineOrientation {
  kConstant,          ///< that of the segment's start; the tool turns at rest at its end, so it always stops
  kLinearInU,         ///< Lin & Koren Eq. (7)
  kLinearAlongChord,  ///< what controls do, and what reproduces the paper's Fig. 6 (erratum E5)
};

struct MotionOptions {
  Mode mode = Mode::kSurface;
  /// Control cycle, s. Shorter: smaller chords and more samples.
  double period_s = 1e-3;
  /// Of the contact point along the path, mm/s^2. Axis limits may lower it.
  double path_acceleration_max = 2000.0;
  /// Of the contact point along the path, mm/s^3. Lower: gentler starts and stops, longer times.
  double path_jerk_max = 50000.0;
  /// Off-line mode only.
  OfflineOrientation orientation = OfflineOrientation::kLinearAlongChord;
  /// Off-line mode only: pass through corners at the speed that the chord tolerance allows instead of
  /// stopping at the end of each block (erratum E19). Without effect on constant orientation.
  bool look_ahead = true;
  /// Blocks: how far the tip may leave a corner between blocks that give no tolerance of their own (G64 P,
  /// CYCLE832), mm. Larger: corners are passed faster.
  double corner_tolerance_mm = 0.01;
  /// Feed blocks that turn their rotary axes by more per mm of the tip are reported, rad/mm.
  double fast_rotary_rad_mm = 10.0 * kPi / 180.0;
  /// Blocks that turn one rotary axis by more are reported, rad.
  double swing_rad = kPi;
};

/// Every contradiction in the options, in words with numbers; empty when they can be used.
std::vector<std::string> validate(const MotionOptions& options);

}  // namespace swarf::motion
