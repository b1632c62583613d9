#include "reports/setups_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "sim/job/set_ups.h"

namespace swarf::reports {
namespace {

std::string hash_text(uint64_t hash) {
  return fmt::format("{:016x}", hash);
}

}  // namespace

SetupOutcome setup_outcome(const sim::Job& job, const sim::Result& result) {
  const sim::SetupSettings& setup = job.scene.setup;
  const sim::CarriedCuts& carried = *result.main.carried;
  return {.number = setup.number,
          .name = setup.name,
          .folder = sim::setup_folder(job.scene),
          .passes = sim::passes(result),
          .verdict = sim::verdict_sentence(result.checks),
          .start_hash = result.start_hash,
          .hash = result.stock->hash(),
          .starts_from = job.earlier.empty() ? "" : fmt::format("{}", fmt::join(carried.stock.where, ", ")),
          .cuts = carried.text(),
          .volume_removed_mm3 = result.volume_removed_mm3,
          .volume_left_mm3 = result.volume_left_mm3,
          .time_s = result.main.motion.statistics.time_s};
}

std::string setup_line(const SetupOutcome& setup) {
  return fmt::format("set-up {}{}: {}\n    stock {} -> {}, {:.1f} cm3 removed, {:.1f} cm3 left{}",
                     setup.number, setup.name.empty() ? "" : ", " + setup.name,
                     setup.passes ? "PASS" : "FINDINGS", hash_text(setup.start_hash), hash_text(setup.hash),
                     setup.volume_removed_mm3 * 1e-3, setup.volume_left_mm3 * 1e-3,
                     setup.starts_from.empty() ? "" : "; begins with what was cut " + setup.starts_from);
}

std::string setups_json(const std::string& scene, const std::string& command, size_t count,
                        const std::vector<SetupOutcome>& setups) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const SetupOutcome& setup : setups) {
    const Json from =
        setup.starts_from.empty() ? Json(nullptr) : Json{{"cut", setup.starts_from}, {"cuts", setup.cuts}};
    list.push_back({{"number", setup.number},
                    {"name", setup.name},
                    {"folder", setup.folder},
                    {"passes", setup.passes},
                    {"verdict", setup.verdict},
                    {"stock_start_hash", hash_text(setup.start_hash)},
                    {"stock_hash", hash_text(setup.hash)},
                    {"starts_from", from},
                    {"volume_removed_mm3", setup.volume_removed_mm3},
                    {"volume_left_mm3", setup.volume_left_mm3},
                    {"time_s", setup.time_s}});
  }
  const bool all_pass = std::all_of(setups.begin(), setups.end(), [](const auto& one) { return one.passes; });
  const Json json{
      {"schema", 1},     {"swarf", SWARF_VERSION},
      {"scene", scene},  {"command", command},
      {"setups", count}, {"passes", !all_pass || setups.size() == count ? Json(all_pass) : Json(nullptr)},
      {"finished", list}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace swarf::reports
