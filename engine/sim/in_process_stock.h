// Stocks saved in the middle of a program, and cutting on from them.
#pragma once

#include <string>
#include <vector>

#include "sim/bad_cuts.h"
#include "sim/cut_identity.h"
#include "sim/program_place.h"
#include "sim/tool_clearance.h"
#include "stock/stock.h"

namespace swarf::sim {

/// How far a cut has come.
struct CutState {
  size_t sweeps = 0;        ///< of the program's sweeps, from the first
  CutPlace place;           ///< of the last of them
  ToolClearance clearance;  ///< up to the last whole batch of sweeps
  std::vector<BadCut> bad_cuts;
};

/// Texts of a stock file: keys swarf_scene, swarf_program_line, swarf_time_s, swarf_sweeps, swarf_cutter,
/// ..., and one "swarf_part_<name>" for each part of the identity.
stock::StockMetadata cut_metadata(const std::string& scene_name, const CutIdentity& identity,
                                  const CutState& state);

/// Reads a stock and checks that it was cut by this very job. Throws InputError: what Stock::load throws,
/// "stock-not-resumable" for a stock without these texts, "resume-scene-changed" once for each part of the
/// identity that differs.
stock::Stock load_in_process(const std::string& path, const CutIdentity& identity, CutState& state);

}  // namespace swarf::sim
