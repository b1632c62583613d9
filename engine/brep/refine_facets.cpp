#include "brep/refine_facets.h"

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <unordered_set>

#include "mesh/mesh_check.h"

namespace swarf::brep {
namespace {

using surface::FacetOnSurface;

/// Halved, a side of a circle strays a quarter as far; with room for other curves.
constexpr double kHalvedChord = 0.3;
constexpr int kMostRounds = 6;

uint64_t side_key(uint32_t a, uint32_t b) {
  return uint64_t{std::min(a, b)} << 32U | std::max(a, b);
}

/// A corner of a part: its vertex and its place on the surface.
struct PartCorner {
  uint32_t vertex = 0;
  Vec2 uv = Vec2::Zero();
};

class Refiner {
 public:
  Refiner(const TriMesh& mesh, const surface::UnderFacets& under) : under_(under) {
    const mesh::WeldedMesh welded = mesh::weld(mesh);
    points_ = welded.points;
    triangles_ = welded.triangles;
    for (const uint32_t source : welded.sources) facets_.push_back(under.facets[source]);
  }

  /// False: no side strays farther than the chord.
  bool halve(double chord_mm) {
    find_middles(chord_mm);
    if (middles_.empty()) return false;
    std::vector<std::array<uint32_t, 3>> triangles;
    std::vector<FacetOnSurface> facets;
    triangles.swap(triangles_);
    facets.swap(facets_);
    for (size_t i = 0; i < triangles.size(); ++i) divide(triangles[i], facets[i]);
    return true;
  }
  size_t size() const { return triangles_.size(); }

  RefinedFacets finish() && {
    RefinedFacets refined;
    for (const Vec3& p : points_)
      refined.mesh.positions.push_back(
          {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    refined.mesh.triangles = std::move(triangles_);
    refined.under = under_;
    refined.under.facets = std::move(facets_);
    return refined;
  }

 private:
  bool is_curved(const FacetOnSurface& on) const {
    return on.surface != FacetOnSurface::kNone && under_.is_plane[static_cast<size_t>(on.surface)] == 0;
  }

  void find_middles(double chord_mm) {
    middles_.clear();
    std::unordered_set<uint64_t> whole;
    for (size_t i = 0; i < triangles_.size(); ++i) {
      for (size_t k = 0; k < 3; ++k)
        if (facets_[i].edges[k] != FacetOnSurface::kNone)
          whole.insert(side_key(triangles_[i][k], triangles_[i][(k + 1) % 3]));
    }
    for (size_t i = 0; i < triangles_.size(); ++i) {
      if (!is_curved(facets_[i])) continue;
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t a = triangles_[i][k], b = triangles_[i][(k + 1) % 3];
        const uint64_t key = side_key(a, b);
        if (middles_.contains(key) || whole.contains(key)) continue;
        const Vec2 uv = 0.5 * (facets_[i].uv[k] + facets_[i].uv[(k + 1) % 3]);
        const Vec3 on = under_.surfaces[static_cast<size_t>(facets_[i].surface)]->point(uv.x(), uv.y());
        if ((on - 0.5 * (points_[a] + points_[b])).norm() <= chord_mm) continue;
        middles_[key] = static_cast<uint32_t>(points_.size());
        points_.push_back(on.cast<float>().cast<double>());
      }
    }
  }

  std::optional<PartCorner> middle_of(const std::array<uint32_t, 3>& t, const FacetOnSurface& on,
                                      size_t k) const {
    const auto found = middles_.find(side_key(t[k], t[(k + 1) % 3]));
    if (found == middles_.end()) return std::nullopt;
    return PartCorner{found->second, 0.5 * (on.uv[k] + on.uv[(k + 1) % 3])};
  }

  void divide(const std::array<uint32_t, 3>& t, const FacetOnSurface& on) {
    std::array<std::optional<PartCorner>, 3> middles;
    size_t count = 0, first = 3, open = 0;
    for (size_t k = 0; k < 3; ++k) {
      middles[k] = middle_of(t, on, k);
      count += middles[k] ? 1U : 0U;
      if (middles[k] && first == 3) first = k;
      if (!middles[k]) open = k;
    }
    if (count == 0) {
      triangles_.push_back(t);
      facets_.push_back(on);
      return;
    }
    const auto corner = [&](size_t k) { return PartCorner{t[k % 3], on.uv[k % 3]}; };
    const auto middle = [&](size_t k) { return *middles[k % 3]; };
    parent_ = {&t, &on};
    if (count == 1) {
      add({corner(first), middle(first), corner(first + 2)});
      add({middle(first), corner(first + 1), corner(first + 2)});
    } else if (count == 2) {
      // The sides after the whole one meet in a corner of their own.
      add({middle(open + 1), corner(open + 2), middle(open + 2)});
      add({corner(open), corner(open + 1), middle(open + 1)});
      add({corner(open), middle(open + 1), middle(open + 2)});
    } else {
      for (size_t k = 0; k < 3; ++k) add({corner(k), middle(k), middle(k + 2)});
      add({middle(0), middle(1), middle(2)});
    }
  }

  /// What a side of a part has of the side of the facet that it is a half or the whole of.
  void add(const std::array<PartCorner, 3>& part) {
    const auto& [t, on] = parent_;
    FacetOnSurface own;
    own.surface = on->surface;
    for (size_t k = 0; k < 3; ++k) {
      own.uv[k] = part[k].uv;
      const uint32_t a = part[k].vertex, b = part[(k + 1) % 3].vertex;
      for (size_t side = 0; side < 3; ++side) {
        const uint32_t from = (*t)[side], to = (*t)[(side + 1) % 3];
        const auto found = middles_.find(side_key(from, to));
        const bool halved = found != middles_.end();
        if (a == from && b == to) {
          own.edges[k] = on->edges[side];
          own.chords_mm[k] = on->chords_mm[side];
        } else if (halved && ((a == from && b == found->second) || (a == found->second && b == to))) {
          own.chords_mm[k] = kHalvedChord * on->chords_mm[side];
        }
      }
    }
    triangles_.push_back({part[0].vertex, part[1].vertex, part[2].vertex});
    facets_.push_back(own);
  }

  const surface::UnderFacets& under_;
  std::vector<Vec3> points_;
  std::vector<std::array<uint32_t, 3>> triangles_;
  std::vector<FacetOnSurface> facets_;
  std::unordered_map<uint64_t, uint32_t> middles_;  ///< looked up only: its order never shows
  std::pair<const std::array<uint32_t, 3>*, const FacetOnSurface*> parent_{nullptr, nullptr};
};

}  // namespace

RefinedFacets refine(const TriMesh& mesh, const surface::UnderFacets& under, double chord_mm,
                     size_t most_facets) {
  Refiner refiner(mesh, under);
  constexpr size_t kGrows = 4;
  for (int round = 0; round < kMostRounds && refiner.size() * kGrows <= most_facets; ++round) {
    if (!refiner.halve(chord_mm)) break;
  }
  return std::move(refiner).finish();
}

}  // namespace swarf::brep
