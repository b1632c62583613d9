// The parts of machine.toml that describe axes, tool and rapid moves. Every function reports what is wrong to
// the diagnostics of its table and returns something usable, so that one reading finds every mistake.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/config.h"
#include "kinematics/machine_model.h"

namespace swarf::machine {

/// Three finite numbers; without a default the key is required.
Vec3 read_vec3(ConfigTable& table, const std::string& key,
               const std::optional<std::vector<double>>& fallback = {});

/// One [[axis]]: letter, geometry, travel, speeds (mm/min or deg/s in the file; mm/s or rad/s inside), home.
kinematics::Axis read_axis(ConfigTable& table);

/// [tool]: axis and exactly one of gauge_mm (then the tip follows from the tool, with_tool) and tip_mm (it
/// stays). Until a tool is known the tip of a machine with a gauge line stands on it.
void read_tool(ConfigTable& root, kinematics::MachineModel& machine);

/// `rapid` and [tool_change] (axis values in machine coordinates, X_mm, A_deg, ...; an axis that is left out
/// stands at home). Needs the axes.
void read_rapid(ConfigTable& root, kinematics::MachineModel& machine);

}  // namespace swarf::machine
