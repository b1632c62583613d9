#include "collision/stock_body.h"

#include <algorithm>
#include <array>

#include "base/check.h"
#include "collision/overlap_bound.h"

namespace swarf::collision {
namespace {

constexpr double kStockTouch = 1e-4;  // mm, as ContactQuery::touch

/// Twelve outward triangles.
TriMesh mesh_of_block(const Box& box) {
  TriMesh mesh;
  for (unsigned i = 0; i < 8; ++i) {
    const Vec3 p((i & 1U) != 0 ? box.upper.x() : box.lower.x(), (i & 2U) != 0 ? box.upper.y() : box.lower.y(),
                 (i & 4U) != 0 ? box.upper.z() : box.lower.z());
    mesh.positions.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

constexpr double kReach = 0.8661;  // voxels: sqrt(3) / 2, to the nearest grid point

/// Triangles of one place each.
TriMesh mesh_of_points(const std::vector<Vec3>& points) {
  TriMesh mesh;
  for (const Vec3& p : points) {
    const auto at = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    mesh.triangles.push_back({at, at, at});
  }
  return mesh;
}

bool is_clear(const Encounter& pair, const AxisSegment& segment, const Approach& found) {
  return found.lower > kStockTouch && !one_holds_other(pair, segment.at(0.5));
}

ApproachQuery within(double limit) {
  ApproachQuery query;
  query.limit = std::max(limit, 2.0 * kStockTouch);
  query.tolerance = 0.5 * kStockTouch;
  return query;
}

}  // namespace

StockBody::StockBody(const machine::MachineScene& scene, const Box& raw_W)
    : StockBody(scene, mesh_of_block(raw_W)) {}

StockBody::StockBody(const machine::MachineScene& scene, const TriMesh& raw_W)
    : scene_(&scene), raw_(work_body(scene, "stock", BodyKind::kStock, raw_W)) {
  SWARF_CHECK(raw_.closed, "the raw stock is a closed mesh");
}

void StockBody::refresh(const stock::Stock& stock) {
  as_cut_ = beside_ = {};  // so that only one of each is held
  as_cut_ = work_body(*scene_, "stock", BodyKind::kStock, stock.mesh());
  voxel_mm_ = stock.voxel_mm();
  beside_ = work_body(*scene_, "stock", BodyKind::kStock,
                      mesh_of_points(stock.air_points(kReach * voxel_mm_ + kStockTouch)));
}

StockAnswer StockBody::over(const Body& body, const AxisSegment& segment) const {
  const Encounter pair = encounter(*scene_, body, raw_);
  const Approach found = closest_approach(pair, segment, within(0.0));
  if (!is_clear(pair, segment, found)) return suspect(body, segment);
  StockAnswer answer;
  answer.lower = found.lower;
  answer.upper = found.upper;
  return answer;
}

size_t StockBody::free_ways(const Body& body, const Body& material, std::span<const AxisValues> places,
                            double more_mm) const {
  std::vector<PathPose> poses(places.size());
  for (size_t i = 0; i < places.size(); ++i) poses[i].q = places[i];
  PathCheckOptions options;
  options.tolerance_mm = std::max(kStockTouch, 0.005 * voxel_mm_);
  options.touch_mm = kReach * voxel_mm_ + kStockTouch + options.tolerance_mm + more_mm;
  const Encounter pair = encounter(*scene_, body, material);
  StretchWalk walk = walk_stretch(pair, poses, options, {options.touch_mm, {}});
  // Points hold nothing, and what they lie in is met by the mesh.
  if (&material != &beside_) look_inside(pair, poses, std::nullopt, walk.ways);
  const auto met =
      std::find_if(walk.ways.begin(), walk.ways.end(), [](Way way) { return way != Way::kFree; });
  return static_cast<size_t>(met - walk.ways.begin());
}

size_t StockBody::clear_ways(const Body& body, std::span<const AxisValues> places, double more_mm) const {
  const size_t ways = free_ways(body, as_cut(), places, more_mm);
  if (ways == 0 || beside_.nodes.empty()) return ways;
  return free_ways(body, beside_, places.first(ways + 1), more_mm);
}

std::optional<StockTouch> StockBody::first_touch(const Body& body, std::span<const AxisValues> places) const {
  std::vector<PathPose> poses(places.size());
  for (size_t i = 0; i < places.size(); ++i) poses[i].q = places[i];
  PathCheckOptions options;
  options.touch_mm = options.tolerance_mm = kStockTouch;
  const Encounter pair = encounter(*scene_, body, as_cut());
  const StretchWalk walk = walk_stretch(pair, poses, options, {2.0 * kStockTouch, {}});
  const auto met =
      std::find_if(walk.ways.begin(), walk.ways.end(), [](Way way) { return way != Way::kFree; });
  if (met == walk.ways.end()) return {};
  StockTouch touch;
  touch.way = static_cast<size_t>(met - walk.ways.begin());
  AxisSegment segment;
  segment.q0 = places[touch.way];
  segment.q1 = places[touch.way + 1];
  touch.at = first_contact(pair, segment);
  return touch.at.touches ? std::optional(touch) : std::nullopt;
}

StockAnswer StockBody::suspect(const Body& body, const AxisSegment& segment) const {
  const Encounter pair = encounter(*scene_, body, as_cut());
  const Approach found = closest_approach(pair, segment, within(voxel_mm_));
  StockAnswer answer;
  answer.voxel_mm = voxel_mm_;
  answer.lower = found.lower;
  answer.upper = found.upper;
  answer.t = found.t;
  answer.point_M = found.point_a;
  answer.outcome = found.within ? StockOutcome::kOpen : StockOutcome::kClear;
  if (is_clear(pair, segment, found)) return answer;
  const BodyDepth in_body(body), in_stock(as_cut());
  std::array<PathPose, 2> ends;
  ends[0].q = segment.q0;
  ends[1].q = segment.q1;
  const DepthRange depth = depth_over(pair, in_body, in_stock, ends, 0, 1, kStandingPieces);
  answer.depth_mm = depth.seen_mm;
  if (depth.seen_mm > 0.0) {
    answer.t = depth.at;
    answer.point_M = depth.place_M;
  }
  answer.outcome = answer.depth_mm > voxel_mm_ ? StockOutcome::kContact : StockOutcome::kOpen;
  return answer;
}

}  // namespace swarf::collision
