#include "sim/run/flank_machines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cutter/cutter.h"
#include "kinematics/machine_model.h"
#include "machine/shipped.h"
#include "motion/interpolator.h"
#include "sim/job/flank_job.h"
#include "sim/run/flank_rays.h"

namespace swarf::sim {
namespace {

using kinematics::AxisValues;
using kinematics::MachineModel;

constexpr double kTableHeight = 100.0;  // mm, as of "on_table"

int rotary_axes(const MachineModel& machine) {
  return static_cast<int>(
      std::count_if(machine.axes.begin(), machine.axes.end(),
                    [](const kinematics::Axis& axis) { return axis.kind == kinematics::AxisKind::kRotary; }));
}

MachineModel with_work(MachineModel machine, const Job& job) {
  const Box& box = job.scene.stock.box_W;
  const Vec3 foot(box.centre().x(), box.centre().y(), box.lower.z());
  machine.X_MW.translation() += Vec3(0.0, 0.0, kTableHeight) - machine.X_MW.linear() * foot;
  return kinematics::with_tool(machine, cutter::gauge_length(job.scene.tools.front()));
}

/// Which axis is how near to which limit, cycle by cycle.
class Limits {
 public:
  explicit Limits(const MachineModel& machine, double period_s) : machine_(machine), period_(period_s) {
    last_.fill(AxisValues::Zero());
    counts_.assign(machine.axes.size(), {});
  }
  void add(const AxisValues& q) {
    std::rotate(last_.begin(), last_.begin() + 1, last_.end());
    last_[3] = q;
    if (++seen_ < 4) return;
    const AxisValues v = (last_[3] - last_[2]) / period_,
                     a = (last_[3] - 2.0 * last_[2] + last_[1]) / (period_ * period_),
                     j = (last_[3] - 3.0 * last_[2] + 3.0 * last_[1] - last_[0]) / std::pow(period_, 3);
    double most = 0.0;
    size_t axis = 0, kind = 0;
    for (size_t i = 0; i < machine_.axes.size(); ++i) {
      const kinematics::Axis& own = machine_.axes[i];
      const auto row = static_cast<Eigen::Index>(i);
      const std::array<double, 3> used{std::abs(v[row]) / own.speed_max,
                                       std::abs(a[row]) / own.acceleration_max,
                                       std::abs(j[row]) / own.jerk_max};
      for (size_t k = 0; k < used.size(); ++k)
        if (used[k] > most) most = used[k], axis = i, kind = k;
    }
    ++cycles_;
    constexpr double kNear = 0.4;  // plans keep a share of acceleration and jerk for changes of speed
    if (most >= kNear) ++counts_[axis][kind];
  }
  /// Between passes nothing is counted.
  void interrupt() { seen_ = 0; }
  void tell(FlankMachineRow& row) const {
    static constexpr std::array<const char*, 3> kNames{"speed", "acceleration", "jerk"};
    size_t most = 0;
    for (size_t i = 0; i < counts_.size(); ++i) {
      for (size_t k = 0; k < kNames.size(); ++k) {
        if (counts_[i][k] <= most) continue;
        most = counts_[i][k];
        row.limiting = machine_.axes[i].name + " " + kNames[k];
      }
    }
    if (most == 0) row.limiting = "none: the feed";
    row.limiting_share = cycles_ > 0 ? static_cast<double>(most) / static_cast<double>(cycles_) : 0.0;
  }

 private:
  const MachineModel& machine_;
  double period_;
  std::array<AxisValues, 4> last_{};
  size_t seen_ = 0, cycles_ = 0;
  std::vector<std::array<size_t, 3>> counts_;
};

/// The first thing that is out of reach; "": nothing.
std::string out_of_reach(const MachineModel& machine, const motion::Cycle& cycle) {
  if (!cycle.reached) {
    const Vec3& p = cycle.sample.pose.tip_W;
    return fmt::format("({:.1f}, {:.1f}, {:.1f}) mm is out of reach", p.x(), p.y(), p.z());
  }
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const kinematics::Axis& axis = machine.axes[i];
    const double q = cycle.q[static_cast<Eigen::Index>(i)];
    if (q >= axis.min - 1e-9 && q <= axis.max + 1e-9) continue;
    return fmt::format("{} leaves its travel", axis.name);
  }
  return "";
}

void look_at_cycles(const MachineModel& machine, const motion::Cycles& cycles, FlankMachineRow& row) {
  Limits limits(machine, cycles.period_s());
  motion::CycleReader reader(cycles);
  for (size_t k = 0; k < cycles.size(); ++k) {
    const motion::Cycle cycle = reader.at(k);
    if (row.unreached.empty()) row.unreached = out_of_reach(machine, cycle);
    if (cycles.elements().block(static_cast<size_t>(cycle.sample.element)).pass < 0)
      limits.interrupt();
    else
      limits.add(cycle.q);
  }
  row.reached = row.unreached.empty();
  limits.tell(row);
}

FlankMachineRow machine_row(const Job& job, const std::string& name, const MachineModel& machine,
                            toolpath::BlockLaw law, const std::vector<stock::SurfaceDexels>& dexels) {
  FlankMachineRow row;
  row.machine = name;
  const bool curve = job.flank.front().curve != nullptr;
  row.law = curve ? toolpath::law_name(toolpath::BlockLaw::kCurve) : toolpath::law_name(law);
  std::vector<flank::FlankPass> passes = job.flank;
  for (flank::FlankPass& pass : passes) pass.motion.law = law;
  const std::vector<MachineModel> machines{machine};
  try {
    motion::Cycles cycles(flank::flank_path(passes, flank_rule(job)).elements, machines,
                          job.scene.tools.front(), job.scene.motion);
    Progress silent;
    row.time_s = motion::interpolate(cycles, silent).statistics.time_s;
    look_at_cycles(machine, cycles, row);
    if (!row.reached) return row;
    const std::vector<PosedPass> poses = cycle_poses(job, cycles);
    for (size_t s = 0; s < dexels.size(); ++s) {
      for (const std::optional<double>& height : heights_of({job, poses, s}, dexels[s])) {
        if (!height) continue;
        row.least_mm = std::min(row.least_mm, *height);
        row.greatest_mm = std::max(row.greatest_mm, *height);
      }
    }
  } catch (const InputError& error) {
    row.unreached = error.diagnostics.list().front().text;
  }
  return row;
}

}  // namespace

std::vector<FlankMachineRow> flank_machines(const Job& job, const std::vector<stock::SurfaceDexels>& dexels) {
  using toolpath::BlockLaw;
  const bool curve = job.flank.front().curve != nullptr;
  std::vector<FlankMachineRow> rows;
  for (const machine::ShippedMachine& shipped : machine::shipped_machines()) {
    const MachineModel own = machine::load_machine(shipped.file).model;
    if (rotary_axes(own) < 2) continue;
    const MachineModel machine = with_work(own, job);
    for (const BlockLaw law : {BlockLaw::kTcp, BlockLaw::kJoint}) {
      rows.push_back(machine_row(job, shipped.name, machine, law, dexels));
      if (curve) break;
    }
  }
  return rows;
}

}  // namespace swarf::sim
