#include "mesh/mesh_enclosed.h"

#include <algorithm>
#include <array>

#include "base/parallel.h"
#include "mesh/mesh_check.h"
#include "mesh/mesh_crossing.h"
#include "mesh/mesh_distance.h"
#include "mesh/mesh_shells.h"

namespace swarf::mesh {
namespace {

/// Windings are whole numbers.
constexpr double kInside = 0.75;
/// Larger shells are let be: each of a thousand screws in a casting of a million facets would ask all of
/// them.
constexpr size_t kFacetsMost = 16000;

/// The welded mesh, its shells, and which facets touch which shells.
struct Shells {
  WeldedMesh mesh;
  std::vector<uint32_t> across;
  std::vector<Shell> shells;
  std::vector<uint32_t> shell_of, place_in_shell;  ///< per facet
  std::vector<std::array<uint32_t, 2>> touching;   ///< facet and another shell that it may touch, ascending

  explicit Shells(const TriMesh& given);
  bool touches(uint32_t facet, uint32_t shell) const {
    return std::binary_search(touching.begin(), touching.end(), std::array{facet, shell});
  }
  bool is_asked(uint32_t shell) const { return shells[shell].facets.size() <= kFacetsMost; }
  bool is_body(const Shell& shell) const;
};

Shells::Shells(const TriMesh& given)
    : mesh(weld(given)), across(facets_across(mesh.triangles)), shells(shells_of(mesh, across)) {
  shell_of.resize(mesh.triangles.size());
  place_in_shell.resize(mesh.triangles.size());
  for (uint32_t n = 0; n < shells.size(); ++n) {
    for (uint32_t i = 0; i < shells[n].facets.size(); ++i) {
      shell_of[shells[n].facets[i]] = n;
      place_in_shell[shells[n].facets[i]] = i;
    }
  }
  if (shells.size() < 2) return;
  TriMesh numbered{given.positions, {}, {}, {}, {}};  // by the welded mesh's facets
  for (const uint32_t source : mesh.sources) numbered.triangles.push_back(given.triangles[source]);
  const MeshDistance tree(numbered);
  const auto asked = [&](uint32_t one, uint32_t other) {
    return shell_of[one] != shell_of[other] && is_asked(shell_of[one]) && is_asked(shell_of[other]);
  };
  for (const auto& [a, b] : touching_pairs(numbered, tree, asked)) {
    touching.push_back({a, shell_of[b]});
    touching.push_back({b, shell_of[a]});
  }
  std::sort(touching.begin(), touching.end());
}

/// Each edge of its facets once in each direction: then it winds a whole number of times around any point.
bool Shells::is_body(const Shell& shell) const {
  return std::all_of(shell.facets.begin(), shell.facets.end(), [&](uint32_t facet) {
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t other = across[3 * facet + k];
      if (other >= mesh.triangles.size()) return false;
      const auto& t = mesh.triangles[facet];
      const auto& o = mesh.triangles[other];
      const uint32_t from = t[(k + 1) % 3], to = t[k];
      const bool turned_back =
          (o[0] == from && o[1] == to) || (o[1] == from && o[2] == to) || (o[2] == from && o[0] == to);
      if (!turned_back) return false;
    }
    return true;
  });
}

bool within(const Box& inner, const Box& outer) {
  return (inner.lower - outer.lower).minCoeff() >= 0.0 && (outer.upper - inner.upper).minCoeff() >= 0.0;
}

bool meet(const Box& a, const Box& b) {
  return (a.upper - b.lower).minCoeff() >= 0.0 && (b.upper - a.lower).minCoeff() >= 0.0;
}

Box box_of(const std::array<Vec3, 3>& c) {
  return {c[0].cwiseMin(c[1]).cwiseMin(c[2]), c[0].cwiseMax(c[1]).cwiseMax(c[2])};
}

/// Marks the facets of shell `own` that lie within shell `other`. Facets that hang together without touching
/// it lie on one side of it, so one of them is asked for all.
bool mark_within(const Shells& all, uint32_t own, uint32_t other, std::vector<uint8_t>& marked) {
  const Shell& shell = all.shells[own];
  const Shell& body = all.shells[other];
  std::vector<uint8_t> reached(shell.facets.size(), 0);
  std::vector<uint32_t> group;
  bool any = false;
  for (const uint32_t seed : shell.facets) {
    const std::array<Vec3, 3> corners = corners_of(all.mesh, seed);
    if (reached[all.place_in_shell[seed]] != 0 || !within(box_of(corners), body.box) ||
        all.touches(seed, other))
      continue;
    reached[all.place_in_shell[seed]] = 1;
    group.assign(1, seed);
    for (size_t i = 0; i < group.size(); ++i) {
      for (uint32_t k = 0; k < 3; ++k) {
        const uint32_t next = all.across[3 * group[i] + k];
        if (next >= all.shell_of.size() || reached[all.place_in_shell[next]] != 0 || all.touches(next, other))
          continue;
        reached[all.place_in_shell[next]] = 1;
        group.push_back(next);
      }
    }
    if (winding(all.mesh, body, (corners[0] + corners[1] + corners[2]) / 3.0) < kInside) continue;
    for (const uint32_t facet : group) marked[all.mesh.sources[facet]] = 1;
    any = true;
  }
  return any;
}

}  // namespace

Enclosed find_enclosed(const TriMesh& mesh) {
  Enclosed found;
  found.facets.assign(mesh.triangles.size(), 0);
  const Shells all(mesh);
  const size_t count = all.shells.size();
  std::vector<uint8_t> is_body(count);
  for (uint32_t n = 0; n < count; ++n) is_body[n] = all.is_asked(n) && all.is_body(all.shells[n]) ? 1 : 0;
  std::vector<std::vector<uint32_t>> enclosing(count);  // by what they enclose
  parallel_chunks(count, 1, [&](size_t own, size_t) {
    if (!all.is_asked(static_cast<uint32_t>(own))) return;
    for (uint32_t other = 0; other < count; ++other) {
      if (other == own || is_body[other] == 0 || !meet(all.shells[own].box, all.shells[other].box)) continue;
      if (mark_within(all, static_cast<uint32_t>(own), other, found.facets)) enclosing[own].push_back(other);
    }
  });
  std::vector<uint32_t> around;
  for (const auto& list : enclosing) around.insert(around.end(), list.begin(), list.end());
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  for (const uint32_t n : around) found.around.push_back(all.shells[n].box);
  return found;
}

}  // namespace swarf::mesh
