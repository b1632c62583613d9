// findings.json (metrics_json.h).
#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "reports/metrics_json.h"
#include "sim/judge/finding_groups.h"

namespace swarf::reports {

std::string severity_name(Severity severity) {
  if (severity == Severity::kError) return "error";
  return severity == Severity::kWarning ? "warning" : "note";
}

std::string findings_json(const sim::Result& result) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  const std::vector<sim::FindingGroup> groups = sim::group_findings(result.findings);
  for (size_t number = 1; number <= groups.size(); ++number) {
    for (const size_t member : groups[number - 1].members) {
      const sim::Finding& finding = result.findings[member];
      const auto place = [](const std::optional<Vec3>& at) {
        return at ? Json{at->x(), at->y(), at->z()} : Json(nullptr);
      };
      list.push_back({{"code", finding.code},
                      {"severity", severity_name(finding.severity)},
                      {"check", finding.check.empty() ? Json(nullptr) : Json(finding.check)},
                      {"text", finding.text},
                      {"fix", finding.fix},
                      {"file", finding.where.file},
                      {"line", finding.where.line},
                      {"line_last", std::max(finding.where.line, finding.line_last)},
                      {"block", finding.block},
                      {"t_s", finding.t_s},
                      {"earlier", finding.earlier.line > 0
                                      ? Json{{"file", finding.earlier.file}, {"line", finding.earlier.line}}
                                      : Json(nullptr)},
                      {"place_mm", place(finding.place_W)},
                      {"machine_place_mm", place(finding.place_M)},
                      {"number", number}});
    }
  }
  return json_text(list);
}

}  // namespace swarf::reports
