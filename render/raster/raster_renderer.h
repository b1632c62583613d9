// Fast pictures, for the frames of the movie and quick stills: OpenGL in software (OSMesa's llvmpipe) finds
// what is seen, kernels of our own shade it.
#pragma once

#include <memory>

#include "render/draw_list.h"

namespace swarf::render {

/// Draws lists of items into images of one size. Lights stand relative to the camera's bearing, as a
/// photographer's would; one shadow map; a floor under the lowest point of the scene.
///
/// Static meshes stay in GPU memory by their address (a mesh that changed at the same address is noticed by
/// samples of its positions); `dynamic` ones are sent anew in each call. What is seen is found at all samples
/// of a pixel, on a grid of one or two each way, and shaded once per surface in it. Meshes without normals
/// are shaded flat. Not thread-safe, but successive calls may come from different threads.
class RasterRenderer {
 public:
  /// `samples` per pixel for smooth edges: 1 or 4. Throws InputError when OSMesa is missing.
  RasterRenderer(int width, int height, int samples = 4);
  ~RasterRenderer();
  RasterRenderer(const RasterRenderer&) = delete;
  RasterRenderer& operator=(const RasterRenderer&) = delete;

  Image draw(const DrawList& list);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace swarf::render
