// Pixels of a still before they become colours, and what neighbours share.
#pragma once

#include <vector>

#include "render/ray/ray_scene.h"

namespace swarf::render {

/// Means over the samples of a pixel, linear. Its radiance is light + matt * ambient + dull * sheen, channel
/// by channel.
struct PixelLight {
  Vec3f light = Vec3f::Zero();    ///< that is seen as it is
  Vec3f matt = Vec3f::Zero();     ///< what matt surfaces give back of `ambient`
  Vec3f ambient = Vec3f::Zero();  ///< that reaches them from all around: noisy, and nearly the same nearby
  Vec3f sheen = Vec3f::Zero();    ///< what dull surfaces mirror, blurred by their roughness: as ambient
  float dull = 0.0F;              ///< share of the pixel that they cover
  bool knows_sheen = false;       ///< a sample of it was taken
  Vec3f normal = Vec3f::Zero(), position = Vec3f::Zero();  ///< of what is seen; zero: nothing
  float opacity = 1.0F;
};

/// Replaces the ambient light and the sheen of each pixel by the mean over those around it whose surface lies
/// in the same plane and turns the same way: a cross-bilateral filter (Eisemann and Durand 2004) guided by
/// places and normals, which carry no noise, in steps of growing width (a trous, Dammertz et al. 2010). A
/// pixel of several surfaces, which is like none of its neighbours, takes the mean of all beside it. Key
/// light, its shadows and reflections of all but dull surfaces stay as they are. `mm_per_px`: width of a
/// pixel at 1 mm from the eye. Parallel over rows, the same for any number of threads.
void share_ambient(std::vector<PixelLight>& pixels, int width, int height, const Vec3f& eye, float mm_per_px);

}  // namespace swarf::render
