// The cutter: the cutting part by its shape's own parameters, by APT's seven or by a free profile; above it
// neck, shank and holder.
//
//      |  holder |     stacked cylinders and cones, from `length_mm` upwards
//      |__ ___ __|
//         | |          shank: up to `length_mm`
//         |_|          neck (optional): `neck_length_mm` above the flutes
//        |   |         cutting part: from the tip, z = 0, to `flute_length_mm`
//        \___/
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/frames.h"

namespace swarf::cutter {

/// What describes the cutting part. diameter_mm, corner_radius_mm and flute_length_mm mean what the shape
/// says.
enum class Shape {
  kFlat,      ///< flat end mill: diameter
  kBall,      ///< ball end: corner radius = diameter / 2
  kBullNose,  ///< flat end with a corner radius
  kTaper,     ///< cone above a flat or rounded end: diameter = 2 (e + r), of the end; taper = half angle
  kDrill,     ///< cone point (included angle), then a cylinder
  kChamfer,   ///< as the drill, with a flat of tip_diameter_mm at the end
  kWoodruff,  ///< disc (Woodruff, T-slot): flute_length_mm is its width; both edges may be rounded
  kApt,       ///< APT's CUTTER/d,r,e,f,alpha,beta,h
  kProfile    ///< lines and arcs; diameter and flute length follow from them
};

/// The word for it in a scene: "bull_nose".
const char* shape_name(Shape shape);
/// All of them, in the order of Shape.
std::vector<std::string> shape_names();

/// A corner of a free profile and how the outline gets there from the one before.
struct ProfilePoint {
  Vec2 to = Vec2::Zero();  ///< (rho, z), mm
  double radius_mm = 0.0;  ///< 0: a line; above 0: an arc that bulges outwards; below 0: a hollow arc
};

/// A cylinder or a frustum of the tool.
struct ToolSection {
  double diameter_mm = 40.0;      ///< at its lower end
  double top_diameter_mm = 40.0;  ///< at its upper end
  double length_mm = 50.0;
};

/// Lengths in mm, heights measured from the tip along the axis.
struct Cutter {
  int number = 0;          ///< T word; 0: known by its name only
  std::string name;        ///< T="name"; empty: known by its number only
  bool left_hand = false;  ///< cuts while it turns counter-clockwise (M4)
  Shape shape = Shape::kFlat;
  double diameter_mm = 10.0;      ///< APT d: twice the radius at which bottom line and flank line cross
  double corner_radius_mm = 0.0;  ///< APT r
  double flute_length_mm = 25.0;  ///< APT h: cutting edges reach this far up
  double taper_rad = 0.0;         ///< kTaper: flank from the axis
  double point_angle_rad = 0.0;   ///< kDrill, kChamfer: between opposite sides of the cone
  double tip_diameter_mm = 0.0;   ///< kChamfer: 0 is a sharp point
  double alpha_rad = 0.0;         ///< kApt: bottom line from the radial plane, rising outwards
  double beta_rad = 0.0;          ///< kApt: flank from the axis; above 0 it widens upwards
  std::optional<Vec2> corner_centre_mm;  ///< kApt: (e, f); follows from the other five, so only checked
  std::vector<ProfilePoint> profile;     ///< kProfile: from (0, 0) up to the end of the flutes

  double neck_diameter_mm = 0.0;
  double neck_length_mm = 0.0;  ///< 0: no neck
  double shank_diameter_mm = 10.0;
  double length_mm = 60.0;                         ///< tip to the holder's face
  std::vector<ToolSection> holder{ToolSection{}};  ///< from the face upwards
  std::optional<double> gauge_length_mm;           ///< gauge line to tip; none: it lies on top of the holder

  double radius() const { return 0.5 * diameter_mm; }
};

/// Something that contradicts itself: the key of the scene to look at, and what is wrong in words with
/// numbers.
struct Problem {
  std::string key;
  std::string text;
};

/// Every contradiction; empty when the cutter can be used.
std::vector<Problem> validate(const Cutter& cutter);

/// From the spindle's gauge line to the tip: as given, or length and holder together. mm
double gauge_length(const Cutter& cutter);

/// What a program calls it: "T3", "T3 (MILL_10)", "MILL_10".
std::string call_name(const Cutter& cutter);

/// One line for a report: "bull nose, D 10 mm, corner radius 1 mm, flutes 25 mm, length 60 mm".
std::string describe(const Cutter& cutter);

}  // namespace swarf::cutter
