#include "reports/run_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "reports/driven_output.h"
#include "reports/fig6_table.h"
#include "reports/flank_output.h"

namespace swarf::reports {
namespace {

constexpr int kHistogramBins = 60;

using kinematics::AxisKind;

std::vector<std::array<double, 2>> scaled(const std::vector<Vec2>& points, double scale) {
  std::vector<std::array<double, 2>> out;
  out.reserve(points.size());
  for (const Vec2& point : points) out.push_back({point.x(), scale * point.y()});
  return out;
}

/// Where the feed falls in a job of this kind.
const char* feed_caption(const sim::Job& job) {
  const auto& axes = job.machine.model.axes;
  const bool turns = std::any_of(axes.begin(), axes.end(),
                                 [](const kinematics::Axis& axis) { return axis.kind == AxisKind::kRotary; });
  if (job.scene.driven)
    return turns ? "Falls where the surface, or an axis that would exceed its limits, asks for less."
                 : "Falls where the surface asks for less: at corners, and where it bends.";
  return turns ? "Falls where an axis would exceed its speed, above all near the pole of the rotary table."
               : "Falls at corners, and where an axis would exceed its limits.";
}

Plot feed_plot(const sim::Job& job, const motion::TimeEnvelope& envelope) {
  Plot plot;
  plot.title = "Feed of the contact point";
  plot.caption = feed_caption(job);
  plot.x_label = "time";
  plot.x_unit = "s";
  plot.y_label = "feed";
  plot.y_unit = "mm/s";
  plot.y_from_zero = true;
  plot.series.push_back({"in contact", scaled(envelope.feed(), 1.0)});
  return plot;
}

/// One plot for the axes of one kind: positions, or speeds.
Plot axis_plot(const sim::Job& job, const motion::TimeEnvelope& envelope, AxisKind kind, bool speed) {
  const bool rotary = kind == AxisKind::kRotary;
  Plot plot;
  plot.title = fmt::format("{} of the {} axes", speed ? "Speeds" : "Positions", rotary ? "rotary" : "linear");
  plot.x_label = "time";
  plot.x_unit = "s";
  plot.y_label = speed ? "speed" : "position";
  plot.y_unit = fmt::format("{}{}", rotary ? "deg" : "mm", speed ? "/s" : "");
  for (size_t a = 0; a < job.machine.model.axes.size(); ++a) {
    const kinematics::Axis& axis = job.machine.model.axes[a];
    if (axis.kind != kind) continue;
    const double scale = rotary ? deg_from_rad(1.0) : 1.0;
    plot.series.push_back({axis.name, scaled(speed ? envelope.speed(a) : envelope.position(a), scale)});
    if (speed && rotary) plot.limits.push_back({deg_from_rad(axis.speed_max), axis.name + " limit", false});
  }
  return plot;
}

Plot scallop_plot(const sim::Result& result) {
  Plot plot;
  plot.title = "Height of the ridges between passes";
  plot.caption = "Each ridge point is refined between the measuring rays.";
  plot.x_label = "height";
  plot.x_unit = "µm";
  plot.y_label = "ridge points";
  const auto& ridges = result.main.ridges;
  if (ridges.empty()) return plot;
  double low = ridges.front().height_um;
  double high = low;
  for (const measure::Ridge& ridge : ridges) {
    low = std::min(low, ridge.height_um);
    high = std::max(high, ridge.height_um);
  }
  const double width = std::max((high - low) / kHistogramBins, 1e-4);  // um; equal heights still make a bar
  std::vector<double> counts(kHistogramBins, 0.0);
  for (const measure::Ridge& ridge : ridges) {
    const auto bin =
        static_cast<size_t>(std::min<double>((ridge.height_um - low) / width, kHistogramBins - 1));
    counts[bin] += 1.0;
  }
  for (int i = 0; i < kHistogramBins; ++i) {
    plot.bars.push_back({low + i * width, low + (i + 1) * width, counts[static_cast<size_t>(i)]});
  }
  plot.limits.push_back({result.main.surface.scallop_theory_um, "theory", true});
  return plot;
}

Plot height_plot(const sim::Job& job, const sim::Result& result) {
  Plot plot;
  plot.title = "Deviation of the finished surface from the design";
  plot.x_label = "height over the design";
  plot.x_unit = "µm";
  plot.y_label = "measuring rays";
  const double high = 1.1 * job.scene.accept.scallop_band_um();
  for (const stock::SurfaceDexels& dexels : result.main.dexels) {
    for (const measure::HistogramBin& bin :
         measure::height_histogram(dexels, -0.1 * high, high, kHistogramBins)) {
      plot.bars.push_back({bin.low_um, bin.high_um, static_cast<double>(bin.count)});
    }
    break;  // one histogram: the program's first surface
  }
  return plot;
}

}  // namespace

std::vector<Plot> run_plots(const sim::Job& job, const sim::Result& result) {
  const motion::TimeEnvelope& envelope = result.main.envelope;
  const bool planned = !result.main.path.elements.hold_blocks();
  std::vector<Plot> plots{feed_plot(job, envelope), axis_plot(job, envelope, AxisKind::kLinear, false),
                          axis_plot(job, envelope, AxisKind::kRotary, false),
                          axis_plot(job, envelope, AxisKind::kLinear, true),
                          axis_plot(job, envelope, AxisKind::kRotary, true)};
  if (!result.main.ridges.empty() || planned) plots.push_back(scallop_plot(result));
  if (!result.main.dexels.empty()) plots.push_back(height_plot(job, result));
  if (result.flank_milling) {
    for (Plot& plot : flank_plots(result)) plots.push_back(std::move(plot));
  }
  if (result.driven) {
    for (Plot& plot : driven_plots(result)) plots.push_back(std::move(plot));
  } else if (planned) {
    plots.push_back(fig6_plot());
  }
  // A machine without rotary axes has no plots of them.
  std::erase_if(plots, [](const Plot& plot) { return plot.series.empty() && plot.bars.empty(); });
  return plots;
}

}  // namespace swarf::reports
