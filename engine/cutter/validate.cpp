// What makes a cutter impossible, rule by rule: lengths, the shape's own parameters, what stands above it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "cutter/cutter.h"
#include "cutter/profile.h"
#include "cutter/profile_check.h"

namespace swarf::cutter {
namespace {

constexpr double kAgree = 1e-9;         // mm; lengths that the user means to be equal
constexpr double kCentreAgrees = 1e-3;  // mm; CL files carry (e, f) with three or four decimals
constexpr double kParallelRad = 1e-6;   // bottom line and flank closer to parallel than this do not cross

class Checker {
 public:
  explicit Checker(const Cutter& cutter) : c_(cutter) {}

  std::vector<Problem> run() {
    const bool described = c_.shape == Shape::kProfile ? profile() : lengths();
    if (described && shape()) outline_rules();
    tool_above();
    return std::move(problems_);
  }

 private:
  template <typename... Args>
  bool fail(const char* key, fmt::format_string<Args...> text, Args&&... args) {
    problems_.push_back({key, fmt::format(text, std::forward<Args>(args)...)});
    return false;
  }

  bool positive(double value, const char* key, const char* name) {
    if (value > 0.0 && std::isfinite(value)) return true;
    return fail(key, "{} must be above 0 mm and finite, it is {:g}", name, value);
  }
  bool positive(double value, const char* key) { return positive(value, key, key); }

  /// The shape's corner radius must be a length, whatever else it must be.
  bool lengths() {
    bool good = positive(c_.diameter_mm, "diameter_mm");
    const char* flutes = c_.shape == Shape::kWoodruff ? "width_mm" : "flute_length_mm";
    if (!positive(c_.flute_length_mm, flutes)) good = false;
    if (!(c_.corner_radius_mm >= 0.0 && std::isfinite(c_.corner_radius_mm))) {
      good = fail("corner_radius_mm", "corner_radius_mm must be 0 mm or more and finite, it is {:g}",
                  c_.corner_radius_mm);
    }
    return good;
  }

  bool profile() {
    const std::vector<std::string> found = profile_problems(c_.profile);
    for (const std::string& text : found) fail("profile", "{}", text);
    if (!found.empty()) return false;
    const double end = c_.profile.back().to.y();
    return std::abs(end - c_.flute_length_mm) <= kAgree ||
           fail("profile", "the profile ends {:g} mm above the tip, flute_length_mm is {:g}", end,
                c_.flute_length_mm);
  }

  bool angle(double value_rad, double low_deg, double high_deg, const char* key) {
    const double deg = deg_from_rad(value_rad);
    if (deg > low_deg && deg < high_deg) return true;
    return fail(key, "{} is {:g}: it must lie between {:g} and {:g} degrees", key, deg, low_deg, high_deg);
  }

  bool no_larger_corner(double largest, const char* why) {
    if (c_.corner_radius_mm <= largest + kAgree) return true;
    return fail("corner_radius_mm", "corner_radius_mm {:g} is above {:g} mm, {}", c_.corner_radius_mm,
                largest, why);
  }

  /// The shape's own keys, before its outline can be drawn.
  bool shape() {
    const double r = c_.corner_radius_mm, radius = c_.radius();
    switch (c_.shape) {
      case Shape::kFlat:
        return r == 0.0 || fail("corner_radius_mm",
                                "corner_radius_mm is {:g}, but a flat end has none; shape = \"bull_nose\" "
                                "is the one with a corner radius",
                                r);
      case Shape::kBall:
        return r == 0.0 || std::abs(r - radius) <= kAgree ||
               fail("corner_radius_mm",
                    "corner_radius_mm is {:g}, but a ball end of diameter {:g} mm has {:g} mm", r,
                    c_.diameter_mm, radius);
      case Shape::kBullNose:
        if (r == 0.0) {
          return fail("corner_radius_mm",
                      "corner_radius_mm is 0: a bull nose needs one; shape = \"flat\" has "
                      "none");
        }
        return no_larger_corner(radius, "the cutter's radius");
      case Shape::kTaper: {
        const bool corner = no_larger_corner(radius, "the radius of the end");
        return angle(c_.taper_rad, 0.0, 90.0, "taper_deg") && corner;
      }
      case Shape::kDrill:
        return no_corner() && angle(c_.point_angle_rad, 0.0, 180.0, "point_angle_deg");
      case Shape::kChamfer:
        return chamfer();
      case Shape::kWoodruff: {
        const bool half = no_larger_corner(0.5 * c_.flute_length_mm, "half of width_mm");
        return no_larger_corner(radius, "the disc's radius") && half;
      }
      case Shape::kApt:
        return apt();
      case Shape::kProfile:
        return true;
    }
    return false;
  }

  /// Of shapes whose edges are sharp by definition.
  bool no_corner() {
    const double r = c_.corner_radius_mm;
    return r == 0.0 || fail("corner_radius_mm", "corner_radius_mm is {:g}, but shape = \"{}\" has none", r,
                            shape_name(c_.shape));
  }

  bool chamfer() {
    if (!no_corner()) return false;
    if (!(c_.tip_diameter_mm >= 0.0 && c_.tip_diameter_mm < c_.diameter_mm)) {
      return fail("tip_diameter_mm",
                  "tip_diameter_mm is {:g}: it must be 0 or more and below diameter_mm {:g}",
                  c_.tip_diameter_mm, c_.diameter_mm);
    }
    if (!angle(c_.point_angle_rad, 0.0, 180.0, "point_angle_deg")) return false;
    const double cone = (c_.radius() - 0.5 * c_.tip_diameter_mm) / std::tan(0.5 * c_.point_angle_rad);
    if (cone <= c_.flute_length_mm + kAgree) return true;
    return fail("flute_length_mm",
                "flute_length_mm {:g} ends below the cone's upper edge, {:g} mm above the tip",
                c_.flute_length_mm, cone);
  }

  bool apt() {
    if (!(c_.alpha_rad >= 0.0 && c_.alpha_rad < 0.5 * kPi)) {
      return fail("alpha_deg",
                  "alpha_deg is {:g}: the bottom line must rise from the tip by 0 or more and less than 90 "
                  "degrees",
                  deg_from_rad(c_.alpha_rad));
    }
    if (!angle(c_.beta_rad, -90.0, 90.0, "beta_deg")) return false;
    if (c_.alpha_rad + c_.beta_rad >= 0.5 * kPi - kParallelRad) {
      return fail("beta_deg",
                  "alpha_deg {:g} and beta_deg {:g} add up to 90 or more: bottom line and flank never cross",
                  deg_from_rad(c_.alpha_rad), deg_from_rad(c_.beta_rad));
    }
    return true;
  }

  /// Rules about the drawn outline that the shapes have in common.
  void outline_rules() {
    const std::optional<AptForm> form = apt_form(c_);
    if (!form) return;
    if (c_.shape == Shape::kApt) {
      const double largest = form->largest_corner_radius();
      if (!no_larger_corner(largest, "the largest circle between bottom line and flank")) return;
      if (c_.corner_centre_mm) corner_centre(*form);
    }
    const Vec2 start = form->flank_start();
    if (start.y() > form->h + kAgree) {
      fail("flute_length_mm", "flute_length_mm {:g} ends below the flank, which begins {:g} mm above the tip",
           form->h, start.y());
    } else if (form->flank_end().x() <= 0.0) {
      fail("beta_deg",
           "beta_deg {:g} leads the flank to the axis {:g} mm above the tip, below flute_length_mm {:g}",
           deg_from_rad(form->beta), start.y() - start.x() / std::tan(form->beta), form->h);
    }
  }

  void corner_centre(const AptForm& form) {
    const Vec2 given = *c_.corner_centre_mm, right = form.corner_centre();
    if ((given - right).cwiseAbs().maxCoeff() <= kCentreAgrees) return;
    const double e = given.x(), r = form.r;
    if (form.beta == 0.0 && std::abs(e + r - 0.5 * form.d) > kCentreAgrees) {
      fail("corner_centre_mm",
           "e + r = {:g} + {:g} = {:g} mm, but without taper (beta_deg 0) the corner circle touches the "
           "flank at "
           "d/2 = {:g} mm",
           e, r, e + r, 0.5 * form.d);
      return;
    }
    fail("corner_centre_mm",
         "the corner circle about e {:g}, f {:g} mm does not touch bottom line and flank: d, r, alpha and "
         "beta "
         "put its centre at e {:.4f}, f {:.4f} mm",
         e, given.y(), right.x(), right.y());
  }

  void section(const ToolSection& s, const char* key) {
    positive(s.diameter_mm, key, "the holder's diameter_mm");
    positive(s.top_diameter_mm, key, "the holder's top_diameter_mm");
    positive(s.length_mm, key, "the holder's length_mm");
  }

  /// Neck, shank and holder.
  void tool_above() {
    positive(c_.shank_diameter_mm, "shank_diameter_mm");
    positive(c_.length_mm, "length_mm");
    for (const ToolSection& s : c_.holder) section(s, "holder");
    if (c_.holder.empty()) fail("holder", "the holder has no section");
    if (c_.flute_length_mm > c_.length_mm) {
      fail(c_.shape == Shape::kWoodruff ? "width_mm" : "flute_length_mm",
           "flute_length_mm {:g} is longer than the tool, length_mm {:g}", c_.flute_length_mm, c_.length_mm);
    } else if (c_.neck_length_mm != 0.0) {
      neck();
    }
    const double above = c_.neck_length_mm > 0.0 ? c_.neck_diameter_mm : c_.shank_diameter_mm;
    if (c_.shape == Shape::kWoodruff && above >= c_.diameter_mm) {
      fail(c_.neck_length_mm > 0.0 ? "neck_diameter_mm" : "shank_diameter_mm",
           "the disc has diameter_mm {:g}, but what carries it is {:g} mm thick: nothing of it would reach "
           "under "
           "an edge",
           c_.diameter_mm, above);
    }
  }

  void neck() {
    if (!positive(c_.neck_length_mm, "neck_length_mm") || !positive(c_.neck_diameter_mm, "neck_diameter_mm"))
      return;
    if (c_.flute_length_mm + c_.neck_length_mm > c_.length_mm) {
      fail("neck_length_mm", "flutes and neck, {:g} + {:g} mm, are longer than the tool, length_mm {:g}",
           c_.flute_length_mm, c_.neck_length_mm, c_.length_mm);
    }
  }

  const Cutter& c_;
  std::vector<Problem> problems_;
};

}  // namespace

std::vector<Problem> validate(const Cutter& cutter) {
  return Checker(cutter).run();
}

}  // namespace swarf::cutter
