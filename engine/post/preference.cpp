#include "post/preference.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/units.h"

namespace swarf::post {
namespace {

using kinematics::AxisKind;

/// A second weighs so much in mm where ways are equal otherwise: below every digit.
constexpr double kTieMmPerSecond = 1e-9;

}  // namespace

std::optional<Preference> preference(std::string_view word) {
  if (word == "time") return Preference::kTime;
  if (word == "accuracy") return Preference::kAccuracy;
  if (word == "travel") return Preference::kTravel;
  return {};
}

const char* preference_text(Preference preferred) {
  switch (preferred) {
    case Preference::kAccuracy:
      return "the least deviation of the tip";
    case Preference::kTravel:
      return "the least slide movements";
    case Preference::kTime:
      break;
  }
  return "the least time";
}

std::string preference_value(Preference preferred, const kinematics::MachineModel& machine,
                             const PlanSummary& plan) {
  switch (preferred) {
    case Preference::kAccuracy:
      return fmt::format("{:.3f} um", um_from_mm(plan.deviation_mm));
    case Preference::kTravel:
      return fmt::format("{:.3f} mm", slides_of(machine, plan));
    case Preference::kTime:
      break;
  }
  return fmt::format("{:.3f} s", plan.time_s());
}

double slides_of(const kinematics::MachineModel& machine, const PlanSummary& plan) {
  double sum = 0.0;
  for (size_t i = 0; i < machine.axes.size(); ++i)
    if (machine.axes[i].kind == AxisKind::kLinear) sum += plan.travel[static_cast<long>(i)];
  return sum;
}

double preference_cost(Preference preferred, const kinematics::MachineModel& machine,
                       const PlanSummary& plan) {
  switch (preferred) {
    case Preference::kAccuracy:
      return plan.deviation_mm + kTieMmPerSecond * plan.time_s();
    case Preference::kTravel:
      return slides_of(machine, plan) + kTieMmPerSecond * plan.time_s();
    case Preference::kTime:
      break;
  }
  return plan.time_s();
}

std::string way_text(const kinematics::MachineModel& machine, const RouteChoice& way) {
  std::string text;
  for (size_t i = 0; i < machine.axes.size(); ++i)
    if (machine.axes[i].kind == AxisKind::kRotary)
      text += fmt::format("{}{} {:.3f}", text.empty() ? "" : " ", machine.axes[i].name,
                          deg_from_rad(way.start.q[static_cast<long>(i)]));
  text += way.lifted ? ", lifted before" : ", driven there";
  for (size_t i = 0; i < way.sides.size(); ++i)
    if (way.sides[i] == PoleSide::kOther) text += fmt::format("; turns at pole {}", i + 1);
  return text;
}

void RouteLog::add(const RouteTry& tried) {
  if (stretches_.empty() || stretches_.back().first_line != tried.first_line ||
      stretches_.back().last_line != tried.last_line)
    stretches_.push_back({tried.first_line, tried.last_line, {}, {}});
  Stretch& stretch = stretches_.back();
  const std::string way = way_text(machine_, tried.way);
  const bool driven = tried.fault.code.empty();
  const auto [known, fresh] = stretch.ways.try_emplace(way, driven);
  if (driven)
    known->second = true;
  else if (fresh)
    stretch.refusals.push_back({way, tried.fault.text, tried.fault_line});
}

std::vector<std::pair<std::string, std::string>> RouteLog::lines(
    const std::vector<RouteChoice>& taken) const {
  std::vector<std::pair<std::string, std::string>> lines;
  for (size_t i = 0; i < std::min(stretches_.size(), taken.size()); ++i) {
    const Stretch& stretch = stretches_[i];
    const auto driven =
        std::count_if(stretch.ways.begin(), stretch.ways.end(), [](const auto& one) { return one.second; });
    std::string why = driven == 1 ? "the only way that can be driven"
                                  : fmt::format("the best of {} that can be driven", driven);
    const auto first = std::find_if(stretch.refusals.begin(), stretch.refusals.end(),
                                    [&](const Refusal& one) { return !stretch.ways.at(one.way); });
    if (first != stretch.refusals.end())
      why +=
          fmt::format("; {} cannot, such as {}: line {}: {}",
                      stretch.ways.size() - static_cast<size_t>(driven), first->way, first->line, first->why);
    lines.emplace_back(fmt::format("CL {} to {}", stretch.first_line, stretch.last_line),
                       fmt::format("{}: {}", way_text(machine_, taken[i]), why));
  }
  return lines;
}

}  // namespace swarf::post
