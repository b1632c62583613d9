#include "stock/rays/free_ranges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "base/parallel.h"
#include "base/units.h"

namespace swarf::stock {
namespace {

constexpr size_t kRangesPerTask = 8;
/// Normals of a foot and of the wall that limits it differ by twice that angle; |n - m| then is at least
/// this.
const double kConesApart = 2.0 * kLeastWallSine;
/// Square of the sine below which a whole box is left out: rounding of its bounds leaves no wall out with it.
constexpr double kSurelyFlat = (1.0 - 1e-9) * kLeastWallSine * kLeastWallSine;
constexpr double kNoEnd = std::numeric_limits<double>::infinity();

/// Feet of one tile, or of a branch of tiles, with a box and a cone around them.
struct Node {
  Vec3 low, high;
  Vec3 normal;           ///< mean
  double spread;         ///< greatest |normal - mean|
  uint32_t field, tile;  ///< of a leaf
  uint32_t right;        ///< of a branch: its second child; the first one follows it. 0: a leaf
};

const RayField& walls_of(const RayField& field) {
  return field.walls ? *field.walls : field;
}

Node leaf_of(const RayField& field, uint32_t which, uint32_t tile) {
  const RayTile& t = field.tiles[tile];
  const Vec3& first = field.points[field.order[t.begin]];
  Node node{first, first, t.frame.row(2).transpose(), t.normal_spread, which, tile, 0};
  for (uint32_t n = 1; n < t.count; ++n) {
    const Vec3& p = field.points[field.order[t.begin + n]];
    node.low = node.low.cwiseMin(p);
    node.high = node.high.cwiseMax(p);
  }
  return node;
}

/// The ball through p with its centre on the ray cannot be smaller than this for any point of the box that p
/// sees under kLeastWallSine at least; kNoEnd where it sees none so.
double least_radius(const Vec3& p, const Vec3& n, const Node& box) {
  const Vec3 least = box.low - p, greatest = box.high - p;
  const double along = n.cwiseProduct(least).cwiseMax(n.cwiseProduct(greatest)).sum();
  if (along <= 0.0) return kNoEnd;
  const double near2 = least.cwiseMax(-greatest).cwiseMax(0.0).squaredNorm();
  if (along * along < kSurelyFlat * near2) return kNoEnd;
  return near2 / (2.0 * along);
}

}  // namespace

class DesignTree {
 public:
  explicit DesignTree(std::span<const RayFieldPtr> fields) : fields_(fields) {
    std::vector<Node> leaves;
    for (uint32_t f = 0; f < fields.size(); ++f) {
      const RayField& walls = walls_of(*fields[f]);
      for (uint32_t t = 0; t < walls.tiles.size(); ++t) leaves.push_back(leaf_of(walls, f, t));
    }
    nodes_.reserve(2 * leaves.size());
    build(leaves, 0, leaves.size());
  }

  /// False when no ray of the tile can have a wall.
  bool has_walls(const Node& tile) const {
    std::vector<uint32_t> open{0};
    while (!open.empty()) {
      const uint32_t index = open.back();
      const Node& node = nodes_[index];
      open.pop_back();
      if (alike(tile.normal, tile.spread, node) || !rises(tile, node)) continue;
      if (node.right == 0) return true;
      open.push_back(node.right);
      open.push_back(index + 1);
    }
    return false;
  }

  /// The range of one ray; `open` is working space.
  FreeRange::Range range(const Vec3& p, const Vec3& n, std::vector<uint32_t>& open) const {
    FreeRange::Range range{kNoEnd, p};
    open.assign(1, 0);
    while (!open.empty()) {
      const uint32_t index = open.back();
      const Node& node = nodes_[index];
      open.pop_back();
      if (alike(n, 0.0, node) || least_radius(p, n, node) >= range.mm) continue;
      if (node.right == 0) {
        limit_by(p, n, node, range);
        continue;
      }
      const bool right_first = least_radius(p, n, nodes_[node.right]) < least_radius(p, n, nodes_[index + 1]);
      open.push_back(right_first ? index + 1 : node.right);
      open.push_back(right_first ? node.right : index + 1);
    }
    return range;
  }

 private:
  /// Two cones of normals, all of them closer than kConesApart: no ball touches both.
  static bool alike(const Vec3& normal, double spread, const Node& node) {
    return (node.normal - normal).norm() + node.spread + spread < kConesApart;
  }

  void limit_by(const Vec3& p, const Vec3& n, const Node& leaf, FreeRange::Range& range) const {
    const RayField& field = walls_of(*fields_[leaf.field]);
    const RayTile& tile = field.tiles[leaf.tile];
    for (uint32_t i = tile.begin; i < tile.begin + tile.count; ++i) {
      const Vec3& wall = field.points[field.order[i]];
      const Vec3 offset = wall - p;
      const double along = n.dot(offset), distance2 = offset.squaredNorm();
      if (along <= 0.0 || along * along <= kLeastWallSine * kLeastWallSine * distance2) continue;
      const double radius = distance2 / (2.0 * along);
      if (radius < range.mm) range = {radius, wall};
    }
  }

  /// False when no point of `node` lies above the tangent plane of any foot of the tile.
  static bool rises(const Node& tile, const Node& node) {
    const Vec3 least = node.low - tile.high, greatest = node.high - tile.low;  // q - p by component
    const double along = tile.normal.cwiseProduct(least).cwiseMax(tile.normal.cwiseProduct(greatest)).sum();
    const double farthest = least.cwiseAbs().cwiseMax(greatest.cwiseAbs()).norm();
    return along + tile.spread * farthest > 0.0;
  }

  void build(std::vector<Node>& leaves, size_t begin, size_t end) {
    const auto self = static_cast<uint32_t>(nodes_.size());
    if (end - begin == 1) {
      nodes_.push_back(leaves[begin]);
      return;
    }
    Node node = leaves[begin];
    node.normal.setZero();
    for (size_t i = begin; i < end; ++i) {
      node.low = node.low.cwiseMin(leaves[i].low);
      node.high = node.high.cwiseMax(leaves[i].high);
      node.normal += leaves[i].normal;
    }
    if (node.normal.squaredNorm() > 0.0) node.normal.normalize();
    node.spread = 0.0;
    for (size_t i = begin; i < end; ++i) {
      node.spread = std::max(node.spread, (leaves[i].normal - node.normal).norm() + leaves[i].spread);
    }
    nodes_.push_back(node);
    int axis = 0;
    (node.high - node.low).maxCoeff(&axis);
    const size_t middle = begin + (end - begin) / 2;
    const auto at = [&](size_t i) { return leaves.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [&](const Node& a, const Node& b) {
      return std::tuple(a.low[axis] + a.high[axis], a.field, a.tile) <
             std::tuple(b.low[axis] + b.high[axis], b.field, b.tile);
    });
    build(leaves, begin, middle);
    nodes_[self].right = static_cast<uint32_t>(nodes_.size());
    build(leaves, middle, end);
  }

  std::span<const RayFieldPtr> fields_;
  std::vector<Node> nodes_;
};

FreeRange::FreeRange(std::span<const RayFieldPtr> fields)
    : fields_(fields.begin(), fields.end()), tree_(std::make_unique<const DesignTree>(fields_)) {}
FreeRange::~FreeRange() = default;
FreeRange::FreeRange(FreeRange&&) noexcept = default;

FreeRange::Range FreeRange::operator()(const Vec3& point, const Vec3& normal) const {
  std::vector<uint32_t> open;
  return tree_->range(point, normal, open);
}

std::vector<double> free_ranges(std::span<const RayFieldPtr> fields, size_t which) {
  const RayField& field = *fields[which];
  const DesignTree tree(fields);
  std::vector<double> ranges(field.size(), kNoEnd);
  parallel_chunks(field.tiles.size(), kRangesPerTask, [&](size_t begin, size_t end) {
    std::vector<uint32_t> open;
    for (size_t t = begin; t < end; ++t) {
      const RayTile& tile = field.tiles[t];
      if (!tree.has_walls(leaf_of(field, static_cast<uint32_t>(which), static_cast<uint32_t>(t)))) continue;
      for (uint32_t i = tile.begin; i < tile.begin + tile.count; ++i) {
        const uint32_t ray = field.order[i];
        const double range = tree.range(field.points[ray], field.normals[ray], open).mm;
        ranges[ray] = range < 0.5 * field.pitch_mm ? 0.0 : range;
      }
    }
  });
  return ranges;
}

}  // namespace swarf::stock
