#include "collision/stock_body.h"

#include <algorithm>

#include "base/check.h"

namespace swarf::collision {
namespace {

constexpr double kStockTouch = 1e-4;  // mm, as ContactQuery::touch
constexpr int kDepthInstants = 8;     // and one

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
  as_cut_ = work_body(*scene_, "stock", BodyKind::kStock, stock.mesh());
  voxel_mm_ = stock.voxel_mm();
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
  for (int i = 0; i <= kDepthInstants; ++i) {
    const double t = static_cast<double>(i) / kDepthInstants;
    const Depth depth = overlap_depth(pair, in_body, in_stock, segment.at(t));
    if (depth.depth_mm <= answer.depth_mm) continue;
    answer.depth_mm = depth.depth_mm;
    answer.t = t;
    answer.point_M = depth.place_M;
  }
  answer.outcome = answer.depth_mm > voxel_mm_ ? StockOutcome::kContact : StockOutcome::kOpen;
  return answer;
}

}  // namespace swarf::collision
