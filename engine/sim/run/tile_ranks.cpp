#include "sim/run/tile_ranks.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <utility>

#include "measure/dealt_roots.h"
#include "sim/job/memory_limit.h"
#include "sim/run/result.h"
#include "sim/run/tile_messages.h"

namespace swarf::sim {
namespace {

void send_to_all(Ranks& ranks, BytesWriter message) {
  const Bytes bytes = message.take();
  for (int rank = 1; rank < ranks.size(); ++rank) ranks.send(rank, bytes);
}

/// To a rank these tiles, piece by piece.
void send_tiles(Ranks& ranks, int rank, const stock::Stock& stock, const stock::TileSet& tiles) {
  size_t from = 0;
  while (const auto piece = stock::StockTiles::next_tiles(stock, tiles, from)) {
    BytesWriter message = tile_request(TileRequest::kTiles);
    message.add_list(*piece);
    ranks.send(rank, message.take());
    ranks.receive(rank);
  }
}

/// Of the shares of so many others, the parts that rank 0 takes: as much as each of them keeps. Half of a
/// share is every other part of it, so that a row of a path is shared by both.
std::vector<uint32_t> parts_of_lead(int others) {
  constexpr std::array<unsigned, stock::kTileParts> kSpread{0, 4, 2, 6, 1, 5, 3, 7};
  std::vector<uint32_t> taken(static_cast<size_t>(others), 0);
  const int count = others > 0 ? (stock::kTileParts * others + (others + 1) / 2) / (others + 1) : 0;
  for (int n = 0; n < count; ++n)
    taken[static_cast<size_t>(n % others)] |= 1U << kSpread[static_cast<size_t>(n / others)];
  return taken;
}

}  // namespace

TileLead::TileLead(Ranks& ranks, const CutParts& parts)
    : ranks_(ranks), parts_(parts), seen_(static_cast<size_t>(ranks.size())) {
  send_to_all(ranks, tile_request(TileRequest::kHello));
}

/// The answer of a rank to what it was asked; what it tells of itself before is kept.
Bytes TileLead::answer_of(int rank) {
  for (;;) {
    Bytes message = ranks_.receive(rank);
    if (!keep_seen(rank, message)) return message;
  }
}

/// False: it is an answer.
bool TileLead::keep_seen(int rank, const Bytes& message) {
  BytesReader in(message);
  if (in.get<TileAnswer>() == TileAnswer::kAsked) return false;
  const auto begin = in.get<size_t>();
  seen_[static_cast<size_t>(rank)][begin] = get_seen(in);
  return true;
}

/// The rank answers, or it has told of this batch before it was asked.
void TileLead::await_seen(int rank, size_t begin) {
  std::map<size_t, BatchState>& seen = seen_[static_cast<size_t>(rank)];
  while (!seen.contains(begin)) {
    const Bytes message = ranks_.receive(rank);
    if (keep_seen(rank, message)) continue;
    BytesReader in = behind_first(message);
    seen[begin] = get_seen(in);
  }
}

void TileLead::call_together() {
  send_to_all(ranks_, tile_request(TileRequest::kHold));
  are_called_ = true;
}

/// Where all of them meet that have cut ahead, not beyond sweep `most`: at the farthest, unless one must
/// wait.
size_t TileLead::meet(size_t most) {
  if (!are_called_) call_together();
  are_called_ = false;
  for (;;) {
    size_t farthest = 0, nearest = parts_.sweeps.size(), end = most;
    for (int rank = 1; rank < ranks_.size(); ++rank) {
      const Bytes answer = answer_of(rank);
      const auto one = behind_first(answer).get<Standing>();
      farthest = std::max(farthest, one.at);
      nearest = std::min(nearest, one.at);
      if (one.waits) end = std::min(end, one.at);
    }
    end = std::min(end, farthest);
    if (nearest == farthest && farthest == end) return end;
    BytesWriter message = tile_request(TileRequest::kMeet);
    message.add(end);
    send_to_all(ranks_, std::move(message));
  }
}

/// What stands there as it does here.
stock::TileSet TileLead::held_by(int rank) const {
  return {share_of_other(ranks_, rank), stock::TileSet::kAllParts ^ taken_[static_cast<size_t>(rank - 1)]};
}

/// Takes its parts of the tiles of all others as they stand, and what has changed in them.
void TileLead::take_tiles(stock::Stock& stock) {
  stock::TileSet own;
  if (!taken_.empty()) own.parts = taken_;
  tiles_.emplace(stock, own);
  for (int rank = 1; rank < ranks_.size(); ++rank) {
    BytesWriter message = tile_request(TileRequest::kLeft);
    message.add(taken_[static_cast<size_t>(rank - 1)]);
    ranks_.send(rank, message.take());
  }
  for (int rank = 1; rank < ranks_.size(); ++rank) take_pieces(rank);
  finder_.emplace(stock, stock::ContactFinder::Tiles::kOwn);
}

/// The rank was asked, and tells until a piece is empty.
void TileLead::take_pieces(int rank) {
  for (;;) {
    const Bytes answer = answer_of(rank);
    BytesReader in = behind_first(answer);
    const std::string broken = in.get_text();
    if (broken_.empty()) broken_ = broken;
    const std::span<const std::byte> piece = in.get_bytes();
    if (piece.empty()) return;
    ranks_.send(rank, tile_request(TileRequest::kMore).take());
    tiles_->apply(piece);
  }
}

void TileLead::begin(stock::Stock& stock, const Start& start) {
  for (int rank = 1; rank < ranks_.size(); ++rank) check_hello(rank, answer_of(rank), parts_.identity);
  stock_ = &stock;
  at_ = start.at;
  own_from_ = start.is_raw && ranks_.size() > 1 ? meet(start.look_at) : start.at;
  taken_ = parts_of_lead(ranks_.size() - 1);
  if (own_from_ == parts_.sweeps.size()) std::ranges::fill(taken_, 0U);  // nothing is left to cut
  if (!start.is_raw) {
    BytesWriter message = tile_request(TileRequest::kStock);
    message.add(start.at);
    send_to_all(ranks_, std::move(message));
  }
  take_tiles(stock);
  for (int rank = 1; rank < ranks_.size() && !start.is_raw; ++rank)
    send_tiles(ranks_, rank, stock, held_by(rank));
  if (start.may_go_ahead) go_ahead();
}

/// Asks those that have not told yet what they see of a batch: who is ahead of this one has.
std::vector<int> TileLead::ask_to_look(size_t begin, size_t end) {
  BytesWriter message = tile_request(TileRequest::kLook);
  message.add(begin);
  message.add(end);
  message.add_text(bad_cuts_text(parts_.bad_cuts.result()));
  const Bytes asked = message.take();
  std::vector<int> open;
  for (int rank = 1; rank < ranks_.size(); ++rank) {
    while (ranks_.has_message(rank)) keep_seen(rank, ranks_.receive(rank));  // no answer is due
    if (seen_[static_cast<size_t>(rank)].contains(begin)) continue;
    ranks_.send(rank, asked);
    open.push_back(rank);
  }
  return open;
}

BatchState TileLead::look_ahead(size_t begin, size_t end) {
  const std::vector<int> open = ask_to_look(begin, end);
  BatchState all{end, std::numeric_limits<double>::infinity(), {}, {}};
  if (begin >= own_from_) {  // before that the others have looked at its tiles too
    finder_->refresh();
    all = look_at_tiles(parts_, *finder_, begin, end);
  }
  for (const int rank : open) await_seen(rank, begin);
  for (int rank = 1; rank < ranks_.size(); ++rank) {
    const BatchState seen = std::move(seen_[static_cast<size_t>(rank)].extract(begin).mapped());
    all.nearest_mm = std::min(all.nearest_mm, seen.nearest_mm);
    unite(all.suspects, seen.suspects);
    unite(all.bad_suspects, seen.bad_suspects);
  }
  if (all.suspects.empty() && all.bad_suspects.empty()) return all;
  // A suspect of one rank may be clear of the tiles of another, which has counted its gap; and who has cut
  // the batch in one piece must cut it again, in the pieces between those that are judged.
  BytesWriter message = tile_request(TileRequest::kNearest);
  message.add(begin);
  message.add(end);
  message.add_list(all.suspects);
  send_to_all(ranks_, std::move(message));
  all.nearest_mm = nearest_of_others(parts_, *finder_, begin, end, all.suspects);
  for (int rank = 1; rank < ranks_.size(); ++rank) {
    const Bytes answer = answer_of(rank);
    all.nearest_mm = std::min(all.nearest_mm, behind_first(answer).get<double>());
  }
  return all;
}

void TileLead::cut(size_t begin, size_t end) {
  BytesWriter message = tile_request(TileRequest::kCut);
  message.add(end);
  send_to_all(ranks_, std::move(message));
  at_ = end;
  is_whole_ = false;
  if (end > own_from_) parts_.cut(*stock_, std::max(begin, own_from_), end);
}

void TileLead::gather() {
  if (is_whole_) return;
  BytesWriter message = tile_request(TileRequest::kChanges);
  message.add(at_);
  send_to_all(ranks_, std::move(message));
  for (int rank = 1; rank < ranks_.size(); ++rank) take_pieces(rank);
  is_whole_ = true;
}

size_t TileLead::hold() {
  send_to_all(ranks_, tile_request(TileRequest::kHold));
  size_t farthest = own_from_;
  for (int rank = 1; rank < ranks_.size(); ++rank) {
    const Bytes answer = answer_of(rank);
    farthest = std::max(farthest, behind_first(answer).get<Standing>().at);
  }
  return farthest;
}

void TileLead::go_ahead() {
  send_to_all(ranks_, tile_request(TileRequest::kAhead));
}

stock::StockProof TileLead::prove(double slack_mm, const std::function<bool()>& is_busy) const {
  constexpr size_t kSlabsOfRank = 16;
  stock::SlabProofs proofs(*stock_, slack_mm, kSlabsOfRank * static_cast<size_t>(ranks_.size()));
  deal(ranks_, {proofs.count(),
                [&](size_t slab, int rank) {
                  BytesWriter message = tile_request(TileRequest::kSlab);
                  message.add(at_);
                  proofs.add_request(slab, held_by(rank), message);
                  return message.take();
                },
                [&](size_t slab, const Bytes& answer) { proofs.take(slab, answer); },
                [&](size_t slab) { proofs.prove(slab); }, is_busy});
  return proofs.result();
}

double rank_limit_mb(const Job& job, const CutOptions& options, const Ranks& ranks) {
  if (options.max_memory_mb > 0.0) return options.max_memory_mb;
  if (job.scene.stock.max_memory_mb > 0.0) return job.scene.stock.max_memory_mb;
  const char* const told = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE");  // by mpirun
  const int here = told != nullptr ? std::atoi(told) : 0;
  return memory_limit_mb(job.scene) / (here > 0 ? here : ranks.size());
}

double other_rank_mb(const Job& job, const MemoryPrediction& lead, int ranks) {
  constexpr double kMessages = 32.0;  // MB: pieces of changes and slabs on their way
  if (wants_proof(job)) return lead.peak_mb + kMessages;
  const StockSettings& settings = job.scene.stock;
  const auto stock_mb = [&](double leaves) {
    return static_cast<double>(stock::Stock::memory_for(settings.box_W, settings.voxel_mm, leaves)) /
           kMbOfRank;
  };
  // Rank 0 takes tiles over, and what changes in others, which leaves holes; the others do not.
  const double holes = lead.leaf_mb * kMbOfRank / static_cast<double>(stock::Stock::kLeafBytes);
  return lead.peak_mb - holes * stock_mb(lead.leaves) + stock_mb(lead.leaves / (ranks - 1)) + kMessages;
}

bool may_go_ahead(const CutOptions& options) {
  return options.resume_file.empty() && options.save_after.empty() && !options.record &&
         !options.check_voxels;
}

void ask_for_rays(Ranks& ranks) {
  send_to_all(ranks, tile_request(TileRequest::kRays));
}

std::vector<Bytes> rays_of(Ranks& ranks, int rank) {
  std::vector<Bytes> surfaces;
  for (Bytes one = ranks.receive(rank); !one.empty(); one = ranks.receive(rank))
    surfaces.push_back(std::move(one));
  return surfaces;
}

void send_whole_stock(Ranks& ranks, const stock::Stock& stock) {
  send_to_all(ranks, tile_request(TileRequest::kHold));
  for (int rank = 1; rank < ranks.size(); ++rank) {
    const Bytes answer = ranks.receive(rank);
    const auto parts = behind_first(answer).get<Standing>().parts;
    send_tiles(ranks, rank, stock, stock::TileSet(share_of_other(ranks, rank), parts).others());
  }
}

void ask_for_proof(Ranks& ranks, const KnownOfPart& known) {
  BytesWriter message = tile_request(TileRequest::kProof);
  message.add(known);
  send_to_all(ranks, std::move(message));
}

void deal_roots(Ranks& ranks, const DealtWork& work) {
  DealtWork sent = work;
  sent.request = [&](size_t portion, int rank) {
    BytesWriter message = tile_request(TileRequest::kRoots);
    const Bytes asked = work.request(portion, rank);
    message.add_all(std::span(asked));
    return message.take();
  };
  deal(ranks, sent);
}

void dismiss_ranks(Ranks& ranks) {
  if (ranks.has_left()) return;
  send_to_all(ranks, tile_request(TileRequest::kEnd));
  // What was asked before and is no longer of use comes first.
  const Bytes last = tile_request(TileRequest::kEnd).take();
  for (int rank = 1; rank < ranks.size(); ++rank)
    while (ranks.receive(rank) != last) continue;
  ranks.leave();
}

}  // namespace swarf::sim
