// Polylines as screen-space quads of a width in pixels.
#pragma once

#include <vector>

#include "render/draw_list.h"

namespace swarf::render {

struct LineVertex {
  float ndc[3];
  float colour[3];
};

/// Six vertices (two triangles) per visible segment, appended for all lines. `clip_from_world` is the
/// camera's matrix; `width`, `height` the picture's size in pixels. Segments are cut at the near plane and
/// drawn a little nearer than they are, so that a path on a surface stays visible.
std::vector<LineVertex> line_quads(const std::vector<DrawLine>& lines, const Eigen::Matrix4d& clip_from_world,
                                   int width, int height);

}  // namespace swarf::render
