#include "sim/run/in_process_stock.h"

#include <fmt/format.h>

#include <charconv>
#include <sstream>

namespace swarf::sim {
namespace {

constexpr const char* kSceneKey = "swarf_scene";
constexpr const char* kVersionKey = "swarf_version";
constexpr const char* kLineKey = "swarf_program_line";
constexpr const char* kTimeKey = "swarf_time_s";
constexpr const char* kBlockKey = "swarf_block";
constexpr const char* kSweepsKey = "swarf_sweeps";
constexpr const char* kClearanceKey = "swarf_clearance";
constexpr const char* kBadCutsKey = "swarf_bad_cuts";
constexpr const char* kBatchKey = "swarf_batch";
constexpr const char* kStockContactsKey = "swarf_stock_contacts";
constexpr const char* kPartPrefix = "swarf_part_";

/// Shortest decimals that read back to the same bits.
std::string batch_text(const BatchState& batch) {
  std::string text = fmt::format("{} {} {}", batch.end, batch.nearest_mm, batch.suspects.size());
  for (const size_t sweep : batch.suspects) text += fmt::format(" {}", sweep);
  text += fmt::format(" {}", batch.bad_suspects.size());
  for (const size_t sweep : batch.bad_suspects) text += fmt::format(" {}", sweep);
  return text;
}

bool parse_batch(const std::string& text, BatchState& batch) {
  std::istringstream in(text);
  const auto list = [&](std::vector<size_t>& sweeps) {
    size_t count = 0;
    in >> count;
    for (size_t i = 0, sweep = 0; i < count && in >> sweep; ++i) sweeps.push_back(sweep);
  };
  in >> batch.end >> batch.nearest_mm;
  list(batch.suspects);
  list(batch.bad_suspects);
  return !in.fail();
}

bool parse_state(const stock::StockMetadata& metadata, CutState& state) {
  const auto number = [&](const char* key, auto& value) {
    const auto found = metadata.find(key);
    if (found == metadata.end()) return false;
    const char* end = found->second.data() + found->second.size();
    return std::from_chars(found->second.data(), end, value).ptr == end;
  };
  const auto clearance = metadata.find(kClearanceKey);
  const auto bad_cuts = metadata.find(kBadCutsKey);
  const auto batch = metadata.find(kBatchKey);
  const auto contacts = metadata.find(kStockContactsKey);
  if (contacts == metadata.end()) return false;
  state.stock_contacts = contacts->second;
  return number(kSweepsKey, state.sweeps) && number(kLineKey, state.place.line) &&
         number(kTimeKey, state.place.t_s) && number(kBlockKey, state.place.block) &&
         clearance != metadata.end() && parse_clearance(clearance->second, state.clearance) &&
         bad_cuts != metadata.end() && parse_bad_cuts(bad_cuts->second, state.bad_cuts) &&
         batch != metadata.end() && parse_batch(batch->second, state.batch);
}

}  // namespace

InputError not_resumable(const std::string& path) {
  return {"stock-not-resumable",
          {path},
          "the stock file does not say how far it was cut",
          "name a stock that this version of swarf run has saved"};
}

stock::StockMetadata cut_metadata(const std::string& scene_name, const CutIdentity& identity,
                                  const CutState& state) {
  stock::StockMetadata metadata{{kSceneKey, scene_name},
                                {kVersionKey, SWARF_VERSION},
                                {kLineKey, fmt::format("{}", state.place.line)},
                                {kTimeKey, fmt::format("{}", state.place.t_s)},
                                {kBlockKey, fmt::format("{}", state.place.block)},
                                {kSweepsKey, fmt::format("{}", state.sweeps)},
                                {kClearanceKey, clearance_text(state.clearance)},
                                {kBadCutsKey, bad_cuts_text(state.bad_cuts)},
                                {kBatchKey, batch_text(state.batch)},
                                {kStockContactsKey, state.stock_contacts}};
  for (const IdentityPart& part : identity) metadata[kPartPrefix + part.name] = part.value;
  return metadata;
}

CutIdentity identity_in(const stock::StockMetadata& metadata) {
  CutIdentity identity;
  const std::string prefix = kPartPrefix;
  for (const auto& [key, value] : metadata) {
    if (key.compare(0, prefix.size(), prefix) == 0) identity.push_back({key.substr(prefix.size()), value});
  }
  return identity;
}

stock::Stock load_unchecked(const std::string& path, stock::StockMetadata& metadata, CutState& state,
                            const stock::RawShape* raw) {
  stock::Stock stock = stock::Stock::load(path, &metadata, raw);
  if (!parse_state(metadata, state)) {
    throw not_resumable(path);
  }
  return stock;
}

stock::Stock load_in_process(const std::string& path, const CutIdentity& identity, const stock::RawShape& raw,
                             CutState& state) {
  stock::StockMetadata metadata;
  stock::Stock stock = load_unchecked(path, metadata, state, &raw);
  Diagnostics diagnostics;
  for (const IdentityDifference& part : differences(identity_in(metadata), identity)) {
    if (state.sweeps == 0 && part.name == kMotionPart) continue;
    diagnostics.error("resume-scene-changed", {path},
                      fmt::format("the stock was cut with another {}: {}; the scene has {}", part.name,
                                  part.before, part.now),
                      "run the changed scene from the start, or take the change back");
  }
  diagnostics.throw_if_errors();
  if (state.sweeps == 0) state = {};
  return stock;
}

}  // namespace swarf::sim
