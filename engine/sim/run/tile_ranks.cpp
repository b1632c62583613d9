#include "sim/run/tile_ranks.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <utility>

#include "base/check.h"
#include "measure/dealt_roots.h"
#include "sim/run/result.h"

namespace swarf::sim {
namespace {

/// First byte of every message of rank 0.
enum class TileRequest : uint8_t {
  kAhead,    ///< cut on without being asked                          no answer
  kHold,     ///< no longer: how many sweeps are cut
  kHello,    ///< what the rank is about to cut, or why it cannot begin
  kStock,    ///< begin with the raw stock, cut by so many sweeps     no answer
  kMore,     ///< parts of the tiles of rank 0 that are its own now   no answer
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

BytesWriter request(TileRequest what) {
  BytesWriter message;
  message.add(what);
  return message;
}

void send_to_all(Ranks& ranks, BytesWriter message) {
  const Bytes bytes = message.take();
  for (int rank = 1; rank < ranks.size(); ++rank) ranks.send(rank, bytes);
}

/// To every rank its tiles or all others, piece by piece.
void send_tiles(Ranks& ranks, const stock::Stock& stock, stock::StockTiles::Which which) {
  for (int rank = 1; rank < ranks.size(); ++rank) {
    size_t from = 0;
    while (const auto piece = stock::StockTiles::next_tiles(stock, {rank, ranks.size()}, which, from)) {
      BytesWriter message = request(TileRequest::kTiles);
      message.add_list(*piece);
      ranks.send(rank, message.take());
      ranks.receive(rank);
    }
  }
}

/// `at`: so many sweeps are cut already.
Bytes hello(const std::string& failure, const CutIdentity& identity, size_t at) {
  BytesWriter message;
  message.add_text(failure);
  message.add(at);
  message.add(identity.size());
  for (const IdentityPart& part : identity) {
    message.add_text(part.name);
    message.add_text(part.value);
  }
  return message.take();
}

/// How many sweeps the rank has cut already. Throws InputError "rank-failed", "rank-differs".
size_t check_hello(int rank, const Bytes& message, const CutIdentity& own) {
  BytesReader in(message);
  const std::string failure = in.get_text();
  const std::string name = fmt::format("rank {}", rank);
  if (!failure.empty())
    throw InputError("rank-failed", {name}, fmt::format("this rank cannot begin: {}", failure),
                     "give every machine the same files at the same paths");
  const auto at = in.get<size_t>();
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
  return at;
}

/// Of the parts of its tiles, those that rank 0 leaves to the others, by rank. All ranks that cut alike would
/// then end together: `at`, of `total` sweeps, is how far the others are while rank 0 has not begun.
std::vector<uint32_t> parts_to_give(const std::vector<size_t>& at, size_t total) {
  std::vector<uint32_t> given(at.size() + 1, 0);
  if (at.empty() || total == 0) return given;
  double left = 1.0;  // shares
  for (const size_t one : at) left += 1.0 - static_cast<double>(one) / static_cast<double>(total);
  const double kept = left / static_cast<double>(at.size() + 1);
  const int kept_parts =
      std::clamp(static_cast<int>(std::lround(kept * stock::kTileParts)), 0, stock::kTileParts);
  for (int part = kept_parts; part < stock::kTileParts; ++part)
    given[1 + static_cast<size_t>(part - kept_parts) % at.size()] |= 1U << static_cast<unsigned>(part);
  for (const uint32_t parts : given) given[0] |= parts;
  return given;
}

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
  OwnTiles(const Job& job, const CutParts& parts, const stock::TileSet& own)
      : job_(job), parts_(parts), own_(own), stock_(raw()), tiles_(stock_, own) {
    finder_.emplace(stock_, stock::ContactFinder::Tiles::kOwn);
  }
  OwnTiles(const OwnTiles&) = delete;
  OwnTiles& operator=(const OwnTiles&) = delete;

  size_t at() const { return at_; }
  bool is_done() const { return at_ == parts_.sweeps.size(); }
  void take(const Bytes& tiles) { tiles_.apply(tiles); }
  void start_at(size_t at) { at_ = at; }
  const stock::Stock& stock() const { return stock_; }

  /// One more part of the program, as one process would cut it. False: a sweep is not clear of these tiles,
  /// so that rank 0 must come to it first.
  bool go_on() {
    if (came_back_) return false;  // it might have to again
    if (at_ >= next_look_) {
      BatchState seen = look(at_, parts_.batch_end(at_));
      if (!seen.suspects.empty() || !seen.bad_suspects.empty()) return false;
      next_look_ = seen.end;
      seen_[at_] = std::move(seen);
    }
    cut_to(std::min(next_look_, parts_.check_end(at_)));
    return true;
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
  const std::string& broken() const { return broken_; }

 private:
  stock::Stock raw() const {
    const StockSettings& settings = job_.scene.stock;
    return stock::StockTiles::own_tiles(settings.body_W(), settings.voxel_mm, own_);
  }
  /// From the raw stock again where it is cut farther; what was told and seen before stays true.
  void come_to(size_t at) {
    if (at_ <= at) return;
    came_back_ = true;
    stock_ = raw();
    finder_.emplace(stock_, stock::ContactFinder::Tiles::kOwn);
    at_ = 0;
    for (const size_t end : std::exchange(ends_, {})) cut_to(std::min(at, end));
  }

  const Job& job_;
  const CutParts& parts_;
  stock::TileSet own_;
  stock::Stock stock_;
  stock::StockTiles tiles_;
  std::optional<stock::ContactFinder> finder_;
  size_t at_ = 0;                      ///< sweeps
  std::vector<size_t> ends_;           ///< of all cuts: the counts of work hang on them
  std::map<size_t, BatchState> seen_;  ///< by first sweep: batches that were begun ahead of rank 0
  size_t next_look_ = 0;               ///< where the next of them begins
  bool came_back_ = false;
  std::string broken_;
};

/// Another rank than 0, from the first request to the last.
class TileServer {
 public:
  TileServer(Ranks& ranks, const Job& job, CutParts& parts, const MeasuredPath& measured,
             const std::function<void()>& cut_rays)
      : ranks_(ranks), job_(job), parts_(parts), measured_(measured), cut_rays_(cut_rays) {}

  void serve() {
    for (;;) {
      while (ahead_ && !ranks_.has_message(0)) ahead_ = go_on();
      const Bytes message = ranks_.receive(0);
      BytesReader in(message);
      const auto what = in.get<TileRequest>();
      if (!(what < TileRequest::kSlab ? cut(what, in) : follow(what, in))) return;
    }
  }

 private:
  /// What belongs to the cut.
  bool cut(TileRequest what, BytesReader& in) {
    BytesWriter out;
    switch (what) {
      case TileRequest::kAhead:
        ahead_ = parts_.carried.empty();
        return true;
      case TileRequest::kHold:
        ahead_ = false;
        out.add(farthest());
        break;
      case TileRequest::kHello:
        ranks_.send(0, hello("", parts_.identity, own_.empty() ? 0 : own().at()));
        return true;
      case TileRequest::kStock:
        if (const auto at = in.get<size_t>(); at > 0) own().start_at(at);
        return true;
      case TileRequest::kMore:
        own();
        own_.push_back(
            std::make_unique<OwnTiles>(job_, parts_, stock::TileSet({0, ranks_.size()}, in.get<uint32_t>())));
        ahead_ = true;
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
      case TileRequest::kCut: {
        const auto end = in.get<size_t>();
        for (const auto& tiles : own_) tiles->cut_to(end);
        return true;
      }
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
    if (own_.size() > 1) own_.resize(1);  // they are told
    switch (what) {
      case TileRequest::kSlab:
        ranks_.send(0, stock::prove_slab(in));
        break;
      case TileRequest::kRays:
        cut_rays_();
        for (const stock::SurfaceDexels& dexels : measured_.dexels)
          ranks_.send(0, dexels.tiles_of(share_of(ranks_)));
        ranks_.send(0, {});
        break;
      case TileRequest::kProof:
        if (!proof_) proof_.emplace(job_, measured_, own().stock());
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

  /// Those of its share.
  OwnTiles& own() {
    if (own_.empty()) own_.push_back(std::make_unique<OwnTiles>(job_, parts_, share_of(ranks_)));
    return *own_.front();
  }
  /// The tiles that are least far. False: they must wait, or all are done.
  bool go_on() {
    own();
    const auto last = std::min_element(own_.begin(), own_.end(),
                                       [](const auto& a, const auto& b) { return a->at() < b->at(); });
    return !(*last)->is_done() && (*last)->go_on();
  }
  size_t farthest() const {
    size_t at = 0;
    for (const auto& tiles : own_) at = std::max(at, tiles->at());
    return at;
  }
  void look(BytesReader& in, BytesWriter& out) {
    const auto begin = in.get<size_t>(), end = in.get<size_t>();
    std::vector<BadCut> found;
    SWARF_CHECK(parse_bad_cuts(in.get_text(), found), "rank 0 tells its bad cuts");
    parts_.bad_cuts.resume(found);
    BatchState all = own().look(begin, end);
    for (size_t n = 1; n < own_.size(); ++n) {
      const BatchState more = own_[n]->look(begin, end);
      all.nearest_mm = std::min(all.nearest_mm, more.nearest_mm);
      unite(all.suspects, more.suspects);
      unite(all.bad_suspects, more.bad_suspects);
    }
    out.add(all.nearest_mm);
    out.add_list(all.suspects);
    out.add_list(all.bad_suspects);
  }
  void tell_nearest(BytesReader& in, BytesWriter& out) {
    const auto begin = in.get<size_t>(), end = in.get<size_t>();
    const auto suspects = in.get_list<size_t>();
    double nearest_mm = own().nearest(begin, end, suspects);
    for (size_t n = 1; n < own_.size(); ++n)
      nearest_mm = std::min(nearest_mm, own_[n]->nearest(begin, end, suspects));
    out.add(nearest_mm);
  }
  void tell_changes(size_t at, BytesWriter& out) {
    std::string broken;
    std::optional<Bytes> piece;
    for (const auto& tiles : own_) {
      if (!piece) piece = tiles->next_changes(at);
      if (broken.empty()) broken = tiles->broken();
    }
    out.add_text(broken);
    out.add_list(piece.value_or(Bytes{}));
  }

  Ranks& ranks_;
  const Job& job_;
  CutParts& parts_;
  const MeasuredPath& measured_;
  const std::function<void()>& cut_rays_;
  Progress silent_;
  std::vector<std::unique_ptr<OwnTiles>> own_;  ///< those of its share, then what rank 0 has left to it
  std::optional<ProofInputs> proof_;
  std::unique_ptr<measure::RootProver> prover_;  ///< of the surface that is being proven
  bool ahead_ = false;                           ///< of rank 0
};

}  // namespace

TileLead::TileLead(Ranks& ranks, const CutParts& parts) : ranks_(ranks), parts_(parts) {
  send_to_all(ranks, request(TileRequest::kHello));
  for (int rank = 1; rank < ranks.size(); ++rank)
    ahead_.push_back(check_hello(rank, ranks.receive(rank), parts.identity));
}

void TileLead::begin(stock::Stock& stock, size_t at, bool is_raw) {
  stock_ = &stock;
  at_ = at;
  const std::vector<uint32_t> given = parts_to_give(ahead_, parts_.sweeps.size());
  const stock::TileSet own(share_of(ranks_), stock::TileSet::kAllParts ^ (is_raw ? given.front() : 0));
  tiles_.emplace(stock, own);
  finder_.emplace(stock, stock::ContactFinder::Tiles::kOwn);
  for (int rank = 1; rank < ranks_.size(); ++rank) {
    BytesWriter message = request(TileRequest::kStock);
    message.add(at);
    ranks_.send(rank, message.take());
    const uint32_t parts = given[static_cast<size_t>(rank)];
    if (!is_raw || parts == 0) continue;
    message = request(TileRequest::kMore);
    message.add(parts);
    ranks_.send(rank, message.take());
  }
  if (!is_raw) send_tiles(ranks_, stock, stock::StockTiles::Which::kOfShare);
}

BatchState TileLead::look_ahead(size_t begin, size_t end) {
  BytesWriter message = request(TileRequest::kLook);
  message.add(begin);
  message.add(end);
  message.add_text(bad_cuts_text(parts_.bad_cuts.result()));
  send_to_all(ranks_, std::move(message));
  finder_->refresh();
  BatchState all = look_at_tiles(parts_, *finder_, begin, end);
  for (int rank = 1; rank < ranks_.size(); ++rank) {
    const Bytes answer = ranks_.receive(rank);
    BytesReader in(answer);
    all.nearest_mm = std::min(all.nearest_mm, in.get<double>());
    unite(all.suspects, in.get_list<size_t>());
    unite(all.bad_suspects, in.get_list<size_t>());
  }
  if (all.suspects.empty()) return all;
  // A suspect of one rank may be clear of the tiles of another, which has counted its gap.
  message = request(TileRequest::kNearest);
  message.add(begin);
  message.add(end);
  message.add_list(all.suspects);
  send_to_all(ranks_, std::move(message));
  all.nearest_mm = nearest_of_others(parts_, *finder_, begin, end, all.suspects);
  for (int rank = 1; rank < ranks_.size(); ++rank) {
    const Bytes answer = ranks_.receive(rank);
    all.nearest_mm = std::min(all.nearest_mm, BytesReader(answer).get<double>());
  }
  return all;
}

void TileLead::cut(size_t begin, size_t end) {
  BytesWriter message = request(TileRequest::kCut);
  message.add(end);
  send_to_all(ranks_, std::move(message));
  at_ = end;
  is_whole_ = false;
  parts_.cut(*stock_, begin, end);
}

void TileLead::gather() {
  if (is_whole_) return;
  BytesWriter message = request(TileRequest::kChanges);
  message.add(at_);
  const Bytes asked = message.take();
  for (int rank = 1; rank < ranks_.size(); ++rank) ranks_.send(rank, asked);
  for (int rank = 1; rank < ranks_.size(); ++rank) {
    for (;;) {
      const Bytes answer = ranks_.receive(rank);
      BytesReader in(answer);
      const std::string broken = in.get_text();
      if (broken_.empty()) broken_ = broken;
      const auto piece = in.get_list<std::byte>();
      if (piece.empty()) break;
      ranks_.send(rank, asked);  // it reads the next piece while this one is taken over
      tiles_->apply(piece);
    }
  }
  is_whole_ = true;
}

size_t TileLead::hold() {
  send_to_all(ranks_, request(TileRequest::kHold));
  size_t farthest = 0;
  for (int rank = 1; rank < ranks_.size(); ++rank) {
    const Bytes answer = ranks_.receive(rank);
    farthest = std::max(farthest, BytesReader(answer).get<size_t>());
  }
  return farthest;
}

void TileLead::go_ahead() {
  let_ranks_go_ahead(ranks_);
}

stock::StockProof TileLead::prove(double slack_mm) const {
  constexpr size_t kSlabsOfRank = 12;
  stock::SlabProofs proofs(*stock_, slack_mm, kSlabsOfRank * static_cast<size_t>(ranks_.size()));
  deal(ranks_, {proofs.count(),
                [&](size_t slab) {
                  BytesWriter message = request(TileRequest::kSlab);
                  proofs.add_request(slab, message);
                  return message.take();
                },
                [&](size_t slab, const Bytes& answer) { proofs.take(slab, answer); },
                [&](size_t slab) { proofs.prove(slab); }});
  return proofs.result();
}

bool may_go_ahead(const CutOptions& options) {
  return options.resume_file.empty() && options.save_after.empty() && !options.record &&
         !options.check_voxels;
}

void let_ranks_go_ahead(Ranks& ranks) {
  send_to_all(ranks, request(TileRequest::kAhead));
}

void serve_tile_lead(Ranks& ranks, const Job& job, CutParts& parts, const MeasuredPath& measured,
                     const std::function<void()>& cut_rays) {
  TileServer(ranks, job, parts, measured, cut_rays).serve();
}

void refuse_tile_lead(Ranks& ranks, const std::string& why) {
  for (;;) {
    const Bytes message = ranks.receive(0);
    const auto asked = BytesReader(message).get<TileRequest>();
    if (asked == TileRequest::kHello) ranks.send(0, hello(why, {}, 0));
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
  send_tiles(ranks, stock, stock::StockTiles::Which::kOfOthers);
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
