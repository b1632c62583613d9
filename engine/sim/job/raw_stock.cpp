// The body that [stock] means: files read, checked and moved into the work frame.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "mesh/mesh_check.h"
#include "mesh/mesh_crossing.h"
#include "mesh/mesh_io.h"
#include "mesh/mesh_nesting.h"
#include "mesh/mesh_ops.h"
#include "mesh/signed_distance.h"
#include "sim/job/mesh_unit.h"
#include "sim/job/stock_keys.h"

namespace swarf::sim {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMeshName = "stock mesh";

TriMesh moved(TriMesh mesh, double unit_mm, const Pose& X_WF) {
  if (unit_mm == 1.0 && X_WF.isApprox(Pose::Identity(), 0.0)) return mesh;
  for (auto& p : mesh.positions) {
    const Vec3 q = X_WF * Vec3(unit_mm * Vec3(p[0], p[1], p[2]));
    p = {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z())};
  }
  mesh.normals.clear();
  return mesh;
}

/// Closed, turned outward, its bodies apart. `remedy`: of one that runs through itself.
bool is_sound(const TriMesh& mesh, const std::string& file, const char* remedy, Diagnostics& diagnostics) {
  mesh::check_design_mesh(mesh, file, nullptr, diagnostics, kMeshName);
  if (diagnostics.has_errors()) return false;
  const mesh::Crossings found = mesh::find_crossings(mesh::SignedDistance(mesh));
  if (found.pairs > 0)
    diagnostics.error(
        "mesh-self-crossing", {file},
        fmt::format("the {} crosses itself: {} pairs of facets run through or over each other, the first at "
                    "({:.3f}, {:.3f}, {:.3f}) mm: what lies inside is not clear",
                    kMeshName, found.pairs, found.place.x(), found.place.y(), found.place.z()),
        remedy);
  if (!diagnostics.has_errors()) mesh::check_bodies(mesh, file, diagnostics, kMeshName);
  return !diagnostics.has_errors();
}

std::optional<stock::RawShape> load_raw_mesh(const RawSettings& raw, double tool_mm,
                                             Diagnostics& diagnostics) {
  const TriMesh mesh = moved(mesh::load_mesh(raw.file), raw.unit_mm, raw.X_WF);
  if (!is_sound(mesh, raw.file, "unite the bodies in the CAD or repair program and export again",
                diagnostics))
    return {};
  suspect_unit({kMeshName, "stock.mesh_unit", raw.where}, mesh::bounds(mesh), tool_mm, diagnostics);
  return stock::RawShape::of_mesh(mesh, fs::path(raw.file).filename().string());
}

/// Two sides meet beside a common corner.
bool sides_cross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const auto turn = [](const Vec2& p, const Vec2& q, const Vec2& r) {
    return (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
  };
  const double ab_c = turn(a, b, c), ab_d = turn(a, b, d), cd_a = turn(c, d, a), cd_b = turn(c, d, b);
  if (ab_c == 0.0 && ab_d == 0.0) {
    const int axis = std::abs(b.x() - a.x()) >= std::abs(b.y() - a.y()) ? 0 : 1;
    return std::max(std::min(a[axis], b[axis]), std::min(c[axis], d[axis])) <
           std::min(std::max(a[axis], b[axis]), std::max(c[axis], d[axis]));
  }
  return ab_c * ab_d <= 0.0 && cd_a * cd_b <= 0.0;
}

bool is_simple(const RawSettings& raw, Diagnostics& diagnostics) {
  const std::vector<Vec2>& p = raw.outline.points_mm;
  const auto fail = [&](const Vec2& at, const std::string& what) {
    diagnostics.error("outline-crosses-itself", raw.where,
                      fmt::format("the outline of the stock {} at ({:.3f}, {:.3f}) mm", what, at.x(), at.y()),
                      "write its corners in order around it, each once");
    return false;
  };
  for (size_t i = 0; i < p.size(); ++i) {
    const Vec2 &a = p[i], &b = p[(i + 1) % p.size()], &next = p[(i + 2) % p.size()];
    if (a == b) return fail(a, "has the same corner twice");
    const Vec2 way = b - a, on = next - b;
    if (way.x() * on.y() == way.y() * on.x() && way.dot(on) < 0.0) return fail(b, "turns back");
    for (size_t k = i + 2; k < p.size(); ++k) {
      if (i == 0 && k + 1 == p.size()) continue;
      if (sides_cross(a, b, p[k], p[(k + 1) % p.size()])) return fail(p[k], "crosses itself");
    }
  }
  return true;
}

}  // namespace

std::optional<stock::RawShape> load_raw(const RawSettings& raw, double tool_mm, Diagnostics& diagnostics) {
  switch (raw.kind) {
    case RawKind::kBox:
      return {};
    case RawKind::kTube:
      return stock::RawShape::of_tube(raw.tube);
    case RawKind::kOutline:
      if (!is_simple(raw, diagnostics)) return {};
      return stock::RawShape::of_outline(raw.outline);
    case RawKind::kMesh:
      return load_raw_mesh(raw, tool_mm, diagnostics);
    case RawKind::kRun:
    case RawKind::kSetups:
      return {};  // set_ups.h
  }
  return {};
}

}  // namespace swarf::sim
