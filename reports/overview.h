// What is there, in one picture and without a run: a machine with its axes at zero and turned, a program's
// path in its stock.
#pragma once

#include "machine/machine_scene.h"
#include "render/draw_list.h"
#include "sim/job/scene.h"
#include "toolpath/tool_path.h"

namespace swarf::reports {

/// Two views of the machine: its axes at zero (in the middle of the travel where zero lies outside), then the
/// rotary axes at +30 degrees; without rotary axes the linear ones moved by 30 % of their travel. The arrows
/// stand on the work's origin: X red, Y green, Z blue; a purple line is a rotary axis. A machine without
/// meshes shows a plate under its work.
render::Image machine_overview(const machine::MachineScene& machine);

/// The path in the edges of the stock (feed moves orange, rapids blue), then the machine at the middle of the
/// path with the uncut stock. Jobs of blocks; throws InputError "nothing-to-show" for others.
render::Image job_overview(const sim::Job& job, const toolpath::ToolPath& path);

}  // namespace swarf::reports
