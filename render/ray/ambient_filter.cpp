#include "render/ray/ambient_filter.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace swarf::render {
namespace {

constexpr int kReach = 2;  // pixels to each side in a step of width 1
constexpr int kStepWidths[] = {1, 3};
constexpr float kPlanePx = 1.0F;  // off the plane of the pixel by more, it is another surface
constexpr float kFacing = 0.9F;   // cosine between normals below which it is, too
/// In pixels of the same surface: of the mean of all that are looked at, and of the pixel itself. They count
/// where the pixel is like no other.
constexpr float kMeanWeight = 0.5F, kOwnWeight = 0.25F;
/// What is mirrored in narrow grooves and edges differs more from all around them than the light there does.
constexpr float kOwnSheenWeight = 1.0F;
constexpr int kRowsAtOnce = 8;

struct Shared {
  Vec3f ambient, sheen;
  bool knows_sheen;
};

struct Step {
  const std::vector<PixelLight>& pixels;
  int width, height;
  Vec3f eye;
  float mm_per_px;
  int apart;  ///< between the pixels that are looked at

  const PixelLight& at(int x, int y) const {
    return pixels[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
  }
  Shared shared(int x, int y) const;
};

/// A mean over the pixels of the same surface, and a little of all.
class SharedMean {
 public:
  void add(const Vec3f& value, float weight) {
    same_sum_ += weight * value;
    same_ += weight;
    all_sum_ += value;
    all_ += 1.0F;
  }
  bool empty() const { return all_ == 0.0F; }
  Vec3f mean() const { return (same_sum_ + kMeanWeight / all_ * all_sum_) / (same_ + kMeanWeight); }

 private:
  Vec3f same_sum_ = Vec3f::Zero(), all_sum_ = Vec3f::Zero();
  float same_ = 0.0F, all_ = 0.0F;
};

/// 1 for the same surface, falling to 0.
float likeness(const PixelLight& a, const PixelLight& b, float tolerance_mm) {
  const float facing = a.normal.dot(b.normal);
  if (facing <= kFacing) return 0.0F;
  const float off = std::abs(a.normal.dot(b.position - a.position)) / tolerance_mm;
  return off < 1.0F ? (facing - kFacing) / (1.0F - kFacing) * (1.0F - off) : 0.0F;
}

Shared Step::shared(int x, int y) const {
  const PixelLight& own = at(x, y);
  const auto is_matt = [](const PixelLight& pixel) { return pixel.matt.maxCoeff() > 0.0F; };
  if (!is_matt(own) && own.dull <= 0.0F) return {own.ambient, own.sheen, own.knows_sheen};
  const float tolerance_mm = kPlanePx * static_cast<float>(apart) * mm_per_px * (own.position - eye).norm();
  SharedMean ambient, sheen;
  for (int j = y - kReach * apart; j <= y + kReach * apart; j += apart) {
    if (j < 0 || j >= height) continue;
    for (int i = x - kReach * apart; i <= x + kReach * apart; i += apart) {
      if (i < 0 || i >= width) continue;
      const PixelLight& other = at(i, j);
      const bool gives_sheen = other.knows_sheen && own.dull > 0.0F;
      if (!is_matt(other) && !gives_sheen) continue;
      const float weight = &other == &own ? kOwnWeight : likeness(own, other, tolerance_mm);
      if (is_matt(other)) ambient.add(other.ambient, weight);
      if (gives_sheen) sheen.add(other.sheen, &other == &own ? kOwnSheenWeight : weight);
    }
  }
  const bool knows_sheen = own.dull > 0.0F && !sheen.empty();
  return {is_matt(own) ? ambient.mean() : own.ambient, knows_sheen ? sheen.mean() : own.sheen, knows_sheen};
}

}  // namespace

void share_ambient(std::vector<PixelLight>& pixels, int width, int height, const Vec3f& eye,
                   float mm_per_px) {
  std::vector<Shared> shared(pixels.size());
  for (const int apart : kStepWidths) {
    const Step step{pixels, width, height, eye, mm_per_px, apart};
    parallel_chunks(static_cast<size_t>(height), kRowsAtOnce, [&](size_t begin, size_t end) {
      for (size_t i = begin * static_cast<size_t>(width); i < end * static_cast<size_t>(width); ++i)
        shared[i] = step.shared(static_cast<int>(i) % width, static_cast<int>(i) / width);
    });
    for (size_t i = 0; i < pixels.size(); ++i) {
      pixels[i].ambient = shared[i].ambient;
      pixels[i].sheen = shared[i].sheen;
      pixels[i].knows_sheen = shared[i].knows_sheen;
    }
  }
}

}  // namespace swarf::render
