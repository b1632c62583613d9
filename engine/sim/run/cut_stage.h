// The stage that cuts the stock: resumed from a saved stock, saved on the way, recorded, checked, stopped.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "base/ranks.h"
#include "base/time_budget.h"
#include "sim/job/scene.h"
#include "sim/run/in_process_stock.h"
#include "sim/run/memory.h"
#include "sim/run/program_place.h"

namespace swarf::sim {

struct MeasuredPath;
struct Result;

/// What the user asked of the cut besides the finished part.
struct CutOptions {
  std::string resume_file;               ///< go on from this stock; empty: from the box
  std::vector<ProgramPlace> save_after;  ///< a stock file for each
  /// For save_after, the record and the tables of the motion (recorder.h), which need it; exists.
  std::string save_folder;
  bool record = false;        ///< keep the sweeps and hashes of the stock (CutStage::kRecordFile)
  size_t record_every = 256;  ///< sweeps between two hashes
  /// Keep the stock so far in kKeptStock whenever so many seconds have passed, for a run that is killed; 0:
  /// never.
  double keep_every_s = 0.0;
  /// Leaves of the stock go to the disk, in save_folder, when more memory is expected to be needed than may
  /// be used: slower, the same results. Not together with check_voxels.
  bool spill = false;
  double max_memory_mb = 0.0;          ///< 0: what the scene says
  bool check_voxels = false;           ///< costly invariants on the way too; twice the stock's memory
  Outputs outputs;                     ///< what follows: its memory counts
  std::vector<std::string> overrides;  ///< of the scene, for the record
  Ranks* ranks = nullptr;              ///< cut tile by tile with these (tile_ranks.h); null: alone
  TimeBudget budget;                   ///< of the whole run; cutting and measuring always end
};

inline constexpr const char* kRecordFile = "run.record";
inline constexpr const char* kFinishedStock = "stock.vdb";
inline constexpr const char* kKeptStock = "stock_so_far.vdb";

/// What came of them.
struct CutOutcome {
  CutState state;                  ///< where the cut ended
  size_t resumed_from = 0;         ///< sweeps that the resumed stock had seen; 0: none
  std::vector<std::string> saved;  ///< names of the files in save_folder
  stock::StockMetadata metadata;   ///< for the finished stock's file
  bool is_written = false;         ///< that file, kFinishedStock in save_folder
  int map_checks = 0;              ///< times that invariants 1 to 4 were checked
  int voxel_checks = 0;            ///< times that all of them were
  std::string broken_invariant;    ///< in words with its place; "": all hold
};

/// The file in save_folder for a place.
std::string saved_stock_name(const ProgramPlace& place);

/// Cuts result.main's path; fills stock, clearance, volumes and cut outcome. Stops between batches of sweeps
/// when the user asks. The stock does not depend on the options: resumed, saved, recorded and plain runs end
/// with equal hashes. Throws InputError: "place-unknown", "place-before-resume", what load_in_process throws,
/// "out-of-memory", "spill-disk-full", "spill-unwritable".
void cut_stock(const Job& job, const CutOptions& options, Progress& progress, Result& result);

/// For a run that was stopped before its motion was known: the stock as it was when the run began, to go on
/// from. Throws InputError as load_unchecked().
void leave_uncut(const Job& job, const CutOptions& options, Result& result);

}  // namespace swarf::sim
