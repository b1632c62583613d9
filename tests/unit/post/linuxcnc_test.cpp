// LinuxCNC's own interpreter reads what is written for LinuxCNC, where it is installed.
#include <array>
#include <cstdlib>
#include <sstream>

#include "program/control/work_space.h"
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

constexpr const char* kNoInterpreter =
    "no rs274 in PATH: LinuxCNC is not installed here (Debian: linuxcnc-uspace), its own interpreter has not "
    "read what swarf post writes";

/// The lines that record.py makes of the program.
std::vector<std::string> recorded(const std::string& rs274, const std::string& text,
                                  const std::string& more) {
  const auto folder = test::scratch_folder() / "rs274";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "part.ngc") << text;
  const std::string command = "python3 " + std::string(SWARF_SOURCE_DIR) +
                              "/tests/golden/linuxcnc/record.py " + rs274 + " " + folder.string() + more;
  if (std::system(command.c_str()) != 0) return {"E record.py fails"};
  std::ifstream moves(folder / "part.moves");
  std::vector<std::string> lines;
  for (std::string line; std::getline(moves, line);) lines.push_back(line);
  return lines;
}

TEST(LinuxCnc, ReadsThreeAxes) {
  const std::string program = rs274();
  if (program.empty()) GTEST_SKIP() << kNoInterpreter;
  PostOptions options;
  options.tools = {{1, "T1", 50.8}};  // as in tests/golden/linuxcnc/record.py
  const Posted run = run_post(
      "$$ SWARF CL DATA\nLOADTL/1\nSPINDL/RPM,3000,CLW\nFROM/0,0,120\nRAPID\nGOTO/10,-5,60\nFEDRAT/600,MMPM\n"
      "GOTO/10,-5,41.5\nGOTO/30.1234,-5,41.5\nCIRCLE/30.1234,5,41.5,0,0,-1,10\nGOTO/40.1234,5,41.5\n"
      "CYCLE/DRILL,DEPTH,5,CLEAR,2,MMPM,120\nGOTO/0,0,40\nGOTO/10,0,40\nCYCLE/OFF\nFINI\n",
      placed_machine("mill_3axis"), shipped_post("linuxcnc"), options);
  ASSERT_EQ(run.faults + reading_faults(run), "");
  // Where the machine stands G53 sends it is not known to rs274 alone: its positions count from G54.
  std::vector<Vec3> theirs;
  char kind = 0;
  for (const std::string& line : recorded(program, run.text, "")) {
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

/// One of LinuxCNC's own moves.
struct AxisMove {
  bool feed = false;
  Vec3 p, turn_deg;
  double seconds = 0.0;
};

/// Feeds that turn both rotary axes, through the pole too, a rapid: axis values and times of
/// every block are those that our own interpreter reads, which reads the CL data's positions (compare()).
TEST(LinuxCnc, ReadsFiveAxes) {
  const std::string program = rs274();
  if (program.empty()) GTEST_SKIP() << kNoInterpreter;
  PostOptions options;
  options.tools = {{1, "T1", 50.8}};
  options.tcp = false;
  for (const std::string name : {"maho_600c", "mikron_ucp710", "spinner_u5_620"}) {
    SCOPED_TRACE(name);
    const kinematics::MachineModel machine = placed_machine(name);
    const Posted run = run_post(
        "$$ SWARF CL DATA\nMULTAX/ON\nLOADTL/1\nSPINDL/RPM,3000,CLW\nFROM/0,0,120,0,0,1\nRAPID\n"
        "GOTO/10,-5,60,0.28,0,0.96\nFEDRAT/600,MMPM\nGOTO/10,-5,41.5,0.28,0,0.96\n"
        "GOTO/20.1234,3,41,0.28,0.096,0.955210\nGOTO/30,5,41.5,0,0.28,0.96\nGOTO/30,5,41.5,0,0,1\n"
        "GOTO/32,9,40,-0.28,0,0.96\nRAPID\nGOTO/18.8,9,85.1,-0.28,0,0.96\nFINI\n",
        machine, shipped_post("linuxcnc"), options);
    ASSERT_EQ(run.faults + reading_faults(run) + compare(run), "");
    std::vector<AxisMove> theirs;
    for (const std::string& line : recorded(program, run.text, " axes")) {
      ASSERT_NE(line[0], 'E') << line << "\n" << run.text;
      AxisMove one;
      one.feed = line[0] == 'L';
      std::istringstream numbers(line.substr(1));
      for (Vec3* part : {&one.p, &one.turn_deg})
        for (int k = 0; k < 3; ++k) numbers >> (*part)[k];
      numbers >> one.seconds;
      theirs.push_back(one);
    }
    program::nc::WorkSpace words(machine);
    words.set_length(50.8);
    size_t at = 0, feeds = 0;
    for (const program::NcMove& move : run.moves) {
      if (move.rapid) continue;
      ++feeds;
      const std::array<double, 3> rotary = words.rotary_of(move.q_to);
      const Vec3 gauge = words.program_from_linear(words.linear_of(move.q_to), rotary) + Vec3(0, 0, 50.8);
      const Vec3 turn(deg_from_rad(rotary[0]), deg_from_rad(rotary[1]), deg_from_rad(rotary[2]));
      while (at < theirs.size() && (!theirs[at].feed || (theirs[at].p - gauge).norm() > 2e-4 ||
                                    (theirs[at].turn_deg - turn).norm() > 2e-4))
        ++at;
      ASSERT_LT(at, theirs.size()) << "line " << move.line << " is not reached\n" << run.text;
      EXPECT_NEAR(theirs[at].seconds, move.duration_s, 1e-3 * move.duration_s + 2e-4) << "line " << move.line;
      ++at;
    }
    EXPECT_GE(feeds, 5U);
  }
}

}  // namespace
}  // namespace swarf::post::linuxcnc_test
