#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "stock/level_set/stock_grid_internal.h"
#include "stock/mesher/mesher_leaf.h"
#include "stock/mesher/stock_mesher.h"

namespace swarf::stock {
namespace {

constexpr size_t kMeshedPerTask = 32;
constexpr int kBlockSide = 8;

/// A leaf position and those around it.
struct Place {
  int i, j, k;
};

Place place_of(const LeafMap& map, size_t n) {
  const auto plane = static_cast<size_t>(map.dimension.y()) * map.dimension.z();
  return {static_cast<int>(n / plane), static_cast<int>(n % plane / map.dimension.z()),
          static_cast<int>(n % map.dimension.z())};
}

bool known(const LeafMap& map, const Place& p) {
  return p.i >= 0 && p.j >= 0 && p.k >= 0 && p.i < map.dimension.x() && p.j < map.dimension.y() &&
         p.k < map.dimension.z();
}

/// The values of one leaf position: an array, or one value for all of it.
struct LeafView {
  const float* values = nullptr;
  float constant = 0.0F;
};

LeafView leaf_view(const LevelSet& set, const Place& p) {
  if (!known(set.map, p)) return {nullptr, set.band()};
  const size_t n = set.map.index(p.i, p.j, p.k);
  if (set.map.states[n] == LeafState::kLeaf) return {set.values(n), 0.0F};
  return {nullptr, set.map.states[n] == LeafState::kSolid ? -set.band() : set.band()};
}

void gather_values(const LevelSet& set, size_t n, ValueBlock& block) {
  const Place p = place_of(set.map, n);
  std::array<LeafView, 27> views;
  for (int v = 0; v < 27; ++v)
    views[v] = leaf_view(set, {p.i + v / 9 - 1, p.j + v / 3 % 3 - 1, p.k + v % 3 - 1});
  const auto scale = static_cast<float>(1.0 / set.voxel);
  float* out = block.values.data();
  for (int i = -1; i <= kBlockSide + 1; ++i) {
    for (int j = -1; j <= kBlockSide + 1; ++j) {
      // (x + 8) / 8 is 0, 1, 2 in the leaf before, here and after.
      const LeafView* row = &views[(i + kBlockSide) / kBlockSide * 9 + (j + kBlockSide) / kBlockSide * 3];
      const int offset = (i & 7) * 64 + (j & 7) * kBlockSide;
      const auto copy = [&](const LeafView& view, int first, int count) {
        for (int k = 0; k < count; ++k) {
          *out++ = scale * (view.values != nullptr ? view.values[offset + first + k] : view.constant);
        }
      };
      copy(row[0], kBlockSide - 1, 1);
      copy(row[1], 0, kBlockSide);
      copy(row[2], 0, 2);
    }
  }
}

/// Sets `marks` at every position whose offset from `n` lies in [low, high] along each axis.
void mark_around(const LeafMap& map, size_t n, int low, int high, std::vector<uint8_t>& marks) {
  const Place p = place_of(map, n);
  for (int i = low; i <= high; ++i) {
    for (int j = low; j <= high; ++j) {
      for (int k = low; k <= high; ++k) {
        const Place q{p.i + i, p.j + j, p.k + k};
        if (known(map, q)) marks[map.index(q.i, q.j, q.k)] = 1;
      }
    }
  }
}

std::vector<size_t> marked(const std::vector<uint8_t>& marks) {
  std::vector<size_t> places;
  for (size_t n = 0; n < marks.size(); ++n) {
    if (marks[n] != 0) places.push_back(n);
  }
  return places;
}

/// Numbers in a patch of the vertices of each leaf that its triangles use: its own and those before them.
class PatchVertices {
 public:
  PatchVertices(TriMesh& mesh, int side)
      : mesh_(mesh), along_(side + 1), slots_(static_cast<size_t>(along_) * along_ * along_) {}

  /// `slot`: of the leaf's position, one before the patch's first on each axis.
  uint32_t number(const Place& slot, const LeafMesh& leaf, uint32_t vertex) {
    std::vector<uint32_t>& numbers =
        slots_[static_cast<size_t>((slot.i * along_ + slot.j) * along_ + slot.k)];
    if (numbers.empty()) numbers.assign(leaf.vertices.size(), kNone);
    uint32_t& number = numbers[vertex];
    if (number == kNone) {
      number = static_cast<uint32_t>(mesh_.positions.size());
      mesh_.positions.push_back(leaf.vertices[vertex].position);
      mesh_.normals.push_back(leaf.vertices[vertex].normal);
    }
    return number;
  }

 private:
  static constexpr uint32_t kNone = 0xffffffffU;
  TriMesh& mesh_;
  int along_;
  std::vector<std::vector<uint32_t>> slots_;
};

}  // namespace

struct StockMesher::Impl {
  const LevelSet& set;
  int side;  ///< of a patch, leaf positions
  std::vector<std::unique_ptr<LeafMesh>> leaves;
  std::vector<uint32_t> seen;   ///< LeafMap::cuts at the last call; empty before the first
  std::vector<uint64_t> drawn;  ///< hash of each leaf's triangles; 0: none
  size_t meshed = 0;

  Impl(const LevelSet& level_set, int patch_side)
      : set(level_set), side(patch_side), leaves(level_set.map.size()), drawn(level_set.map.size(), 0) {}

  std::vector<uint8_t> changed_places();
  bool place(size_t n);
  bool join(size_t n);
  uint64_t hash_of(size_t n, const std::array<const LeafMesh*, 8>& meshes) const;
  std::vector<size_t> update();
  TriMesh assemble() const;
  Eigen::Vector3i patch_dimension() const;
  size_t patch_of(size_t n) const;
  TriMesh patch(size_t number) const;
  std::array<const LeafMesh*, 8> around(size_t n) const;
  Vec3 origin_W(size_t n) const {
    const openvdb::Coord first = set.map.origin(n);
    return set.voxel * Vec3(first.x(), first.y(), first.z());
  }
};

/// Positions whose vertices depend on values that have changed.
std::vector<uint8_t> StockMesher::Impl::changed_places() {
  if (seen.empty()) {
    seen = set.map.cuts;
    return std::vector<uint8_t>(set.map.size(), 1);
  }
  std::vector<uint8_t> changed(set.map.size(), 0);
  for (size_t n = 0; n < seen.size(); ++n) {
    if (seen[n] != set.map.cuts[n]) mark_around(set.map, n, -1, 1, changed);
  }
  seen = set.map.cuts;
  return changed;
}

/// Vertices and edges of a position from its values; false: they are what they were, and so are its triangles
/// if those of the leaves before it are.
bool StockMesher::Impl::place(size_t n) {
  std::unique_ptr<LeafMesh> made;
  if (set.map.states[n] == LeafState::kLeaf) {
    ValueBlock block;
    gather_values(set, n, block);
    made = std::make_unique<LeafMesh>();
    if (!place_vertices(block, origin_W(n), set.voxel, *made)) made.reset();
  }
  const bool same = made && leaves[n]
                        ? made->vertices == leaves[n]->vertices && made->edges == leaves[n]->edges
                        : !made && !leaves[n];
  if (!same) leaves[n] = std::move(made);
  return !same;
}

std::array<const LeafMesh*, 8> StockMesher::Impl::around(size_t n) const {
  const Place p = place_of(set.map, n);
  std::array<const LeafMesh*, 8> meshes{};
  for (int v = 0; v < 8; ++v) {
    const Place q{p.i - (v >> 2), p.j - (v >> 1 & 1), p.k - (v & 1)};
    if (known(set.map, q)) meshes[v] = leaves[set.map.index(q.i, q.j, q.k)].get();
  }
  return meshes;
}

/// Of the leaf's triangles as they are drawn: places and normals of their corners.
uint64_t StockMesher::Impl::hash_of(size_t n, const std::array<const LeafMesh*, 8>& meshes) const {
  Hash hash;
  for (const auto& triangle : leaves[n]->triangles) {
    for (const VertexRef ref : triangle) {
      const LeafVertex& vertex = meshes[ref >> 16]->vertices[ref & 0xffffU];
      for (const float c : vertex.position) hash.add(c);
      for (const float c : vertex.normal) hash.add(c);
    }
  }
  return hash.value();
}

/// False: its triangles are drawn as they were.
bool StockMesher::Impl::join(size_t n) {
  uint64_t now = 0;
  if (leaves[n]) {
    const std::array<const LeafMesh*, 8> meshes = around(n);
    join_vertices(meshes, origin_W(n), set.voxel, *leaves[n]);
    if (!leaves[n]->triangles.empty()) now = hash_of(n, meshes);
  }
  return std::exchange(drawn[n], now) != now;
}

/// Positions whose triangles are new.
std::vector<size_t> StockMesher::Impl::update() {
  const bool first = seen.empty();
  const std::vector<size_t> around_cuts = marked(changed_places());
  meshed = static_cast<size_t>(std::count_if(around_cuts.begin(), around_cuts.end(), [&](size_t n) {
    return set.map.states[n] == LeafState::kLeaf;
  }));
  std::vector<uint8_t> differs(around_cuts.size(), 1);
  parallel_chunks(around_cuts.size(), kMeshedPerTask, [&](size_t begin, size_t end) {
    for (size_t c = begin; c < end; ++c) differs[c] = place(around_cuts[c]) ? 1 : 0;
  });
  // A leaf's triangles use vertices of the leaves before it.
  std::vector<uint8_t> joined(set.map.size(), first ? 1 : 0);
  for (size_t c = 0; c < around_cuts.size() && !first; ++c) {
    if (differs[c] != 0) mark_around(set.map, around_cuts[c], 0, 1, joined);
  }
  std::vector<size_t> places = marked(joined);
  std::vector<uint8_t> other(places.size(), 1);
  parallel_chunks(places.size(), kMeshedPerTask, [&](size_t begin, size_t end) {
    for (size_t c = begin; c < end; ++c) other[c] = join(places[c]) || first ? 1 : 0;
  });
  std::vector<size_t> redrawn;
  for (size_t c = 0; c < places.size(); ++c) {
    if (other[c] != 0) redrawn.push_back(places[c]);
  }
  return redrawn;
}

TriMesh StockMesher::Impl::assemble() const {
  std::vector<size_t> places;
  std::vector<uint32_t> first_vertex(leaves.size(), 0);
  std::vector<size_t> first_triangle(leaves.size(), 0);
  size_t vertices = 0, triangles = 0;
  for (size_t n = 0; n < leaves.size(); ++n) {
    if (!leaves[n]) continue;
    places.push_back(n);
    first_vertex[n] = static_cast<uint32_t>(vertices);
    first_triangle[n] = triangles;
    vertices += leaves[n]->vertices.size();
    triangles += leaves[n]->triangles.size();
  }
  SWARF_CHECK(vertices < 0xffffffffU, "more vertices than 32 bits can number");
  TriMesh mesh;
  mesh.positions.resize(vertices);
  mesh.normals.resize(vertices);
  mesh.triangles.resize(triangles);
  parallel_chunks(places.size(), kMeshedPerTask, [&](size_t begin, size_t end) {
    for (size_t c = begin; c < end; ++c) {
      const size_t n = places[c];
      const LeafMesh& leaf = *leaves[n];
      for (size_t v = 0; v < leaf.vertices.size(); ++v) {
        mesh.positions[first_vertex[n] + v] = leaf.vertices[v].position;
        mesh.normals[first_vertex[n] + v] = leaf.vertices[v].normal;
      }
      const Place p = place_of(set.map, n);
      std::array<uint32_t, 8> base{};
      for (int v = 0; v < 8; ++v) {
        const Place q{p.i - (v >> 2), p.j - (v >> 1 & 1), p.k - (v & 1)};
        if (known(set.map, q)) base[v] = first_vertex[set.map.index(q.i, q.j, q.k)];
      }
      for (size_t t = 0; t < leaf.triangles.size(); ++t) {
        auto& triangle = mesh.triangles[first_triangle[n] + t];
        for (int corner = 0; corner < 3; ++corner) {
          const VertexRef ref = leaf.triangles[t][corner];
          triangle[corner] = base[ref >> 16] + (ref & 0xffffU);
        }
      }
    }
  });
  return mesh;
}

Eigen::Vector3i StockMesher::Impl::patch_dimension() const {
  const auto along = [&](int positions) { return (positions + side - 1) / side; };
  return {along(set.map.dimension.x()), along(set.map.dimension.y()), along(set.map.dimension.z())};
}

size_t StockMesher::Impl::patch_of(size_t n) const {
  const Place p = place_of(set.map, n);
  const Eigen::Vector3i many = patch_dimension();
  return (static_cast<size_t>(p.i / side) * many.y() + p.j / side) * many.z() + p.k / side;
}

TriMesh StockMesher::Impl::patch(size_t number) const {
  const Eigen::Vector3i many = patch_dimension();
  const auto plane = static_cast<size_t>(many.y()) * many.z();
  const Place low{static_cast<int>(number / plane) * side, static_cast<int>(number % plane / many.z()) * side,
                  static_cast<int>(number % many.z()) * side};
  TriMesh mesh;
  PatchVertices vertices(mesh, side);
  for (int v = 0; v < side * side * side; ++v) {
    const Place at{v / (side * side), v / side % side, v % side};
    const Place p{low.i + at.i, low.j + at.j, low.k + at.k};
    if (!known(set.map, p)) continue;
    const size_t n = set.map.index(p.i, p.j, p.k);
    if (!leaves[n]) continue;
    const std::array<const LeafMesh*, 8> meshes = around(n);
    for (const auto& triangle : leaves[n]->triangles) {
      std::array<uint32_t, 3> corners{};
      for (size_t c = 0; c < 3; ++c) {
        const uint32_t before = triangle[c] >> 16;
        const Place slot{at.i + 1 - static_cast<int>(before >> 2),
                         at.j + 1 - static_cast<int>(before >> 1 & 1),
                         at.k + 1 - static_cast<int>(before & 1)};
        corners[c] = vertices.number(slot, *meshes[before], triangle[c] & 0xffffU);
      }
      mesh.triangles.push_back(corners);
    }
  }
  return mesh;
}

StockMesher::StockMesher(const Stock& stock, int patch_side)
    : impl_(std::make_unique<Impl>(stock.level_set(), patch_side)) {}
StockMesher::~StockMesher() = default;
StockMesher::StockMesher(StockMesher&&) noexcept = default;

TriMesh StockMesher::mesh() {
  impl_->update();
  return impl_->assemble();
}
std::vector<size_t> StockMesher::update() {
  std::vector<size_t> changed;
  for (const size_t n : impl_->update()) changed.push_back(impl_->patch_of(n));
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  return changed;
}
int StockMesher::leaves_along(const Stock& stock) {
  const auto& along = stock.level_set().map.dimension;
  return std::max({along.x(), along.y(), along.z()});
}
size_t StockMesher::patches() const {
  return static_cast<size_t>(impl_->patch_dimension().cast<int64_t>().prod());
}
TriMesh StockMesher::patch(size_t number) const {
  return impl_->patch(number);
}
size_t StockMesher::leaves_meshed() const {
  return impl_->meshed;
}
size_t StockMesher::memory_bytes() const {
  size_t bytes =
      impl_->leaves.size() * (sizeof(impl_->leaves[0]) + sizeof(impl_->seen[0]) + sizeof(impl_->drawn[0]));
  for (const auto& leaf : impl_->leaves) {
    if (!leaf) continue;
    bytes += sizeof(LeafMesh) + leaf->vertices.capacity() * sizeof(leaf->vertices[0]) +
             leaf->edges.capacity() * sizeof(leaf->edges[0]) +
             leaf->triangles.capacity() * sizeof(leaf->triangles[0]);
  }
  return bytes;
}

TriMesh Stock::mesh() const {
  return StockMesher(*this).mesh();
}

}  // namespace swarf::stock
