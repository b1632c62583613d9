// Places in a program as a user writes them, and the sweeps that lie there.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "motion/tool_sample.h"
#include "sim/run/cut_sweeps.h"
#include "toolpath/tool_path.h"

namespace swarf::sim {

/// "13": after the last motion of program line 13, the line that findings and blocks.csv name.
/// "12.5s": program time, after the last motion that is complete then.
/// "T5", "T=DRILL_8": after the last motion of that tool.
struct ProgramPlace {
  std::string text;  ///< as written
  int line = 0;      ///< 1-based; 0: a time is meant
  double t_s = 0.0;
  int tool_number = 0;    ///< above 0: a tool is meant
  std::string tool_name;  ///< not empty: a tool is meant
};

/// A list with commas. Throws InputError "bad-place".
std::vector<ProgramPlace> parse_places(const std::string& list);

/// Where a sweep stands in the program.
struct CutPlace {
  uint32_t block = 0;  ///< Sweep::block
  int line = 0;        ///< of the program
  double t_s = 0.0;    ///< at the sweep's end
};

/// The line of the block that sweep `n` comes from, and when the tool comes to the sweep's end.
CutPlace place_of(const CutSweeps& sweeps, size_t n, const toolpath::Elements& elements,
                  motion::CycleReader& reader);

/// Number of sweeps up to and including the place. Throws InputError "place-unknown" for a line without
/// motion (naming the nearest with), for a time outside the program and for a tool that never moves.
size_t sweeps_until(const ProgramPlace& place, const CutSweeps& sweeps, const motion::Cycles& cycles,
                    const std::vector<cutter::Cutter>& tools);

}  // namespace swarf::sim
