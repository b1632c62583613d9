// The inverse along a way, of several poses side by side. What is seldom (the pole, out of reach, turns far
// beyond the travel, a proof that fails) is left to continued() of one pose.
#include "kinematics/inverse_lanes.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "kinematics/chain.h"
#include "kinematics/lane_kernel.h"

namespace swarf::kinematics {
namespace {

/// Whole turns from the values before beyond which they are not counted side by side.
constexpr double kTurnsMost = 1e6;

SWARF_KERNEL_INLINE double nearest_whole(double x) {
  return std::nearbyint(x);
}
/// std::nearbyint of each, the sign of zero included; below 2^51.
template <class T>
SWARF_KERNEL_INLINE T nearest_whole(const T& x) {
  using Bits = typename lanes::Vector<sizeof(T) / sizeof(double)>::Bits;
  const T whole = (x + lanes::kWhole) - lanes::kWhole;
  return lanes::same_bits<T>(Bits(lanes::same_bits<Bits>(whole) | (lanes::same_bits<Bits>(x) & INT64_MIN)));
}

template <class T>
SWARF_KERNEL_INLINE T magnitude(const T& x) {
  return x < 0.0 ? -x : x;
}

template <class T>
SWARF_KERNEL_INLINE T roots(const T& x) {
  double of[sizeof(T) / sizeof(double)];
  std::memcpy(of, &x, sizeof of);
  for (double& one : of) one = std::sqrt(one);
  return lanes::same_bits<T>(of);
}

/// In the order in which Eigen adds: two rows at once, then the third.
template <int N>
SWARF_KERNEL_INLINE LanePoints<N> product(const Mat3& m, const LanePoints<N>& p) {
  return {(m(0, 0) * p.x + m(0, 1) * p.y) + m(0, 2) * p.z, (m(1, 0) * p.x + m(1, 1) * p.y) + m(1, 2) * p.z,
          m(2, 0) * p.x + (m(2, 1) * p.y + m(2, 2) * p.z)};
}

/// Of a pose all rows are added alike.
template <int N>
SWARF_KERNEL_INLINE LanePoints<N> moved(const Pose& by, const LanePoints<N>& p) {
  const auto row = [&](int i) { return by(i, 3) + ((by(i, 0) * p.x + by(i, 1) * p.y) + by(i, 2) * p.z); };
  return {row(0), row(1), row(2)};
}

/// The rotary values of one branch by axis, outer and inner: as they are found, and turned to those before.
template <class T>
struct Turned {
  T value[2], q[2];
};

}  // namespace

struct LaneInverse {
  /// Two rotary axes, and no linear axis rides on one.
  static bool takes(const InverseKinematics& inverse) {
    return inverse.rotary_.size() == 2 && inverse.columns_constant_;
  }

  /// Turns by axis and branch, with the senses of the machine's axes. `odd`: above 0 where there are not
  /// two branches, or this is not the way to them.
  template <int N>
  struct Turns {
    Numbers<N> of[2][2];
    Numbers<N> odd;
  };

  /// RotaryPair::solve().
  template <int N>
  SWARF_KERNEL_INLINE static Turns<N> turns(const InverseKinematics& inverse, const LanePoints<N>& axis_W) {
    const RotaryPair& pair = inverse.pair_;
    const LanePoints<N> in_frame = product<N>(pair.frame_, axis_W);
    const Numbers<N> c1 = in_frame.x, wn = in_frame.y, wk = in_frame.z;
    const Numbers<N> rho_squared = wn * wn + wk * wk, rho = roots(rho_squared);
    Numbers<N> p =
        lanes::by_sign<Numbers<N>>(c1, spread<N>(pair.p_at_pole_[1]), spread<N>(pair.p_at_pole_[0]));
    if (pair.d_ != 0.0) {
      const Numbers<N> from_pole = rho_squared / (1.0 + magnitude(c1));
      p += pair.d_per_s_ * lanes::by_sign<Numbers<N>>(c1, -from_pole, from_pole);
    }
    const bool never_aside = pair.d_ == 0.0 && pair.p_at_pole_[0] == 0.0 && pair.p_at_pole_[1] == 0.0;
    Numbers<N> r = rho, z_angle = spread<N>(0.5 * kPi);
    if (!never_aside) {
      const Numbers<N> square = (rho - p) * (rho + p);
      r = p == 0.0 ? rho : roots<Numbers<N>>(square > 0.0 ? square : Numbers<N>{});
      z_angle = p == 0.0 ? z_angle : lanes::atan2<N>(r, p);
    }
    const Numbers<N> turn = lanes::atan2<N>(wk, wn);
    const Numbers<N> tilt = lanes::atan2<N>(r, (c1 - pair.d_ * pair.c2_) * pair.per_s_);
    const double outer = inverse.rotary_sense_[0], inner = inverse.rotary_sense_[1];
    // Everything but two branches has no root above 0, or is not a number.
    const Numbers<N> zero{}, one = zero + 1.0;
    const Numbers<N> odd =
        (rho >= kPoleTolerance ? zero : one) + (r > 0.0 ? zero : one) + (magnitude(p) <= rho ? zero : one);
    return {{{outer * (turn - z_angle), outer * (turn + z_angle)},
             {inner * (-tilt - pair.v_angle_), inner * (tilt - pair.v_angle_)}},
            odd};
  }

  /// The branch that turns less from the values before. Of one pose or of several.
  template <class T>
  SWARF_KERNEL_INLINE static Turned<T> nearer(const InverseKinematics& inverse, const T (&turns)[2][2],
                                              const T (&before)[2]) {
    Turned<T> branch[2];
    T way[2] = {};
    for (int which = 0; which < 2; ++which) {
      for (int slot = 0; slot < 2; ++slot) {
        const T value = LaneKernel::unwound<T>(turns[slot][which], before[slot], inverse.rotary_min_[slot],
                                               inverse.rotary_max_[slot]);
        branch[which].value[slot] = value;
        branch[which].q[slot] = value + kTurn * nearest_whole((before[slot] - value) / kTurn);
        way[which] += magnitude(T(branch[which].q[slot] - before[slot]));
      }
    }
    Turned<T> result;
    for (int slot = 0; slot < 2; ++slot) {
      result.value[slot] = way[1] < way[0] ? branch[1].value[slot] : branch[0].value[slot];
      result.q[slot] = way[1] < way[0] ? branch[1].q[slot] : branch[0].q[slot];
    }
    return result;
  }

  /// nearer() of each pose after the one before it.
  template <int N>
  SWARF_KERNEL_INLINE static Turned<Numbers<N>> nearer_along(const InverseKinematics& inverse,
                                                             const Turns<N>& turns, const AxisValues& before,
                                                             Numbers<N> (&hints)[2]) {
    Turned<Numbers<N>> result;
    double hint[2] = {before[inverse.rotary_[0]], before[inverse.rotary_[1]]};
    for (int lane = 0; lane < N; ++lane) {
      const double own[2][2] = {{turns.of[0][0][lane], turns.of[0][1][lane]},
                                {turns.of[1][0][lane], turns.of[1][1][lane]}};
      const Turned<double> one = nearer<double>(inverse, own, hint);
      for (int slot = 0; slot < 2; ++slot) {
        hints[slot][lane] = hint[slot];
        result.value[slot][lane] = one.value[slot];
        result.q[slot][lane] = hint[slot] = one.q[slot];
      }
    }
    return result;
  }

  template <int N>
  SWARF_KERNEL_INLINE static LanePoints<N> load(const double (&rows)[3][N]) {
    return {lanes::same_bits<Numbers<N>>(rows[0]), lanes::same_bits<Numbers<N>>(rows[1]),
            lanes::same_bits<Numbers<N>>(rows[2])};
  }

  /// unit_axis() of each, its squares added as Eigen does.
  template <int N>
  SWARF_KERNEL_INLINE static LanePoints<N> unit_axes(const LanePoints<N>& axis) {
    const Numbers<N> squared = (axis.x * axis.x + axis.y * axis.y) + axis.z * axis.z;
    const Numbers<N> off = magnitude(Numbers<N>(squared - 1.0)) <= kUnitRounding ? Numbers<N>{} : squared;
    const auto bits = lanes::same_bits<Bits<N>>(off);
    int64_t any = 0;
    for (int lane = 0; lane < N; ++lane) any |= bits[lane];
    if (any == 0) return axis;
    const Numbers<N> norm = roots(squared);
    return {off == 0.0 ? axis.x : axis.x / norm, off == 0.0 ? axis.y : axis.y / norm,
            off == 0.0 ? axis.z : axis.z / norm};
  }

  /// The values by axis, of each pose.
  template <int N>
  struct Values {
    Numbers<N> of[kMaxAxes];
    Numbers<N> out_of_travel;  ///< the first axis outside, or -1
  };

  /// InverseKinematics::first_out_of_travel() of each.
  template <int N>
  SWARF_KERNEL_INLINE static Values<N> by_axis(const InverseKinematics& inverse, const LanePoints<N>& linear,
                                               const Turned<Numbers<N>>& chosen) {
    Values<N> values;
    values.of[inverse.linear_[0]] = linear.x;
    values.of[inverse.linear_[1]] = linear.y;
    values.of[inverse.linear_[2]] = linear.z;
    for (size_t slot = 0; slot < 2; ++slot) values.of[inverse.rotary_[slot]] = chosen.value[slot];
    values.out_of_travel = spread<N>(-1.0);
    for (int i = kMaxAxes - 1; i >= 0; --i) {
      values.out_of_travel = LaneKernel::if_within<Numbers<N>>(
          values.of[i], inverse.travel_min_[i], inverse.travel_max_[i], values.out_of_travel, spread<N>(i));
    }
    for (size_t slot = 0; slot < 2; ++slot) values.of[inverse.rotary_[slot]] = chosen.q[slot];
    return values;
  }

  /// The first poses, N at most; returns how many: up to one that is odd and belongs to a way.
  template <int N, bool kAlong>
  SWARF_KERNEL_INLINE static size_t solve(const PoseRow& row) {
    const InverseKinematics& inverse = row.inverse;
    const size_t count = std::min<size_t>(row.poses_W.size(), N);
    double tip[3][N], axis[3][N], follows[2][N];
    for (size_t lane = 0; lane < N; ++lane) {
      const size_t from = std::min(lane, count - 1);
      for (int i = 0; i < 3; ++i) {
        tip[i][lane] = row.poses_W[from].tip_W[i];
        axis[i][lane] = row.poses_W[from].axis_W[i];
      }
      for (size_t slot = 0; slot < 2 && !kAlong; ++slot)
        follows[slot][lane] = row.before[from][inverse.rotary_[slot]];
    }
    const LanePoints<N> axis_W = unit_axes<N>(load<N>(axis));
    const Turns<N> turns = LaneInverse::turns<N>(inverse, axis_W);
    Numbers<N> hints[2];
    Turned<Numbers<N>> chosen;
    if constexpr (kAlong) {
      chosen = nearer_along<N>(inverse, turns, *row.before, hints);
    } else {
      for (int slot = 0; slot < 2; ++slot) hints[slot] = lanes::same_bits<Numbers<N>>(follows[slot]);
      chosen = nearer<Numbers<N>>(inverse, turns.of, hints);
    }
    Numbers<N> odd = turns.odd;
    LaneSines<N> of;
    for (int slot = 0; slot < 2; ++slot) {
      lanes::sines<N>(chosen.value[slot], of.sine[slot], of.cosine[slot]);
      const Numbers<N> away = hints[slot] - chosen.value[slot], zero{}, one = zero + 1.0;
      odd += (magnitude(chosen.value[slot]) <= kLaneRange ? zero : one) +
             (magnitude(away) <= kTurn * kTurnsMost ? zero : one);
    }
    const Mat3 into_M = inverse.machine_.X_MW.linear();
    const LanePoints<N> tip_M = moved<N>(inverse.machine_.X_MW, load<N>(tip));
    const LanePoints<N> axis_M = product<N>(into_M, axis_W);
    const LanePoints<N> linear = LaneKernel::locate<N>(inverse, tip_M, of);
    odd += LaneKernel::disprove<N>(inverse, tip_M, axis_M, of, linear);
    return hand_out<N, kAlong>(row, count, odd, by_axis<N>(inverse, linear, chosen));
  }

  template <int N, bool kAlong>
  SWARF_KERNEL_INLINE static size_t hand_out(const PoseRow& row, size_t count, const Numbers<N>& odd,
                                             const Values<N>& values) {
    for (size_t lane = 0; lane < count; ++lane) {
      Branch& one = row.found[lane];
      if (odd[lane] != 0.0) {
        const AxisValues& hint = !kAlong ? row.before[lane] : lane == 0 ? *row.before : row.found[lane - 1].q;
        one = row.inverse.continued(row.poses_W[lane], hint);
        if (kAlong) return lane + 1;
        continue;
      }
      for (int i = 0; i < kMaxAxes; ++i) one.q[i] = values.of[i][lane];
      one.out_of_travel_axis = static_cast<int>(values.out_of_travel[lane]);
      one.outcome = one.out_of_travel_axis >= 0 ? InverseOutcome::kOutOfTravel : InverseOutcome::kOk;
    }
    return count;
  }
};

namespace {

template <bool kAlong>
SWARF_X86_64_V4_WIDE size_t solve_eight(const PoseRow& row) {
  return LaneInverse::solve<8, kAlong>(row);
}
template <bool kAlong>
SWARF_X86_64_V3 size_t solve_four(const PoseRow& row) {
  return LaneInverse::solve<4, kAlong>(row);
}
template <bool kAlong>
size_t solve_two(const PoseRow& row) {
  return LaneInverse::solve<2, kAlong>(row);
}

}  // namespace

std::span<const InverseLanes> inverse_lane_variants() {
  static const std::vector<InverseLanes> variants = runnable<InverseLanes>(
      {8, &solve_eight<false>, &solve_eight<true>}, {4, &solve_four<false>, &solve_four<true>},
      {2, &solve_two<false>, &solve_two<true>});
  return variants;
}

void continue_apart(const InverseLanes& lanes, const InverseKinematics& inverse,
                    std::span<const ToolPose> poses_W, std::span<const AxisValues> before,
                    std::span<Branch> found) {
  for (size_t i = 0; i < poses_W.size();) {
    if (LaneInverse::takes(inverse) && poses_W.size() - i > 1) {
      i += lanes.apart({inverse, poses_W.subspan(i), &before[i], &found[i]});
    } else {
      found[i] = inverse.continued(poses_W[i], before[i]);
      ++i;
    }
  }
}

void continue_along(const InverseLanes& lanes, const InverseKinematics& inverse,
                    std::span<const ToolPose> poses_W, const AxisValues& before, std::span<Branch> found) {
  AxisValues last = before;
  for (size_t i = 0; i < poses_W.size();) {
    size_t done = 1;
    if (LaneInverse::takes(inverse) && poses_W.size() - i > 1)
      done = lanes.along({inverse, poses_W.subspan(i), &last, &found[i]});
    else
      found[i] = inverse.continued(poses_W[i], last);
    for (; done > 0; --done, ++i)
      if (found[i].outcome != InverseOutcome::kUnreachable) last = found[i].q;
  }
}

void InverseKinematics::continued(std::span<const ToolPose> poses_W, std::span<const AxisValues> before,
                                  std::span<Branch> found) const {
  continue_apart(inverse_lane_variants().front(), *this, poses_W, before, found);
}

void InverseKinematics::continued(std::span<const ToolPose> poses_W, const AxisValues& before,
                                  std::span<Branch> found) const {
  continue_along(inverse_lane_variants().front(), *this, poses_W, before, found);
}

}  // namespace swarf::kinematics
