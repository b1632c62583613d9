// Axis values at which two bodies are known to be apart. Internal to this folder.
//
//   cycles of a stretch --> least box of axis values around them --> inside the box that is known? nothing to
//   ask. Else one search tries a wider box around both, which later stretches will lie in; then the new one
//   widened; then the new one itself. Where all of these fail, the next stretches are not tried.
//
// A box is cleared by a search over its middle from which the axes stray as far as its faces
// (closest_approach.h), so that no motion inside it needs to be looked at.
#pragma once

#include "collision/pair_walk.h"

namespace swarf::collision {

struct AxisBox {
  AxisValues low = AxisValues::Zero(), high = AxisValues::Zero();
};
AxisBox box_of(PathStretch poses);

class FreeRange {
 public:
  /// Whether the bodies are farther than `least` mm apart, neither inside the other, at all axis values of
  /// the box. False says nothing. `least` must not grow from call to call; `tolerance`: of the search, mm.
  bool covers(const Encounter& pair, const AxisBox& box, double least, double tolerance);

 private:
  bool try_box(const Encounter& pair, const AxisBox& box, double least, double tolerance);
  bool find(const Encounter& pair, const AxisBox& box, double least, double tolerance);

  AxisBox free_;
  bool known_ = false;
  int pause_ = 0, next_pause_ = 1;  ///< stretches
};

}  // namespace swarf::collision
