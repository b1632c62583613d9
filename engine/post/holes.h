// Drilling cycles among the moves of a stretch, and which of them a control can keep.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "post/follow.h"
#include "post/tilted_plane.h"
#include "program/cl/program.h"
#include "program/control/work_space.h"

namespace swarf::post {

/// What a dialect can do, from PostFormat.
struct PostAbilities {
  std::array<bool, 3> planes{};  ///< arcs in XY, ZX, YZ
  bool helix = true, tcp_arcs = true;
  bool drill = false, drill_dwell = false, deep = false, chip_break = false, bore = false, bore_dwell = false,
       tap = false;
  double arc_digit_mm = 1e-3;  ///< last digit of a linear word
  PlaneRules plane;
};

/// A cycle and its moves.
struct HoleSpan {
  size_t first = 0;  ///< index of its first move
  program::ClHole hole;
  double spindle_rpm = 0.0;

  size_t end() const { return first + static_cast<size_t>(hole.moves); }
  /// Where its own moves begin: behind those that only lead over it.
  size_t begin() const { return end() - program::cycle_steps(hole.cycle).size(); }
};

/// The last hole whose first move stands before this one; null: none does. `holes` in their order.
const HoleSpan* hole_before(std::span<const HoleSpan> holes, size_t move);
/// The hole whose first move this is; or null.
const HoleSpan* hole_at(std::span<const HoleSpan> holes, size_t move);

/// The control has a word for it, wherever the tool points: enough for a plane that stands square to it.
bool has_word_for(const PostAbilities& can, const HoleSpan& hole);
/// The control drills it along its own Z, with the rotary axes as at `q`.
bool stands_along_z(const Follower& follower, program::nc::WorkSpace& space, const HoleSpan& hole,
                    const kinematics::AxisValues& q);

}  // namespace swarf::post
