#include "position/mesh_target.h"

#include <algorithm>
#include <array>

#include "base/check.h"
#include "position/triangle_rest.h"

namespace swarf::position {
namespace {

/// Of nodes that wait: three for each level of the tree, which is balanced, and one.
constexpr size_t kWaitingMost = 64;

LocalTriangle local_triangle(const GuideLine& line, const TreeTriangle& t) {
  const auto corner = [&](size_t i) {
    return line.local({t.corners[i][0], t.corners[i][1], t.corners[i][2]});
  };
  return {corner(0), corner(1), corner(2)};
}

/// One question to the tree: the highest rest above `height`, and the triangle that gives it.
class Search {
 public:
  Search(const SphereTree& tree, const ToolProfile& profile, const GuideLine& line, double height)
      : tree_(tree),
        profile_(profile),
        line_(line),
        height_(height),
        upright_(line.axis_W.x() == 0.0 && line.axis_W.y() == 0.0 && line.axis_W.z() == 1.0) {}

  void ask(uint32_t place) {
    const LocalTriangle local = local_triangle(line_, tree_.triangles()[place]);
    const TriangleRest rest = rest_on_triangle(profile_, local, height_);
    if (rest.height > height_) {
      height_ = rest.height;
      found_ = static_cast<int>(place);
    }
  }

  void walk() {
    visit(0);
    while (waiting_ > 0) {
      const Waiting next = stack_[--waiting_];
      if (next.bound <= height_) continue;
      if (next.count > 0) {
        ask_leaf(next.first, next.count);
      } else {
        visit(next.first);
      }
    }
  }

  double height() const { return height_; }
  int found() const { return found_; }  ///< -1: nothing above

 private:
  struct Waiting {
    double bound;
    uint32_t first, count;
  };

  /// What lies in the lane gives no height above this one, to the last bit.
  bool cannot_raise(const FourNodes& nodes, size_t lane, double bound) const {
    if (bound <= std::max(height_, kBeside)) return true;
    // Of an upright tool: level faces under a flat end are all as high as this says.
    return upright_ && static_cast<double>(nodes.top[lane]) - line_.point_W.z() <= height_;
  }

  void ask_leaf(uint32_t first, uint32_t count) {
    FourHeights bounds;
    corner_bounds(profile_, line_, &tree_.triangles()[first], bounds);
    for (uint32_t i = 0; i < count; ++i)
      if (bounds[i] > height_) ask(first + i);
  }

  /// The highest comes up first.
  void visit(uint32_t place) {
    const FourNodes& nodes = tree_.nodes()[place];
    FourHeights bounds;
    height_bounds(profile_, line_, nodes, bounds);
    const size_t below = waiting_;
    for (size_t lane = 0; lane < bounds.size(); ++lane) {
      if (cannot_raise(nodes, lane, bounds[lane])) continue;
      size_t at = waiting_++;
      for (; at > below && stack_[at - 1].bound > bounds[lane]; --at) stack_[at] = stack_[at - 1];
      stack_[at] = {bounds[lane], nodes.first[lane], nodes.count[lane]};
    }
  }

  const SphereTree& tree_;
  const ToolProfile& profile_;
  const GuideLine& line_;
  double height_;
  bool upright_;
  int found_ = -1;
  std::array<Waiting, kWaitingMost> stack_;
  size_t waiting_ = 0;
};

/// The rest on the triangle in full.
Rest rest_of(const ToolProfile& profile, const GuideLine& line, const TreeTriangle& triangle) {
  const LocalTriangle local = local_triangle(line, triangle);
  const TriangleRest found = rest_on_triangle(profile, local, -std::numeric_limits<double>::infinity());
  const auto number = static_cast<int>(triangle.number);
  Rest rest;
  rest.height = found.height;
  rest.what = found.what;
  rest.number = found.what == Touched::kFace ? number : 3 * number + found.place;
  rest.contact_W = line.world(found.contact);
  rest.gradient = triangle_gradient(profile, local, found);
  return rest;
}

}  // namespace

void MeshTarget::raise(const ToolProfile& profile, const GuideLine& line, Rest& best, int& near) const {
  if (tree_.nodes().empty()) return;
  Search search(tree_, profile, line, best.height);
  if (near >= 0) {
    SWARF_CHECK(static_cast<size_t>(near) < tree_.triangles().size(), "the hint is of another mesh");
    search.ask(static_cast<uint32_t>(near));
  }
  search.walk();
  if (search.found() < 0) return;
  near = search.found();
  best = rest_of(profile, line, tree_.triangles()[static_cast<size_t>(near)]);
}

}  // namespace swarf::position
