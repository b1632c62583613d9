// Canned cycles of LinuxCNC, move by move.
#include "unit/program/nc_support.h"

namespace swarf::program::linuxcnc_cycles_test {
namespace {

struct Step {
  double x, y, z;
  bool rapid;
  double rpm;
};

void expect_steps(const NcRun& run, size_t from, const std::vector<Step>& steps) {
  ASSERT_EQ(run.moves().size(), from + steps.size()) << run.text();
  for (size_t i = 0; i < steps.size(); ++i) {
    SCOPED_TRACE(i);
    const NcMove& move = run.moves()[from + i];
    expect_tip(move, steps[i].x, steps[i].y, steps[i].z);
    EXPECT_EQ(move.rapid, steps[i].rapid);
    EXPECT_EQ(move.spindle_rpm, steps[i].rpm);
  }
}

TEST(LinuxCncCycles, TheThreeHolesOfTheReference) {
  const NcRun run = linuxcnc("G0 X1 Y2 Z3\nG91 G98 G81 X4 Y5 Z-0.6 R1.8 L3 F100\nM2\n");
  ASSERT_EQ(run.text(), "");
  expect_steps(run, 1,
               {{1, 2, 4.8, true, 0},
                {5, 7, 4.8, true, 0},
                {5, 7, 4.2, false, 0},
                {5, 7, 4.8, true, 0},
                {9, 12, 4.8, true, 0},
                {9, 12, 4.2, false, 0},
                {9, 12, 4.8, true, 0},
                {13, 17, 4.8, true, 0},
                {13, 17, 4.2, false, 0},
                {13, 17, 4.8, true, 0}});
}

TEST(LinuxCncCycles, TwelveHolesOfTheReference) {
  const NcRun run = linuxcnc(
      "G90 G98 G0 X0 Y0 Z0\nG1 F50 X0 G4 P0.1\nG91 G81 X1 Y0 Z-0.5 R1 L4\nX0 Y1 R0 L3\nX-1 Y0 L3\nX0 Y-1 "
      "L2\nG80\n"
      "G90 G0 X0\nY0\nZ0\nM2\n");
  ASSERT_EQ(run.text(), "");
  std::vector<Vec3> holes;
  for (const NcMove& move : run.moves()) {
    if (!move.rapid && move.duration_s > 0.0) holes.push_back(move.to.tip_W);
  }
  const std::vector<std::pair<double, double>> places = {{1, 0}, {2, 0}, {3, 0}, {4, 0}, {4, 1}, {4, 2},
                                                         {4, 3}, {3, 3}, {2, 3}, {1, 3}, {1, 2}, {1, 1}};
  ASSERT_EQ(holes.size(), 12u);
  // R0 of the second block counts from Z0, where the series began (as LinuxCNC 2.9 does).
  for (size_t i = 0; i < 12; ++i) {
    const double bottom = i < 4 ? 0.5 : -0.5;
    EXPECT_NEAR((holes[i] - Vec3(places[i].first, places[i].second, bottom)).norm(), 0.0, 1e-12) << i;
  }
}

TEST(LinuxCncCycles, TheFirstHeightStaysOverDifferentCycles) {
  const NcRun run = linuxcnc("G0 Z20\nG98 G99 G0 X0\nM2\n");
  EXPECT_EQ(run.first_error(), "modal-conflict 2:5");
  const NcRun series =
      linuxcnc("G0 Z20\nG99 G81 X1 Z-1 R2 F100\nG98 G82 X2 Z-1 P.5\nG80\nG0 Z10\nG81 X3 Z-1 R2\nM2\n");
  ASSERT_EQ(series.text(), "");
  std::vector<double> heights;
  for (const NcMove& move : series.moves()) heights.push_back(move.to.tip_W.z());
  EXPECT_EQ(heights, (std::vector<double>{20, 20, 2, -1, 2, 20, 2, -1, 20, 10, 10, 2, -1, 10}));
}

TEST(LinuxCncCycles, TappingAndBoringComeOutAsTheReferenceSays) {
  const NcRun run = linuxcnc(
      "S100 M3 G0 Z10 G98\nG84 X1 Z-5 R2 F125 P0.2\nG85 X2 Z-5 R2\nG89 X3 Z-5 R2 P1\nG86 X4 Z-5 R2 P1\n"
      "G80 M4\nG74 X5 Z-5 R2\nM2\n");
  ASSERT_EQ(run.text(), "");
  expect_steps(run, 1, {{1, 0, 10, true, 100},   {1, 0, 2, true, 100},    {1, 0, -5, false, 100},
                        {1, 0, 10, false, -100}, {2, 0, 10, true, 100},   {2, 0, 2, true, 100},
                        {2, 0, -5, false, 100},  {2, 0, 2, false, 100},   {2, 0, 10, true, 100},
                        {3, 0, 10, true, 100},   {3, 0, 2, true, 100},    {3, 0, -5, false, 100},
                        {3, 0, 10, false, 100},  {4, 0, 10, true, 100},   {4, 0, 2, true, 100},
                        {4, 0, -5, false, 100},  {4, 0, 10, true, 0},     {5, 0, 10, true, -100},
                        {5, 0, 2, true, -100},   {5, 0, -5, false, -100}, {5, 0, 10, false, 100}});
  EXPECT_EQ(run.moves()[4].dwell_s, 0.2);
  EXPECT_EQ(run.moves()[13].dwell_s, 1.0);
}

TEST(LinuxCncCycles, BackBoringOfRs274) {
  const NcRun run = linuxcnc("S100 M3 G0 Z20\nG99 G87 X10 Y5 Z-30 R2 I-3 J1 K-12 F100\nG98 G91 X20 K4\nM2\n");
  EXPECT_FALSE(run.diagnostics.has_errors()) << run.text();
  EXPECT_NE(run.text().find("cycle-of-rs274"), std::string::npos);
  // Each time the height before the move after it: stopped beside the axis, turning on it.
  const auto hole = [](double x, double above, double r, double z, double k, double out) {
    return std::vector<Step>{{x, 5, above, true, 100}, {x, 5, r, true, 100},   {x - 3, 6, r, true, 0},
                             {x - 3, 6, z, true, 0},   {x, 5, z, true, 0},     {x, 5, k, false, 100},
                             {x, 5, z, false, 100},    {x - 3, 6, z, true, 0}, {x - 3, 6, out, true, 0},
                             {x, 5, out, true, 0}};
  };
  std::vector<Step> steps = hole(10, 20, 2, -30, -12, 2);
  // Under G91 from Z20, where the series began: R2 is Z22, Z-30 is Z-8, K4 is Z-4; G98 goes back to R.
  steps.push_back({10, 5, 22, true, 100});
  for (const Step& step : hole(30, 22, 22, -8, -4, 22)) steps.push_back(step);
  steps.erase(steps.begin() + 12);  // the tool stands at R already
  expect_steps(run, 1, steps);
}

TEST(LinuxCncCycles, BackBoringInAnotherPlane) {
  const NcRun run = linuxcnc("S100 M3\nG19 G98 G0 X20\nG87 X-30 Y10 Z5 R2 J-3 K1 I-12 F100\nM2\n");
  EXPECT_FALSE(run.diagnostics.has_errors()) << run.text();
  ASSERT_EQ(run.moves().size(), 11u);
  expect_tip(run.moves()[3], 2, 7, 6);
  expect_tip(run.moves()[4], -30, 7, 6);
  expect_tip(run.moves()[6], -12, 10, 5);
  expect_tip(run.moves()[10], 20, 10, 5);
}

TEST(LinuxCncCycles, ManualBoringIsToldAndGoesStraightOut) {
  const NcRun run = linuxcnc("S100 M3 G0 Z10 G98\nG88 X1 Z-5 R2 P.5 F100\nM2\n");
  EXPECT_FALSE(run.diagnostics.has_errors()) << run.text();
  EXPECT_NE(run.text().find("cycle-of-rs274"), std::string::npos);
  expect_steps(run, 1,
               {{1, 0, 10, true, 100},
                {1, 0, 2, true, 100},
                {1, 0, -5, false, 100},
                {1, 0, 2, true, 0},
                {1, 0, 10, true, 100}});
  EXPECT_EQ(run.moves()[4].dwell_s, 0.5);
}

}  // namespace
}  // namespace swarf::program::linuxcnc_cycles_test
