// A contact that the grid only hints at, by the sweeps themselves.
//
// From the grid points with the lowest sums a search by shrinking steps goes down
//   max(material, part)   to a point in both, a witness that the sweeps left there and the part passes over,
//   material + part       from there, as long as it stays in both: the depth.
#include <algorithm>
#include <array>
#include <optional>

#include "stock/contact/contact_finder.h"
#include "stock/contact/contact_passage.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/stock_grid_internal.h"

namespace swarf::stock {
namespace {

constexpr size_t kStarts = 6;
constexpr double kApart = 1.5;      // voxels, between two starts
constexpr double kFirstStep = 0.5;  // voxels
constexpr double kLastStepMm = 1e-3;
constexpr double kFarthest = 2.0;  // voxels, from the start

/// Steps to the faces, edges and corners of a cube, of length 1.
std::array<Vec3, 26> directions() {
  std::array<Vec3, 26> all;
  size_t count = 0;
  for (int n = 0; n < 27; ++n) {
    if (n != 13) all[count++] = Vec3(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1).normalized();
  }
  return all;
}

}  // namespace

class ShallowSearch {
 public:
  ShallowSearch(const ContactFinder& finder, const SweepMap& map, const RevolvedPart& part, const OwnCut* own,
                const ContactFinder::Material& material)
      : finder_(finder), map_(map), part_(part), own_(own), material_(material), voxel_(finder.voxel_) {}

  std::optional<Contact> run() {
    find_starts();
    for (const Start& start : starts_) go_down(start.point);
    return best_;
  }

 private:
  struct Start {
    double sum;
    Vec3 point;
  };
  struct Look {
    double material, part, t;
    bool inside() const { return material < 0.0 && part < 0.0; }
    double deeper() const { return std::max(material, part); }
    double sum() const { return material + part; }
  };

  void find_starts() {
    const double least = -ContactFinder::kHint * voxel_;
    finder_.each_leaf(map_, part_, least, [&](size_t leaf, const ContactFinder::Bound& bound) {
      uint16_t places[kLeafVoxels];
      const size_t count = finder_.candidates(leaf, bound, least, ContactFinder::kWide, places);
      for (size_t n = 0; n < count; ++n) {
        const Vec3 point = finder_.point_at(leaf, places[n]);
        const Passage passage(map_, part_, point, kExactGap * voxel_);
        const double sum = finder_.value_at(leaf, places[n]) + passage.least();
        if (sum < least) add_start({sum, point});
      }
      return true;
    });
  }

  /// The lowest, no two of them close together.
  void add_start(const Start& start) {
    const auto close = std::find_if(starts_.begin(), starts_.end(), [&](const Start& other) {
      return (other.point - start.point).norm() < kApart * voxel_;
    });
    if (close != starts_.end()) {
      if (start.sum < close->sum) *close = start;
    } else {
      starts_.push_back(start);
    }
    std::stable_sort(starts_.begin(), starts_.end(),
                     [](const Start& a, const Start& b) { return a.sum < b.sum; });
    if (starts_.size() > kStarts) starts_.pop_back();
  }

  Look look_at(const Vec3& point) const {
    const Passage passage(map_, part_, point, 1e-6);
    Look look{material_(point), passage.least(), passage.least_t()};
    if (own_ == nullptr || look.part >= 0.0) return look;
    // What the flutes take before the part stands deep enough there to count.
    const double t = passage.first(std::max(look.part, -0.5 * ContactFinder::kLeastMm));
    look.material = std::max(look.material, taken(*own_, point, t));
    return look;
  }

  void go_down(const Vec3& start) {
    static const std::array<Vec3, 26> kDirections = directions();
    Vec3 at = start;
    Look here = look_at(at);
    for (double step = kFirstStep * voxel_; step > kLastStepMm;) {
      Vec3 next = at;
      for (const Vec3& direction : kDirections) {
        const Vec3 candidate = at + step * direction;
        if ((candidate - start).norm() > kFarthest * voxel_) continue;
        const Look look = look_at(candidate);
        const bool lower =
            here.inside() ? look.inside() && look.sum() < here.sum() : look.deeper() < here.deeper();
        if (!lower) continue;
        here = look;
        next = candidate;
      }
      if (next == at) step *= 0.5;
      at = next;
    }
    if (here.inside()) take(at, here);
  }

  void take(const Vec3& point, const Look& look) {
    const double depth = -look.sum();
    if (depth < ContactFinder::kLeastMm || (best_ && depth <= best_->depth_mm)) return;
    best_ = Contact{look.t, look.t, depth, look.t, point};
  }

  const ContactFinder& finder_;
  const SweepMap& map_;
  const RevolvedPart& part_;
  const OwnCut* own_;
  const ContactFinder::Material& material_;
  double voxel_;
  std::vector<Start> starts_;
  std::optional<Contact> best_;
};

std::optional<Contact> ContactFinder::shallow_contact(const SweepMap& map, const RevolvedPart& part,
                                                      const OwnCut* own, const Material& material) const {
  return ShallowSearch(*this, map, part, own, material).run();
}

}  // namespace swarf::stock
