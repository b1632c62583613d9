#include "stock/mesher/mesher_leaf.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/check.h"

namespace swarf::stock {
namespace {

constexpr int kSide = 8;

/// Bit k + 1 of column (i, j) is set when grid point (i, j, k) is inside; i, j, k in [-1, 9].
class SignColumns {
 public:
  explicit SignColumns(const ValueBlock& block) {
    for (int column = 0; column < ValueBlock::kSide * ValueBlock::kSide; ++column) {
      const float* values = block.values.data() + static_cast<ptrdiff_t>(column) * ValueBlock::kSide;
      unsigned bits = 0;
      for (int k = 0; k < ValueBlock::kSide; ++k) bits |= static_cast<unsigned>(values[k] < 0.0F) << k;
      bits_[column] = static_cast<uint16_t>(bits);
    }
  }
  /// Bit k is set when the surface passes cell (i, j, k), 0 <= k < 8.
  unsigned passed(int i, int j) const {
    const unsigned any = at(i, j) | at(i, j + 1) | at(i + 1, j) | at(i + 1, j + 1);
    const unsigned all = at(i, j) & at(i, j + 1) & at(i + 1, j) & at(i + 1, j + 1);
    return ((any | any >> 1) & ~(all & all >> 1)) >> 1 & 0xffU;
  }
  CellSigns cell(int i, int j, int k) const {
    unsigned signs = 0;
    for (int column = 0; column < 4; ++column) {
      signs |= (at(i + (column >> 1), j + (column & 1)) >> (k + 1) & 3U) << (2 * column);
    }
    return static_cast<CellSigns>(signs);
  }

 private:
  unsigned at(int i, int j) const { return bits_[(i + 1) * ValueBlock::kSide + j + 1]; }
  std::array<uint16_t, static_cast<size_t>(ValueBlock::kSide) * ValueBlock::kSide> bits_{};
};

CellPatches patches_of(const SignColumns& signs, int i, int j, int k) {
  const CellSigns here = signs.cell(i, j, k);
  const uint8_t met = twice_met_faces(here);
  if (met == 0) return cell_patches(here);
  uint8_t flipped = 0;
  for (int face = 0; face < 6; ++face) {
    if ((met >> face & 1) == 0) continue;
    std::array<int, 3> next{i, j, k};
    next[face / 2] += face % 2 != 0 ? 1 : -1;
    const uint8_t other = twice_met_faces(signs.cell(next[0], next[1], next[2]));
    // Seen from the other side the face's side changes.
    if ((other >> (face ^ 1) & 1) != 0) flipped = static_cast<uint8_t>(flipped | 1 << face);
  }
  return flipped == 0 ? cell_patches(here) : cell_patches(here, flipped);
}

/// Makes the vertices of one leaf, cell by cell.
class VertexPlacer {
 public:
  VertexPlacer(const ValueBlock& block, const Vec3& origin_W, double voxel_mm, LeafMesh& mesh)
      : block_(block), origin_W_(origin_W), voxel_mm_(voxel_mm), mesh_(mesh) {}

  void place(int i, int j, int k, const CellPatches& patches) {
    const float* corner = block_.values.data() + ValueBlock::index(i, j, k);
    const auto cell = static_cast<uint16_t>((i * kSide + j) * kSide + k);
    const CellSample sample(corner);
    mesh_.first[cell] = static_cast<uint16_t>(mesh_.vertices.size());
    const Vec3 low = origin_W_ + voxel_mm_ * Vec3(i, j, k);
    if (patches.count == 1 && !sample.kinked()) {
      add(low, sample.vertex(patches.edges[0]), patches.edges[0]);
      add_edges(cell, sample.value, patches.edges[0], [&](int edge) { return sample.crossing(edge); });
      return;
    }
    const KinkedCell kinked(corner, sample);
    uint16_t edges = 0;
    for (int p = 0; p < patches.count; ++p) {
      add(low, kinked.vertex(patches.edges[p], patches.count == 1), patches.edges[p]);
      edges = static_cast<uint16_t>(edges | patches.edges[p]);
    }
    add_edges(cell, sample.value, edges, [&](int edge) { return static_cast<float>(kinked.crossing(edge)); });
  }

 private:
  void add(const Vec3& low, const CellVertex& vertex, uint16_t edges) {
    const Eigen::Vector3f p = (low + voxel_mm_ * vertex.place.cast<double>()).cast<float>();
    mesh_.vertices.push_back({{p.x(), p.y(), p.z()},
                              {vertex.normal.x(), vertex.normal.y(), vertex.normal.z()},
                              edges,
                              vertex.sharp});
  }
  template <class Crossing>
  void add_edges(uint16_t cell, const std::array<float, 8>& value, uint16_t edges, const Crossing& crossing) {
    for (int axis = 0; axis < 3; ++axis) {
      const int edge = 4 * axis;  // from corner 0
      if ((edges >> edge & 1) == 0) continue;
      mesh_.edges.push_back({cell, static_cast<uint8_t>(axis), value[0] < 0.0F, crossing(edge)});
    }
  }

  const ValueBlock& block_;
  Vec3 origin_W_;
  double voxel_mm_;
  LeafMesh& mesh_;
};

/// A corner of a quad, in the plane across the grid edge and along it, relative to the edge's lower end,
/// voxels.
struct QuadCorner {
  VertexRef ref;
  const LeafVertex* vertex;
  Eigen::Vector3d place;   ///< u, v, along
  Eigen::Vector3d normal;  ///< outward if the inside is at the lower end, else inward
};

QuadCorner quad_corner(const std::array<const LeafMesh*, 8>& around, std::array<int, 3> cell, int edge) {
  unsigned leaf = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (cell[axis] >= 0) continue;
    cell[axis] += kSide;
    leaf |= static_cast<unsigned>(corner_step(axis));
  }
  const LeafMesh& mesh = *around[leaf];
  unsigned n = mesh.first[(cell[0] * kSide + cell[1]) * kSide + cell[2]];
  while ((mesh.vertices[n].edges >> edge & 1) == 0) ++n;
  return {leaf << 16 | n, &mesh.vertices[n], {}, {}};
}

/// How little the triangle agrees with the sheets of its corners: those that lie on one sheet know its
/// normal.
double disagreement(const QuadCorner& a, const QuadCorner& b, const QuadCorner& c) {
  constexpr double kSliver = 1e-4;  // square voxels
  const Eigen::Vector3d cross = (b.place - a.place).cross(c.place - a.place);
  const double length = cross.norm();
  if (length < kSliver) return 1.0;
  double sum = 0.0;
  for (const QuadCorner* corner : {&a, &b, &c}) {
    if (!corner->vertex->sharp) sum += 1.0 - cross.dot(corner->normal) / length;
  }
  return sum;
}

/// Where the grid edge meets the two triangles on either side of the diagonal a-c of the quad a, b, c, d.
double height_on_edge(const QuadCorner& a, const QuadCorner& b, const QuadCorner& c, const QuadCorner& d) {
  const Eigen::Vector3d diagonal = c.place - a.place;
  // The quad runs counter-clockwise around the edge, so d lies to the left of a-c.
  const double side = diagonal.x() * -a.place.y() - diagonal.y() * -a.place.x();
  const Eigen::Vector3d normal = side > 0.0 ? Eigen::Vector3d(diagonal.cross(d.place - a.place))
                                            : Eigen::Vector3d((b.place - a.place).cross(diagonal));
  if (!(normal.z() > 0.0)) return std::numeric_limits<double>::infinity();
  return normal.dot(a.place) / normal.z();
}

/// Whether a triangle of the quad runs the wrong way round its grid edge: the surface would be folded there.
bool turns_back(const QuadCorner& a, const QuadCorner& b, const QuadCorner& c) {
  return (b.place - a.place).cross(c.place - a.place).z() < 0.0;
}

/// Whether the diagonal 0-2 is to be taken: that one which leaves the quad without a fold. If both do, beside
/// sharp edges that one whose triangles agree with the sheets, or if neither is better the one that passes
/// through the crossing of the grid edge; elsewhere the shorter.
bool first_diagonal(const std::array<QuadCorner, 4>& q, double crossing) {
  const bool shorter = (q[0].place - q[2].place).squaredNorm() <= (q[1].place - q[3].place).squaredNorm();
  if (std::none_of(q.begin(), q.end(), [](const QuadCorner& c) { return c.vertex->sharp; })) return shorter;
  const bool first_folds = turns_back(q[0], q[1], q[2]) || turns_back(q[0], q[2], q[3]);
  const bool second_folds = turns_back(q[1], q[2], q[3]) || turns_back(q[1], q[3], q[0]);
  if (first_folds != second_folds) return second_folds;
  constexpr double kEqual = 1e-3;
  const double first = disagreement(q[0], q[1], q[2]) + disagreement(q[0], q[2], q[3]);
  const double second = disagreement(q[1], q[2], q[3]) + disagreement(q[1], q[3], q[0]);
  if (std::abs(first - second) > kEqual) return first < second;
  const double above = std::abs(height_on_edge(q[0], q[1], q[2], q[3]) - crossing);
  const double beside = std::abs(height_on_edge(q[1], q[2], q[3], q[0]) - crossing);
  if (above < beside - kEqual) return true;
  if (beside < above - kEqual) return false;
  return shorter;
}

}  // namespace

bool place_vertices(const ValueBlock& block, const Vec3& origin_W, double voxel_mm, LeafMesh& mesh) {
  const SignColumns signs(block);
  bool begun = false;
  VertexPlacer placer(block, origin_W, voxel_mm, mesh);
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      for (unsigned passed = signs.passed(i, j); passed != 0; passed &= passed - 1) {
        if (!begun) {
          mesh.first.fill(LeafMesh::kNoVertex);
          mesh.vertices.clear();
          mesh.edges.clear();
          begun = true;
        }
        const int k = std::countr_zero(passed);
        placer.place(i, j, k, patches_of(signs, i, j, k));
      }
    }
  }
  return begun;
}

void join_vertices(const std::array<const LeafMesh*, 8>& around, const Vec3& origin_W, double voxel_mm,
                   LeafMesh& mesh) {
  mesh.triangles.clear();
  mesh.triangles.reserve(2 * mesh.edges.size());
  for (const LeafEdge& edge : mesh.edges) {
    const int axis = edge.axis, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const std::array<int, 3> low{edge.cell / 64, edge.cell / kSide % kSide, edge.cell % kSide};
    const Vec3 foot = origin_W + voxel_mm * Vec3(low[0], low[1], low[2]);
    std::array<QuadCorner, 4> q;
    for (int n = 0; n < 4; ++n) {
      const bool before_u = n == 0 || n == 3, before_v = n < 2;
      std::array<int, 3> cell = low;
      cell[u] -= before_u ? 1 : 0;
      cell[v] -= before_v ? 1 : 0;
      // The edge's place in a cell that lies before it is at the far side: 2p + q of the two other axes.
      const int at_u = before_u ? 1 : 0, at_v = before_v ? 1 : 0;
      const int place = u < v ? 2 * at_u + at_v : 2 * at_v + at_u;
      q[n] = quad_corner(around, cell, 4 * axis + place);
      const auto& p = q[n].vertex->position;
      q[n].place = Vec3(p[u] - foot[u], p[v] - foot[v], p[axis] - foot[axis]) / voxel_mm;
      const auto& normal = q[n].vertex->normal;
      q[n].normal = (edge.upward ? 1.0 : -1.0) * Vec3(normal[u], normal[v], normal[axis]);
    }
    const bool first = first_diagonal(q, edge.crossing);
    // Counter-clockwise about the axis; outward is along the axis if the inside is at the lower end.
    std::array<std::array<int, 3>, 2> split{{{0, 1, 2}, {0, 2, 3}}};
    if (!first) split = {{{1, 2, 3}, {1, 3, 0}}};
    for (auto& t : split) {
      if (!edge.upward) std::swap(t[1], t[2]);
      mesh.triangles.push_back({q[t[0]].ref, q[t[1]].ref, q[t[2]].ref});
    }
  }
}

}  // namespace swarf::stock
