// The section on the singularity, computed from the shipped scene so_singularity: every figure of theory 2.
#include "reports/singularity_section.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "papers/so_study.h"
#include "papers/so_table2.h"
#include "reports/page_sections.h"
#include "sim/simulation.h"

namespace swarf::reports {
namespace {

class SoSection : public testing::Test {
 protected:
  SoSection()
      : job_(sim::load_job(SWARF_SOURCE_DIR "/scenes/so_singularity/scene.toml", {})),
        path_(sim::job_path(job_, diagnostics_).path),
        scan_(*motion::scan_singularity(path_, job_.machine.model, job_.scene.linearise_tolerance_mm)),
        rows_(papers::so_paper_rows(job_.machine.model, scan_)) {}

  const papers::PaperRow& row(const std::string& quantity) const {
    const auto found = std::find_if(rows_.begin(), rows_.end(),
                                    [&](const papers::PaperRow& one) { return one.quantity == quantity; });
    EXPECT_NE(found, rows_.end()) << quantity;
    return *found;
  }
  void expect_near(const std::string& quantity, double value, double tolerance = 1e-6) const {
    EXPECT_NEAR(std::stod(row(quantity).ours), value, tolerance) << quantity;
  }

  Diagnostics diagnostics_;
  sim::Job job_;
  toolpath::ToolPath path_;
  motion::SingularityScan scan_;
  std::vector<papers::PaperRow> rows_;
};

TEST_F(SoSection, TheRowsOfTheoryTwo) {
  ASSERT_TRUE(papers::runs_so_block(job_.machine.model, scan_));
  const double p0[] = {-90.959486, 7.310307, 227.634115, 1.066422, 148.968506};
  const double printed_p1[] = {-82.0656, -34.8175, 228.3975, 1.1793, 121.5477};
  for (int i = 0; i < 5; ++i) {
    const std::string letter(1, "XYZAC"[i]);
    expect_near("P0: inverse, " + letter, p0[i]);
    expect_near("P1: inverse, " + letter, printed_p1[i], i < 3 ? 0.13e-3 : 5e-5);
  }
  expect_near("Deviation from the line at u = .4101, printed NC data", 0.938286);
  expect_near("Analytic deviation at u = .4101, Eq. (3), (6)", 0.938189);
  expect_near("Greatest deviation from the line", 0.938333);
  EXPECT_EQ(row("Greatest deviation from the line").ours, "0.938333 at u = 0.404124");
  EXPECT_EQ(row("Greatest deviation from the line, printed NC data").ours, "0.938447 at u = 0.404136");
  EXPECT_EQ(row("Greatest analytic deviation, Eq. (8)").ours, "0.938350 at u = 0.404120");
  EXPECT_EQ(row("The same with C as printed").ours, "0.938351 at u = 0.404120");
  EXPECT_EQ(row("Greatest distance to the segment").ours, "2.126416 at u = 0.5454");
  expect_near("Past P1 along the line", 1.952073);
  expect_near("Length of the real path", 5.462893);
  expect_near("Tool axis off the great circle", 0.034036);
  const double points[3][3] = {{73.281468, -50.317918, 228.697628},
                               {72.624794, -49.620049, 228.704054},
                               {73.098517, -49.614769, 228.700078}};
  const char* at[] = {"0.25", "0.5", "0.75"};
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i)
      expect_near(fmt::format("Trajectory point, {}({})", "xyz"[i], at[k]), points[k][i]);
  }
  EXPECT_EQ(row("Greatest distance to the segment").erratum, "E15");
}

TEST_F(SoSection, SecondBranchOfP0) {
  expect_near("P0: second branch, X", 90.959486);
  // Theory 2 has t_y = 49.9338 in these two; the machine has 49.93, which fits the paper's NC data.
  expect_near("P0: second branch, Y", -7.327604);
  expect_near("P0: second branch, Z", 229.492730, 1e-4);
  expect_near("P0: second branch, A", -1.066422);
  expect_near("P0: second branch, C", -31.031494);
}

TEST_F(SoSection, ForwardOfThePrintedNcData) {
  const double p0[] = {75.2110, -51.4295, 228.6808, 0.0095944, 0.0159479, 0.9998268};
  const double p1[] = {74.5130, -50.5510, 228.6857, 0.0175393, 0.0107682, 0.9997882};
  for (size_t i = 0; i < 6; ++i) {
    const double tolerance = i < 3 ? 0.2e-3 : 1e-6;
    expect_near(fmt::format("P0: forward of the NC data, {}", "xyzijk"[i]), p0[i], tolerance);
    expect_near(fmt::format("P1: forward of the NC data, {}", "xyzijk"[i]), p1[i], tolerance);
  }
}

TEST_F(SoSection, TheTopicHasItsFiguresAndTables) {
  const Topic topic =
      singularity_topic(path_, scan_, papers::study_block(job_.machine.model, scan_.worst.front()));
  ASSERT_EQ(topic.figures.size(), 2u);
  ASSERT_EQ(topic.tables.size(), 4u);
  const Table& tolerances = topic.tables[1];
  ASSERT_EQ(tolerances.rows.size(), 6u);
  const char* equal[] = {"4", "5", "8", "11", "15", "32"};
  const char* greedy[] = {"4", "5", "7", "10", "14", "31"};
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(tolerances.rows[i][1], equal[i]);
    EXPECT_EQ(tolerances.rows[i][2], greedy[i]);
  }
  const Table& pieces = topic.tables[2];
  EXPECT_EQ(pieces.rows[1][2], "0.250863");  // theory 2 cuts the seventh digit: .250862
  EXPECT_EQ(pieces.rows[2][2], "0.063519");
  EXPECT_EQ(pieces.rows[3][2], "0.015896");
  EXPECT_EQ(pieces.rows[4][2], "0.003973");
  EXPECT_EQ(pieces.rows[5][2], "0.000993");
  EXPECT_EQ(topic.tables[3].rows.size(), 8u);
  const std::string html = topic_section(topic);
  EXPECT_NE(html.find("Singularity (So et al.)"), std::string::npos);
  EXPECT_EQ(html.find("nan"), std::string::npos);
  EXPECT_EQ(html.find("inf"), html.find("infinite"));
}

/// Another program on the same machine shows no figure of the paper.
TEST_F(SoSection, OnlyTheBlockOfTheTableShowsTheTable) {
  motion::SingularityScan other = scan_;
  for (motion::BlockSingularity& block : other.worst) block.ends.to.tip_W.x() += 1e-3;
  EXPECT_FALSE(papers::runs_so_block(job_.machine.model, other));
  EXPECT_TRUE(papers::so_paper_rows(job_.machine.model, other).empty());
}

}  // namespace
}  // namespace swarf::reports
