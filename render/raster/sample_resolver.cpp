#include "render/raster/sample_resolver.h"

#include <algorithm>
#include <array>

#include "base/parallel.h"

namespace swarf::render {
namespace {

constexpr size_t kStrip = 512;            ///< px of a row that are shaded together
constexpr size_t kRowsShadedAtOnce = 10;  ///< px, of one task
constexpr size_t kSamplesMost = 4;        ///< of a pixel

/// One surface among a pixel's samples.
struct PixelSurface {
  SeenWords words{};
  float depth = 0.0F;
  size_t first = 0;                        ///< sample
  float u = 0.0F, v = 0.0F, count = 0.0F;  ///< sums of normals on the octahedron
};

/// Shades strips of rows, one after the other.
class StripShader {
 public:
  StripShader(const SampleBand& band, const Lighting& lighting, int top, Image& image)
      : band_(band),
        lighting_(lighting),
        top_(top),
        image_(image),
        kernel_(shade_kernels().front()),
        firsts_(kStrip),
        parts_(kSamplesMost * kStrip),
        several_(kStrip),
        pixels_(kSamplesMost * kStrip),
        shares_(kSamplesMost * kStrip) {}

  void shade(int row, size_t left, size_t count) {
    const auto side = static_cast<std::ptrdiff_t>(band_.side), stride = side * band_.width;
    // The uppermost of its rows of samples.
    const std::ptrdiff_t start =
        (side * (band_.rows - row) - 1) * stride + side * static_cast<std::ptrdiff_t>(left);
    const SampleRow samples{&band_.words[2 * static_cast<size_t>(start)],
                            &band_.depths[static_cast<size_t>(start)], -stride, count, band_.farthest};
    const float step = 1.0F / static_cast<float>(side);
    const float x = static_cast<float>(left) - 0.5F * static_cast<float>(image_.width) + 0.5F * step,
                y = static_cast<float>(top_ + row) - 0.5F * static_cast<float>(image_.height) + 0.5F * step;
    kernel_.first_surfaces(samples, band_.side, firsts_, several_.data());
    for (size_t i = 0; i < count; ++i) firsts_.x[i] = x + static_cast<float>(i);
    std::fill_n(firsts_.y.begin(), count, y);
    kernel_.shade(lighting_, count, firsts_);
    find_parts(samples, x, y);
    if (parts_found_ > 0) blend_parts();
    kernel_.write_bytes(
        firsts_, count,
        &image_.rgba[4 * (static_cast<size_t>(top_ + row) * static_cast<size_t>(image_.width) + left)]);
  }

 private:
  /// Pixels that see several surfaces.
  void find_parts(const SampleRow& samples, float x, float y) {
    parts_found_ = 0;
    for (size_t i = 0; i < samples.count; ++i)
      if (several_[i] != 0) find_parts_of(samples, i, x + static_cast<float>(i), y);
  }

  void find_parts_of(const SampleRow& samples, size_t pixel, float x, float y) {
    const auto side = static_cast<size_t>(band_.side);
    std::array<PixelSurface, kSamplesMost> found;
    size_t surfaces = 0;
    for (size_t s = 0; s < side * side; ++s) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(side * pixel + s % side) +
                                static_cast<std::ptrdiff_t>(s / side) * samples.below;
      const SeenWords words = samples.depths[at] < samples.farthest
                                  ? SeenWords{samples.words[2 * at], samples.words[2 * at + 1]}
                                  : kGroundWords;
      auto* const end = found.begin() + surfaces;
      auto* one = std::find_if(found.begin(), end,
                               [&](const PixelSurface& seen) { return one_surface(seen.words, words); });
      if (one == end) found[surfaces++] = {words, samples.depths[at], s};
      one->u += static_cast<float>(words[0] & 0xffffU);
      one->v += static_cast<float>(words[0] >> 16);
      one->count += 1.0F;
    }
    for (size_t k = 0; k < surfaces; ++k) add(pixel, found[k], x, y);
  }

  void add(size_t pixel, const PixelSurface& seen, float x, float y) {
    const auto side = static_cast<size_t>(band_.side), at = parts_found_++;
    const float step = 1.0F / static_cast<float>(side);
    parts_.x[at] = x + step * static_cast<float>(seen.first % side);
    parts_.y[at] = y + step * static_cast<float>(seen.first / side);
    parts_.depth[at] = seen.depth;
    parts_.normal_u[at] = seen.u / seen.count;
    parts_.normal_v[at] = seen.v / seen.count;
    parts_.paint[at] = seen.words[1];
    pixels_[at] = pixel;
    shares_[at] = seen.count * step * step;
  }

  void blend_parts() {
    kernel_.shade(lighting_, parts_found_, parts_);
    for (size_t k = 0; k < parts_found_; ++k)
      firsts_.red[pixels_[k]] = firsts_.green[pixels_[k]] = firsts_.blue[pixels_[k]] = 0.0F;
    for (size_t k = 0; k < parts_found_; ++k) {
      firsts_.red[pixels_[k]] += shares_[k] * parts_.red[k];
      firsts_.green[pixels_[k]] += shares_[k] * parts_.green[k];
      firsts_.blue[pixels_[k]] += shares_[k] * parts_.blue[k];
    }
  }

  const SampleBand& band_;
  const Lighting& lighting_;
  int top_;
  Image& image_;
  ShadeKernel kernel_;
  ShadeBatch firsts_, parts_;
  std::vector<uint32_t> several_;
  std::vector<size_t> pixels_;  ///< of the strip, of each part
  std::vector<float> shares_;   ///< of its pixel
  size_t parts_found_ = 0;
};

}  // namespace

void SampleBand::resize(int band_rows) {
  rows = band_rows;
  const auto across = static_cast<size_t>(side * width), down = static_cast<size_t>(side * rows);
  const size_t samples = across * down + static_cast<size_t>(side) * kShadedAtOnce;
  words.resize(2 * samples);
  depths.resize(samples);
}

void resolve(const SampleBand& band, const Lighting& lighting, int top, Image& image) {
  parallel_chunks(static_cast<size_t>(band.rows), kRowsShadedAtOnce, [&](size_t begin, size_t end) {
    StripShader shader(band, lighting, top, image);
    const auto width = static_cast<size_t>(band.width);
    for (size_t row = begin; row < end; ++row)
      for (size_t left = 0; left < width; left += kStrip)
        shader.shade(static_cast<int>(row), left, std::min(kStrip, width - left));
  });
}

}  // namespace swarf::render
