#include "render/raster/gpu_mesh.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/check.h"
#include "base/hash.h"

namespace swarf::render {
namespace {

constexpr size_t kFingerprintSamples = 64;

/// Sizes and some positions: tells a mesh from another that took its address.
uint64_t fingerprint(const TriMesh& mesh) {
  Hash hash;
  for (const size_t size :
       {mesh.positions.size(), mesh.triangles.size(), mesh.normals.size(), mesh.colours.size()}) {
    hash.add(uint64_t{size});
  }
  const size_t step = mesh.positions.size() / kFingerprintSamples + 1;
  for (size_t i = 0; i < mesh.positions.size(); i += step) {
    for (const float c : mesh.positions[i]) hash.add(c);
    if (!mesh.colours.empty()) {
      for (const uint8_t c : mesh.colours[i]) hash.add(uint64_t{c});
    }
  }
  return hash.value();
}

Box bounds_of(const TriMesh& mesh) {
  Eigen::Array3f low = Eigen::Array3f::Constant(mesh.positions.empty() ? 0.0F : 1e30F), high = -low;
  for (const auto& p : mesh.positions) {
    const Eigen::Array3f v(p[0], p[1], p[2]);
    low = low.min(v);
    high = high.max(v);
  }
  return {low.matrix().cast<double>(), high.matrix().cast<double>()};
}

/// Vertices are split along creases, so vertices count as one where their positions are equal.
std::vector<uint32_t> merged_vertices(const TriMesh& mesh) {
  std::vector<uint32_t> order(mesh.positions.size()), merged(mesh.positions.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return mesh.positions[a] < mesh.positions[b]; });
  for (size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && mesh.positions[order[i]] == mesh.positions[order[i - 1]];
    merged[order[i]] = same ? merged[order[i - 1]] : order[i];
  }
  return merged;
}

/// True when each edge is met as often in one direction as in the other.
bool is_closed(const TriMesh& mesh) {
  const std::vector<uint32_t> merged = merged_vertices(mesh);
  std::vector<std::pair<uint32_t, uint32_t>> forward, backward;
  for (const auto& triangle : mesh.triangles) {
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t a = merged[triangle[k]], b = merged[triangle[(k + 1) % 3]];
      if (a < b) forward.emplace_back(a, b);
      if (b < a) backward.emplace_back(b, a);
    }
  }
  std::sort(forward.begin(), forward.end());
  std::sort(backward.begin(), backward.end());
  return forward == backward;
}

/// With its normal at each face's own corners: shaded flat.
TriMesh with_face_normals(const TriMesh& mesh) {
  TriMesh flat;
  for (const auto& triangle : mesh.triangles) {
    const auto at = [&](size_t k) {
      const auto& p = mesh.positions[triangle[k]];
      return Eigen::Vector3f(p[0], p[1], p[2]);
    };
    const Eigen::Vector3f normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
    const auto first = static_cast<uint32_t>(flat.positions.size());
    flat.triangles.push_back({first, first + 1, first + 2});
    for (const uint32_t vertex : triangle) {
      flat.positions.push_back(mesh.positions[vertex]);
      flat.normals.push_back({normal.x(), normal.y(), normal.z()});
      if (!mesh.colours.empty()) flat.colours.push_back(mesh.colours[vertex]);
    }
  }
  return flat;
}

/// The triangles, those that are enclosed last, and how many are not.
std::vector<std::array<uint32_t, 3>> outside_first(const TriMesh& mesh, const mesh::Enclosed& enclosed,
                                                   size_t& outside) {
  SWARF_CHECK(enclosed.facets.size() == mesh.triangles.size(), "one mark per triangle");
  std::vector<std::array<uint32_t, 3>> sorted, last;
  for (size_t i = 0; i < mesh.triangles.size(); ++i)
    (enclosed.facets[i] == 0 ? sorted : last).push_back(mesh.triangles[i]);
  outside = sorted.size();
  sorted.insert(sorted.end(), last.begin(), last.end());
  return sorted;
}

}  // namespace

const GpuMesh& GpuMeshCache::get(const DrawItem& item) {
  const auto [found, inserted] = entries_.try_emplace(item.mesh);
  Entry& entry = found->second;
  entry.used = true;
  const uint64_t now = item.revision != 0 ? item.revision : fingerprint(*item.mesh);
  if (inserted || item.dynamic || entry.mesh.fingerprint != now || entry.mesh.enclosed != item.enclosed) {
    upload(item, entry.mesh);
    entry.mesh.fingerprint = now;
    entry.mesh.enclosed = item.enclosed;
  }
  return entry.mesh;
}

void GpuMeshCache::collect() {
  for (auto it = entries_.begin(); it != entries_.end();) {
    if (it->second.used) {
      it->second.used = false;
      ++it;
      continue;
    }
    gl_.DeleteVertexArrays(1, &it->second.mesh.vertex_array);
    gl_.DeleteBuffers(4, it->second.mesh.buffers);
    it = entries_.erase(it);
  }
}

void GpuMeshCache::upload(const DrawItem& item, GpuMesh& target) {
  const TriMesh& given = *item.mesh;
  SWARF_CHECK(given.normals.empty() || given.normals.size() == given.positions.size(),
              "one normal per vertex");
  SWARF_CHECK(given.colours.empty() || given.colours.size() == given.positions.size(),
              "one colour per vertex");
  TriMesh flat;
  if (given.normals.empty()) flat = with_face_normals(given);
  const TriMesh& mesh = given.normals.empty() ? flat : given;
  if (target.vertex_array != 0) {
    gl_.DeleteVertexArrays(1, &target.vertex_array);
    gl_.DeleteBuffers(4, target.buffers);
  }
  gl_.GenVertexArrays(1, &target.vertex_array);
  gl_.GenBuffers(4, target.buffers);
  gl_.BindVertexArray(target.vertex_array);
  const GLenum usage = item.dynamic ? GL_STREAM_DRAW : GL_STATIC_DRAW;
  const auto attribute = [&](GLuint index, GLint components, GLenum type, GLboolean normalised,
                             const auto& data) {
    if (data.empty()) return;
    gl_.BindBuffer(GL_ARRAY_BUFFER, target.buffers[index]);
    gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(data.size() * sizeof(data[0])), data.data(),
                   usage);
    gl_.VertexAttribPointer(index, components, type, normalised, 0, nullptr);
    gl_.EnableVertexAttribArray(index);
  };
  attribute(0, 3, GL_FLOAT, GL_FALSE, mesh.positions);
  attribute(1, 3, GL_FLOAT, GL_FALSE, mesh.normals);
  attribute(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, mesh.colours);
  size_t outside = mesh.triangles.size();
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, target.buffers[3]);
  gl_.BufferData(
      GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.triangles.size() * sizeof(mesh.triangles[0])),
      item.enclosed != nullptr ? outside_first(mesh, *item.enclosed, outside).data() : mesh.triangles.data(),
      usage);
  target.index_count = static_cast<GLsizei>(3 * mesh.triangles.size());
  target.outside_count = static_cast<GLsizei>(3 * outside);
  target.has_colours = !mesh.colours.empty();
  target.closed = item.outside_only || (!item.dynamic && item.revision == 0 && is_closed(given));
  target.bounds = bounds_of(mesh);
}

}  // namespace swarf::render
