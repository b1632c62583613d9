#include "brep/refine_facets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

#include "base/parallel.h"
#include "brep/facet_chord.h"

namespace swarf::brep {
namespace {

constexpr int kNoEdge = surface::FacetOnSurface::kNone;

/// A side's piece of a curved edge: places [from, to] along it, or back, by real numbers.
struct Piece {
  int edge = kNoEdge;
  double from = 0.0, to = 0.0;
};

struct FineFacet {
  int surface = 0;
  std::array<uint32_t, 3> corners{};
  std::array<Vec2, 3> uv{};
  std::array<Piece, 3> sides{};  ///< side k, from corner k to the next
};

/// A place half way along a side, as one of its facets knows it.
struct Middle {
  int rank = 0;  ///< 3: on a curved edge, 2: on a curved surface, 1: straight
  Vec3 point = Vec3::Zero();
  double sagitta_mm = 0.0;
  uint32_t vertex = 0xffffffffu;  ///< once it is made
};

using SideKey = std::pair<uint32_t, uint32_t>;
SideKey key_of(uint32_t a, uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

class Refiner {
 public:
  Refiner(const Facets& facets, double chord_mm) : under_(*facets.under), chord_mm_(chord_mm) {
    std::map<std::array<float, 3>, uint32_t> known;
    std::vector<uint32_t> vertex_of;
    for (const auto& p : facets.mesh.positions) {
      const auto [it, is_new] = known.try_emplace(p, static_cast<uint32_t>(points_.size()));
      if (is_new) points_.emplace_back(p[0], p[1], p[2]);
      vertex_of.push_back(it->second);
    }
    for (size_t n = 0; n < facets.mesh.triangles.size(); ++n) {
      const surface::FacetOnSurface& on = under_.facets[n];
      FineFacet facet{on.surface, {}, on.uv, {}};
      for (size_t k = 0; k < 3; ++k) {
        facet.corners[k] = vertex_of[facets.mesh.triangles[n][k]];
        if (on.edges[k] != kNoEdge)
          facet.sides[k] = {on.edges[k], 0.0,
                            static_cast<double>(under_.edges[static_cast<size_t>(on.edges[k])].size() - 1)};
      }
      facets_.push_back(facet);
    }
    find_sides();
  }

  /// False: more than `most` triangles.
  bool refine(size_t most) {
    constexpr int kMostRounds = 12;
    for (int round = 0; round < kMostRounds; ++round) {
      if (!halve_sides()) return facets_.size() <= most;
      if (facets_.size() > most) return false;
    }
    return true;
  }

  /// Whether a facet lies against its face: an edge bulged across another one nearby.
  bool is_folded() const {
    constexpr double kNeedle = 1e-9;  // mm2; rounding turns smaller ones
    return std::any_of(facets_.begin(), facets_.end(), [&](const FineFacet& facet) {
      const Vec3& a = points_[facet.corners[0]];
      const Vec3 across = (points_[facet.corners[1]] - a).cross(points_[facet.corners[2]] - a);
      if (across.norm() < kNeedle) return false;
      const Vec2 middle = (facet.uv[0] + facet.uv[1] + facet.uv[2]) / 3.0;
      const surface::Derivatives d = surface_of(facet).derivatives(middle.x(), middle.y());
      const Vec3 normal = d.Su.cross(d.Sv);
      return normal.norm() > 0.0 && turned_[static_cast<size_t>(facet.surface)] * across.dot(normal) < 0.0;
    });
  }

  FineFacets result() const {
    FineFacets fine;
    double farthest = 0.0;
    for (const Vec3& p : points_) {
      farthest = std::max(farthest, p.cwiseAbs().maxCoeff());
      fine.mesh.positions.push_back(
          {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    }
    for (const FineFacet& facet : facets_) fine.mesh.triangles.push_back(facet.corners);
    constexpr size_t kFacetsPerTask = 256;
    std::vector<double> off((facets_.size() + kFacetsPerTask - 1) / kFacetsPerTask, 0.0);
    parallel_chunks(facets_.size(), kFacetsPerTask, [&](size_t begin, size_t end) {
      double& most = off[begin / kFacetsPerTask];
      for (size_t n = begin; n < end; ++n) most = std::max(most, strays(facets_[n]));
    });
    for (const double one : off) fine.chord_mm = std::max(fine.chord_mm, one);
    constexpr double kFloatStep = 0x1.0p-24 * 1.7320508;  // half a step in each of three coordinates
    fine.chord_mm = std::max(fine.chord_mm, most_sagitta_) + kFloatStep * farthest;
    return fine;
  }

 private:
  /// Which way the parameters turn, seen from outside, of each surface: as most of its facets' area lies.
  void find_sides() {
    turned_.assign(under_.surfaces.size(), 0.0);
    for (const FineFacet& facet : facets_) {
      const Vec3& a = points_[facet.corners[0]];
      const Vec3 across = (points_[facet.corners[1]] - a).cross(points_[facet.corners[2]] - a);
      const Vec2 middle = (facet.uv[0] + facet.uv[1] + facet.uv[2]) / 3.0;
      const surface::Derivatives d = surface_of(facet).derivatives(middle.x(), middle.y());
      turned_[static_cast<size_t>(facet.surface)] += across.dot(d.Su.cross(d.Sv));
    }
  }

  bool is_curved(const FineFacet& facet) const {
    return under_.is_plane[static_cast<size_t>(facet.surface)] == 0;
  }
  const surface::Surface& surface_of(const FineFacet& facet) const {
    return *under_.surfaces[static_cast<size_t>(facet.surface)];
  }
  double strays(const FineFacet& facet) const {
    if (!is_curved(facet)) return 0.0;
    return distance_bound(surface_of(facet), facet.uv,
                          {points_[facet.corners[0]], points_[facet.corners[1]], points_[facet.corners[2]]},
                          chord_mm_);
  }

  /// The parameters at a share of a side.
  Vec2 along(const FineFacet& facet, size_t k, double share) const {
    const Piece& piece = facet.sides[k];
    if (piece.edge == kNoEdge) return facet.uv[k] + share * (facet.uv[(k + 1) % 3] - facet.uv[k]);
    const surface::EdgePlaces& places = under_.edges[static_cast<size_t>(piece.edge)];
    const double at =
        std::clamp(piece.from + share * (piece.to - piece.from), 0.0, static_cast<double>(places.size() - 1));
    const auto below = std::min(static_cast<size_t>(at), places.size() - 2);
    return places[below] + (at - static_cast<double>(below)) * (places[below + 1] - places[below]);
  }

  Middle middle_of(const FineFacet& facet, size_t k) const {
    const Vec3 &a = points_[facet.corners[k]], &b = points_[facet.corners[(k + 1) % 3]];
    if (!is_curved(facet)) return {1, 0.5 * (a + b), 0.0};
    const surface::Surface& surface = surface_of(facet);
    Middle middle{facet.sides[k].edge != kNoEdge ? 3 : 2};
    for (const double share : {0.25, 0.5, 0.75}) {
      const Vec2 uv = along(facet, k, share).cwiseMax(Vec2::Zero()).cwiseMin(Vec2::Ones());
      const Vec3 p = surface.point(uv.x(), uv.y());
      if (share == 0.5) middle.point = p;
      middle.sagitta_mm = std::max(middle.sagitta_mm, to_segment(p, a, b));
    }
    return middle;
  }

  /// The parameters of the place nearest to a point, by a few steps of Gauss and Newton.
  static Vec2 parameters_near(const surface::Surface& surface, Vec2 uv, const Vec3& point) {
    constexpr int kSteps = 3;
    for (int i = 0; i < kSteps; ++i) {
      const surface::Derivatives d = surface.derivatives(uv.x(), uv.y());
      const Vec3 off = point - d.S;
      const double e = d.Su.squaredNorm(), f = d.Su.dot(d.Sv), g = d.Sv.squaredNorm(), det = e * g - f * f;
      if (!(det > 1e-14 * e * g)) break;
      const double a = d.Su.dot(off), b = d.Sv.dot(off);
      const Vec2 step((g * a - f * b) / det, (e * b - f * a) / det);
      uv = (uv + step).cwiseMax(Vec2::Zero()).cwiseMin(Vec2::Ones());
    }
    return uv;
  }

  /// One round; false where no side strays too far.
  bool halve_sides() {
    std::map<SideKey, Middle> middles;
    for (const FineFacet& facet : facets_) {
      for (size_t k = 0; k < 3; ++k) {
        const Middle one = middle_of(facet, k);
        Middle& best = middles[key_of(facet.corners[k], facet.corners[(k + 1) % 3])];
        if (one.rank > best.rank) best = one;
        if (one.rank == best.rank) best.sagitta_mm = std::max(best.sagitta_mm, one.sagitta_mm);
      }
    }
    most_sagitta_ = 0.0;
    bool any = false;
    for (auto& [key, middle] : middles) {
      if (!(middle.sagitta_mm > chord_mm_)) {
        most_sagitta_ = std::max(most_sagitta_, middle.sagitta_mm);
        continue;
      }
      any = true;
      middle.vertex = static_cast<uint32_t>(points_.size());
      points_.push_back(middle.point);
    }
    if (!any) return false;
    std::vector<FineFacet> finer;
    for (const FineFacet& facet : facets_) divide(facet, middles, finer);
    facets_ = std::move(finer);
    return true;
  }

  struct Corner {
    uint32_t vertex;
    Vec2 uv;
  };

  static std::array<Piece, 2> halves(const Piece& piece) {
    if (piece.edge == kNoEdge) return {};
    const double middle = 0.5 * (piece.from + piece.to);
    return {Piece{piece.edge, piece.from, middle}, Piece{piece.edge, middle, piece.to}};
  }

  void divide(const FineFacet& f, const std::map<SideKey, Middle>& middles,
              std::vector<FineFacet>& finer) const {
    constexpr uint32_t kNone = 0xffffffffu;
    std::array<Corner, 3> m;
    int count = 0;
    for (size_t k = 0; k < 3; ++k) {
      m[k] = {middles.at(key_of(f.corners[k], f.corners[(k + 1) % 3])).vertex, along(f, k, 0.5)};
      if (m[k].vertex == kNone) continue;
      ++count;
      if (is_curved(f)) m[k].uv = parameters_near(surface_of(f), m[k].uv, points_[m[k].vertex]);
    }
    if (count == 0) {
      finer.push_back(f);
      return;
    }
    const auto corner = [&](size_t k) { return Corner{f.corners[k % 3], f.uv[k % 3]}; };
    const auto add = [&](const std::array<Corner, 3>& c, const std::array<Piece, 3>& sides) {
      finer.push_back(
          {f.surface, {c[0].vertex, c[1].vertex, c[2].vertex}, {c[0].uv, c[1].uv, c[2].uv}, sides});
    };
    const auto first = [&](size_t k) { return halves(f.sides[k % 3])[0]; };
    const auto second = [&](size_t k) { return halves(f.sides[k % 3])[1]; };
    if (count == 3) {
      for (size_t k = 0; k < 3; ++k)
        add({corner(k), m[k], m[(k + 2) % 3]}, {first(k), Piece{}, second(k + 2)});
      add({m[0], m[1], m[2]}, {});
      return;
    }
    size_t k = 0;
    if (count == 1) {
      while (m[k].vertex == kNone) ++k;
      add({corner(k), m[k], corner(k + 2)}, {first(k), Piece{}, f.sides[(k + 2) % 3]});
      add({m[k], corner(k + 1), corner(k + 2)}, {second(k), f.sides[(k + 1) % 3], Piece{}});
      return;
    }
    while (m[k].vertex == kNone || m[(k + 1) % 3].vertex == kNone) ++k;
    const Corner &p = m[k], &q = m[(k + 1) % 3];
    add({p, corner(k + 1), q}, {second(k), first(k + 1), Piece{}});
    add({corner(k), p, q}, {first(k), Piece{}, Piece{}});
    add({corner(k), q, corner(k + 2)}, {Piece{}, second(k + 1), f.sides[(k + 2) % 3]});
  }

  const surface::UnderFacets& under_;
  double chord_mm_, most_sagitta_ = 0.0;
  std::vector<Vec3> points_;
  std::vector<FineFacet> facets_;
  std::vector<double> turned_;  ///< of each surface; its sign counts
};

}  // namespace

FineFacets refine_facets(const Facets& facets, double chord_mm, size_t most) {
  if (!facets.proven || facets.across_creases > 0 || facets.under == nullptr) return {};
  for (const surface::FacetOnSurface& on : facets.under->facets)
    if (on.surface == kNoEdge) return {};
  Refiner refiner(facets, chord_mm);
  if (!refiner.refine(most) || refiner.is_folded()) return {};
  return refiner.result();
}

}  // namespace swarf::brep
