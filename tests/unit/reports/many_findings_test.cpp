// Ten thousand findings: the page groups them, shows the first of them, stays small and opens at once.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "reports/report_writer.h"
#include "reports/review_findings.h"
#include "sim/judge/finding_groups.h"
#include "support/page_opens.h"

namespace swarf::reports {
namespace {

constexpr size_t kFindings = 10'000;

/// Gouges of three tools along two walls, some of them near each other, others in a place of their own, and
/// moves beyond an axis in rows of lines.
std::vector<sim::Finding> many_findings(const std::string& program) {
  std::string text;
  for (size_t i = 0; i < 4 * kFindings; ++i) text += fmt::format("N{} G1 X{}\n", i, i % 300);
  test::write_text(program, text);
  std::vector<sim::Finding> findings;
  for (size_t i = 0; i < kFindings; ++i) {
    const int line = static_cast<int>(3 * i + 1);
    sim::Finding one;
    one.where = {program, line};
    one.t_s = 0.1 * static_cast<double>(i);
    one.block = "G1";
    if (i % 2 == 0) {
      one.code = one.check = "gouge";
      one.text = fmt::format("a gouge, {} um", i);
      one.fix = "move the tool of this block away from the design";
      one.place_W = Vec3(2.0 * static_cast<double>(i % 300), static_cast<double>(i / 300), 0.0);
      one.amount_mm = 1e-3 * static_cast<double>(i);
      one.cause = fmt::format("T{}", i % 3);
      one.reach_mm = 6.0;
    } else {
      one.code = one.check = "travel";
      one.text = "X is beyond its travel";
      one.where.line = static_cast<int>(i % 40 < 20 ? i + 1 : i + 40'001);  // rows of ten
      one.cause = "X";
    }
    findings.push_back(std::move(one));
  }
  return findings;
}

TEST(ManyFindings, AreGroupedAndThePageIsSmallAndOpensAtOnce) {
  const auto folder = test::fresh_folder("many_findings");
  sim::Result result;
  result.findings = many_findings((folder / "long.nc").string());
  const auto started = std::chrono::steady_clock::now();
  ReportData data;
  data.title = "Ten thousand findings";
  data.verdict = {false, "gouge fails", {}};
  data.findings = report_findings(result);
  write_report((folder / "report.html").string(), data);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  EXPECT_LT(data.findings.size(), kFindings / 10);
  size_t members = 0;
  for (const ReportFinding& one : data.findings) members += one.count;
  EXPECT_EQ(members, kFindings) << "each is in one group";
  EXPECT_LT(seconds, 5.0);
  EXPECT_LT(std::filesystem::file_size(folder / "report.html"), 2'000'000U);
  EXPECT_LE(review_pins(result).size(), kPinsMost);
  test::expect_pages_open((folder / "report.html").string());
}

/// None of them like another: as many groups as findings, of which the page shows the first and says so.
TEST(ManyFindings, ThoseThatAreAllDifferentAreShownInPart) {
  const auto folder = test::fresh_folder("different_findings");
  sim::Result result;
  result.findings = many_findings((folder / "long.nc").string());
  for (size_t i = 0; i < kFindings; ++i) result.findings[i].cause = fmt::format("cause {}", i);
  ReportData data;
  data.title = "Ten thousand causes";
  data.verdict = {false, "gouge fails", {}};
  data.findings = report_findings(result);
  ASSERT_EQ(data.findings.size(), kFindings);
  const std::string page = render_report(data);
  EXPECT_NE(page.find("The first 200 of 10000; findings.json has them all."), std::string::npos);
  EXPECT_LT(page.size(), 2'000'000U);
  EXPECT_EQ(review_pins(result).size(), kPinsMost);
}

}  // namespace
}  // namespace swarf::reports
