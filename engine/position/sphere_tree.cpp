#include "position/sphere_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/diagnostics.h"
#include "base/parallel.h"

namespace swarf::position {
namespace {

constexpr size_t kTrianglesMost = size_t{1} << 29U;
/// Subtrees of so many leaves are built side by side, and nodes are bounded in such chunks.
constexpr size_t kLeavesPerTask = 4096, kNodesPerTask = 256;
/// Of a sphere's radius, for the rounding of floats (6e-8) in it, in the planes and in the normal's length.
constexpr double kFloatShare = 1e-6;
/// Of the coordinates: more than the rounding of a centre to floats (6e-8) and of doubles in bounds and
/// heights.
constexpr double kPlaceRounding = 1e-7;
constexpr double kLeast_mm = 1e-9;

using Corner = std::array<float, 3>;
Vec3 point_of(const Corner& p) {
  return {p[0], p[1], p[2]};
}

/// What the tree is sorted by.
struct Item {
  std::array<float, 3> centre;
  uint32_t number;
};

/// A part of the leaves whose node is yet to be made; where its parent keeps it.
struct Job {
  size_t first_leaf, leaves, parent, lane;
};

/// Triangles below a node's lanes, by their places in the order of the leaves.
struct TreeRange {
  uint32_t first = 0, count = 0;
};
using FourRanges = std::array<TreeRange, 4>;

/// Sorts the items of its leaves and makes their nodes; what belongs to other parts of the tree it leaves
/// alone.
class TreeOrder {
 public:
  explicit TreeOrder(std::vector<Item>& items) : items_(items) {}

  /// Down to parts of `stop` leaves, which go to `rest`. Returns the place of the node.
  uint32_t split(const Job& job, size_t stop, std::vector<Job>& rest) {
    const size_t half = job.leaves / 2, quarter = half / 2, third = (job.leaves - half) / 2;
    const std::array<size_t, 4> parts{quarter, half - quarter, third, job.leaves - half - third};
    divide(job.first_leaf, half, job.leaves);
    divide(job.first_leaf, quarter, half);
    divide(job.first_leaf + half, third, job.leaves - half);
    const size_t place = nodes.size();
    nodes.emplace_back();
    ranges.emplace_back();
    size_t leaf = job.first_leaf;
    for (size_t lane = 0; lane < 4; leaf += parts[lane++]) {
      if (parts[lane] > 0) make_lane({leaf, parts[lane], place, lane}, stop, rest);
    }
    return static_cast<uint32_t>(place);
  }

  std::vector<FourNodes> nodes;  ///< first and count only
  std::vector<FourRanges> ranges;

 private:
  size_t first_item(size_t leaf) const { return std::min(items_.size(), leaf * SphereTree::kLeafTriangles); }

  void make_lane(const Job& part, size_t stop, std::vector<Job>& rest) {
    const auto begin = static_cast<uint32_t>(first_item(part.first_leaf));
    const auto count = static_cast<uint32_t>(first_item(part.first_leaf + part.leaves) - begin);
    ranges[part.parent][part.lane] = {begin, count};
    nodes[part.parent].first[part.lane] = begin;
    nodes[part.parent].count[part.lane] = part.leaves == 1 ? count : 0;
    if (part.leaves == 1) return;
    if (part.leaves <= stop) {
      rest.push_back(part);
      return;
    }
    const uint32_t below = split(part, stop, rest);
    nodes[part.parent].first[part.lane] = below;
  }

  /// The first `left` leaves get the lesser centres.
  void divide(size_t first_leaf, size_t left, size_t leaves) {
    if (left == 0 || left == leaves) return;
    const size_t begin = first_item(first_leaf), end = first_item(first_leaf + leaves);
    Corner low = items_[begin].centre, high = low;
    for (size_t i = begin; i < end; ++i)
      for (size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], items_[i].centre[k]);
        high[k] = std::max(high[k], items_[i].centre[k]);
      }
    size_t axis = 0;
    for (size_t k = 1; k < 3; ++k)
      if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
    const auto at = [this](size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(
        at(begin), at(first_item(first_leaf + left)), at(end), [axis](const Item& a, const Item& b) {
          return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis] : a.number < b.number;
        });
  }

  std::vector<Item>& items_;
};

/// The nodes of all leaves, the parts below the upper levels made side by side and put behind them in their
/// order.
void order_tree(std::vector<Item>& items, std::vector<FourNodes>& nodes, std::vector<FourRanges>& ranges) {
  const size_t leaves = (items.size() + SphereTree::kLeafTriangles - 1) / SphereTree::kLeafTriangles;
  TreeOrder upper(items);
  std::vector<Job> jobs, none;
  upper.split({0, leaves, 0, 0}, kLeavesPerTask, jobs);
  std::vector<TreeOrder> parts(jobs.size(), TreeOrder(items));
  parallel_chunks(jobs.size(), 1, [&](size_t begin, size_t) { parts[begin].split(jobs[begin], 0, none); });
  nodes = std::move(upper.nodes);
  ranges = std::move(upper.ranges);
  for (size_t i = 0; i < parts.size(); ++i) {
    const auto shift = static_cast<uint32_t>(nodes.size());
    nodes[jobs[i].parent].first[jobs[i].lane] = shift;
    for (FourNodes& node : parts[i].nodes)
      for (size_t lane = 0; lane < 4; ++lane)
        if (node.count[lane] == 0) node.first[lane] += shift;
    nodes.insert(nodes.end(), parts[i].nodes.begin(), parts[i].nodes.end());
    ranges.insert(ranges.end(), parts[i].ranges.begin(), parts[i].ranges.end());
    parts[i].nodes = {};
    parts[i].ranges = {};
  }
}

std::vector<Item> items_of(const TriMesh& mesh) {
  std::vector<Item> items(mesh.triangles.size());
  parallel_chunks(items.size(), 1U << 16U, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const auto& t = mesh.triangles[i];
      items[i].number = static_cast<uint32_t>(i);
      for (size_t k = 0; k < 3; ++k) {
        const double sum =
            static_cast<double>(mesh.positions[t[0]][k]) + mesh.positions[t[1]][k] + mesh.positions[t[2]][k];
        items[i].centre[k] = static_cast<float>(sum / 3.0);
      }
    }
  });
  return items;
}

Vec3 mean_normal(std::span<const TreeTriangle> triangles) {
  Vec3 sum = Vec3::Zero();
  for (const TreeTriangle& t : triangles) {
    const Vec3 a = point_of(t.corners[0]);
    sum += (point_of(t.corners[1]) - a).cross(point_of(t.corners[2]) - a);
  }
  const double length = sum.norm();  // any unit vector bounds; this one bounds well
  return length > 1e-30 ? Vec3(sum / length) : Vec3(Vec3::UnitZ());
}

/// Beyond every tool: a lane that holds nothing.
void leave_empty(FourNodes& node, size_t lane) {
  for (size_t k = 0; k < 3; ++k) node.centre[k][lane] = node.normal[k][lane] = 0.0F;
  node.centre[0][lane] = node.centre[1][lane] = node.centre[2][lane] = 1e12F;
  node.normal[2][lane] = 1.0F;
  node.radius[lane] = node.low[lane] = node.high[lane] = 0.0F;
  node.top[lane] = std::numeric_limits<float>::lowest();
}

/// Sphere and planes of a lane.
void bound_lane(std::span<const TreeTriangle> triangles, FourNodes& node, size_t lane) {
  Vec3 lower = point_of(triangles.front().corners[0]), upper = lower;
  for (const TreeTriangle& t : triangles)
    for (const Corner& p : t.corners) {
      lower = lower.cwiseMin(point_of(p));
      upper = upper.cwiseMax(point_of(p));
    }
  const Vec3 middle = 0.5 * (lower + upper), mean = mean_normal(triangles);
  const Eigen::Vector3f centre_f = middle.cast<float>(), normal_f = mean.cast<float>();
  for (size_t k = 0; k < 3; ++k) {
    node.centre[k][lane] = centre_f[static_cast<int>(k)];
    node.normal[k][lane] = normal_f[static_cast<int>(k)];
  }
  const Vec3 centre(centre_f[0], centre_f[1], centre_f[2]), normal(normal_f[0], normal_f[1], normal_f[2]);
  double square = 0.0, low = std::numeric_limits<double>::infinity(), high = -low;
  for (const TreeTriangle& t : triangles)
    for (const Corner& p : t.corners) {
      const Vec3 from = point_of(p) - centre;
      square = std::max(square, from.squaredNorm());
      low = std::min(low, normal.dot(from));
      high = std::max(high, normal.dot(from));
    }
  const double reach = lower.cwiseAbs().cwiseMax(upper.cwiseAbs()).sum();
  const double margin = kFloatShare * std::sqrt(square) + kPlaceRounding * reach + kLeast_mm;
  node.radius[lane] = static_cast<float>(std::sqrt(square) + margin);
  node.low[lane] = static_cast<float>(low - margin);
  node.high[lane] = static_cast<float>(high + margin);
  node.top[lane] = static_cast<float>(upper.z());  // a float's value
}

void check_mesh(const TriMesh& mesh) {
  if (mesh.triangles.size() > kTrianglesMost) {
    throw InputError(
        "mesh-too-large", {},
        fmt::format("{} triangles: at most {} can serve as a part", mesh.triangles.size(), kTrianglesMost),
        "export the mesh with a wider tolerance");
  }
  size_t broken = 0;
  for (const Corner& p : mesh.positions)
    if (!(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]))) ++broken;
  if (broken > 0) {
    throw InputError(
        "mesh-not-finite", {},
        fmt::format("{} of {} vertices have NaN or infinite coordinates", broken, mesh.positions.size()),
        "export the mesh again");
  }
  for (const auto& t : mesh.triangles)
    for (const uint32_t v : t)
      SWARF_CHECK(v < mesh.positions.size(), fmt::format("a triangle has vertex {}", v));
}

}  // namespace

SphereTree::SphereTree(const TriMesh& mesh) {
  check_mesh(mesh);
  if (mesh.triangles.empty()) return;
  std::vector<Item> items = items_of(mesh);
  std::vector<FourRanges> ranges;
  order_tree(items, nodes_, ranges);
  triangles_.reserve(items.size() + kLeafTriangles - 1);
  triangles_.resize(items.size());
  parallel_chunks(items.size(), 1U << 16U, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const auto& t = mesh.triangles[items[i].number];
      triangles_[i] = {{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]}, items[i].number};
    }
  });
  triangles_.insert(triangles_.end(), kLeafTriangles - 1, TreeTriangle(triangles_.back()));
  parallel_chunks(nodes_.size(), kNodesPerTask, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      for (size_t lane = 0; lane < 4; ++lane) {
        const TreeRange& range = ranges[i][lane];
        if (range.count == 0) {
          leave_empty(nodes_[i], lane);
        } else {
          bound_lane(triangles().subspan(range.first, range.count), nodes_[i], lane);
        }
      }
  });
}

}  // namespace swarf::position
