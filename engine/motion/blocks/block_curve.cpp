#include "motion/blocks/block_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "base/units.h"
#include "kinematics/forward_chain.h"

namespace swarf::motion {
namespace {

using kinematics::AxisKind;
using kinematics::AxisValues;
using kinematics::Branch;
using kinematics::InverseOutcome;
using kinematics::MachineModel;
using toolpath::BlockLaw;
using toolpath::BlockMove;

/// Rotary values that differ by less do not turn, rad.
constexpr double kTurnMin = 1e-13;
/// Blocks that turn are stretched where the axes' way per share is this much greater than elsewhere.
constexpr double kUneven = 1.05;
/// Nodes of a curved block: at least, per radian that its axes and its arc turn, at most.
constexpr double kNodesMin = 12.0, kNodesPerRadian = 120.0, kNodesMax = 4096.0;
constexpr size_t kCellsMax = 96;
/// Nodes per step of the closest that follow() needs: beside a pole a step is a fiftieth of the distance to
/// it.
constexpr double kNodesPerStep = 0.16;
/// Differences at the nodes miss what lies between them by less than this share.
constexpr double kBetweenNodes = 1.1;
/// The same on a splined curve, whose third derivatives jump at its knots; and the share that its slopes may
/// be missed by.
constexpr double kBetweenKnots = 1.5, kSlopeOfCurve = 1.0 + 1e-4;
/// A rotary that turns by more than this from node to node jumps, rad.
constexpr double kJump = 0.5;
/// The end of a block must meet its given axis values, mm.
constexpr double kJoin = 1e-6;
/// Share of the step between two nodes over which the slope there is found by differences.
constexpr double kReach = 0.02;
/// Nodes whose inverse is solved at once.
constexpr size_t kSolvedAtOnce = 32;
/// A pole whose distance is this share of what the axis goes in the block is narrow: even steps would miss
/// it.
constexpr double kNarrowPole = 5e-3;
/// Share of the way that the approach to a narrow pole gets for itself, so that each of its scales is met.
constexpr double kSpread = 0.2;
/// Chords that the tip's way under the joint law is summed from: within 1e-3 of the way for half a turn.
constexpr size_t kWayChords = 32;

bool turns(const BlockMotion& motion) {
  for (size_t i = 0; i < motion.machine->axes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (motion.machine->axes[i].kind == AxisKind::kRotary &&
        std::abs(motion.q_to[row] - motion.q_from[row]) > kTurnMin)
      return true;
  }
  return false;
}

/// Sum of the turns of the rotary axes between two sets of values, rad.
double turn_between(const MachineModel& machine, const AxisValues& a, const AxisValues& b) {
  double turn = 0.0;
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (machine.axes[i].kind == AxisKind::kRotary) turn += std::abs(b[row] - a[row]);
  }
  return turn;
}

}  // namespace

double axis_way(const MachineModel& machine, const AxisValues& from, const AxisValues& to) {
  double square = 0.0;
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double arm = machine.axes[i].kind == AxisKind::kRotary ? kTurnArm : 1.0;
    square += std::pow(arm * (to[row] - from[row]), 2);
  }
  return std::sqrt(square);
}

double way_of_tip(const BlockMotion& motion) {
  if (motion.block.law != BlockLaw::kJoint || !turns(motion)) {
    if (motion.block.law != BlockLaw::kJoint) return toolpath::tip_way(motion.block);
    return (motion.block.to.tip_W - motion.block.from.tip_W).norm();
  }
  const AxisValues change = motion.q_to - motion.q_from;
  std::array<AxisValues, kWayChords - 1> q;
  std::array<ToolPose, kWayChords> pose;
  for (size_t i = 1; i < kWayChords; ++i)
    q[i - 1] = motion.q_from + static_cast<double>(i) / kWayChords * change;
  kinematics::ForwardChain(*motion.machine).at(q, pose);
  pose.back() = motion.block.to;
  double way = 0.0;
  Vec3 before = motion.block.from.tip_W;
  for (size_t i = 0; i < kWayChords; i += 2) {
    way += (pose[i].tip_W - before).norm() + (pose[i + 1].tip_W - pose[i].tip_W).norm();
    before = pose[i + 1].tip_W;
  }
  return way;
}

BlockCurve::BlockCurve(const BlockMotion& motion, const kinematics::InverseKinematics& inverse,
                       double speed_mm_s)
    : q_from_(motion.q_from),
      q_to_(motion.q_to),
      machine_(motion.machine),
      inverse_(&inverse),
      speed_(speed_mm_s) {
  const BlockMove& block = motion.block;
  tip_way_ = way_of_tip(motion);
  even_ = block.law == BlockLaw::kJoint ||
          (!block.arc && !block.curve && block.from.axis_W == block.to.axis_W && !turns(motion));
  if (even_) {
    length_ = limited_way(motion.q_to - motion.q_from, 1.0);
    return;
  }
  law_ = std::make_shared<const Law>(motion);
  follow();
}

/// The values that those at share x follow by continuity: under axes of their own these, else the hint.
AxisValues BlockCurve::before(double x, const AxisValues& hint) const {
  return block().law == BlockLaw::kTcpAxes ? AxisValues(q_from_ + x * (q_to_ - q_from_)) : hint;
}

AxisValues BlockCurve::solve(double x, const AxisValues& hint) const {
  const Branch branch = inverse_->continued(law_->at(x), before(x, hint));
  return branch.outcome == InverseOutcome::kUnreachable ? hint : branch.q;
}

double BlockCurve::limited_way(const AxisValues& change, double share) const {
  const MachineModel& machine = *machine_;
  double ways[kinematics::kMaxAxes + 1] = {share * tip_way_};
  double most = ways[0];
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    ways[i + 1] = std::abs(change[static_cast<Eigen::Index>(i)]) * speed_ / machine.axes[i].speed_max;
    most = std::max(most, ways[i + 1]);
  }
  if (most == 0.0) return 0.0;
  double sum = 0.0;
  for (const double way : ways) {
    const double square = way / most * (way / most);
    sum += square * square * square;
  }
  return most * std::cbrt(std::sqrt(sum));
}

namespace {

/// Nodes of a block with axes of its own, as far apart as they turn evenly.
void append_own_nodes(const BlockCurve::Law& law, const kinematics::InverseKinematics& inverse, double way,
                      std::vector<PathNode>& nodes) {
  constexpr size_t kNodes = 16;
  std::array<ToolPose, kNodes> poses;
  std::array<AxisValues, kNodes> own;
  std::array<Branch, kNodes> found;
  const auto share = [&](size_t i) { return static_cast<double>(i + 1) / kNodes; };
  for (size_t i = 0; i < kNodes; ++i) {
    law.set(share(i), poses[i]);
    own[i] = law.motion.q_from + share(i) * (law.motion.q_to - law.motion.q_from);
  }
  inverse.continued(poses, own, found);
  for (size_t i = 0; i < kNodes; ++i) {
    const bool reached = found[i].outcome != InverseOutcome::kUnreachable;
    nodes.push_back({share(i), way * share(i), reached ? found[i].q : nodes.back().q, false, true});
  }
}

/// Nodes so close that no turn beside a pole is missed.
void append_close_nodes(const BlockCurve::Law& law, const kinematics::InverseKinematics& inverse, double way,
                        std::vector<PathNode>& nodes) {
  constexpr size_t kSteps = 8;
  const MachineModel& machine = *law.motion.machine;
  std::array<ToolPose, kSteps + 1> poses;
  for (size_t i = 0; i <= kSteps; ++i) law.set(static_cast<double>(i) / kSteps, poses[i]);
  if (append_even_nodes(poses, inverse, machine, way / kSteps, nodes)) return;
  const PathShape shape{
      [&](double x) { return law.at(x); }, [&](double from, double to) { return way * (to - from); },
      [&](const ToolPose& pose, const AxisValues& last) { return inverse.continued(pose, last); }};
  append_nodes(shape, inverse, machine, 1.0, way / kSteps * (1.0 + 1e-9), nodes);
}

}  // namespace

void BlockCurve::follow() {
  const double way = std::max(toolpath::tip_way(block()), 1.0);
  std::vector<PathNode> nodes{{0.0, 0.0, q_from_, false, true}};
  if (block().law == BlockLaw::kTcpAxes) {
    append_own_nodes(*law_, *inverse_, way, nodes);
  } else {
    append_close_nodes(*law_, *inverse_, way, nodes);
  }
  length_ = 0.0;
  double fastest = 0.0, closest = 1.0, slowest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i + 1 < nodes.size(); ++i) {
    followed_ = followed_ && nodes[i + 1].reached;
    const double own = limited_way(nodes[i + 1].q - nodes[i].q, nodes[i + 1].x - nodes[i].x);
    const double step = nodes[i + 1].x - nodes[i].x;
    const double rate = own / step;
    closest = std::min(closest, step);
    length_ += own;
    fastest = std::max(fastest, rate);
    slowest = std::min(slowest, rate);
  }
  jump_mm_ = axis_way(*machine_, nodes.back().q, q_to_);
  if (jump_mm_ > kJoin) followed_ = false;
  if (followed_) jump_mm_ = 0.0;
  if (!followed_) length_ = std::max(length_, toolpath::tip_way(block()));
  // From block to block of one curve s stays the way of its tip: no change of it bends q(s).
  if (followed_ && block().curve)
    length_ = tip_way_;
  else if (followed_ && turns(law_->motion) && fastest > kUneven * slowest)
    stretch(nodes);
  sample(kNodesPerStep / closest);
  // Even steps have missed a turn that the path makes: nothing between them is known.
  if (followed_ && axis_way(*machine_, nodes_.back(), q_to_) > kJoin) {
    followed_ = false;
    jump_mm_ = axis_way(*machine_, nodes_.back(), q_to_);
  }
}

/// Mm of s per share at x, from the axis values a little to both sides; x lies between node `near` and the
/// next.
double BlockCurve::way_rate(const std::vector<PathNode>& nodes, size_t near, double x) const {
  // The slope at x of the parabola through three places, of which x is the middle except at the ends.
  const double reach = kReach * (nodes[near + 1].x - nodes[near].x);
  const double middle = std::clamp(x, reach, 1.0 - reach);
  const AxisValues low = solve(middle - reach, nodes[near].q), high = solve(middle + reach, nodes[near].q);
  AxisValues change = 0.5 * (high - low);
  if (x != middle) change += (x - middle) / reach * (high + low - 2.0 * solve(middle, nodes[near].q));
  return limited_way(change, reach) / reach;
}

namespace {

/// Whether w grows all the way; its slope is a parabola between knots.
bool rises(const CubicSpline& spline, double step) {
  for (size_t i = 0; i + 1 < spline.values().size(); ++i) {
    const double t = step * static_cast<double>(i);
    const CubicSpline::Value from = spline.at(t), to = spline.at(t + step);
    const double share = from.ddw / (from.ddw - to.ddw);  // where the slope turns
    if (from.dw <= 0.0 || to.dw <= 0.0) return false;
    if (share > 0.0 && share < 1.0 && spline.at(t + share * step).dw <= 0.0) return false;
  }
  return true;
}

/// The narrowest; of width 0 where none is narrow.
BlockCurve::Pole narrow_pole(const BlockCurve::Law& law, const kinematics::InverseKinematics& inverse,
                             const std::vector<PathNode>& nodes) {
  if (law.motion.block.law == BlockLaw::kTcpAxes) return {};  // turns evenly, however far
  BlockCurve::Pole pole{0.0, kNarrowPole};
  for (size_t i = 0; i + 1 < nodes.size(); ++i) {
    const double step = nodes[i + 1].x - nodes[i].x;
    const double middle = nodes[i].x + 0.5 * step;
    // How far the axis is from the pole there, by how far it goes over the whole block at that rate.
    const double turn = (law.at(nodes[i + 1].x).axis_W - law.at(nodes[i].x).axis_W).norm();
    const double width = step * inverse.pole_distance(law.at(middle).axis_W) / turn;
    if (width < pole.width) pole = {middle, width};
  }
  return pole.width < kNarrowPole ? pole : BlockCurve::Pole{};
}

}  // namespace

/// Steps are halved until the share goes nowhere back: one that changes its rate a hundredfold from step to
/// step under axis limits far apart would. Where even the closest do not help it is not stretched.
void BlockCurve::stretch(const std::vector<PathNode>& nodes) {
  const double turn = turn_between(*machine_, nodes.front().q, nodes.back().q), length = length_;
  const Pole pole = narrow_pole(*law_, *inverse_, nodes);
  constexpr double kClosest = 4.0 * kNodesMax;
  for (double steps = std::clamp(4.0 * kNodesPerRadian * turn, 48.0, kNodesMax); steps <= kClosest;
       steps *= 2.0) {
    pole_ = pole;
    length_ = length;
    if (pole_.width > 0.0)
      spread(nodes, static_cast<size_t>(steps));
    else
      follow_rate(nodes, static_cast<size_t>(steps));
    stretched_ = rises(share_, share_step_);
    if (stretched_) return;
  }
  pole_ = {};
  length_ = length;
}

/// The solution of dx/ds = 1/|dq/dx| by Runge and Kutta, scaled to end at 1, and a spline through it.
void BlockCurve::follow_rate(const std::vector<PathNode>& nodes, size_t steps) {
  const double h = length_ / static_cast<double>(steps);
  size_t near = 0;
  const auto slope = [&](double x) {
    x = std::clamp(x, 0.0, 1.0);
    while (near + 2 < nodes.size() && nodes[near + 1].x <= x) ++near;
    while (near > 0 && nodes[near].x > x) --near;
    return 1.0 / way_rate(nodes, near, x);
  };
  std::vector<double> x(steps + 1, 0.0);
  for (size_t i = 0; i < steps; ++i) {
    const double k1 = slope(x[i]), k2 = slope(x[i] + 0.5 * h * k1);
    const double k3 = slope(x[i] + 0.5 * h * k2), k4 = slope(x[i] + h * k3);
    x[i + 1] = x[i] + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  const double whole = x.back();
  for (double& value : x) value /= whole;
  share_ = CubicSpline(0.0, h, std::move(x));
  share_step_ = h;
}

/// Past a narrow pole: s(x) summed from node to node by Simpson's rule, and a spline through the inverse.
void BlockCurve::spread(const std::vector<PathNode>& nodes, size_t steps) {
  const double from = pole_.place(0.0), to = pole_.place(1.0);
  const double evenly = kSpread * length_ / (to - from);
  std::vector<double> u, s{0.0}, slope;
  for (size_t i = 0; i < nodes.size(); ++i) {
    u.push_back(pole_.place(nodes[i].x));
    const auto rate = [&](size_t near, double at) {
      const double x = std::clamp(pole_.share(at), 0.0, 1.0);
      return way_rate(nodes, near, x) * pole_.width * std::cosh(at) + evenly;
    };
    slope.push_back(rate(std::min(i, nodes.size() - 2), u[i]));
    if (i == 0) continue;
    const double middle = rate(i - 1, 0.5 * (u[i - 1] + u[i]));
    s.push_back(s.back() + (u[i] - u[i - 1]) / 6.0 * (slope[i - 1] + 4.0 * middle + slope[i]));
  }
  length_ = s.back();
  share_step_ = length_ / static_cast<double>(steps);
  std::vector<double> knots;
  for (size_t k = 0, i = 0; k <= steps; ++k) {
    const double at = share_step_ * static_cast<double>(k);
    while (i + 2 < s.size() && s[i + 1] < at) ++i;
    // The cubic through both nodes with the slopes there.
    const double h = s[i + 1] - s[i], t = std::clamp((at - s[i]) / h, 0.0, 1.0);
    const double du = u[i + 1] - u[i];  // slopes above three times the mean would lead back
    const double a = std::min(h / slope[i], 3.0 * du) - du, b = du - std::min(h / slope[i + 1], 3.0 * du);
    knots.push_back(u[i] + t * du + t * (1.0 - t) * ((1.0 - t) * a + t * b));
  }
  share_ = CubicSpline(0.0, share_step_, std::move(knots));
}

/// `least`: nodes, at least.
void BlockCurve::sample(double least) {
  double turn = turn_between(*machine_, q_from_, q_to_);
  if (block().arc) turn += toolpath::arc_angle(block());
  // Past a narrow pole as many as the spline has.
  const double density = pole_.width > 0.0 ? 4.0 * kNodesPerRadian : kNodesPerRadian;
  const auto steps = static_cast<size_t>(std::clamp(std::max(least, density * turn), kNodesMin, kNodesMax));
  nodes_.reserve(steps + 1);
  nodes_.push_back(q_from_);
  const bool own_axes = block().law == BlockLaw::kTcpAxes;
  std::array<ToolPose, kSolvedAtOnce> poses;
  std::array<AxisValues, kSolvedAtOnce> given_before;
  std::array<Branch, kSolvedAtOnce> found;
  for (size_t first = 1; first <= steps; first += kSolvedAtOnce) {
    const size_t count = std::min(kSolvedAtOnce, steps + 1 - first);
    for (size_t i = 0; i < count; ++i) {
      const double x = share(length_ * static_cast<double>(first + i) / static_cast<double>(steps));
      poses[i] = law_->at(x);
      if (own_axes) given_before[i] = before(x, q_from_);
    }
    if (own_axes)
      inverse_->continued(std::span(poses).first(count), std::span(given_before).first(count), found);
    else
      inverse_->continued(std::span(poses).first(count), nodes_.back(), found);
    for (const Branch& branch : std::span(found).first(count))
      nodes_.push_back(branch.outcome == InverseOutcome::kUnreachable ? nodes_.back() : branch.q);
  }
  for (size_t i = 0; i < steps; ++i) jumps_ = jumps_ || jumps_after(i);
}

bool BlockCurve::jumps_after(size_t node) const {
  return turn_between(*machine_, nodes_[node], nodes_[node + 1]) > kJump;
}

double BlockCurve::share(double s) const {
  if (s <= 0.0) return 0.0;
  if (s >= length_) return 1.0;
  if (!stretched_) return s / length_;
  const double at = share_.at(s).w;
  return std::clamp(pole_.width > 0.0 ? pole_.share(at) : at, 0.0, 1.0);
}

const AxisValues& BlockCurve::nearest_node(double s) const {
  const double at = s / length_ * static_cast<double>(nodes_.size() - 1);
  return nodes_[std::min(nodes_.size() - 1, static_cast<size_t>(std::max(0.0, at + 0.5)))];
}

AxisValues BlockCurve::given(double x) const {
  if (x == 0.0 || x == 1.0) return x == 0.0 ? q_from_ : q_to_;
  return q_from_ + x * (q_to_ - q_from_);
}

AxisValues BlockCurve::q(double s) const {
  const double x = share(s);
  return is_given(x) ? given(x) : solve(x, nearest_node(s));
}

bool BlockCurve::is_solved(double s, double share, AxisValues& q, ToolPose& pose,
                           AxisValues& before_it) const {
  if (is_given(share)) {
    q = given(share);
    return true;
  }
  q = nearest_node(s);
  if (block().law == BlockLaw::kTcpAxes)
    before_it = before(share, q);
  else
    before_it = q;
  law_->set(share, pose);
  return false;
}

namespace {

/// BlockCurve::q() of several places.
template <size_t N>
std::array<AxisValues, N> values_at(const BlockCurve& curve, const std::array<double, N>& places) {
  std::array<AxisValues, N> q;
  std::array<ToolPose, N> poses;
  std::array<AxisValues, N> before;
  std::array<size_t, N> open;
  std::array<Branch, N> found;
  size_t count = 0;
  for (size_t i = 0; i < N; ++i)
    if (!curve.is_solved(places[i], curve.share(places[i]), q[i], poses[count], before[count]))
      open[count++] = i;
  curve.inverse().continued(std::span(poses).first(count), std::span(before).first(count), found);
  for (size_t i = 0; i < count; ++i)
    if (found[i].outcome != InverseOutcome::kUnreachable) q[open[i]] = found[i].q;
  return q;
}

}  // namespace

BlockCurve::Jet BlockCurve::jet(double s) const {
  if (even_) {
    const AxisValues slope = (q_to_ - q_from_) / length_;
    return {q(s), slope, AxisValues::Zero()};
  }
  // Central differences of the sixth order, as wide as the block's ends and its bends allow.
  const double bend = length_ / static_cast<double>(nodes_.size() - 1);
  const double h = std::min({s / 3.0, (length_ - s) / 3.0, 0.7 * bend});
  const auto at = values_at<7>(*this, {s, s - 1 * h, s + 1 * h, s - 2 * h, s + 2 * h, s - 3 * h, s + 3 * h});
  const AxisValues& value = at[0];
  AxisValues even[3], odd[3];
  for (size_t i = 0; i < 3; ++i) {
    const AxisValues &low = at[1 + 2 * i], &high = at[2 + 2 * i];
    odd[i] = high - low;
    even[i] = (high - value) + (low - value);
  }
  return {value, (45.0 * odd[0] - 9.0 * odd[1] + odd[2]) / (60.0 * h),
          (270.0 * even[0] - 27.0 * even[1] + 2.0 * even[2]) / (180.0 * h * h)};
}

PathCell BlockCurve::bounds_between(size_t from, size_t to) const {
  const size_t last = nodes_.size() - 1;
  const double h = length_ / static_cast<double>(last);
  PathCell cell;
  cell.first = cell.second = cell.third = AxisValues::Zero();
  const auto jump = [&](size_t i) { return jumps_ && jumps_after(i); };
  // Third differences of all steps that touch the cell and of one step beside it.
  for (size_t i = from > 3 ? from - 3 : 0; i + 3 <= last && i <= to; ++i) {
    if (jump(i) || jump(i + 1) || jump(i + 2)) continue;
    cell.third = cell.third.cwiseMax(
        (nodes_[i + 3] - 3.0 * nodes_[i + 2] + 3.0 * nodes_[i + 1] - nodes_[i]).cwiseAbs());
  }
  const bool on_curve = block().curve.has_value();
  cell.third *= (on_curve ? kBetweenKnots : kBetweenNodes) / (h * h * h);
  for (size_t i = std::max<size_t>(1, from); i <= std::min(last - 1, to); ++i) {
    if (jump(i - 1) || jump(i)) continue;
    cell.first = cell.first.cwiseMax(0.5 * (nodes_[i + 1] - nodes_[i - 1]).cwiseAbs());
    cell.second = cell.second.cwiseMax((nodes_[i + 1] - 2.0 * nodes_[i] + nodes_[i - 1]).cwiseAbs());
  }
  bool ends = false;
  AxisValues edge = AxisValues::Zero();
  for (size_t i = from; i < std::min(last, to); ++i) {
    const bool at_end = i == 0 || i + 1 == last || jump(i - 1) || jump(i + 1);
    if (!at_end || jump(i)) continue;
    ends = true;
    edge = edge.cwiseMax((nodes_[i + 1] - nodes_[i]).cwiseAbs());
  }
  // The spline's third derivative is even between two knots: up to its jump above or below what it follows.
  if (stretched_) cell.third += kBetweenNodes * bends_of_share(from, to) / h * cell.first;
  // At a node a central difference misses the slope by h^2/6 of the third derivative, between nodes the slope
  // rises above them by h^2/8 of it; at an end the mean of the last step misses it by half its bend.
  cell.second = cell.second / (h * h) + (ends ? 1.0 : 0.5) * h * cell.third;
  cell.first = cell.first / h + 0.3 * h * h * cell.third;
  if (ends) cell.first = cell.first.cwiseMax(edge / h + 0.5 * h * cell.second);
  if (on_curve) cell.first *= kSlopeOfCurve;
  return cell;
}

double BlockCurve::bends_of_share(size_t from, size_t to) const {
  const double step = share_step_, h = length_ / static_cast<double>(nodes_.size() - 1);
  const auto first =
      static_cast<size_t>(std::max(1.0, std::floor(static_cast<double>(from) * h / step) - 1.0));
  const auto end = std::min(static_cast<double>(to) * h / step + 2.0, length_ / step - 0.5);
  double greatest = 0.0;
  for (size_t k = first; static_cast<double>(k) < end; ++k) {
    const double s = static_cast<double>(k) * step;
    const CubicSpline::Value at = share_.at(s);
    const double kink = (share_.at(s + step).ddw - 2.0 * at.ddw + share_.at(s - step).ddw) / step;
    greatest = std::max(greatest, std::abs(kink) / at.dw);
  }
  return greatest;
}

namespace {

/// Feed and path limits of the tip along a stretch of a block.
struct AlongTip {
  double speed;
  RampLimits tip;
  /// `way_mm`: of the tip over the whole block; share of the block that the stretch goes through.
  AlongTip(const BlockCurve::TipLimits& limits, double way_mm, double share, double length) {
    // Millimetres of the tip per mm of s.
    const double ratio = way_mm * share / length;
    speed = limits.feed_mm_s > 0.0 ? limits.feed_mm_s / ratio : std::numeric_limits<double>::infinity();
    if (limits.duration_s > 0.0) speed = length / (share * limits.duration_s);
    tip = {limits.path.acceleration / ratio, limits.path.jerk / ratio};
  }
};

}  // namespace

/// Calls visit(from, to) for each cell of a stretch.
template <typename Visit>
void BlockCurve::divide(double from, double to, const Visit& visit) const {
  const double last = static_cast<double>(nodes_.size() - 1);
  const double group = std::max(1.0, std::ceil(last / static_cast<double>(kCellsMax)));
  const double step = length_ / last * std::max(group, last <= kNodesMin ? last / 2.0 : 1.0);
  const auto count = static_cast<size_t>(std::max(1.0, std::ceil((to - from) / step * (1.0 - 1e-9))));
  for (size_t i = 0; i < count; ++i)
    visit(from + (to - from) * static_cast<double>(i) / static_cast<double>(count),
          from + (to - from) * static_cast<double>(i + 1) / static_cast<double>(count));
}

void BlockCurve::append_cells(double from, double to, const TipLimits& tip,
                              std::vector<PathCell>& cells) const {
  if (!(to > from)) return;
  if (even_) {
    PathCell& cell = cells.emplace_back();
    cell.first = (q_to_ - q_from_).cwiseAbs() / length_;
    cell.second = cell.third = AxisValues::Zero();
    cell.length = to - from;
    const AlongTip along(tip, tip_way_, cell.length / length_, cell.length);
    cell.speed = along.speed;
    cell.tip = along.tip;
    return;
  }
  const double last = static_cast<double>(nodes_.size() - 1);
  divide(from, to, [&](double a, double b) {
    PathCell& cell = cells.emplace_back(bounds_between(static_cast<size_t>(a / length_ * last),
                                                       static_cast<size_t>(std::ceil(b / length_ * last))));
    cell.length = b - a;
    cell.uneven = stretched_;
    const AlongTip along(tip, tip_way_, share(b) - share(a), cell.length);
    cell.speed = along.speed;
    cell.tip = along.tip;
  });
}

void BlockCurve::limit_tip(double from, double to, const TipLimits& tip, PathCell& cell) const {
  if (!(to > from)) return;
  const auto lower = [&](const AlongTip& along) {
    cell.speed = std::min(cell.speed, along.speed);
    cell.tip.acceleration = std::min(cell.tip.acceleration, along.tip.acceleration);
    cell.tip.jerk = std::min(cell.tip.jerk, along.tip.jerk);
  };
  if (even_) return lower({tip, tip_way_, (to - from) / length_, to - from});
  divide(from, to, [&](double a, double b) { lower({tip, tip_way_, share(b) - share(a), b - a}); });
}

}  // namespace swarf::motion
