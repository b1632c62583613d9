// The control cycle must not allocate: every operator new of this executable is counted.
#include <gtest/gtest.h>

#include "support/counted_new.h"
#include "test_machines.h"

namespace swarf::kinematics {
namespace {

TEST(Allocation, SolvingAndForwardAllocateNothing) {
  const MachineModel machine = nutating_head();
  const long before_building = allocations;
  const InverseKinematics inverse(machine);
  EXPECT_GT(allocations, before_building);  // the counter counts
  Rng rng(1);
  AxisValues q = AxisValues::Zero();
  const long before = allocations;
  for (int i = 0; i < 1000; ++i) {
    const ToolPose pose{50.0 * rng.direction(), rng.direction()};
    q += inverse.solve(pose, q).branch[0].q + inverse.solve_nearest(pose, q).q;
    q += AxisValues::Constant(forward(machine, q).tip_W.x() * 1e-6);
    q = AxisValues::Zero();
  }
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace swarf::kinematics
