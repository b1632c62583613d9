// The steps of the inverse for N poses side by side (N = 2, 4 or 8), or for both branches of one: the same
// operations in the same order for each, whatever N is and whatever stands beside it.
#pragma once

#include <cmath>
#include <vector>

#include "base/angles.h"
#include "base/instruction_sets.h"
#include "kinematics/lane_pair.h"
#include "kinematics/machine_model.h"

namespace swarf::kinematics {

/// Of the outer and the inner axis.
template <int N>
struct LaneSines {
  Numbers<N> sine[2], cosine[2];
};

struct LaneKernel {
  /// The values by whole turns nearest to the hint, or one turn from there where only that is inside the
  /// travel. Of one number or of several.
  template <class T>
  SWARF_KERNEL_INLINE static T unwound(const T& turn, const T& hint, double least, double most) {
    const T turns_away = (hint - turn) * (1.0 / kTurn);
    // Without a call and without a branch.
    const T value = turn + kTurn * ((turns_away + lanes::kWhole) - lanes::kWhole);
    const T other = value < least ? value + kTurn : value - kTurn;
    return if_within<T>(value, least, most, value, if_within<T>(other, least, most, other, value));
  }

  /// What is chosen where x lies in the bounds, else the other.
  template <class T>
  SWARF_KERNEL_INLINE static T if_within(const T& x, double least, double most, const T& chosen,
                                         const T& other) {
    if constexpr (sizeof(T) == sizeof(double))
      return (x >= least) & (x <= most) ? chosen : other;
    else
      return lanes::by_sign<T>(x - least, other, lanes::by_sign<T>(most - x, other, chosen));
  }

  /// Carries the work or tool point to the base; the linear axes are what is looked for.
  template <int N>
  SWARF_KERNEL_INLINE static LanePoints<N> walk_to_base(const InverseKinematics& inverse,
                                                        const std::vector<LinkStep>& steps,
                                                        const LaneSines<N>& of, LanePoints<N> point) {
    for (const LinkStep& step : steps) {
      if (!step.rotary) continue;
      const int slot = inverse.column_[step.axis];
      const LanePoints<N> origin = spread<N>(step.origin);
      point = origin + rotate<N>(step.along, step.direction, step.sense * of.sine[slot], of.cosine[slot],
                                 point - origin);
    }
    return point;
  }

  /// The linear values that bring the tip to where it has to be; where no linear axis rides on a rotary one.
  template <int N>
  SWARF_KERNEL_INLINE static LanePoints<N> locate(const InverseKinematics& inverse,
                                                  const LanePoints<N>& tip_M, const LaneSines<N>& of) {
    const LanePoints<N> work = walk_to_base<N>(inverse, inverse.table_steps_, of, tip_M);
    const LanePoints<N> tool =
        walk_to_base<N>(inverse, inverse.head_steps_, of, spread<N>(inverse.machine_.tip_M));
    const LanePoints<N> gap = work - tool;
    const Mat3& rows = inverse.linear_inverse_;
    return {rows(0, 0) * gap.x + rows(0, 1) * gap.y + rows(0, 2) * gap.z,
            rows(1, 0) * gap.x + rows(1, 1) * gap.y + rows(1, 2) * gap.z,
            rows(2, 0) * gap.x + rows(2, 1) * gap.y + rows(2, 2) * gap.z};
  }

  /// forward() without its last step, the turn into W, which changes no distance. 0 where it gives the pose
  /// back, else more.
  template <int N>
  SWARF_KERNEL_INLINE static Numbers<N> disprove(const InverseKinematics& inverse, const LanePoints<N>& tip_M,
                                                 const LanePoints<N>& axis_M, const LaneSines<N>& of,
                                                 const LanePoints<N>& linear_values) {
    const Numbers<N> linear[3] = {linear_values.x, linear_values.y, linear_values.z};
    LanePoints<N> tip = spread<N>(inverse.machine_.tip_M), axis = spread<N>(inverse.machine_.tool_axis_M);
    for (const LinkStep& step : inverse.tool_to_work_) {
      const int slot = inverse.column_[step.axis];
      if (!step.rotary) {
        tip = tip + (step.sense * linear[slot]) * spread<N>(step.direction);
        continue;
      }
      const Numbers<N> sine = step.sense * of.sine[slot], cosine = of.cosine[slot];
      const LanePoints<N> origin = spread<N>(step.origin);
      tip = origin + rotate<N>(step.along, step.direction, sine, cosine, tip - origin);
      axis = rotate<N>(step.along, step.direction, sine, cosine, axis);
    }
    const Numbers<N> zero{};
    return (squared_norm<N>(tip - tip_M) <= kTipTolerance * kTipTolerance ? zero : zero + 1.0) +
           (squared_norm<N>(axis - axis_M) <= kAxisTolerance * kAxisTolerance ? zero : zero + 1.0);
  }
};

}  // namespace swarf::kinematics
