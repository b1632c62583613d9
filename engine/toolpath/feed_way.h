// Where a path of blocks goes in its feed moves.
#pragma once

#include <limits>

#include "base/frames.h"
#include "toolpath/elements.h"

namespace swarf::toolpath {

struct FeedWay {
  /// Of the tip, W, mm; turned inside out without a feed move. Arcs are looked at in 64 steps: a circle of
  /// radius r may leave the box by 0.0003 r.
  Box box_W{Vec3::Constant(std::numeric_limits<double>::infinity()),
            Vec3::Constant(-std::numeric_limits<double>::infinity())};
  bool upright = true;  ///< the tool stands along Z of W in all of them
  size_t feeds = 0;
};

/// Of a path that holds blocks.
FeedWay feed_way(const Elements& elements);

}  // namespace swarf::toolpath
