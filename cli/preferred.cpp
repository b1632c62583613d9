#include "cli/preferred.h"

#include <fmt/format.h>

namespace swarf::cli {

Preferred::Preferred(post::Preference preferred, const kinematics::MachineModel& machine,
                     post::PostOptions& options)
    : preferred_(preferred), machine_(machine), first_(options), log_(machine) {
  options.hooks.routes_most = post::kRoutesMost;
  options.hooks.cost = [this](const post::PlanSummary& plan) {
    return post::preference_cost(preferred_, machine_, plan);
  };
  options.hooks.tried = [this](const post::RouteTry& one) { log_.add(one); };
}

void Preferred::compare(const std::string& file, const post::PostFormat& format,
                        const post::PostResult& result) {
  choices_ = result.choices;
  dropped_ = result.routes_dropped;
  taken_ = post::preference_value(preferred_, machine_, result.plan);
  Progress silent;
  Diagnostics unsaid;
  try {
    const post::PostResult first = post::post(
        file, machine_, format, first_, [](std::string_view) {}, silent, unsaid);
    first_value_ = post::preference_value(preferred_, machine_, first.plan);
  } catch (const InputError&) {
    first_value_ = "cannot be driven to the end";
  }
}

std::vector<std::pair<std::string, std::string>> Preferred::lines() const {
  constexpr size_t kTold = 30;
  std::vector<std::pair<std::string, std::string>> rows = log_.lines(choices_);
  const size_t all = rows.size();
  if (all > kTold) {
    rows.resize(kTold);
    rows.emplace_back("", fmt::format("and {} stretches more: --json has all", all - kTold));
  }
  const std::string unproven =
      dropped_ > 0 ? fmt::format("; {} ways were given up, so it is not proven to be the least", dropped_)
                   : "";
  rows.insert(rows.begin(),
              {"choice", fmt::format("{} of all ways: {}; the first ways that can be driven: {}{}",
                                     post::preference_text(preferred_), taken_, first_value_, unproven)});
  return rows;
}

nlohmann::ordered_json Preferred::json() const {
  nlohmann::ordered_json stretches = nlohmann::ordered_json::array();
  for (const auto& [name, text] : log_.lines(choices_)) stretches.push_back({{"lines", name}, {"way", text}});
  return {{"criterion", post::preference_text(preferred_)},
          {"taken", taken_},
          {"first_ways", first_value_},
          {"routes_dropped", dropped_},
          {"stretches", stretches}};
}

}  // namespace swarf::cli
