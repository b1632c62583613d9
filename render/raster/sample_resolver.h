// From what OSMesa found at each sample to the colours of pixels.
#pragma once

#include <vector>

#include "render/draw_list.h"
#include "render/raster/shade_kernel.h"

namespace swarf::render {

/// Some rows of a picture: `side` x `side` samples of each pixel on a grid, lowest row first, as OpenGL has
/// them.
struct SampleBand {
  int width = 0, rows = 0, side = 1;  ///< px; samples of a pixel each way, 1 or 2
  std::vector<uint32_t> words;        ///< two a sample
  std::vector<float> depths;
  float farthest = 1.0F;  ///< depth from which on nothing was drawn

  /// Room for `band_rows` rows, and for what kernels read beyond the end of one.
  void resize(int band_rows);
};

/// Paints the rows of the band into the image from row `top` on, in parallel. What one pixel's samples see of
/// one surface is shaded once, at the first of them and with their mean normal; samples are averaged as
/// stored.
void resolve(const SampleBand& band, const Lighting& lighting, int top, Image& image);

}  // namespace swarf::render
