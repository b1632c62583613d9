#include "reports/flank_choices.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/units.h"

namespace swarf::reports {
namespace {

using ChoiceJson = nlohmann::ordered_json;

/// The shortest time of those that keep the limit, or the least error where none does or none is set.
int best_machine(const std::vector<sim::FlankMachineRow>& rows, double limit_mm) {
  int best = -1;
  const auto better = [&](const sim::FlankMachineRow& a, const sim::FlankMachineRow& b) {
    const bool a_holds = a.most_mm() <= limit_mm, b_holds = b.most_mm() <= limit_mm;
    if (a_holds != b_holds) return a_holds;
    return a_holds ? a.time_s < b.time_s : a.most_mm() < b.most_mm();
  };
  for (size_t i = 0; i < rows.size(); ++i)
    if (rows[i].reached && (best < 0 || better(rows[i], rows[static_cast<size_t>(best)])))
      best = static_cast<int>(i);
  return best;
}

Table tool_table_of(const std::vector<sim::FlankTool>& tools) {
  Table table;
  table.title = "Which tool";
  table.intro = "Every tool of the scene was planned; the one whose placement errs least mills.";
  table.columns = {
      {"Tool"}, {"Error", "µm", true}, {"at u", "", true}, {"at v", "", true}, {"Refused because"}};
  for (const sim::FlankTool& tool : tools) {
    if (tool.used) table.highlighted_row = static_cast<int>(table.rows.size());
    const bool fits = tool.refused.empty();
    table.rows.push_back({tool.name, fits ? fmt::format("{:.4f}", um_from_mm(tool.worst.mm)) : "",
                          fits ? fmt::format("{:.4f}", tool.worst.u) : "",
                          fits ? fmt::format("{:.3f}", tool.worst.v) : "", tool.refused});
  }
  return table;
}

Table machine_table(const std::vector<sim::FlankMachineRow>& rows, double limit_mm) {
  Table table;
  table.title = "Which machine";
  table.intro = fmt::format(
      "The same passes on each shipped five-axis machine, clamped in the middle of its table, 100 mm high. "
      "Marked: the {}.",
      limit_mm > 0.0 ? "quickest that keeps the limit, or where none does the one that errs least"
                     : "one that errs least");
  table.columns = {{"Machine"},
                   {"Blocks"},
                   {"Time", "s", true},
                   {"Deepest", "µm", true},
                   {"Highest", "µm", true},
                   {"What limits it"},
                   {"Share of cycles", "%", true}};
  table.highlighted_row = best_machine(rows, limit_mm);
  for (const sim::FlankMachineRow& row : rows) {
    if (!row.reached) {
      table.rows.push_back({row.machine, row.law, "", "", "", row.unreached, ""});
      continue;
    }
    table.rows.push_back({row.machine, row.law, fmt::format("{:.3f}", row.time_s),
                          fmt::format("{:.4f}", um_from_mm(row.least_mm)),
                          fmt::format("{:.4f}", um_from_mm(row.greatest_mm)), row.limiting,
                          fmt::format("{:.0f}", 100.0 * row.limiting_share)});
  }
  table.notes = {
      "Errors are those of the envelope that the control's cycles leave over the measuring rays; the "
      "tip under TCP follows the blocks, under joint each axis goes evenly through a block. What limits: "
      "the axis that most often uses more than .4 of one of its limits, and more of it than any other."};
  return table;
}

ChoiceJson flank_tools_json(const std::vector<sim::FlankTool>& tools) {
  ChoiceJson json = ChoiceJson::array();
  for (const sim::FlankTool& tool : tools) {
    ChoiceJson row{{"name", tool.name}, {"used", tool.used}};
    if (tool.refused.empty())
      row["error_um"] = um_from_mm(tool.worst.mm);
    else
      row["refused"] = tool.refused;
    json.push_back(row);
  }
  return json;
}

ChoiceJson flank_machines_json(const std::vector<sim::FlankMachineRow>& machines) {
  ChoiceJson json = ChoiceJson::array();
  for (const sim::FlankMachineRow& row : machines) {
    ChoiceJson one{{"machine", row.machine}, {"law", row.law}, {"reached", row.reached}};
    if (row.reached) {
      one["time_s"] = row.time_s;
      one["least_um"] = um_from_mm(row.least_mm);
      one["greatest_um"] = um_from_mm(row.greatest_mm);
      one["limiting"] = row.limiting;
      one["limiting_share"] = row.limiting_share;
    } else {
      one["why_not"] = row.unreached;
    }
    json.push_back(one);
  }
  return json;
}

ChoiceJson clearance_json(const sim::FlankClearance& kept) {
  return {{"asked_mm", kept.asked_mm},
          {"before_mm", kept.before_mm},
          {"before_parts", kept.before_parts},
          {"slide_mm", kept.slide_mm},
          {"lift_low_um", um_from_mm(kept.lift_low_mm)},
          {"lift_high_um", um_from_mm(kept.lift_high_mm)}};
}

}  // namespace

void add_choices(const sim::Job& job, const sim::FlankFigures& figures, ChoiceJson& json) {
  if (job.flank_clearance) json["clearance"] = clearance_json(*job.flank_clearance);
  if (!job.flank_tools.empty()) json["tools"] = flank_tools_json(job.flank_tools);
  if (!figures.machines.empty()) json["machines"] = flank_machines_json(figures.machines);
}

std::vector<Table> choice_tables(const sim::Job& job, const sim::FlankFigures& figures) {
  std::vector<Table> tables;
  if (!job.flank_tools.empty()) tables.push_back(tool_table_of(job.flank_tools));
  if (!figures.machines.empty())
    tables.push_back(machine_table(figures.machines, job.scene.flank->motion.limit_mm));
  return tables;
}

/// What the choice of a tool, of a machine and the fixtures have come to, for the console.
std::vector<std::pair<std::string, std::string>> choice_lines(const sim::Job& job,
                                                              const sim::FlankFigures& figures) {
  std::vector<std::pair<std::string, std::string>> lines;
  for (const sim::FlankTool& tool : job.flank_tools)
    lines.emplace_back("tool " + tool.name,
                       tool.refused.empty()
                           ? fmt::format("{:.3f} um at u = {:.4f}{}", um_from_mm(tool.worst.mm), tool.worst.u,
                                         tool.used ? " (used)" : "")
                           : "refused: " + tool.refused);
  const int best = best_machine(figures.machines, job.scene.flank->motion.limit_mm);
  for (size_t i = 0; i < figures.machines.size(); ++i) {
    const sim::FlankMachineRow& row = figures.machines[i];
    lines.emplace_back(row.machine + ", " + row.law,
                       row.reached ? fmt::format("{:.3f} s, {:.3f} to {:.3f} um, {}{}", row.time_s,
                                                 um_from_mm(row.least_mm), um_from_mm(row.greatest_mm),
                                                 row.limiting, static_cast<int>(i) == best ? " (best)" : "")
                                   : row.unreached);
  }
  if (!job.flank_clearance) return lines;
  const sim::FlankClearance& kept = *job.flank_clearance;
  lines.emplace_back(
      "clearance", fmt::format("{:g} mm of every fixture, proven over the whole motion; {}; slid by {:.3f} "
                               "mm, lifted by {:.3f} um "
                               "at the tip and {:.3f} um at the shank",
                               kept.asked_mm,
                               kept.before_parts.empty() ? std::string("nothing came nearer")
                                                         : fmt::format("without a move {:.3f} mm between {}",
                                                                       kept.before_mm, kept.before_parts),
                               kept.slide_mm, um_from_mm(kept.lift_low_mm), um_from_mm(kept.lift_high_mm)));
  return lines;
}

}  // namespace swarf::reports
