#include "render/figures/colour.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace swarf::render {
namespace {

using Lab = Eigen::Vector3f;

/// OKLab of a linear sRGB colour (Ottosson, "A perceptual color space for image processing", 2020).
Lab oklab_from_linear(const Rgb& c) {
  const float l = std::cbrt(0.4122214708F * c[0] + 0.5363325363F * c[1] + 0.0514459929F * c[2]);
  const float m = std::cbrt(0.2119034982F * c[0] + 0.6806995451F * c[1] + 0.1073969566F * c[2]);
  const float s = std::cbrt(0.0883024619F * c[0] + 0.2817188376F * c[1] + 0.6299787005F * c[2]);
  return {0.2104542553F * l + 0.7936177850F * m - 0.0040720468F * s,
          1.9779984951F * l - 2.4285922050F * m + 0.4505937099F * s,
          0.0259040371F * l + 0.7827717662F * m - 0.8086757660F * s};
}

Rgb linear_from_oklab(const Lab& lab) {
  const float l = std::pow(lab[0] + 0.3963377774F * lab[1] + 0.2158037573F * lab[2], 3.0F);
  const float m = std::pow(lab[0] - 0.1055613458F * lab[1] - 0.0638541728F * lab[2], 3.0F);
  const float s = std::pow(lab[0] - 0.0894841775F * lab[1] - 1.2914855480F * lab[2], 3.0F);
  return {std::clamp(4.0767416621F * l - 3.3077115913F * m + 0.2309699292F * s, 0.0F, 1.0F),
          std::clamp(-1.2684380046F * l + 2.6097574011F * m - 0.3413193965F * s, 0.0F, 1.0F),
          std::clamp(-0.0041960863F * l - 0.7034186147F * m + 1.7076147010F * s, 0.0F, 1.0F)};
}

struct Anchor {
  double place;  ///< deviation / scale, -1..1
  std::array<uint8_t, 4> srgb;
};

/// The scale's anchors, chosen so that OKLab lightness falls from .96 to .40 on both sides.
constexpr std::array<Anchor, 7> kAnchors{{{-1.0, {12, 62, 148, 255}},
                                          {-0.66, {58, 124, 203, 255}},
                                          {-0.33, {146, 188, 232, 255}},
                                          {0.0, {243, 243, 240, 255}},
                                          {0.33, {252, 214, 98, 255}},
                                          {0.66, {240, 128, 34, 255}},
                                          {1.0, {158, 8, 22, 255}}}};

double apart(const Rgb& a, const Rgb& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

constexpr Rgb kUnknownColour{0.05F, 0.05F, 0.05F};

}  // namespace

float srgb_from_linear(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

float linear_from_srgb(float encoded) {
  return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

std::array<uint8_t, 4> srgb8_from_linear(const Rgb& linear) {
  std::array<uint8_t, 4> out{0, 0, 0, 255};
  for (size_t i = 0; i < 3; ++i) {
    out[i] = static_cast<uint8_t>(std::lround(255.0F * srgb_from_linear(std::clamp(linear[i], 0.0F, 1.0F))));
  }
  return out;
}

Rgb linear_from_srgb8(const std::array<uint8_t, 4>& encoded) {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (size_t i = 0; i < values.size(); ++i) values[i] = linear_from_srgb(static_cast<float>(i) / 255.0F);
    return values;
  }();
  return {table[encoded[0]], table[encoded[1]], table[encoded[2]]};
}

Rgb deviation_colour(double deviation_um, const DeviationScale& scale) {
  SWARF_CHECK(scale.below_um > 0.0 && scale.above_um > 0.0, "the colour scale needs a width above zero");
  if (std::isnan(deviation_um)) return kUnknownColour;
  const double place = std::clamp(scale.place(deviation_um), -1.0, 1.0);
  size_t i = 1;
  while (i + 1 < kAnchors.size() && place > kAnchors[i].place) ++i;
  const Anchor &low = kAnchors[i - 1], &high = kAnchors[i];
  const auto t = static_cast<float>((place - low.place) / (high.place - low.place));
  const Lab a = oklab_from_linear(linear_from_srgb8(low.srgb));
  const Lab b = oklab_from_linear(linear_from_srgb8(high.srgb));
  return linear_from_oklab(a + t * (b - a));
}

ColourError::ColourError(const DeviationScale& scale)
    : scale_(scale),
      allowed_um_(std::max(kShownWithinUm, kShownWithinShare * std::min(scale.below_um, scale.above_um))) {
  constexpr int kSteps = 2048;
  for (int i = 0; i <= kSteps; ++i)
    colours_.push_back(deviation_colour(scale.at(2.0 * i / kSteps - 1.0), scale));
}

const Rgb& ColourError::colour_at(double um) const {
  const double place = std::clamp(scale_.place(um), -1.0, 1.0);
  return colours_[static_cast<size_t>(std::lround(0.5 * (place + 1.0) * double(colours_.size() - 1)))];
}

double ColourError::operator()(const std::array<float, 3>& um, const Vec3& shares, float truth_um) const {
  Rgb mixed{};
  double read = 0.0;
  for (size_t k = 0; k < 3; ++k) {
    const double share = shares[static_cast<int>(k)];
    const Rgb& colour = colour_at(um[k]);
    for (size_t c = 0; c < 3; ++c) mixed[c] += static_cast<float>(share) * colour[c];
    read += share * um[k];
  }
  constexpr double kReadShare = 0.1;
  const double value = std::abs(read - truth_um) / std::max(allowed_um_, kReadShare * std::abs(truth_um));
  const Rgb& right = colour_at(truth_um);
  const double aside = std::max(apart(colour_at(truth_um - allowed_um_), right),
                                apart(colour_at(truth_um + allowed_um_), right));
  return std::max(value, aside > 0.0 ? apart(mixed, right) / aside : 0.0);
}

void colour_by_deviation(TriMesh& mesh, const DeviationScale& scale) {
  SWARF_CHECK(mesh.deviation_um.size() == mesh.positions.size(), "the mesh carries no deviation");
  // A table is finer than 8-bit colours and saves the cube roots for a million vertices.
  constexpr int kSteps = 1024;
  std::vector<std::array<uint8_t, 4>> table(kSteps + 1);
  for (int i = 0; i <= kSteps; ++i) {
    table[i] = srgb8_from_linear(deviation_colour(scale.at(2.0 * i / kSteps - 1.0), scale));
  }
  mesh.colours.resize(mesh.positions.size());
  for (size_t i = 0; i < mesh.colours.size(); ++i) {
    const double place = scale.place(mesh.deviation_um[i]);
    mesh.colours[i] = std::isnan(place)
                          ? srgb8_from_linear(kUnknownColour)
                          : table[std::lround((std::clamp(place, -1.0, 1.0) + 1.0) * (0.5 * kSteps))];
  }
}

}  // namespace swarf::render
