// The scene that the flags of a command line mean: the same text that a scene.toml holds, read by the same
// reader.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/frames.h"
#include "sim/job/scene.h"

namespace swarf::sim {

/// A job as flags say it. What is left out is left to the reader of scenes, which fills it in and says so.
struct JobFlags {
  std::string program_file;
  bool cl_data = false;  ///< else an NC program
  std::string machine;   ///< name of a shipped one, or a file; "": the generic three-axis mill
  std::string tools;     ///< words (tool_words.h); "": `tool_table`
  std::string tool_table;
  std::optional<Box> stock_W;  ///< mm; none: from the path, or
  std::string stock_keys;      ///< keys of [stock] in TOML for another shape; "": none
  std::optional<double> voxel_mm;
  std::optional<Vec3> origin_M;  ///< mm; none: the stock stands on the table
  std::string design;            ///< closed mesh; "": nothing is measured
  std::string units, dialect;    ///< "": not said
  int start_tool = 0;            ///< 0: not said
  bool t_changes_tool = false;
  std::string slot_ends;  ///< "": not said
  std::string tracut;     ///< "": not said; of CL data
};

/// scene.toml; the paths in it are those of the flags, absolute or from the current folder.
std::string scene_text(const JobFlags& flags);

/// "0,0,-10,40,30,0" as two corners in mm. Throws InputError "bad-stock" with what is wrong: another count,
/// no number, corners that are no box (the remedy is the same box the right way round).
Box parse_stock(const std::string& text);

/// What --stock says: a box as above into stock_W, else stock_keys: "cyl,D,L" and "tube,D,d,L" stand on the
/// work's origin and reach down from it by L, "casting.stl" (.ply, .obj) is a mesh in mm in the work frame.
/// Throws InputError "bad-stock".
void take_stock(const std::string& text, JobFlags& flags);

/// "0,0,160": three numbers. Throws InputError "bad-option" that names `flag`.
Vec3 parse_vector(const std::string& flag, const std::string& text);

/// A basic string of TOML, quoted.
std::string toml_string(const std::string& text);

}  // namespace swarf::sim
