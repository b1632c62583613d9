// The tools of a job: [cutter] for one, [[tool]] and tool_table for several.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/config.h"
#include "cutter/cutter.h"

namespace swarf::sim {

/// Tools by number whose lines in a .tbl cannot be used, each with its place and reason.
using IncompleteTools = std::map<int, std::string>;

/// All tools of a scene, in the order of their lines: [[tool]] of the scene, then those of `table_file`, the
/// file that `tool_table` names ("": none): TOML with [[tool]], or a LinuxCNC tool table (.tbl).
///
/// A .tbl has one tool a line, "T2 P2 Z81.5 D8 ; comment", lengths in mm: T is its number, Z its length from
/// the gauge line to the tip, D its diameter. What it cannot say is not made up in silence: without "ball" in
/// the comment the end is flat, the flutes reach up to the gauge line, there is no shank or holder below it,
/// and a warning ("tool-shape-assumed") says so for each tool. A tool that a [[tool]] describes too takes
/// everything from there but its length, which was measured at the machine.
///
/// Errors: "two-tool-sets" ([cutter] beside the others), "no-tools", "tool-unnamed" (neither number nor
/// name), "tool-twice", "bad-tool-name", what read_tool reports; of a .tbl "bad-tool-line" (unknown word,
/// word twice, bad number), "missing-tool-word" (T, Z or D), "unsupported-tool-offset" (X, Y or a rotary
/// offset), "tool-contradiction" (length or diameter differ from [[tool]]).
///
/// Tables of a shop have many tools, and a program calls a few: with `incomplete` a line of a .tbl that lacks
/// Z or D, has them at zero or below, or has offsets that cannot be used, is no error but kept there, to be
/// told where the tool is called; T0 (no tool) is passed over.
std::vector<cutter::Cutter> read_tools(ConfigTable& scene, const std::string& table_file,
                                       Diagnostics& diagnostics, IncompleteTools* incomplete = nullptr);

/// The tools of a table file alone, TOML or .tbl; errors as above.
std::vector<cutter::Cutter> read_tool_table(const std::string& table_file, Diagnostics& diagnostics,
                                            IncompleteTools* incomplete = nullptr);

/// Index of the tool with that number (above 0), or with that name; -1: the table lacks it.
int tool_index(const std::vector<cutter::Cutter>& tools, int number, const std::string& name);

/// "T1, T2 (DRILL_8)": for messages about a tool that is not among them.
std::string list_tools(const std::vector<cutter::Cutter>& tools);

}  // namespace swarf::sim
