#include "render/ray/still.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"
#include "render/figures/colour.h"
#include "render/ray/ambient_filter.h"
#include "render/ray/tracer.h"

namespace swarf::render {
namespace {

/// Side of the square tiles that are the units of parallel work.
constexpr int kTile = 16;

/// Rays through the pixels of a camera.
struct Lens {
  Vec3 eye, right, up, forward;  ///< right and up scaled to half the picture at distance 1

  Lens(const Camera& camera, int width, int height) : eye(camera.eye) {
    forward = (camera.target - camera.eye).normalized();
    const Vec3 side = forward.cross(camera.up);
    constexpr double kParallel = 1e-9;  // sine of an angle that leaves no direction to the right
    SWARF_CHECK(side.norm() > kParallel * camera.up.norm(), "the camera looks along its own up direction");
    const double half = std::tan(0.5 * camera.vertical_fov_rad);
    right = side.normalized() * (half * width / height);
    up = side.normalized().cross(forward) * half;
  }
  Vec3f ray(double x, double y) const { return (forward + x * right + y * up).normalized().cast<float>(); }
};

/// Identity up to the knee, then a rational shoulder towards 1 with equal slope at the knee.
float tone(float x) {
  constexpr float kKnee = 0.6F;
  if (x <= kKnee) return std::max(x, 0.0F);
  const float t = (x - kKnee) / (1.0F - kKnee);
  return kKnee + (1.0F - kKnee) * t / (1.0F + t);
}

/// Offset in pixels of a tent filter two pixels wide, from a uniform number.
double tent(float xi) {
  return xi < 0.5F ? std::sqrt(2.0 * xi) - 1.0 : 1.0 - std::sqrt(2.0 - 2.0 * xi);
}

Vec3f vector_of(const Rgb& c) {
  return {c[0], c[1], c[2]};
}

/// Brightness of a sample as it is seen, and how sure their mean is (Welford).
class Brightness {
 public:
  void add(const Vec3f& light, double exposure) {
    const float linear = 0.2126F * tone(light.x() * static_cast<float>(exposure)) +
                         0.7152F * tone(light.y() * static_cast<float>(exposure)) +
                         0.0722F * tone(light.z() * static_cast<float>(exposure));
    const double value = 255.0 * srgb_from_linear(linear);
    const double off = value - mean_;
    mean_ += off / ++count_;
    squares_ += off * (value - mean_);
  }
  /// Of 255.
  double standard_error() const { return std::sqrt(squares_ / (count_ * (count_ - 1.0))); }

 private:
  double mean_ = 0.0, squares_ = 0.0, count_ = 0.0;
};

/// The sums over a pixel's samples.
class Gathered {
 public:
  void add(const Seen& seen, bool with_shared) {
    // One hot sample of a mirrored light must not outshine the whole pixel.
    constexpr float kFirefly = 8.0F;
    sum_.light += seen.light.cwiseMin(kFirefly);
    sum_.matt += seen.matt;
    sum_.normal += seen.normal;
    sum_.position += seen.position;
    ++count_;
    if (!seen.normal.isZero()) ++surfaces_;
    if (seen.dull) ++dull_;
    if (!with_shared) return;
    if (seen.dull) {
      sum_.sheen += seen.sheen.cwiseMin(kFirefly);
      ++with_sheen_;
    }
    sum_.ambient += seen.matt.cwiseProduct(seen.ambient.cwiseMin(kFirefly));
    matt_with_ambient_ += seen.matt;
  }
  bool knows_shared() const { return matt_with_ambient_.maxCoeff() > 0.0F || with_sheen_ > 0; }
  PixelLight mean(float opacity) const {
    PixelLight mean = sum_;
    const auto many = static_cast<float>(std::max(count_, 1));
    mean.light /= many;
    mean.matt /= many;
    for (int k = 0; k < 3; ++k)
      mean.ambient[k] = matt_with_ambient_[k] > 0.0F ? sum_.ambient[k] / matt_with_ambient_[k] : 0.0F;
    if (with_sheen_ > 0) mean.sheen /= static_cast<float>(with_sheen_);
    mean.knows_sheen = with_sheen_ > 0;
    mean.dull = static_cast<float>(dull_) / many;
    if (surfaces_ > 0) mean.position /= static_cast<float>(surfaces_);
    if (!mean.normal.isZero()) mean.normal.normalize();
    mean.opacity = opacity;
    return mean;
  }

 private:
  PixelLight sum_;
  Vec3f matt_with_ambient_ = Vec3f::Zero();
  int count_ = 0, surfaces_ = 0, dull_ = 0, with_sheen_ = 0;
};

struct Shot {
  const StillOptions& options;
  const Lens& lens;
  const Tracer& tracer;
  const BlueNoise& noise;

  PixelLight pixel(int x, int y) const {
    // Fewer samples say nothing about their spread. After so many without a trace of the drawing or its
    // shadow the pixel is backdrop.
    constexpr int kLeast = 6;
    bool empty = true;
    int taken = 0, behind = 0;
    Gathered gathered;
    Brightness brightness;
    for (int s = 0; s < options.samples_per_pixel; ++s) {
      Sampler sampler(noise, x, y, static_cast<uint32_t>(s), options.seed);
      const Eigen::Vector2f xi = sampler.next();
      const double px = (x + 0.5 + tent(xi.x())) / options.width,
                   py = (y + 0.5 + tent(xi.y())) / options.height;
      const auto down = std::clamp(static_cast<float>(py), 0.0F, 1.0F);
      const Vec3f backdrop =
          (1.0F - down) * vector_of(options.backdrop_top) + down * vector_of(options.backdrop_bottom);
      // Every other sample is enough of what neighbours share.
      const bool with_shared = s % 2 == 0 || !gathered.knows_shared();
      const Seen seen = tracer.look(lens.eye.cast<float>(), lens.ray(2.0 * px - 1.0, 1.0 - 2.0 * py),
                                    backdrop, with_shared, sampler);
      behind += seen.empty ? 1 : 0;
      if (!options.transparent || !seen.empty) gathered.add(seen, with_shared);
      empty = empty && seen.empty;
      ++taken;
      if (empty && taken == kLeast) break;
      if (options.noise <= 0.0) continue;
      // What neighbours share is as good as known.
      brightness.add(seen.light + static_cast<float>(options.sky_strength) * seen.matt, options.exposure);
      if (taken >= kLeast && !empty && brightness.standard_error() < options.noise) break;
    }
    return gathered.mean(options.transparent ? static_cast<float>(taken - behind) / static_cast<float>(taken)
                                             : 1.0F);
  }

  void tile(int tile_x, int tile_y, std::vector<PixelLight>& pixels) const {
    for (int y = tile_y * kTile; y < std::min(options.height, (tile_y + 1) * kTile); ++y) {
      for (int x = tile_x * kTile; x < std::min(options.width, (tile_x + 1) * kTile); ++x)
        pixels[static_cast<size_t>(y) * static_cast<size_t>(options.width) + static_cast<size_t>(x)] =
            pixel(x, y);
    }
  }

  std::array<uint8_t, 4> colour(const PixelLight& pixel) const {
    const Vec3f light = static_cast<float>(options.exposure) *
                        (pixel.light + pixel.matt.cwiseProduct(pixel.ambient) + pixel.dull * pixel.sheen);
    std::array<uint8_t, 4> value = srgb8_from_linear({tone(light.x()), tone(light.y()), tone(light.z())});
    value[3] = static_cast<uint8_t>(std::lround(255.0F * pixel.opacity));
    return value;
  }
};

}  // namespace

Image render_still(const DrawList& list, const StillOptions& options) {
  SWARF_CHECK(options.width > 0 && options.height > 0 && options.samples_per_pixel > 0, "size of the still");
  const Lens lens(list.camera, options.width, options.height);
  const double radius_per_mm = std::tan(0.5 * list.camera.vertical_fov_rad) / options.height;
  const RayScene scene(list, radius_per_mm, options.kept_tree);
  const Studio studio(options);
  const Tracer tracer(scene, studio, options);
  static const BlueNoise noise;
  const Shot shot{options, lens, tracer, noise};
  std::vector<PixelLight> pixels(static_cast<size_t>(options.width) * static_cast<size_t>(options.height));
  const int across = (options.width + kTile - 1) / kTile, down = (options.height + kTile - 1) / kTile;
  parallel_chunks(static_cast<size_t>(across) * down, 1, [&](size_t begin, size_t) {
    shot.tile(static_cast<int>(begin) % across, static_cast<int>(begin) / across, pixels);
  });
  share_ambient(pixels, options.width, options.height, lens.eye.cast<float>(),
                static_cast<float>(2.0 * radius_per_mm));
  Image image{options.width, options.height, std::vector<uint8_t>(4 * pixels.size())};
  parallel_chunks(pixels.size(), kTile * static_cast<size_t>(options.width), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const auto value = shot.colour(pixels[i]);
      std::copy(value.begin(), value.end(), image.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
    }
  });
  return image;
}

}  // namespace swarf::render
