// What a scene leaves open and its program settles: whose tool the only one is, the block of stock, its
// voxel, where it stands on the machine. Every value that was taken is a row of Scene::assumptions.
//
//   tools    one tool without a number is the only one that the program asks for
//   box      the tip's way over all feed moves, the largest radius and 2 mm on every side, 2 mm below; its
//   top is
//            Z 0 where an upright tool goes below it (the usual zero of a milled part), else the highest feed
//            move, 2 mm above it where all are at one height; with a mesh as design the box holds it too
//   voxel    a twentieth of the smallest tool; coarser where the faces would have more than 600 000 cells or
//            2 GB or half of the free memory would not hold them; never above a quarter of the tool or of the
//            block
//   origin   "on_table": the middle of the stock's lower face 100 mm above the machine's own work origin, as
//   a
//            vice holds it
#pragma once

#include <string>

#include "base/diagnostics.h"
#include "cutter/cutter.h"
#include "sim/job/scene.h"

namespace swarf::sim {

/// A grid on which the block or a tool's cut has no extent shows nothing ("out-of-range").
void check_voxel(const StockSettings& stock, const std::vector<cutter::Cutter>& tools,
                 Diagnostics& diagnostics);

/// Gives the tools of `tools = "6"` the number that the program calls, and says what a list lacks. NC and CL
/// jobs whose program has not been loaded. "unknown-tool" names every tool that the program asks for.
void bind_tools(Job& job, Diagnostics& diagnostics);

/// The shipped machines that turn, for messages: "fork_head (XYZCA), head_table_bc (XYZBC)".
std::string five_axis_machines();

/// Box, voxel and origin, where they are open, of a job whose machine, program and design are loaded.
/// "machine-needed": a program of five axes and a scene without a machine; "nothing-to-cut": no feed move.
void fill_open(Job& job, Diagnostics& diagnostics);

}  // namespace swarf::sim
