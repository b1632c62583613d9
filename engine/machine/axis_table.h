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

/// Accelerations and jerks that the file does not give: those that machines of this size usually have, by the
/// longest linear travel: up to 1000 mm 4000 mm/s2 and 50000 mm/s3 (rotary 600 deg/s2, 12000 deg/s3), up to
/// 2500 mm 3000 and 40000 (400, 8000), else 1500 and 20000 (200, 4000). Says which; "": none was left out.
std::string set_usual_dynamics(std::vector<kinematics::Axis>& axes);

/// [tool]: axis and exactly one of gauge_mm (then the tip follows from the tool, with_tool) and tip_mm (it
/// stays). Until a tool is known the tip of a machine with a gauge line stands on it.
void read_tool(ConfigTable& root, kinematics::MachineModel& machine);

/// `rapid` and [tool_change] (axis values in machine coordinates, X_mm, A_deg, ...; an axis that is left out
/// stands at home). Needs the axes.
void read_rapid(ConfigTable& root, kinematics::MachineModel& machine);

}  // namespace swarf::machine
