// shown_agreement(): what is interpolated between vertices against the field, at random places.
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/rng.h"
#include "mesh/mixed_corners.h"
#include "mesh/shown_field.h"

namespace swarf::mesh {
namespace {

constexpr uint64_t kSeed = 41;

struct RandomPlace {
  size_t triangle;
  Vec3 shares;
};

std::vector<RandomPlace> random_places(const TriMesh& mesh, size_t count) {
  std::vector<double> sums;
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = vec3_of(mesh.positions[t[0]]);
    const Vec3 cross = (vec3_of(mesh.positions[t[1]]) - a).cross(vec3_of(mesh.positions[t[2]]) - a);
    sums.push_back(sum += 0.5 * cross.norm());
  }
  Rng rng(kSeed);
  std::vector<RandomPlace> places;
  for (size_t n = 0; n < count; ++n) {
    const auto found = std::lower_bound(sums.begin(), sums.end(), rng.uniform(0.0, sum));
    double u = rng.uniform(), v = rng.uniform();
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const auto triangle = static_cast<size_t>(found - sums.begin());
    places.push_back({std::min(triangle, sums.size() - 1), {1.0 - u - v, u, v}});
  }
  return places;
}

}  // namespace

ShownAgreement shown_agreement(const ShownField& field, const TriMesh& mesh, size_t count) {
  ShownAgreement found;
  if (mesh.triangles.empty()) return found;
  const std::vector<RandomPlace> places = random_places(mesh, count);
  TriMesh probes;
  for (const RandomPlace& place : places) {
    const auto& corners = mesh.triangles[place.triangle];
    probes.positions.push_back(floats_of(mixed_corners(mesh.positions, corners, place.shares)));
    probes.normals.push_back(floats_of(mixed_corners(mesh.normals, corners, place.shares).normalized()));
  }
  field.measure(probes);
  for (size_t n = 0; n < places.size(); ++n) {
    const auto& corners = mesh.triangles[places[n].triangle];
    std::array<float, 3> um{};
    for (size_t k = 0; k < 3; ++k) um[k] = mesh.deviation_um[corners[k]];
    const bool shown = !std::isnan(um[0] + um[1] + um[2]);
    if (std::isnan(probes.deviation_um[n])) continue;
    if (!shown) {
      ++found.grey;
      continue;
    }
    ++found.seen;
    const double error = field.error(um, places[n].shares, probes.deviation_um[n]);
    if (error > 1.0) ++found.wrong;
    if (error <= found.worst) continue;
    found.worst = error;
    found.where = vec3_of(probes.positions[n]);
  }
  return found;
}

}  // namespace swarf::mesh
