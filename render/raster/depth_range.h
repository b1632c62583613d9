// Where in the depth buffer a frame is drawn, so that buffers need not be cleared for each.
#pragma once

#include <cmath>

namespace swarf::render {

/// What a depth buffer holds of a frame, from its near plane to its far one. By default all of the buffer.
struct DepthRange {
  float nearest = 0.0F, farthest = 1.0F;
  float size() const { return farthest - nearest; }
};

/// So many frames are drawn between two clears: the last range is still far from the smallest numbers.
constexpr int kDepthRanges = 16;

/// The range of a frame, 0 .. kDepthRanges - 1: each before all that earlier frames left behind, which counts
/// as nothing then. Each is a sixteenth of the one before, and a power of two only moves a number's exponent:
/// a frame drawn in any of them is the same to the bit. Between them half of a range is left free, since a
/// rasteriser's depths may leave theirs by a rounding. Steps of depth are 8/7 of those of the whole buffer.
inline DepthRange depth_range(int frame) {
  const float farthest = std::ldexp(1.0F, -4 * frame);
  return {0.125F * farthest, farthest};
}

}  // namespace swarf::render
