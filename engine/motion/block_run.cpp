#include "motion/block_run.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/free_move.h"
#include "motion/jerk_profile.h"

namespace swarf::motion {
namespace {

using toolpath::BlockLaw;
using toolpath::BlockMove;

/// Chords that the tip's way under the joint law is summed from: within 1e-3 of the way for half a turn.
constexpr int kWayChords = 32;
/// Runs shorter than this go nowhere, mm.
constexpr double kLengthMin = 1e-9;

double way_of_tip(const BlockMotion& motion) {
  if (motion.block->law != BlockLaw::kJoint) return toolpath::tip_way(*motion.block);
  double way = 0.0;
  Vec3 before = motion.block->from.tip_W;
  for (int i = 1; i <= kWayChords; ++i) {
    const Vec3 tip = pose_at(motion, static_cast<double>(i) / kWayChords).tip_W;
    way += (tip - before).norm();
    before = tip;
  }
  return way;
}

/// Seconds that the slowest axis needs at its speed limit.
double axis_time(const BlockMotion& motion) {
  double time = 0.0;
  for (size_t i = 0; i < motion.machine->axes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    time =
        std::max(time, std::abs(motion.q_to[row] - motion.q_from[row]) / motion.machine->axes[i].speed_max);
  }
  return time;
}

double planned_length(const BlockMotion& motion, double way) {
  return std::max(way, motion.block->feed_mm_s * axis_time(motion));
}

BlockTick tick_at(const BlockMotion& motion, size_t element, double s, double feed_mm_s, SampleKind kind) {
  BlockTick tick;
  tick.sample.pose = pose_at(motion, s);
  tick.sample.contact_W = tick.sample.pose.tip_W;
  tick.sample.u = s;
  tick.sample.feed_mm_s = feed_mm_s;
  tick.sample.element = static_cast<int>(element);
  tick.sample.kind = kind;
  tick.q = motion.q_from + s * (motion.q_to - motion.q_from);
  return tick;
}

/// Places along [0, length] after each tick.
std::vector<double> places(const RestToRest& profile, double length, double period) {
  const auto ticks = static_cast<size_t>(std::max(1.0, std::ceil(profile.duration() / period)));
  std::vector<double> at(ticks);
  for (size_t k = 0; k + 1 < ticks; ++k)
    at[k] = std::clamp(profile.position(static_cast<double>(k + 1) * period), 0.0, length);
  at.back() = length;
  return at;
}

std::vector<BlockTick> sample_feed_run(std::span<const BlockMotion> motions, size_t first, size_t end,
                                       const MotionOptions& options) {
  std::vector<double> reach{0.0};  // mm from the run's start to the end of each block
  std::vector<double> share;       // of the tip's way in the planned length of each block
  for (size_t i = first; i < end; ++i) {
    const double way = way_of_tip(motions[i]);
    const double own = planned_length(motions[i], way);
    reach.push_back(reach.back() + own);
    share.push_back(own > 0.0 ? way / own : 0.0);
  }
  const double length = reach.back();
  if (length < kLengthMin) return {};
  const RestToRest profile(length, motions[first].block->feed_mm_s, options.path_acceleration_max,
                           options.path_jerk_max);
  std::vector<BlockTick> ticks;
  size_t block = 0;
  double before = 0.0;
  for (const double place : places(profile, length, options.period_s)) {
    while (block + 2 < reach.size() && place > reach[block + 1]) ++block;
    const double own = reach[block + 1] - reach[block];
    const double s = own > 0.0 ? std::min(1.0, (place - reach[block]) / own) : 1.0;
    const double feed = share[block] * (place - before) / options.period_s;
    ticks.push_back(tick_at(motions[first + block], first + block, s, feed, SampleKind::kCutting));
    before = place;
  }
  return ticks;
}

/// All axes linear, as fast as the slowest of them may.
std::vector<BlockTick> sample_joint_rapid(const BlockMotion& motion, size_t element,
                                          const MotionOptions& options) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  double speed = kNone, acceleration = kNone, jerk = kNone;
  for (size_t i = 0; i < motion.machine->axes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double way = std::abs(motion.q_to[row] - motion.q_from[row]);
    if (way == 0.0) continue;
    const kinematics::Axis& axis = motion.machine->axes[i];
    speed = std::min(speed, axis.speed_max / way);
    acceleration = std::min(acceleration, axis.acceleration_max / way);
    jerk = std::min(jerk, axis.jerk_max / way);
  }
  if (speed == kNone) return {};
  const RestToRest profile(1.0, speed, acceleration, jerk);
  std::vector<BlockTick> ticks;
  ToolPose before = motion.block->from;
  for (const double s : places(profile, 1.0, options.period_s)) {
    BlockTick tick = tick_at(motion, element, s, 0.0, SampleKind::kRapid);
    tick.sample.feed_mm_s = (tick.sample.pose.tip_W - before.tip_W).norm() / options.period_s;
    before = tick.sample.pose;
    ticks.push_back(tick);
  }
  return ticks;
}

std::vector<BlockTick> sample_straight_rapid(const BlockMotion& motion, size_t element,
                                             const kinematics::InverseKinematics& inverse,
                                             const MotionOptions& options) {
  const BlockMove& block = *motion.block;
  const toolpath::FreeMove move{toolpath::MoveKind::kRapid, block.from, block.to, 0.0};
  const double way = (block.to.tip_W - block.from.tip_W).norm();
  const double turn = (block.to.axis_W - block.from.axis_W).norm();
  std::vector<BlockTick> ticks;
  for (const ToolSample& sample : sample_free_move(move, *motion.machine, inverse, options, motion.q_from)) {
    BlockTick tick;
    tick.sample = sample;
    tick.sample.u = way > 0.0 ? (sample.pose.tip_W - block.from.tip_W).norm() / way
                              : (sample.pose.axis_W - block.from.axis_W).norm() / turn;
    tick.sample.u = std::min(1.0, tick.sample.u);
    tick.sample.element = static_cast<int>(element);
    ticks.push_back(tick);
  }
  return ticks;
}

}  // namespace

double run_length(std::span<const BlockMotion> motions, size_t first, size_t end) {
  double length = 0.0;
  for (size_t i = first; i < end; ++i) length += planned_length(motions[i], way_of_tip(motions[i]));
  return length;
}

size_t run_end(std::span<const BlockMotion> motions, size_t first) {
  const toolpath::BlockMove& block = *motions[first].block;
  const auto joins = [&](const toolpath::BlockMove& next) {
    return next.feed_mm_s == block.feed_mm_s && next.tool == block.tool;
  };
  size_t end = first + 1;
  while (block.feed_mm_s > 0.0 && end < motions.size() && joins(*motions[end].block)) ++end;
  return end;
}

std::vector<BlockTick> sample_run(std::span<const BlockMotion> motions, size_t first, size_t end,
                                  const kinematics::InverseKinematics& inverse,
                                  const MotionOptions& options) {
  const BlockMove& block = *motions[first].block;
  if (block.feed_mm_s > 0.0) return sample_feed_run(motions, first, end, options);
  if (block.law == BlockLaw::kJoint) return sample_joint_rapid(motions[first], first, options);
  return sample_straight_rapid(motions[first], first, inverse, options);
}

}  // namespace swarf::motion
