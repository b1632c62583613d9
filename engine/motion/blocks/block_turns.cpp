#include "motion/blocks/block_turns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/minima.h"
#include "motion/blocks/block_curve.h"
#include "motion/blocks/block_run.h"

namespace swarf::motion {
namespace {

using kinematics::AxisKind;
using toolpath::BlockMove;

constexpr int kPlaces = 32;
/// Tips that move less have no direction, mm.
constexpr double kWayMin = 1e-6;

double segment_distance(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 way = to - from;
  const double square = way.squaredNorm();
  const double x = square > 0.0 ? std::clamp((point - from).dot(way) / square, 0.0, 1.0) : 0.0;
  return (point - from - x * way).norm();
}

double error_at(const BlockMotion& motion, double s) {
  const BlockMove& block = motion.block;
  const Vec3 tip =
      kinematics::forward(*motion.machine, motion.q_from + s * (motion.q_to - motion.q_from)).tip_W;
  if (block.arc || block.curve) return (tip - pose_at(motion, s).tip_W).norm();
  return segment_distance(tip, block.from.tip_W, block.to.tip_W);
}

/// Turn of the rotary axis that turns most; its index, -1 when none does.
struct Turn {
  int axis = -1;
  double rad = 0.0;  ///< signed
};
Turn greatest_turn(const BlockMotion& motion) {
  Turn turn;
  for (size_t i = 0; i < motion.machine->axes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double own = motion.q_to[row] - motion.q_from[row];
    if (motion.machine->axes[i].kind == AxisKind::kRotary && std::abs(own) > std::abs(turn.rad))
      turn = {static_cast<int>(i), own};
  }
  return turn;
}

/// Findings of one code: lists the first, counts all.
class List {
 public:
  List(const toolpath::Elements& elements, std::string code) : elements_(elements), code_(std::move(code)) {}
  void add(size_t element, std::string text) {
    if (++count_ <= kListed) {
      findings_.push_back({code_, std::move(text), static_cast<int>(element), 0.0, elements_.where(element),
                           Severity::kWarning});
    }
  }
  void move_to(std::vector<MotionFinding>& all) {
    if (count_ > kListed)
      findings_.back().text += fmt::format("; {} more blocks like this", count_ - kListed);
    std::move(findings_.begin(), findings_.end(), std::back_inserter(all));
  }

 private:
  const toolpath::Elements& elements_;
  std::string code_;
  int count_ = 0;
  std::vector<MotionFinding> findings_;
};

}  // namespace

ModeError mode_error(const BlockMotion& motion) {
  if (greatest_turn(motion).axis < 0) return {};
  const Minimum greatest =
      greatest_sampled([&](double share) { return error_at(motion, share); }, 0.0, 1.0, kPlaces);
  return {greatest.value, greatest.at};
}

OtherMode other_mode(const BlockMotions& motions) {
  OtherMode worst;
  if (!motions.may_turn()) return worst;
  for (size_t i = 0; i < motions.size(); ++i) {
    const ModeError own = mode_error(motions[i]);
    if (own.mm > worst.tip_error_max_mm) worst = {own.mm, static_cast<int>(i), own.share};
  }
  return worst;
}

std::vector<MotionFinding> find_fast_turns(const toolpath::Elements& elements, const BlockMotions& motions,
                                           const MotionOptions& options) {
  if (!motions.may_turn()) return {};
  List fast(elements, "fast-rotary"), swings(elements, "swing");
  for (size_t i = 0; i < motions.size(); ++i) {
    const BlockMotion motion = motions[i];
    const Turn turn = greatest_turn(motion);
    if (turn.axis < 0) continue;
    const std::string& name = motion.machine->axes[static_cast<size_t>(turn.axis)].name;
    const auto row = static_cast<Eigen::Index>(turn.axis);
    const double way = toolpath::tip_way(motion.block);
    if (!is_rapid(motion.block) && way > kWayMin && std::abs(turn.rad) > options.fast_rotary_rad_mm * way) {
      fast.add(i, fmt::format("axis {} turns {:.3f} deg while the tip goes {:.4f} mm: {:.1f} deg/mm, the "
                              "threshold is {:.1f}",
                              name, deg_from_rad(turn.rad), way, deg_from_rad(std::abs(turn.rad) / way),
                              deg_from_rad(options.fast_rotary_rad_mm)));
    }
    if (std::abs(turn.rad) > options.swing_rad) {
      swings.add(i, fmt::format("axis {} swings {:+.3f} deg in one block, from {:.3f} to {:.3f} deg; the "
                                "threshold is {:.1f} deg",
                                name, deg_from_rad(turn.rad), deg_from_rad(motion.q_from[row]),
                                deg_from_rad(motion.q_to[row]), deg_from_rad(options.swing_rad)));
    }
  }
  std::vector<MotionFinding> findings;
  fast.move_to(findings);
  swings.move_to(findings);
  return findings;
}

}  // namespace swarf::motion
