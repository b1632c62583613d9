#include "motion/speed/look_ahead.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/check.h"
#include "motion/speed/hop_split.h"

namespace swarf::motion {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
/// Shares of an axis' acceleration and jerk that a curved cell may use at its speed without changing it.
constexpr double kCurvatureShare = 0.7, kThirdShare = 0.5;
/// A corner stays passable while accelerating when it leaves these shares of acceleration and jerk.
constexpr double kLeftShare = 0.5;
constexpr int kRoundsMax = 200;
/// Share of a hop's time that parts must promise to save.
constexpr double kTight = 0.08;
/// Hops that are parted together.
constexpr size_t kHopsAtOnce = 8;
/// Rounds that slow one cell of each hop.
constexpr int kOneByOne = 24;

/// What lies between two keys.
struct Gap {
  double length = 0.0;
  RampLimits limits{kNone, kNone};
  void add(const Gap& other) {
    length += other.length;
    limits.acceleration = std::min(limits.acceleration, other.limits.acceleration);
    limits.jerk = std::min(limits.jerk, other.limits.jerk);
  }
};

/// A place of given speed without acceleration: cells [begin, end), or the node before `begin` when empty.
struct Key {
  size_t begin = 0, end = 0;
  double speed = 0.0;
  bool kept = false;  ///< is slowed down, never dropped
  Gap before;         ///< from the key before
};

/// A hop that keeps the speeds of its cells, with all that it was made from besides Planner::used_.
struct Hop {
  size_t begin = 0, end = 0;  ///< cells
  double from = 0.0, to = 0.0, length = 0.0;
  RampLimits limits;
  size_t first_phase = 0, phases = 0;
};

class Planner {
 public:
  Planner(const std::vector<PathCell>& cells, const AxisLimits& limits, const PlanStart& start)
      : cells_(cells), limits_(limits), start_(start), forced_(cells.size() + 1, kNone) {
    for (const PathCell& cell : cells) {
      SWARF_CHECK(cell.length > 0.0 && cell.speed > 0.0 && std::isfinite(cell.speed),
                  "a cell has a length and a speed");
      own_.push_back(left_at(cell, cell.speed, limits));
      if (cell.stop) forced_[own_.size()] = 0.0;
    }
  }

  std::optional<CellPlan> plan() {
    for (round_ = 0; round_ < kRoundsMax; ++round_) {
      choose_keys();
      if (too_fast_) return std::nullopt;
      if (!place_phases()) continue;
      part_tight_hops();
      return std::move(plan_);
    }
    SWARF_CHECK(too_fast_, "no plan keeps the speeds of the cells");
    return std::nullopt;
  }

 private:
  double top(size_t cell) const { return cells_[cell].speed; }

  Gap gap_of(size_t cell, double v, const RampLimits& left) {
    used_[cell] = v;
    return {cells_[cell].length, left};
  }

  void choose_keys() {
    const size_t n = cells_.size();
    keys_.assign(1, {0, 0, start_.speed, true, {}});
    pending_ = {};
    used_before_.swap(used_);
    used_.assign(n, 0.0);
    for (size_t i = 0; i < n; ++i) {
      const double left = i > 0 ? top(i - 1) : start_.top_before, right = i + 1 < n ? top(i + 1) : kNone;
      const bool corner = cells_[i].corner;
      const bool least = !corner && top(i) <= left && top(i) <= right;
      if (i > 0) add_node(i, least || is_least(i - 1) ? std::min(left, top(i)) : kNone);
      if (corner) {
        push({i, i + 1, std::min({top(i), left, right}), false, {}});
      } else {
        pending_.add(gap_of(i, top(i), own_[i]));
      }
    }
    push({n, n, 0.0, true, {}});
  }

  bool is_least(size_t i) const {
    if (cells_[i].corner) return false;
    const double left = i > 0 ? top(i - 1) : start_.top_before;
    return top(i) <= left && (i + 1 == cells_.size() || top(i) <= top(i + 1));
  }

  /// The node before cell i as a key: because it bounds a cell of least speed, or because it must be one.
  void add_node(size_t i, double speed) {
    if (std::isfinite(forced_[i])) {
      push({i, i, std::min(forced_[i], speed), true, {}});
    } else if (std::isfinite(speed)) {
      push({i, i, speed, false, {}});
    }
  }

  /// Takes the gap that has gathered as what lies before the key.
  void push(Key key) {
    key.before = pending_;
    pending_ = {};
    place(key);
  }

  void place(Key key) {
    for (;;) {
      Key& last = keys_.back();
      const Gap& gap = key.before;
      if (ramp_length(last.speed, key.speed, gap.limits) <= gap.length || last.speed == key.speed) break;
      if (key.speed > last.speed) {
        if (drop(key, last.speed, gap)) {
          pending_.add(key.before);
          return;
        }
        key.speed = reachable_speed(last.speed, gap.length, key.speed, gap.limits);
        break;
      }
      if (keys_.size() == 1) {
        too_fast_ = true;
        break;
      }
      Key slower = last;
      keys_.pop_back();
      if (drop(slower, key.speed, gap)) {
        slower.before.add(key.before);
        key.before = slower.before;
        continue;
      }
      slower.speed = reachable_speed(key.speed, gap.length, slower.speed, gap.limits);
      place(slower);
      Gap joined = pending_;
      pending_ = {};
      joined.add(key.before);
      key.before = joined;
    }
    keys_.push_back(key);
  }

  /// Turns the key into a part of the gap before it; false when it must stay. `from`: speed at the other end
  /// of the gap that is too short.
  bool drop(Key& key, double from, const Gap& gap) {
    if (key.kept) return false;
    if (key.begin == key.end) return true;
    const PathCell& cell = cells_[key.begin];
    const RampLimits still = left_at(cell, 0.0, limits_);
    const double acceleration = std::min(gap.limits.acceleration, still.acceleration);
    const double v =
        std::min(key.speed, std::sqrt(from * from + 2.0 * acceleration * (gap.length + cell.length)));
    const RampLimits left = left_at(cell, v, limits_);
    if (left.acceleration < kLeftShare * still.acceleration || left.jerk < kLeftShare * still.jerk)
      return false;
    key.before.add(gap_of(key.begin, v, left));
    return true;
  }

  /// False when a cell was passed too fast: it has become forced.
  bool place_phases() {
    phases_before_.swap(plan_.phases);
    hops_before_.swap(hops_);
    plan_ = {};
    hops_.clear();
    next_before_ = 0;
    bool holds = true;
    for (size_t k = 1; k < keys_.size(); ++k) {
      const Key &a = keys_[k - 1], &b = keys_[k];
      if (b.before.length > 0.0) holds = (place_again(a, b) || place_hop(a, b)) && holds;
      if (b.begin != b.end) {
        const PathCell& cell = cells_[b.begin];
        plan_.phases.push_back({{cell.length / b.speed, b.speed, 0.0, 0.0}, b.begin, 0.0});
      }
      plan_.places.push_back({b.end, b.speed, plan_.phases.size()});
    }
    return holds;
  }

  /// What the round before has placed here stands when all that it was made from is the same; false when
  /// something is not.
  bool place_again(const Key& a, const Key& b) {
    while (next_before_ < hops_before_.size() && hops_before_[next_before_].begin < a.end) ++next_before_;
    if (next_before_ == hops_before_.size()) return false;
    Hop hop = hops_before_[next_before_];
    const RampLimits &now = b.before.limits, &then = hop.limits;
    if (hop.begin != a.end || hop.end != b.begin || hop.from != a.speed || hop.to != b.speed ||
        hop.length != b.before.length || now.acceleration != then.acceleration || now.jerk != then.jerk)
      return false;
    const auto range = [&](const auto& list, size_t from) {
      return list.begin() + static_cast<std::ptrdiff_t>(from);
    };
    if (!std::equal(range(used_, hop.begin), range(used_, hop.end), range(used_before_, hop.begin)))
      return false;
    const size_t first = plan_.phases.size();
    plan_.phases.insert(plan_.phases.end(), range(phases_before_, hop.first_phase),
                        range(phases_before_, hop.first_phase + hop.phases));
    hop.first_phase = first;
    hops_.push_back(hop);
    return true;
  }

  bool place_hop(const Key& a, const Key& b) {
    double fastest = 0.0;
    for (size_t i = a.end; i < b.begin; ++i) fastest = std::max(fastest, used_[i]);
    hop_.clear();
    const double peak = append_hop(a.speed, b.speed, b.before.length, fastest, b.before.limits, hop_);
    double offset = 0.0;
    const size_t first = plan_.phases.size();
    for (const Phase& phase : hop_) {
      plan_.phases.push_back({phase, a.end, offset});
      offset += phase.way(phase.duration);
    }
    if (!holds_in(a, b, peak)) return false;
    hops_.push_back({a.end, b.begin, a.speed, b.speed, b.before.length, b.before.limits, first, hop_.size()});
    return true;
  }

  /// Looks for the slowest cell of the hop that is passed too fast and makes its ends keys; after many rounds
  /// those of every such cell.
  bool holds_in(const Key& a, const Key& b, double peak) {
    double s = 0.0;
    std::optional<size_t> worst;
    for (size_t i = a.end; i < b.begin; ++i) {
      const double from = s;
      s += cells_[i].length;
      if (used_[i] * (1.0 + kSpeedRounding) >= peak) continue;
      const bool slowest = !worst || used_[i] < used_[*worst];
      if (!slowest && round_ < kOneByOne) continue;
      if (!(greatest_speed(hop_, from, s) > used_[i] * (1.0 + kSpeedRounding))) continue;
      if (round_ >= kOneByOne) force_ends(i, a, b);
      if (slowest) worst = i;
    }
    if (!worst) return true;
    force_ends(*worst, a, b);
    return false;
  }

  /// Where the neighbouring key is slow enough already, the other end alone.
  void force_ends(size_t cell, const Key& a, const Key& b) {
    const double most = used_[cell];
    if (cell > a.end || a.speed > most) force(cell, most);
    if (cell + 1 < b.begin || b.speed > most) force(cell + 1, most);
  }
  void force(size_t node, double speed) {
    if (node == 0) too_fast_ = true;
    forced_[node] = std::min(forced_[node], speed);
  }

  /// The hop before a key goes past a pole and takes much more time than its cells ask for.
  bool is_tight(size_t key) const {
    const Key &a = keys_[key - 1], &b = keys_[key];
    const auto cells = std::span(cells_).subspan(a.end, b.begin - a.end);
    if (std::none_of(cells.begin(), cells.end(), [](const PathCell& cell) { return cell.uneven; }))
      return false;
    return least_time_between({cells_, used_, limits_}, node(a), node(b)) <
           (1.0 - kTight) * time_of(first_phase(key), last_phase(key));
  }
  double time_of(size_t first, size_t end) const {
    double time = 0.0;
    for (size_t i = first; i < end; ++i) time += plan_.phases[i].phase.duration;
    return time;
  }
  static EvenNode node(const Key& key) { return {key.begin, key.end, key.speed, 0.0}; }
  size_t first_phase(size_t key) const { return key > 1 ? plan_.places[key - 2].phases : 0; }
  /// Of the hop before the key, without the key's own.
  size_t last_phase(size_t key) const {
    return plan_.places[key - 1].phases - (keys_[key].begin != keys_[key].end ? 1 : 0);
  }

  /// Tight hops together with those beside them, whose common corners they share.
  void part_tight_hops() {
    std::vector<char> tight(keys_.size(), 0);
    for (size_t k = 1; k < keys_.size(); ++k) tight[k] = is_tight(k) ? 1 : 0;
    if (std::find(tight.begin(), tight.end(), 1) == tight.end()) return;
    CellPlan parted;
    for (size_t k = 1; k < keys_.size();) {
      const bool near = tight[k] != 0 || (k + 1 < keys_.size() && tight[k + 1] != 0);
      size_t end = k + 1;
      while (near && end < keys_.size() && end - k < kHopsAtOnce && (tight[end] != 0 || tight[end - 1] != 0))
        ++end;
      append_parted(k, end, near, parted);
      k = end;
    }
    plan_ = std::move(parted);
  }

  /// The hops before keys [from, to), parted where that saves time.
  void append_parted(size_t from, size_t to, bool tight, CellPlan& parted) {
    std::vector<EvenNode> nodes;
    for (size_t k = from - 1; tight && k < to; ++k) nodes.push_back(node(keys_[k]));
    const SpeedOfCells of{cells_, used_, limits_};
    if (!tight || !part_hops(of, time_of(first_phase(from), last_phase(to - 1)), nodes)) {
      for (size_t k = from; k < to; ++k) append_as_it_is(k, parted);
      return;
    }
    for (size_t k = 1; k < nodes.size(); ++k) {
      const EvenNode& at = nodes[k];
      double offset = 0.0;
      hop_between(of, nodes[k - 1], at, hop_);
      for (const Phase& phase : hop_) {
        parted.phases.push_back({phase, nodes[k - 1].end, offset});
        offset += phase.way(phase.duration);
      }
      if (at.begin != at.end)
        parted.phases.push_back({{cells_[at.begin].length / at.speed, at.speed, 0.0, 0.0}, at.begin, 0.0});
      parted.places.push_back({at.end, at.speed, parted.phases.size()});
    }
  }
  void append_as_it_is(size_t key, CellPlan& plan) const {
    const auto begin = plan_.phases.begin();
    plan.phases.insert(plan.phases.end(), begin + static_cast<std::ptrdiff_t>(first_phase(key)),
                       begin + static_cast<std::ptrdiff_t>(plan_.places[key - 1].phases));
    plan.places.push_back(plan_.places[key - 1]);
    plan.places.back().phases = plan.phases.size();
  }

  const std::vector<PathCell>& cells_;
  const AxisLimits& limits_;
  PlanStart start_;
  std::vector<RampLimits> own_;  ///< what each cell leaves at its own speed
  std::vector<double> forced_;   ///< by node: the speed that it must not exceed
  std::vector<double> used_;     ///< by cell of a gap: the speed that its limits hold for
  std::vector<Key> keys_;
  int round_ = 0;
  Gap pending_;
  std::vector<Phase> hop_;
  // Of this round and of the one before it:
  std::vector<Hop> hops_, hops_before_;
  std::vector<PlacedPhase> phases_before_;
  std::vector<double> used_before_;
  size_t next_before_ = 0;  ///< of hops_before_, while phases are placed
  CellPlan plan_;
  bool too_fast_ = false;  ///< at the start
};

}  // namespace

double speed_limit(const kinematics::Axis& axis, bool rapid) {
  return rapid && axis.rapid_max > 0.0 ? axis.rapid_max : axis.speed_max;
}

AxisLimits axis_limits(const kinematics::MachineModel& machine, bool rapid) {
  AxisLimits limits;
  for (kinematics::AxisValues* values : {&limits.speed, &limits.acceleration, &limits.jerk})
    values->setConstant(kNone);
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const kinematics::Axis& axis = machine.axes[i];
    limits.speed[row] = kPlanned * speed_limit(axis, rapid);
    limits.acceleration[row] = kPlanned * axis.acceleration_max;
    limits.jerk[row] = kPlanned * axis.jerk_max;
  }
  return limits;
}

RampLimits left_at(const PathCell& cell, double v, const AxisLimits& limits) {
  RampLimits left = cell.tip;
  for (Eigen::Index i = 0; i < kinematics::kMaxAxes; ++i) {
    if (cell.first[i] == 0.0) continue;
    left.acceleration =
        std::min(left.acceleration, (limits.acceleration[i] - cell.second[i] * v * v) / cell.first[i]);
    const double cross = 3.0 * cell.second[i] * v;
    if (cross > 0.0)
      left.acceleration =
          std::min(left.acceleration, 0.5 * (limits.jerk[i] - cell.third[i] * v * v * v) / cross);
  }
  left.acceleration = std::max(0.0, left.acceleration);
  for (Eigen::Index i = 0; i < kinematics::kMaxAxes; ++i) {
    if (cell.first[i] == 0.0) continue;
    const double used = (cell.third[i] * v * v + 3.0 * cell.second[i] * left.acceleration) * v;
    left.jerk = std::min(left.jerk, (limits.jerk[i] - used) / cell.first[i]);
  }
  left.jerk = std::max(0.0, left.jerk);
  return left;
}

void limit_speed(const AxisLimits& limits, PathCell& cell) {
  const double curvature = cell.corner ? 1.0 : kCurvatureShare, third = cell.corner ? 1.0 : kThirdShare;
  for (Eigen::Index i = 0; i < kinematics::kMaxAxes; ++i) {
    // Division by zero gives infinity: an axis at rest limits nothing.
    cell.speed = std::min({cell.speed, limits.speed[i] / cell.first[i],
                           std::sqrt(curvature * limits.acceleration[i] / cell.second[i])});
    if (cell.third[i] > 0.0)
      cell.speed = std::min(cell.speed, std::cbrt(third * limits.jerk[i] / cell.third[i]));
  }
}

std::optional<CellPlan> plan_cells(const std::vector<PathCell>& cells, const AxisLimits& limits,
                                   const PlanStart& start) {
  return Planner(cells, limits, start).plan();
}

}  // namespace swarf::motion
