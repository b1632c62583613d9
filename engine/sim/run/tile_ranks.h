// A run whose stock and rays several processes share (base/ranks.h, stock/stock_tiles.h).
//
// Every rank loads the job and makes the motion, which is the same everywhere; each cuts its own tiles. Rank
// 0 is the run as it always is: it holds the whole stock, its own tiles always as they stand, the others' as
// they stood when it last asked. It asks before everything that looks at the whole: a sweep that may touch
// with the tool's body, a look of links and fixtures, a hash, a file, the end. So what it finds and writes is
// what one process finds and writes.
//
//   rank 0    look ahead -> all; cut -> all; cut; ...  changes? -> all, take them over, judge, save
//   others    wait for what is asked, in order: answer a look, cut, tell the changes
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "base/ranks.h"
#include "sim/run/cut_parts.h"
#include "sim/run/in_process_stock.h"
#include "stock/stock_tiles.h"

namespace swarf::sim {

/// Rank 0.
class TileLead {
 public:
  /// Waits until all others have their motion. Throws InputError "rank-differs" when one has other sweeps,
  /// tools or stock, "rank-failed" when one could not begin.
  TileLead(Ranks& ranks, const CutParts& parts);

  /// Deals the stock out. `is_raw`: nothing is cut from it yet. It must outlive this object.
  void begin(stock::Stock& stock, bool is_raw);
  /// Looks at the stock from sweep `begin` on, each rank at its own tiles.
  BatchState look_ahead(size_t begin, size_t end);
  /// Every rank cuts its own tiles.
  void cut(size_t begin, size_t end);
  /// Brings the whole stock up to date.
  void gather();

 private:
  Ranks& ranks_;
  const CutParts& parts_;
  stock::Stock* stock_ = nullptr;
  std::optional<stock::StockTiles> tiles_;
  std::optional<stock::ContactFinder> finder_;  ///< of its own tiles
  bool is_whole_ = true;
};

/// On another rank: does what rank 0 asks until it says that this is all. `rays`: cuts this rank's tiles of
/// the measuring rays, and what they are then, for each surface. `parts` learn what rank 0 has found.
void serve_tile_lead(Ranks& ranks, const Job& job, CutParts& parts,
                     const std::function<std::vector<Bytes>()>& rays);
/// On another rank that cannot begin: tells why, and waits for the end.
void refuse_tile_lead(Ranks& ranks, const std::string& why);

/// On rank 0: every other rank cuts its tiles of the rays; meanwhile this one may cut its own.
void ask_for_rays(Ranks& ranks);
/// The answer, rank by rank.
std::vector<Bytes> rays_of(Ranks& ranks, int rank);
/// On rank 0: nothing more will be asked.
void dismiss_ranks(Ranks& ranks);

}  // namespace swarf::sim
