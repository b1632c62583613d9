// How far the digits of a program may put the tip aside.
//
// Every axis value is written within half a digit h_i. The tip of the values written differs from that of the
// exact ones by at most sum h_i |dp/dq_i|, with |dp/dq_i| = 1 for a linear axis and the arm of the tip about
// a rotary one. On a block the axes written run within h_i of the exact ones all the way, so the same holds
// there with the greatest arm: where no rotary axis turns the arm is convex along the block, otherwise it
// grows at most by the way of the tip along the chain.
// With TCP the words are the tip's: sqrt(3) half digits, whatever the arms.
#pragma once

#include "post/follow.h"

namespace swarf::post {

/// Bound over a block between two sets of axis values, mm; `tcp`: the words are the tip's there. Holds for
/// the ends alone, too.
double rounding_mm(const Follower& follower, bool tcp, const kinematics::AxisValues& from,
                   const kinematics::AxisValues& to);
/// Of the tool axis, rad: half a digit of each rotary axis.
double rounding_rad(const Follower& follower);

}  // namespace swarf::post
