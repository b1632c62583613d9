// The outline of a cutting part: lines and arcs in the half plane (rho, z), from the tip to the end of the
// flutes.
#pragma once

#include <vector>

#include "cutter/cutter.h"

namespace swarf::cutter {

/// A line or an arc of at most half a turn, travelled upwards: the cutter lies to its left.
struct OutlineElement {
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();  ///< (rho, z), mm
  double radius = 0.0;                          ///< mm; 0: a line; above 0: bulges outwards; below 0: hollow
  Vec2 centre = Vec2::Zero();                   ///< of the arc

  bool is_line() const { return radius == 0.0; }
};

/// The arc between two points that are at most 2 |radius| apart.
OutlineElement arc_between(const Vec2& from, const Vec2& to, double radius);
/// Unit direction of travel at either end.
Vec2 start_tangent(const OutlineElement& element);
Vec2 end_tangent(const OutlineElement& element);
/// What an arc turns through, rad, in [0, pi]; 0 for a line.
double arc_angle(const OutlineElement& element);
/// To the right of the direction of travel: out of the cutter.
Vec2 outward(const Vec2& tangent);

/// Bottom line, corner circle and flank of APT's general cutter, with the corner circle tangent to both.
struct AptForm {
  double d = 0.0, r = 0.0;         ///< mm
  double alpha = 0.0, beta = 0.0;  ///< rad; alpha + beta < pi/2
  double h = 0.0;                  ///< mm

  Vec2 corner_centre() const;            ///< (e, f)
  Vec2 bottom_end() const;               ///< where the corner circle leaves the bottom line
  Vec2 flank_start() const;              ///< where it meets the flank
  Vec2 flank_end() const;                ///< at the height h
  double largest_corner_radius() const;  ///< the one whose circle touches the bottom line on the axis
};

/// The seven parameters that flat, ball, bull nose, taper, drill and apt stand for; nothing for other shapes.
std::optional<AptForm> apt_form(const Cutter& cutter);

/// The outline of a cutter without problems (validate). Elements below 1e-9 mm are left out.
std::vector<OutlineElement> outline(const Cutter& cutter);

/// Greatest rho of the outline, mm.
double greatest_radius(const std::vector<OutlineElement>& outline);

/// Makes `cutter` the free profile of these points: diameter and flute length follow from them. Points that
/// are no outline are taken over for validate() to complain about.
void set_profile(Cutter& cutter, std::vector<ProfilePoint> points);

/// Corners of a polygon that stays within `tolerance_mm` of the outline; the first lies on the axis.
std::vector<Vec2> sample_outline(const std::vector<OutlineElement>& outline, double tolerance_mm);

}  // namespace swarf::cutter
