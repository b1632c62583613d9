// A finished part against its design, both as meshes: distances from either to the other over all of both.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measure/surface_cells.h"
#include "mesh/signed_distance.h"
#include "stock/rays/ray_field.h"

namespace swarf::measure {

/// Who is compared with whom, and what is allowed. Lengths in mm.
struct ComparisonInput {
  const mesh::SignedDistance* stock = nullptr;   ///< a closed mesh
  const mesh::SignedDistance* design = nullptr;  ///< a closed mesh, or open patches
  bool open_design = false;
  double allowance = 0.0;  ///< >= 0: the target is the design offset outward by this
  double excess = 0.01, gouge = 0.001;
  double pitch = 0.5;  ///< cells of both surfaces are halved until every point lies so near to a sample
  double design_error = 0.0;          ///< by which the design's facets stray from what they stand for
  std::vector<double> design_errors;  ///< the same per facet of the design's mesh; empty: it for all
  /// The surfaces over the design's facets: samples are measured from them, bounds from the facets and their
  /// error. Null: from the facets all.
  const stock::DesignMesh* faces = nullptr;
  std::vector<double> stock_error;  ///< the same per vertex of the stock's mesh; empty: none
  std::vector<uint8_t> stock_edge;  ///< per vertex of the stock's mesh: an edge that its grid has rounded
  double edge = 0.0;                ///< what a rounded edge may be off; also the width along a patch's border
  std::optional<double> reach;      ///< nothing farther from the other surface is measured
};

/// A connected part of stock and design where the deviation is beyond a limit.
struct DeviationRegion {
  bool gouge = false;
  double worst_um = 0.0;  ///< > 0
  Vec3 place = Vec3::Zero();
  bool on_design = false;       ///< the place: on the design, else on the stock
  double stock_area_mm2 = 0.0;  ///< beyond the limit
  double design_area_mm2 = 0.0;
  std::optional<double> volume_mm3;  ///< between stock and design; of the worst kListedDeviations only
};
inline constexpr size_t kListedDeviations = 20;

/// What is known of the greatest excess (or gouge).
struct DeviationExtreme {
  double um = 0.0;        ///< the greatest sample, 0 without one
  double bound_um = 0.0;  ///< proven of all points of both surfaces, errors of facets and grid included
  Vec3 place = Vec3::Zero();
  Vec3 bound_place = Vec3::Zero();
};

struct SideSummary {
  double area_mm2 = 0.0;        ///< compared
  double beyond_mm2 = 0.0;      ///< of the stock: beyond the patches, or facing another way
  double edge_mm2 = 0.0;        ///< compared, but rounded by the grid: only what exceeds `edge` counts
  double unmeasured_mm2 = 0.0;  ///< farther away than the reach
  size_t samples = 0, proof_samples = 0;
  double greatest_um = 0.0;  ///< |deviation|
};

struct PartComparison {
  DeviationExtreme excess, gouge;
  double edge_greatest_um = 0.0;  ///< |deviation| at rounded edges
  double mean_um = 0.0, mean_abs_um = 0.0, rms_um = 0.0, within_tolerance_pct = 0.0;  ///< by area, both sides
  double grid_error_um = 0.0;  ///< greatest that was added to a bound
  SideSummary stock, design;
  size_t region_count = 0;
  std::vector<DeviationRegion> regions;  ///< worst first, at most kListedDeviations
  /// Closed designs without allowance: material beyond the design, missing from it, and stock - design.
  std::optional<double> excess_mm3, gouge_mm3, difference_mm3;
  TriMesh stock_map, design_map;  ///< the cells with deviation_um: of each vertex the worst beside it
};

/// Measures from both surfaces. Positive: stock beyond the target.
///
///   On the stock      deviation = distance to the design - allowance
///   On the design     deviation = - distance of the point, moved outward by the allowance, to the stock
///
/// 1. Both surfaces are divided into cells and sampled at the cells' centroids: by area, whatever the facets.
/// 2. Over a cell of radius r the deviation is at most that of its centroid + r (distances are 1-Lipschitz),
/// at
///    most the distance of its corners to any one facet (distance to a convex set is convex), and within what
///    clear_column allows. Cells for which none of these meets the target are halved, worst first, until the
///    bound meets the limit, or lies within kProofGap of a sample; what the work allowed leaves is in the
///    bound.
/// 3. Cells beyond a limit that touch, or lie over one another, are one region.
PartComparison compare_parts(const ComparisonInput& input);

/// A bound that exceeds a sample by this is tight, mm.
inline constexpr double kProofGap = 5e-5;

}  // namespace swarf::measure
