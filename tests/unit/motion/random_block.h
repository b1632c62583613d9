// Random machines and blocks for the tests of block motions.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "base/rng.h"
#include "motion/blocks/block_motion.h"
#include "unit/motion/dome.h"

namespace swarf::motion {

inline Vec3 random_point(Rng& rng, double reach) {
  return {rng.uniform(-reach, reach), rng.uniform(-reach, reach), rng.uniform(-reach, reach)};
}

/// Three linear axes and two rotary ones in random directions, on random sides.
inline kinematics::MachineModel random_machine(Rng& rng) {
  kinematics::MachineModel machine = paper_machine();
  for (size_t i = 3; i < 5; ++i) {
    machine.axes[i].direction_M = rng.direction();
    machine.axes[i].origin_M = random_point(rng, 100);
  }
  if (rng.uniform() < 0.5) {
    machine.head_chain.push_back(machine.table_chain.back());
    machine.axes[static_cast<size_t>(machine.table_chain.back())].side = kinematics::Side::kHead;
    machine.table_chain.pop_back();
  }
  return machine;
}

/// A block with its motion; the machine stands beside it.
struct RandomBlock {
  kinematics::MachineModel machine;
  toolpath::BlockMove block;
  kinematics::AxisValues q_from = kinematics::AxisValues::Zero(), q_to = kinematics::AxisValues::Zero();
  BlockMotion motion() const { return {block, &machine, q_from, q_to}; }
  std::string text() const {
    const auto pose = [](const ToolPose& p) {
      return fmt::format("{{{{{}, {}, {}}}, {{{}, {}, {}}}}}", p.tip_W.x(), p.tip_W.y(), p.tip_W.z(),
                         p.axis_W.x(), p.axis_W.y(), p.axis_W.z());
    };
    std::string q;
    for (int i = 0; i < 5; ++i) q += fmt::format(" q{} = {} -> {}", i, q_from[i], q_to[i]);
    return fmt::format("{}: from {} to {}{}{}", law_name(block.law), pose(block.from), pose(block.to),
                       block.arc ? " arc" : "", block.law == toolpath::BlockLaw::kJoint ? q : "");
  }
};

inline RandomBlock random_block(Rng& rng, toolpath::BlockLaw law) {
  RandomBlock c;
  c.machine = random_machine(rng);
  c.block.law = law;
  c.block.feed_mm_s = 10.0;
  if (law == toolpath::BlockLaw::kJoint) {
    for (int i = 0; i < 5; ++i) {
      c.q_from[i] = i < 3 ? rng.uniform(-50, 50) : rng.uniform(-2, 2);
      c.q_to[i] = c.q_from[i] + (i < 3 ? rng.uniform(-20, 20) : rng.uniform(-0.6, 0.6));
    }
    c.block.from = kinematics::forward(c.machine, c.q_from);
    c.block.to = kinematics::forward(c.machine, c.q_to);
    return c;
  }
  c.block.from = {random_point(rng, 50), rng.direction()};
  const double turn = rng.uniform(0.0, 1.0);
  const Vec3 across = c.block.from.axis_W.cross(rng.direction()).normalized();
  c.block.to.axis_W = std::cos(turn) * c.block.from.axis_W + std::sin(turn) * across;
  c.block.to.tip_W = c.block.from.tip_W + random_point(rng, 20);
  if (law == toolpath::BlockLaw::kTcp && rng.uniform() < 0.5) {
    const double angle = rng.uniform(0.1, 6.0), radius = rng.uniform(2, 30);
    const Vec3 normal = rng.direction(), arm = radius * normal.unitOrthogonal();
    c.block.arc = program::Arc{c.block.from.tip_W - arm, normal};
    c.block.to.tip_W = c.block.arc->centre_W + std::cos(angle) * arm + std::sin(angle) * normal.cross(arm);
  }
  return c;
}

}  // namespace swarf::motion
