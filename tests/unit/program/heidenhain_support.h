// Runs Heidenhain conversational programs for the tests.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "unit/program/nc_support.h"

namespace swarf::program {

/// Runs blocks between BEGIN PGM and END PGM.
inline NcRun klartext(const std::string& blocks, const ControlSetup& setup = three_axis_setup(),
                      const char* unit = "MM") {
  return run_text(std::string("BEGIN PGM TEST ") + unit + "\n" + blocks + "END PGM TEST " + unit + "\n",
                  Dialect::kHeidenhain, setup);
}

/// The same, and says so when there are errors.
inline NcRun klartext_clean(const std::string& blocks, const ControlSetup& setup = three_axis_setup(),
                            const char* unit = "MM") {
  NcRun run = klartext(blocks, setup, unit);
  EXPECT_EQ(run.text(), "") << blocks;
  return run;
}

/// Trunnion A with table C whose A turns all the way round.
inline ControlSetup free_five_axis_setup() {
  ControlSetup setup = five_axis_setup();
  for (kinematics::Axis& axis : setup.machine.axes) {
    if (axis.name == "A") axis.min = -kPi, axis.max = kPi;
  }
  return setup;
}

/// Heights of all moves, mm.
inline std::vector<double> heights(const NcRun& run) {
  std::vector<double> z;
  for (const NcMove& move : run.moves()) z.push_back(move.to.tip_W.z());
  return z;
}

inline void expect_heights(const NcRun& run, const std::vector<double>& expected) {
  const std::vector<double> z = heights(run);
  ASSERT_EQ(z.size(), expected.size()) << testing::PrintToString(z);
  for (size_t i = 0; i < z.size(); ++i) EXPECT_NEAR(z[i], expected[i], 1e-9) << "move " << i;
}

}  // namespace swarf::program
