// Small programs written for every shipped machine in every shipped post, and read back.
#include "machine/shipped.h"
#include "unit/post/read_back.h"

namespace swarf::post::round_trip_test {
namespace {

const char* const kPosts[] = {"fanuc", "siemens", "heidenhain", "linuxcnc", "haas", "mazak"};
const char* const kMachines[] = {"mill_3axis", "fork_head",     "head_table_bc", "lin_koren_xyzab",
                                 "maho_600c",  "mikron_ucp710", "nutating_head", "spinner_u5_620"};

const char* const kThreeAxes =
    "$$ SWARF CL DATA\nPARTNO PLATE (A)\nLOADTL/1\nSPINDL/RPM,3000,CLW\nCOOLNT/ON\nFROM/0,0,120\nRAPID\n"
    "GOTO/10,-5,60\nFEDRAT/600,MMPM\nGOTO/10,-5,41.5\nGOTO/30.1234,-5,41.5\n"
    "CIRCLE/30.1234,5,41.5,0,0,-1,10\nGOTO/40.1234,5,41.5\nDELAY/0.5\nGOTO/40.1234,12,41.5\n"
    "CIRCLE/30.1234,12,41.5,0,0,1,10\nGOTO/40.1234,12,41.5\nRAPID\nGOTO/40.1234,12,90\nCOOLNT/OFF\nFINI\n";

Posted posted(const std::string& cl, const std::string& machine, const std::string& name, bool tcp,
              bool inches = false) {
  PostOptions options;
  const kinematics::MachineModel placed = placed_machine(machine);
  options.tcp = tcp;
  options.tools = {{1, "MILL10", 80.0}};
  return run_post(cl, placed, in_unit(shipped_post(name), inches), options);
}

TEST(RoundTrip, ThreeAxesOnEveryMachineInEveryPost) {
  for (const char* machine : kMachines) {
    for (const char* name : kPosts) {
      SCOPED_TRACE(fmt::format("{} {}", machine, name));
      const Posted run = posted(kThreeAxes, machine, name, false);
      ASSERT_EQ(run.faults, "");
      ASSERT_EQ(reading_faults(run), "") << run.text;
      EXPECT_EQ(compare(run), "") << run.text;
    }
  }
}

/// The same in inches, a digit more of them: lengths and feeds; the words that name the unit are the post's.
TEST(RoundTrip, InchesInEveryPost) {
  for (const char* machine : {"mill_3axis", "maho_600c"}) {
    for (const char* name : kPosts) {
      SCOPED_TRACE(fmt::format("{} {}", machine, name));
      const Posted run = posted(kThreeAxes, machine, name, false, true);
      ASSERT_EQ(run.faults, "");
      ASSERT_EQ(reading_faults(run), "") << run.text;
      EXPECT_EQ(compare(run), "") << run.text;
      const PostFormat mm = shipped_post(name);
      EXPECT_NEAR(run.result.rules.linear_half, 2.54 * half_digit(mm.numbers.linear), 1e-12);
      const std::string unit = std::string(name) == "heidenhain" ? " INCH"
                               : std::string(name) == "siemens"  ? "G700 "
                                                                 : "G20 ";
      EXPECT_NE(run.text.find(unit), std::string::npos) << run.text;
      EXPECT_EQ(run.text.find("G21"), std::string::npos) << run.text;
      double seconds = 0.0;
      for (const program::NcMove& move : run.moves) seconds += move.rapid ? 0.0 : move.duration_s;
      EXPECT_NEAR(seconds, run.result.plan.feed_s, 5e-3 * seconds + 0.02) << run.text;
    }
  }
}

/// A post that names its unit itself is in that unit, and no other can be had of it.
TEST(RoundTrip, AUnitThatThePostDoesNotNameIsRefused) {
  PostFormat own = shipped_post("fanuc");
  own.unit = {};
  EXPECT_EQ(in_unit(own, false).numbers.linear.decimals, own.numbers.linear.decimals);
  EXPECT_THROW(in_unit(own, true), InputError);
}

}  // namespace
}  // namespace swarf::post::round_trip_test
