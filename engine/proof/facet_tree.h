// The facets of a body in a tree of groups that lie side by side. Internal to this folder.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/frames.h"
#include "mesh/signed_distance.h"

namespace swarf::proof {

/// Facets side by side: their box, and a plane that none of them stands above.
struct FacetGroup {
  Box box;
  Vec3 normal = Vec3::UnitZ();  ///< unit: the mean of the facets' normals
  double top_mm = 0.0;          ///< greatest normal . x over the facets
  uint32_t first = 0, count = 0;
  uint32_t second = 0;  ///< its other half; the first one follows it. 0: it is not divided
};

class FacetTree {
 public:
  /// Keeps nothing of `design`.
  explicit FacetTree(const mesh::SignedDistance& design);

  /// Visits facets until `visit(facet)` is true, and says so; passes over the groups for which `skip(group)`
  /// is true.
  template <typename Skip, typename Visit>
  bool any(const Skip& skip, const Visit& visit) const {
    std::vector<uint32_t> todo;
    if (!groups_.empty()) todo.push_back(0);
    while (!todo.empty()) {
      const uint32_t n = todo.back();
      todo.pop_back();
      const FacetGroup& group = groups_[n];
      if (skip(group)) continue;
      if (group.second != 0) {
        todo.push_back(group.second);
        todo.push_back(n + 1);
        continue;
      }
      for (uint32_t i = group.first; i < group.first + group.count; ++i)
        if (visit(order_[i])) return true;
    }
    return false;
  }
  /// Appends the facets of the undivided groups whose boxes meet `box`, in rising order.
  void find(const Box& box, std::vector<uint32_t>& found) const;

 private:
  struct Builder;
  std::vector<FacetGroup> groups_;  ///< the root first
  std::vector<uint32_t> order_;     ///< facets, those of a group in a row
};

/// Whether they have a point in common.
inline bool do_meet(const Box& a, const Box& b) {
  return (a.lower.array() <= b.upper.array()).all() && (b.lower.array() <= a.upper.array()).all();
}

}  // namespace swarf::proof
