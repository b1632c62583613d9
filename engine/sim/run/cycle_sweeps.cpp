#include "sim/run/cycle_sweeps.h"

namespace swarf::sim {

bool one_sweep_each_cycle(const Job& job) {
  return job.scene.stock.cut_by == CutBy::kPasses && job.driven == nullptr;
}

/// The nodes lie half way between the cycles, where the joint-linear motion of the axes strays most from the
/// path. Each sweep ends in its own cycle until the next one is known.
void CycleSweeps::add(std::span<const motion::Cycle> window) {
  for (const motion::Cycle& cycle : window) {
    const motion::ToolSample& sample = cycle.sample;
    if (all_.sweeps.empty()) {
      node_ = sample.pose;
    } else {
      node_ = kinematics::forward(machine_, 0.5 * (q_ + cycle.q));
      all_.sweeps.back().end = node_;
    }
    all_.sweeps.push_back({node_, sample.pose, static_cast<uint32_t>(all_.sweeps.size())});
    all_.sources.push_back({sample.element, sample.tool, sample.u, cycle.number});
    q_ = cycle.q;
  }
}

}  // namespace swarf::sim
