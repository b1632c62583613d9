#include "mesh/mesh_nesting.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "mesh/mesh_check.h"
#include "mesh/mesh_crossing.h"
#include "mesh/mesh_distance.h"
#include "mesh/mesh_shells.h"

namespace swarf::mesh {
namespace {

/// Windings are whole numbers unless the point lies on the shell.
constexpr double kClearlyOther = 0.75;

struct Body {
  double volume_mm3 = 0.0;
  Vec3 place = Vec3::Zero();  ///< in the middle of the largest facet
};

Body measure(const WeldedMesh& mesh, const Shell& shell) {
  Body body;
  double largest = -1.0;
  const Vec3 origin = corners_of(mesh, shell.facets.front())[0];
  for (const uint32_t facet : shell.facets) {
    const std::array<Vec3, 3> c = corners_of(mesh, facet);
    const Vec3 normal = (c[1] - c[0]).cross(c[2] - c[0]);
    body.volume_mm3 += (c[0] - origin).dot(normal) / 6.0;
    if (normal.squaredNorm() <= largest) continue;
    largest = normal.squaredNorm();
    body.place = (c[0] + c[1] + c[2]) / 3.0;
  }
  return body;
}

}  // namespace

std::optional<MisplacedBody> find_misplaced_body(const TriMesh& mesh) {
  const WeldedMesh welded = weld(mesh);
  const std::vector<Shell> shells = shells_of(welded, facets_across(welded.triangles));
  std::vector<Body> bodies(shells.size());
  parallel_chunks(shells.size(), 1, [&](size_t n, size_t) { bodies[n] = measure(welded, shells[n]); });
  std::vector<double> around(shells.size(), 0.0);
  parallel_chunks(shells.size(), 1, [&](size_t n, size_t) {
    for (size_t other = 0; other < shells.size(); ++other) {
      if (other != n && holds(shells[other].box, bodies[n].place))
        around[n] += winding(welded, shells[other], bodies[n].place);
    }
  });
  for (size_t n = 0; n < shells.size(); ++n) {
    const double right = bodies[n].volume_mm3 < 0.0 ? 1.0 : 0.0;
    if (std::abs(around[n] - right) > kClearlyOther)
      return MisplacedBody{bodies[n].place, bodies[n].volume_mm3, static_cast<int>(std::lround(around[n]))};
  }
  return {};
}

void check_bodies(const TriMesh& mesh, const std::string& path, Diagnostics& diagnostics,
                  const std::string& name) {
  const std::optional<MisplacedBody> body = find_misplaced_body(mesh);
  if (!body) return;
  const Vec3& p = body->place;
  const char* fault = body->volume_mm3 < 0.0
                          ? (body->around < 1 ? "is turned inward but lies in no body: it is inside out"
                                              : "is a cavity in the material of two bodies at once")
                          : "lies inside another body's material";
  diagnostics.error(
      "mesh-nested-bodies", {path},
      fmt::format("a body of the {} ({:.3f} mm3, with a facet at ({:.3f}, {:.3f}, {:.3f}) mm) {}", name,
                  std::abs(body->volume_mm3), p.x(), p.y(), p.z(), fault),
      "unite the bodies in the CAD program; the facets of a cavity point into it, those of a body outward");
}

void check_apart(const TriMesh& mesh, const std::string& path, Diagnostics& diagnostics,
                 const std::string& name) {
  const WeldedMesh welded = weld(mesh);
  const std::vector<Shell> shells = shells_of(welded, facets_across(welded.triangles));
  if (shells.size() < 2) return;
  std::vector<uint32_t> shell_of(welded.triangles.size(), 0);
  for (uint32_t n = 0; n < shells.size(); ++n)
    for (const uint32_t facet : shells[n].facets) shell_of[facet] = n;
  TriMesh all;
  for (const Vec3& p : welded.points)
    all.positions.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  all.triangles = welded.triangles;
  const Crossings found = find_crossings(all, MeshDistance(all),
                                         [&](uint32_t a, uint32_t b) { return shell_of[a] != shell_of[b]; });
  if (found.pairs == 0) return;
  const Vec3& p = found.place;
  diagnostics.error(
      "mesh-bodies-overlap", {path},
      fmt::format("two bodies of the {} overlap or lie against each other: {} pairs of facets, the "
                  "first at ({:.3f}, {:.3f}, {:.3f}) mm",
                  name, found.pairs, p.x(), p.y(), p.z()),
      "unite the bodies in the CAD program and export again");
}

}  // namespace swarf::mesh
