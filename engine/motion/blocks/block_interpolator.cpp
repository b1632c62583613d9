#include "motion/blocks/block_interpolator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/tool_axis.h"
#include "motion/passes/pass_geometry.h"
#include "motion/speed/free_move.h"
#include "motion/speed/jerk_profile.h"

namespace swarf::motion {
namespace {

using kinematics::AxisValues;
using kinematics::InverseKinematics;
using kinematics::MachineModel;
using toolpath::SurfacePass;

/// A block is planned in at least so many cells.
constexpr double kCellsPerBlock = 4.0;

/// One straight block from a to b, or a turn at rest.
struct Block {
  double ta = 0.0, tb = 0.0;  ///< curve parameters of its ends
  Vec3 contact_a, contact_b;
  ToolPose a, b;
  bool turn = false;
  double length = 0.0;  ///< mm, of the contact chord; of a turn: move_length()
};

/// Greatest distance of the curve from the chord between two parameters, mm: the best of evenly spread
/// samples, corrected by the parabola through its neighbours.
double chord_error(const SurfacePass& pass, double ta, double tb) {
  constexpr int kSamples = 8;
  const Vec3 a = curve_point(*pass.surface, pass.curve, ta);
  const Vec3 direction = (curve_point(*pass.surface, pass.curve, tb) - a).normalized();
  double error[kSamples + 1] = {};
  int best = 1;
  for (int i = 1; i < kSamples; ++i) {
    const Vec3 gap = curve_point(*pass.surface, pass.curve, ta + (tb - ta) * i / kSamples) - a;
    error[i] = (gap - gap.dot(direction) * direction).norm();
    if (error[i] > error[best]) best = i;
  }
  const double slope = 0.5 * (error[best + 1] - error[best - 1]);
  const double bend = error[best + 1] - 2.0 * error[best] + error[best - 1];
  return bend < 0.0 ? error[best] - 0.5 * slope * slope / bend : error[best];
}

/// End of the longest segment from ta within the tolerance.
double segment_end(const SurfacePass& pass, double ta) {
  constexpr int kHalvings = 24;  // 1e-7 of the segment
  const double tolerance = pass.chord_tolerance_mm;
  const toolpath::CurvePoint at = curve_at(*pass.surface, pass.curve, ta);
  const double rest = pass.t_end - ta;
  double step = std::sqrt(8.0 * tolerance / path_curvature(pass, ta)) / at.dC.norm();
  if (!(step < std::abs(rest))) step = std::abs(rest);
  double good = ta;
  double bad = ta + std::copysign(step, rest);
  while (chord_error(pass, ta, bad) <= tolerance) {
    if (bad == pass.t_end) return bad;
    good = bad;
    step *= 2.0;
    bad = step < std::abs(rest) ? ta + std::copysign(step, rest) : pass.t_end;
  }
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (good + bad);
    (chord_error(pass, ta, middle) <= tolerance ? good : bad) = middle;
  }
  return good;
}

std::vector<Block> blocks_of(const SurfacePass& pass, const toolpath::ContactEnd& end,
                             OfflineOrientation orientation) {
  const std::vector<double> ends = segment_pass(pass);
  std::vector<Block> blocks;
  for (size_t i = 0; i + 1 < ends.size(); ++i) {
    Block block;
    block.ta = ends[i];
    block.tb = ends[i + 1];
    block.contact_a = curve_point(*pass.surface, pass.curve, block.ta);
    block.contact_b = curve_point(*pass.surface, pass.curve, block.tb);
    block.a = contact_pose(pass, block.ta, end);
    const ToolPose exact = contact_pose(pass, block.tb, end);
    block.b = exact;
    block.length = (block.contact_b - block.contact_a).norm();
    if (orientation == OfflineOrientation::kConstant)
      block.b = {block.a.tip_W + block.contact_b - block.contact_a, block.a.axis_W};
    blocks.push_back(block);
    if (orientation == OfflineOrientation::kConstant)
      blocks.push_back({block.tb, block.tb, block.contact_b, block.contact_b, block.b, exact, true,
                        move_length(block.b, exact)});
  }
  return blocks;
}

/// Curve parameter whose point projects onto the chord at fraction x: Newton, from the linear guess.
double foot_parameter(const SurfacePass& pass, const Block& block, double x) {
  constexpr int kSteps = 3;
  double t = block.ta + x * (block.tb - block.ta);
  if (block.turn) return t;
  const Vec3 chord = block.contact_b - block.contact_a;
  const double target = x * chord.squaredNorm();
  for (int i = 0; i < kSteps; ++i) {
    const toolpath::CurvePoint at = curve_at(*pass.surface, pass.curve, t);
    t -= ((at.C - block.contact_a).dot(chord) - target) / at.dC.dot(chord);
  }
  return t;
}

ToolPose block_pose(const SurfacePass& pass, const Block& block, double x, OfflineOrientation orientation) {
  if (block.turn) return pose_between(block.a, block.b, x);
  double share = x;
  if (orientation == OfflineOrientation::kLinearInU && x > 0.0 && x < 1.0)
    share = (foot_parameter(pass, block, x) - block.ta) / (block.tb - block.ta);
  return {block.a.tip_W + x * (block.b.tip_W - block.a.tip_W),
          (block.a.axis_W + share * (block.b.axis_W - block.a.axis_W)).normalized()};
}

/// Appends a block's nodes and marks its end as a corner.
void append_block_nodes(const SurfacePass& pass, const Block& block, const MachineModel& machine,
                        const InverseKinematics& inverse, OfflineOrientation orientation,
                        std::vector<PathNode>& nodes) {
  const PathShape shape{[&](double x) { return block_pose(pass, block, x, orientation); },
                        [&](double from, double to) { return block.length * (to - from); }};
  nodes.back().x = 0.0;
  append_nodes(shape, inverse, machine, 1.0, block.length / kCellsPerBlock * (1.0 + 1e-9), nodes);
  nodes.back().corner = true;
}

/// Speed at which the corner between two blocks may be passed.
double corner_speed(const Block& before, const Block& after, double acceleration, double tolerance) {
  const Vec3 in = (before.contact_b - before.contact_a) / before.length;
  const Vec3 out = (after.contact_b - after.contact_a) / after.length;
  const double quarter = 0.25 * angle_between(in, out);
  const double sagitta = 2.0 * std::sin(quarter) * std::sin(quarter);  // 1 - cos(theta/2)
  return std::sqrt(acceleration * tolerance * std::max(0.0, 1.0 - sagitta) / sagitta);
}

/// Where the tool stands after each tick: block and fraction.
struct Place {
  size_t block = 0;
  double x = 0.0;
  double step_mm = 0.0;
};

struct Context {
  const SurfacePass& pass;
  const std::vector<Block>& blocks;
  const MachineModel& machine;
  const InverseKinematics& inverse;
  const MotionOptions& options;
};

std::vector<Place> stop_at_each_block(const Context& with, PathNode start) {
  std::vector<Place> places;
  double before = 0.0, total_before = 0.0, last = 0.0;  // s, mm, mm
  const double period = with.options.period_s;
  for (size_t i = 0; i < with.blocks.size(); ++i) {
    const Block& block = with.blocks[i];
    if (block.length == 0.0) continue;
    std::vector<PathNode> nodes{start};
    append_block_nodes(with.pass, block, with.machine, with.inverse, with.options.orientation, nodes);
    start = nodes.back();
    SpeedLimits limits = uniform_limits(nodes, with.pass.feed_mm_s, with.options.path_acceleration_max);
    clamp_by_axes(nodes, with.machine, limits);
    const RestToRest profile(block.length, *std::min_element(limits.speed.begin(), limits.speed.end()),
                             *std::min_element(limits.acceleration.begin(), limits.acceleration.end()),
                             with.options.path_jerk_max);
    for (;;) {
      const double t = static_cast<double>(places.size() + 1) * period - before;
      if (t >= profile.duration()) break;
      const double position = profile.position(t);
      places.push_back({i, position / block.length, total_before + position - last});
      last = total_before + position;
    }
    before += profile.duration();
    total_before += block.length;
  }
  places.push_back({with.blocks.size() - 1, 1.0, total_before - last});
  return places;
}

SpeedLimits look_ahead_limits(const Context& with, const PathNode& start) {
  std::vector<PathNode> nodes{start};
  std::vector<size_t> corners;
  for (const Block& block : with.blocks) {
    append_block_nodes(with.pass, block, with.machine, with.inverse, with.options.orientation, nodes);
    corners.push_back(nodes.size() - 1);
  }
  const double acceleration = with.options.path_acceleration_max;
  SpeedLimits limits = uniform_limits(nodes, with.pass.feed_mm_s, acceleration);
  for (size_t i = 0; i + 1 < with.blocks.size(); ++i) {
    const double speed =
        corner_speed(with.blocks[i], with.blocks[i + 1], acceleration, with.pass.chord_tolerance_mm);
    for (const size_t cell : {corners[i] - 1, corners[i]})
      limits.speed[cell] = std::min(limits.speed[cell], speed);
  }
  clamp_by_axes(nodes, with.machine, limits);
  return limits;
}

std::vector<Place> through_corners(const Context& with, const PathNode& start) {
  const SpeedLimits limits = look_ahead_limits(with, start);
  const Profile profile = sample_plan(plan_speed(limits, with.options.path_jerk_max, with.options.period_s),
                                      limits.length(), with.options.period_s);
  std::vector<Place> places;
  size_t block = 0;
  double before = 0.0;
  for (size_t k = 0; k < profile.step_mm.size(); ++k) {
    const double position = profile.position_mm[k];
    while (block + 1 < with.blocks.size() && position > before + with.blocks[block].length)
      before += with.blocks[block++].length;
    places.push_back(
        {block, std::min(1.0, (position - before) / with.blocks[block].length), profile.step_mm[k]});
  }
  places.back() = {with.blocks.size() - 1, 1.0, profile.step_mm.back()};
  return places;
}

ToolSample sample_at(const Context& with, const Place& place) {
  const Block& block = with.blocks[place.block];
  ToolSample sample;
  sample.kind = SampleKind::kCutting;
  sample.pose = block_pose(with.pass, block, place.x, with.options.orientation);
  sample.contact_W = block.contact_a + place.x * (block.contact_b - block.contact_a);
  const double t = foot_parameter(with.pass, block, place.x);
  const double w = with.pass.curve.w.at(t).w;
  sample.u = with.pass.curve.along_u ? t : w;
  sample.v = with.pass.curve.along_u ? w : t;
  sample.feed_mm_s = block.turn ? 0.0 : place.step_mm / with.options.period_s;
  return sample;
}

}  // namespace

std::vector<double> segment_pass(const SurfacePass& pass) {
  std::vector<double> ends{pass.t_start};
  while (ends.back() != pass.t_end) ends.push_back(segment_end(pass, ends.back()));
  return ends;
}

std::vector<ToolSample> sample_offline_pass(const SurfacePass& pass, const cutter::Cutter& cutter,
                                            const MachineModel& machine, const InverseKinematics& inverse,
                                            const MotionOptions& options, const AxisValues& hint) {
  const std::vector<Block> blocks = blocks_of(pass, toolpath::contact_end(cutter), options.orientation);
  const kinematics::Branch branch = inverse.solve_nearest(blocks.front().a, hint);
  const bool reached = branch.outcome != kinematics::InverseOutcome::kUnreachable;
  const PathNode start{0.0, 0.0, reached ? branch.q : hint, false, reached};
  const Context with{pass, blocks, machine, inverse, options};
  const bool stops = !options.look_ahead || options.orientation == OfflineOrientation::kConstant;
  const std::vector<Place> places = stops ? stop_at_each_block(with, start) : through_corners(with, start);
  std::vector<ToolSample> samples;
  samples.reserve(places.size());
  for (const Place& place : places) samples.push_back(sample_at(with, place));
  return samples;
}

}  // namespace swarf::motion
