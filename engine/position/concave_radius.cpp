#include "position/concave_radius.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace swarf::position {
namespace {

constexpr double kFlattest = 1.0 / kFlatRadius_mm;

/// Greatest k with II - k I not negative: the curvature that turns most towards the outside.
double greatest_curvature(const Mat2& second, const Mat2& first) {
  const double det = first.determinant();
  const double half =
      0.5 * (second(0, 0) * first(1, 1) + second(1, 1) * first(0, 0) - 2.0 * second(0, 1) * first(0, 1));
  return (half + std::sqrt(std::max(0.0, half * half - det * second.determinant()))) / det;
}

struct HollowCell {
  PatchCell cell;
  double at_centre = 0.0;  ///< curvature towards the outside, 1/mm
  double most = 0.0;       ///< no more anywhere in the cell
};

/// With D the change of (a, b) over the cell and sigma the least stretch of them at its centre, e = D/sigma:
/// a normal turns by at most asin(e / (1 - e)), II by E, I shrinks to (1 - e)^2 of itself.
HollowCell hollow_cell(const surface::Surface& surface, int patch, const Vec2& low, const Vec2& high) {
  HollowCell hollow;
  PatchCell& cell = hollow.cell = patch_cell(surface, patch, low, high);
  const Vec3 across = cell.a.cross(cell.b);
  hollow.at_centre = hollow.most = std::numeric_limits<double>::infinity();
  Mat2 first;
  first << cell.a.squaredNorm(), cell.a.dot(cell.b), cell.a.dot(cell.b), cell.b.squaredNorm();
  const double middle = 0.5 * (first(0, 0) + first(1, 1));
  const double stretch2 = middle - std::hypot(0.5 * (first(0, 0) - first(1, 1)), first(0, 1));
  if (!(across.norm() > 0.0) || !(stretch2 > 0.0)) return hollow;
  const Vec3 normal = across.normalized() * surface.outward_sign();
  // The centre's own second derivatives, so that what is found is found at a place.
  const surface::Derivatives d = surface.derivatives(cell.centre.x(), cell.centre.y());
  const Vec2 h = cell.half;
  Mat2 second;
  second << h.x() * h.x() * normal.dot(d.Suu), h.x() * h.y() * normal.dot(d.Suv),
      h.x() * h.y() * normal.dot(d.Suv), h.y() * h.y() * normal.dot(d.Svv);
  hollow.at_centre = greatest_curvature(second, first);
  const double bend_u = 2.0 * (cell.uu.norm() + cell.stray_uu),
               bend_v = 2.0 * (cell.vv.norm() + cell.stray_vv);
  const double bend_uv = cell.uv.norm() + cell.stray_uv;
  const double shrunk = std::hypot(bend_u + bend_uv, bend_v + bend_uv) / std::sqrt(stretch2);
  if (shrunk >= 0.5) return hollow;
  const double turned = 1.5 * shrunk / (1.0 - shrunk);
  // The centre's second derivatives lie within the strays of the means, as all others do: twice the stray.
  const double change = turned * (bend_u + bend_v + 2.0 * bend_uv) +
                        2.0 * (2.0 * cell.stray_uu + 2.0 * cell.stray_vv + 2.0 * cell.stray_uv);
  hollow.most = std::max(0.0, hollow.at_centre + change / stretch2) / ((1.0 - shrunk) * (1.0 - shrunk));
  return hollow;
}

struct LessHollow {
  bool operator()(const HollowCell& x, const HollowCell& y) const { return x.most < y.most; }
};

class HollowSearch {
 public:
  explicit HollowSearch(const std::vector<Patch>& patches) : patches_(patches) {}

  ConcaveRadius run(size_t most_cells) {
    for (size_t i = 0; i < patches_.size(); ++i) add(static_cast<int>(i), {0.0, 0.0}, {1.0, 1.0});
    while (!waiting_.empty() && waiting_.top().most > enough() && made_ + 2 <= most_cells) {
      const PatchCell cell = waiting_.top().cell;
      waiting_.pop();
      const int side = longer_side(cell);
      Vec2 low = cell.low(), high = cell.high();
      low[side] = high[side] = cell.centre[side];
      add(cell.patch, cell.low(), high);
      add(cell.patch, low, cell.high());
    }
    const double most = waiting_.empty() ? most_ : std::max(most_, waiting_.top().most);
    // What is flatter than kFlattest everywhere has no radius to speak of.
    if (most > kFlattest) found_.at_least = 1.0 / most;
    return found_;
  }

 private:
  double enough() const { return std::max(kFlattest, most_ * (1.0 + kConcaveShare)); }
  void add(int patch, const Vec2& low, const Vec2& high) {
    ++made_;
    const HollowCell hollow = hollow_cell(*patches_[static_cast<size_t>(patch)].surface, patch, low, high);
    if (std::isfinite(hollow.at_centre) && hollow.at_centre > std::max(kFlattest, most_)) {
      most_ = hollow.at_centre;
      found_.radius = 1.0 / most_;
      found_.place_W = hollow.cell.p;
      found_.patch = patch;
      found_.uv = hollow.cell.centre;
    }
    if (hollow.most > kFlattest) waiting_.push(hollow);
  }

  const std::vector<Patch>& patches_;
  std::priority_queue<HollowCell, std::vector<HollowCell>, LessHollow> waiting_;
  ConcaveRadius found_;
  double most_ = 0.0;  ///< 1/mm, at a place
  size_t made_ = 0;
};

}  // namespace

ConcaveRadius smallest_concave_radius(const std::vector<Patch>& patches, size_t most_cells) {
  return HollowSearch(patches).run(most_cells);
}

}  // namespace swarf::position
