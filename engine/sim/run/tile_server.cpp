#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "base/check.h"
#include "measure/dealt_roots.h"
#include "sim/run/bad_cuts.h"
#include "sim/run/result.h"
#include "sim/run/tile_messages.h"
#include "sim/run/tile_ranks.h"

namespace swarf::sim {
namespace {

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
  void take(std::span<const std::byte> tiles) { tiles_.apply(tiles); }
  /// take() brings what so many sweeps have left.
  void start_at(size_t at) {
    come_to(0);
    at_ = left_.at = at;
  }
  const stock::Stock& stock() const { return stock_; }

  /// Looks at the next batch where it has come to one. False: nothing is left up to sweep `most`, or a sweep
  /// is not clear of these tiles, so that rank 0 must come to it first.
  bool may_go_on(size_t most) {
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
    return !waits_;
  }
  /// Then one more part of the program, not beyond sweep `most`, as one process would cut it.
  void go_on(size_t most) { cut_to(std::min({next_look_, parts_.check_end(at_), most})); }
  /// Up to this sweep, or to where it must wait; back to it where more is cut.
  void meet(size_t at) {
    come_to(at);
    while (may_go_on(at)) go_on(at);
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
  /// The batch was begun ahead, and next_seen() has given it.
  bool has_told(size_t begin) const {
    return seen_.contains(begin) && std::ranges::find(untold_, begin) == untold_.end();
  }
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
        const size_t end = service_.parts.sweeps.size();
        ahead_ = has_room() && own().may_go_on(end);
        if (is_known_) tell_seen();  // rank 0 cuts the batch meanwhile
        if (ahead_) own().go_on(end);
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
        ranks_.send(0, rank_hello("", service_.parts.identity));
        is_known_ = true;
        if (own_) tell_seen();
        return true;
      case TileRequest::kLeft:
        next_piece_ = [this, taken = in.get<uint32_t>()] { return own().next_left(taken); };
        tell_pieces(kPiecesOnTheirWay);
        return true;
      case TileRequest::kStock:
        own().start_at(in.get<size_t>());
        return true;
      case TileRequest::kTiles:
        own().take(in.get_bytes());
        break;
      case TileRequest::kLook:
        if (!look(in, out)) return true;
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
        next_piece_ = [this, at = in.get<size_t>()] { return own().next_changes(at); };
        tell_pieces(kPiecesOnTheirWay);
        return true;
      case TileRequest::kMore:
        tell_pieces(1);
        return true;
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
        ranks_.send(0, prove_slab(in));
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
        ranks_.send(0, tile_request(TileRequest::kEnd).take());
        return false;
    }
    return true;
  }

  OwnTiles& own() {
    if (!own_) own_.emplace(service_.job, service_.parts, share_of_other(ranks_, ranks_.rank()));
    return *own_;
  }
  /// Rank 0 has not predicted yet what this takes. By the number of leaves: to ask each of them takes a tenth
  /// of the time of a cut.
  bool has_room() {
    const StockSettings& settings = service_.job.scene.stock;
    const auto leaves = static_cast<double>(own().stock().leaves());
    return static_cast<double>(stock::Stock::memory_for(settings.box_W, settings.voxel_mm, leaves)) /
               kMbOfRank <=
           service_.most_mb;
  }
  /// False: rank 0 has been told, and goes on by that.
  bool look(BytesReader& in, BytesWriter& out) {
    const auto begin = in.get<size_t>(), end = in.get<size_t>();
    std::vector<BadCut> found;
    SWARF_CHECK(parse_bad_cuts(in.get_text(), found), "rank 0 tells its bad cuts");
    service_.parts.bad_cuts.resume(found);
    if (own().has_told(begin)) return false;
    add_seen(own().look(begin, end), out);
    return true;
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
  Bytes prove_slab(BytesReader& in) {
    SWARF_CHECK(own().standing().at == in.get<size_t>(),
                "the stock that is proven is cut as far as that of rank 0");
    return stock::SlabProofs::answer(in, own().stock());
  }
  void tell_nearest(BytesReader& in, BytesWriter& out) {
    const auto begin = in.get<size_t>(), end = in.get<size_t>();
    const auto suspects = in.get_list<size_t>();
    out.add(own().nearest(begin, end, suspects));
  }
  void tell_pieces(int count) {
    for (; count > 0 && next_piece_; --count) {
      const std::optional<Bytes> piece = next_piece_();
      if (!piece) next_piece_ = nullptr;
      BytesWriter out = answer_to(TileAnswer::kAsked);
      out.add_text(own().broken());
      out.add_list(piece.value_or(Bytes{}));
      ranks_.send(0, out.take());
    }
  }

  Ranks& ranks_;
  const TileService& service_;
  Progress silent_;
  std::optional<OwnTiles> own_;
  std::optional<ProofInputs> proof_;
  std::unique_ptr<measure::RootProver> prover_;  ///< of the surface that is being proven
  /// Of what rank 0 has asked for; empty: nothing is left to tell.
  std::function<std::optional<Bytes>()> next_piece_;
  bool ahead_;             ///< of rank 0
  bool is_known_ = false;  ///< to rank 0, which takes what is told
};

}  // namespace

void serve_tile_lead(Ranks& ranks, const TileService& service) {
  TileServer server(ranks, service);
  server.serve();
  ranks.leave();  // while the stock is given back
}

void refuse_tile_lead(Ranks& ranks, const std::string& why) {
  for (;;) {
    const Bytes message = ranks.receive(0);
    const auto asked = BytesReader(message).get<TileRequest>();
    if (asked == TileRequest::kHello) ranks.send(0, rank_hello(why, {}));
    if (asked != TileRequest::kEnd) continue;
    ranks.send(0, tile_request(TileRequest::kEnd).take());
    ranks.leave();
    return;
  }
}

}  // namespace swarf::sim
