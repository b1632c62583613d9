// The tool-axis fan of Lin & Koren's Fig. 13: paths on the surface, tool axes standing on them.
#pragma once

#include <vector>

#include "render/draw_list.h"

namespace swarf::render {

/// Every array in path order; one entry per tool sample.
struct FanInput {
  std::vector<Vec3> points;         ///< contact points, mm
  std::vector<Vec3> axes;           ///< unit tool axes at the points, tip to spindle
  std::vector<size_t> pass_starts;  ///< index of the first point of each pass, ascending, first is 0
};

struct FanStyle {
  int passes = 14;              ///< at most so many passes are drawn, first and last among them
  int axes_per_pass = 13;       ///< axes at equal arc length, both ends among them
  double axis_length_mm = 0.0;  ///< 0: a fifth of the diagonal of the points' box
  double path_step_mm = 0.5;    ///< spacing of the drawn path points
  Rgb path_colour{0.02F, 0.10F, 0.35F};
  Rgb axis_colour{0.75F, 0.10F, 0.03F};
  float path_width_px = 2.0F;
  float axis_width_px = 1.5F;
};

/// Lines of the fan: each drawn pass as a polyline, then its axes as segments from the contact points.
/// Thinned by arc length, because one axis per control cycle would be a solid block of ink.
std::vector<DrawLine> axis_fan(const FanInput& input, const FanStyle& style = {});

}  // namespace swarf::render
