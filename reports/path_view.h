// The program's way as points with what the control knows there: for viewers and the page.
#pragma once

#include <string>
#include <vector>

#include "render/gltf/gltf_writer.h"
#include "reports/machine_view.h"

namespace swarf::reports {

struct WayPoint {
  Vec3 tip_W = Vec3::Zero();
  double t_s = 0.0;
  double feed_mm_s = 0.0;  ///< reached on the way that ends here; 0: rapid
  int tool = 0;            ///< index into Scene::tools
  int line = 0;            ///< of the program
  bool rapid = false;
};

struct Way {
  std::vector<WayPoint> points;
  /// No tip of the program's elements is farther from the lines between the points, mm; none of the cycles of
  /// passes that are planned is.
  double error_mm = 0.0;
};

/// The whole program: of blocks their ends, arcs in chords; of other elements their cycles. Points that the
/// lines between others pass within kWayError are left out; of more than kWayPoints the error is doubled
/// until they fit.
Way program_way(const FinishedRun& run);

inline constexpr double kWayError = 0.005;  // mm
inline constexpr size_t kWayPoints = 60'000;

/// As a line with the attributes _TIME_S, _FEED_MM_MIN, _TOOL (index), _LINE, _RAPID (0 or 1), coloured by
/// tool, rapids grey.
render::GltfPath gltf_path(const Way& way);

/// sRGB of a tool by its index: the colours of a path, in glTF and page.
std::array<uint8_t, 4> tool_colour(size_t tool);

}  // namespace swarf::reports
