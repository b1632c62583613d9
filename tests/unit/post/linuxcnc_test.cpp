// LinuxCNC's own interpreter reads what is written for LinuxCNC, where it is installed.
#include <cstdlib>

#include "unit/post/read_back.h"

namespace swarf::post::linuxcnc_test {
namespace {

/// The program rs274, or "".
std::string rs274() {
  const char* path = std::getenv("PATH");
  std::string folders = path == nullptr ? "" : path;
  for (size_t at = 0; at <= folders.size();) {
    const size_t end = std::min(folders.find(':', at), folders.size());
    const std::string file = folders.substr(at, end - at) + "/rs274";
    if (std::filesystem::exists(file)) return file;
    at = end + 1;
  }
  return "";
}

TEST(LinuxCnc, ReadsThreeAxes) {
  const std::string program = rs274();
  if (program.empty())
    GTEST_SKIP() << "no rs274 in PATH: LinuxCNC is not installed here (Debian: linuxcnc-uspace), its own "
                    "interpreter has not read what swarf post writes";
  PostOptions options;
  options.tools = {{1, "T1", 50.8}};  // as in tests/golden/linuxcnc/record.py
  const Posted run = run_post(
      "$$ SWARF CL DATA\nLOADTL/1\nSPINDL/RPM,3000,CLW\nFROM/0,0,120\nRAPID\nGOTO/10,-5,60\nFEDRAT/600,MMPM\n"
      "GOTO/10,-5,41.5\nGOTO/30.1234,-5,41.5\nCIRCLE/30.1234,5,41.5,0,0,-1,10\nGOTO/40.1234,5,41.5\n"
      "CYCLE/DRILL,DEPTH,5,CLEAR,2,MMPM,120\nGOTO/0,0,40\nGOTO/10,0,40\nCYCLE/OFF\nFINI\n",
      placed_machine("mill_3axis"), shipped_post("linuxcnc"), options);
  ASSERT_EQ(run.faults + reading_faults(run), "");
  const auto folder = test::scratch_folder() / "rs274";
  std::filesystem::create_directories(folder);
  // Where the machine stands G53 sends it is not known to rs274 alone: its positions count from G54.
  std::ofstream(folder / "part.ngc") << run.text;
  const std::string command = "python3 " + std::string(SWARF_SOURCE_DIR) +
                              "/tests/golden/linuxcnc/record.py " + program + " " + folder.string();
  ASSERT_EQ(std::system(command.c_str()), 0);
  std::ifstream moves(folder / "part.moves");
  std::vector<Vec3> theirs;
  char kind = 0;
  for (std::string line; std::getline(moves, line);) {
    Vec3 p;
    ASSERT_NE(line[0], 'E') << line;
    if (std::sscanf(line.c_str(), "%c %lf %lf %lf", &kind, &p.x(), &p.y(), &p.z()) == 4) theirs.push_back(p);
  }
  // Every CL position, as the gauge line above it, in its order.
  size_t at = 0;
  for (const program::Move& move : run.expected) {
    const Vec3 gauge = move.to.tip_W + Vec3(0, 0, 50.8);
    while (at < theirs.size() && (theirs[at] - gauge).norm() > 2e-4) ++at;
    ASSERT_LT(at, theirs.size()) << "line " << move.line << " is not reached";
  }
}

}  // namespace
}  // namespace swarf::post::linuxcnc_test
