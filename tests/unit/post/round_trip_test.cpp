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

Posted posted(const std::string& cl, const std::string& machine, const std::string& name, bool tcp) {
  PostOptions options;
  const kinematics::MachineModel placed = placed_machine(machine);
  options.tcp = tcp;
  options.tools = {{1, "MILL10", 80.0}};
  return run_post(cl, placed, shipped_post(name), options);
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

}  // namespace
}  // namespace swarf::post::round_trip_test
