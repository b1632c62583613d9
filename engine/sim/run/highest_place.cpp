#include "sim/run/highest_place.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "measure/sweep_index.h"
#include "mesh/mesh_lines.h"
#include "sim/run/ray_cutters.h"
#include "stock/rays/ray_height.h"

namespace swarf::sim {
namespace {

/// A place that is nearer than this to where the material ends lies there; mm.
constexpr double kOnPart = 1e-6;

/// On the three great circles about a frame of `normal`: what fills a slot, or a groove, is left along it.
std::vector<Vec3> ways_around(const Vec3& normal) {
  constexpr int kOfCircle = 64;
  int least = 0;
  normal.cwiseAbs().minCoeff(&least);
  const Vec3 e1 = normal.cross(Vec3::Unit(least)).normalized(), e2 = normal.cross(e1);
  std::vector<Vec3> ways;
  for (const auto& [a, b] : {std::pair(normal, e1), std::pair(normal, e2), std::pair(e1, e2)}) {
    for (int k = 0; k < kOfCircle; ++k) {
      const double turn = 2.0 * std::numbers::pi * k / kOfCircle;
      ways.push_back(std::cos(turn) * a + std::sin(turn) * b);
    }
  }
  return ways;
}

/// Of the measuring ray that stands nearest to a place.
Vec3 normal_below(const MeasuredPath& measured, const Vec3& place) {
  Vec3 normal = Vec3::UnitZ();
  double least = std::numeric_limits<double>::infinity();
  for (const stock::SurfaceDexels& dexels : measured.dexels) {
    for (size_t n = 0; n < dexels.points().size(); ++n) {
      const double distance = (place - dexels.points()[n]).squaredNorm();
      if (distance >= least) continue;
      least = distance;
      normal = dexels.normals()[n];
    }
  }
  return normal;
}

/// The facets of a design, or of the grid of its rays.
TriMesh facets_of(const stock::RayField& field) {
  if (field.design != nullptr) return field.design->mesh;
  TriMesh mesh;
  for (const Vec3& p : field.points) {
    const Eigen::Vector3f at = p.cast<float>();
    mesh.positions.push_back({at.x(), at.y(), at.z()});
  }
  mesh.triangles = field.triangles;
  return mesh;
}

/// How far each line from a place goes until it meets the design, mm.
std::vector<double> ways_to_design(const MeasuredPath& measured, const Vec3& place,
                                   const std::vector<Vec3>& ways) {
  std::vector<double> lengths(ways.size(), std::numeric_limits<double>::infinity());
  std::vector<double> hits;
  for (const stock::SurfaceDexels& dexels : measured.dexels) {
    const mesh::MeshLines lines(facets_of(dexels.field()));
    for (size_t n = 0; n < ways.size(); ++n) {
      hits.clear();
      lines.add_hits(place, ways[n], hits);
      for (const double hit : hits)
        if (hit > 0.0) lengths[n] = std::min(lengths[n], hit);
    }
  }
  return lengths;
}

/// A place of the part's surface on a line.
struct End {
  double mm = std::numeric_limits<double>::infinity();  ///< along it
  Vec3 way = Vec3::Zero();
};

/// Where the raw material around a place ends on a line from it, mm.
double raw_end(const stock::RawShape& raw, const Vec3& place, const Vec3& way) {
  for (const stock::RawInterval& material : raw.along(place, way))
    if (material.low <= kOnPart && material.high > 0.0) return material.high;
  return 0.0;
}

/// The first place of a line from within the material that the sweep reaches, mm; infinite: none.
double first_cut(const Vec3& place, const Vec3& way, const stock::SweepMap& map,
                 const stock::CutterSolid& cutter) {
  double end = std::numeric_limits<double>::infinity();
  for (const cutter::ConvexPiece& piece : cutter.pieces) {
    const stock::RayInterval cut = stock::ray_interval(place, way, map, piece);
    if (cut.hit() && cut.high > kOnPart) end = std::min(end, std::max(0.0, cut.low));
  }
  return end;
}

bool comes_near(const stock::Sweep& sweep, const stock::CutterSolid& cutter, const Vec3& place,
                double reach_mm) {
  const Box box = measure::sweep_box(sweep, cutter);
  return ((box.lower - place).array() <= reach_mm).all() && ((place - box.upper).array() <= reach_mm).all();
}

/// Where the material that is around a place ends, on the line on which that is nearest; infinitely far where
/// it goes on over all of `lengths`, mm.
End nearest_end(const Job& job, const MeasuredPath& measured, const Vec3& place,
                const std::vector<Vec3>& ways, const std::vector<double>& lengths) {
  const stock::RawShape& raw = job.scene.stock.body_W();
  std::vector<double> ends;
  for (const Vec3& way : ways) ends.push_back(raw_end(raw, place, way));
  const double reach = *std::max_element(lengths.begin(), lengths.end());
  const RayCutters cutters = ray_cutters(job, measured);
  for (const stock::Sweep& sweep : measured.rays.sweeps) {
    const stock::CutterSolid& cutter = cutters.solids[static_cast<size_t>(cutters.solid_of[sweep.block])];
    if (!comes_near(sweep, cutter, place, reach)) continue;
    const stock::SweepMap map = stock::sweep_map(sweep);
    for (size_t n = 0; n < ways.size(); ++n)
      ends[n] = std::min(ends[n], first_cut(place, ways[n], map, cutter));
  }
  End nearest;
  for (size_t n = 0; n < ways.size(); ++n)
    if (ends[n] < lengths[n] && ends[n] < nearest.mm) nearest = {ends[n], ways[n]};
  return nearest;
}

}  // namespace

void end_on_part(const Job& job, MeasuredPath& measured) {
  if (measured.dexels.empty() || !(measured.surface.excess_max_um > 0.0)) return;
  Vec3& top = measured.surface.excess_top;
  const std::vector<Vec3> ways = ways_around(normal_below(measured, top));
  std::vector<double> lengths(ways.size(), kOnPart);
  if (nearest_end(job, measured, top, ways, lengths).mm <= kOnPart) return;
  const std::vector<double> free = ways_to_design(measured, top, ways);
  const double farthest = job.scene.stock.body_W().box().size().norm();
  // Few sweeps come near the place, all of them to the far end of a line.
  for (double reach = measured.dexels.front().field().pitch_mm; reach < 2.0 * farthest; reach *= 2.0) {
    for (size_t n = 0; n < ways.size(); ++n) lengths[n] = std::min(free[n], reach);
    const End end = nearest_end(job, measured, top, ways, lengths);
    if (!(end.mm <= reach)) continue;
    top += end.mm * end.way;
    return;
  }
}

}  // namespace swarf::sim
