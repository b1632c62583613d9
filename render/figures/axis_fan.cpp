#include "render/figures/axis_fan.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace swarf::render {
namespace {

struct Pass {
  size_t begin, end;  ///< half-open range of points
};

/// Indices of at most `wanted` out of `count` passes at one stride, the first and the last among them. A
/// stride that meets the last pass exactly is preferred: an uneven gap would look like a change of step-over.
std::vector<size_t> spread(size_t count, size_t wanted) {
  std::vector<size_t> chosen;
  if (count == 0) return chosen;
  const size_t least = wanted < 2 ? count : std::max<size_t>(1, (count - 1 + wanted - 2) / (wanted - 1));
  size_t stride = least;
  while (stride < 2 * least && (count - 1) % stride != 0) ++stride;
  if (stride == 2 * least) stride = least;
  for (size_t i = 0; i < count; i += stride) chosen.push_back(i);
  if (chosen.back() != count - 1 && chosen.size() < wanted) chosen.push_back(count - 1);
  return chosen;
}

std::vector<Pass> chosen_passes(const FanInput& input, int wanted) {
  std::vector<Pass> passes;
  for (size_t k = 0; k < input.pass_starts.size(); ++k) {
    const size_t end = k + 1 < input.pass_starts.size() ? input.pass_starts[k + 1] : input.points.size();
    SWARF_CHECK(input.pass_starts[k] <= end && end <= input.points.size(), "pass starts must ascend");
    if (end - input.pass_starts[k] >= 2) passes.push_back({input.pass_starts[k], end});
  }
  std::vector<Pass> chosen;
  for (const size_t k : spread(passes.size(), static_cast<size_t>(wanted))) chosen.push_back(passes[k]);
  return chosen;
}

/// Arc length from the start of the pass to each of its points.
std::vector<double> arc_lengths(const FanInput& input, const Pass& pass) {
  std::vector<double> length(pass.end - pass.begin, 0.0);
  for (size_t i = 1; i < length.size(); ++i) {
    length[i] = length[i - 1] + (input.points[pass.begin + i] - input.points[pass.begin + i - 1]).norm();
  }
  return length;
}

/// Indices within a pass of the points nearest to `count` equal steps of arc length; no index twice.
std::vector<size_t> equal_steps(const std::vector<double>& length, size_t count) {
  std::vector<size_t> chosen;
  for (size_t k = 0; k < count; ++k) {
    const double wanted = length.back() * static_cast<double>(k) / static_cast<double>(count - 1);
    auto after = std::lower_bound(length.begin(), length.end(), wanted);
    if (after == length.end()) --after;
    if (after != length.begin() && wanted - *(after - 1) < *after - wanted) --after;
    const auto index = static_cast<size_t>(after - length.begin());
    if (chosen.empty() || index > chosen.back()) chosen.push_back(index);
  }
  return chosen;
}

double default_axis_length(const FanInput& input) {
  Vec3 low = input.points.front(), high = low;
  for (const Vec3& p : input.points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return 0.2 * (high - low).norm();
}

}  // namespace

std::vector<DrawLine> axis_fan(const FanInput& input, const FanStyle& style) {
  SWARF_CHECK(input.points.size() == input.axes.size(), "one axis for each point");
  SWARF_CHECK(style.passes >= 1 && style.axes_per_pass >= 2 && style.path_step_mm > 0.0, "fan style");
  std::vector<DrawLine> lines;
  if (input.points.empty()) return lines;
  const double axis_length = style.axis_length_mm > 0.0 ? style.axis_length_mm : default_axis_length(input);
  for (const Pass& pass : chosen_passes(input, style.passes)) {
    const std::vector<double> length = arc_lengths(input, pass);
    const size_t path_points = 2 + static_cast<size_t>(length.back() / style.path_step_mm);
    DrawLine path{{}, style.path_colour, style.path_width_px, "paths"};
    for (const size_t i : equal_steps(length, path_points))
      path.points.push_back(input.points[pass.begin + i]);
    lines.push_back(std::move(path));
    for (const size_t i : equal_steps(length, static_cast<size_t>(style.axes_per_pass))) {
      const Vec3& foot = input.points[pass.begin + i];
      lines.push_back({{foot, foot + axis_length * input.axes[pass.begin + i]},
                       style.axis_colour,
                       style.axis_width_px,
                       "axes"});
    }
  }
  return lines;
}

}  // namespace swarf::render
