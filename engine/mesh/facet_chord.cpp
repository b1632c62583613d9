#include "mesh/facet_chord.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/angles.h"
#include "base/disjoint_sets.h"
#include "mesh/mesh_check.h"

namespace swarf::mesh {
namespace {

constexpr double kFlat = 2e-4;     // rad: facets in one plane, as single precision has them
constexpr double kSmooth = 0.524;  // rad: 30 degrees
constexpr size_t kLeastStrips = 8;

/// An edge between two strips of one curved face.
struct Bend {
  uint32_t strips[2];
  Vec3 from, to;
  double angle;
};

class Strips {
 public:
  explicit Strips(const TriMesh& mesh) : mesh_(weld(mesh)), planes_(mesh_.triangles.size()) {
    for (const auto& t : mesh_.triangles) {
      const Vec3 n = (mesh_.points[t[1]] - mesh_.points[t[0]]).cross(mesh_.points[t[2]] - mesh_.points[t[0]]);
      normals_.push_back(n.normalized());
    }
    const std::vector<uint32_t> across = facets_across(mesh_.triangles);
    for (uint32_t side = 0; side < across.size(); ++side)
      if (across[side] != kNone && side / 3 < across[side] && angle(side / 3, across[side]) <= kFlat)
        planes_.join(side / 3, across[side]);
    for (uint32_t side = 0; side < across.size(); ++side)
      if (across[side] != kNone && side / 3 < across[side]) add_bend(side, across[side]);
    keep_curved();
  }

  FacetChord widest() const {
    const std::vector<double> widths = widths_of();
    FacetChord result;
    for (const Bend& bend : bends_) {
      const double width = std::min(widths[bend.strips[0]], widths[bend.strips[1]]);
      const double mm = 0.5 * width * std::tan(0.25 * bend.angle);
      if (mm > result.mm) result = {mm, 0.5 * (bend.from + bend.to)};
    }
    return result;
  }

 private:
  static constexpr uint32_t kNone = 0xffffffffU;

  double angle(uint32_t a, uint32_t b) const {
    return std::atan2(normals_[a].cross(normals_[b]).norm(), normals_[a].dot(normals_[b]));
  }

  void add_bend(uint32_t side, uint32_t other) {
    const uint32_t facet = side / 3;
    const uint32_t a = planes_.root(facet), b = planes_.root(other);
    const double turn = angle(facet, other);
    if (a == b || !(turn <= kSmooth)) return;
    const auto& t = mesh_.triangles[facet];
    bends_.push_back({{a, b}, mesh_.points[t[side % 3]], mesh_.points[t[(side + 1) % 3]], turn});
  }

  /// Drops bends of strips that have only one, and of groups of few strips.
  void keep_curved() {
    std::vector<uint32_t> bends(mesh_.triangles.size(), 0);
    for (const Bend& bend : bends_)
      for (const uint32_t strip : bend.strips) ++bends[strip];
    std::erase_if(bends_,
                  [&](const Bend& bend) { return bends[bend.strips[0]] < 2 || bends[bend.strips[1]] < 2; });
    DisjointSets groups(mesh_.triangles.size());
    for (const Bend& bend : bends_) groups.join(bend.strips[0], bend.strips[1]);
    std::vector<uint8_t> is_member(mesh_.triangles.size(), 0);
    for (const Bend& bend : bends_) is_member[bend.strips[0]] = is_member[bend.strips[1]] = 1;
    std::vector<uint32_t> sizes(mesh_.triangles.size(), 0);
    for (uint32_t n = 0; n < is_member.size(); ++n)
      if (is_member[n] != 0) ++sizes[groups.root(n)];
    std::erase_if(bends_,
                  [&](const Bend& bend) { return sizes[groups.root(bend.strips[0])] < kLeastStrips; });
  }

  /// Of each strip, across its longest bend: how far its corners reach from that edge.
  std::vector<double> widths_of() const {
    std::vector<const Bend*> longest(mesh_.triangles.size(), nullptr);
    for (const Bend& bend : bends_)
      for (const uint32_t strip : bend.strips)
        if (longest[strip] == nullptr ||
            (bend.to - bend.from).norm() > (longest[strip]->to - longest[strip]->from).norm())
          longest[strip] = &bend;
    std::vector<double> widths(mesh_.triangles.size(), 0.0);
    for (uint32_t n = 0; n < mesh_.triangles.size(); ++n) {
      const uint32_t strip = planes_.root(n);
      const Bend* bend = longest[strip];
      if (bend == nullptr) continue;
      const Vec3 way = (bend->to - bend->from).normalized();
      for (const uint32_t corner : mesh_.triangles[n])
        widths[strip] = std::max(widths[strip], (mesh_.points[corner] - bend->from).cross(way).norm());
    }
    return widths;
  }

  WeldedMesh mesh_;
  mutable DisjointSets planes_;
  std::vector<Vec3> normals_;
  std::vector<Bend> bends_;
};

}  // namespace

FacetChord estimate_facet_chord(const TriMesh& mesh) {
  return Strips(mesh).widest();
}

}  // namespace swarf::mesh
