#include "motion/passes/driven_interpolator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/diagnostics.h"
#include "position/patch_target.h"

namespace swarf::motion {
namespace {

/// The chord of a cycle is found to this share of it, and to what rounding leaves, mm.
constexpr double kChordShare = 1e-8, kChordRounding_mm = 1e-12;
constexpr int kSecants = 30;
/// As near to a node as rounding and its chord allow: the tool stands on it, mm.
constexpr double kOnNode_mm = 2e-9;

}  // namespace

DrivenInterpolator::DrivenInterpolator(toolpath::DrivenPass pass, const kinematics::MachineModel& machine,
                                       const kinematics::InverseKinematics& inverse,
                                       const MotionOptions& options, const kinematics::AxisValues& hint)
    : pass_(std::move(pass)),
      period_s_(options.period_s),
      ahead_(evaluate_ahead(pass_, machine, inverse, options, hint)),
      control_(ahead_.limits, options.period_s) {
  start_ = at_ = toolpath::tip_at(pass_, 0.0, near_);
}

/// The tool comes to rest on a node.
void DrivenInterpolator::stand_on(size_t node) {
  const EvaluatedNode& there = ahead_.nodes[node];
  x_ = there.x;
  at_ = toolpath::tip_at(pass_, x_, near_);
  // At a step one line has two tips, and a crease lies within its line's rounding.
  at_.pose = there.pose;
  cell_ = std::min(node, ahead_.steps.size() - 1);
  state_ = {};
  per_chord_ = per_chord_before_ = 0.0;
}

void DrivenInterpolator::require_progress() {
  constexpr double kProgress_mm = 1e-4;
  constexpr int kMostCycles = 5000;
  if ((at_.pose.tip_W - anchor_).norm() > kProgress_mm) {
    anchor_ = at_.pose.tip_W;
    waits_ = 0;
  }
  if (++waits_ < kMostCycles) return;
  const Vec3& p = at_.pose.tip_W;
  throw InputError(
      "pass-stands", {},
      fmt::format("at ({:.6f}, {:.6f}, {:.6f}) mm the tool gets no farther: what stops it there is "
                  "known within {:g} mm only, and the chord's tolerance finds creases in that",
                  p.x(), p.y(), p.z(), position::kPatchProof_mm),
      "raise driven.chord_tolerance_um, or move the guide by a micrometre");
}

void DrivenInterpolator::along_step(double length) {
  const Vec3& end = ahead_.nodes[cell_ + 1].pose.tip_W;
  at_.pose.tip_W += length * (end - at_.pose.tip_W).normalized();
}

/// The first place of the cell one chord away; the cell's end is farther.
void DrivenInterpolator::along_surface(double length) {
  const Vec3 from = at_.pose.tip_W;
  const double begin = x_, end = ahead_.nodes[cell_ + 1].x;
  // Chords grow along the cell: nearer than the chord at `low`, farther at `high`.
  double low = x_, low_chord = 0.0, high = end, high_chord = to_node(cell_ + 1);
  const double tolerance = std::max(kChordShare * length, kChordRounding_mm);
  for (int i = 0; i < kSecants; ++i) {
    double share = (length - low_chord) / (high_chord - low_chord);
    // Chords are all but linear; a side that stays is brought nearer.
    if (i > 4 && i % 2 == 1) share = 0.5;
    double x = low + share * (high - low);
    // As the last two cycles went on: where the path is smooth the second position is the last.
    const double guess = begin + length * (2.0 * per_chord_ - per_chord_before_);
    if (i == 0 && per_chord_before_ > 0.0 && guess > low && guess < high) x = guess;
    at_ = toolpath::tip_at(pass_, x, near_);
    x_ = x;
    const double chord = (at_.pose.tip_W - from).norm();
    if (std::abs(chord - length) <= tolerance || !(low < x && x < high)) break;
    (chord < length ? low : high) = x;
    (chord < length ? low_chord : high_chord) = chord;
  }
  per_chord_before_ = per_chord_;
  per_chord_ = (x_ - begin) / length;
}

void DrivenInterpolator::advance(double length) {
  while (to_node(cell_ + 1) <= length + kOnNode_mm) {
    const bool stops = ahead_.clamps.at[cell_ + 1] == 0.0;
    if (stops) {
      stand_on(cell_ + 1);
      return;
    }
    ++cell_;
  }
  if (ahead_.steps[cell_]) {
    along_step(length);
  } else {
    along_surface(length);
  }
}

DrivenOutput DrivenInterpolator::step(const DrivenInput& input) {
  const ClampPlace place{cell_, to_node(cell_ + 1)};
  const double share = input.override_share * pass_.override_at(static_cast<double>(cycles_++) * period_s_);
  const SpeedTick tick = control_.next(state_, share * pass_.feed_mm_s, ahead_.clamps, place);
  const Vec3 before = at_.pose.tip_W;
  const size_t last = ahead_.nodes.size() - 1;
  // What is left of a stop when the speed is gone: a thousandth of what the limit of jerk lets a cycle do.
  const double rest = 1e-3 * ahead_.limits.jerk * std::pow(period_s_, 3);
  const bool near = tick.after.speed == 0.0 && place.to_node_mm - tick.way_mm <= rest;
  const bool stops = ahead_.clamps.at[cell_ + 1] == 0.0 && share > 0.0;
  // Two looks at one position may differ by their proof: no way along the guide would end what is left of it.
  const bool within_proof = tick.after.speed == 0.0 && place.to_node_mm <= position::kPatchProof_mm;
  const bool arrives = stops && (near || within_proof);
  state_ = tick.after;
  if (arrives) {
    stand_on(cell_ + 1);
  } else if (tick.way_mm > 0.0) {
    advance(tick.way_mm);
  }
  if (share > 0.0) require_progress();
  DrivenOutput out;
  out.at = at_;
  out.x = x_;
  out.feed_mm_s = tick.way_mm / period_s_;
  out.chord_mm = (at_.pose.tip_W - before).norm();
  out.clamp_mm_s = ahead_.clamps.speed[cell_];
  out.finished = (at_.pose.tip_W - ahead_.nodes[last].pose.tip_W).norm() == 0.0 && x_ == ahead_.nodes[last].x;
  return out;
}

}  // namespace swarf::motion
