#include "measure/certified_regions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>

#include "base/disjoint_sets.h"
#include "base/units.h"
#include "measure/regions.h"

namespace swarf::measure {
namespace {

/// Share of a triangle above the limit and the mean value there, for values linear between its corners.
struct Above {
  double share = 0.0, mean = 0.0;
};

Above above_limit(std::array<double, 3> v, double limit) {
  std::sort(v.begin(), v.end());
  if (v[0] >= limit) return {1.0, (v[0] + v[1] + v[2]) / 3.0};
  if (v[2] <= limit) return {};
  if (v[1] <= limit) {  // one corner above: a triangle similar in both edges
    const double share = (v[2] - limit) / (v[2] - v[0]) * (v[2] - limit) / (v[2] - v[1]);
    return {share, (v[2] + 2.0 * limit) / 3.0};
  }
  const double below = (limit - v[0]) / (v[1] - v[0]) * (limit - v[0]) / (v[2] - v[0]);
  const double whole = (v[0] + v[1] + v[2]) / 3.0, part = (v[0] + 2.0 * limit) / 3.0;
  return {1.0 - below, (whole - below * part) / (1.0 - below)};
}

/// Pieces of one size class (radius below 2^level) by the cube of that size they lie in.
struct SizeClass {
  double side = 0.0;
  std::unordered_multimap<uint64_t, uint32_t> cubes;  // looked up only: its order never shows in the sets
};

uint64_t cube_key(const Vec3& p, double side, int dx, int dy, int dz) {
  constexpr uint64_t kMask = (uint64_t{1} << 21U) - 1;
  const auto part = [&](double x, int d) {
    return static_cast<uint64_t>(static_cast<int64_t>(std::floor(x / side)) + d) & kMask;
  };
  return part(p.x(), dx) << 42U | part(p.y(), dy) << 21U | part(p.z(), dz);
}

void join_near(const std::vector<RegionPiece>& pieces, uint32_t n, const SizeClass& others,
               DisjointSets& sets) {
  constexpr double kTouch = 1e-6;  // mm
  for (int code = 0; code < 27; ++code) {
    const uint64_t key =
        cube_key(pieces[n].centre, others.side, code / 9 - 1, code / 3 % 3 - 1, code % 3 - 1);
    const auto [first, last] = others.cubes.equal_range(key);
    for (auto it = first; it != last; ++it) {
      const RegionPiece &a = pieces[n], &b = pieces[it->second];
      if ((a.centre - b.centre).norm() <= a.radius + b.radius + kTouch) sets.join(n, it->second);
    }
  }
}

}  // namespace

void add_piece(const DesignCell& cell, const std::array<double, 3>& values_mm,
               const std::array<uint32_t, 3>& blocks, double limit_mm, std::vector<RegionPiece>& pieces) {
  const size_t worst =
      static_cast<size_t>(std::max_element(values_mm.begin(), values_mm.end()) - values_mm.begin());
  if (!(values_mm[worst] > limit_mm)) return;
  const Above above = above_limit(values_mm, limit_mm);
  const double area = above.share * cell.area_mm2();
  pieces.push_back({cell.centroid(), cell.radius(), area, area * above.mean, values_mm[worst],
                    cell.corners[worst].point, blocks[worst]});
}

std::vector<Region> join_pieces(const std::vector<RegionPiece>& pieces) {
  DisjointSets sets(pieces.size());
  std::map<int, SizeClass> classes;
  const auto level = [&](const RegionPiece& piece) {
    int exponent = 0;
    std::frexp(std::max(piece.radius, 1e-6), &exponent);
    return exponent;
  };
  for (uint32_t n = 0; n < pieces.size(); ++n) {
    SizeClass& home = classes[level(pieces[n])];
    home.side = 2.0 * std::ldexp(1.0, level(pieces[n]));
    home.cubes.emplace(cube_key(pieces[n].centre, home.side, 0, 0, 0), n);
  }
  // Each piece looks for those of its own size and larger: two that touch are met from the smaller one.
  for (uint32_t n = 0; n < pieces.size(); ++n) {
    for (auto it = classes.find(level(pieces[n])); it != classes.end(); ++it)
      join_near(pieces, n, it->second, sets);
  }
  std::vector<Region> regions;
  std::vector<uint32_t> region_of(pieces.size());
  for (uint32_t n = 0; n < pieces.size(); ++n) {
    const uint32_t root = sets.root(n);
    if (root == n) {
      region_of[n] = static_cast<uint32_t>(regions.size());
      regions.emplace_back();
    }
    Region& region = regions[region_of[root]];
    const RegionPiece& piece = pieces[n];
    region.area_mm2 += piece.area_mm2;
    region.volume_mm3 += piece.volume_mm3;
    if (um_from_mm(piece.worst_mm) <= region.worst_um) continue;
    region.worst_um = um_from_mm(piece.worst_mm);
    region.place = piece.place;
    region.block = piece.block;
  }
  std::sort(regions.begin(), regions.end(), larger);
  return regions;
}

}  // namespace swarf::measure
