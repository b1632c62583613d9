// The [setup] table of a scene: where the work is clamped, and what stands in the control before the program
// starts.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/config.h"
#include "base/frames.h"
#include "kinematics/machine_model.h"
#include "program/cl/program.h"
#include "program/nc_program.h"

namespace swarf::sim {

/// X_mm = 12.5 or C_deg = 90.
struct AxisSetting {
  std::string axis;
  bool rotary = false;
  double value = 0.0;  ///< mm or rad
  SourceLocation where;
};
using AxisSettings = std::vector<AxisSetting>;

struct SetupSettings {
  int number = 0;                ///< from 1 on, of several [[setup]]; 0: there is one, [setup]
  std::string name;              ///< of several; "": not said
  Pose X_WF = Pose::Identity();  ///< from the work frame of the first of them: `part_pose`
  bool pose_said = false;
  /// Origin of W in M with all axes at zero; none: what the machine says.
  std::optional<Vec3> work_origin_mm;
  bool on_table = false;                ///< "on_table": the origin follows from the stock (open_job.h)
  double work_rotation_rad = 0.0;       ///< of W about Z of M, through its origin: how the part is clamped
  std::map<int, AxisSettings> offsets;  ///< 1: G54, ..., 6: G59, 7: G59.1, 8: G59.2, 9: G59.3
  std::optional<AxisSettings> start;    ///< axis values where the program starts
  std::optional<double> unit_mm;  ///< `units` of programs without G20 and G21, 1 or 25.4; none: the machine's
  int start_tool = 0;             ///< number of the tool in the spindle; 0: not said
  std::string start_tool_name;    ///< or its name; "": not said
  SourceLocation start_tool_where;
  bool t_changes_tool = false;                 ///< T changes the tool without M6
  std::optional<program::SlotEnds> slot_ends;  ///< 840D: what RAD and AFSL of slots count to
  std::optional<program::ClTracut> tracut;     ///< CL: what positions behind TRACUT are
  bool tip_without_length = false;  ///< `without_length = "tip"`: of a program that calls no tool length
};

/// Reads [setup], or the keys of one of several that belong there (`number` from 1 on); offsets, start,
/// units, start_tool and t_changes_tool belong to NC programs only. "unknown-offset" for what is not G54 to
/// G59.3, "part-pose-of-first" where the first of several names the frame that it defines itself.
SetupSettings read_setup(ConfigTable table, bool nc, int number = 0);

/// The settings as values of this machine; what is not named is zero. "unknown-axis" for an axis that it
/// lacks, "wrong-unit" for mm on a rotary axis and the reverse. `complete`: every axis has to be named
/// ("missing-axis").
kinematics::AxisValues axis_values(const AxisSettings& settings, const kinematics::MachineModel& machine,
                                   bool complete, Diagnostics& diagnostics);

}  // namespace swarf::sim
