// How many leaves of the stock may stay in memory (--max-memory with --spill), and which: the program is
// known ahead, and so is when each tile of the stock is cut next.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/run/cut_parts.h"
#include "sim/run/memory.h"
#include "stock/stock.h"

namespace swarf::sim {

class LeafBudget {
 public:
  /// Sweeps between two calls of make_room(), at the most.
  static constexpr size_t kSweepsPerStep = 512;

  /// `folder`: where leaves go to. Throws InputError "out-of-memory" when the tiles of one step do not fit,
  /// "spill-disk-full" when there is less room than will be needed.
  LeafBudget(const Job& job, const CutParts& parts, const MemoryPrediction& memory, std::string folder);

  const stock::Spill& spill() const { return spill_; }
  /// Behind `sweeps` sweeps.
  void make_room(stock::Stock& stock, size_t sweeps) const;

 private:
  void find_uses(const CutParts& parts);
  size_t tiles_at_once() const;
  void require_disk(double leaves) const;

  stock::Spill spill_;
  stock::TileGrid tiles_;
  std::vector<std::vector<uint32_t>> steps_;  ///< of each tile: those that may cut it, in order
};

}  // namespace swarf::sim
