#include "reports/review_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/units.h"
#include "program/source_text.h"
#include "sim/judge/finding_groups.h"

namespace swarf::reports {
namespace {

constexpr int kNeighbours = 3;     // lines before and behind a block
constexpr size_t kExcerpts = 200;  // the page shows no more findings

ReportFinding report_finding(std::span<const sim::Finding> findings, const sim::FindingGroup& group) {
  const sim::Finding& worst = findings[group.members.front()];
  ReportFinding out{worst.code, worst.severity, worst.text, worst.fix, worst.where, worst.t_s, worst.block};
  // A finding that names no block has no time either.
  if (worst.where.line == 0) out.time_s = std::numeric_limits<double>::quiet_NaN();
  out.count = group.members.size();
  out.first_line = group.first_line;
  out.last_line = group.last_line;
  if (worst.place_W) {
    out.has_place = true;
    for (size_t k = 0; k < 3; ++k) out.place_mm[k] = (*worst.place_W)[static_cast<Eigen::Index>(k)];
  }
  if (worst.place_M) {
    out.in_machine = true;
    for (size_t k = 0; k < 3; ++k) out.place_mm[k] = (*worst.place_M)[static_cast<Eigen::Index>(k)];
  }
  return out;
}

/// The text around the blocks that have one; each file is read once.
void add_excerpts(std::vector<ReportFinding>& findings) {
  std::map<std::string, std::set<int>> wanted;
  for (const ReportFinding& finding : findings)
    if (!finding.block.empty())
      for (int line = finding.where.line - kNeighbours; line <= finding.where.line + kNeighbours; ++line)
        if (line > 0) wanted[finding.where.file].insert(line);
  std::map<std::string, std::map<int, std::string>> texts;
  for (const auto& [file, lines] : wanted) texts[file] = program::read_lines(file, lines);
  for (ReportFinding& finding : findings) {
    if (finding.block.empty()) continue;
    const std::map<int, std::string>& lines = texts[finding.where.file];
    const auto end = lines.upper_bound(finding.where.line + kNeighbours);
    for (auto at = lines.lower_bound(finding.where.line - kNeighbours); at != end; ++at)
      finding.excerpt.push_back({at->first, at->second});
  }
}

}  // namespace

std::vector<ReportFinding> report_findings(const sim::Result& result) {
  std::vector<ReportFinding> out;
  for (const sim::FindingGroup& group : sim::group_findings(result.findings))
    out.push_back(report_finding(result.findings, group));
  std::vector<ReportFinding> shown(out.begin(),
                                   out.begin() + static_cast<ptrdiff_t>(std::min(out.size(), kExcerpts)));
  add_excerpts(shown);
  std::move(shown.begin(), shown.end(), out.begin());
  return out;
}

namespace {

void add_pin(size_t number, const sim::Finding& worst, std::vector<ReviewPin>& pins) {
  if ((!worst.place_W && !worst.place_M) || pins.size() >= kPinsMost) return;
  pins.push_back({number, worst.code, worst.text, worst.severity, worst.place_W, worst.place_M,
                  worst.where.line, worst.t_s, worst.amount_mm});
}

}  // namespace

std::vector<ReviewPin> review_pins(const sim::Result& result) {
  std::vector<ReviewPin> pins;
  const std::vector<sim::FindingGroup> groups = sim::group_findings(result.findings);
  for (size_t i = 0; i < groups.size(); ++i) add_pin(i + 1, result.findings[groups[i].members.front()], pins);
  return pins;
}

std::vector<ReviewPin> review_pins(const KeptFindings& kept) {
  std::vector<ReviewPin> pins;
  int last = 0;
  for (size_t i = 0; i < kept.list.size(); ++i) {
    // The worst of a fault stands first in the file.
    if (kept.numbers[i] != last) add_pin(static_cast<size_t>(kept.numbers[i]), kept.list[i], pins);
    last = kept.numbers[i];
  }
  return pins;
}

const measure::Ridge* highest_ridge(const sim::Result& result) {
  const auto& ridges = result.main.ridges;
  const auto highest = std::max_element(
      ridges.begin(), ridges.end(), [](const auto& a, const auto& b) { return a.height_um < b.height_um; });
  return highest != ridges.end() ? &*highest : nullptr;
}

std::vector<WorstPlace> worst_places(const sim::Result& result) {
  const measure::SurfaceMetrics& surface = result.main.surface;
  std::vector<WorstPlace> places;
  if (surface.gouge_max_um > 0.0)
    places.push_back({surface.gouge_bottom, -surface.gouge_max_um * kMicrometre, surface.gouge_bottom});
  if (surface.excess_max_um > 0.0)
    places.push_back({surface.excess_top, surface.excess_max_um * kMicrometre, surface.excess_top});
  if (const measure::Ridge* ridge = highest_ridge(result))
    places.push_back({ridge->point, ridge->height_um * kMicrometre});
  return places;
}

std::vector<WorstPlace> kept_worst_places(const std::string& folder) {
  std::ifstream file(std::filesystem::path(folder) / "metrics.json");
  const nlohmann::json metrics = nlohmann::json::parse(file, nullptr, false);
  std::vector<WorstPlace> places;
  if (!metrics.is_object()) return places;
  const auto place_of = [](const nlohmann::json& one) {
    return Vec3(one.value("x_mm", 0.0), one.value("y_mm", 0.0), one.value("z_mm", 0.0));
  };
  const auto add = [&](const char* name, const char* value, double sign, bool end) {
    const auto one = metrics.find(name);
    if (one == metrics.end() || !one->is_object()) return;
    places.push_back({place_of(*one), sign * one->value(value, 0.0) * kMicrometre});
    if (end) places.back().end_W = places.back().place_W;
  };
  add("deepest_gouge", "depth_um", -1.0, true);
  add("highest_material", "height_um", 1.0, true);
  add("highest_ridge", "height_um", 1.0, false);
  return places;
}

}  // namespace swarf::reports
