// What is wrong with a mesh as a part that tools are set down on, before anything moves.
//
// A border is an edge with a facet on one side only: the rim of a gap, or where a sheet ends. Across a gap g
// wide, with rims level to each other, the axis is never farther than g/2 from a rim, so the tip sinks by
// w(g/2) at most, and a gap wider than the cutter lets it fall through. On rims that are not level it may
// sink deeper; what it does there is told by on_border while it moves: a tool that goes down into a gap, or
// off the end of a sheet, comes to rest on a border on its way.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "mesh/tri_mesh.h"
#include "position/rest.h"
#include "position/tool_profile.h"

namespace swarf::position {

/// An edge with a facet on one side only.
struct BorderEdge {
  Vec3 from, to;  ///< mm
  Vec3 outwards;  ///< unit: in the facet's plane, square to the edge, away from the facet; zero without area
  uint32_t side;  ///< 3 triangle + the place of the corner at which it starts
};

/// The borders of a mesh; vertices at equal positions are one. Facets that collapse to a line do not count.
class Borders {
 public:
  explicit Borders(const TriMesh& mesh);

  const std::vector<BorderEdge>& edges() const { return edges_; }  ///< in the order of their sides
  bool closed() const { return edges_.empty(); }
  /// Whether the tool rests on a border: of a rest that MeshTarget gave for the same mesh.
  bool on_border(const Rest& rest) const;

 private:
  std::vector<BorderEdge> edges_;
  std::vector<uint8_t> side_, corner_;  ///< by 3 triangle + place
};

/// Across a gap: from the middle of a border edge to the nearest other one that it faces, within 60 degrees
/// of outwards. Measured at the middles: a gap that widens along one edge is wider by at most the edge's
/// length.
struct Gap {
  double width_mm = 0.0;
  Vec3 at = Vec3::Zero();  ///< the middle of the edge
};
struct GapReport {
  size_t edges = 0;  ///< border edges that face others within `reach_mm`
  Gap widest;
  size_t lone_edges = 0;  ///< those that do not: the end of a sheet, or a gap that is wider
  Vec3 first_lone = Vec3::Zero();
};
GapReport gaps(const Borders& borders, double reach_mm);

/// How far the tip sinks, at most, below the level rims of a gap so wide, mm; infinite when it falls through.
double sinks_into(const ToolProfile& profile, double width_mm);

/// Holds a mesh of file `path` against what the position calculator needs:
///   mesh-empty, mesh-not-finite, mesh-inverted   as mesh::check_design_mesh
///   mesh-zero-area, mesh-non-manifold, mesh-turned-facets   warnings: facets stop a tool from both sides
///   part-gap-wide   a gap into which the tool may sink by more than `sink_mm`: the widest, and where
///   part-gap        a warning: gaps into which it may sink by no more
///   part-ends       a note: border edges that face none within the cutter's diameter: beside them a tool
///   falls,
///                   be it off the sheet's end or into a gap that is wider than the cutter
void check_part(const TriMesh& mesh, const std::string& path, const ToolProfile& profile, double sink_mm,
                Diagnostics& diagnostics);

}  // namespace swarf::position
