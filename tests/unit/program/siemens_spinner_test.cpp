// Two production programs by other people (assets/programs/spinner_u5): read to their end, and what they
// say about the geometry holds. They prove the senses of the machine's rotary axes.
#include <cmath>
#include <map>
#include <set>

#include "unit/program/siemens_support.h"

namespace swarf::program::nc::siemens::siemens_spinner_test {
namespace {

ControlSetup shop() {
  ControlSetup setup;
  setup.machine = spinner();
  // Lengths are assumed (the data set does not give them); diameters are those of the names.
  setup.tools = {{0, "PLAN_D50_N_AP4", 150.0, 50.0, 0.0},     {0, "SCHAFT_D12_N_AP30", 120.0, 12.0, 0.0},
                 {0, "SCHAFT_D6_N_AP15", 110.0, 6.0, 0.0},    {0, "ENTFRAESER_D8_N_90GRAD", 120.0, 8.0, 0.0},
                 {0, "SCHAFT_D8_N_AP20", 120.0, 8.0, 0.0},    {0, "SCHAFT_D4_N_AP20", 110.0, 4.0, 0.0},
                 {0, "ENTFRAESER_D8_90GRAD", 120.0, 8.0, 0.0}};
  kinematics::AxisValues offset = kinematics::AxisValues::Zero();
  offset[2] = 60.0;
  setup.work_offsets[1] = offset;
  return setup;
}

const Ran& ran_program(const std::string& name) {
  static std::map<std::string, Ran> runs;
  const auto [entry, fresh] = runs.try_emplace(name);
  if (fresh) run_file(project_file("assets/programs/spinner_u5/" + name), shop(), entry->second);
  return entry->second;
}

class SpinnerProgram : public testing::TestWithParam<std::string> {};

TEST_P(SpinnerProgram, RunsToItsEndWithoutASkippedWord) {
  const Ran& ran = ran_program(GetParam());
  EXPECT_FALSE(ran.diagnostics.has_errors()) << all_text(ran.diagnostics);
  EXPECT_EQ(ran.summary.functions, (std::vector<std::string>{"G601", "FNORM", "M9", "M50", "MSG", "COMPOF",
                                                             "M7", "M27", "M29", "M51", "M65"}));
  ASSERT_FALSE(ran.moves.empty());
  kinematics::AxisValues home = kinematics::AxisValues::Zero();
  home << -365.0, 224.0, 610.0, 0.0, 0.0;
  EXPECT_EQ(ran.moves.back().q_to, home);
  EXPECT_EQ(ran.moves.front().q_from, home);  // known after the third block
}

TEST_P(SpinnerProgram, ArcsEndOnTheirCircles) {
  int arcs = 0;
  for (const NcMove& move : ran_program(GetParam()).moves) {
    if (!move.arc) continue;
    ++arcs;
    const Vec3& n = move.arc->normal_W;
    const auto radius = [&](const Vec3& p) {
      const Vec3 spoke = p - move.arc->centre_W;
      return (spoke - spoke.dot(n) * n).norm();
    };
    EXPECT_NEAR(radius(move.from.tip_W), radius(move.to.tip_W), kArcTolerance) << "line " << move.line;
    EXPECT_NEAR(std::abs(n.dot(move.to.axis_W)), 1.0, 1e-12)
        << "line " << move.line << ": the arc lies across the tool";
  }
  EXPECT_EQ(arcs, GetParam() == "axis_cross.mpf" ? 696 : 1553);
}

/// Tip positions are the programmed ones, in the frame of the last AROT words, and every feed move of a
/// turned frame has its tool along that frame's Z: B and C turn as the machine file says.
TEST_P(SpinnerProgram, TheToolStandsAlongTheFrameThatTheProgramTurns) {
  const std::string text = read_file(project_file("assets/programs/spinner_u5/" + GetParam()));
  std::map<int, Mat3> frame_of_line;  // written by hand from the AROT words, not by the interpreter
  Mat3 frame = Mat3::Identity();
  int number = 0, turned = 0;
  for (const std::string_view line : split_lines(text)) {
    ++number;
    const size_t at = line.find("AROT ");
    if (line.find(" TRANS ") != std::string_view::npos) frame = Mat3::Identity();
    if (at != std::string_view::npos) {
      const double angle = rad_from_deg(std::stod(std::string(line.substr(at + 6))));
      frame = frame * Eigen::AngleAxisd(angle, Vec3::Unit(line[at + 5] - 'X')).toRotationMatrix();
      ++turned;
    }
    frame_of_line[number] = frame;
  }
  EXPECT_EQ(turned, GetParam() == "axis_cross.mpf" ? 41 : 0);
  int checked = 0;
  for (const NcMove& move : ran_program(GetParam()).moves) {
    if (move.rapid) continue;
    const Mat3& F = frame_of_line.at(move.line);
    EXPECT_LE((move.to.axis_W - F.col(2)).norm(), 1e-9) << "line " << move.line;
    ++checked;
  }
  EXPECT_GT(checked, 2000);
}

std::string name_of_case(const testing::TestParamInfo<std::string>& info) {
  return info.param.substr(0, info.param.find('.'));
}
INSTANTIATE_TEST_SUITE_P(Files, SpinnerProgram, testing::Values("axis_cross.mpf", "bottle_opener.mpf"),
                         name_of_case);

TEST(SpinnerPrograms, FiguresOfTheRuns) {
  const struct {
    const char* name;
    long lines, moves;
    int tip_moves;  ///< under TRAORI
    std::vector<int> tools;
  } cases[] = {{"axis_cross.mpf", 3073, 2582, 1563, {0, 1, 2, 3}},
               {"bottle_opener.mpf", 2792, 2679, 0, {4, 5, 6}}};
  for (const auto& one : cases) {
    const Ran& ran = ran_program(one.name);
    EXPECT_EQ(ran.summary.lines, one.lines) << one.name;
    EXPECT_EQ(static_cast<long>(ran.moves.size()), one.moves) << one.name;
    EXPECT_EQ(ran.summary.tools_used, one.tools) << one.name;
    int tip_moves = 0;
    for (const NcMove& move : ran.moves) tip_moves += move.law == BlockLaw::kTcp ? 1 : 0;
    EXPECT_EQ(tip_moves, one.tip_moves) << one.name;
  }
}

/// N21400 to N21430 of axis_cross.mpf, reckoned from the text: AROT X90, Y-45, Z-90 with B90 C-135.
TEST(SpinnerPrograms, PocketOnTheObliqueFaceByHand) {
  const Mat3 F = (Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()) * Eigen::AngleAxisd(-kPi / 4, Vec3::UnitY()) *
                  Eigen::AngleAxisd(-kPi / 2, Vec3::UnitZ()))
                     .toRotationMatrix();
  const Vec3 up(0, 0, 60);
  bool found = false;
  for (const NcMove& move : ran_program("axis_cross.mpf").moves) {
    if (move.line != 2146) continue;  // X20.444 Y-39.196 at Z24.381
    found = true;
    EXPECT_LE((move.to.tip_W - (up + F * Vec3(20.444, -39.196, 24.381))).norm(), 1e-9);
    EXPECT_LE((move.from.tip_W - (up + F * Vec3(20.882, -40.937, 24.381))).norm(), 1e-9);
    EXPECT_NEAR(move.feed_mm_s, 1592.0 / 60.0, 1e-12);
    EXPECT_EQ(move.spindle_rpm, 26526.0);
    EXPECT_NEAR(move.corner_tolerance_mm, 0.02, 1e-15);
    EXPECT_FALSE(move.exact_stop);
  }
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace swarf::program::nc::siemens::siemens_spinner_test
