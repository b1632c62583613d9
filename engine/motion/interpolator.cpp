#include "motion/interpolator.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/check.h"
#include "base/units.h"
#include "kinematics/reach.h"
#include "kinematics/rotary_pair.h"
#include "motion/block_interpolator.h"
#include "motion/block_run.h"
#include "motion/block_turns.h"
#include "motion/free_move.h"
#include "motion/motion_statistics.h"
#include "motion/pass_geometry.h"
#include "motion/pole_turn.h"
#include "motion/surface_interpolator.h"

namespace swarf::motion {
namespace {

using kinematics::Branch;
using kinematics::InverseOutcome;
using toolpath::FreeMove;
using toolpath::SurfacePass;
using Clock = std::chrono::steady_clock;

/// Cycles beyond which the samples would fill the memory: five and a half hours at 1 ms.
constexpr double kCyclesMax = 2e7;
constexpr double kCycleBytes = sizeof(ToolSample) + sizeof(kinematics::AxisValues);
/// Elements must follow each other without a gap, mm and (per unit axis) rad.
constexpr double kJoinTolerance = 1e-6;

/// Collects samples and solves the inverse for each.
class Recorder {
 public:
  Recorder(const toolpath::ToolPath& path, std::span<const kinematics::MachineModel> by_tool,
           const cutter::Cutter& cutter, const MotionOptions& options)
      : path_(path),
        machine_(by_tool.front()),
        cutter_(cutter),
        options_(options),
        inverses_(by_tool.begin(), by_tool.end()) {
    result_.trajectory.period_s = options.period_s;
    for (size_t i = 0; i < machine_.axes.size(); ++i)
      q_[static_cast<Eigen::Index>(i)] = machine_.axes[i].home;
  }

  void run(int element) {
    element_ = element;
    const auto& what = path_.elements[static_cast<size_t>(element)].what;
    if (const auto* move = std::get_if<FreeMove>(&what)) {
      if (move->feed_mm_s > 0.0) check_cycles((move->to.tip_W - move->from.tip_W).norm(), move->feed_mm_s);
      start_at(move->from, SampleKind::kRapid, {move->from.tip_W});
      for (ToolSample& sample : sample_free_move(*move, machine_, inverse(), options_, q_)) record(sample);
    } else {
      run_pass(std::get<SurfacePass>(what));
    }
    report_outside_reach();
  }

  /// The blocks [first, end) of a program, which are one run.
  void run_blocks(const std::vector<BlockMotion>& motions, size_t first, size_t end) {
    element_ = static_cast<int>(first);
    const toolpath::BlockMove& block = *motions[first].block;
    tool_in_spindle_ = block.tool;
    // Another tool's tip stands elsewhere.
    joins_ = first == 0 || motions[first - 1].block->tool == block.tool;
    const SampleKind kind = is_rapid(block) ? SampleKind::kRapid : SampleKind::kCutting;
    const bool starts = result_.trajectory.samples.empty() || !joins_;
    start_at(block.from, kind, {block.from.tip_W});
    if (starts && block.axes) result_.trajectory.axes.back() = q_ = block.axes->from;
    if (starts && !block.axes && inverse().pole_distance(block.from.axis_W) < kinematics::kPoleTolerance)
      result_.trajectory.axes.back() = q_ = motions[first].q_from;
    stand(block, kind);
    if (!starts && turns_at_rest(motions[first - 1], motions[first])) turn_at_pole(motions[first], kind);
    const PlannedRun run = plan_run(motions, first, end, inverse(), options_);
    add_cycles(run.duration_s, "moves");
    RunSampler sampler(run, options_.period_s);
    result_.trajectory.samples.reserve(grown(sampler.ticks()));
    result_.trajectory.axes.reserve(grown(sampler.ticks()));
    for (BlockTick tick; sampler.next(tick);) {
      if (tick.sample.element != element_) report_outside_reach();
      element_ = tick.sample.element;
      if (tick.followed) {
        record(tick.sample, {tick.q, InverseOutcome::kOk});
      } else {
        record(tick.sample);
      }
    }
    report_outside_reach();
  }

  MotionResult finish(const std::vector<BlockMotion>& motions) {
    result_.statistics = measure_motion(result_.trajectory, path_, motions, machine_, inverse(), cutter_);
    rank_tick_costs();
    for (MotionFinding& fault : find_axis_faults(result_.trajectory, path_, machine_))
      result_.findings.push_back(std::move(fault));
    for (MotionFinding& warning : find_fast_turns(path_, motions, options_)) {
      warning.t_s = first_time(warning.element);
      result_.findings.push_back(std::move(warning));
    }
    std::stable_sort(result_.findings.begin(), result_.findings.end(),
                     [](const MotionFinding& a, const MotionFinding& b) { return a.element < b.element; });
    return std::move(result_);
  }

 private:
  void run_pass(const SurfacePass& pass) {
    check_cycles(pass_length(pass, pass.t_start, pass.t_end), pass.feed_mm_s);
    const toolpath::CurvePoint start = curve_at(*pass.surface, pass.curve, pass.t_start);
    start_at(contact_pose(pass, pass.t_start, cutter_.radius()), SampleKind::kCutting,
             {start.C, start.u, start.v});
    if (options_.mode == Mode::kOffline) {
      for (ToolSample& sample : sample_offline_pass(pass, cutter_, machine_, inverse(), options_, q_))
        record(sample);
    } else {
      run_in_real_time(pass);
    }
  }

  void run_in_real_time(const SurfacePass& pass) {
    SurfaceInterpolator interpolator(machine_, inverse(), cutter_, options_);
    interpolator.begin(pass, q_);
    StepOutput out;
    while (!out.finished) {
      const auto begin = Clock::now();
      interpolator.step({}, out);
      const Branch branch = inverse().solve_nearest(out.pose, q_);
      const auto end = Clock::now();
      tick_ns_.push_back(std::chrono::duration<double, std::nano>(end - begin).count());
      ToolSample sample;
      sample.pose = out.pose;
      sample.contact_W = out.contact_W;
      sample.u = out.u;
      sample.v = out.v;
      sample.feed_mm_s = out.feed_mm_s;
      sample.kind = SampleKind::kCutting;
      record(sample, branch);
    }
  }

  /// Of the first sample in the element, or behind it when it is shorter than a cycle.
  double first_time(int element) const {
    const std::vector<ToolSample>& samples = result_.trajectory.samples;
    const auto first =
        std::lower_bound(samples.begin(), samples.end(), element,
                         [](const ToolSample& one, int sought) { return one.element < sought; });
    return first == samples.end() ? result_.statistics.time_s : first->t_s;
  }

  const kinematics::InverseKinematics& inverse() const {
    return inverses_[inverses_.size() == 1 ? 0 : static_cast<size_t>(tool_in_spindle_)];
  }

  /// The dwell of a block before it moves.
  void stand(const toolpath::BlockMove& block, SampleKind kind) {
    add_cycles(block.dwell_s, "dwells");
    const double ticks = std::ceil(block.dwell_s / options_.period_s * (1.0 - 1e-12));
    for (double k = 0.0; k < ticks; ++k) {
      ToolSample sample;
      sample.pose = block.from;
      sample.contact_W = block.from.tip_W;
      sample.kind = kind;
      record(sample, {q_, InverseOutcome::kOk});
    }
  }

  /// The tool stands while the rotary axes turn to where the block needs them.
  void turn_at_pole(const BlockMotion& motion, SampleKind kind) {
    const PoleTurn turn(inverse(), *motion.machine, motion.block->from, q_, motion.q_from);
    add_cycles(turn.duration_s(), "turns at the pole");
    const double ticks = std::ceil(turn.duration_s() / options_.period_s * (1.0 - 1e-12));
    for (double k = 1.0; k <= ticks; ++k) {
      ToolSample sample;
      sample.pose = motion.block->from;
      sample.contact_W = sample.pose.tip_W;
      sample.kind = kind;
      record(sample, {turn.at(k * options_.period_s), InverseOutcome::kOk});
    }
  }

  /// Samples to make room for, so that many runs do not copy what is there many times.
  size_t grown(size_t more) const {
    const size_t now = result_.trajectory.samples.size(), room = result_.trajectory.samples.capacity();
    return now + more <= room ? room : std::max(now + more, room + room / 2);
  }

  struct Contact {
    Vec3 point_W = Vec3::Zero();
    double u = 0.0, v = 0.0;
  };

  /// Records the very first pose and that of a new tool; others must be where the element before ended.
  void start_at(const ToolPose& pose, SampleKind kind, const Contact& at) {
    if (result_.trajectory.samples.empty() || !joins_) {
      ToolSample sample;
      sample.pose = pose;
      sample.contact_W = at.point_W;
      sample.kind = kind;
      sample.u = at.u;
      sample.v = at.v;
      record(sample);
      return;
    }
    const ToolPose& before = result_.trajectory.samples.back().pose;
    SWARF_CHECK((before.tip_W - pose.tip_W).norm() <= kJoinTolerance &&
                    (before.axis_W - pose.axis_W).norm() <= kJoinTolerance,
                fmt::format("element {} does not start where the one before ends", element_));
  }

  void record(ToolSample& sample) { record(sample, inverse().solve_nearest(sample.pose, q_)); }

  void record(ToolSample& sample, const Branch& branch) {
    sample.t_s = static_cast<double>(result_.trajectory.samples.size()) * options_.period_s;
    sample.element = element_;
    sample.tool = static_cast<int16_t>(tool_in_spindle_);
    if (branch.outcome != InverseOutcome::kUnreachable) {
      q_ = branch.q;
    } else if (outside_reach_++ == 0) {
      outside_since_s_ = sample.t_s;
      outside_pose_ = sample.pose;
    }
    result_.trajectory.samples.push_back(sample);
    result_.trajectory.axes.push_back(q_);
  }

  void report_outside_reach() {
    if (outside_reach_ == 0) return;
    const kinematics::UnreachableText why = kinematics::unreachable_text(machine_, outside_pose_);
    result_.findings.push_back(
        {"unreachable",
         fmt::format("its axes stood still for {} cycles, from the first pose out of reach: {}; {}",
                     outside_reach_, why.text, why.fix),
         element_, outside_since_s_, path_.elements[static_cast<size_t>(element_)].where});
    outside_reach_ = 0;
  }

  /// Refuses a feed move that alone would take too many cycles, before it is planned.
  void check_cycles(double length, double feed_mm_s) const {
    const double cycles = length / (feed_mm_s * options_.period_s);
    if (cycles <= kCyclesMax) return;
    throw InputError(
        "too-many-cycles", path_.elements[static_cast<size_t>(element_)].where,
        fmt::format("{:.3f} mm at {:g} mm/min take {:.3g} cycles of {:g} ms, more than {:g}", length,
                    mm_min_from_mm_s(feed_mm_s), cycles, options_.period_s * 1e3, kCyclesMax),
        fmt::format("raise F above {:.3g} mm/min, or the period",
                    mm_min_from_mm_s(length / (kCyclesMax * options_.period_s))));
  }

  /// Refuses what would make the whole program too long, before its samples take memory.
  void add_cycles(double seconds, const char* what) {
    time_s_ += seconds;
    const double cycles = time_s_ / options_.period_s;
    if (cycles <= kCyclesMax) return;
    throw InputError(
        "too-many-cycles", path_.elements[static_cast<size_t>(element_)].where,
        fmt::format(
            "the program {} for {:.3g} h up to here: {:.3g} cycles of {:g} ms, more than {:g} ({:.1f} GB)",
            what, time_s_ / 3600.0, cycles, options_.period_s * 1e3, kCyclesMax,
            kCyclesMax * kCycleBytes / 1e9),
        fmt::format("a period_ms of {:.2g} or more, or a shorter program",
                    std::ceil(10.0 * time_s_ / kCyclesMax * 1e3) / 10.0));
  }

  void rank_tick_costs() {
    if (tick_ns_.empty()) return;
    const auto rank = [&](double share) {
      const auto at =
          tick_ns_.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(tick_ns_.size() - 1));
      std::nth_element(tick_ns_.begin(), at, tick_ns_.end());
      return *at;
    };
    result_.statistics.tick_ns_median = rank(0.5);
    result_.statistics.tick_ns_p999 = rank(0.999);
  }

  const toolpath::ToolPath& path_;
  const kinematics::MachineModel& machine_;
  const cutter::Cutter& cutter_;
  const MotionOptions& options_;
  std::vector<kinematics::InverseKinematics> inverses_;  ///< by tool, or one for whatever tool
  int tool_in_spindle_ = 0;
  bool joins_ = true;  ///< the element starts where the one before ended
  kinematics::AxisValues q_ = kinematics::AxisValues::Zero();
  int element_ = 0;
  double time_s_ = 0.0;  ///< of the blocks so far
  size_t outside_reach_ = 0;
  double outside_since_s_ = 0.0;
  ToolPose outside_pose_;
  std::vector<double> tick_ns_;
  MotionResult result_;
};

void throw_if_invalid(const MotionOptions& options) {
  Diagnostics diagnostics;
  for (const std::string& problem : validate(options)) diagnostics.error("bad-options", {}, problem, "");
  diagnostics.throw_if_errors();
}

}  // namespace

std::vector<std::string> validate(const MotionOptions& options) {
  std::vector<std::string> problems;
  const auto positive = [&](double value, const char* name, const char* unit) {
    if (!(value > 0.0) || !std::isfinite(value))
      problems.push_back(fmt::format("{} must be a number above 0 {}, it is {:g}", name, unit, value));
  };
  positive(options.period_s, "period_s", "s");
  positive(options.path_acceleration_max, "path_acceleration_max", "mm/s^2");
  positive(options.path_jerk_max, "path_jerk_max", "mm/s^3");
  positive(options.corner_tolerance_mm, "corner_tolerance_mm", "mm");
  positive(options.fast_rotary_rad_mm, "fast_rotary_rad_mm", "rad/mm");
  positive(options.swing_rad, "swing_rad", "rad");
  return problems;
}

MotionResult interpolate(const toolpath::ToolPath& path, std::span<const kinematics::MachineModel> by_tool,
                         const cutter::Cutter& cutter, const MotionOptions& options, Progress& progress) {
  throw_if_invalid(options);
  Recorder recorder(path, by_tool, cutter, options);
  const bool blocks = toolpath::holds_blocks(path);
  const std::vector<BlockMotion> motions = blocks ? block_motions(path, by_tool) : std::vector<BlockMotion>{};
  progress.begin("interpolate", static_cast<double>(path.elements.size()), "elements");
  for (size_t i = 0; i < path.elements.size() && !progress.stop_requested();) {
    if (blocks) {
      const size_t end = run_end(motions, i);
      recorder.run_blocks(motions, i, end);
      i = end;
    } else {
      recorder.run(static_cast<int>(i++));
    }
    progress.advance(static_cast<double>(i));
  }
  progress.end();
  return recorder.finish(motions);
}

}  // namespace swarf::motion
