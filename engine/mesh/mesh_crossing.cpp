#include "mesh/mesh_crossing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace swarf::mesh {
namespace {

using FacetCorners = std::array<Vec3, 3>;
__extension__ using Wide = __float128;  // 113 bits: products of three differences of floats fit

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
/// Roundings of a determinant of three differences, each term relative to its absolute value (Shewchuk 1997
/// has 7; some more for the simpler form here).
constexpr double kDeterminantRoundings = 16.0;

int sign_of(Wide value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

template <typename Number>
Number determinant(const std::array<std::array<Number, 3>, 3>& m) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) +
         m[0][1] * (m[1][2] * m[2][0] - m[1][0] * m[2][2]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// Without arithmetic: d is one of the others, or all lie in one plane across an axis. So it is for most
/// neighbours, and of those a determinant would be known to vanish from the long numbers only.
bool clearly_in_plane(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  if (d == a || d == b || d == c) return true;
  for (int k = 0; k < 3; ++k) {
    if (a[k] == d[k] && b[k] == d[k] && c[k] == d[k]) return true;
  }
  return false;
}

/// On which side of the plane (a, b, c) d lies: +1 above (counter-clockwise seen from there), 0 in it.
int side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  if (clearly_in_plane(a, b, c, d)) return 0;
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double value = u.cross(v).dot(w);
  const double sum = std::abs(w[0]) * (std::abs(u[1] * v[2]) + std::abs(u[2] * v[1])) +
                     std::abs(w[1]) * (std::abs(u[2] * v[0]) + std::abs(u[0] * v[2])) +
                     std::abs(w[2]) * (std::abs(u[0] * v[1]) + std::abs(u[1] * v[0]));
  if (std::abs(value) > kDeterminantRoundings * kEpsilon * sum) return value > 0.0 ? 1 : -1;
  std::array<std::array<Wide, 3>, 3> rows;
  for (int k = 0; k < 3; ++k) {
    rows[0][k] = Wide(b[k]) - Wide(a[k]);
    rows[1][k] = Wide(c[k]) - Wide(a[k]);
    rows[2][k] = Wide(d[k]) - Wide(a[k]);
  }
  return sign_of(determinant(rows));
}

/// Turn of a, b, c in the plane without axis `drop`: exact.
int turn(const Vec3& a, const Vec3& b, const Vec3& c, int drop) {
  const int x = (drop + 1) % 3, y = (drop + 2) % 3;
  const double value = (b[x] - a[x]) * (c[y] - a[y]) - (b[y] - a[y]) * (c[x] - a[x]);
  const double sum = std::abs((b[x] - a[x]) * (c[y] - a[y])) + std::abs((b[y] - a[y]) * (c[x] - a[x]));
  if (std::abs(value) > kDeterminantRoundings * kEpsilon * sum) return value > 0.0 ? 1 : -1;
  const Wide abx = Wide(b[x]) - Wide(a[x]), aby = Wide(b[y]) - Wide(a[y]);
  const Wide acx = Wide(c[x]) - Wide(a[x]), acy = Wide(c[y]) - Wide(a[y]);
  return sign_of(abx * acy - aby * acx);
}

/// Facets in one plane: no side of either has the other beyond it.
bool overlap_in_plane(const FacetCorners& s, const FacetCorners& t) {
  int drop = 0;
  (s[1] - s[0]).cross(s[2] - s[0]).cwiseAbs().maxCoeff(&drop);
  const auto separated = [&](const FacetCorners& a, const FacetCorners& b) {
    const int own = turn(a[0], a[1], a[2], drop);
    for (size_t i = 0; i < 3; ++i) {
      const auto beyond = [&](const Vec3& p) { return turn(a[i], a[(i + 1) % 3], p, drop) * own <= 0; };
      if (std::all_of(b.begin(), b.end(), beyond)) return true;
    }
    return false;
  };
  return !separated(s, t) && !separated(t, s);
}

/// The line p-q runs through (a, b, c), border included; p and q lie on its two sides.
bool runs_through(const Vec3& p, const Vec3& q, const FacetCorners& t) {
  const int s0 = side(p, q, t[0], t[1]), s1 = side(p, q, t[1], t[2]), s2 = side(p, q, t[2], t[0]);
  return (s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0);
}

bool edges_cross(const FacetCorners& s, const std::array<int, 3>& sides, const FacetCorners& t) {
  for (size_t i = 0; i < 3; ++i) {
    const size_t j = (i + 1) % 3;
    if (sides[i] * sides[j] < 0 && runs_through(s[i], s[j], t)) return true;
  }
  return false;
}

std::array<int, 3> sides_of(const FacetCorners& s, const FacetCorners& plane) {
  return {side(plane[0], plane[1], plane[2], s[0]), side(plane[0], plane[1], plane[2], s[1]),
          side(plane[0], plane[1], plane[2], s[2])};
}

bool facets_cross(const FacetCorners& s, const FacetCorners& t) {
  const std::array<int, 3> of_s = sides_of(s, t);
  if (of_s == std::array{0, 0, 0}) return overlap_in_plane(s, t);
  if (of_s == std::array{1, 1, 1} || of_s == std::array{-1, -1, -1}) return false;
  return edges_cross(s, of_s, t) || edges_cross(t, sides_of(t, s), s);
}

/// As edges_cross(), but an end in the plane counts, and all of an edge in it wherever that edge leads.
bool edges_touch(const FacetCorners& s, const std::array<int, 3>& sides, const FacetCorners& t) {
  for (size_t i = 0; i < 3; ++i) {
    const size_t j = (i + 1) % 3;
    if (sides[i] * sides[j] <= 0 && runs_through(s[i], s[j], t)) return true;
  }
  return false;
}

/// False only where they have no place in common.
bool facets_may_touch(const FacetCorners& s, const FacetCorners& t) {
  const std::array<int, 3> of_s = sides_of(s, t), of_t = sides_of(t, s);
  const auto beside = [](const std::array<int, 3>& sides) {
    return sides == std::array{1, 1, 1} || sides == std::array{-1, -1, -1};
  };
  return !beside(of_s) && !beside(of_t) && (edges_touch(s, of_s, t) || edges_touch(t, of_t, s));
}

/// Rounded to multiples of so few bits that determinants of them fit into 113: three differences of 36 bits
/// and their sum. It is about 1e-10 of the largest coordinate, far below the spacing of floats there.
std::vector<Vec3> rounded_points(const TriMesh& mesh) {
  float largest = 0.0F;
  for (const auto& p : mesh.positions)
    largest = std::max({largest, std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
  constexpr int kBits = 34;
  const double grid =
      std::ldexp(1.0, std::ilogb(std::max(largest, std::numeric_limits<float>::min())) + 1 - kBits);
  std::vector<Vec3> points;
  points.reserve(mesh.positions.size());
  for (const auto& p : mesh.positions)
    points.push_back(grid * (Vec3(p[0], p[1], p[2]) / grid).array().round().matrix());
  return points;
}

struct Span {
  Vec3 low, high;
  explicit Span(const FacetCorners& t)
      : low(t[0].cwiseMin(t[1]).cwiseMin(t[2])), high(t[0].cwiseMax(t[1]).cwiseMax(t[2])) {}
  bool meets(const Span& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

constexpr size_t kFacetsPerTask = 512;

/// Calls found(task, t, others) for each facet t and those of a higher number of which pair(own corners,
/// their corners) is true, ascending within each task of kFacetsPerTask; `others` in no particular order.
/// Parallel.
template <typename Asked, typename Pair, typename Found>
void each_paired(const TriMesh& mesh, const MeshDistance& tree, const Asked& asked, const Pair& pair,
                 const Found& found) {
  const std::vector<Vec3> points = rounded_points(mesh);
  const auto corners = [&](uint32_t t) {
    const auto& v = mesh.triangles[t];
    return FacetCorners{points[v[0]], points[v[1]], points[v[2]]};
  };
  parallel_chunks(mesh.triangles.size(), kFacetsPerTask, [&](size_t begin, size_t end) {
    std::vector<uint32_t> met;
    for (auto t = static_cast<uint32_t>(begin); t < end; ++t) {
      const FacetCorners own = corners(t);
      const Span span(own);
      const Vec3 centre = 0.5 * (span.low + span.high);
      met.clear();
      tree.each_near(centre, 0.5 * (span.high - span.low).norm(), [&](uint32_t other) {
        if (other <= t || !asked(t, other)) return;
        const FacetCorners theirs = corners(other);
        if (span.meets(Span(theirs)) && pair(own, theirs)) met.push_back(other);
      });
      if (!met.empty()) found(begin / kFacetsPerTask, t, met);
    }
  });
}

size_t tasks_of(const TriMesh& mesh) {
  return (mesh.triangles.size() + kFacetsPerTask - 1) / kFacetsPerTask;
}

}  // namespace

bool edge_crosses(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  return side(a, b, c, p) * side(a, b, c, q) < 0 && runs_through(p, q, {a, b, c});
}

Crossings find_crossings(const SignedDistance& mesh) {
  return find_crossings(mesh.mesh(), mesh.tree(), [](uint32_t, uint32_t) { return true; });
}

Crossings find_crossings(const TriMesh& mesh, const MeshDistance& tree,
                         const std::function<bool(uint32_t, uint32_t)>& asked) {
  std::vector<Crossings> parts(tasks_of(mesh));
  each_paired(mesh, tree, asked, facets_cross,
              [&](size_t task, uint32_t t, const std::vector<uint32_t>& met) {
                Crossings& mine = parts[task];
                if (mine.pairs == 0) {
                  mine.first = t;
                  mine.second = *std::min_element(met.begin(), met.end());
                  const auto& p = mesh.positions[mesh.triangles[t][0]];
                  mine.place = Vec3(p[0], p[1], p[2]);
                }
                mine.pairs += met.size();
              });
  Crossings all;
  for (const Crossings& part : parts) {
    const size_t pairs = all.pairs + part.pairs;
    if (all.pairs == 0) all = part;
    all.pairs = pairs;
  }
  return all;
}

std::vector<std::array<uint32_t, 2>> touching_pairs(const TriMesh& mesh, const MeshDistance& tree,
                                                    const std::function<bool(uint32_t, uint32_t)>& asked) {
  std::vector<std::vector<std::array<uint32_t, 2>>> parts(tasks_of(mesh));
  each_paired(mesh, tree, asked, facets_may_touch,
              [&](size_t task, uint32_t t, const std::vector<uint32_t>& met) {
                for (const uint32_t other : met) parts[task].push_back({t, other});
              });
  std::vector<std::array<uint32_t, 2>> pairs;
  for (const auto& part : parts) pairs.insert(pairs.end(), part.begin(), part.end());
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace swarf::mesh
