#include "reports/avoidance_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/angles.h"
#include "base/units.h"
#include "reports/html.h"

namespace swarf::reports {
namespace {

using avoidance::Attempt;
using avoidance::ChangeKind;
using avoidance::Outcome;
using avoidance::Position;
using avoidance::PositionState;

nlohmann::ordered_json vector_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

nlohmann::ordered_json attempt_json(const Attempt& attempt) {
  nlohmann::ordered_json json{{"work_origin_mm", vector_json(attempt.origin_M)},
                              {"extended_mm", attempt.extended_mm},
                              {"ways_tried", attempt.tried},
                              {"free", !attempt.failure}};
  if (attempt.failure) {
    json["code"] = attempt.failure->code;
    json["text"] = attempt.failure->text;
    json["line"] = attempt.failure->line;
    json["remedies"] = nlohmann::ordered_json::array();
    for (const avoidance::Remedy one : attempt.failure->remedies)
      json["remedies"].push_back(avoidance::remedy_name(one));
  } else {
    json["slides_mm"] = attempt.slides_mm;
    json["time_s"] = attempt.plan.time_s();
  }
  json["action"] = attempt.action;
  return json;
}

long count_of(const Outcome& outcome, PositionState state) {
  return std::count_if(outcome.positions.begin(), outcome.positions.end(),
                       [&](const Position& one) { return one.state == state; });
}

/// Ways that were given up in the program that was taken, or in the last attempt.
long refused_ways(const Outcome& outcome) {
  if (outcome.attempts.empty()) return 0;
  const auto& tries = outcome.attempts.back().tries;
  return std::count_if(tries.begin(), tries.end(),
                       [](const avoidance::TriedWay& one) { return !one.outcome.empty(); });
}

std::string position_text(const Vec3& v) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f}) mm", v.x(), v.y(), v.z());
}

std::string reach_text(const std::vector<double>& extended_mm) {
  std::string text;
  for (const double one : extended_mm) text += fmt::format("{}{:+.1f}", text.empty() ? "" : ", ", one);
  return text;
}

/// One row for each decision, deeper ones further in.
Table tree(const Outcome& outcome) {
  constexpr size_t kRowsMost = 300;
  Table table;
  table.title = "Decisions, in their order";
  table.intro =
      "Each program is planned through all its stretches; a way that is not free gives place to the other "
      "solution "
      "of the rotary axes, or turns at the last pole before. What no way avoids goes to CONTROL.";
  table.columns = {{"Decision"}, {"CL lines"}, {"What came of it"}};
  for (const Attempt& attempt : outcome.attempts) {
    if (table.rows.size() >= kRowsMost) break;
    table.rows.push_back({fmt::format("Work at {}, tools {} mm", position_text(attempt.origin_M),
                                      reach_text(attempt.extended_mm)),
                          "", attempt.failure ? "not free" : "free: taken"});
    for (size_t i = 0; i < attempt.tries.size() && table.rows.size() < kRowsMost; ++i) {
      const avoidance::TriedWay& one = attempt.tries[i];
      const bool alone = one.outcome.empty() && (i == 0 || attempt.tries[i - 1].first_line != one.first_line);
      if (alone && attempt.tries.size() > 40) continue;  // the first way was free: nothing was decided
      table.rows.push_back({"\u2003" + one.way, fmt::format("{} to {}", one.first_line, one.last_line),
                            one.outcome.empty() ? fmt::format("free, {:.2f} s", one.time_s)
                                                : fmt::format("line {}: {}", one.line, one.outcome)});
    }
    if (attempt.failure) {
      table.rows.push_back({"\u2003CONTROL", fmt::format("{}", attempt.failure->line),
                            attempt.failure->text + (attempt.action.empty() ? "" : ": " + attempt.action)});
    }
  }
  table.notes.push_back("Stretches whose first way was free are left out of long programs.");
  return table;
}

/// A square for each position of one layer of the grid, seen from above.
std::string map_svg(const std::vector<const Position*>& layer, const Position* best) {
  double low_x = 1e300, low_y = 1e300, high_x = -1e300, high_y = -1e300, step = 1e300;
  for (const Position* one : layer) {
    low_x = std::min(low_x, one->origin_M.x());
    high_x = std::max(high_x, one->origin_M.x());
    low_y = std::min(low_y, one->origin_M.y());
    high_y = std::max(high_y, one->origin_M.y());
  }
  for (const Position* a : layer)
    for (const Position* b : layer) {
      const double way = (a->origin_M - b->origin_M).cwiseAbs().maxCoeff();
      if (way > 1e-9) step = std::min(step, way);
    }
  if (step > 1e299) step = 1.0;
  constexpr double kCell = 44.0, kEdge = 46.0;
  const double width = (high_x - low_x) / step * kCell + kCell + 2 * kEdge;
  const double height = (high_y - low_y) / step * kCell + kCell + 2 * kEdge;
  std::string svg = fmt::format(
      R"(<svg viewBox="0 0 {:.0f} {:.0f}" role="img" aria-label="Clamping positions: slide movements in mm, or why not">)",
      width, height);
  for (const Position* one : layer) {
    const double x = kEdge + (one->origin_M.x() - low_x) / step * kCell;
    const double y = height - kEdge - kCell - (one->origin_M.y() - low_y) / step * kCell;
    const bool valid = one->state == PositionState::kValid;
    const bool worse = one->state == PositionState::kWorse;
    const char* const text = one->state == PositionState::kNoFullTurn  ? "turn"
                             : one->state == PositionState::kOffTravel ? "travel"
                             : one->state == PositionState::kCollides  ? "hit"
                             : one->state == PositionState::kUntried   ? "?"
                                                                       : nullptr;
    const std::string label = text != nullptr ? text
                                              : fmt::format("{}{:.0f}", worse ? "\u2265" : "",
                                                            worse ? one->bound_mm : one->slides_mm);
    svg += fmt::format(
        R"(<g><title>{}</title><rect x="{:.1f}" y="{:.1f}" width="{:.0f}" height="{:.0f}" fill="{}" fill-opacity="{}" stroke="currentColor" stroke-width="{}"/><text x="{:.1f}" y="{:.1f}" text-anchor="middle" font-size="11" fill="currentColor">{}</text></g>)",
        escape(position_text(one->origin_M) + ": " + avoidance::state_name(one->state) +
               (one->why.empty() ? "" : ": " + one->why)),
        x + 1, y + 1, kCell - 2, kCell - 2,
        valid   ? "#2e9e5b"
        : worse ? "#7a8894"
                : "#c0392b",
        valid ? "0.45" : "0.25", one == best ? "3" : "0.5", x + kCell / 2, y + kCell / 2 + 4, label);
  }
  svg += fmt::format(
      R"(<text x="{:.0f}" y="{:.0f}" text-anchor="middle" font-size="12" fill="currentColor">X {:.0f} to {:.0f} mm</text>)",
      width / 2, height - 14, low_x, high_x);
  svg += fmt::format(
      R"svg(<text x="14" y="{:.0f}" text-anchor="middle" font-size="12" fill="currentColor" transform="rotate(-90 14 {:.0f})">Y {:.0f} to {:.0f} mm</text></svg>)svg",
      height / 2, height / 2, low_y, high_y);
  return svg;
}

std::vector<Figure> maps(const Outcome& outcome) {
  std::vector<double> heights;
  for (const Position& one : outcome.positions)
    if (std::find(heights.begin(), heights.end(), one.origin_M.z()) == heights.end())
      heights.push_back(one.origin_M.z());
  std::vector<Figure> figures;
  if (outcome.positions.size() < 2) return figures;
  const Position* const best = outcome.found ? &outcome.positions[outcome.best] : nullptr;
  for (const double z : heights) {
    std::vector<const Position*> layer;
    for (const Position& one : outcome.positions)
      if (one.origin_M.z() == z) layer.push_back(&one);
    figures.push_back(
        {fmt::format("Clamping positions at Z {:.1f} mm", z),
         map_svg(layer, best),
         "Sum of slide movements in mm. Green: free; the bold one is taken. Grey: at least so much, which "
         "is not below the best: no simulation was needed. Red: no full turn of the table, out of travel, "
         "or a collision.",
         {},
         false});
  }
  return figures;
}

}  // namespace

nlohmann::ordered_json avoidance_json(const Outcome& outcome, const sim::Job& job) {
  nlohmann::ordered_json json{{"found", outcome.found},
                              {"positions", outcome.positions.size()},
                              {"simulations", outcome.simulations},
                              {"no_full_turn", count_of(outcome, PositionState::kNoFullTurn)},
                              {"off_travel", count_of(outcome, PositionState::kOffTravel)},
                              {"collide", count_of(outcome, PositionState::kCollides)},
                              {"worse", count_of(outcome, PositionState::kWorse)},
                              {"attempts_count", outcome.attempts.size()},
                              {"ways_refused", refused_ways(outcome)},
                              {"extended_mm", outcome.extended_mm}};
  if (outcome.found) {
    const Position& best = outcome.positions[outcome.best];
    json["work_origin_mm"] = vector_json(best.origin_M);
    json["slides_mm"] = best.slides_mm;
    json["slides_bound_mm"] = best.bound_mm;
    json["time_s"] = best.time_s;
    json["backtrack_time_s"] = outcome.backtrack_time_s;
    json["best_routes_time_s"] = outcome.best_time_s;
    json["routes_dropped"] = outcome.routes_dropped;
    json["pole_turns"] = outcome.attempts.back().plan.pole_turns;
    json["approaches"] = outcome.attempts.back().plan.approaches;
    json["axes"] = nlohmann::ordered_json::object();
    const post::PlanSummary& plan = outcome.attempts.back().plan;
    for (size_t i = 0; i < job.machine.model.axes.size(); ++i) {
      const kinematics::Axis& axis = job.machine.model.axes[i];
      const bool rotary = axis.kind == kinematics::AxisKind::kRotary;
      const double scale = rotary ? 180.0 / kPi : 1.0;
      const std::string unit = rotary ? "deg" : "mm";
      const auto row = static_cast<long>(i);
      json["axes"][axis.name] = {{"min_" + unit, plan.low[row] * scale},
                                 {"max_" + unit, plan.high[row] * scale},
                                 {"travel_" + unit, plan.travel[row] * scale}};
    }
  }
  constexpr size_t kToldMost = 200;
  json["attempts"] = nlohmann::ordered_json::array();
  for (size_t i = 0; i < std::min(outcome.attempts.size(), kToldMost); ++i)
    json["attempts"].push_back(attempt_json(outcome.attempts[i]));
  json["map"] = nlohmann::ordered_json::array();
  for (const Position& one : outcome.positions) {
    nlohmann::ordered_json cell{{"work_origin_mm", vector_json(one.origin_M)},
                                {"state", avoidance::state_name(one.state)}};
    if (std::isfinite(one.bound_mm)) cell["slides_bound_mm"] = one.bound_mm;
    if (one.state == PositionState::kValid) cell["slides_mm"] = one.slides_mm;
    if (!one.why.empty()) cell["why"] = one.why;
    json["map"].push_back(std::move(cell));
  }
  return json;
}

std::vector<std::pair<std::string, std::string>> avoidance_lines(const Outcome& outcome,
                                                                 const sim::Job& job) {
  std::vector<std::pair<std::string, std::string>> lines;
  for (const Attempt& attempt : outcome.attempts) {
    if (!attempt.failure) continue;
    lines.emplace_back("avoided",
                       fmt::format("CL line {}: {}{}", attempt.failure->line, attempt.failure->text,
                                   attempt.action.empty() ? "" : "; " + attempt.action));
    if (lines.size() >= 8) break;
  }
  if (!outcome.found) return lines;
  const Position& best = outcome.positions[outcome.best];
  const Attempt& taken = outcome.attempts.back();
  lines.emplace_back("ways",
                     fmt::format("{} tried, {} refused, {} turns at a pole, {} approaches", taken.tried,
                                 refused_ways(outcome), taken.plan.pole_turns, taken.plan.approaches));
  if (outcome.positions.size() > 1)
    lines.emplace_back(
        "clamping", fmt::format("{} positions, {} simulated ({:.0f} %), {} without a full turn of the table",
                                outcome.positions.size(), outcome.simulations,
                                100.0 * static_cast<double>(outcome.simulations) /
                                    static_cast<double>(outcome.positions.size()),
                                count_of(outcome, PositionState::kNoFullTurn)));
  lines.emplace_back("work at", fmt::format("{}, slides move {:.1f} mm in all", position_text(best.origin_M),
                                            best.slides_mm));
  lines.emplace_back("tools", reach_text(outcome.extended_mm) + " mm against the scene");
  lines.emplace_back(
      "time",
      fmt::format("{:.2f} s with backtracking, {:.2f} s the best of all ways{}; accelerations not counted",
                  outcome.backtrack_time_s, outcome.best_time_s,
                  outcome.routes_dropped > 0 ? " that were followed (some were given up)" : ""));
  for (size_t i = 0; i < job.machine.model.axes.size(); ++i) {
    const kinematics::Axis& axis = job.machine.model.axes[i];
    const bool rotary = axis.kind == kinematics::AxisKind::kRotary;
    const double scale = rotary ? 180.0 / kPi : 1.0;
    const auto row = static_cast<long>(i);
    lines.emplace_back(
        fmt::format("axis {}", axis.name),
        fmt::format("{:.3f} to {:.3f} {}, {:.3f} in all", taken.plan.low[row] * scale,
                    taken.plan.high[row] * scale, rotary ? "deg" : "mm", taken.plan.travel[row] * scale));
  }
  return lines;
}

namespace {

/// "tilt +10.001 deg, lift 0.490 mm".
std::string change_text(const avoidance::PathChange& change) {
  std::string text;
  for (const ChangeKind kind : {ChangeKind::kLead, ChangeKind::kTilt, ChangeKind::kLift}) {
    const double amount = change.of(kind);
    if (amount == 0.0) continue;
    const bool lift = kind == ChangeKind::kLift;
    text += fmt::format("{}{} {:+.3f} {}", text.empty() ? "" : ", ", avoidance::change_name(kind),
                        lift ? amount : deg_from_rad(amount), lift ? "mm" : "deg");
  }
  return text;
}

}  // namespace

nlohmann::ordered_json advice_json(const avoidance::Advice& advice, const std::string& file) {
  nlohmann::ordered_json json{
      {"cl", file}, {"looks", advice.looks}, {"blocks", nlohmann::ordered_json::array()}};
  for (const avoidance::BlockChange& block : advice.blocks) {
    const Vec3 &tip = block.after.tip_W, &axis = block.after.axis_W;
    json["blocks"].push_back({{"line", block.line},
                              {"lead_deg", deg_from_rad(block.change.lead_rad)},
                              {"tilt_deg", deg_from_rad(block.change.tilt_rad)},
                              {"lift_mm", block.change.lift_mm},
                              {"tip_mm", {tip.x(), tip.y(), tip.z()}},
                              {"axis", {axis.x(), axis.y(), axis.z()}},
                              {"frees", block.frees}});
  }
  return json;
}

std::vector<std::pair<std::string, std::string>> advice_lines(const avoidance::Advice& advice,
                                                              const std::string& file) {
  std::vector<std::pair<std::string, std::string>> lines;
  lines.emplace_back("CL data", fmt::format("{}, {} positions changed, {} programs looked at", file,
                                            advice.blocks.size(), advice.looks));
  using avoidance::Advice;
  lines.emplace_back(
      "resolution",
      fmt::format(
          "{} angles from {:g} to {:g} deg, the least to {:g} deg; lifts doubled, the least to {:g} mm; what "
          "is free only between two of them may be passed over",
          Advice::kLeansDeg.size(), Advice::kLeansDeg.front(), Advice::kLeansDeg.back(),
          Advice::kResolutionDeg, Advice::kLiftResolutionMm));
  constexpr size_t kTold = 30;
  for (const avoidance::BlockChange& block : advice.blocks) {
    if (lines.size() > kTold) break;
    lines.emplace_back("changed", fmt::format("CL line {}: {}; it frees: {}", block.line,
                                              change_text(block.change), block.frees));
  }
  return lines;
}

Topic avoidance_topic(const Outcome& outcome, const sim::Job& job) {
  Topic topic{"avoidance", "Avoidance", "Post-processor and simulation together (Kruth et al.)", "", {}, {}};
  topic.intro =
      "The program was written from the CL data while every way of the machine was looked at for collisions; "
      "what "
      "you see above is the simulation of that program.";
  topic.figures = maps(outcome);
  Table facts;
  facts.title = "What was taken";
  facts.columns = {{"What"}, {"Value"}};
  for (const auto& [name, value] : avoidance_lines(outcome, job)) facts.rows.push_back({name, value});
  topic.tables = {facts, tree(outcome)};
  return topic;
}

}  // namespace swarf::reports
