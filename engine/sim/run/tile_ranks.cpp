#include "sim/run/tile_ranks.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "base/check.h"

namespace swarf::sim {
namespace {

/// First byte of every message of rank 0.
enum class TileRequest : uint8_t {
  kHello,    ///< what the rank is about to cut, or why it cannot begin
  kStock,    ///< tiles of the rank, none: raw                        no answer
  kLook,     ///< begin, end, bad cuts so far: suspects and the least gap
  kNearest,  ///< begin, end, suspects of all ranks: the least gap of the other sweeps
  kCut,      ///< begin, end                                          no answer
  kChanges,  ///< StockTiles::changes()
  kRays,     ///< SurfaceDexels::tiles_of(), for each surface
  kEnd,      ///<                                                     no answer
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

/// Another rank than 0, from the first request to the last.
class TileServer {
 public:
  TileServer(Ranks& ranks, const Job& job, CutParts& parts) : ranks_(ranks), job_(job), parts_(parts) {}

  void serve(const std::function<std::vector<Bytes>()>& rays) {
    for (;;) {
      const Bytes message = ranks_.receive(0);
      BytesReader in(message);
      switch (in.get<TileRequest>()) {
        case TileRequest::kHello:
          ranks_.send(0, hello("", parts_.identity));
          break;
        case TileRequest::kStock:
          take_stock(in);
          break;
        case TileRequest::kLook:
          look(in);
          break;
        case TileRequest::kNearest:
          tell_nearest(in);
          break;
        case TileRequest::kCut: {
          const auto begin = in.get<size_t>(), end = in.get<size_t>();
          parts_.cut(*stock_, begin, end);
          break;
        }
        case TileRequest::kChanges:
          ranks_.send(0, tiles_->changes());
          break;
        case TileRequest::kRays:
          for (const Bytes& surface : rays()) ranks_.send(0, surface);
          ranks_.send(0, {});
          break;
        case TileRequest::kEnd:
          return;
      }
    }
  }

 private:
  void take_stock(BytesReader& in) {
    const StockSettings& settings = job_.scene.stock;
    const Share share = share_of(ranks_);
    stock_.emplace(stock::StockTiles::own_tiles(settings.body_W(), settings.voxel_mm, share));
    tiles_.emplace(*stock_, share);
    const auto tiles = in.get_list<std::byte>();
    if (!tiles.empty()) tiles_->apply(tiles);
    finder_.emplace(*stock_, stock::ContactFinder::Tiles::kOwn);
  }

  void look(BytesReader& in) {
    const auto begin = in.get<size_t>(), end = in.get<size_t>();
    std::vector<BadCut> found;
    SWARF_CHECK(parse_bad_cuts(in.get_text(), found), "rank 0 tells its bad cuts");
    parts_.bad_cuts.resume(found);
    finder_->refresh();
    const BatchState seen = look_at_tiles(parts_, *finder_, begin, end);
    BytesWriter answer;
    answer.add(seen.nearest_mm);
    answer.add_list(seen.suspects);
    answer.add_list(seen.bad_suspects);
    ranks_.send(0, answer.take());
  }

  void tell_nearest(BytesReader& in) {
    const auto begin = in.get<size_t>(), end = in.get<size_t>();
    BytesWriter answer;
    answer.add(nearest_of_others(parts_, *finder_, begin, end, in.get_list<size_t>()));
    ranks_.send(0, answer.take());
  }

  Ranks& ranks_;
  const Job& job_;
  CutParts& parts_;
  std::optional<stock::Stock> stock_;
  std::optional<stock::StockTiles> tiles_;
  std::optional<stock::ContactFinder> finder_;
};

}  // namespace

TileLead::TileLead(Ranks& ranks, const CutParts& parts) : ranks_(ranks), parts_(parts) {
  send_to_all(ranks, request(TileRequest::kHello));
  for (int rank = 1; rank < ranks.size(); ++rank) check_hello(rank, ranks.receive(rank), parts.identity);
}

void TileLead::begin(stock::Stock& stock, bool is_raw) {
  stock_ = &stock;
  tiles_.emplace(stock, share_of(ranks_));
  finder_.emplace(stock, stock::ContactFinder::Tiles::kOwn);
  for (int rank = 1; rank < ranks_.size(); ++rank) {
    BytesWriter message = request(TileRequest::kStock);
    message.add_list(is_raw ? Bytes{} : tiles_->tiles_of(rank));
    ranks_.send(rank, message.take());
  }
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
  message.add(begin);
  message.add(end);
  send_to_all(ranks_, std::move(message));
  is_whole_ = false;
  parts_.cut(*stock_, begin, end);
}

void TileLead::gather() {
  if (is_whole_) return;
  send_to_all(ranks_, request(TileRequest::kChanges));
  for (int rank = 1; rank < ranks_.size(); ++rank) tiles_->apply(ranks_.receive(rank));
  is_whole_ = true;
}

void serve_tile_lead(Ranks& ranks, const Job& job, CutParts& parts,
                     const std::function<std::vector<Bytes>()>& rays) {
  TileServer(ranks, job, parts).serve(rays);
}

void refuse_tile_lead(Ranks& ranks, const std::string& why) {
  for (;;) {
    const Bytes message = ranks.receive(0);
    const auto asked = BytesReader(message).get<TileRequest>();
    if (asked == TileRequest::kEnd) return;
    if (asked == TileRequest::kHello) ranks.send(0, hello(why, {}));
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

void dismiss_ranks(Ranks& ranks) {
  send_to_all(ranks, request(TileRequest::kEnd));
}

}  // namespace swarf::sim
