#include "render/ray/still.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "base/check.h"
#include "base/parallel.h"
#include "render/figures/colour.h"
#include "render/ray/ambient_filter.h"
#include "render/ray/tracer.h"

namespace swarf::render {
namespace {

/// Side of the square tiles that are the units of parallel work.
constexpr size_t kTile = 16;

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

/// As it is seen, of 255.
float brightness(const Vec3f& light, float exposure) {
  const float linear = 0.2126F * tone(light.x() * exposure) + 0.7152F * tone(light.y() * exposure) +
                       0.0722F * tone(light.z() * exposure);
  return 255.0F * srgb_from_linear(linear);
}

/// What is counted of a pixel's samples beside their sums.
struct Tally {
  Vec3f matt_with_ambient = Vec3f::Zero();
  float mean = 0.0F, squares = 0.0F;  ///< of their brightness (Welford)
  int count = 0, behind = 0, surfaces = 0, dull = 0, with_sheen = 0;

  void add_brightness(float value) {
    const float off = value - mean;
    mean += off / static_cast<float>(count);
    squares += off * (value - mean);
  }
  float variance() const { return squares / static_cast<float>(std::max(count - 1, 1)); }
  bool knows_shared() const { return matt_with_ambient.maxCoeff() > 0.0F || with_sheen > 0; }
};

void add_sample(const Seen& seen, bool with_shared, PixelLight& sum, Tally& tally) {
  // One hot sample of a mirrored light must not outshine the whole pixel.
  constexpr float kFirefly = 8.0F;
  sum.light += seen.light.cwiseMin(kFirefly);
  sum.matt += seen.matt;
  sum.normal += seen.normal;
  sum.position += seen.position;
  if (!seen.normal.isZero()) ++tally.surfaces;
  if (seen.dull) ++tally.dull;
  if (!with_shared) return;
  if (seen.dull) {
    sum.sheen += seen.sheen.cwiseMin(kFirefly);
    ++tally.with_sheen;
  }
  sum.ambient += seen.matt.cwiseProduct(seen.ambient.cwiseMin(kFirefly));
  tally.matt_with_ambient += seen.matt;
}

/// Makes means of a pixel's sums.
void divide(const Tally& tally, bool transparent, PixelLight& sum) {
  const int kept = transparent ? tally.count - tally.behind : tally.count;
  const auto many = static_cast<float>(std::max(kept, 1));
  sum.light /= many;
  sum.matt /= many;
  for (int k = 0; k < 3; ++k)
    sum.ambient[k] = tally.matt_with_ambient[k] > 0.0F ? sum.ambient[k] / tally.matt_with_ambient[k] : 0.0F;
  if (tally.with_sheen > 0) sum.sheen /= static_cast<float>(tally.with_sheen);
  sum.knows_sheen = tally.with_sheen > 0;
  sum.dull = static_cast<float>(tally.dull) / many;
  if (tally.surfaces > 0) sum.position /= static_cast<float>(tally.surfaces);
  if (!sum.normal.isZero()) sum.normal.normalize();
  sum.opacity = static_cast<float>(kept) / static_cast<float>(tally.count);
}

/// Every pixel takes a few samples; what they tell, together with those of the pixels beside it, says how
/// many more it takes. A pixel's own few may all miss an edge or a line that its neighbours meet.
class Shot {
 public:
  Shot(const StillOptions& options, const Lens& lens, const Tracer& tracer)
      : options_(options),
        lens_(lens),
        tracer_(tracer),
        pixels_(static_cast<size_t>(options.width) * static_cast<size_t>(options.height)) {}

  std::vector<PixelLight> take() {
    std::vector<Tally> tallies(pixels_.size());
    const int first = std::min(kFirst, options_.samples_per_pixel);
    over_tiles([&](size_t x, size_t y, Openings& openings) {
      for (int s = 0; s < first; ++s) sample(x, y, s, tallies[at(x, y)], openings);
    });
    std::vector<int> wanted(pixels_.size());
    over_tiles([&](size_t x, size_t y, Openings&) { wanted[at(x, y)] = samples_wanted(x, y, tallies); });
    over_tiles([&](size_t x, size_t y, Openings& openings) {
      Tally& tally = tallies[at(x, y)];
      for (int s = first; s < wanted[at(x, y)]; ++s) sample(x, y, s, tally, openings);
      divide(tally, options_.transparent, pixels_[at(x, y)]);
    });
    return std::move(pixels_);
  }

 private:
  /// Samples of every pixel. With the eight pixels around it they are eighteen, whose spread is known well.
  static constexpr int kFirst = 2;
  /// Of the samples after the first, one of so many brings what neighbours share.
  static constexpr int kSharedEvery = 4;

  size_t at(size_t x, size_t y) const { return y * static_cast<size_t>(options_.width) + x; }
  void over_tiles(const std::function<void(size_t, size_t, Openings&)>& visit) const;
  void sample(size_t x, size_t y, int s, Tally& tally, Openings& openings);
  int samples_wanted(size_t x, size_t y, const std::vector<Tally>& tallies) const;

  const StillOptions& options_;
  const Lens& lens_;
  const Tracer& tracer_;
  std::vector<PixelLight> pixels_;  ///< sums until they are divided
};

/// In parallel, row by row within a tile; openings are of one tile, so that threads do not matter.
void Shot::over_tiles(const std::function<void(size_t, size_t, Openings&)>& visit) const {
  const auto width = static_cast<size_t>(options_.width), height = static_cast<size_t>(options_.height);
  const size_t across = (width + kTile - 1) / kTile, down = (height + kTile - 1) / kTile;
  parallel_chunks(across * down, 1, [&](size_t begin, size_t) {
    const size_t left = begin % across * kTile, top = begin / across * kTile;
    Openings openings;
    for (size_t y = top; y < std::min(height, top + kTile); ++y)
      for (size_t x = left; x < std::min(width, left + kTile); ++x) visit(x, y, openings);
  });
}

void Shot::sample(size_t x, size_t y, int s, Tally& tally, Openings& openings) {
  static const BlueNoise noise;
  Sampler sampler(noise, static_cast<int>(x), static_cast<int>(y), static_cast<uint32_t>(s), options_.seed);
  const Eigen::Vector2f xi = sampler.next();
  const double px = (static_cast<double>(x) + 0.5 + tent(xi.x())) / options_.width,
               py = (static_cast<double>(y) + 0.5 + tent(xi.y())) / options_.height;
  const auto down = std::clamp(static_cast<float>(py), 0.0F, 1.0F);
  const Vec3f backdrop =
      (1.0F - down) * vector_of(options_.backdrop_top) + down * vector_of(options_.backdrop_bottom);
  const bool with_shared = s < kFirst || s % kSharedEvery == 0 || !tally.knows_shared();
  const Seen seen = tracer_.look(lens_.eye.cast<float>(), lens_.ray(2.0 * px - 1.0, 1.0 - 2.0 * py), backdrop,
                                 with_shared, sampler, openings);
  ++tally.count;
  const bool left_out = options_.transparent && seen.empty;
  if (seen.empty) ++tally.behind;
  if (!left_out) add_sample(seen, with_shared, pixels_[at(x, y)], tally);
  // What neighbours share is as good as known. A rim before nothing is one whatever its brightness.
  const Vec3f light = seen.light + static_cast<float>(options_.sky_strength) * seen.matt;
  tally.add_brightness(left_out ? -255.0F : brightness(light, static_cast<float>(options_.exposure)));
}

/// So many that their mean would be as sure as asked for, if they were independent, with the variance among
/// all samples in and around the pixel.
int Shot::samples_wanted(size_t x, size_t y, const std::vector<Tally>& tallies) const {
  constexpr double kMost = 1e6;  // as an integer, whatever the noise
  const int most = options_.samples_per_pixel;
  if (options_.noise <= 0.0) return most;
  const auto width = static_cast<size_t>(options_.width), height = static_cast<size_t>(options_.height);
  float within = 0.0F;
  Tally means;
  for (size_t j = std::max(y, size_t{1}) - 1; j < std::min(y + 2, height); ++j) {
    for (size_t i = std::max(x, size_t{1}) - 1; i < std::min(x + 2, width); ++i) {
      const Tally& tally = tallies[at(i, j)];
      within += tally.variance();
      ++means.count;
      means.add_brightness(tally.mean);
    }
  }
  const float variance = (within + means.squares) / static_cast<float>(means.count);
  const double wanted = std::min(std::ceil(variance / (options_.noise * options_.noise)), kMost);
  return std::clamp(static_cast<int>(wanted), std::min(kFirst, most), most);
}

std::array<uint8_t, 4> colour(const PixelLight& pixel, float exposure) {
  const Vec3f light =
      exposure * (pixel.light + pixel.matt.cwiseProduct(pixel.ambient) + pixel.dull * pixel.sheen);
  std::array<uint8_t, 4> value = srgb8_from_linear({tone(light.x()), tone(light.y()), tone(light.z())});
  value[3] = static_cast<uint8_t>(std::lround(255.0F * pixel.opacity));
  return value;
}

}  // namespace

Image render_still(const DrawList& list, const StillOptions& options) {
  SWARF_CHECK(options.width > 0 && options.height > 0 && options.samples_per_pixel > 0, "size of the still");
  const Lens lens(list.camera, options.width, options.height);
  const double radius_per_mm = std::tan(0.5 * list.camera.vertical_fov_rad) / options.height;
  const RayScene scene(list, radius_per_mm, options.kept_tree);
  const Studio studio(options);
  const Tracer tracer(scene, studio, options);
  std::vector<PixelLight> pixels = Shot(options, lens, tracer).take();
  share_ambient(pixels, options.width, options.height, lens.eye.cast<float>(),
                static_cast<float>(2.0 * radius_per_mm));
  Image image{options.width, options.height, std::vector<uint8_t>(4 * pixels.size())};
  parallel_chunks(pixels.size(), kTile * static_cast<size_t>(options.width), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const auto value = colour(pixels[i], static_cast<float>(options.exposure));
      std::copy(value.begin(), value.end(), image.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
    }
  });
  return image;
}

}  // namespace swarf::render
