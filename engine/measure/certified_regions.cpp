#include "measure/certified_regions.h"

#include <algorithm>
#include <cmath>
#include <map>
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

int level_of(const CellDisc& disc) {
  int exponent = 0;
  std::frexp(std::max(disc.radius, 1e-6), &exponent);
  return exponent;
}

/// Calls join(n, m) for each that touches disc n.
template <typename Join>
void join_near(const std::vector<CellDisc>& discs, uint32_t n, const SizeClass& others, const Join& join) {
  constexpr double kTouching = 1e-6;  // mm
  for (int code = 0; code < 27; ++code) {
    const uint64_t key = cube_key(discs[n].centre, others.side, code / 9 - 1, code / 3 % 3 - 1, code % 3 - 1);
    const auto [first, last] = others.cubes.equal_range(key);
    for (auto it = first; it != last; ++it) {
      const CellDisc &a = discs[n], &b = discs[it->second];
      if ((a.centre - b.centre).norm() <= a.radius + b.radius + kTouching) join(n, it->second);
    }
  }
}

template <typename Join>
void join_touching(const std::vector<CellDisc>& discs, const Join& join) {
  std::map<int, SizeClass> classes;
  for (uint32_t n = 0; n < discs.size(); ++n) {
    SizeClass& home = classes[level_of(discs[n])];
    home.side = 2.0 * std::ldexp(1.0, level_of(discs[n]));
    home.cubes.emplace(cube_key(discs[n].centre, home.side, 0, 0, 0), n);
  }
  // Each looks for those of its own size and larger: two that touch are met from the smaller one.
  for (uint32_t n = 0; n < discs.size(); ++n) {
    for (auto it = classes.find(level_of(discs[n])); it != classes.end(); ++it)
      join_near(discs, n, it->second, join);
  }
}

/// What became of parts: one for each set, in the order of their first members.
struct Joined {
  std::vector<RegionPart> wholes;
  std::vector<size_t> whole_of;  ///< of each part
};

Joined joined_parts(const std::vector<RegionPart>& parts, DisjointSets& sets) {
  Joined result;
  for (uint32_t n = 0; n < parts.size(); ++n) {
    const uint32_t first = sets.root(n);
    result.whole_of.push_back(first == n ? result.wholes.size() : result.whole_of[first]);
    if (first == n) result.wholes.emplace_back();
    result.wholes[result.whole_of[n]].add(parts[n]);
  }
  return result;
}

}  // namespace

void RegionPart::add(const RegionPart& other) {
  area_mm2 += other.area_mm2;
  volume_mm3 += other.volume_mm3;
  if (other.worst_mm <= worst_mm) return;
  worst_mm = other.worst_mm;
  place = other.place;
  block = other.block;
}

void add_piece(const DesignCell& cell, const std::array<double, 3>& values_mm,
               const std::array<uint32_t, 3>& blocks, double limit_mm, bool near_rim,
               std::vector<RegionPiece>& pieces) {
  const size_t worst =
      static_cast<size_t>(std::max_element(values_mm.begin(), values_mm.end()) - values_mm.begin());
  if (!(values_mm[worst] > limit_mm)) return;
  const Above above = above_limit(values_mm, limit_mm);
  const double area = above.share * cell.area_mm2();
  pieces.push_back({{area, area * above.mean, values_mm[worst], cell.corners[worst].point, blocks[worst]},
                    {cell.centroid(), cell.radius()},
                    near_rim});
}

RootRegions join_pieces(const std::vector<RegionPiece>& pieces) {
  std::vector<CellDisc> discs;
  std::vector<RegionPart> parts;
  for (const RegionPiece& piece : pieces) {
    discs.push_back(piece.disc);
    parts.push_back(piece.part);
  }
  DisjointSets sets(pieces.size());
  join_touching(discs, [&](uint32_t a, uint32_t b) { sets.join(a, b); });
  Joined root = joined_parts(parts, sets);
  std::vector<RootRegions::Rim> rim;
  for (size_t n = 0; n < pieces.size(); ++n)
    if (pieces[n].near_rim) rim.push_back({pieces[n].disc, root.whole_of[n]});
  rim.shrink_to_fit();
  root.wholes.shrink_to_fit();
  return {std::move(root.wholes), std::move(rim)};
}

std::vector<Region> join_roots(const std::vector<const RootRegions*>& roots) {
  std::vector<RegionPart> parts;
  std::vector<CellDisc> discs;
  std::vector<uint32_t> part_of;
  for (const RootRegions* root : roots) {
    for (const RootRegions::Rim& rim : root->rim) {
      discs.push_back(rim.disc);
      part_of.push_back(static_cast<uint32_t>(parts.size() + rim.part));
    }
    parts.insert(parts.end(), root->parts.begin(), root->parts.end());
  }
  DisjointSets sets(parts.size());
  join_touching(discs, [&](uint32_t a, uint32_t b) { sets.join(part_of[a], part_of[b]); });
  std::vector<Region> regions;
  for (const RegionPart& whole : joined_parts(parts, sets).wholes)
    regions.push_back(
        {um_from_mm(whole.worst_mm), whole.area_mm2, whole.volume_mm3, whole.place, whole.block});
  std::stable_sort(regions.begin(), regions.end(), larger);
  return regions;
}

}  // namespace swarf::measure
