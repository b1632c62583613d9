// A run whose stock and rays several processes share (base/ranks.h, stock/stock_tiles.h).
//
// Every rank loads the job and makes the sweeps, which are the same everywhere; each cuts its own tiles. Rank
// 0 is the run as it always is: it holds the whole stock, its own tiles always as they stand, the others' as
// they stood when it last asked. It asks before everything that looks at the whole: a sweep that may touch
// with the tool's body, a hash, a file, the end. So what it finds and writes is what one process finds and
// writes.
//
//   others    share out all tiles and cut them ahead of rank 0, as long as no sweep comes near them with the
//             tool's body; tell what they saw when they are asked; answer, cut, tell the changes in the order
//             of the questions
//   rank 0    motion, tables, raw stock; all meet -> take its own tiles from the others as they stand there;
//             look ahead -> all; cut -> all; cut; ...  changes? -> all, take them over, save
//
// Before the sweep at which they meet no rank has seen one that must be judged, and nobody looks at the whole
// stock: rank 0 never has to go back. The others may have to: where one rank finds a sweep that is to be
// judged and the others have gone past it, they begin their tiles again and cut them up to there. Before the
// stock is kept on the way they wait for rank 0.
//
// What follows the cut is dealt out (base/dealt_work.h): rank 0 sends what is needed with each question.
#pragma once

#include <functional>
#include <map>
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
  TileLead(Ranks& ranks, const CutParts& parts);

  /// Soon this rank will begin with the raw stock: the others finish what they cut, and wait. Earlier than
  /// begin(), because that takes them a while.
  void call_together();

  struct Start {
    size_t at = 0;              ///< sweeps that have cut the stock already
    bool is_raw = true;         ///< nothing is cut from it yet: the others may have begun
    bool may_go_ahead = false;  ///< see may_go_ahead()
    size_t look_at = 0;         ///< sweeps after which somebody looks at the whole stock
  };
  /// Takes this rank's tiles from the others, or deals them out. The stock must outlive this object. Throws
  /// InputError "rank-differs" when one has other sweeps, tools or stock, "rank-failed" when one could not
  /// begin.
  void begin(stock::Stock& stock, const Start& start);
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
  /// Sweeps that had cut the tiles of this rank when it took them.
  size_t own_from() const { return own_from_; }
  /// Of the whole stock, which is up to date. `is_busy`: this rank only deals as long as that is true.
  stock::StockProof prove(double slack_mm, const std::function<bool()>& is_busy) const;

 private:
  Bytes answer_of(int rank);
  bool keep_seen(int rank, const Bytes& message);
  void await_seen(int rank, size_t begin);
  size_t meet(size_t most);
  std::vector<int> ask_to_look(size_t begin, size_t end);
  void take_tiles(stock::Stock& stock);
  stock::TileSet held_by(int rank) const;
  void take_pieces(int rank);

  Ranks& ranks_;
  const CutParts& parts_;
  stock::Stock* stock_ = nullptr;
  std::optional<stock::StockTiles> tiles_;
  std::optional<stock::ContactFinder> finder_;      ///< of its own tiles
  std::vector<std::map<size_t, BatchState>> seen_;  ///< by rank and first sweep: told before it was asked for
  std::string broken_;
  bool are_called_ = false;      ///< the others, and have not answered yet
  size_t at_ = 0;                ///< sweeps that the run has come to
  size_t own_from_ = 0;          ///< before that its own tiles are no longer cut
  std::vector<uint32_t> taken_;  ///< of the share of each other rank: its own tiles
  bool is_whole_ = true;
};

/// Nothing but contacts and the keeping of the stock needs all of it on the way.
bool may_go_ahead(const CutOptions& options);

/// Memory that each rank may take, MB of 2^20 bytes: as told, else its share of what is free on its machine.
double rank_limit_mb(const Job& job, const CutOptions& options, const Ranks& ranks);
/// What each rank but 0, of more than one, is expected to take at its greatest, MB. `lead`: what rank 0 is.
double other_rank_mb(const Job& job, const MemoryPrediction& lead, int ranks);

/// What another rank has at hand.
struct TileService {
  const Job& job;
  CutParts& parts;  ///< they learn what rank 0 has found
  const MeasuredPath& measured;
  std::function<void()> cut_rays;  ///< cuts this rank's tiles of the measuring rays, in `measured`
  bool ahead;                      ///< may_go_ahead(): it cuts before it is asked
  double most_mb;                  ///< a larger stock it does not cut before it is asked
};
/// On another rank: does what rank 0 asks until it says that this is all.
void serve_tile_lead(Ranks& ranks, const TileService& service);
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
/// On rank 0: nothing more will be asked; the others end, and all leave. Again: nothing.
void dismiss_ranks(Ranks& ranks);

}  // namespace swarf::sim
