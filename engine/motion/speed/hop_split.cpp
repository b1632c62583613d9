#include "motion/speed/hop_split.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace swarf::motion {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// Nodes that are added, and places that are tried for each.
constexpr size_t kAddedMax = 6, kPlacesTried = 6;
/// Passes that move the speeds of all nodes after one has been added.
constexpr int kPasses = 2;
/// Share of the time that a node must save.
constexpr double kNodeGain = 0.009;
/// Speeds tried at a node: so many over all that can be reached, then around the best, ever closer.
constexpr int kSpeedsTried = 5, kCloser = 3;
/// Halvings of the interval in which a hop's top speed lies.
constexpr int kTopHalvings = 7;

double seconds_of(const std::vector<Phase>& phases) {
  return std::accumulate(phases.begin(), phases.end(), 0.0,
                         [](double sum, const Phase& phase) { return sum + phase.duration; });
}

double length_between(const SpeedOfCells& of, const EvenNode& a, const EvenNode& b) {
  double sum = 0.0;
  for (size_t i = a.end; i < b.begin; ++i) sum += of.cells[i].length;
  return sum;
}

/// What the cells leave when none is passed faster than `top`.
RampLimits left_between(const SpeedOfCells& of, const EvenNode& a, const EvenNode& b, double top) {
  RampLimits least{kNever, kNever};
  for (size_t i = a.end; i < b.begin; ++i) {
    const RampLimits own = left_at(of.cells[i], std::min(top, of.speed[i]), of.limits);
    least.acceleration = std::min(least.acceleration, own.acceleration);
    least.jerk = std::min(least.jerk, own.jerk);
  }
  return least;
}

bool keeps_speeds(const SpeedOfCells& of, const EvenNode& a, const EvenNode& b, double peak,
                  const std::vector<Phase>& phases) {
  double s = 0.0;
  for (size_t i = a.end; i < b.begin; ++i) {
    const double from = s, most = of.speed[i] * (1.0 + kSpeedRounding);
    s += of.cells[i].length;
    if (peak > most && greatest_speed(phases, from, s) > most) return false;
  }
  return true;
}

class Parter {
 public:
  Parter(const SpeedOfCells& of, std::vector<EvenNode>& nodes) : of_(of), nodes_(nodes) {}

  bool part(double before) {
    for (size_t k = 1; k < nodes_.size(); ++k) nodes_[k].part_s = between(nodes_[k - 1], nodes_[k]);
    for (int pass = 0; pass < kPasses; ++pass) move_speeds();
    double best = time();
    for (size_t added = 0; added < kAddedMax; ++added) {
      const std::vector<EvenNode> kept = nodes_;
      if (!add_node()) break;
      for (int pass = 0; pass < kPasses; ++pass) move_speeds();
      const double now = time();
      if (now > (1.0 - kNodeGain) * best) {
        nodes_ = kept;
        break;
      }
      best = now;
    }
    return best <= (1.0 - kPartGain) * before;
  }

 private:
  double between(const EvenNode& a, const EvenNode& b) { return hop_between(of_, a, b, phases_); }

  /// Of the cells that the node passes evenly.
  double even_time(const EvenNode& node) const {
    double length = 0.0;
    for (size_t i = node.begin; i < node.end; ++i) length += of_.cells[i].length;
    return length > 0.0 ? length / node.speed : 0.0;
  }

  double time() const {
    double sum = 0.0;
    for (size_t k = 1; k < nodes_.size(); ++k) sum += nodes_[k].part_s;
    for (size_t k = 1; k + 1 < nodes_.size(); ++k) sum += even_time(nodes_[k]);
    return sum;
  }

  /// Greatest speed that the node's cells and those beside it allow.
  double most_at(const EvenNode& node) const {
    double most = kNever;
    const size_t first = std::max<size_t>(1, node.begin) - 1;
    for (size_t i = first; i <= node.end && i < of_.cells.size(); ++i)
      most = std::min(most, i >= node.begin && i < node.end ? of_.cells[i].speed : of_.speed[i]);
    return most;
  }

  /// Moves the speed of a node between two others to where all takes the least time. Returns it.
  double fit(const EvenNode& a, EvenNode& node, EvenNode& b) {
    EvenNode best = node;
    double least = kNever, after = b.part_s;
    const auto attempt = [&](double speed) {
      EvenNode moved = node;
      moved.speed = speed;
      moved.part_s = between(a, moved);
      const double before = moved.part_s + even_time(moved);
      if (before >= least) return;
      const double behind = between(moved, b);
      if (before + behind >= least) return;
      least = before + behind;
      after = behind;
      best = moved;
    };
    const double most = most_at(node);
    if (node.speed > 0.0) attempt(node.speed);
    double step = most / kSpeedsTried;
    for (int i = 1; i <= kSpeedsTried; ++i) attempt(step * i);
    for (int i = 0; i < kCloser && least < kNever; ++i) {
      step *= 0.5;
      const double middle = best.speed;
      if (middle - step > 0.0) attempt(middle - step);
      if (middle + step < most) attempt(middle + step);
    }
    node = best;
    b.part_s = after;
    return least;
  }

  void move_speeds() {
    for (size_t k = 1; k + 1 < nodes_.size(); ++k)
      if (nodes_[k].speed > 0.0) fit(nodes_[k - 1], nodes_[k], nodes_[k + 1]);
  }

  /// How unlike the limits of the cells on both sides of a place are: 0 where they are alike.
  double unlike_at(size_t cell) const {
    const double v = std::min(of_.speed[cell - 1], of_.speed[cell]);
    const RampLimits a = left_at(of_.cells[cell - 1], v, of_.limits);
    const RampLimits b = left_at(of_.cells[cell], v, of_.limits);
    const auto ratio = [](double x, double y) { return std::abs(std::log((x + 1e-9) / (y + 1e-9))); };
    return ratio(a.acceleration, b.acceleration) + ratio(a.jerk, b.jerk) +
           ratio(of_.speed[cell - 1], of_.speed[cell]);
  }

  /// Adds the node that saves most, of the places where the limits change most.
  bool add_node() {
    struct Place {
      double unlike;
      size_t cell, before;  ///< the node before it
    };
    std::vector<Place> places;
    for (size_t k = 1; k < nodes_.size(); ++k)
      for (size_t i = nodes_[k - 1].end + 1; i < nodes_[k].begin; ++i)
        places.push_back({unlike_at(i) * nodes_[k].part_s, i, k - 1});
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
      return a.unlike != b.unlike ? a.unlike > b.unlike : a.cell < b.cell;
    });
    if (places.size() > kPlacesTried) places.resize(kPlacesTried);
    double most = 0.0;
    size_t where = 0;
    EvenNode best, behind;
    for (const Place& place : places) {
      EvenNode node{place.cell, place.cell, 0.0, 0.0}, after = nodes_[place.before + 1];
      const double split = fit(nodes_[place.before], node, after);
      const double saved = nodes_[place.before + 1].part_s - split;
      if (!(saved > most)) continue;
      most = saved;
      where = place.before + 1;
      best = node;
      behind = after;
    }
    if (where == 0) return false;
    nodes_[where] = behind;
    nodes_.insert(nodes_.begin() + static_cast<std::ptrdiff_t>(where), best);
    return true;
  }

  const SpeedOfCells& of_;
  std::vector<EvenNode>& nodes_;
  std::vector<Phase> phases_;
};

}  // namespace

double hop_between(const SpeedOfCells& of, const EvenNode& a, const EvenNode& b, std::vector<Phase>& phases) {
  phases.clear();
  if (a.end == b.begin) return a.speed == b.speed ? 0.0 : kNever;
  const double length = length_between(of, a, b);
  double high = 0.0, low = std::max(a.speed, b.speed), least = kNever;
  for (size_t i = a.end; i < b.begin; ++i) high = std::max(high, of.speed[i]);
  std::vector<Phase> tried;
  for (int i = 0; i < kTopHalvings && low <= high; ++i) {
    const double top = i == 0 ? high : 0.5 * (low + high);
    const RampLimits left = left_between(of, a, b, top);
    tried.clear();
    std::optional<double> peak;
    if (left.acceleration > 0.0 && left.jerk > 0.0 &&
        (a.speed == b.speed || ramp_length(a.speed, b.speed, left) <= length))
      peak = append_hop(a.speed, b.speed, length, top, left, tried);
    const double time = seconds_of(tried);
    if (peak && *peak > 0.0 && time < least && keeps_speeds(of, a, b, *peak, tried)) {
      least = time;
      phases = tried;
    }
    const bool reached = peak && *peak >= top * (1.0 - kSpeedRounding);
    if (i == 0 && reached) break;
    (reached ? low : high) = top;
  }
  return least;
}

double least_time_between(const SpeedOfCells& of, const EvenNode& a, const EvenNode& b) {
  double time = 0.0, length = 0.0, top = 0.0;
  RampLimits most{0.0, 0.0};
  for (size_t i = a.end; i < b.begin; ++i) {
    time += of.cells[i].length / of.speed[i];
    length += of.cells[i].length;
    top = std::max(top, of.speed[i]);
    const RampLimits own = left_at(of.cells[i], 0.0, of.limits);
    most.acceleration = std::max(most.acceleration, own.acceleration);
    most.jerk = std::max(most.jerk, own.jerk);
  }
  std::vector<Phase> phases;
  append_hop(a.speed, b.speed, length, top, most, phases);
  return std::max(time, seconds_of(phases));
}

bool part_hops(const SpeedOfCells& of, double before_s, std::vector<EvenNode>& nodes) {
  return Parter(of, nodes).part(before_s);
}

}  // namespace swarf::motion
