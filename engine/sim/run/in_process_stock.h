// Stocks saved in the middle of a program, and cutting on from them.
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "sim/run/contact_event.h"
#include "sim/run/cut_identity.h"
#include "sim/run/program_place.h"
#include "stock/stock.h"

namespace swarf::sim {

/// What is known of the batch of sweeps that the cut stands in, from the stock before its first one.
struct BatchState {
  size_t end = 0;                    ///< sweeps, of the program's own batch; 0: none is begun
  double nearest_mm = 0.0;           ///< least gap of those that are clear of it
  std::vector<size_t> suspects;      ///< those that are not: judged when it is their turn
  std::vector<size_t> bad_suspects;  ///< of BadCutCheck
};

/// How far a cut has come.
struct CutState {
  size_t sweeps = 0;        ///< of the program's sweeps, from the first
  CutPlace place;           ///< of the last of them
  ToolClearance clearance;  ///< of the sweeps so far
  std::vector<BadCut> bad_cuts;
  BatchState batch;
  std::string stock_contacts;  ///< of StockContactCheck
};

/// Texts of a stock file: keys swarf_scene, swarf_program_line, swarf_time_s, swarf_sweeps, swarf_cutter,
/// ..., and one "swarf_part_<name>" for each part of the identity.
stock::StockMetadata cut_metadata(const std::string& scene_name, const CutIdentity& identity,
                                  const CutState& state);

/// "stock-not-resumable": the file lacks what a run goes on with.
InputError not_resumable(const std::string& path);
/// The identity of the cut that such texts name.
CutIdentity identity_in(const stock::StockMetadata& metadata);

/// Reads a stock and checks that it was cut by this very job; one that is not cut yet may be cut by any
/// motion of it, for the run may have been stopped before the whole motion was known. Throws InputError: what
/// Stock::load throws, "stock-not-resumable" for a stock without these texts, "resume-scene-changed" once for
/// each part of the identity that differs. `raw`: the job's raw stock, which the identity names.
stock::Stock load_in_process(const std::string& path, const CutIdentity& identity, const stock::RawShape& raw,
                             CutState& state);

/// Reads a stock and its texts as they are, to be saved again. Throws as Stock::load and
/// "stock-not-resumable".
stock::Stock load_unchecked(const std::string& path, stock::StockMetadata& metadata, CutState& state,
                            const stock::RawShape* raw = nullptr);

}  // namespace swarf::sim
