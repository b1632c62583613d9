// Chips that fly from where material is removed: for the eye, yet as many as there is material for.
//
//   program   |----------x---------x---------x------|      x: tick, every so many cycles from cycle 0 on
//                        points of the flutes, drawn by block and cycle: does one move into material?
//
//   removed by a tick = time * area of the flutes * mean of max(0, v . n) over them, in material
//
// which is the volume that the flutes sweep out of the stock, by random points (Monte Carlo). Of it come
// volume / ChipClock::one_mm3 chips, a rest by chance, each from one of those points. Ticks, points and the
// stock they are asked of, whole sweeps only, do not depend on what frames there are: the chips of a moment
// follow from it, from the run and from the shot's clock alone.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "base/rng.h"
#include "reports/machine_view.h"
#include "reports/storyboard.h"
#include "sim/run/cut_along.h"

namespace swarf::reports {

/// In the air, in one picture. In the mean over the program kChipsMean fly in a moment; where much is removed
/// at once more do, up to kChipsMost, the newest.
inline constexpr size_t kChipsMost = 600;
inline constexpr double kChipsMean = 150.0;
/// A chip is seen so long, s of its flight; it falls 70 mm in them.
inline constexpr double kFlight_s = 0.12;
/// Seconds of flight in a second of the movie at most: at their own speed, some m/s, chips would be seen on
/// two frames.
inline constexpr double kFlightSpeed = 0.15;
/// At the rim of a tool whose spindle's speed nobody says, as of a path without a program, mm/s.
inline constexpr double kUnsaidCuttingSpeed = 3000.0;
inline constexpr double kGravity = 9806.65;  // mm/s2

struct Chip {
  double born_s = 0.0;                                        ///< program time
  Vec3 place_W = Vec3::Zero(), speed_W = Vec3::Zero();        ///< mm, mm/s: as it leaves the cutting edge
  kinematics::AxisValues q = kinematics::AxisValues::Zero();  ///< of the machine then
  size_t tool = 0;
  uint64_t seed = 0;
  double flown_s = 0.0;  ///< in the air by now, of its flight
};

/// How a shot shows its chips.
struct ChipClock {
  double flight = 1.0;   ///< seconds of flight in a second of the program: 1 in the program's own time
  size_t step = 1;       ///< cycles from tick to tick
  double one_mm3 = 0.0;  ///< removed material that a chip stands for; 0: none fly
};
/// `rate`: seconds of the program in a second of the movie; `removed_mm3`: by the program, in `time_s`.
ChipClock chip_clock(double rate, double removed_mm3, double time_s, double period_s);
/// Of the frames of a shot, by the median of their steps: a power of two, so that a part of the movie that is
/// made alone has the same.
double rate_of_shot(const std::vector<PlannedFrame>& frames, size_t shot, int fps, double period_s);

/// The chip in the drawing: thrown from `X_born`, the work frame of its birth in the drawing's, falling along
/// the drawing's -Z, at rest once it has come down to `lowest`.
Pose flown(const Chip& chip, const Pose& X_born, double lowest);

class Chips {
 public:
  /// References must outlive it.
  Chips(const FinishedRun& run, const std::vector<PlannedFrame>& frames);
  /// In the air at this frame, oldest first; none in a shot without chips. Fastest in the order of frames.
  std::vector<Chip> at(const PlannedFrame& frame);
  const ChipClock& clock(size_t shot) const { return clocks_[shot]; }
  /// Removed in the ticks of all calls, as it was estimated, mm3.
  double removed_mm3() const { return removed_mm3_; }

 private:
  /// The flutes' outline as cones: where random points are drawn from.
  struct Flutes {
    std::vector<Vec2> corners;    ///< (rho, z), from the tip
    std::vector<double> area_to;  ///< up to the end of each cone, mm2
  };
  struct Engaged {
    Vec3 place_W = Vec3::Zero(), outward_W = Vec3::Zero();  ///< outward: from the tool's axis, unit
    double rho = 0.0;                                       ///< mm
    double flux_to = 0.0;                                   ///< mm/s, of this one and all before it
  };
  void tick(uint64_t cycle, const ChipClock& clock);
  std::vector<Engaged> engaged(const motion::Cycle& before, const motion::Cycle& now, Rng& rng) const;
  Chip thrown(const motion::Cycle& now, double turn_rad_s, const std::vector<Engaged>& from, Rng& rng) const;

  const FinishedRun& run_;
  std::vector<ChipClock> clocks_;  ///< by shot
  std::vector<Flutes> flutes_;     ///< by tool
  std::optional<sim::CutAlong> along_;
  motion::CycleReader reader_;
  std::deque<Chip> flying_;
  size_t shot_ = 0;
  uint64_t now_ = 0, next_tick_ = 0;
  uint64_t cut_to_ = 0;  ///< tick that the stock stands at
  double removed_mm3_ = 0.0;
};

}  // namespace swarf::reports
