// One surface of a comparison, seen from its own cells. Internal to this folder.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "base/units.h"
#include "measure/clear_column.h"
#include "measure/part_comparison.h"

namespace swarf::measure {

enum class CellState : uint8_t {
  kMeasured,
  kBeyond,  ///< no part of the comparison: off the patches, or facing another way
  kFar,     ///< beyond the reach
};

/// The deviation at one point of a surface.
struct DeviationSample {
  CellState state = CellState::kMeasured;
  bool edge = false;         ///< at a rounded edge
  double inside = 0.0;       ///< how far inside the offset design: its concave corners are no surface of it
  double raw = 0.0;          ///< deviation, mm
  double counted = 0.0;      ///< the same; 0 where a rounded edge may be off by so much
  double error = 0.0;        ///< of grid and facets; at a rounded edge what that may be off
  double distance = 0.0;     ///< signed, to the other surface
  uint32_t facet = kUnseen;  ///< of the other surface
  static constexpr uint32_t kUnseen = 0xffffffffU;  ///< it faces away: nothing was looked for
  Vec3 foot = Vec3::Zero();
};

/// Deviation of the wanted sign that counts at a sample; 0 where none does.
double counted_of(const DeviationSample& sample, bool gouge);

/// What is common to both sides and made once.
struct ComparisonScene {
  explicit ComparisonScene(const ComparisonInput& comparison);
  const ComparisonInput& input;
  std::vector<double> stock_errors, design_errors;            ///< per facet, mm; empty: none
  std::vector<double> stock_near_errors, design_near_errors;  ///< TargetMesh::near_errors
  TargetMesh stock, design;
  /// The border of open patches as facets without area; null when there is none.
  TriMesh border_mesh;
  std::unique_ptr<mesh::MeshDistance> border;
  /// All normals of open patches lie within this angle of the axis; pi when they point all round.
  Vec3 normal_axis = Vec3::UnitZ();
  double normal_spread_rad = kPi;

  /// Whether a facet of the stock looks away from all of the patches, wherever its nearest point on them is.
  bool faces_away(const Vec3& normal) const;
};

class DeviationSide {
 public:
  DeviationSide(const ComparisonScene& scene, bool on_design);

  const mesh::SignedDistance& own() const { return on_design_ ? *in_.design : *in_.stock; }
  const mesh::SignedDistance& other() const { return on_design_ ? *in_.stock : *in_.design; }
  bool on_design() const { return on_design_; }
  double pitch() const { return in_.pitch; }
  const TargetMesh& opposite() const { return on_design_ ? scene_.stock : scene_.design; }
  bool other_is_open() const { return in_.open_design && !on_design_; }
  /// How far from the other surface a place of the own one should be, mm.
  double offset_mm() const { return on_design_ ? 0.0 : in_.allowance; }
  /// By which what an own facet stands for may stray from it, mm.
  double own_error(uint32_t triangle) const {
    return (on_design_ ? scene_.design : scene_.stock).error(triangle);
  }

  /// At a point of own triangle `triangle`; `near`: a sample that was taken nearby, which shortens the
  /// search.
  DeviationSample look(uint32_t triangle, const Vec3& point, const DeviationSample* near) const;
  /// To where the triangle is measured: the design is moved by the allowance.
  Vec3 shift(uint32_t triangle) const {
    return on_design_ ? Vec3(in_.allowance * in_.design->face_normal(triangle)) : Vec3(Vec3::Zero());
  }

 private:
  DeviationSample look_from_stock(uint32_t triangle, const Vec3& point, double within) const;
  DeviationSample look_from_design(uint32_t triangle, const Vec3& target, double within) const;
  void discount(DeviationSample& sample) const;
  double distance_to_faces(const Vec3& point, double facets_mm) const;
  double distance_from_faces(const Vec3& point, double facets_mm) const;
  bool stock_edge(uint32_t triangle) const;
  bool near_border(const Vec3& point) const;

  const ComparisonScene& scene_;
  const ComparisonInput& in_;
  bool on_design_;
};

/// The leaves of a side and what was measured at their centroids.
struct SampledSide {
  SampledSide(const ComparisonScene& scene, bool on_design);
  /// Halves and samples until every cell is as small as the pitch.
  void sample();
  /// Greatest deviation of the wanted sign that counts in a cell; 0 where none does.
  double worst(size_t cell, bool gouge) const;
  Vec3 worst_place(size_t cell, bool gouge) const;

  DeviationSide side;
  SurfaceCells cells;
  std::vector<DeviationSample> samples;  ///< per cell
  /// Worse places inside cells that the proof came across: excess, then gouge.
  struct Finding {
    double value;
    Vec3 place;
  };
  std::array<std::map<uint32_t, Finding>, 2> findings;
};

/// Finds the extremes of both sides and proves bounds for them.
void prove_extremes(std::array<SampledSide*, 2> sides, const ComparisonInput& input, PartComparison& result);

/// Regions with areas; volumes are added by measure_volumes.
struct RegionMap {
  std::vector<DeviationRegion> regions;            ///< worst first, all of them
  std::array<std::vector<uint32_t>, 2> region_of;  ///< per cell of stock and design; kNoDeviationRegion
};
inline constexpr uint32_t kNoDeviationRegion = 0xffffffffU;
RegionMap connect_regions(const std::array<SampledSide*, 2>& sides, const ComparisonInput& input);

/// Volumes of the listed regions and of the whole.
void measure_volumes(const std::array<SampledSide*, 2>& sides, const RegionMap& map,
                     const ComparisonInput& input, PartComparison& result);

}  // namespace swarf::measure
