#include "sim/run/tile_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/diagnostics.h"

namespace swarf::sim {

BytesWriter tile_request(TileRequest what) {
  BytesWriter message;
  message.add(what);
  return message;
}

BytesWriter answer_to(TileAnswer what) {
  BytesWriter message;
  message.add(what);
  return message;
}

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

Bytes rank_hello(const std::string& failure, const CutIdentity& identity) {
  BytesWriter message = answer_to(TileAnswer::kAsked);
  message.add_text(failure);
  message.add(identity.size());
  for (const IdentityPart& part : identity) {
    message.add_text(part.name);
    message.add_text(part.value);
  }
  return message.take();
}

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

Share share_of_other(const Ranks& ranks, int rank) {
  return {rank - 1, ranks.size() - 1};
}

void unite(std::vector<size_t>& all, const std::vector<size_t>& more) {
  std::vector<size_t> both;
  std::set_union(all.begin(), all.end(), more.begin(), more.end(), std::back_inserter(both));
  all = std::move(both);
}

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

}  // namespace swarf::sim
