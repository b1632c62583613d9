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

Bytes hello(const std::string& failure, const CutIdentity& identity) {
  BytesWriter message;
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
  BytesReader in(message);
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

/// This rank's tiles, and how far they are cut.
class OwnTiles {
 public:
  OwnTiles(const Job& job, const CutParts& parts, Share share)
      : job_(job), parts_(parts), share_(share), stock_(raw()), tiles_(stock_, share) {
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
  /// The next piece of what has changed up to so many sweeps, or nothing.
  void tell_changes(size_t at, BytesWriter& out) {
    come_to(at);
    out.add_text(broken_);
    out.add_list(tiles_.next_changes().value_or(Bytes{}));
  }

 private:
  stock::Stock raw() const {
    const StockSettings& settings = job_.scene.stock;
    return stock::StockTiles::own_tiles(settings.body_W(), settings.voxel_mm, share_);
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
  Share share_;
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
      while (ahead_ && !ranks_.has_message(0)) ahead_ = own().go_on() && !own().is_done();
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
        ahead_ = parts_.carried.empty() && !own().is_done();
        return true;
      case TileRequest::kHold:
        ahead_ = false;
        out.add(own().at());
        break;
      case TileRequest::kHello:
        ranks_.send(0, hello("", parts_.identity));
        return true;
      case TileRequest::kStock:
        if (const auto at = in.get<size_t>(); at > 0) own().start_at(at);
        return true;
      case TileRequest::kTiles:
        own().take(in.get_list<std::byte>());
        break;
      case TileRequest::kLook:
        look(in, out);
        break;
      case TileRequest::kNearest: {
        ahead_ = false;
        const auto begin = in.get<size_t>(), end = in.get<size_t>();
        out.add(own().nearest(begin, end, in.get_list<size_t>()));
        break;
      }
      case TileRequest::kCut:
        own().cut_to(in.get<size_t>());
        return true;
      case TileRequest::kChanges:
        ahead_ = false;
        own().tell_changes(in.get<size_t>(), out);
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

  OwnTiles& own() {
    if (!own_) own_.emplace(job_, parts_, share_of(ranks_));
    return *own_;
  }
  void look(BytesReader& in, BytesWriter& out) {
    const auto begin = in.get<size_t>(), end = in.get<size_t>();
    std::vector<BadCut> found;
    SWARF_CHECK(parse_bad_cuts(in.get_text(), found), "rank 0 tells its bad cuts");
    parts_.bad_cuts.resume(found);
    const BatchState seen = own().look(begin, end);
    out.add(seen.nearest_mm);
    out.add_list(seen.suspects);
    out.add_list(seen.bad_suspects);
  }

  Ranks& ranks_;
  const Job& job_;
  CutParts& parts_;
  const MeasuredPath& measured_;
  const std::function<void()>& cut_rays_;
  Progress silent_;
  std::optional<OwnTiles> own_;
  std::optional<ProofInputs> proof_;
  std::unique_ptr<measure::RootProver> prover_;  ///< of the surface that is being proven
  bool ahead_ = false;                           ///< of rank 0
};

}  // namespace

TileLead::TileLead(Ranks& ranks, const CutParts& parts) : ranks_(ranks), parts_(parts) {
  send_to_all(ranks, request(TileRequest::kHello));
  for (int rank = 1; rank < ranks.size(); ++rank) check_hello(rank, ranks.receive(rank), parts.identity);
}

void TileLead::begin(stock::Stock& stock, size_t at, bool is_raw) {
  stock_ = &stock;
  at_ = at;
  tiles_.emplace(stock, share_of(ranks_));
  finder_.emplace(stock, stock::ContactFinder::Tiles::kOwn);
  for (int rank = 1; rank < ranks_.size(); ++rank) {
    BytesWriter message = request(TileRequest::kStock);
    message.add(at);
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
