// Findings that are one fault, and which comes first.
#include "sim/judge/finding_groups.h"

#include <gtest/gtest.h>

#include <numeric>

namespace swarf::sim {
namespace {

Finding at_place(const Vec3& place, double amount_mm, int line) {
  Finding f{"gouge", Severity::kError, "a gouge", "", {"a.nc", line, 0}, 0.1 * line, "", "gouge"};
  f.place_W = place;
  f.amount_mm = amount_mm;
  f.reach_mm = 6.0;
  f.cause = "T1";
  return f;
}

Finding at_lines(const char* code, const char* check, int line, int last, const std::string& cause) {
  Finding f{code, Severity::kError, "", "", {"a.nc", line, 0}, 0.1 * line, "", check};
  f.line_last = last;
  f.cause = cause;
  return f;
}

TEST(FindingGroups, FourCornersOfSeventeenGougesAreFour) {
  std::vector<Finding> findings;
  const std::array<Vec3, 4> corners{Vec3(0, 0, 0), Vec3(40, 0, 0), Vec3(40, 30, 0), Vec3(0, 30, 0)};
  for (int i = 0; i < 17; ++i)
    findings.push_back(at_place(corners[static_cast<size_t>(i % 4)] + Vec3(0.3 * i, 0, -0.5 * i),
                                0.001 * (1 + i % 5), 10 + i));
  const std::vector<FindingGroup> groups = group_findings(findings);
  ASSERT_EQ(groups.size(), 4U);
  size_t members = 0;
  for (const FindingGroup& group : groups) {
    members += group.members.size();
    for (const size_t i : group.members)
      EXPECT_LE(findings[i].amount_mm, findings[group.members.front()].amount_mm)
          << "the worst stands for it";
  }
  EXPECT_EQ(members, 17U) << "each is in one group";
  EXPECT_EQ(groups.front().first_line, 10 + 0);
}

TEST(FindingGroups, PlacesAreLinkedByOthersAndByNothingElse) {
  std::vector<Finding> findings{at_place({0, 0, 0}, 1, 1), at_place({10, 0, 0}, 1, 2),
                                at_place({5, 0, 0}, 1, 3)};
  EXPECT_EQ(group_findings(findings).size(), 1U) << "the third links the first two";
  findings[2].cause = "T2";
  EXPECT_EQ(group_findings(findings).size(), 3U) << "another tool is another fault";
  findings[2].cause = "T1";
  findings[2].severity = Severity::kWarning;
  EXPECT_EQ(group_findings(findings).size(), 3U);
}

TEST(FindingGroups, BlocksOfOneFaultAreOneRowWithItsRange) {
  std::vector<Finding> findings;
  for (const int line : {30, 12, 10, 11, 15, 31})
    findings.push_back(at_lines("travel", "travel", line, 0, "X"));
  findings.push_back(at_lines("travel", "travel", 13, 0, "Y"));
  const std::vector<FindingGroup> groups = group_findings(findings);
  ASSERT_EQ(groups.size(), 3U);
  std::vector<std::pair<int, int>> ranges;
  for (const FindingGroup& group : groups) ranges.emplace_back(group.first_line, group.last_line);
  std::sort(ranges.begin(), ranges.end());
  EXPECT_EQ(ranges, (std::vector<std::pair<int, int>>{{10, 15}, {13, 13}, {30, 31}}));
}

TEST(FindingGroups, RowsOfBlocksReachToTheirLastLine) {
  std::vector<Finding> findings{at_lines("machine-contact", "machine_parts", 10, 40, "a and b"),
                                at_lines("machine-contact", "machine_parts", 42, 42, "a and b"),
                                at_lines("machine-contact", "machine_parts", 12, 13, "a and b"),
                                at_lines("machine-contact", "machine_parts", 47, 50, "a and b")};
  const std::vector<FindingGroup> groups = group_findings(findings);
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0].last_line, 42);
  EXPECT_EQ(groups[1].first_line, 47);
}

TEST(FindingGroups, TheRiskyStandFirst) {
  std::vector<Finding> findings{
      at_place({0, 0, 0}, 0.002, 5), at_place({90, 0, 0}, 0.2, 6), at_lines("travel", "travel", 1, 0, "X"),
      at_lines("machine-contact", "machine_parts", 9, 9, "a and b"), at_lines("fast-rotary", "", 2, 0, "")};
  findings.back().severity = Severity::kWarning;
  const std::vector<FindingGroup> groups = group_findings(findings);
  std::vector<size_t> order;
  for (const FindingGroup& group : groups) order.push_back(group.members.front());
  EXPECT_EQ(order, (std::vector<size_t>{3, 1, 0, 2, 4}));
  EXPECT_TRUE(group_findings({}).empty());
}

TEST(FindingGroups, WhatHasNoLineStandsAlone) {
  std::vector<Finding> findings{at_lines("gouge-not-proven", "gouge", 0, 0, ""),
                                at_lines("gouge-not-proven", "gouge", 0, 0, "")};
  EXPECT_EQ(group_findings(findings).size(), 2U);
  EXPECT_EQ(group_findings(findings)[0].first_line, 0);
  EXPECT_EQ(risk_of(findings[0]), 1) << "what is open is no gouge yet";
}

}  // namespace
}  // namespace swarf::sim
