// SARIF and JUnit: nothing that is open looks right, and any text makes valid files.
#include "reports/pipeline_output.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace swarf::reports {
namespace pipeline_output_test {

using nlohmann::json;

sim::Check judged(const char* name, sim::Outcome outcome, const char* reason = "") {
  sim::Check check;
  check.name = name;
  check.subject = "Deepest gouge";
  check.outcome = outcome;
  check.reason = reason;
  return check;
}

std::vector<FileVerdict> one_of_each() {
  return {{"scenes/a b/scene.toml",
           {{"gouge", Severity::kError, {"part.nc", 21, 8}, "a gouge of 3 um", "move the tool"},
            {"no-spindle", Severity::kWarning, {"part.nc", 0, 0}, "nobody says", ""}},
           {judged("gouge", sim::Outcome::kFails), judged("excess", sim::Outcome::kNotProven, "not finished"),
            judged("travel", sim::Outcome::kHolds), judged("uncut", sim::Outcome::kNotJudged, "no design")}}};
}

TEST(Sarif, NamesFileLineAndColumn) {
  const json log = json::parse(sarif_text(one_of_each(), 1));
  EXPECT_EQ(log.at("version"), "2.1.0");
  const json& results = log.at("runs").at(0).at("results");
  ASSERT_EQ(results.size(), 6u);
  const json& place = results.at(0).at("locations").at(0).at("physicalLocation");
  EXPECT_EQ(place.at("artifactLocation").at("uri"), "part.nc");
  EXPECT_EQ(place.at("region").at("startLine"), 21);
  EXPECT_EQ(place.at("region").at("startColumn"), 8);
  EXPECT_FALSE(results.at(1).at("locations").at(0).at("physicalLocation").contains("region"));
  EXPECT_EQ(results.at(2).at("locations").at(0).at("physicalLocation").at("artifactLocation").at("uri"),
            "scenes/a%20b/scene.toml");
}

TEST(Sarif, WhatIsNotJudgedIsOpenAndWhatIsNotProvenFails) {
  const json log = json::parse(sarif_text(one_of_each(), 1));
  const json& results = log.at("runs").at(0).at("results");
  EXPECT_EQ(results.at(2).at("kind"), "fail");
  EXPECT_EQ(results.at(3).at("kind"), "fail");
  EXPECT_EQ(results.at(3).at("level"), "error");
  EXPECT_EQ(results.at(4).at("kind"), "pass");
  EXPECT_EQ(results.at(5).at("kind"), "open");
}

TEST(Sarif, ListsEveryRuleOnce) {
  const json log = json::parse(sarif_text(one_of_each(), 1));
  EXPECT_EQ(log.at("runs").at(0).at("tool").at("driver").at("rules").size(), 6u);
  EXPECT_EQ(log.at("runs").at(0).at("invocations").at(0).at("exitCode"), 1);
}

TEST(Junit, CountsFailuresAndSkipped) {
  const std::string text = junit_text(one_of_each(), 1);
  EXPECT_NE(text.find("tests=\"5\" failures=\"3\" errors=\"0\" skipped=\"1\""), std::string::npos) << text;
  EXPECT_NE(text.find("<skipped message=\"Deepest gouge: no design\"/>"), std::string::npos) << text;
  EXPECT_NE(text.find("part.nc:21:8: error: a gouge of 3 um"), std::string::npos) << text;
}

TEST(Junit, OfWhatWasNotDoneIsNeverGreen) {
  for (const int exit_code : {2, 3, 130}) {
    const std::string text = junit_text({{"a.nc", {}}}, exit_code);
    EXPECT_NE(text.find("tests=\"2\" failures=\"0\" errors=\"1\" skipped=\"0\""), std::string::npos) << text;
    EXPECT_NE(text.find("name=\"run\"><error message="), std::string::npos) << text;
  }
  EXPECT_EQ(junit_text({{"a.nc", {}}}, 0).find("<error"), std::string::npos);
  EXPECT_EQ(junit_text(one_of_each(), 2).find("<error"), std::string::npos) << "its failures say why";
}

TEST(Junit, AnyTextMakesAValidFile) {
  const std::string text =
      junit_text({{"a<b>&\"c\".nc", {{"bad", Severity::kError, {"x", 1, 1}, "\xff\x01 <&>", "\n"}}}}, 2);
  EXPECT_NE(text.find("a&lt;b&gt;&amp;&quot;c&quot;.nc"), std::string::npos) << text;
  EXPECT_EQ(text.find('\x01'), std::string::npos);
  EXPECT_EQ(text.find('\xff'), std::string::npos);
}

}  // namespace pipeline_output_test
}  // namespace swarf::reports
