#include "sim/run/tile_ranks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "base/check.h"
#include "measure/dealt_roots.h"
#include "sim/job/memory_limit.h"
#include "sim/run/result.h"

namespace swarf::sim {
namespace {

constexpr double kMbOfRank = 1024.0 * 1024.0;

/// First byte of every message of rank 0.
enum class TileRequest : uint8_t {
  kAhead,    ///< cut on without being asked                          no answer
  kHold,     ///< no longer: where it stands
  kMeet,     ///< sweeps, to cut up to or to come back to: the same
  kHello,    ///< what the rank is about to cut, or why it cannot begin
  kLeft,     ///< parts that rank 0 takes: a piece of StockTiles::next_left(), or none
  kStock,    ///< the stock comes, cut by so many sweeps              no answer
  kTiles,    ///< positions to take over: an empty message
  kLook,     ///< begin, end, bad cuts so far: suspects and the least gap
  kNearest,  ///< begin, end, suspects of all ranks: the least gap of the other sweeps
  kCut,      ///< begin, end                                          no answer
  kChanges,  ///< sweeps: the broken invariant, a piece of StockTiles::next_changes(), or none
  kSlab,     ///< of stock_slabs.h
  kRays,     ///< SurfaceDexels::tiles_of(), for each surface
  kProof,    ///< what is known of a surface of the part              no answer
  kRoots,    ///< of that surface: RootProver::prove()
  kEnd,      ///< the same, as the last message of all
};

/// First byte of every message of another rank that belongs to the cut.
enum class TileAnswer : uint8_t {
  kAsked,  ///< to a question
  kSeen,   ///< what a batch that it has begun ahead of rank 0 looked like; nobody has asked
};

BytesWriter answer_to(TileAnswer what) {
  BytesWriter message;
  message.add(what);
  return message;
}

/// Of an answer.
BytesReader behind_first(const Bytes& message) {
  BytesReader in(message);
  in.get<TileAnswer>();
  return in;
}

void add_seen(const BatchState& seen, BytesWriter& out) {
  out.add(seen.end);
  out.add(seen.nearest_mm);
  out.add_list(seen.suspects);
  out.add_list(seen.bad_suspects);
}

BatchState get_seen(BytesReader& in) {
  BatchState seen;
  seen.end = in.get<size_t>();
  seen.nearest_mm = in.get<double>();
  seen.suspects = in.get_list<size_t>();
  seen.bad_suspects = in.get_list<size_t>();
  return seen;
}

BytesWriter request(TileRequest what) {
  BytesWriter message;
  message.add(what);
  return message;
}

void send_to_all(Ranks& ranks, BytesWriter message) {
  const Bytes bytes = message.take();
  for (int rank = 1; rank < ranks.size(); ++rank) ranks.send(rank, bytes);
}

/// Rank 0 has other work first: the tiles are shared out among the others, and it takes parts of each share.
Share share_of_other(const Ranks& ranks, int rank) {
  return {rank - 1, ranks.size() - 1};
}

/// To a rank these tiles, piece by piece.
void send_tiles(Ranks& ranks, int rank, const stock::Stock& stock, const stock::TileSet& tiles) {
  size_t from = 0;
  while (const auto piece = stock::StockTiles::next_tiles(stock, tiles, from)) {
    BytesWriter message = request(TileRequest::kTiles);
    message.add_list(*piece);
    ranks.send(rank, message.take());
    ranks.receive(rank);
  }
}

Bytes hello(const std::string& failure, const CutIdentity& identity) {
  BytesWriter message = answer_to(TileAnswer::kAsked);
  message.add_text(failure);
  message.add(identity.size());
  for (const IdentityPart& part : identity) {
    message.add_text(part.name);
    message.add_text(part.value);
  }
  return message.take();
}

/// Throws InputError "rank-failed", "rank-differs".
void check_hello(int rank, const Bytes& message, const CutIdentity& own) {
  BytesReader in = behind_first(message);
  const std::string failure = in.get_text();
  const std::string name = fmt::format("rank {}", rank);
  if (!failure.empty())
    throw InputError("rank-failed", {name}, fmt::format("this rank cannot begin: {}", failure),
                     "give every machine the same files at the same paths");
  CutIdentity identity(in.get<size_t>());
  for (IdentityPart& part : identity) {
    part.name = in.get_text();
    part.value = in.get_text();
  }
  Diagnostics diagnostics;
  for (const IdentityDifference& part : differences(identity, own))
    diagnostics.error(
        "rank-differs", {name},
        fmt::format("this rank has another {}: {}; rank 0 has {}", part.name, part.before, part.now),
        "give every machine the same program, version and files");
  diagnostics.throw_if_errors();
}

/// Of the shares of so many others, the parts that rank 0 takes: as much as each of them keeps.
std::vector<uint32_t> parts_of_lead(int others) {
  std::vector<uint32_t> taken(static_cast<size_t>(others), 0);
  const int count = others > 0 ? (stock::kTileParts * others + (others + 1) / 2) / (others + 1) : 0;
  for (int n = 0; n < count; ++n)
    taken[static_cast<size_t>(n % others)] |= 1U << static_cast<unsigned>(n / others);
  return taken;
}

/// Where another rank stands.
struct Standing {
  size_t at = 0;       ///< sweeps that its tiles have seen
  bool waits = false;  ///< the next ones it must not cut before rank 0 comes to them
  uint32_t parts = 0;  ///< of its share, those that are its own
};

void unite(std::vector<size_t>& all, const std::vector<size_t>& more) {
  std::vector<size_t> both;
  std::set_union(all.begin(), all.end(), more.begin(), more.end(), std::back_inserter(both));
  all = std::move(both);
}

/// What one rank sees in its own tiles.
BatchState look_at_tiles(const CutParts& parts, const stock::ContactFinder& finder, size_t begin,
                         size_t end) {
  ToolClearanceCheck::Outlook outlook = parts.clearance.look_ahead(finder, begin, end);
  return {end, outlook.nearest_mm, std::move(outlook.suspects),
          parts.bad_cuts.look_ahead(finder, begin, end)};
}

double nearest_of_others(const CutParts& parts, const stock::ContactFinder& finder, size_t begin, size_t end,
                         const std::vector<size_t>& suspects) {
  return parts.clearance.look_ahead(finder, begin, end, suspects).nearest_mm;
}

/// Tiles of this rank, and how far they are cut.
class OwnTiles {
 public:
  OwnTiles(const Job& job, const CutParts& parts, const Share& share)
      : job_(job), parts_(parts), share_(share), own_(share), stock_(raw()), tiles_(stock_, own_) {
    finder_.emplace(stock_, stock::ContactFinder::Tiles::kOwn);
  }
  OwnTiles(const OwnTiles&) = delete;
  OwnTiles& operator=(const OwnTiles&) = delete;

  Standing standing() const { return {at_, waits_, own_.parts[static_cast<size_t>(share_.index)]}; }
  void take(const Bytes& tiles) { tiles_.apply(tiles); }
  /// take() brings what so many sweeps have left.
  void start_at(size_t at) {
    come_to(0);
    at_ = left_.at = at;
  }
  const stock::Stock& stock() const { return stock_; }

  /// One more part of the program, not beyond sweep `most`, as one process would cut it. False: nothing is
  /// left, or a sweep is not clear of these tiles, so that rank 0 must come to it first.
  bool go_on(size_t most) {
    if (at_ >= most) return false;
    waits_ = came_back_;  // it might have to again
    if (!waits_ && at_ >= next_look_) {
      BatchState seen = look(at_, parts_.batch_end(at_));
      waits_ = !seen.suspects.empty() || !seen.bad_suspects.empty();
      if (!waits_) {
        next_look_ = seen.end;
        seen_[at_] = std::move(seen);
        untold_.push_back(at_);
      }
    }
    if (waits_) return false;
    cut_to(std::min({next_look_, parts_.check_end(at_), most}));
    return true;
  }
  /// Up to this sweep, or to where it must wait; back to it where more is cut.
  void meet(size_t at) {
    come_to(at);
    while (go_on(at)) continue;
  }

  BatchState look(size_t begin, size_t end) {
    // What was clear of all bad moves is clear of those that are still looked for.
    if (const auto seen = seen_.find(begin); seen != seen_.end()) return seen->second;
    SWARF_CHECK(at_ <= begin, "what is passed was seen");
    finder_->refresh();
    return look_at_tiles(parts_, *finder_, begin, end);
  }
  double nearest(size_t begin, size_t end, const std::vector<size_t>& suspects) {
    come_to(begin);
    finder_->refresh();
    return nearest_of_others(parts_, *finder_, begin, end, suspects);
  }
  void cut_to(size_t end) {
    if (end <= at_) return;
    const size_t before = at_;
    parts_.cut(stock_, before, end);
    at_ = end;
    ends_.push_back(end);
    if (broken_.empty() && parts_.is_check_due(before, at_))
      broken_ = stock_.check(stock::CheckLevel::kOwnMap);
  }
  /// The next piece of what has changed up to so many sweeps.
  std::optional<Bytes> next_changes(size_t at) {
    come_to(at);
    return tiles_.next_changes();
  }
  /// The next piece of the parts that rank 0 takes; none: from now on they are no longer its own.
  std::optional<Bytes> next_left(uint32_t taken) {
    const stock::TileSet kept(share_, stock::TileSet::kAllParts ^ taken);
    std::optional<Bytes> piece = tiles_.next_left(kept);
    if (piece) return piece;
    own_ = kept;
    left_ = {at_, stock_.statistics()};
    finder_.emplace(stock_, stock::ContactFinder::Tiles::kOwn);
    return {};
  }
  const std::string& broken() const { return broken_; }
  /// Batches that were begun ahead since this was asked last, by first sweep.
  std::vector<std::pair<size_t, BatchState>> next_seen() {
    std::vector<std::pair<size_t, BatchState>> seen;
    for (const size_t begin : std::exchange(untold_, {})) seen.emplace_back(begin, seen_.at(begin));
    return seen;
  }

 private:
  stock::Stock raw() const {
    const StockSettings& settings = job_.scene.stock;
    return stock::StockTiles::own_tiles(settings.body_W(), settings.voxel_mm, own_);
  }
  /// From the raw stock again where it is cut farther; what was told and seen before stays true.
  void come_to(size_t at) {
    if (at_ <= at) return;
    SWARF_CHECK(at >= left_.at, "what rank 0 has taken was cut so far");
    came_back_ = true;
    stock_ = raw();
    finder_.emplace(stock_, stock::ContactFinder::Tiles::kOwn);
    at_ = 0;
    for (const size_t end : std::exchange(ends_, {})) {
      cut_to(std::min(at, end));
      if (at_ == left_.at) tiles_.count_as(left_.counts);
    }
  }

  const Job& job_;
  const CutParts& parts_;
  Share share_;
  stock::TileSet own_;  ///< of the share, as long as rank 0 has taken none of them
  stock::Stock stock_;
  stock::StockTiles tiles_;
  std::optional<stock::ContactFinder> finder_;
  size_t at_ = 0;                      ///< sweeps
  std::vector<size_t> ends_;           ///< of all cuts: the counts of work hang on them
  std::map<size_t, BatchState> seen_;  ///< by first sweep: batches that were begun ahead of rank 0
  std::vector<size_t> untold_;         ///< of them
  size_t next_look_ = 0;               ///< where the next of them begins
  bool came_back_ = false, waits_ = false;
  struct {
    size_t at = 0;                ///< sweeps when rank 0 took its tiles
    stock::CutStatistics counts;  ///< of theirs too
  } left_;
  std::string broken_;
};

/// Another rank than 0, from the first request to the last.
class TileServer {
 public:
  TileServer(Ranks& ranks, const TileService& service)
      : ranks_(ranks), service_(service), ahead_(service.ahead && service.parts.carried.empty()) {}

  void serve() {
    for (;;) {
      while (ahead_ && !ranks_.has_message(0)) {
        ahead_ = has_room() && own().go_on(service_.parts.sweeps.size());
        if (is_known_) tell_seen();
      }
      const Bytes message = ranks_.receive(0);
      BytesReader in(message);
      const auto what = in.get<TileRequest>();
      if (!(what < TileRequest::kSlab ? cut(what, in) : follow(what, in))) return;
    }
  }

 private:
  /// What belongs to the cut.
  bool cut(TileRequest what, BytesReader& in) {
    BytesWriter out = answer_to(TileAnswer::kAsked);
    switch (what) {
      case TileRequest::kAhead:
        ahead_ = service_.parts.carried.empty();
        return true;
      case TileRequest::kMeet:
        own().meet(in.get<size_t>());
        out.add(own().standing());
        break;
      case TileRequest::kHold:
        ahead_ = false;
        out.add(own().standing());
        break;
      case TileRequest::kHello:
        ranks_.send(0, hello("", service_.parts.identity));
        is_known_ = true;
        if (own_) tell_seen();
        return true;
      case TileRequest::kLeft:
        out.add_list(own().next_left(in.get<uint32_t>()).value_or(Bytes{}));
        break;
      case TileRequest::kStock:
        own().start_at(in.get<size_t>());
        return true;
      case TileRequest::kTiles:
        own().take(in.get_list<std::byte>());
        break;
      case TileRequest::kLook:
        look(in, out);
        break;
      case TileRequest::kNearest:
        ahead_ = false;
        tell_nearest(in, out);
        break;
      case TileRequest::kCut:
        own().cut_to(in.get<size_t>());
        return true;
      case TileRequest::kChanges:
        ahead_ = false;
        tell_changes(in.get<size_t>(), out);
        break;
      default:
        break;
    }
    ranks_.send(0, out.take());
    return true;
  }

  /// What follows it. False: there is nothing more.
  bool follow(TileRequest what, BytesReader& in) {
    switch (what) {
      case TileRequest::kSlab:
        ranks_.send(0, stock::prove_slab(in));
        break;
      case TileRequest::kRays:
        service_.cut_rays();
        for (const stock::SurfaceDexels& dexels : service_.measured.dexels)
          ranks_.send(0, dexels.tiles_of(share_of(ranks_)));
        ranks_.send(0, {});
        break;
      case TileRequest::kProof:
        if (!proof_) proof_.emplace(service_.job, service_.measured, own().stock());
        prover_ = std::make_unique<measure::RootProver>(proof_->of_surface(in.get<KnownOfPart>(), silent_));
        break;
      case TileRequest::kRoots:
        ranks_.send(0, prover_->prove(in));
        break;
      default:
        ranks_.send(0, request(TileRequest::kEnd).take());
        return false;
    }
    return true;
  }

  OwnTiles& own() {
    if (!own_) own_.emplace(service_.job, service_.parts, share_of_other(ranks_, ranks_.rank()));
    return *own_;
  }
  /// Rank 0 has not predicted yet what this takes.
  bool has_room() {
    return static_cast<double>(own().stock().memory_bytes()) / kMbOfRank <= service_.most_mb;
  }
  void look(BytesReader& in, BytesWriter& out) {
    const auto begin = in.get<size_t>(), end = in.get<size_t>();
    std::vector<BadCut> found;
    SWARF_CHECK(parse_bad_cuts(in.get_text(), found), "rank 0 tells its bad cuts");
    service_.parts.bad_cuts.resume(found);
    add_seen(own().look(begin, end), out);
  }
  /// Rank 0 need not ask, and wait until this one has cut its next part.
  void tell_seen() {
    for (const auto& [begin, seen] : own().next_seen()) {
      BytesWriter out = answer_to(TileAnswer::kSeen);
      out.add(begin);
      add_seen(seen, out);
      ranks_.send(0, out.take());
    }
  }
  void tell_nearest(BytesReader& in, BytesWriter& out) {
    const auto begin = in.get<size_t>(), end = in.get<size_t>();
    const auto suspects = in.get_list<size_t>();
    out.add(own().nearest(begin, end, suspects));
  }
  void tell_changes(size_t at, BytesWriter& out) {
    const std::optional<Bytes> piece = own().next_changes(at);
    out.add_text(own().broken());
    out.add_list(piece.value_or(Bytes{}));
  }

  Ranks& ranks_;
  const TileService& service_;
  Progress silent_;
  std::optional<OwnTiles> own_;
  std::optional<ProofInputs> proof_;
  std::unique_ptr<measure::RootProver> prover_;  ///< of the surface that is being proven
  bool ahead_;                                   ///< of rank 0
  bool is_known_ = false;                        ///< to rank 0, which takes what is told
};

}  // namespace

TileLead::TileLead(Ranks& ranks, const CutParts& parts)
    : ranks_(ranks), parts_(parts), seen_(static_cast<size_t>(ranks.size())) {
  send_to_all(ranks, request(TileRequest::kHello));
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

/// Where all of them meet that have cut ahead, not beyond sweep `most`: at the farthest, unless one must
/// wait.
size_t TileLead::meet(size_t most) {
  send_to_all(ranks_, request(TileRequest::kHold));
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
    BytesWriter message = request(TileRequest::kMeet);
    message.add(end);
    send_to_all(ranks_, std::move(message));
  }
}

/// Takes parts of the tiles of all others as they stand, and what has changed in them.
void TileLead::take_tiles(stock::Stock& stock, const std::vector<uint32_t>& parts) {
  stock::TileSet own;
  if (!parts.empty()) own.parts = parts;
  tiles_.emplace(stock, own);
  std::vector<Bytes> asked;
  for (int rank = 1; rank < ranks_.size(); ++rank) {
    BytesWriter message = request(TileRequest::kLeft);
    message.add(parts[static_cast<size_t>(rank - 1)]);
    asked.push_back(message.take());
    ranks_.send(rank, asked.back());
  }
  for (int rank = 1; rank < ranks_.size(); ++rank)
    take_pieces(rank, asked[static_cast<size_t>(rank - 1)], [](BytesReader&) {});
  finder_.emplace(stock, stock::ContactFinder::Tiles::kOwn);
}

/// The rank was asked, and is asked again until it answers without a piece. `before`: reads what comes first
/// in an answer.
void TileLead::take_pieces(int rank, const Bytes& asked, const std::function<void(BytesReader&)>& before) {
  for (;;) {
    const Bytes answer = answer_of(rank);
    BytesReader in = behind_first(answer);
    before(in);
    const auto piece = in.get_list<std::byte>();
    if (piece.empty()) return;
    ranks_.send(rank, asked);  // it reads the next piece while this one is taken over
    tiles_->apply(piece);
  }
}

void TileLead::begin(stock::Stock& stock, const Start& start) {
  for (int rank = 1; rank < ranks_.size(); ++rank) check_hello(rank, answer_of(rank), parts_.identity);
  stock_ = &stock;
  at_ = start.at;
  own_from_ = start.is_raw && ranks_.size() > 1 ? meet(start.look_at) : start.at;
  std::vector<uint32_t> parts = parts_of_lead(ranks_.size() - 1);
  if (own_from_ == parts_.sweeps.size()) std::ranges::fill(parts, 0U);  // nothing is left to cut
  if (!start.is_raw) {
    BytesWriter message = request(TileRequest::kStock);
    message.add(start.at);
    send_to_all(ranks_, std::move(message));
  }
  take_tiles(stock, parts);
  for (int rank = 1; rank < ranks_.size() && !start.is_raw; ++rank) {
    const uint32_t kept = stock::TileSet::kAllParts ^ parts[static_cast<size_t>(rank - 1)];
    send_tiles(ranks_, rank, stock, {share_of_other(ranks_, rank), kept});
  }
  if (start.may_go_ahead) go_ahead();
}

/// Asks those that have not told yet what they see of a batch: who is ahead of this one has.
std::vector<int> TileLead::ask_to_look(size_t begin, size_t end) {
  BytesWriter message = request(TileRequest::kLook);
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
  for (const int rank : open) {
    const Bytes answer = answer_of(rank);
    BytesReader in = behind_first(answer);
    seen_[static_cast<size_t>(rank)][begin] = get_seen(in);
  }
  for (int rank = 1; rank < ranks_.size(); ++rank) {
    const BatchState seen = std::move(seen_[static_cast<size_t>(rank)].extract(begin).mapped());
    all.nearest_mm = std::min(all.nearest_mm, seen.nearest_mm);
    unite(all.suspects, seen.suspects);
    unite(all.bad_suspects, seen.bad_suspects);
  }
  if (all.suspects.empty()) return all;
  // A suspect of one rank may be clear of the tiles of another, which has counted its gap.
  BytesWriter message = request(TileRequest::kNearest);
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
  BytesWriter message = request(TileRequest::kCut);
  message.add(end);
  send_to_all(ranks_, std::move(message));
  at_ = end;
  is_whole_ = false;
  if (end > own_from_) parts_.cut(*stock_, std::max(begin, own_from_), end);
}

void TileLead::gather() {
  if (is_whole_) return;
  BytesWriter message = request(TileRequest::kChanges);
  message.add(at_);
  const Bytes asked = message.take();
  for (int rank = 1; rank < ranks_.size(); ++rank) ranks_.send(rank, asked);
  for (int rank = 1; rank < ranks_.size(); ++rank)
    take_pieces(rank, asked, [&](BytesReader& in) {
      const std::string broken = in.get_text();
      if (broken_.empty()) broken_ = broken;
    });
  is_whole_ = true;
}

size_t TileLead::hold() {
  send_to_all(ranks_, request(TileRequest::kHold));
  size_t farthest = own_from_;
  for (int rank = 1; rank < ranks_.size(); ++rank) {
    const Bytes answer = answer_of(rank);
    farthest = std::max(farthest, behind_first(answer).get<Standing>().at);
  }
  return farthest;
}

void TileLead::go_ahead() {
  send_to_all(ranks_, request(TileRequest::kAhead));
}

stock::StockProof TileLead::prove(double slack_mm, const std::function<bool()>& is_busy) const {
  constexpr size_t kSlabsOfRank = 16;
  stock::SlabProofs proofs(*stock_, slack_mm, kSlabsOfRank * static_cast<size_t>(ranks_.size()));
  deal(ranks_, {proofs.count(),
                [&](size_t slab) {
                  BytesWriter message = request(TileRequest::kSlab);
                  proofs.add_request(slab, message);
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

void serve_tile_lead(Ranks& ranks, const TileService& service) {
  TileServer(ranks, service).serve();
}

void refuse_tile_lead(Ranks& ranks, const std::string& why) {
  for (;;) {
    const Bytes message = ranks.receive(0);
    const auto asked = BytesReader(message).get<TileRequest>();
    if (asked == TileRequest::kHello) ranks.send(0, hello(why, {}));
    if (asked != TileRequest::kEnd) continue;
    ranks.send(0, request(TileRequest::kEnd).take());
    return;
  }
}

void ask_for_rays(Ranks& ranks) {
  send_to_all(ranks, request(TileRequest::kRays));
}

std::vector<Bytes> rays_of(Ranks& ranks, int rank) {
  std::vector<Bytes> surfaces;
  for (Bytes one = ranks.receive(rank); !one.empty(); one = ranks.receive(rank))
    surfaces.push_back(std::move(one));
  return surfaces;
}

void send_whole_stock(Ranks& ranks, const stock::Stock& stock) {
  send_to_all(ranks, request(TileRequest::kHold));
  for (int rank = 1; rank < ranks.size(); ++rank) {
    const Bytes answer = ranks.receive(rank);
    const auto parts = behind_first(answer).get<Standing>().parts;
    send_tiles(ranks, rank, stock, stock::TileSet(share_of_other(ranks, rank), parts).others());
  }
}

void ask_for_proof(Ranks& ranks, const KnownOfPart& known) {
  BytesWriter message = request(TileRequest::kProof);
  message.add(known);
  send_to_all(ranks, std::move(message));
}

void deal_roots(Ranks& ranks, const DealtWork& work) {
  DealtWork sent = work;
  sent.request = [&](size_t portion) {
    BytesWriter message = request(TileRequest::kRoots);
    const Bytes asked = work.request(portion);
    message.add_all(std::span(asked));
    return message.take();
  };
  deal(ranks, sent);
}

void dismiss_ranks(Ranks& ranks) {
  send_to_all(ranks, request(TileRequest::kEnd));
  // What was asked before and is no longer of use comes first.
  const Bytes last = request(TileRequest::kEnd).take();
  for (int rank = 1; rank < ranks.size(); ++rank)
    while (ranks.receive(rank) != last) continue;
}

}  // namespace swarf::sim
