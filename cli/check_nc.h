// swarf check of NC programs: read and interpreted, nothing simulated.
#pragma once

#include <string>
#include <vector>

#include "cli/checked.h"

namespace swarf::cli {

/// What an NC program is checked with.
struct NcCheckOptions {
  std::string machine;                  ///< machine.toml or a shipped name; "": plain XYZ without limits
  std::string dialect;                  ///< "linuxcnc" ...; "": recognised
  std::string tools;                    ///< tool table, .toml or .tbl; "": none, lengths are 0
  bool drive = true;                    ///< with a machine: time and travel by look-ahead, as a run has them
  bool at_home = false;                 ///< the program starts at the machine's home
  std::string units;                    ///< "mm" or "inch" before G20 and G21; "": the machine's, or not said
  int start_tool = 0;                   ///< number of the tool in the spindle; 0: not said
  bool t_changes_tool = false;          ///< T changes the tool without M6
  std::string slot_ends;                ///< "edge" or "centre" (840D slots); "": not said
  std::vector<std::string> kinematics;  ///< "m430=identity" ...: what LinuxCNC's kinematics switches mean
  std::vector<std::string> parameters;  ///< "500=3.5", "R1=2": values before the program starts
  std::vector<std::string> builder_words;  ///< "M68", "M68=clamp C", "CYCL DEF 392", "LASERCHECK"
};

/// True for the endings of NC programs, or when options only they have are given. A .nc file with surface
/// blocks (G10 L70) is no NC program in this sense.
bool is_nc_program(const std::string& file, const NcCheckOptions& options);

/// Reads the program and tells dialect, lines, moves, paths, times, tools, start, extents and what has no
/// effect. Throws InputError.
Checked check_nc(const std::string& file, const NcCheckOptions& options);

}  // namespace swarf::cli
