#include "mesh/shown_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/check.h"
#include "mesh/divided_triangle.h"
#include "mesh/field_line.h"
#include "mesh/mixed_corners.h"
#include "mesh/patch_borders.h"
#include "mesh/vertices_at.h"

namespace swarf::mesh {
namespace {

/// Splits follow each other, a few rounds deep: a kink found, its neighbourhood, and the strips beside it.
constexpr int kFieldRounds = 9;
/// No piece of a side is shorter, mm, and sides are not looked at that are shorter than kSideLookedAt.
constexpr double kShortest = 2e-3, kSideLookedAt = 0.01;
/// What is smaller than this, mm, and has about the same values at its corners, is taken as right: this much
/// of what is allowed.
constexpr double kSmallSide = 1.0, kSameShown = 0.5;
/// Of a triangle inside: about one place for so many mm2, but for small ones and up to so many.
constexpr double kInsideArea = 3.0;
constexpr size_t kInsideMost = 300;
/// Vertices without a field are asked again farther inside their patch, so many times.
constexpr int kTriesInside = 3;
constexpr double kFartherInside = 8.0;
/// Of what is allowed: between the places that are looked at it errs a little more.
constexpr double kGoodEnough = 0.7;

using FieldTriangle = std::array<uint32_t, 3>;
using MeshSide = std::pair<uint32_t, uint32_t>;  ///< of two vertices, the lesser first

/// A place of the mesh whose field is asked for.
struct FieldProbe {
  uint32_t owner;  ///< index of a side, or of a triangle
  Vec3 shares;     ///< of a side: its place t in x
};

class FieldOnMesh {
 public:
  FieldOnMesh(const ShownField& field, TriMesh& mesh) : field_(field), mesh_(mesh) {}

  void show() {
    if (field_.most_vertices > mesh_.positions.size())
      add_vertices_at(field_.known_changes, field_.near_mm, mesh_);
    borders_ = patch_borders(mesh_, kInsetMm);
    measure_vertices(0);
    active_.resize(mesh_.triangles.size());
    for (uint32_t t = 0; t < active_.size(); ++t) active_[t] = t;
    for (int round = 0; round < kFieldRounds && !active_.empty(); ++round) {
      if (mesh_.positions.size() >= field_.most_vertices || asked_ >= field_.most_places) return;
      look();
      choose();
      if (cuts_.empty()) return;
      const size_t first = mesh_.positions.size();
      make_vertices();
      measure_vertices(first);
      divide();
    }
  }

 private:
  struct SideLook {
    MeshSide side;
    FieldLine line;  ///< t from the lesser vertex
    double area_mm2 = 0.0;
  };
  struct TriangleLook {
    uint32_t triangle;
    double worst = 0.0, area_mm2 = 0.0;
  };
  /// Where a side of the welded mesh is divided: t from the lesser welded vertex.
  struct Cut {
    uint64_t key = 0;
    double gain = 0.0;  ///< error times area
    std::vector<double> at;
  };

  Vec3 position(uint32_t v) const { return vec3_of(mesh_.positions[v]); }
  Vec3 inner(uint32_t v) const { return position(v) + borders_.inset[v]; }

  Vec3 cross_of(const FieldTriangle& t) const {
    return (position(t[1]) - position(t[0])).cross(position(t[2]) - position(t[0]));
  }

  /// Sets the values of the vertices from `first` on.
  void measure_vertices(size_t first) {
    mesh_.deviation_um.resize(mesh_.positions.size(), std::numeric_limits<float>::quiet_NaN());
    std::vector<uint32_t> open;
    for (auto v = static_cast<uint32_t>(first); v < mesh_.positions.size(); ++v) open.push_back(v);
    double farther = 1.0;
    for (int attempt = 0; attempt < kTriesInside && !open.empty(); ++attempt, farther *= kFartherInside) {
      TriMesh places;
      for (const uint32_t v : open) {
        places.positions.push_back(floats_of(position(v) + farther * borders_.inset[v]));
        places.normals.push_back(mesh_.normals[v]);
      }
      field_.measure(places);
      std::vector<uint32_t> still;
      for (size_t i = 0; i < open.size(); ++i) {
        const float um = places.deviation_um[i];
        if (std::isnan(um) && !borders_.inset[open[i]].isZero()) still.push_back(open[i]);
        if (std::isnan(um)) continue;
        mesh_.deviation_um[open[i]] = um;
        mesh_.normals[open[i]] = places.normals[i];
      }
      open = std::move(still);
    }
  }

  /// Lists the active triangles, and of their sides those that have not been looked at.
  void list_looks() {
    sides_.clear();
    inside_.clear();
    std::unordered_map<uint64_t, uint32_t> side_of;
    for (const uint32_t t : active_) {
      const FieldTriangle& triangle = mesh_.triangles[t];
      const double area = 0.5 * cross_of(triangle).norm();
      inside_.push_back({t, 0.0, area});
      for (size_t k = 0; k < 3; ++k) {
        const auto [a, b] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
        const bool is_new = looked_.insert(side_key(a, b)).second;
        if (is_new) {
          side_of[side_key(a, b)] = static_cast<uint32_t>(sides_.size());
          sides_.push_back({{a, b}, {}, 0.0});
        }
        const auto found = side_of.find(side_key(a, b));
        if (found != side_of.end()) sides_[found->second].area_mm2 += area;
      }
    }
  }

  /// Measures what is listed.
  void look() {
    list_looks();
    TriMesh places;
    std::vector<FieldProbe> probes;
    for (uint32_t i = 0; i < sides_.size(); ++i) ask_side(i, probes, places);
    const size_t of_sides = probes.size();
    for (uint32_t i = 0; i < inside_.size(); ++i) ask_inside(i, probes, places);
    asked_ += probes.size();
    field_.measure(places);
    for (size_t n = 0; n < of_sides; ++n)
      sides_[probes[n].owner].line.add(probes[n].shares.x(), places.deviation_um[n]);
    for (size_t n = of_sides; n < probes.size(); ++n) {
      TriangleLook& one = inside_[probes[n].owner];
      const FieldTriangle& triangle = mesh_.triangles[one.triangle];
      one.worst = std::max(one.worst, error_inside(triangle, probes[n].shares, places.deviation_um[n]));
    }
  }

  void ask(uint32_t owner, const Vec3& shares, const FieldTriangle& of, std::vector<FieldProbe>& probes,
           TriMesh& places) const {
    Vec3 point = Vec3::Zero(), normal = Vec3::Zero();
    for (size_t k = 0; k < 3; ++k) {
      const double share = shares[static_cast<int>(k)];
      point += share * inner(of[k]);
      normal += share * vec3_of(mesh_.normals[of[k]]);
    }
    probes.push_back({owner, shares});
    places.positions.push_back(floats_of(point));
    places.normals.push_back(floats_of(normal.normalized()));
  }

  void ask_side(uint32_t i, std::vector<FieldProbe>& probes, TriMesh& places) const {
    const auto [a, b] = sides_[i].side;
    const double length = (position(b) - position(a)).norm();
    if (length < kSideLookedAt || (length < kSmallSide && is_same(a, b))) return;
    for (const double t : places_on_side(length, borders_.on_crease[a] != 0, borders_.on_crease[b] != 0)) {
      ask(i, {1.0 - t, t, 0.0}, {a, b, b}, probes, places);
      probes.back().shares.x() = t;
    }
  }

  bool is_same(uint32_t a, uint32_t b) const {
    const float x = mesh_.deviation_um[a], y = mesh_.deviation_um[b];
    return !std::isnan(x + y) && field_.error({x, x, x}, {1.0, 0.0, 0.0}, y) <= kSameShown;
  }

  void ask_inside(uint32_t i, std::vector<FieldProbe>& probes, TriMesh& places) const {
    const FieldTriangle& triangle = mesh_.triangles[inside_[i].triangle];
    const double longest = longest_side(triangle).second;
    if (longest < kSideLookedAt) return;
    if (longest < kSmallSide && is_same(triangle[0], triangle[1]) && is_same(triangle[1], triangle[2]))
      return;
    const auto wanted = static_cast<size_t>(inside_[i].area_mm2 / kInsideArea);
    const size_t count = std::min(1 + wanted, kInsideMost);
    for (size_t n = 0; n < count; ++n) ask(i, place_inside(n), triangle, probes, places);
  }

  /// Evenly over the triangle, the same for each: the R2 sequence, folded.
  static Vec3 place_inside(size_t n) {
    constexpr double kA = 0.7548776662466927, kB = 0.5698402909980532;
    double u = 0.5 + kA * static_cast<double>(n + 1), v = 0.5 + kB * static_cast<double>(n + 1);
    u -= std::floor(u);
    v -= std::floor(v);
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    return {1.0 - u - v, u, v};
  }

  double error_inside(const FieldTriangle& t, const Vec3& shares, float truth) const {
    const std::array<float, 3> um{mesh_.deviation_um[t[0]], mesh_.deviation_um[t[1]],
                                  mesh_.deviation_um[t[2]]};
    return std::isnan(truth + um[0] + um[1] + um[2]) ? 0.0 : field_.error(um, shares, truth);
  }

  std::pair<size_t, double> longest_side(const FieldTriangle& t) const {
    std::pair<size_t, double> longest{0, -1.0};
    for (size_t k = 0; k < 3; ++k) {
      const double length = (position(t[(k + 1) % 3]) - position(t[k])).norm();
      if (length > longest.second) longest = {k, length};
    }
    return longest;
  }

  void add_cut(uint32_t a, uint32_t b, const std::vector<double>& at, double gain) {
    const bool turned = borders_.welded[a] > borders_.welded[b];
    Cut& cut = found_[side_key(borders_.welded[a], borders_.welded[b])];
    cut.key = side_key(borders_.welded[a], borders_.welded[b]);
    cut.gain += gain;
    for (const double t : at) cut.at.push_back(turned ? 1.0 - t : t);
  }

  /// Sides are divided at the knots of what is known along them.
  void cut_sides() {
    const auto between = [&](float low, float high, double t, float truth) {
      return field_.error({low, high, high}, {1.0 - t, t, 0.0}, truth);
    };
    for (const SideLook& look : sides_) {
      const auto [a, b] = look.side;
      const float low = mesh_.deviation_um[a], high = mesh_.deviation_um[b];
      if (std::isnan(low + high)) continue;
      const double apart = kShortest / std::max((position(b) - position(a)).norm(), kShortest);
      const FieldLine::Knots knots =
          look.line.knots(low, high, field_.saturates, apart, kGoodEnough, between);
      if (!knots.at.empty()) add_cut(a, b, knots.at, knots.worst * look.area_mm2);
    }
  }

  /// Triangles that err inside and whose own sides are right are halved.
  void cut_inside() {
    std::vector<const TriangleLook*> wrong;
    for (const TriangleLook& look : inside_)
      if (look.worst > kGoodEnough && !has_cut(mesh_.triangles[look.triangle])) wrong.push_back(&look);
    for (const TriangleLook* look : wrong) {
      const FieldTriangle& t = mesh_.triangles[look->triangle];
      const auto [k, length] = longest_side(t);
      if (length > 2.0 * kShortest) add_cut(t[k], t[(k + 1) % 3], {0.5}, look->worst * look->area_mm2);
    }
  }

  bool has_cut(const FieldTriangle& t) const {
    const auto is_cut = [&](uint32_t a, uint32_t b) {
      return found_.count(side_key(borders_.welded[a], borders_.welded[b])) > 0;
    };
    return is_cut(t[0], t[1]) || is_cut(t[1], t[2]) || is_cut(t[2], t[0]);
  }

  /// The sides to divide, those that mend most as far as there is room for vertices.
  void choose() {
    found_.clear();
    cut_sides();
    cut_inside();
    std::vector<Cut*> best;
    for (auto& [key, cut] : found_) best.push_back(&cut);
    std::sort(best.begin(), best.end(), [](const Cut* x, const Cut* y) {
      return std::pair(-x->gain, x->key) < std::pair(-y->gain, y->key);
    });
    cuts_.clear();
    size_t room = field_.most_vertices - mesh_.positions.size();
    for (Cut* cut : best) {
      merge_places(cut->at);
      if (2 * cut->at.size() > room) break;
      room -= 2 * cut->at.size();
      cuts_.emplace(cut->key, std::move(cut->at));
    }
  }

  /// Sorted, and none so near another that the piece between them would be nothing.
  static void merge_places(std::vector<double>& at) {
    constexpr double kApart = 1e-6;
    std::sort(at.begin(), at.end());
    at.erase(std::unique(at.begin(), at.end(), [](double x, double y) { return y - x < kApart; }), at.end());
  }

  /// Of a side of a triangle, from a to b: its new vertices, made once for all triangles that share it.
  std::vector<uint32_t> vertices_on(uint32_t a, uint32_t b) {
    const auto cut = cuts_.find(side_key(borders_.welded[a], borders_.welded[b]));
    if (cut == cuts_.end()) return {};
    const uint32_t low = std::min(a, b), high = std::max(a, b);
    const auto [made, is_new] = made_.try_emplace(side_key(a, b));
    if (is_new)
      for (const double t : cut->second) made->second.push_back(add_vertex(low, high, t));
    std::vector<uint32_t> out = made->second;
    if ((a == low) != (borders_.welded[low] < borders_.welded[high])) std::reverse(out.begin(), out.end());
    return out;
  }

  /// `t`: from the end that is the lesser welded vertex, so that all copies get the same bits.
  uint32_t add_vertex(uint32_t a, uint32_t b, double t) {
    if (borders_.welded[a] > borders_.welded[b]) std::swap(a, b);
    const auto vertex = static_cast<uint32_t>(mesh_.positions.size());
    mesh_.positions.push_back(floats_of(position(a) + t * (position(b) - position(a))));
    mesh_.normals.push_back(
        floats_of(((1.0 - t) * vec3_of(mesh_.normals[a]) + t * vec3_of(mesh_.normals[b])).normalized()));
    const float x = mesh_.deviation_um[a], y = mesh_.deviation_um[b];
    mesh_.deviation_um.push_back(x + static_cast<float>(t) * (y - x));
    borders_.inset.push_back((1.0 - t) * borders_.inset[a] + t * borders_.inset[b]);
    borders_.on_crease.push_back(borders_.on_crease[a] != 0 && borders_.on_crease[b] != 0 ? 1 : 0);
    borders_.welded.push_back(
        welded_at_.try_emplace({side_key(borders_.welded[a], borders_.welded[b]), t}, vertex).first->second);
    return vertex;
  }

  void make_vertices() {
    made_.clear();
    welded_at_.clear();
    for (const FieldTriangle& t : mesh_.triangles)
      for (size_t k = 0; k < 3; ++k) vertices_on(t[k], t[(k + 1) % 3]);
  }

  void divide() {
    active_.clear();
    const size_t count = mesh_.triangles.size();
    for (size_t i = 0; i < count; ++i) {
      const FieldTriangle t = mesh_.triangles[i];
      std::array<std::vector<uint32_t>, 3> on;
      for (size_t k = 0; k < 3; ++k) on[k] = vertices_on(t[k], t[(k + 1) % 3]);
      if (on[0].empty() && on[1].empty() && on[2].empty()) continue;
      const std::vector<FieldTriangle> parts = divided_triangle(mesh_, t, on, field_.saturates);
      mesh_.triangles[i] = parts.front();
      active_.push_back(static_cast<uint32_t>(i));
      for (size_t n = 1; n < parts.size(); ++n) {
        active_.push_back(static_cast<uint32_t>(mesh_.triangles.size()));
        mesh_.triangles.push_back(parts[n]);
      }
    }
  }

  const ShownField& field_;
  TriMesh& mesh_;
  PatchBorders borders_;
  std::vector<uint32_t> active_;         ///< triangles that are to be looked at
  std::unordered_set<uint64_t> looked_;  ///< sides
  std::vector<SideLook> sides_;
  std::vector<TriangleLook> inside_;
  std::map<uint64_t, Cut> found_;
  std::unordered_map<uint64_t, std::vector<double>> cuts_;
  std::unordered_map<uint64_t, std::vector<uint32_t>> made_;
  std::map<std::pair<uint64_t, double>, uint32_t> welded_at_;
  size_t asked_ = 0;  ///< places beside the vertices
};

}  // namespace

void show_field(const ShownField& field, TriMesh& mesh) {
  SWARF_CHECK(mesh.normals.size() == mesh.positions.size(), "rays follow normals");
  FieldOnMesh(field, mesh).show();
}

}  // namespace swarf::mesh
