#include "reports/kept_findings.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/file.h"

namespace swarf::reports {
namespace {

namespace fs = std::filesystem;

std::optional<Vec3> place_of(const nlohmann::json& at) {
  if (at.is_null()) return {};
  return Vec3(at.at(0), at.at(1), at.at(2));
}

sim::Finding finding_of(const nlohmann::json& one) {
  sim::Finding finding;
  finding.code = one.at("code");
  const std::string severity = one.at("severity");
  finding.severity = severity == "note"      ? Severity::kNote
                     : severity == "warning" ? Severity::kWarning
                                             : Severity::kError;
  finding.text = one.at("text");
  finding.fix = one.at("fix");
  finding.where = {one.at("file"), one.at("line")};
  finding.t_s = one.at("t_s");
  finding.block = one.at("block");
  finding.check = one.at("check").is_null() ? "" : one.at("check");
  finding.place_W = place_of(one.at("place_mm"));
  finding.place_M = place_of(one.at("machine_place_mm"));
  return finding;
}

}  // namespace

int KeptFindings::faults() const {
  return numbers.empty() ? 0 : *std::max_element(numbers.begin(), numbers.end());
}

KeptFindings read_findings(const std::string& folder) {
  const std::string path = (fs::path(folder) / "findings.json").string();
  if (!fs::exists(path)) return {};
  const std::string text = read_all(path, {"broken-findings", "the findings cannot be read"});
  KeptFindings kept;
  try {
    const nlohmann::json list = nlohmann::json::parse(text);
    if (!list.is_array()) throw std::runtime_error("it is no list");
    for (const nlohmann::json& one : list) {
      kept.list.push_back(finding_of(one));
      kept.numbers.push_back(one.at("number"));
    }
  } catch (const std::exception& error) {
    throw InputError("broken-findings", {path},
                     std::string("this is no list of findings of this version of swarf: ") + error.what(),
                     "run the scene again");
  }
  return kept;
}

}  // namespace swarf::reports
