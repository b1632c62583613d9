#include "reports/pipeline_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "reports/html.h"
#include "reports/metrics_json.h"

namespace swarf::reports {
namespace {

using Object = nlohmann::ordered_json;
using nlohmann::json;

/// Names and comments of programs need not be UTF-8; both formats must be.
std::string valid_utf8(const std::string& text) {
  return json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
}

/// A file relative to the working folder, as a reference of RFC 3986.
std::string uri_of(const std::string& file) {
  const std::filesystem::path path(file);
  const std::filesystem::path near =
      path.is_absolute() ? path.lexically_proximate(std::filesystem::current_path()) : path;
  const bool below = !near.empty() && *near.begin() != "..";
  std::string uri = path.is_absolute() && !below ? "file://" : "";
  for (const char c : (below ? near : path).lexically_normal().generic_string()) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("-._~/").find(c) != std::string_view::npos;
    uri += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri;
}

Object location_of(const SourceLocation& where) {
  Object place{{"artifactLocation", {{"uri", uri_of(where.file)}}}};
  if (where.line > 0) place["region"]["startLine"] = where.line;
  if (where.line > 0 && where.column > 0) place["region"]["startColumn"] = where.column;
  return {{"physicalLocation", place}};
}

Object result_of(const Diagnostic& told, const std::string& input) {
  SourceLocation where = told.where;
  if (where.file.empty()) where = {input};
  const std::string text = told.fix.empty() ? told.text : told.text + "\nfix: " + told.fix;
  return {{"ruleId", told.code},
          {"level", severity_name(told.severity)},
          {"message", {{"text", text}}},
          {"locations", Object::array({location_of(where)})}};
}

const char* kind_of_outcome(sim::Outcome outcome) {
  switch (outcome) {
    case sim::Outcome::kHolds:
      return "pass";
    case sim::Outcome::kFails:
    case sim::Outcome::kNotProven:
      return "fail";
    case sim::Outcome::kNotJudged:
      break;
  }
  return "open";
}

/// "deepest gouge 0.012 um, at most 0.2 um", with what it rests on or why it is open.
std::string check_text(const sim::Check& check) {
  const std::string& what = check.what.empty() ? check.subject : check.what;
  return check.reason.empty() ? what : what + ": " + check.reason;
}

Object result_of(const sim::Check& check, const std::string& input) {
  const std::string kind = kind_of_outcome(check.outcome);
  return {{"ruleId", "check/" + check.name},
          {"kind", kind},
          {"level", kind == "fail" ? "error" : "none"},
          {"message", {{"text", check_text(check)}}},
          {"locations", Object::array({location_of({input})})}};
}

struct TestCase {
  std::string name, tag, message;  ///< tag: failure, error, skipped; "": passed
};

/// The file itself, then its checks.
std::vector<TestCase> cases_of(const FileVerdict& verdict) {
  TestCase input{"input", "", ""};
  for (const Diagnostic& told : verdict.told) {
    if (told.severity != Severity::kError) continue;
    input.tag = "failure";
    input.message += (input.message.empty() ? "" : "\n") + format(told);
  }
  std::vector<TestCase> cases{input};
  for (const sim::Check& check : verdict.checks) {
    const std::string kind = kind_of_outcome(check.outcome);
    cases.push_back({check.name,
                     kind == "fail"   ? "failure"
                     : kind == "open" ? "skipped"
                                      : "",
                     kind == "pass" ? "" : check_text(check)});
  }
  return cases;
}

/// What came of a command that has not done all its work.
std::string unfinished_text(int exit_code) {
  constexpr int kBadInput = 2, kStopped = 130;
  if (exit_code == kStopped) return "stopped: nothing was judged";
  if (exit_code == kBadInput) return "not everything that was asked for could be done";
  return "swarf did not come to an end: killed, or an internal error";
}

size_t count_tag(const std::vector<TestCase>& cases, const char* tag) {
  return static_cast<size_t>(
      std::count_if(cases.begin(), cases.end(), [&](const TestCase& one) { return one.tag == tag; }));
}

}  // namespace

std::string xml_text(const std::string& text) {
  std::string clean = valid_utf8(text);
  for (char& c : clean) {
    if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') c = '?';
  }
  std::string out;
  for (const char c : escape(clean)) out += c == '\n' ? std::string("&#10;") : std::string(1, c);
  return out;
}

std::string sarif_text(const std::vector<FileVerdict>& files, int exit_code) {
  Object results = Object::array();
  std::set<std::string> codes;
  const auto add = [&](Object result) {
    codes.insert(result["ruleId"].get<std::string>());
    results.push_back(std::move(result));
  };
  for (const FileVerdict& verdict : files) {
    for (const Diagnostic& told : verdict.told) add(result_of(told, verdict.file));
    for (const sim::Check& check : verdict.checks) add(result_of(check, verdict.file));
  }
  Object rules = Object::array();
  for (const std::string& code : codes) rules.push_back({{"id", code}});
  const Object driver{{"name", "swarf"}, {"version", SWARF_VERSION}, {"rules", rules}};
  const Object run{
      {"tool", {{"driver", driver}}},
      {"invocations", Object::array({{{"executionSuccessful", exit_code < 2}, {"exitCode", exit_code}}})},
      {"results", results}};
  const Object log{{"$schema", "https://json.schemastore.org/sarif-2.1.0.json"},
                   {"version", "2.1.0"},
                   {"runs", Object::array({run})}};
  return log.dump(2, ' ', false, Object::error_handler_t::replace) + "\n";
}

std::string junit_text(const std::vector<FileVerdict>& files, int exit_code) {
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"swarf\">\n";
  for (const FileVerdict& verdict : files) {
    std::vector<TestCase> cases = cases_of(verdict);
    if (exit_code >= 2 && count_tag(cases, "failure") == 0)
      cases.push_back({"run", "error", unfinished_text(exit_code)});
    text +=
        fmt::format("  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\">\n",
                    xml_text(verdict.file), cases.size(), count_tag(cases, "failure"),
                    count_tag(cases, "error"), count_tag(cases, "skipped"));
    for (const TestCase& one : cases) {
      text += fmt::format("    <testcase classname=\"{}\" name=\"{}\"", xml_text(verdict.file),
                          xml_text(one.name));
      text += one.tag.empty()
                  ? "/>\n"
                  : fmt::format("><{} message=\"{}\"/></testcase>\n", one.tag, xml_text(one.message));
    }
    text += "  </testsuite>\n";
  }
  return text + "</testsuites>\n";
}

}  // namespace swarf::reports
