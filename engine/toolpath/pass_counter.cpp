#include "toolpath/pass_counter.h"

#include <cmath>

#include "toolpath/cl_path.h"

namespace swarf::toolpath {
namespace {

/// Direction in which the tip leaves (at_end false) or arrives; zero when it stands.
Vec3 tip_direction(const BlockMove& block, bool at_end) {
  if (!block.arc) return (block.to.tip_W - block.from.tip_W).normalized();
  const Vec3& tip = at_end ? block.to.tip_W : block.from.tip_W;
  return block.arc->normal_W.cross(tip - block.arc->centre_W).normalized();
}

}  // namespace

int PassCounter::next(const BlockMove& block) {
  if (is_rapid(block)) {
    open_ = false;
    return -1;
  }
  const Vec3 leaving = tip_direction(block, false);
  const bool moves = leaving.squaredNorm() > 0.0;
  const bool other_tool = block.tool != tool_;
  tool_ = block.tool;
  const bool corner =
      moves && arriving_.squaredNorm() > 0.0 && arriving_.dot(leaving) < std::cos(kPassCorner_rad);
  if (!open_ || other_tool || corner) ++pass_;
  open_ = true;
  if (moves) arriving_ = tip_direction(block, true);
  return pass_;
}

}  // namespace swarf::toolpath
