// What the ranks of a run tell each other (tile_ranks.h). Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "base/ranks.h"
#include "sim/run/cut_identity.h"
#include "sim/run/cut_parts.h"
#include "sim/run/in_process_stock.h"
#include "stock/contact/contact_finder.h"

namespace swarf::sim {

/// Bytes of a MB.
inline constexpr double kMbOfRank = 1024.0 * 1024.0;

/// First byte of every message of rank 0.
enum class TileRequest : uint8_t {
  kAhead,    ///< cut on without being asked                          no answer
  kHold,     ///< no longer: where it stands
  kMeet,     ///< sweeps, to cut up to or to come back to: the same
  kHello,    ///< what the rank is about to cut, or why it cannot begin
  kLeft,     ///< parts that rank 0 takes: the first pieces of StockTiles::next_left()
  kStock,    ///< the stock comes, cut by so many sweeps              no answer
  kTiles,    ///< positions to take over: an empty message
  kLook,     ///< begin, end, bad cuts so far: what it looks like     no answer where it has told of it
  kNearest,  ///< begin, end, suspects of all ranks: the least gap of the other sweeps
  kCut,      ///< begin, end                                          no answer
  kChanges,  ///< sweeps: the first pieces of StockTiles::next_changes()
  kMore,     ///< the next piece of either                            no answer behind the last one
  kSlab,     ///< sweeps, then what stock_slabs.h asks
  kRays,     ///< SurfaceDexels::tiles_of(), for each surface
  kProof,    ///< what is known of a surface of the part              no answer
  kRoots,    ///< of that surface: RootProver::prove()
  kEnd,      ///< nothing more is asked: the same, as the last message of all
};

/// Pieces of one rank on their way: one is told while another is taken over. Each stands behind the broken
/// invariant; an empty one is the last.
inline constexpr int kPiecesOnTheirWay = 2;

/// First byte of every message of another rank that belongs to the cut.
enum class TileAnswer : uint8_t {
  kAsked,  ///< to a question
  kSeen,   ///< what a batch that it has begun ahead of rank 0 looked like; nobody has asked
};

/// Where another rank stands.
struct Standing {
  size_t at = 0;       ///< sweeps that its tiles have seen
  bool waits = false;  ///< the next ones it must not cut before rank 0 comes to them
  uint32_t parts = 0;  ///< of its share, those that are its own
};

/// The head of a message, of rank 0 and of another.
BytesWriter tile_request(TileRequest what);
BytesWriter answer_to(TileAnswer what);
/// An answer, read from behind its head on.
BytesReader behind_first(const Bytes& message);

/// What a batch looks like, in a message.
void add_seen(const BatchState& seen, BytesWriter& out);
BatchState get_seen(BytesReader& in);

/// What a rank is about to cut; `failure`: why it cannot begin, "" where it can.
Bytes rank_hello(const std::string& failure, const CutIdentity& identity);
/// Throws InputError "rank-failed", "rank-differs".
void check_hello(int rank, const Bytes& message, const CutIdentity& own);

/// Rank 0 has other work first: the tiles are shared out among the others, and it takes parts of each share.
Share share_of_other(const Ranks& ranks, int rank);

/// Adds the numbers of a sorted list that another does not hold yet.
void unite(std::vector<size_t>& all, const std::vector<size_t>& more);

/// What one rank sees in its own tiles of the sweeps [begin, end).
BatchState look_at_tiles(const CutParts& parts, const stock::ContactFinder& finder, size_t begin, size_t end);
/// The least gap there of all but the suspects, mm.
double nearest_of_others(const CutParts& parts, const stock::ContactFinder& finder, size_t begin, size_t end,
                         const std::vector<size_t>& suspects);

}  // namespace swarf::sim
