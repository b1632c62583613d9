#include "measure/flank_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "base/angles.h"
#include "base/check.h"
#include "base/minima.h"
#include "base/parallel.h"
#include "measure/axis_patch.h"

namespace swarf::measure {
namespace {

using surface::Surface;

constexpr int kGridV = 32;
constexpr int kGridU = 256;      ///< a multiple of every block count of the table
constexpr int kBlocksMax = 32;   ///< of the table
constexpr int kAxisNodes = 256;  ///< of the continuous axis surface, before the nearest one is refined
constexpr double kFinestStep = 1e-8;
constexpr size_t kStartsMax = 64;

struct AxisLine {
  Vec3 near_tip, far;  ///< TC0, TC1
};

AxisLine axis_at(const Surface& surface, double radius, double u) {
  const surface::Derivatives d0 = surface.derivatives(u, 0.0), d1 = surface.derivatives(u, 1.0);
  return {d0.S + radius * outward_normal(surface, d0), d1.S + radius * outward_normal(surface, d1)};
}

/// The axis patches of n blocks.
class BlockAxes {
 public:
  BlockAxes(const Surface& surface, double radius, int blocks) {
    AxisLine from = axis_at(surface, radius, 0.0);
    for (int i = 1; i <= blocks; ++i) {
      const AxisLine to = axis_at(surface, radius, static_cast<double>(i) / blocks);
      patches_.emplace_back(from.near_tip, to.near_tip, from.far, to.far);
      from = to;
    }
  }
  /// `u` only tells where to look first.
  double distance(const Vec3& x, double u) const {
    const auto count = static_cast<int>(patches_.size());
    const int own = std::clamp(static_cast<int>(u * count), 0, count - 1);
    double least = patches_[static_cast<size_t>(own)].distance(x);
    for (int i = 0; i < count; ++i) {
      const AxisPatch& patch = patches_[static_cast<size_t>(i)];
      if (i != own && patch.distance_bound(x) < least) least = std::min(least, patch.distance(x));
    }
    return least;
  }

 private:
  std::vector<AxisPatch> patches_;
};

/// The axis surface through both guide curves.
class CurveAxes {
 public:
  CurveAxes(const Surface& surface, double radius) : surface_(surface), radius_(radius) {
    for (int i = 0; i <= kAxisNodes; ++i) {
      nodes_.push_back(axis_at(surface, radius, static_cast<double>(i) / kAxisNodes));
    }
    for (int i = 0; i < kAxisNodes; ++i) {
      const AxisLine &a = nodes_[static_cast<size_t>(i)], &b = nodes_[static_cast<size_t>(i) + 1];
      step_ = std::max({step_, (b.near_tip - a.near_tip).norm(), (b.far - a.far).norm()});
    }
  }
  double distance(const Vec3& x, double /*u*/) const {
    std::array<double, kAxisNodes + 1> at_node{};
    for (size_t i = 0; i < at_node.size(); ++i) at_node[i] = to(x, nodes_[i]);
    double least = *std::min_element(at_node.begin(), at_node.end());
    for (size_t i = 0; i < at_node.size(); ++i) {
      const double before = i > 0 ? at_node[i - 1] : at_node[i];
      const double after = i < kAxisNodes ? at_node[i + 1] : at_node[i];
      // Half a step from the node the axis is at most half a step nearer.
      if (at_node[i] > before || at_node[i] > after || at_node[i] - step_ > least) continue;
      const double low = std::max(0.0, (static_cast<double>(i) - 1.0) / kAxisNodes);
      const double high = std::min(1.0, (static_cast<double>(i) + 1.0) / kAxisNodes);
      const auto at = [&](double t) { return to(x, axis_at(surface_, radius_, t)); };
      least = std::min(least, least_between(at, low, high).value);
    }
    return least;
  }

 private:
  static double to(const Vec3& x, const AxisLine& line) {
    return segment_distance(x, line.near_tip, line.far);
  }
  const Surface& surface_;
  double radius_, step_ = 0.0;
  std::vector<AxisLine> nodes_;
};

/// The error at one place, for the search.
using ErrorAt = std::function<double(double u, double v)>;

/// Steps to the least of the eight neighbours, halving the step where none lies deeper.
FlankDepth descend(FlankDepth from, const ErrorAt& error_at) {
  for (double step = 1.0; step * 1.0 / kGridV > kFinestStep;) {
    FlankDepth best = from;
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        const double u = std::clamp(from.u + i * step / kGridU, 0.0, 1.0);
        const double v = std::clamp(from.v + j * step / kGridV, 0.0, 1.0);
        if (u == from.u && v == from.v) continue;
        const double error = error_at(u, v);
        if (error < best.error_mm) best = {error, u, v};
      }
    }
    if (best.error_mm < from.error_mm) {
      from = best;
    } else {
      step *= 0.5;
    }
  }
  return from;
}

/// Points of the grid that none of their neighbours undercuts, deepest first, at most kStartsMax.
std::vector<FlankDepth> starts(const std::vector<double>& grid, int columns, int rows) {
  const auto value = [&](int i, int j) { return grid[static_cast<size_t>(i * (rows + 1) + j)]; };
  std::vector<FlankDepth> found;
  for (int i = 0; i <= columns; ++i) {
    for (int j = 0; j <= rows; ++j) {
      bool least = true;
      for (int k = std::max(0, i - 1); k <= std::min(columns, i + 1); ++k) {
        for (int l = std::max(0, j - 1); l <= std::min(rows, j + 1); ++l) {
          least = least && value(i, j) <= value(k, l);
        }
      }
      if (least) {
        found.push_back({value(i, j), static_cast<double>(i) / columns, static_cast<double>(j) / rows});
      }
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const FlankDepth& a, const FlankDepth& b) { return a.error_mm < b.error_mm; });
  if (found.size() > kStartsMax) found.resize(kStartsMax);
  return found;
}

FlankDepth deepest(const ErrorAt& error_at) {
  std::vector<double> grid(static_cast<size_t>((kGridU + 1) * (kGridV + 1)));
  parallel_chunks(grid.size(), kGridV + 1, [&](size_t begin, size_t end) {
    const double u = static_cast<double>(begin / (kGridV + 1)) / kGridU;
    for (size_t i = begin; i < end; ++i) grid[i] = error_at(u, static_cast<double>(i - begin) / kGridV);
  });
  std::vector<FlankDepth> found = starts(grid, kGridU, kGridV);
  parallel_chunks(found.size(), 1, [&](size_t i, size_t) { found[i] = descend(found[i], error_at); });
  return *std::min_element(found.begin(), found.end(),
                           [](const FlankDepth& a, const FlankDepth& b) { return a.error_mm < b.error_mm; });
}

template <typename Axes>
FlankDepth envelope_error(const Surface& surface, double radius, const Axes& axes) {
  return deepest([&](double u, double v) { return axes.distance(surface.point(u, v), u) - radius; });
}

}  // namespace

bool is_ruled(const Surface& surface) {
  constexpr int kNodes = 16;
  constexpr double kStraight = 1e-9;
  for (int i = 0; i <= kNodes; ++i) {
    for (int j = 0; j <= kNodes; ++j) {
      const surface::Derivatives d =
          surface.derivatives(static_cast<double>(i) / kNodes, static_cast<double>(j) / kNodes);
      if (d.Svv.norm() > kStraight * d.Sv.norm()) return false;
    }
  }
  return true;
}

double ruling_twist(const Surface& surface, double u) {
  const Vec3 N0 = outward_normal(surface, surface.derivatives(u, 0.0));
  const Vec3 N1 = outward_normal(surface, surface.derivatives(u, 1.0));
  return angle_between(N0, N1);
}

double standing_error(const Surface& surface, double radius_mm, double u) {
  const AxisLine axis = axis_at(surface, radius_mm, u);
  return segment_distance(surface.point(u, 0.0), surface.point(u, 1.0), axis.near_tip, axis.far) - radius_mm;
}

FlankDepth block_envelope_error(const Surface& surface, double radius_mm, int blocks) {
  SWARF_CHECK(blocks >= 1 && kGridU % blocks == 0, "blocks that end on the lines of the search grid");
  return envelope_error(surface, radius_mm, BlockAxes(surface, radius_mm, blocks));
}

FlankDepth continuous_envelope_error(const Surface& surface, double radius_mm) {
  return envelope_error(surface, radius_mm, CurveAxes(surface, radius_mm));
}

FlankError flank_error(const Surface& surface, double radius_mm) {
  SWARF_CHECK(is_ruled(surface) && radius_mm > 0.0, "flank error of a surface linear in v and a real cutter");
  FlankError result;
  result.cutter_radius_mm = radius_mm;
  const Minimum twist =
      greatest_sampled([&](double u) { return ruling_twist(surface, u); }, 0.0, 1.0, kGridU);
  result.psi_max_rad = twist.value;
  result.psi_max_u = twist.at;
  result.twist_bound_mm = radius_mm * (1.0 - std::cos(0.5 * result.psi_max_rad));
  const Minimum standing =
      least_sampled([&](double u) { return standing_error(surface, radius_mm, u); }, 0.0, 1.0, kGridU);
  result.standing_error_mm = standing.value;
  result.standing_u = standing.at;
  result.continuous = continuous_envelope_error(surface, radius_mm);
  for (int blocks = 1; blocks <= kBlocksMax; blocks *= 2) {
    result.rows.push_back({blocks, block_envelope_error(surface, radius_mm, blocks)});
  }
  return result;
}

}  // namespace swarf::measure
