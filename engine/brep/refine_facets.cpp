#include "brep/refine_facets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_set>
#include <utility>

#include "base/parallel.h"
#include "brep/facet_chord.h"
#include "brep/straight_lines.h"

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
  int surface = -1;               ///< of the facets beside the side; kBorder: of two of them
  static constexpr int kBorder = -2;
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
      // Of the border that is a pole the library makes facets with two corners in one place.
      const std::array<uint32_t, 3>& c = facet.corners;
      if (c[0] != c[1] && c[1] != c[2] && c[2] != c[0]) facets_.push_back(facet);
    }
    for (const surface::SurfacePtr& surface : under_.surfaces) straight_.push_back(straight_lines(*surface));
    find_poles();
    find_sides();
  }

  /// False: more than `most` triangles.
  bool refine(size_t most) {
    constexpr int kMostRounds = 24;
    for (int round = 0; round < kMostRounds; ++round) {
      turn_sides();
      if (!halve_sides()) return facets_.size() <= most;
      if (facets_.size() > most) return false;
    }
    return true;
  }

  /// Whether a facet lies against its face: an edge bulged across another one nearby. Such needles take the
  /// other diagonal where both halves then lie right.
  bool stays_folded() {
    std::vector<uint32_t> folded;
    for (uint32_t n = 0; n < facets_.size(); ++n)
      if (is_folded(facets_[n])) folded.push_back(n);
    return std::any_of(folded.begin(), folded.end(), [&](uint32_t n) { return !unfold(n); });
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
    constexpr double kFloatStep = 0x1.0p-24 * 1.7320508;  // half a step in each of three coordinates
    constexpr size_t kFacetsPerTask = 256;
    const std::map<SideKey, double> sides = sagittas();
    fine.chords_mm.resize(facets_.size());
    parallel_chunks(facets_.size(), kFacetsPerTask, [&](size_t begin, size_t end) {
      for (size_t n = begin; n < end; ++n) {
        const std::array<uint32_t, 3>& corners = facets_[n].corners;
        double most = strays(facets_[n]);
        for (size_t k = 0; k < 3; ++k)
          most = std::max(most, sides.at(key_of(corners[k], corners[(k + 1) % 3])));
        fine.chords_mm[n] = most + kFloatStep * farthest;
      }
    });
    for (const double one : fine.chords_mm) fine.chord_mm = std::max(fine.chord_mm, one);
    return fine;
  }

 private:
  /// Which way the parameters turn, seen from outside, of each surface: as most of its facets' area lies.
  void find_sides() {
    turned_.assign(under_.surfaces.size(), 0.0);
    for (const FineFacet& facet : facets_) {
      const surface::Derivatives d = at_middle(facet);
      turned_[static_cast<size_t>(facet.surface)] += across(facet).dot(d.Su.cross(d.Sv));
    }
  }

  /// The parameters of its corners; a pole has the free one of the middle of the others.
  std::array<Vec2, 3> uv_of(const FineFacet& facet) const {
    std::array<Vec2, 3> uv = facet.uv;
    for (size_t k = 0; k < 3 && !poles_.empty(); ++k) {
      const auto pole = poles_.find({facet.surface, facet.corners[k]});
      if (pole == poles_.end()) continue;
      uv[k][pole->second] = 0.5 * (uv[(k + 1) % 3][pole->second] + uv[(k + 2) % 3][pole->second]);
    }
    return uv;
  }

  surface::Derivatives at_middle(const FineFacet& facet) const {
    const std::array<Vec2, 3> uv = uv_of(facet);
    const Vec2 middle = (uv[0] + uv[1] + uv[2]) / 3.0;
    return surface_of(facet).derivatives(middle.x(), middle.y());
  }

  /// Vertices where a whole border of a surface's square is one point: any parameter along it is theirs.
  void find_poles() {
    constexpr double kPole = 1e-6, kBorder = 1e-9;  // the library's corners lie beside the border by rounding
    for (const FineFacet& facet : facets_) {
      for (size_t k = 0; k < 3 && is_curved(facet); ++k) {
        const Vec2& uv = facet.uv[k];
        if (uv.minCoeff() > kBorder && uv.maxCoeff() < 1.0 - kBorder) continue;
        const surface::Derivatives d = surface_of(facet).derivatives(uv.x(), uv.y());
        const double u = d.Su.norm(), v = d.Sv.norm();
        if (u < kPole * v) poles_[{facet.surface, facet.corners[k]}] = 0;
        if (v < kPole * u) poles_[{facet.surface, facet.corners[k]}] = 1;
      }
    }
  }

  /// The parameters at both ends of a side. A pole has the free one of the other end.
  std::array<Vec2, 2> ends_of(const FineFacet& facet, size_t k) const {
    std::array<Vec2, 2> ends{facet.uv[k], facet.uv[(k + 1) % 3]};
    if (poles_.empty()) return ends;
    for (size_t i = 0; i < 2; ++i) {
      const auto pole = poles_.find({facet.surface, facet.corners[(k + i) % 3]});
      if (pole != poles_.end()) ends[i][pole->second] = ends[1 - i][pole->second];
    }
    return ends;
  }

  bool is_curved(const FineFacet& facet) const {
    return under_.is_plane[static_cast<size_t>(facet.surface)] == 0;
  }
  const surface::Surface& surface_of(const FineFacet& facet) const {
    return *under_.surfaces[static_cast<size_t>(facet.surface)];
  }
  double strays(const FineFacet& facet) const {
    if (!is_curved(facet)) return 0.0;
    const std::array<Vec3, 3> at{points_[facet.corners[0]], points_[facet.corners[1]],
                                 points_[facet.corners[2]]};
    if (const std::optional<int>& along = straight_[static_cast<size_t>(facet.surface)])
      return straight_bound(surface_of(facet), *along, uv_of(facet), at);
    for (size_t k = 0; k < 3 && !poles_.empty(); ++k) {
      if (!poles_.contains({facet.surface, facet.corners[k]})) continue;
      // What lies under a facet at a pole has four corners in the parameters.
      const Vec2 &b = facet.uv[(k + 1) % 3], &c = facet.uv[(k + 2) % 3];
      const Vec2 over_b = ends_of(facet, k)[0], over_c = ends_of(facet, (k + 2) % 3)[1];
      return std::max(distance_bound(surface_of(facet), {b, c, over_b}, at, chord_mm_),
                      distance_bound(surface_of(facet), {c, over_c, over_b}, at, chord_mm_));
    }
    return distance_bound(surface_of(facet), facet.uv, at, chord_mm_);
  }

  /// The parameters at a share of a side.
  Vec2 along(const FineFacet& facet, size_t k, double share) const {
    const Piece& piece = facet.sides[k];
    if (piece.edge == kNoEdge) {
      const std::array<Vec2, 2> ends = ends_of(facet, k);
      return ends[0] + share * (ends[1] - ends[0]);
    }
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
    const std::optional<int>& lines = straight_[static_cast<size_t>(facet.surface)];
    if (lines) {
      const std::array<Vec2, 2> ends = ends_of(facet, k);
      middle.sagitta_mm = straight_bound(surface, *lines, ends[0], ends[1]);
      if (facet.sides[k].edge == kNoEdge) {
        const Vec2 uv = 0.5 * (ends[0] + ends[1]);
        middle.point = surface.point(uv.x(), uv.y());
        return middle;
      }
    }
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

  /// Two facets that share a side, and which side it is of each.
  struct Pair {
    std::array<uint32_t, 2> facet{};
    std::array<size_t, 2> side{};
  };

  static double area_of(const std::array<Vec2, 3>& uv) {
    const Vec2 ab = uv[1] - uv[0], ac = uv[2] - uv[0];
    return ab.x() * ac.y() - ab.y() * ac.x();
  }

  /// Along the normal of a facet, twice its area long, mm2.
  Vec3 across(const FineFacet& facet) const {
    const Vec3& a = points_[facet.corners[0]];
    return (points_[facet.corners[1]] - a).cross(points_[facet.corners[2]] - a);
  }

  /// The two facets of a pair on the other diagonal; false: there is none.
  bool other_diagonal(const Pair& pair, std::array<FineFacet, 2>& made) const {
    const FineFacet &f = facets_[pair.facet[0]], &g = facets_[pair.facet[1]];
    const size_t a = pair.side[0], b = (a + 1) % 3, c = (a + 2) % 3;
    const size_t i = pair.side[1], j = (i + 1) % 3, d = (i + 2) % 3;
    // Across a seam the parameters differ.
    constexpr double kSame = 1e-8;
    if (f.surface != g.surface) return false;
    if ((f.uv[a] - g.uv[j]).norm() > kSame || (f.uv[b] - g.uv[i]).norm() > kSame) return false;
    made[0] = {f.surface,
               {f.corners[a], g.corners[d], f.corners[c]},
               {f.uv[a], g.uv[d], f.uv[c]},
               {g.sides[j], Piece{}, f.sides[c]}};
    made[1] = {f.surface,
               {g.corners[d], f.corners[b], f.corners[c]},
               {g.uv[d], f.uv[b], f.uv[c]},
               {g.sides[d], f.sides[b], Piece{}}};
    return true;
  }

  /// Whether the other diagonal strays less, with facets that do not overlap.
  bool turned(const Pair& pair, std::array<FineFacet, 2>& made) const {
    if (!other_diagonal(pair, made)) return false;
    const FineFacet &f = facets_[pair.facet[0]], &g = facets_[pair.facet[1]];
    constexpr double kFlat = 0.02, kNearer = 1.0 - 1e-3;
    const double whole = area_of(uv_of(f)) + area_of(uv_of(g));
    const Vec3 outward = across(f) + across(g);
    for (const FineFacet& one : made)
      if (!(area_of(uv_of(one)) / whole > kFlat) || !(across(one).dot(outward) > 0.0)) return false;
    const double strays = middle_of(f, pair.side[0]).sagitta_mm;
    return strays > chord_mm_ && middle_of(made[0], 1).sagitta_mm < kNearer * strays;
  }

  bool is_folded(const FineFacet& facet) const {
    constexpr double kNeedle = 1e-9;  // mm2; rounding turns smaller ones
    const Vec3 out = across(facet);
    if (out.norm() < kNeedle) return false;
    const surface::Derivatives d = at_middle(facet);
    const Vec3 normal = d.Su.cross(d.Sv);
    return normal.norm() > 0.0 && turned_[static_cast<size_t>(facet.surface)] * out.dot(normal) < 0.0;
  }

  bool has_side(uint32_t a, uint32_t b) const {
    for (uint32_t n = 0; n < facets_.size(); ++n)
      if (side_of(n, key_of(a, b)) != 3) return true;
    return false;
  }

  /// Turns a folded facet and one beside it; false: none serves.
  bool unfold(uint32_t n) {
    if (!is_folded(facets_[n])) return true;
    for (size_t k = 0; k < 3; ++k) {
      const SideKey key = key_of(facets_[n].corners[k], facets_[n].corners[(k + 1) % 3]);
      for (uint32_t other = 0; other < facets_.size(); ++other) {
        const size_t side = other == n ? 3 : side_of(other, key);
        std::array<FineFacet, 2> made;
        if (side == 3 || !other_diagonal({{n, other}, {k, side}}, made)) continue;
        if (is_folded(made[0]) || is_folded(made[1]) || has_side(made[0].corners[1], made[0].corners[2]))
          continue;
        facets_[n] = made[0];
        facets_[other] = made[1];
        return true;
      }
    }
    return false;
  }

  size_t side_of(uint32_t facet, const SideKey& key) const {
    const std::array<uint32_t, 3>& corners = facets_[facet].corners;
    for (size_t k = 0; k < 3; ++k)
      if (key_of(corners[k], corners[(k + 1) % 3]) == key) return k;
    return 3;
  }

  /// Two facets beside a side within a curved surface take the other diagonal where that strays less, until
  /// no side strays less so: between rims that run side by side, nothing needs to be halved then.
  void turn_sides() {
    constexpr uint32_t kNone = 0xffffffffu;
    std::map<SideKey, std::array<uint32_t, 2>> beside;
    std::vector<SideKey> open;
    for (uint32_t n = 0; n < facets_.size(); ++n) {
      for (size_t k = 0; k < 3 && is_curved(facets_[n]); ++k) {
        const SideKey key = key_of(facets_[n].corners[k], facets_[n].corners[(k + 1) % 3]);
        const auto [it, is_new] = beside.try_emplace(key, std::array<uint32_t, 2>{n, kNone});
        if (!is_new) it->second[1] = n;
        if (is_new && facets_[n].sides[k].edge == kNoEdge && !is_settled(key)) open.push_back(key);
      }
    }
    while (!open.empty()) {
      const SideKey key = open.back();
      open.pop_back();
      const auto found = beside.find(key);
      if (found == beside.end() || found->second[1] == kNone) continue;
      const Pair pair{found->second, {side_of(found->second[0], key), side_of(found->second[1], key)}};
      std::array<FineFacet, 2> made;
      if (pair.side[0] == 3 || pair.side[1] == 3 || !turned(pair, made)) continue;
      if (!beside.try_emplace(key_of(made[0].corners[1], made[0].corners[2]), pair.facet).second) continue;
      beside.erase(key);
      for (size_t n = 0; n < 2; ++n) {
        facets_[pair.facet[n]] = made[n];
        for (size_t k = 0; k < 3; ++k) {
          const SideKey side = key_of(made[n].corners[k], made[n].corners[(k + 1) % 3]);
          std::array<uint32_t, 2>& of = beside.at(side);
          if (of[0] == pair.facet[1 - n] && of[1] != pair.facet[n]) of[0] = pair.facet[n];
          if (of[1] == pair.facet[1 - n] && of[0] != pair.facet[n]) of[1] = pair.facet[n];
          if (made[n].sides[k].edge == kNoEdge && !is_settled(side)) open.push_back(side);
        }
      }
    }
  }

  static uint64_t number_of(const SideKey& key) { return uint64_t{key.first} << 32U | key.second; }
  /// Whether a round before has seen that it strays little enough.
  bool is_settled(const SideKey& key) const { return settled_.contains(number_of(key)); }

  /// One round; false where no side strays too far. Those between two surfaces go first.
  bool halve_sides() {
    std::map<SideKey, Middle> middles;
    for (const FineFacet& facet : facets_) {
      for (size_t k = 0; k < 3; ++k) {
        const SideKey key = key_of(facet.corners[k], facet.corners[(k + 1) % 3]);
        if (is_settled(key)) continue;
        Middle& best = middles[key];
        // Within a surface both facets see the same.
        if (best.rank == 2 && best.surface == facet.surface && facet.sides[k].edge == kNoEdge) continue;
        const Middle one = middle_of(facet, k);
        const int surface =
            best.surface == -1 || best.surface == facet.surface ? facet.surface : Middle::kBorder;
        const double sagitta_mm = std::max(best.sagitta_mm, one.sagitta_mm);
        if (one.rank > best.rank) best = one;
        best.surface = surface;
        best.sagitta_mm = sagitta_mm;
      }
    }
    const bool on_borders = std::any_of(middles.begin(), middles.end(), [&](const auto& one) {
      return one.second.surface == Middle::kBorder && one.second.sagitta_mm > chord_mm_;
    });
    bool any = false;
    for (auto& [key, middle] : middles) {
      if (!(middle.sagitta_mm > chord_mm_)) {
        settled_.insert(number_of(key));
        continue;
      }
      if (on_borders && middle.surface != Middle::kBorder) continue;
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

  /// How far what each side stands for strays from it, as the facets beside it know it.
  std::map<SideKey, double> sagittas() const {
    std::map<SideKey, double> most;
    for (const FineFacet& facet : facets_) {
      for (size_t k = 0; k < 3; ++k) {
        double& one = most[key_of(facet.corners[k], facet.corners[(k + 1) % 3])];
        one = std::max(one, middle_of(facet, k).sagitta_mm);
      }
    }
    return most;
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
      const auto found = middles.find(key_of(f.corners[k], f.corners[(k + 1) % 3]));
      if (found == middles.end() || found->second.vertex == kNone) {
        m[k].vertex = kNone;
        continue;
      }
      m[k] = {found->second.vertex, along(f, k, 0.5)};
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
  double chord_mm_;
  std::unordered_set<uint64_t> settled_;  ///< number_of() sides
  std::vector<Vec3> points_;
  std::vector<FineFacet> facets_;
  std::vector<std::optional<int>> straight_;       ///< of each surface: straight_lines()
  std::vector<double> turned_;                     ///< of each surface; its sign counts
  std::map<std::pair<int, uint32_t>, int> poles_;  ///< surface and vertex; which parameter is free there
};

}  // namespace

FineFacets refine_facets(const Facets& facets, double chord_mm, size_t most) {
  if (!facets.proven || facets.across_creases > 0 || facets.under == nullptr) return {};
  for (const surface::FacetOnSurface& on : facets.under->facets)
    if (on.surface == kNoEdge) return {};
  Refiner refiner(facets, chord_mm);
  if (!refiner.refine(most) || refiner.stays_folded()) return {};
  return refiner.result();
}

FineFacets finest_facets(const Facets& facets, std::span<const double> chords_mm, size_t most) {
  const double coarsest = chords_mm.back();
  FineFacets coarse = refine_facets(facets, coarsest, most);
  const auto count = static_cast<double>(coarse.mesh.triangles.size());
  if (count == 0.0) return coarse;
  for (const double chord : chords_mm.first(chords_mm.size() - 1)) {
    if (count * coarsest / chord > static_cast<double>(most)) continue;
    FineFacets fine = refine_facets(facets, chord, most);
    if (!fine.mesh.triangles.empty()) return fine;
  }
  return coarse;
}

}  // namespace swarf::brep
