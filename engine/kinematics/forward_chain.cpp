#include "kinematics/forward_chain.h"

#include <algorithm>
#include <cmath>

#include "kinematics/chain.h"
#include "kinematics/lane_pair.h"
#include "kinematics/model_check.h"

namespace swarf::kinematics {

ForwardChain::ForwardChain(const MachineModel& machine)
    : tip_M_(machine.tip_M), axis_M_(machine.tool_axis_M), X_MW_(machine.X_MW) {
  from_tool_to_work(machine, [&](const LinkStep& step) { steps_.push_back(step); });
  const std::vector<int> rotary = rotary_order(machine);
  for (size_t i = 0; i < 2 && !rotary.empty(); ++i) rotary_[i] = rotary[std::min(i, rotary.size() - 1)];
}

struct ForwardLanes {
  /// Sines of both rotary values; those out of the lanes' range by the library.
  template <int N>
  SWARF_KERNEL_INLINE static void sines(const Numbers<N>& angle, Numbers<N>& sine, Numbers<N>& cosine) {
    lanes::sines<N>(angle, sine, cosine);
    for (int lane = 0; lane < N; ++lane) {
      if (std::abs(angle[lane]) <= kLaneRange) continue;
      sine[lane] = std::sin(angle[lane]);
      cosine[lane] = std::cos(angle[lane]);
    }
  }

  /// In the order in which Eigen adds for a matrix that is turned over.
  template <int N>
  SWARF_KERNEL_INLINE static LanePoints<N> turned_back(const Mat3& m, const LanePoints<N>& p) {
    const auto row = [&](int i) { return m(0, i) * p.x + (m(1, i) * p.y + m(2, i) * p.z); };
    return {row(0), row(1), row(2)};
  }

  /// The first poses, N at most; returns how many.
  template <int N>
  SWARF_KERNEL_INLINE static size_t some(const ForwardChain& chain, std::span<const AxisValues> q,
                                         std::span<ToolPose> poses_W) {
    const size_t count = std::min<size_t>(q.size(), N);
    double rows[kMaxAxes][N];
    for (size_t lane = 0; lane < N; ++lane)
      for (int i = 0; i < kMaxAxes; ++i) rows[i][lane] = q[std::min(lane, count - 1)][i];
    Numbers<N> value[kMaxAxes], sine[2], cosine[2];
    for (int i = 0; i < kMaxAxes; ++i) value[i] = lanes::same_bits<Numbers<N>>(rows[i]);
    for (int slot = 0; slot < 2; ++slot) sines<N>(value[chain.rotary_[slot]], sine[slot], cosine[slot]);
    LanePoints<N> tip = spread<N>(chain.tip_M_), axis = spread<N>(chain.axis_M_);
    for (const LinkStep& step : chain.steps_) {
      if (!step.rotary) {
        tip = tip + (step.sense * value[step.axis]) * spread<N>(step.direction);
        continue;
      }
      const int slot = step.axis == chain.rotary_[0] ? 0 : 1;
      const Numbers<N> s = step.sense * sine[slot];
      const LanePoints<N> origin = spread<N>(step.origin);
      tip = origin + rotate<N>(step.along, step.direction, s, cosine[slot], tip - origin);
      axis = rotate<N>(step.along, step.direction, s, cosine[slot], axis);
    }
    const Mat3 from_M = chain.X_MW_.linear();
    const LanePoints<N> shift = spread<N>(Vec3(chain.X_MW_.translation()));
    const LanePoints<N> tip_W = turned_back<N>(from_M, tip - shift), axis_W = turned_back<N>(from_M, axis);
    for (size_t lane = 0; lane < count; ++lane) {
      poses_W[lane].tip_W = {tip_W.x[lane], tip_W.y[lane], tip_W.z[lane]};
      poses_W[lane].axis_W = {axis_W.x[lane], axis_W.y[lane], axis_W.z[lane]};
    }
    return count;
  }

  template <int N>
  SWARF_KERNEL_INLINE static void all(const ForwardChain& chain, std::span<const AxisValues> q,
                                      std::span<ToolPose> poses_W) {
    for (size_t i = 0; i < q.size();) i += some<N>(chain, q.subspan(i), poses_W.subspan(i));
  }
};

namespace {

SWARF_X86_64_V4_WIDE void eight(const ForwardChain& chain, std::span<const AxisValues> q,
                                std::span<ToolPose> poses_W) {
  ForwardLanes::all<8>(chain, q, poses_W);
}
SWARF_X86_64_V3 void four(const ForwardChain& chain, std::span<const AxisValues> q,
                          std::span<ToolPose> poses_W) {
  ForwardLanes::all<4>(chain, q, poses_W);
}
void two(const ForwardChain& chain, std::span<const AxisValues> q, std::span<ToolPose> poses_W) {
  ForwardLanes::all<2>(chain, q, poses_W);
}

}  // namespace

std::span<const ForwardKernel> forward_kernel_variants() {
  static const std::vector<ForwardKernel> variants = runnable<ForwardKernel>(&eight, &four, &two);
  return variants;
}

void ForwardChain::at(std::span<const AxisValues> q, std::span<ToolPose> poses_W) const {
  forward_kernel_variants().front()(*this, q, poses_W);
}

}  // namespace swarf::kinematics
