// One contact in full: when it begins and ends, how deep it goes and where, however deep.
//
// Every grid point x has its own instants: the part is deep enough there from the first t with
//   d(t) <= -deep - phi(x),   phi(x) of the stock before the sweep, raised by what the flutes take until t.
// d falls up to its least and rises after it, and what the flutes take only grows, so the first t is found
// from below: raise phi, look for the next t, until nothing changes or x lies in the air.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "stock/contact/contact_finder.h"
#include "stock/contact/contact_passage.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/stock_grid_internal.h"

namespace swarf::stock {
namespace {

constexpr double kDepthStep = 0.125;  // voxels: a place is only deeper when it is by this much
constexpr double kRaised = 1.0 / 64;  // voxels: less is no change
constexpr int kMostRaises = 32;

/// Points on the part and on its axis, at most `spacing` apart along the profile, and half a voxel inside its
/// edges.
std::vector<Vec3> lattice(const RevolvedPart& part, double spacing, double voxel) {
  constexpr int kMostAround = 24, kLeastAround = 8;
  std::vector<Vec3> points;
  const auto ring = [&](const Vec2& p) {
    const int count =
        std::clamp(static_cast<int>(std::ceil(2.0 * kPi * p.x() / spacing)), kLeastAround, kMostAround);
    if (p.x() > 0.0) {
      for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * kPi * i / count;
        points.emplace_back(p.x() * std::cos(angle), p.x() * std::sin(angle), p.y());
      }
    }
  };
  const std::vector<Vec2>& corners = part.corners();
  for (size_t c = 1; c < corners.size(); ++c) {
    const Vec2 way = corners[c] - corners[c - 1];
    const int count = static_cast<int>(std::ceil(way.norm() / spacing));
    for (int i = 1; i <= count; ++i) ring(corners[c - 1] + way * i / count);
  }
  const double length = part.high() - part.low();
  const double inset = std::min(0.5 * voxel, 0.5 * length);
  for (const Vec2& corner : corners) {
    if (corner.x() <= inset) continue;
    const bool lower = corner.y() < part.low() + 0.5 * length;
    ring(corner + Vec2(-inset, lower ? inset : -inset));
  }
  const int count = static_cast<int>(std::ceil(length / spacing));
  for (int i = 0; i <= count; ++i) points.emplace_back(0.0, 0.0, part.low() + length * i / count);
  return points;
}

}  // namespace

class ContactSearch {
 public:
  ContactSearch(const ContactFinder& finder, const SweepMap& map, const RevolvedPart& part, const OwnCut* own)
      : finder_(finder), map_(map), part_(part), own_(own), voxel_(finder.voxel_), deep_(finder.deep_mm()) {}

  std::optional<Contact> run() {
    find_leaves();
    const auto by_first = [](const Leaf& a, const Leaf& b) { return a.first_t < b.first_t; };
    std::stable_sort(leaves_.begin(), leaves_.end(), by_first);
    for (const Leaf& leaf : leaves_) look_for_first_and_deepest(leaf);
    if (!touches_) return std::nullopt;
    const auto by_last = [](const Leaf& a, const Leaf& b) { return a.last_t > b.last_t; };
    std::stable_sort(leaves_.begin(), leaves_.end(), by_last);
    for (const Leaf& leaf : leaves_) look_for_last(leaf);
    look_deeper();
    return best_;
  }

 private:
  using Bound = ContactFinder::Bound;
  struct Leaf {
    size_t index;
    Bound bound;
    double first_t, last_t;  ///< no grid point of the leaf is met before or after
  };

  void find_leaves() {
    const double least = -deep_;
    finder_.each_leaf(map_, part_, least, [&](size_t leaf, const Bound& bound) {
      const double reach = std::sqrt(3.0) * 0.5 * (kLeafSide - 1) * voxel_;  // from the centre
      const double meets = kBandVoxels * voxel_ - deep_ + reach;
      const Passage centre(map_, part_, bound.centre, kExactGap * voxel_);
      if (centre.least() <= meets) leaves_.push_back({leaf, bound, centre.first(meets), centre.last(meets)});
      return true;
    });
  }

  template <typename Visit>
  void each_candidate(const Leaf& leaf, double least, const Visit& visit) const {
    uint16_t places[kLeafVoxels];
    const size_t count = finder_.candidates(leaf.index, leaf.bound, least, ContactFinder::kReach, places);
    for (size_t n = 0; n < count; ++n)
      visit(finder_.point_at(leaf.index, places[n]), finder_.value_at(leaf.index, places[n]));
  }

  /// When the part stands deep enough at the point, as far as the flutes leave it there.
  std::optional<double> first_contact(const Passage& passage, const Vec3& point, double value) const {
    for (int raise = 0; raise < kMostRaises; ++raise) {
      if (value + passage.least() >= -deep_) return std::nullopt;
      const double t = passage.first(-deep_ - value);
      if (own_ == nullptr) return t;
      const double raised = std::max(value, taken(*own_, point, t));
      if (raised <= value + kRaised * voxel_) return t;
      if (raised > ContactFinder::kReach * voxel_) return std::nullopt;  // air by now
      value = raised;
    }
    return passage.least_t();
  }

  void look_for_first_and_deepest(const Leaf& leaf) {
    const bool sooner = !touches_ || leaf.first_t < best_.first_t;
    const double deeper = -(best_.depth_mm + kDepthStep * voxel_);
    each_candidate(leaf, sooner || !touches_ ? -deep_ : deeper, [&](const Vec3& point, double value) {
      const Passage passage(map_, part_, point, kExactGap * voxel_);
      const double sum = value + passage.least();
      if (sum >= -deep_) return;
      const bool may_be_deeper = !touches_ || -sum > best_.depth_mm + kDepthStep * voxel_;
      const bool may_be_sooner = !touches_ || passage.first(-deep_ - value) < best_.first_t;
      if (!may_be_deeper && !may_be_sooner) return;
      const std::optional<double> t = first_contact(passage, point, value);
      if (!t) return;
      best_.first_t = touches_ ? std::min(best_.first_t, *t) : *t;
      touches_ = true;
      if (may_be_deeper) deepest_is(point, -sum, std::max(*t, passage.least_t()));
    });
  }

  void deepest_is(const Vec3& point, double depth, double t) {
    const Frame frame = frame_at(map_, t);
    const Vec3 start = map_.start(point);
    const RevolvedPart::Place place = part_.at(start + t * (map_.end(point) - start));
    best_.depth_mm = depth;
    best_.deepest_t = t;
    best_.place_W = point - place.value * (frame.rows.transpose() * place.normal);
  }

  void look_for_last(const Leaf& leaf) {
    if (!looked_) best_.last_t = best_.first_t;
    looked_ = true;
    if (leaf.last_t <= best_.last_t) return;
    each_candidate(leaf, -deep_, [&](const Vec3& point, double value) {
      const Passage passage(map_, part_, point, kExactGap * voxel_);
      if (value + passage.least() >= -deep_) return;
      double last = passage.last(-deep_ - value);
      if (last <= best_.last_t) return;
      const std::optional<double> first = first_contact(passage, point, value);
      if (!first) return;
      if (own_ != nullptr && !touches_at(passage, point, value, last)) {
        double inner = *first;
        for (int step = 0; step < kHalvings; ++step) {
          const double middle = 0.5 * (inner + last);
          (touches_at(passage, point, value, middle) ? inner : last) = middle;
        }
        last = inner;
      }
      best_.last_t = std::max(best_.last_t, last);
    });
  }
  bool touches_at(const Passage& passage, const Vec3& point, double value, double t) const {
    const double left = std::max(value, taken(*own_, point, t));
    return left <= ContactFinder::kReach * voxel_ && left + passage.distance(t) <= -deep_ + kRaised * voxel_;
  }

  /// Where the level set only says "deeper than the band": the part's own points, by their distance to the
  /// air.
  void look_deeper() {
    constexpr double kMostSteps = 4000.0;
    const std::vector<Vec3> points = lattice(part_, std::max(2.0 * voxel_, part_.radius() / 6.0), voxel_);
    std::vector<ContactFinder::Witness> witnesses(points.size());
    const double turn = (map_.R1t.row(2) - map_.R0t.row(2)).norm();
    const double way = (map_.tip1 - map_.tip0).norm() + turn * std::hypot(part_.radius(), part_.high());
    const double steps = std::clamp(std::ceil(way / voxel_), 1.0, kMostSteps);
    for (double n = 0.0; n <= steps; n += 1.0) {
      const double t = best_.first_t + (1.0 - best_.first_t) * n / steps;
      const Frame frame = frame_at(map_, t);
      for (size_t i = 0; i < points.size(); ++i) look_at(frame.work(points[i]), t, witnesses[i]);
    }
  }
  /// `witness` of the same point of the part a step ago tells most of the time that nothing is deeper.
  void look_at(const Vec3& point, double t, ContactFinder::Witness& witness) {
    const double value = finder_.stock_.distance_mm(point);
    if (value > -0.9 * kBandVoxels * voxel_) return;  // looked at among the grid points
    const Vec3 start = map_.start(point);
    const double distance = part_.at(start + t * (map_.end(point) - start)).value;
    const double needed = best_.depth_mm + kDepthStep * voxel_ + distance;
    if (witness.bound(point) <= needed) return;
    const double left = own_ != nullptr ? std::max(value, taken(*own_, point, t)) : value;
    if (left > ContactFinder::kReach * voxel_ || left + distance >= -deep_) return;
    const double depth = finder_.depth_of(point, witness, needed);
    if (depth > needed) deepest_is(point, depth - distance, t);
  }

  const ContactFinder& finder_;
  const SweepMap& map_;
  const RevolvedPart& part_;
  const OwnCut* own_;
  double voxel_, deep_;
  std::vector<Leaf> leaves_;
  bool touches_ = false, looked_ = false;
  Contact best_;
};

std::optional<Contact> ContactFinder::contact(const SweepMap& map, const RevolvedPart& part,
                                              const OwnCut* own) const {
  return ContactSearch(*this, map, part, own).run();
}

void ContactFinder::look_for_air(size_t leaf, const Vec3& point_W, Witness& best, double& least) const {
  const LevelSet& set = stock_.level_set();
  if (set.map.states[leaf] != LeafState::kLeaf) return;
  const Vec3 to_first = point_at(leaf, 0) - point_W;
  const Vec3 far = (to_first + Vec3::Constant((kLeafSide - 1) * voxel_)).cwiseMin(0.0);
  const Vec3 near = to_first.cwiseMax(0.0);
  if ((near - far).norm() - set.band() >= least) return;
  const float* values = set.values(leaf);
  const double inside = -0.999 * set.band();  // below, the band says nothing
  int found = -1;
  for (int row = 0; row < kLeafVoxels / kLeafSide; ++row) {
    const double x = to_first.x() + row / kLeafSide * voxel_, y = to_first.y() + row % kLeafSide * voxel_;
    const double across2 = x * x + y * y;
    for (int k = 0; k < kLeafSide; ++k) {
      const double value = values[row * kLeafSide + k], z = to_first.z() + k * voxel_;
      const double most = least + value;  // of the way to that place
      if (value <= inside || most <= 0.0 || across2 + z * z >= most * most) continue;
      least = std::sqrt(across2 + z * z) - value;
      found = row * kLeafSide + k;
    }
  }
  if (found >= 0) best = {point_at(leaf, found), -static_cast<double>(values[found])};
}

double ContactFinder::depth_of(const Vec3& point_W, Witness& witness, double enough) const {
  const LevelSet& set = stock_.level_set();
  if (stock_.distance_mm(point_W) >= 0.0) return 0.0;
  const double side = kLeafSide * voxel_;
  const openvdb::Coord& size = set.map.dimension;
  const auto home_of = [&](const Vec3& point, int* home) {
    for (int a = 0; a < 3; ++a) {
      home[a] = static_cast<int>(std::floor((point[a] + 0.5 * voxel_) / side)) - set.map.lower[a];
    }
  };
  Witness best = witness;
  double least = witness.bound(point_W);
  int home[3];
  if (std::isfinite(least)) {
    home_of(witness.place, home);
    look_for_air(set.map.index(home[0], home[1], home[2]), point_W, best, least);
  }
  home_of(point_W, home);
  const int farthest = std::max({size.x(), size.y(), size.z()});
  for (int ring = 0; ring <= farthest && least > enough; ++ring) {
    if ((ring - 1) * side - set.band() >= least) break;
    for (int i = std::max(0, home[0] - ring); i <= std::min(size.x() - 1, home[0] + ring); ++i) {
      for (int j = std::max(0, home[1] - ring); j <= std::min(size.y() - 1, home[1] + ring); ++j) {
        const bool on_side = std::abs(i - home[0]) == ring || std::abs(j - home[1]) == ring;
        const int step = on_side || ring == 0 ? 1 : 2 * ring;
        for (int k = home[2] - ring; k <= home[2] + ring; k += step)
          if (k >= 0 && k < size.z()) look_for_air(set.map.index(i, j, k), point_W, best, least);
      }
    }
  }
  witness = best;
  return least;
}

}  // namespace swarf::stock
