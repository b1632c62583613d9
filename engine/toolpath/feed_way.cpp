#include "toolpath/feed_way.h"

namespace swarf::toolpath {
namespace {

constexpr double kUpright = 1e-9;

void add(FeedWay& way, const ToolPose& pose) {
  way.box_W.lower = way.box_W.lower.cwiseMin(pose.tip_W);
  way.box_W.upper = way.box_W.upper.cwiseMax(pose.tip_W);
  way.upright = way.upright && pose.axis_W.z() > 1.0 - kUpright;
}

/// What lies between the ends of an arc or a helix.
void add_arc(FeedWay& way, const BlockMove& block) {
  constexpr int kSteps = 64;
  const Vec3& normal = block.arc->normal_W;
  const Vec3 spoke = block.from.tip_W - block.arc->centre_W;
  const Vec3 rise = normal * (block.to.tip_W - block.from.tip_W).dot(normal);
  const double angle = arc_angle(block);
  for (int i = 1; i < kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    const Vec3 turned = Eigen::AngleAxisd(share * angle, normal) * spoke;
    add(way, {block.arc->centre_W + turned + share * rise, block.from.axis_W});
  }
}

}  // namespace

FeedWay feed_way(const Elements& elements) {
  FeedWay way;
  for (size_t i = 0; i < elements.size(); ++i) {
    const BlockMove block = elements.block(i);
    if (is_rapid(block)) continue;
    ++way.feeds;
    add(way, block.from);
    add(way, block.to);
    if (block.arc) add_arc(way, block);
  }
  return way;
}

}  // namespace swarf::toolpath
