// The tool table as programs call it.
#pragma once

#include <string>

#include "program/control/control.h"

namespace swarf::program::nc {

/// Index into ControlSetup::tools. "unknown-tool" names it and the tools there are. With an empty table
/// nothing can be looked up: returns -1 and warns once ("no-tool-table").
int find_tool(Control& control, int number, int column);
int find_tool(Control& control, const std::string& name, int column);
/// True where there is no tool table: the radius of every cutter is 0 then, as its length, and the warning
/// "no-tool-table" says so.
bool no_tool_table(Control& control, int column);
/// What stands ready (T); change_tool() puts it into the spindle. -1 with `number` 0 empties the spindle.
void select_tool(ToolState& tools, int index, int number);
/// M6: moves to MachineModel::tool_change where the machine has one (rapid, all axes), stops the spindle.
/// The compensated length stays what it is; the dialect sets it.
void change_tool(Control& control);
/// The tool that is in the spindle already: no change, no motion.
void declare_tool(Control& control, int index, int number);
/// The tool in the spindle, null when there is none or no table.
const NcTool* active_tool(const Control& control);
/// Compensated length c; 0 with G49, D0. The tip itself always stands where the tool's true length puts it.
void set_length_compensation(Control& control, double length_mm, bool on);
/// True while positions are those of the tip for want of a length (ControlSetup::tip_without_length).
bool tip_is_reference(const Control& control);
/// Takes up the tool in the spindle: where its tip stands now.
void set_true_tool(Control& control);

}  // namespace swarf::program::nc
