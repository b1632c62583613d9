#include "brep/facet_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace swarf::brep {
namespace {

/// Each patch is looked at in the middles of kParts x kParts cells.
constexpr int kParts = 8;
constexpr double kSide = 1.0 / kParts;

double facets_of_cell(const surface::Derivatives& at, double chord_mm) {
  const auto divisions = [&](const Vec3& bend) { return kSide * std::sqrt(bend.norm() / (8.0 * chord_mm)); };
  // A strip of a patch that is straight one way is divided the other way alone.
  const double across = std::max(divisions(at.Suu), kSide) * std::max(divisions(at.Svv), kSide);
  const double twisted = kSide * kSide * at.Suv.norm() / (4.0 * chord_mm);
  return 2.0 * std::max(across, twisted);
}

double facets_of_patch(const surface::Surface& surface, double chord_mm) {
  double facets = 0.0;
  for (int i = 0; i < kParts; ++i)
    for (int k = 0; k < kParts; ++k)
      facets += facets_of_cell(surface.derivatives((i + 0.5) * kSide, (k + 0.5) * kSide), chord_mm);
  return facets;
}

/// Its polyline has `points` with a chord of its own; two faces meet there.
double facets_along(const Edge& edge, double edge_mm) {
  const double chord = std::max(edge.chord_mm, 1e-12);
  return 2.0 * static_cast<double>(edge.points.size()) * std::min(1.0, std::sqrt(chord / edge_mm));
}

Vec3 size_of(const Model& model) {
  if (model.vertices.empty()) return Vec3::Zero();
  Vec3 low = model.vertices.front(), high = low;
  for (const Edge& edge : model.edges)
    for (const Vec3& p : edge.points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  return high - low;
}

}  // namespace

double estimated_facets(const Model& model, double chord_mm, double edge_mm) {
  double facets = 0.0;
  for (const surface::Face& face : model.faces) facets += facets_of_patch(*face.surface, chord_mm);
  for (const Edge& edge : model.edges) facets += facets_along(edge, edge_mm);
  return facets;
}

void require_facets_fit(const Model& model, double chord_mm, double edge_mm) {
  const double facets = estimated_facets(model, chord_mm, edge_mm);
  if (facets <= kMostFacets) return;
  const Vec3 size = size_of(model);
  throw InputError(
      "cad-too-fine", {model.file},
      fmt::format(
          "the part is {:.5g} x {:.5g} x {:.5g} mm (unit {} = {:g} mm): facets within {:.3g} um of its "
          "faces and {:.3g} um of its edges would be at least {:.2g} million, and {:g} million are the most",
          size.x(), size.y(), size.z(), model.unit, model.mm_per_unit, um_from_mm(chord_mm),
          um_from_mm(edge_mm), 1e-6 * facets, 1e-6 * kMostFacets),
      "if the size is wrong, export the part again with its right unit; else raise chord_um, or "
      "accept.gouge_max_um, from which the chord of edges follows");
}

}  // namespace swarf::brep
