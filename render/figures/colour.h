// Colour spaces, and the scale that turns a deviation into a colour.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/draw_list.h"

namespace swarf::render {

/// sRGB transfer curve (IEC 61966-2-1), one channel, 0..1 both ways.
float srgb_from_linear(float linear);
float linear_from_srgb(float encoded);

/// Linear 0..1 to 8-bit sRGB with alpha 255; channels outside 0..1 saturate, as a screen does.
std::array<uint8_t, 4> srgb8_from_linear(const Rgb& linear);
Rgb linear_from_srgb8(const std::array<uint8_t, 4>& encoded);

/// Where the colours of deviation end below (gouge) and above (excess), um, both > 0.
struct DeviationScale {
  double below_um = 1.0, above_um = 1.0;
  DeviationScale(double below, double above) : below_um(below), above_um(above) {}
  /// As wide on both sides.
  DeviationScale(double half_width) : DeviationScale(half_width, half_width) {}
  /// -1 .. 1 within the scale.
  double place(double um) const { return um / (um < 0.0 ? below_um : above_um); }
  /// The deviation at a place.
  double at(double place) const { return place * (place < 0.0 ? below_um : above_um); }
};

/// Colour of a deviation on a diverging scale.
///
/// Below zero (gouge) blue, at zero near-white (on size), above zero (excess) yellow, orange, red. Lightness
/// falls evenly with |deviation| on both sides, so that the scale still reads in grey; the sides differ in
/// the blue-yellow direction, which red-green blindness leaves intact. Interpolated in OKLab (Ottosson 2020).
/// Beyond the scale: the end colours. NaN (unknown): dark grey, which the scale does not contain.
Rgb deviation_colour(double deviation_um, const DeviationScale& scale);

/// How well colours between vertices show a deviation, against what is allowed: the greater of
/// kShownWithinUm and kShownWithinShare of the scale.
class ColourError {
 public:
  explicit ColourError(const DeviationScale& scale);
  double allowed_um() const { return allowed_um_; }
  /// A renderer mixes the linear colours of three corners with these values in these shares: how far the
  /// mixture is from the colour of `truth_um`, in units of the distance of the colours that lie as much aside
  /// as is allowed. Values beyond the scale, whose colours are one, are to be read within a tenth.
  double operator()(const std::array<float, 3>& um, const Vec3& shares, float truth_um) const;

 private:
  const Rgb& colour_at(double um) const;

  DeviationScale scale_;
  double allowed_um_;
  std::vector<Rgb> colours_;  ///< at equal distances from place -1 to 1
};
inline constexpr double kShownWithinUm = 1.0, kShownWithinShare = 0.02;

/// Fills `mesh.colours` from `mesh.deviation_um`, which must be present.
void colour_by_deviation(TriMesh& mesh, const DeviationScale& scale);

}  // namespace swarf::render
