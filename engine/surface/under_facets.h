// The exact surfaces under the facets of a mesh: what is measured is the surface, the facets say which of its
// parameters belong to the part and what lies beside what.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "surface/surface.h"

namespace swarf::surface {

/// One facet as a triangle of parameters.
struct FacetOnSurface {
  static constexpr int kNone = -1;
  int surface = kNone;       ///< of UnderFacets::surfaces; kNone: no more than the facet is known
  std::array<Vec2, 3> uv{};  ///< its corners, in the unit square
  /// Of UnderFacets::edges: side k, from corner k to the next, stands for a piece of that curved edge.
  std::array<int, 3> edges{kNone, kNone, kNone};
  std::array<double, 3> chords_mm{};  ///< how far the edge strays from side k of the facet
};

/// A piece of a curved edge in the parameters: 2^n + 1 places from one corner of a facet to the next.
using EdgePlaces = std::vector<Vec2>;

struct UnderFacets {
  std::vector<SurfacePtr> surfaces;
  std::vector<char> is_plane;          ///< of each surface: its facets are exact themselves
  std::vector<FacetOnSurface> facets;  ///< of each triangle of the mesh
  std::vector<EdgePlaces> edges;       ///< of sides of curved facets
  double chord_mm = 0.0;               ///< no place of the surfaces is farther from its facet
  /// Beside a curved edge planes end this much before or beyond it, and curved surfaces, which follow the
  /// places of their edges; mm, held at the quarters of every side.
  double edge_mm = 0.0;

  /// Whether the surface of the facet is something else than the facet.
  bool is_curved(uint32_t facet) const {
    const int on = facets[facet].surface;
    return on != FacetOnSurface::kNone && is_plane[static_cast<size_t>(on)] == 0;
  }
};
using UnderFacetsPtr = std::shared_ptr<const UnderFacets>;

}  // namespace swarf::surface
