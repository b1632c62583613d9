// What bounds the deviation over a flat piece of a surface, and where it is best cut in two. Internal to this
// folder.
#pragma once

#include <array>

#include "measure/deviation_side.h"

namespace swarf::measure {

/// Bounds of one piece, step by step tighter and dearer:
///
///   kWay      the distance of the centre, and the way to it: distances are 1-Lipschitz
///   kFacet    the corners' distances to the facet that the centre sees (TargetMesh::distance_over)
///   kColumn   the facets above and below the piece (clear_column)
///   kCorners  the same as kFacet for each facet that a corner sees
///
/// What is left open is cut where the nearest facet changes: beyond the side of a facet the next one is
/// nearer, in a corner the one on the other side of the bisector. The parts lie over one facet each after as
/// many cuts as facets meet there, however small the step between two edges is. Halving would go on until
/// the parts were as small as the step.
class PieceBounds {
 public:
  enum class Step : uint8_t { kWay, kFacet, kColumn, kCorners };
  static constexpr std::array kSteps{Step::kWay, Step::kFacet, Step::kColumn, Step::kCorners};

  /// `piece` as it lies on the surface; `centre`: the sample at its centre, which was measured.
  PieceBounds(const DeviationSide& side, uint32_t triangle, const FlatPiece& piece,
              const DeviationSample& centre);
  void tighten(Step step);
  /// The deviation (DeviationSample::raw), errors included.
  DistanceRange deviation() const;
  /// Of the corners that kCorners has looked from, the one that is farthest from what it sees; on the
  /// surface.
  Vec3 farthest_corner() const;
  /// After kCorners.
  std::array<FlatPiece, 2> parts() const;

 private:
  void within(double low, double high);
  void look_from_corners();
  size_t corner_farthest_from_facet(double& excess_mm) const;
  std::optional<std::array<FlatPiece, 2>> cut_beside_facet(uint32_t facet, const Vec3& beyond) const;
  std::optional<std::array<FlatPiece, 2>> cut_between(uint32_t a, uint32_t b, const Vec3& at) const;
  std::optional<std::array<FlatPiece, 2>> cut_at(const CutPlane& plane) const;

  const DeviationSide& side_;
  const TargetMesh& target_;
  uint32_t triangle_;
  const FlatPiece& piece_;
  FlatPiece moved_;
  const DeviationSample& centre_;
  DistanceRange distance_;
  std::array<uint32_t, FlatPiece::kMostCorners> facets_{};  ///< that the corners see
  std::array<double, FlatPiece::kMostCorners> away_{};      ///< how far they are, mm
};

}  // namespace swarf::measure
