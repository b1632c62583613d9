// decimate(): meshoptimizer for the bulk, OpenMesh for the rest, a nearest-point tree for the proof.
#include <meshoptimizer.h>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModAspectRatioT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/parallel.h"
#include "mesh/mesh_distance.h"
#include "mesh/mesh_ops.h"

namespace swarf::mesh {
namespace {

using Indices = std::vector<uint32_t>;
using OmMesh = OpenMesh::TriMesh_ArrayKernelT<>;

/// Largest mesh that goes on to OpenMesh, whose decimater makes about 35 000 collapses a second.
constexpr size_t kOpenMeshTriangles = 60000;
/// Thinner triangles than this are not made (longest edge over smallest height); they shade badly.
constexpr double kMaxAspect = 20.0;
constexpr double kMaxNormalTurnDeg = 20.0;
/// A quadric's error is a mean over planes and the measured one a maximum: the first try asks for this share.
constexpr double kFirstBudget = 0.3;
constexpr int kTries = 10;
/// What a place may use of the budget after so many tries that were too coarse there; at last it stays as it
/// is.
constexpr std::array<double, 3> kShares{1.0, 0.3, 0.0};

/// The mesh as one list of indices in which vertices at one position are one vertex (the first of them).
Indices welded_indices(const TriMesh& mesh) {
  const auto* indices = reinterpret_cast<const uint32_t*>(mesh.triangles.data());
  Indices welded(3 * mesh.triangles.size());
  meshopt_generateShadowIndexBuffer(welded.data(), indices, welded.size(), mesh.positions.data(),
                                    mesh.positions.size(), sizeof(mesh.positions[0]),
                                    sizeof(mesh.positions[0]));
  return welded;
}

/// By vertex: how many tries were too coarse there.
using Failures = std::vector<uint8_t>;

/// Of one cell of triangles, kept for the next try: most places come to it unchanged.
struct SimplifiedCell {
  Indices in;                    ///< corners
  uint8_t failures = UINT8_MAX;  ///< the most of them
  Indices out;
};
/// By the keys of the cells.
using SimplifiedCells = std::unordered_map<uint64_t, SimplifiedCell>;

/// Numbers the vertices of a list anew, in their order; `vertices` gets which they were.
void number_anew(Indices& list, Indices& vertices, size_t all) {
  vertices = list;
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  thread_local Indices place;  // of what is not in the list: left over
  if (place.size() < all) place.resize(all);
  for (uint32_t i = 0; i < vertices.size(); ++i) place[vertices[i]] = i;
  for (uint32_t& v : list) v = place[v];
}

/// One round of meshoptimizer on a cell's triangles; edges shared with others stay as they are.
Indices simplify_cell(const TriMesh& mesh, const SimplifiedCell& cell, double error_mm) {
  if (kShares[cell.failures] == 0.0) return cell.in;
  Indices local = cell.in, vertices;
  number_anew(local, vertices, mesh.positions.size());
  std::vector<std::array<float, 3>> positions;
  for (const uint32_t v : vertices) positions.push_back(mesh.positions[v]);
  const float extent =
      meshopt_simplifyScale(positions.front().data(), positions.size(), sizeof(positions.front()));
  if (!(extent > 0.0F)) return {};  // only degenerate triangles at one point
  Indices out(local.size());
  out.resize(meshopt_simplify(out.data(), local.data(), local.size(), positions.front().data(),
                              positions.size(), sizeof(positions.front()), 0,
                              static_cast<float>(kShares[cell.failures] * error_mm / extent),
                              meshopt_SimplifyLockBorder, nullptr));
  for (uint32_t& v : out) v = vertices[v];
  return out;
}

/// The same of the triangles whose numbers are listed, unless that is done already.
void simplify_cell(const TriMesh& mesh, const Indices& indices, std::span<const uint32_t> triangles,
                   double error_mm, const Failures& failures, SimplifiedCell& cell) {
  Indices in;
  for (const uint32_t t : triangles)
    in.insert(in.end(), &indices[size_t{3} * t], &indices[size_t{3} * t] + 3);
  uint8_t most = 0;
  for (const uint32_t v : in) most = std::max(most, failures[v]);
  if (most == cell.failures && in == cell.in) return;
  cell.in = std::move(in);
  cell.failures = most;
  cell.out = simplify_cell(mesh, cell, error_mm);
}

/// Triangle numbers sorted by the cell of a grid of pitch `cell_mm` that holds their centroid, and where each
/// cell's run starts.
struct Cells {
  Indices triangles;
  std::vector<size_t> starts;
  std::vector<uint64_t> keys;
};

Cells sort_into_cells(const TriMesh& mesh, const Indices& indices, double cell_mm, double shift_mm) {
  constexpr double kCellsAcross = 1 << 20;  // 3 x 21 bits of a key
  std::vector<std::pair<uint64_t, uint32_t>> keyed(indices.size() / 3);
  for (uint32_t t = 0; t < keyed.size(); ++t) {
    uint64_t key = 0;
    for (size_t k = 0; k < 3; ++k) {
      double sum = 0.0;
      for (size_t corner = 0; corner < 3; ++corner) sum += mesh.positions[indices[size_t{3} * t + corner]][k];
      const double cell = std::floor((sum / 3.0 + shift_mm) / cell_mm) + 0.5 * kCellsAcross;
      key = (key << 21) | static_cast<uint64_t>(std::clamp(cell, 0.0, kCellsAcross));
    }
    keyed[t] = {key, t};
  }
  std::sort(keyed.begin(), keyed.end());
  Cells cells;
  for (size_t i = 0; i < keyed.size(); ++i) {
    if (i == 0 || keyed[i].first != keyed[i - 1].first) {
      cells.starts.push_back(i);
      cells.keys.push_back(keyed[i].first);
    }
    cells.triangles.push_back(keyed[i].second);
  }
  cells.starts.push_back(keyed.size());
  return cells;
}

/// meshoptimizer sums its quadrics in float, relative to the extent of what it is given: below kFloatFloor of
/// the extent its errors are noise. So it gets cells small enough for the error asked for, in two rounds with
/// the second grid shifted by half a cell, so that the first round's locked borders are open in the second.
/// `kept`: of both rounds, of the tries before.
Indices simplify(const TriMesh& mesh, Indices indices, double error_mm, const Failures& failures,
                 std::array<SimplifiedCells, 2>& kept) {
  constexpr double kFloatFloor = 2.5e-4;
  const double cell_mm = error_mm / kFloatFloor;
  for (size_t round = 0; round < kept.size(); ++round) {
    const Cells cells = sort_into_cells(mesh, indices, cell_mm, round == 0 ? 0.0 : 0.5 * cell_mm);
    std::vector<SimplifiedCell*> parts;
    for (const uint64_t key : cells.keys) parts.push_back(&kept[round][key]);
    parallel_chunks(parts.size(), 1, [&](size_t i, size_t) {
      const std::span all(cells.triangles);
      simplify_cell(mesh, indices, all.subspan(cells.starts[i], cells.starts[i + 1] - cells.starts[i]),
                    error_mm, failures, *parts[i]);
    });
    indices.clear();
    for (const SimplifiedCell* part : parts)
      indices.insert(indices.end(), part->out.begin(), part->out.end());
  }
  return indices;
}

/// Triangles whose corners are numbers of vertices; a number's own vertex in the mesh is originals[number].
struct Surface {
  Indices indices, originals;
};

/// Collapses can make sheets touch at a vertex or along an edge, where meshoptimizer does not ask. Around a
/// vertex of a closed surface each triangle leads from one neighbour to the next, and as many lead to a
/// neighbour as away from it; so they part into loops that meet each neighbour once. Every loop but the first
/// gets a copy of the vertex, after which the surface is manifold. Vertices on a border stay.
void split_fans(Surface& surface) {
  const size_t count = surface.originals.size();
  std::vector<size_t> start(count + 1, 0);
  for (const uint32_t v : surface.indices) ++start[v + 1];
  for (size_t v = 0; v < count; ++v) start[v + 1] += start[v];
  std::vector<size_t> corners(surface.indices.size()), next(start.begin(), start.end() - 1);
  for (size_t c = 0; c < corners.size(); ++c) corners[next[surface.indices[c]]++] = c;
  const auto neighbour = [&](size_t corner, size_t step) {
    return surface.indices[corner / 3 * 3 + (corner + step) % 3];
  };
  std::vector<size_t> rest, path, loops;
  for (uint32_t v = 0; v < count; ++v) {
    rest.assign(corners.begin() + static_cast<std::ptrdiff_t>(start[v]),
                corners.begin() + static_cast<std::ptrdiff_t>(start[v + 1]));
    loops.clear();
    bool closed = true;
    for (bool first = true; closed && !(rest.empty() && path.empty());) {
      // On from where the path ends, or anywhere.
      const auto on = path.empty() ? rest.begin() : std::find_if(rest.begin(), rest.end(), [&](size_t c) {
        return neighbour(c, 1) == neighbour(path.back(), 2);
      });
      closed = on != rest.end();
      if (!closed) break;
      path.push_back(*on);
      rest.erase(on);
      const auto back = std::find_if(path.begin(), path.end(),
                                     [&](size_t c) { return neighbour(c, 1) == neighbour(path.back(), 2); });
      if (back == path.end()) continue;
      if (!first) loops.insert(loops.end(), back, path.end());
      if (!first) loops.push_back(corners.size());  // ends a loop
      first = false;
      path.erase(back, path.end());
    }
    path.clear();
    if (!closed) continue;
    for (size_t i = 0; i < loops.size(); ++i) {
      if (i == 0 || loops[i - 1] == corners.size()) surface.originals.push_back(surface.originals[v]);
      if (loops[i] == corners.size()) continue;
      surface.indices[loops[i]] = static_cast<uint32_t>(surface.originals.size() - 1);
    }
  }
}

/// Whether OpenMesh can hold the triangles: it asserts instead of refusing. Each directed edge once, at most
/// one border through a vertex, and no inner vertex with fewer than three triangles (two sheets folded flat).
bool fits_openmesh(const Surface& surface) {
  const size_t count = surface.originals.size();
  std::vector<uint64_t> edges;
  std::vector<uint32_t> triangles(count, 0), borders(count, 0);
  for (size_t c = 0; c < surface.indices.size(); ++c) {
    const uint64_t from = surface.indices[c], to = surface.indices[c / 3 * 3 + (c + 1) % 3];
    if (from == to) return false;
    edges.push_back(from << 32 | to);
    ++triangles[from];
  }
  std::sort(edges.begin(), edges.end());
  if (std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return false;
  for (const uint64_t edge : edges) {
    const uint64_t back = edge << 32 | edge >> 32;
    if (!std::binary_search(edges.begin(), edges.end(), back)) ++borders[edge >> 32];
  }
  for (size_t v = 0; v < count; ++v) {
    if (borders[v] > 1 || (borders[v] == 0 && triangles[v] > 0 && triangles[v] < 3)) return false;
  }
  return true;
}

/// The triangles as an OpenMesh whose vertices know their number; false if they are not
/// manifold.
bool to_openmesh(const TriMesh& mesh, const Surface& surface, OmMesh& om,
                 OpenMesh::VPropHandleT<uint32_t> number) {
  if (!fits_openmesh(surface)) return false;
  const Indices& indices = surface.indices;
  std::vector<OmMesh::VertexHandle> handle(surface.originals.size());
  for (size_t i = 0; i < indices.size(); i += 3) {
    std::array<OmMesh::VertexHandle, 3> corner;
    for (size_t k = 0; k < 3; ++k) {
      OmMesh::VertexHandle& h = handle[indices[i + k]];
      if (!h.is_valid()) {
        const auto& p = mesh.positions[surface.originals[indices[i + k]]];
        h = om.add_vertex({p[0], p[1], p[2]});
        om.property(number, h) = indices[i + k];
      }
      corner[k] = h;
    }
    if (!om.add_face(corner[0], corner[1], corner[2]).is_valid()) return false;
  }
  return true;
}

double mean_area(const OmMesh& om) {
  double sum = 0.0;
  for (const auto face : om.faces()) {
    sum += om.calc_sector_area(om.halfedge_handle(face));
  }
  return sum / static_cast<double>(om.n_faces());
}

/// OpenMesh writes about complex edges to its error stream; the result tells us what we need. The stream is
/// made and connected by who asks for it first, which two threads must not do at once.
void silence_openmesh() {
  [[maybe_unused]] static const bool is_silent = [] {
    omerr().disable();
    return true;
  }();
}

/// OpenMesh's decimater within the error, but not where tries have failed; a mesh it cannot represent stays
/// as it is.
void refine_with_openmesh(const TriMesh& mesh, double error_mm, const Failures& failures, Surface& surface) {
  OmMesh om;
  OpenMesh::VPropHandleT<uint32_t> number;
  om.add_property(number);
  om.request_face_normals();
  om.request_vertex_status();
  om.request_edge_status();
  om.request_face_status();
  silence_openmesh();
  if (!to_openmesh(mesh, surface, om, number)) return;
  // Quadrics of faces do not resist motion along an open border.
  for (const auto v : om.vertices())
    om.status(v).set_locked(om.is_boundary(v) || failures[surface.originals[om.property(number, v)]] > 0);
  om.update_face_normals();
  OpenMesh::Decimater::DecimaterT<OmMesh> decimater(om);
  OpenMesh::Decimater::ModQuadricT<OmMesh>::Handle quadric;
  OpenMesh::Decimater::ModAspectRatioT<OmMesh>::Handle aspect;
  OpenMesh::Decimater::ModNormalFlippingT<OmMesh>::Handle flipping;
  decimater.add(quadric);
  decimater.add(aspect);
  decimater.add(flipping);
  // Its quadrics weigh squared distances by area.
  decimater.module(quadric).set_max_err(error_mm * error_mm * mean_area(om), false);
  decimater.module(aspect).set_aspect_ratio(kMaxAspect);
  decimater.module(flipping).set_max_normal_deviation(kMaxNormalTurnDeg);
  if (!decimater.initialize()) return;
  decimater.decimate();
  om.garbage_collection();
  surface.indices.clear();
  for (const auto face : om.faces()) {
    for (const auto v : om.fv_range(face)) surface.indices.push_back(om.property(number, v));
  }
}

/// The surface with the vertices in use only, in the order of their numbers, and their attributes.
TriMesh gather(const TriMesh& mesh, const Surface& surface) {
  const Indices& indices = surface.indices;
  constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();
  std::vector<uint32_t> place(surface.originals.size(), kUnused);
  for (const uint32_t i : indices) place[i] = 0;
  TriMesh out;
  for (uint32_t v = 0; v < place.size(); ++v) {
    if (place[v] == kUnused) continue;
    place[v] = static_cast<uint32_t>(out.positions.size());
    const uint32_t original = surface.originals[v];
    out.positions.push_back(mesh.positions[original]);
    if (!mesh.normals.empty()) out.normals.push_back(mesh.normals[original]);
    if (!mesh.colours.empty()) out.colours.push_back(mesh.colours[original]);
    if (!mesh.deviation_um.empty()) out.deviation_um.push_back(mesh.deviation_um[original]);
  }
  out.triangles.reserve(indices.size() / 3);
  for (size_t i = 0; i < indices.size(); i += 3) {
    out.triangles.push_back({place[indices[i]], place[indices[i + 1]], place[indices[i + 2]]});
  }
  return out;
}

/// The greatest of the vertices' distances; those that are too far are counted.
double count_failures(const std::vector<double>& distances_mm, double max_error_mm, Failures& failures) {
  double greatest = 0.0;
  for (size_t v = 0; v < distances_mm.size(); ++v) {
    greatest = std::max(greatest, distances_mm[v]);
    if (distances_mm[v] > max_error_mm && failures[v] + 1U < kShares.size()) ++failures[v];
  }
  return greatest;
}

}  // namespace

TriMesh decimate(const TriMesh& mesh, double max_error_mm, double* reached_error) {
  SWARF_CHECK(max_error_mm > 0.0, "decimation needs an error above zero");
  if (reached_error != nullptr) *reached_error = 0.0;
  if (mesh.triangles.empty()) return mesh;
  const Indices welded = welded_indices(mesh);
  const double budget = kFirstBudget * max_error_mm;
  Failures failures(mesh.positions.size(), 0);
  std::array<SimplifiedCells, 2> kept;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    Surface surface{simplify(mesh, welded, budget, failures, kept), Indices(mesh.positions.size())};
    std::iota(surface.originals.begin(), surface.originals.end(), 0U);
    split_fans(surface);
    if (surface.indices.size() / 3 <= kOpenMeshTriangles)
      refine_with_openmesh(mesh, budget, failures, surface);
    TriMesh candidate = gather(mesh, surface);
    const double error = count_failures(distances(mesh.positions, candidate), max_error_mm, failures);
    if (error > max_error_mm) continue;
    if (reached_error != nullptr) *reached_error = error;
    return candidate;
  }
  return mesh;
}

}  // namespace swarf::mesh
