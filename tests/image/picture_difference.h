// Two pictures beside each other.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "render/image_io.h"

namespace swarf::test {

inline constexpr int kTileSide = 16;  ///< pixels

/// The tile in which two pictures of one size differ most.
struct TileDifference {
  double mean = 0.0;  ///< of |difference| over its red, green and blue, of 255
  int x = 0, y = 0;   ///< its first pixel
};

inline double tile_mean(const render::Image& a, const render::Image& b, int x0, int y0) {
  const int x1 = std::min(x0 + kTileSide, a.width), y1 = std::min(y0 + kTileSide, a.height);
  double sum = 0.0;
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      const auto at = 4 * (static_cast<size_t>(y) * static_cast<size_t>(a.width) + static_cast<size_t>(x));
      for (size_t c = 0; c < 3; ++c) sum += std::abs(int{a.rgba[at + c]} - int{b.rgba[at + c]});
    }
  }
  return sum / (3.0 * (x1 - x0) * (y1 - y0));
}

/// The mean over a whole picture lets one pass that lacks its part: most of it is ground. So the worst tile
/// counts, and its opacity does not.
inline TileDifference largest_difference(const render::Image& a, const render::Image& b) {
  TileDifference worst;
  for (int y = 0; y < a.height; y += kTileSide) {
    for (int x = 0; x < a.width; x += kTileSide) {
      const double mean = tile_mean(a, b, x, y);
      if (mean > worst.mean) worst = {mean, x, y};
    }
  }
  return worst;
}

}  // namespace swarf::test
