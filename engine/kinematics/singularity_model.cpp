#include "kinematics/singularity_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "kinematics/chain.h"
#include "kinematics/model_check.h"

namespace swarf::kinematics {
namespace {

/// To which the greatest deviation is proven, mm.
constexpr double kModelPeakTolerance = 1e-9;

Vec3 turned(const Vec3& e, double angle, const Vec3& v) {
  return rotate(e, std::sin(angle), std::cos(angle), v);
}

/// The links after the outer rotary axis on the way from the tool to the work: linear axes only.
Vec3 carried_beyond(const MachineModel& machine, int outer, const AxisValues& q) {
  Vec3 moved = Vec3::Zero();
  bool beyond = false;
  const auto pass = [&](int i, double way) {
    if (beyond) {
      const Axis& axis = machine.axes[static_cast<size_t>(i)];
      moved += (way * link_sense(axis) * q[i]) * axis.direction_M;
    }
    beyond = beyond || i == outer;
  };
  for (size_t n = machine.head_chain.size(); n-- > 0;) pass(machine.head_chain[n], 1.0);
  for (const int i : machine.table_chain) pass(i, -1.0);
  return moved;
}

}  // namespace

SingularityModel::SingularityModel(const MachineModel& machine, const BlockEnds& ends)
    : X_WM_(machine.X_MW.inverse()) {
  require_finite(ends);
  const std::vector<int> rotary = rotary_order(machine);
  SWARF_CHECK(!rotary.empty(), "the model needs a rotary axis");
  const int outer = rotary[0];
  const Axis& axis = machine.axes[static_cast<size_t>(outer)];
  const double sense = (axis.side == Side::kHead ? 1.0 : -1.0) * link_sense(axis);
  e_ = axis.direction_M;
  const Vec3 seed = std::abs(e_.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
  x_ = (seed - seed.dot(e_) * e_).normalized();
  y_ = e_.cross(x_);
  u0_ = sense * ends.q_from[outer];
  du_ = sense * (ends.q_to[outer] - ends.q_from[outer]);
  g0_ = axis.origin_M + carried_beyond(machine, outer, ends.q_from);
  dg_ = axis.origin_M + carried_beyond(machine, outer, ends.q_to) - g0_;
  from_M_ = machine.X_MW * ends.from.tip_W;
  const Vec3 to_M = machine.X_MW * ends.to.tip_W;
  way_M_ = to_M - from_M_;
  m0_ = turned(e_, -u0_, from_M_ - g0_);
  dm_ = turned(e_, -(u0_ + du_), to_M - g0_ - dg_) - m0_;
}

SingularityModel::State SingularityModel::at(double u) const {
  const double angle = u0_ + u * du_;
  const Vec3 m = m0_ + u * dm_;
  State state;
  state.point = g0_ + u * dg_ + turned(e_, angle, m);
  state.turning = turned(e_, angle, du_ * e_.cross(m) + dm_);
  state.rate = dg_ + state.turning;
  return state;
}

Vec3 SingularityModel::tip_W(double u) const {
  return X_WM_ * at(u).point;
}

double SingularityModel::tangent_criterion(double u) const {
  const Vec3 across = e_.cross(way_M_);
  const State state = at(u);
  const Vec3 turning = state.turning - state.turning.dot(e_) * e_;
  const double scale = across.norm() * turning.norm();
  return scale > 0.0 ? across.dot(state.rate) / scale : std::numeric_limits<double>::quiet_NaN();
}

double SingularityModel::deviation(double u) const {
  const Vec3 gap = at(u).point - from_M_;
  const double square = way_M_.squaredNorm();
  return square > 0.0 ? (gap - gap.dot(way_M_) / square * way_M_).norm() : gap.norm();
}

Peak SingularityModel::greatest_deviation() const {
  const Vec3 across = e_.cross(way_M_);
  const double width = across.norm();
  const auto measure = [&](double u) -> MeasureAt {
    const State state = at(u);
    const Vec3 gap = state.point - from_M_;
    if (width > 0.0) {
      const double height = gap.dot(across) / width, rate = state.rate.dot(across) / width;
      return height < 0.0 ? MeasureAt{-height, -rate} : MeasureAt{height, rate};
    }
    const Vec3 in_plane = gap - gap.dot(e_) * e_;  // the line stands along e: a point in the projection
    const double value = in_plane.norm();
    return {value, value > 0.0 ? in_plane.dot(state.rate) / value : 0.0};
  };
  const auto across_e = [&](const Vec3& v) { return (v - v.dot(e_) * e_).norm(); };
  const double arm = std::max(across_e(m0_), across_e(m0_ + dm_));
  const double bend = du_ * du_ * arm + 2.0 * std::abs(du_) * across_e(dm_);
  Peak peak = greatest(measure, bend, kModelPeakTolerance);
  const double beyond_projection = peak.proven - peak.value;
  peak.value = deviation(peak.u);
  peak.proven = peak.value + beyond_projection;
  return peak;
}

PolarForm SingularityModel::polar() const {
  const Vec2 m0(m0_.dot(x_), m0_.dot(y_)), dm(dm_.dot(x_), dm_.dot(y_));
  const double cross = m0.x() * dm.y() - m0.y() * dm.x();
  PolarForm form;
  form.a = dm.norm();
  form.s = cross > 0.0 ? 1.0 : cross < 0.0 ? -1.0 : 0.0;
  if (form.a == 0.0) {
    form.d = m0.norm();
    return form;
  }
  form.k = -m0.dot(dm) / dm.squaredNorm();
  form.a0 = -form.k * form.a;
  form.d = std::abs(cross) / form.a;
  form.phi = std::atan2(dm.y(), dm.x());
  return form;
}

}  // namespace swarf::kinematics
