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

/// The values that one coordinate of a layer takes, in their order, mm.
std::vector<double> grid_lines(const std::vector<const Position*>& layer, int axis) {
  std::vector<double> values;
  for (const Position* one : layer) values.push_back(one->origin_M[axis]);
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end(), [](double a, double b) { return b - a < 1e-9; }),
               values.end());
  return values;
}

size_t grid_line(const std::vector<double>& values, double value) {
  return static_cast<size_t>(std::lower_bound(values.begin(), values.end(), value - 1e-9) - values.begin());
}

std::string map_text(double x, double y, const char* anchor, const std::string& text) {
  return fmt::format(
      R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}" font-size="11" fill="currentColor">{}</text>)", x, y,
      anchor, text);
}

/// What stands in a position's square.
std::string cell_label(const Position& one) {
  switch (one.state) {
    case PositionState::kNoFullTurn:
      return "turn";
    case PositionState::kOffTravel:
      return "travel";
    case PositionState::kCollides:
      return "hit";
    case PositionState::kUntried:
      return "?";
    case PositionState::kWorse:
      return fmt::format("\u2265{:.0f}", one.bound_mm);
    case PositionState::kValid:
      break;
  }
  return fmt::format("{:.0f}", one.slides_mm);
}

/// A square for each position of one layer of the grid, seen from above.
std::string map_svg(const std::vector<const Position*>& layer, const Position* best) {
  constexpr double kCell = 44.0, kLeft = 64.0, kBelow = 46.0, kAbove = 6.0;
  const std::vector<double> xs = grid_lines(layer, 0), ys = grid_lines(layer, 1);
  const double width = kLeft + kCell * static_cast<double>(xs.size()) + 8.0;
  const double foot = kAbove + kCell * static_cast<double>(ys.size()), height = foot + kBelow;
  std::string svg = fmt::format(
      R"(<svg viewBox="0 0 {:.0f} {:.0f}" role="img" aria-label="Clamping positions: slide movements in mm, or why not">)",
      width, height);
  for (const Position* one : layer) {
    const double x = kLeft + kCell * static_cast<double>(grid_line(xs, one->origin_M.x()));
    const double y = foot - kCell * static_cast<double>(grid_line(ys, one->origin_M.y()) + 1);
    const bool valid = one->state == PositionState::kValid, worse = one->state == PositionState::kWorse;
    svg += fmt::format(
        R"(<g><title>{}</title><rect x="{:.1f}" y="{:.1f}" width="{:.0f}" height="{:.0f}" fill="{}" fill-opacity="{}" stroke="currentColor" stroke-width="{}"/>{}</g>)",
        escape(position_text(one->origin_M) + ": " + avoidance::state_name(one->state) +
               (one->why.empty() ? "" : ": " + one->why)),
        x + 1, y + 1, kCell - 2, kCell - 2,
        valid   ? "#2e9e5b"
        : worse ? "#7a8894"
                : "#c0392b",
        valid ? "0.45" : "0.25", one == best ? "3" : "0.5",
        map_text(x + kCell / 2, y + kCell / 2 + 4, "middle", cell_label(*one)));
  }
  for (size_t i = 0; i < xs.size(); ++i)
    svg += map_text(kLeft + kCell * (static_cast<double>(i) + 0.5), foot + 16, "middle",
                    fmt::format("{:g}", xs[i]));
  for (size_t i = 0; i < ys.size(); ++i)
    svg += map_text(kLeft - 6, foot - kCell * (static_cast<double>(i) + 0.5) + 4, "end",
                    fmt::format("{:g}", ys[i]));
  svg += map_text(kLeft + 0.5 * (width - kLeft), height - 8, "middle", "X of the work's zero, mm");
  return svg +
         fmt::format(
             R"svg(<text x="12" y="{0:.0f}" text-anchor="middle" font-size="11" fill="currentColor" transform="rotate(-90 12 {0:.0f})">Y, mm</text></svg>)svg",
             0.5 * (kAbove + foot));
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
         figures.empty()
             ? "Sum of slide movements in mm. Green: free; the bold one is taken. Grey: at least so much, "
               "which "
               "is not below the best: no simulation was needed. Red: no full turn of the table, out of "
               "travel, or a collision; the reason stands where the pointer rests."
             : "",
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
    lines.emplace_back(
        "avoided",
        fmt::format(
            "CL line {}: {}{}{}", attempt.failure->line, attempt.failure->text,
            outcome.positions.size() > 1 ? ", with the work at " + position_text(attempt.origin_M) : "",
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
      fmt::format("{:.2f} s with backtracking, {:.2f} s the {}{}; accelerations not counted",
                  outcome.backtrack_time_s, outcome.best_time_s,
                  outcome.preferred == post::Preference::kTime
                      ? "best of all ways"
                      : fmt::format("one of all ways that has {}", post::preference_text(outcome.preferred)),
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
  lines.emplace_back("resolution",
                     fmt::format("lead and tilt up to {:g} deg in bands of {:g} deg ({:g} for gouges), the "
                                 "least to {:g} deg; lifts doubled, the least "
                                 "to {:g} mm; a free range narrower than a band may be passed over, one of "
                                 "{:g} deg between places where nothing can stand is not",
                                 Advice::kLeanMostDeg, Advice::kBandDeg, Advice::kGougeBandDeg,
                                 Advice::kResolutionDeg, Advice::kLiftResolutionMm, 2.0 * Advice::kStandDeg));
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
