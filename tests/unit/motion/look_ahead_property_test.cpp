// No axis exceeds its speed, acceleration or jerk, whatever the program; by differences of the samples.
// SWARF_LOOK_AHEAD_PROGRAMS=10000 runs as many programs of 200 blocks (default 12).
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>

#include "motion/judged/motion_check.h"
#include "unit/motion/random_program.h"

namespace swarf::motion {
namespace {

TEST(LookAhead, NoAxisLimitIsExceededInRandomPrograms) {
  const char* asked = std::getenv("SWARF_LOOK_AHEAD_PROGRAMS");
  const int programs = asked != nullptr ? std::atoi(asked) : 12;
  const kinematics::MachineModel machine = paper_machine();
  double worst = -1.0, deviation = 0.0, hours = 0.0;
  for (int n = 0; n < programs; ++n) {
    const auto seed = static_cast<uint64_t>(1000 + n);
    Rng rng(seed);
    const toolpath::ToolPath path = random_program(machine, rng, 200);
    Progress silent;
    const Interpolated result = interpolate(path, machine, cutter::Cutter{}, MotionOptions{}, silent);
    const Excess excess = axis_excess(result.trajectory, machine);
    worst = std::max(worst, excess.relative);
    deviation = std::max(deviation, result.statistics.corner_deviation_max_mm);
    hours += result.statistics.time_s / 3600.0;
    EXPECT_LE(excess.relative, 1e-9) << "Rng rng(" << seed << "); " << excess.text;
  }
  RecordProperty("programs", programs);
  fmt::print("{} programs, {:.3f} h: greatest excess {:.3g} relative, greatest corner deviation {:.4f} mm\n",
             programs, hours, worst, deviation);
}

}  // namespace
}  // namespace swarf::motion
