#include "proof/facet_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace swarf::proof {
namespace {

constexpr uint32_t kFewest = 4;  ///< facets of a group that is not divided, at most

}  // namespace

struct FacetTree::Builder {
  const mesh::SignedDistance& design;
  FacetTree& tree;
  std::vector<Vec3> middles;

  FacetGroup group_of(uint32_t first, uint32_t count) const {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    FacetGroup group{{Vec3::Constant(kFar), Vec3::Constant(-kFar)}, Vec3::Zero(), -kFar, first, count, 0};
    const auto each_corner = [&](const auto& take) {
      for (uint32_t i = first; i < first + count; ++i)
        for (size_t k = 0; k < 3; ++k) take(design.corner(tree.order_[i], k));
    };
    for (uint32_t i = first; i < first + count; ++i) group.normal += design.face_normal(tree.order_[i]);
    group.normal = group.normal.norm() > 0.0 ? Vec3(group.normal.normalized()) : Vec3::UnitZ();
    each_corner([&](const Vec3& p) {
      group.box.lower = group.box.lower.cwiseMin(p);
      group.box.upper = group.box.upper.cwiseMax(p);
      group.top_mm = std::max(group.top_mm, group.normal.dot(p));
    });
    return group;
  }

  /// In two halves across the longest way of the facets' middles.
  void add(uint32_t first, uint32_t count) {
    const auto n = static_cast<uint32_t>(tree.groups_.size());
    tree.groups_.push_back(group_of(first, count));
    if (count <= kFewest) return;
    Vec3 low = middles[tree.order_[first]], high = low;
    for (uint32_t i = first; i < first + count; ++i) {
      low = low.cwiseMin(middles[tree.order_[i]]);
      high = high.cwiseMax(middles[tree.order_[i]]);
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    const uint32_t half = count / 2;
    const auto begin = tree.order_.begin() + first;
    std::nth_element(begin, begin + half, begin + count, [&](uint32_t a, uint32_t b) {
      return middles[a][axis] != middles[b][axis] ? middles[a][axis] < middles[b][axis] : a < b;
    });
    add(first, half);
    tree.groups_[n].second = static_cast<uint32_t>(tree.groups_.size());
    add(first + half, count - half);
  }
};

FacetTree::FacetTree(const mesh::SignedDistance& design) : order_(design.mesh().triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  if (order_.empty()) return;
  Builder builder{design, *this, {}};
  for (const uint32_t n : order_)
    builder.middles.push_back((design.corner(n, 0) + design.corner(n, 1) + design.corner(n, 2)) / 3.0);
  builder.add(0, static_cast<uint32_t>(order_.size()));
}

void FacetTree::find(const Box& box, std::vector<uint32_t>& found) const {
  const size_t before = found.size();
  any([&](const FacetGroup& group) { return !do_meet(group.box, box); },
      [&](uint32_t facet) {
        found.push_back(facet);
        return false;
      });
  std::sort(found.begin() + static_cast<std::ptrdiff_t>(before), found.end());
}

}  // namespace swarf::proof
