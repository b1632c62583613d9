// decimate(): meshoptimizer for the bulk, OpenMesh for the rest, a nearest-point tree for the proof.
#include <meshoptimizer.h>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModAspectRatioT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <algorithm>
#include <limits>

#include "base/check.h"
#include "base/units.h"
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
constexpr double kFirstBudget = 0.5;
constexpr int kTries = 6;

/// The mesh as one list of indices in which vertices at one position are one vertex (the first of them).
Indices welded_indices(const TriMesh& mesh) {
  const auto* indices = reinterpret_cast<const uint32_t*>(mesh.triangles.data());
  Indices welded(3 * mesh.triangles.size());
  meshopt_generateShadowIndexBuffer(welded.data(), indices, welded.size(), mesh.positions.data(),
                                    mesh.positions.size(), sizeof(mesh.positions[0]), sizeof(mesh.positions[0]));
  return welded;
}

Indices simplify(const TriMesh& mesh, const Indices& indices, double error_mm) {
  const double extent = meshopt_simplifyScale(mesh.positions.front().data(), mesh.positions.size(),
                                              sizeof(mesh.positions[0]));
  Indices out(indices.size());
  const size_t count = meshopt_simplify(out.data(), indices.data(), indices.size(), mesh.positions.front().data(),
                                        mesh.positions.size(), sizeof(mesh.positions[0]), 0,
                                        static_cast<float>(error_mm / extent), 0, nullptr);
  out.resize(count);
  return out;
}

/// The triangles as an OpenMesh whose vertices know their index in the original; false if they are not manifold.
bool to_openmesh(const TriMesh& mesh, const Indices& indices, OmMesh& om,
                 OpenMesh::VPropHandleT<uint32_t> original) {
  std::vector<OmMesh::VertexHandle> handle(mesh.positions.size());
  for (size_t i = 0; i < indices.size(); i += 3) {
    std::array<OmMesh::VertexHandle, 3> corner;
    for (size_t k = 0; k < 3; ++k) {
      OmMesh::VertexHandle& h = handle[indices[i + k]];
      if (!h.is_valid()) {
        const auto& p = mesh.positions[indices[i + k]];
        h = om.add_vertex({p[0], p[1], p[2]});
        om.property(original, h) = indices[i + k];
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

/// OpenMesh's decimater within the error; a mesh it cannot represent is returned as it came.
Indices refine_with_openmesh(const TriMesh& mesh, const Indices& indices, double error_mm) {
  OmMesh om;
  OpenMesh::VPropHandleT<uint32_t> original;
  om.add_property(original);
  om.request_face_normals();
  om.request_vertex_status();
  om.request_edge_status();
  om.request_face_status();
  // OpenMesh writes about complex edges to its error stream; the result tells us what we need.
  omerr().disable();
  const bool manifold = to_openmesh(mesh, indices, om, original);
  omerr().enable();
  if (!manifold) return indices;
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
  if (!decimater.initialize()) return indices;
  decimater.decimate();
  om.garbage_collection();
  Indices out;
  out.reserve(3 * om.n_faces());
  for (const auto face : om.faces()) {
    for (const auto v : om.fv_range(face)) out.push_back(om.property(original, v));
  }
  return out;
}

/// The mesh of `indices`, with the vertices in use only, in their original order, and their attributes.
TriMesh gather(const TriMesh& mesh, const Indices& indices) {
  constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();
  std::vector<uint32_t> place(mesh.positions.size(), kUnused);
  for (const uint32_t i : indices) place[i] = 0;
  TriMesh out;
  for (uint32_t v = 0; v < place.size(); ++v) {
    if (place[v] == kUnused) continue;
    place[v] = static_cast<uint32_t>(out.positions.size());
    out.positions.push_back(mesh.positions[v]);
    if (!mesh.normals.empty()) out.normals.push_back(mesh.normals[v]);
    if (!mesh.colours.empty()) out.colours.push_back(mesh.colours[v]);
    if (!mesh.deviation_um.empty()) out.deviation_um.push_back(mesh.deviation_um[v]);
  }
  out.triangles.reserve(indices.size() / 3);
  for (size_t i = 0; i < indices.size(); i += 3) {
    out.triangles.push_back({place[indices[i]], place[indices[i + 1]], place[indices[i + 2]]});
  }
  return out;
}

}  // namespace

TriMesh decimate(const TriMesh& mesh, double max_error_mm, double* reached_error) {
  SWARF_CHECK(max_error_mm > 0.0, "decimation needs an error above zero");
  if (reached_error != nullptr) *reached_error = 0.0;
  if (mesh.triangles.empty()) return mesh;
  const Indices welded = welded_indices(mesh);
  double budget = kFirstBudget * max_error_mm;
  for (int attempt = 0; attempt < kTries; ++attempt, budget *= 0.5) {
    Indices indices = simplify(mesh, welded, budget);
    if (indices.size() / 3 <= kOpenMeshTriangles) indices = refine_with_openmesh(mesh, indices, budget);
    TriMesh candidate = gather(mesh, indices);
    const double error = max_distance(mesh.positions, candidate);
    if (error > max_error_mm) continue;
    if (reached_error != nullptr) *reached_error = error;
    return candidate;
  }
  return mesh;
}

}  // namespace swarf::mesh
