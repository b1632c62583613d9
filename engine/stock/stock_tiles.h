// A stock that several processes cut together, each its own tiles.
//
// A tile is a block of kTileLeaves x kTileLeaves columns of leaf positions, through the whole height. Tiles
// are dealt out in turn along x and along y, so that every row of a path, however it lies, is shared by all.
// What a leaf ends as depends on the sweeps and on the leaf alone, so tiles that were cut apart have the bits
// of a stock that was cut in one piece.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/bytes.h"
#include "base/ranks.h"
#include "stock/stock.h"

namespace swarf::stock {

inline constexpr int kTileLeaves = 8;

/// Whose the column of leaf positions is; `i`, `j`: in leaves from the grid's origin.
int owner_of_column(int i, int j, int count);

/// The tiles of a share are divided into so many parts, each spread evenly over the stock.
inline constexpr int kTileParts = 8;
int part_of_column(int i, int j, int count);

/// Tiles of a share: some of its parts.
struct TileSet {
  static constexpr uint32_t kAllParts = (1U << kTileParts) - 1U;
  TileSet(Share of = {}, uint32_t of_parts = kAllParts) : share(of), parts(of_parts) {}
  bool all() const { return share.all() && parts == kAllParts; }

  Share share;
  uint32_t parts;  ///< bit by bit
};

class StockTiles {
 public:
  /// The raw stock in these tiles alone; the others are air and take no leaves.
  static Stock own_tiles(const RawShape& raw, double voxel_mm, const TileSet& own);

  /// From now on Stock::cut() cuts these tiles alone, and ContactFinder can be asked for them alone;
  /// the others change by apply(). The stock must outlive it. What it is now counts as known to the others.
  StockTiles(Stock& stock, const TileSet& own);

  /// What has changed in these tiles since they were known last, in pieces of few megabytes, each known
  /// with this. None: nothing is left.
  std::optional<Bytes> next_changes();
  /// Everything in the tiles of another share, for one that begins; or in all others, for one that holds
  /// these. Piece by piece: the next one begins at position `from`, which is brought to where it ends. None:
  /// that was all.
  enum class Which { kOfShare, kOfOthers };
  static std::optional<Bytes> next_tiles(const Stock& stock, Share share, Which which, size_t& from);
  /// Takes over what next_changes() or next_tiles() of a stock of the same raw shape and voxel size has told.
  /// Counts of work in it are added to the stock's own; its seconds become those of the slowest.
  void apply(const Bytes& changes);

 private:
  void take_position(BytesReader& in);

  Stock& stock_;
  std::vector<uint32_t> known_;  ///< LeafMap::cuts when they were told last
  CutStatistics told_;           ///< the same of the counts
  size_t next_ = 0;              ///< position that next_changes() goes on from
};

}  // namespace swarf::stock
