// Tilted working planes: cycles, lines and arcs in them are read back to the CL data, and the tip only pays
// for the digits of X Y Z.
#include "unit/post/read_back.h"

namespace swarf::post::tilted_plane_test {
namespace {

const char* const kPosts[] = {"fanuc", "siemens", "heidenhain", "haas", "mazak"};
const char* const kMachines[] = {"fork_head",     "head_table_bc", "lin_koren_xyzab", "maho_600c",
                                 "mikron_ucp710", "nutating_head", "spinner_u5_620"};

/// Holes, a pocket's line and arcs, all with the tool along `axis`; `frame`: its plane.
std::string tilted_work(const Mat3& frame) {
  const Vec3 a = frame.col(2);
  const auto at = [&](double x, double y, double z) {
    const Vec3 p = frame * Vec3(x, y, z);
    return fmt::format("GOTO/{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f}\n", p.x(), p.y(), p.z(), a.x(), a.y(),
                       a.z());
  };
  const auto circle = [&](double x, double y, double z, double radius) {
    const Vec3 c = frame * Vec3(x, y, z);
    return fmt::format("CIRCLE/{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.6f}\n", c.x(), c.y(), c.z(),
                       a.x(), a.y(), a.z(), radius);
  };
  return "$$ SWARF CL DATA\nPARTNO TILTED\nLOADTL/1\nSPINDL/RPM,3000,CLW\nMULTAX/ON\nFROM/" +
         at(0, 0, 60).substr(5) + "RAPID\n" + at(5, 5, 30) + "CYCLE/DRILL,DEPTH,6,CLEAR,2,MMPM,120\n" +
         at(10, 0, 20) + at(-7.5, 3, 20) + at(4, 11, 20) + "CYCLE/OFF\nRAPID\n" + at(12, 5, 30) +
         "FEDRAT/600,MMPM\n" + at(12, 5, 18) + circle(0, 5, 18, 12) + at(0, 17, 18) + at(-9, 17, 18) +
         "RAPID\n" + at(-9, 17, 50) + "FINI\n";
}

Mat3 frame_along(const Vec3& axis) {
  return Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), axis).toRotationMatrix();
}

/// Every CL position is found by a move whose tip is within half a digit of each of X Y Z.
std::string farthest(const Posted& run) {
  const double allowed = std::sqrt(3.0) * run.result.rules.linear_half + 1e-7;
  for (const program::Move& one : run.expected) {
    double least = 1e9;
    for (const program::NcMove& move : run.moves)
      least = std::min(least, (move.to.tip_W - one.to.tip_W).norm());
    if (least > allowed) return fmt::format("CL line {}: {:.4f} um off", one.line, um_from_mm(least));
  }
  return "";
}

const std::vector<Vec3> kDirections{Vec3(0.3, 0, 0.95).normalized(), Vec3(0.05, -0.4, 0.9).normalized(),
                                    Vec3(std::sin(kPi / 6), 0, std::cos(kPi / 6)),
                                    Vec3(1e-3, 2e-3, 1).normalized()};

TEST(TiltedPlane, IsReadBackWithinHalfADigitOfXYZ) {
  long planes = 0, kept = 0;
  for (const char* machine : kMachines) {
    const kinematics::MachineModel placed = placed_machine(machine);
    for (const char* post : kPosts) {
      for (const Vec3& direction : kDirections) {
        for (const PlaneUse use : {PlaneUse::kCycles, PlaneUse::kConstant}) {
          SCOPED_TRACE(fmt::format("{} {} ({:.3f}, {:.3f}, {:.3f}) {}", machine, post, direction.x(),
                                   direction.y(), direction.z(),
                                   use == PlaneUse::kCycles ? "cycles" : "constant"));
          PostOptions options;
          options.planes = use;
          const Posted run =
              run_post(tilted_work(frame_along(direction)), placed, shipped_post(post), options);
          if (run.faults.find("travel") != std::string::npos) continue;
          ASSERT_EQ(run.faults, "");
          ASSERT_EQ(reading_faults(run) + compare(run), "") << run.text;
          planes += run.result.plan.tilts;
          kept += run.result.plan.holes;
          if (use == PlaneUse::kConstant && run.result.plan.tilts > 0) {
            ASSERT_EQ(farthest(run), "") << run.text;
          }
          EXPECT_EQ(run.result.plan.holes, 3) << run.text;
        }
      }
    }
  }
  EXPECT_GT(planes, 120);
  EXPECT_GT(kept, 500);
}

}  // namespace
}  // namespace swarf::post::tilted_plane_test
