// A stock that several processes cut together, each its own tiles.
//
// A tile is a block of kTileLeaves x kTileLeaves columns of leaf positions, through the whole height. Tiles
// are dealt out in turn along x and along y, so that every row of a path, however it lies, is shared by all.
// What a leaf ends as depends on the sweeps and on the leaf alone, so tiles that were cut apart have the bits
// of a stock that was cut in one piece.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
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

/// Some of the tiles: of each share some parts.
struct TileSet {
  static constexpr uint32_t kAllParts = (1U << kTileParts) - 1U;
  TileSet(Share of = {}, uint32_t of_parts = kAllParts) : parts(static_cast<size_t>(of.count), 0) {
    parts[static_cast<size_t>(of.index)] = of_parts;
  }
  bool all() const;
  bool holds_column(int i, int j) const;  ///< in leaves from the grid's origin
  TileSet others() const;                 ///< all that are not in it

  std::vector<uint32_t> parts;  ///< by share, bit by bit
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
  /// The same of all own tiles but `kept`, which are left to another. None: nothing is left to tell, and from
  /// now on only `kept` are its own; leaves of the others are gone.
  std::optional<Bytes> next_left(const TileSet& kept);
  /// Everything in these tiles, for one that holds others. Piece by piece: the next one begins at position
  /// `from`, which is brought to where it ends. None: that was all.
  static std::optional<Bytes> next_tiles(const Stock& stock, const TileSet& tiles, size_t& from);
  /// Takes over what the others have told of a stock of the same raw shape and voxel size. Counts of work in
  /// it are added to the stock's own; its seconds become those of the slowest.
  void apply(std::span<const std::byte> changes);
  /// From the raw stock again: what was counted before, of more tiles, is not to be counted anew.
  void count_as(const CutStatistics& counts);

 private:
  std::optional<Bytes> next_of(const std::vector<uint8_t>* wanted);
  void take_position(BytesReader& in);

  Stock& stock_;
  std::vector<uint32_t> known_;  ///< LeafMap::cuts when they were told last
  CutStatistics told_;           ///< the same of the counts
  size_t next_ = 0;              ///< position that next_changes() goes on from
};

}  // namespace swarf::stock
