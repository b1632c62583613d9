// The reader against LinuxCNC itself: programs whose moves its own interpreter has written down
// (tests/golden/linuxcnc).
#include <algorithm>
#include <sstream>

#include "unit/program/nc_support.h"

namespace swarf::program::linuxcnc_agreement_test {
namespace {

/// rs274 prints four decimals; an end is a sum of up to five such numbers, turned by an angle with four.
constexpr double kPrintedMm = 5e-4;
constexpr double kNowhereMm = 2e-4;  // as record.py

/// A line of a .moves file.
struct Printed {
  char kind = 0;
  Vec3 end = Vec3::Zero(), centre = Vec3::Zero();
  double rpm = 0.0, feed = 0.0;
  int exact = 0;
  std::string text;
};

std::vector<Printed> read_moves(const std::string& path) {
  std::ifstream file(path);
  std::vector<Printed> all;
  for (std::string line; std::getline(file, line);) {
    if (line.empty()) continue;
    std::istringstream words(line);
    Printed one;
    one.text = line;
    words >> one.kind;
    if (one.kind != 'E') words >> one.end.x() >> one.end.y() >> one.end.z() >> one.rpm;
    if (one.kind == 'L' || one.kind == 'A') words >> one.feed >> one.exact;
    if (one.kind == 'A') words >> one.centre.x() >> one.centre.y() >> one.centre.z();
    EXPECT_TRUE(words) << path << ": " << line;
    all.push_back(one);
  }
  return all;
}

/// The moves as rs274 counts them: none that go nowhere, an arc of several turns as one.
std::vector<NcMove> counted(const std::vector<NcMove>& moves) {
  std::vector<NcMove> all;
  Vec3 at = Vec3::Zero();
  for (const NcMove& move : moves) {
    const Vec3 end = move.q_to.head<3>();
    if (!move.arc && (end - at).norm() < kNowhereMm) continue;
    at = end;
    const bool goes_on =
        move.arc && !all.empty() && all.back().arc && all.back().line == move.line &&
        (all.back().arc->centre_W - move.arc->centre_W).cross(move.arc->normal_W).norm() < 1e-9;
    if (goes_on)
      all.back() = move;
    else
      all.push_back(move);
  }
  return all;
}

/// mm/min, also of a straight move under G93.
double feed_of(const NcMove& move) {
  const double way = (move.to.tip_W - move.from.tip_W).norm();
  return move.feed_mm_s > 0.0 ? 60.0 * move.feed_mm_s : 60.0 * way / move.duration_s;
}

void expect_same(const NcMove& ours, const Printed& theirs) {
  const std::string where = "line " + std::to_string(ours.line) + ", LinuxCNC: " + theirs.text;
  ASSERT_EQ(ours.arc ? 'A' : ours.rapid ? 'R' : 'L', theirs.kind) << where;
  ASSERT_NEAR((ours.q_to.head<3>() - theirs.end).norm(), 0.0, kPrintedMm)
      << where << "\nours: " << ours.q_to.head<3>().transpose();
  EXPECT_NEAR(ours.spindle_rpm, theirs.rpm, 1e-3) << where;
  if (theirs.kind == 'R') return;
  EXPECT_NEAR(feed_of(ours), theirs.feed, 1e-4 * theirs.feed + 1e-4) << where;
  if (theirs.kind == 'L') {
    EXPECT_EQ(ours.exact_stop, theirs.exact == 1) << where;
    return;
  }
  // The tip's arc lies a tool length below the gauge line's.
  const Vec3 gauge = ours.q_to.head<3>() - ours.to.tip_W;
  const Vec3 off = ours.arc->centre_W + gauge - theirs.centre;
  EXPECT_NEAR(off.cross(ours.arc->normal_W).norm(), 0.0, 4 * kPrintedMm) << where;
}

class LinuxCncAgreement : public testing::TestWithParam<std::string> {};

TEST_P(LinuxCncAgreement, MovesAreThoseOfTheControl) {
  ControlSetup setup = three_axis_setup();
  setup.tools = {{1, "", 50.8, 6.35, 0.0}, {2, "", 25.4, 12.7, 0.0}, {3, "", 12.7, 2.54, 0.0}};
  const NcRun run = run_file(GetParam(), Dialect::kLinuxCnc, setup);
  std::vector<Printed> theirs = read_moves(GetParam().substr(0, GetParam().size() - 4) + ".moves");
  ASSERT_FALSE(theirs.empty());
  if (theirs.back().kind == 'E') {
    EXPECT_NE(run.first_error(), "") << "LinuxCNC refuses it: " << theirs.back().text;
    return;
  }
  ASSERT_EQ(run.first_error(), "") << run.text();
  const std::vector<NcMove> ours = counted(run.moves());
  for (size_t i = 0; i < std::min(ours.size(), theirs.size()); ++i) {
    expect_same(ours[i], theirs[i]);
    if (HasFatalFailure()) return;
  }
  EXPECT_EQ(ours.size(), theirs.size());
}

std::vector<std::string> programs() {
  const char* folder = std::getenv("SWARF_LINUXCNC_GOLDEN");
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(
           folder != nullptr ? folder : SWARF_SOURCE_DIR "/tests/golden/linuxcnc/programs")) {
    if (entry.path().extension() == ".ngc") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

INSTANTIATE_TEST_SUITE_P(Golden, LinuxCncAgreement, testing::ValuesIn(programs()),
                         [](const auto& one) { return std::filesystem::path(one.param).stem().string(); });

}  // namespace
}  // namespace swarf::program::linuxcnc_agreement_test
