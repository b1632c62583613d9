// The area to be machined by one operation, in pass parameters: t along the passes, w across, both 0..1.
#pragma once

#include "surface/curvature.h"
#include "toolpath/contact_end.h"
#include "toolpath/scallop_interval.h"
#include "toolpath/surface_curve.h"

namespace swarf::toolpath {

/// Uniform abscissae on which passes are computed.
struct Grid {
  double first = 0.0, step = 1.0 / 256.0;
  int intervals = 256;
  double t(int j) const { return first + j * step; }
  double last() const { return first + intervals * step; }
  int size() const { return intervals + 1; }
};

struct Area {
  surface::SurfacePtr surface;
  bool along_u = true;
  double start_w = 0.0, end_w = 1.0;  ///< boundary of the first pass and the opposite one
  double scallop_mm = 0.01;
  ContactEnd end;  ///< of the cutter
  Lean lean;
  RimSides rim_sides = RimSides::kBalanced;  ///< of the strip at hand
  Grid grid;                                 ///< covers [0,1] and a margin for the overrun at both ends
  bool zigzag = false;                       ///< every other pass is reversed
  bool continues_across = true;              ///< the surface may be used beyond the boundary end_w
  bool continues_along = true;               ///< the surface may be used beyond t = 0 and t = 1

  /// Attitude of the axis does not matter, nor does the flat bottom: there is none.
  bool ball() const { return end.ball(); }
  /// How far to its side a pass on a flat surface clears everything: a ball leaves a ridge at any distance.
  double clean_mm() const { return lean.on_normal() && !ball() ? end.flat_mm : end.radius(); }

  PassSurface pass_surface() const { return {*surface, along_u}; }
  double forward() const { return end_w - start_w; }  ///< +1 or -1
  /// True when w lies beyond the last boundary or on it.
  bool beyond_end(double w) const { return (w - end_w) * forward() >= 0.0; }
};

/// The area as seen by the strip between pass k (0-based) and the next one.
Area strip_behind(Area area, size_t k);

/// Which radius of curvature the interval is taken from.
enum class IntervalRule {
  kPaper,  ///< R = 1/kappa across the feed (Lin & Koren)
  kExact,  ///< R = kappa_t/K_G
};

struct Interval {
  double chord_mm = 0.0;   ///< leaves the wanted scallop; the cutter's width where the surface is flat
  double reach_mm = 0.0;   ///< longest chord at which the cutter reaches the cusp
  double curvature = 0.0;  ///< 1/mm, that the chord was taken from; on the normal only
  bool flat = false;       ///< no scallop worth the name within the cutter's width
  double usable() const { return std::min(chord_mm, reach_mm); }
};

/// Interval for the area's scallop, tool and lean at one point, for a feed given in the shape's tangent
/// frame.
Interval interval_at(const Area& area, const surface::Shape& shape, const Vec2& unit_feed, IntervalRule rule);

/// Shape and unit feed (in its tangent frame) on the pass w at t.
struct PassFrame {
  surface::Shape shape;
  Vec2 unit_feed;
};
PassFrame pass_frame(const PassSurface& surface, const CubicSpline& w, double t);

/// The least usable interval along a pass, over 0 <= t <= 1, and where it is.
struct MinimumInterval {
  double chord_mm = 0.0, t = 0.0;
};
MinimumInterval minimum_interval(const Area& area, const CubicSpline& w, IntervalRule rule);

/// What lies between two adjacent passes over [t_low, t_high] (a part of 0..1), as far as the middle of the
/// strip lies within the part.
struct Strip {
  double chord_min_mm = 0.0, chord_max_mm = 0.0;  ///< from the next pass to its foot on the previous one
  double scallop_max_mm = 0.0;  ///< Eq. 1 with R = kappa_t/K_G, or leaned_scallop, at mid strip
};
Strip measure_strip(const Area& area, const CubicSpline& previous, const CubicSpline& next, double t_low,
                    double t_high);

/// Lays the grid of an area and finds out whether the surface continues beyond its edges: there |Su x Sv|
/// must stay away from zero and the tool must not gouge. The margin asked for is the overrun plus one
/// interval.
void extend_beyond_edges(Area& area, double overrun_mm);

/// The tool cannot stand here: true where the lean does not suffice for the concave curvature k, which lets
/// the corner in up to corner k <= 1 and the flat bottom up to flat k <= sin(lean) (1 - corner k): the tool's
/// curvature across the lean is 1/(corner + flat/sin(lean)) (theory 1.2).
bool gouges(const surface::Shape& shape, const Lean& lean, const ContactEnd& end);

}  // namespace swarf::toolpath
