// A run whose stock and rays several processes share (base/ranks.h, stock/stock_tiles.h).
//
// Every rank loads the job and makes the sweeps, which are the same everywhere; each cuts its own tiles. Rank
// 0 is the run as it always is: it holds the whole stock, its own tiles always as they stand, the others' as
// they stood when it last asked. It asks before everything that looks at the whole: a sweep that may touch
// with the tool's body, a hash, a file, the end. So what it finds and writes is what one process finds and
// writes.
//
//   rank 0    motion, tables; look ahead -> all; cut -> all; cut; ...  changes? -> all, take them over, save
//   others    cut their tiles ahead of rank 0 as long as no sweep comes near them with the tool's body; tell
//             what they saw when they are asked; answer, cut, tell the changes in the order of the questions
//
// Rank 0 comes late, so it leaves some of its tiles to those that were ahead. Where one rank finds a sweep
// that is to be judged, the others may have gone past it: they begin their tiles again and cut them up to
// there. Before the stock is kept on the way they wait for rank 0.
//
// What follows the cut is dealt out (base/dealt_work.h): rank 0 sends what is needed with each question.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/dealt_work.h"
#include "base/ranks.h"
#include "sim/run/cut_parts.h"
#include "sim/run/cut_stage.h"
#include "sim/run/in_process_stock.h"
#include "sim/run/prove_part.h"
#include "stock/stock_slabs.h"
#include "stock/stock_tiles.h"

namespace swarf::sim {

/// Rank 0.
class TileLead {
 public:
  /// Waits until all others have their motion. Throws InputError "rank-differs" when one has other sweeps,
  /// tools or stock, "rank-failed" when one could not begin.
  TileLead(Ranks& ranks, const CutParts& parts);

  /// Deals the stock out, as `at` sweeps have cut it. `is_raw`: nothing is cut from it yet. It must outlive
  /// this object.
  void begin(stock::Stock& stock, size_t at, bool is_raw);
  /// Looks at the stock from sweep `begin` on, each rank at its own tiles.
  BatchState look_ahead(size_t begin, size_t end);
  /// Every rank cuts its own tiles.
  void cut(size_t begin, size_t end);
  /// Brings the whole stock up to date.
  void gather();

  /// Nobody cuts on before cut() says so; after so many sweeps all are at the same place.
  size_t hold();
  /// Others need not wait for this one any more.
  void go_ahead();

  /// What the others have told of broken invariants on the way; "": nothing.
  const std::string& broken() const { return broken_; }
  /// Of the whole stock, which is up to date.
  stock::StockProof prove(double slack_mm) const;

 private:
  Ranks& ranks_;
  const CutParts& parts_;
  stock::Stock* stock_ = nullptr;
  std::optional<stock::StockTiles> tiles_;
  std::optional<stock::ContactFinder> finder_;  ///< of its own tiles
  std::vector<size_t> ahead_;                   ///< sweeps that the others had cut when they were asked first
  std::string broken_;
  size_t at_ = 0;  ///< sweeps that have cut its own tiles
  bool is_whole_ = true;
};

/// Nothing but contacts and the keeping of the stock needs all of it on the way.
bool may_go_ahead(const CutOptions& options);
/// On rank 0, before its motion: the others begin to cut the raw stock.
void let_ranks_go_ahead(Ranks& ranks);

/// On another rank: does what rank 0 asks until it says that this is all. `cut_rays`: cuts this rank's tiles
/// of the measuring rays, in `measured`. `parts` learn what rank 0 has found.
void serve_tile_lead(Ranks& ranks, const Job& job, CutParts& parts, const MeasuredPath& measured,
                     const std::function<void()>& cut_rays);
/// On another rank that cannot begin: tells why, and waits for the end.
void refuse_tile_lead(Ranks& ranks, const std::string& why);

/// On rank 0: every other rank cuts its tiles of the rays; meanwhile this one may cut its own.
void ask_for_rays(Ranks& ranks);
/// The answer, rank by rank.
std::vector<Bytes> rays_of(Ranks& ranks, int rank);
/// On rank 0, for the proof of the part: the others learn the whole stock, then of each surface what is
/// known, then work on its roots.
void send_whole_stock(Ranks& ranks, const stock::Stock& stock);
void ask_for_proof(Ranks& ranks, const KnownOfPart& known);
void deal_roots(Ranks& ranks, const DealtWork& work);
/// On rank 0: nothing more will be asked.
void dismiss_ranks(Ranks& ranks);

}  // namespace swarf::sim
