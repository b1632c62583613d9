// The record of a cut: what went in, sweep by sweep, and hashes of what came out. A text file:
//
//   swarf-record 1
//   scene dome/scene.toml               as it was named, seen from the folder it was run in
//   set stock.voxel_mm=0.5              one line for each --set
//   part <name> = <value>               the cut's identity
//   every 256
//   program <number of sweeps>          of the whole program; a stopped run holds fewer
//   sweep <block> <line> <t_s> <tip x y z> <axis i j k>     where it ends; it starts where the last one ended
//   tool <index>                        of the scene's tools, from here on; 0 before the first
//   jump <tip x y z> <axis i j k>       or here
//   state <hash>                        of the stock after so many sweeps, and at the end
//   end <number of sweeps> <checksum of all before>
//
// Numbers are the shortest decimals that read back to the same bits.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/run/cut_identity.h"
#include "sim/run/program_place.h"

namespace swarf::sim {

struct CutRecord {
  std::string scene;
  std::vector<std::string> overrides;
  CutIdentity identity;
  size_t every = 256;         ///< sweeps between two states
  size_t program_sweeps = 0;  ///< of the whole program: a stopped run holds fewer
  std::vector<stock::Sweep> sweeps;
  std::vector<CutPlace> places;  ///< one per sweep
  std::vector<int> tools;        ///< one per sweep: index into the scene's tools
  std::vector<uint64_t> states;  ///< after `every`, 2 `every`, ... sweeps, and after the last
};

/// Replaced whole. Throws InputError "record-unwritable".
void write_record(const std::string& path, const CutRecord& record);

/// Throws InputError: "record-unreadable", "record-foreign", "record-incomplete", "record-damaged".
CutRecord read_record(const std::string& path);

}  // namespace swarf::sim
