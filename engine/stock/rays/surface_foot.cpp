#include "stock/rays/surface_foot.h"

#include <algorithm>
#include <cmath>

namespace swarf::stock {
namespace {

constexpr int kMostFootSteps = 50;
constexpr double kLastFootStep = 1e-6;  // mm; the distance then is known to the square of it
constexpr double kOnFootSide = 1e-12;   // share of the triangle
/// Of the product of the second derivatives: below it they tell no direction.
constexpr double kDefiniteShare = 1e-12;

/// Shares of the corners change by these along l0 and l1: of the first by -1, -1.
const std::array<Vec2, 3> kIntoTriangle{Vec2(-1, -1), Vec2(1, 0), Vec2(0, 1)};
/// Along the side where the share of a corner is 0.
const std::array<Vec2, 3> kAlongSide{Vec2(1, -1), Vec2(0, 1), Vec2(1, 0)};

double share_of_corner(const Vec2& l, size_t k) {
  return k == 0 ? 1.0 - l.x() - l.y() : l[static_cast<Eigen::Index>(k) - 1];
}

class FootSearch {
 public:
  FootSearch(const surface::Surface& surface, const std::array<Vec2, 3>& uv, const Vec3& point)
      : surface_(surface), origin_(uv[0]), b_(uv[1] - uv[0]), c_(uv[2] - uv[0]), point_(point) {}

  SurfaceFoot find(Vec2 l) {
    double nearest = look_at(l);
    Vec2 step = next_step(l);
    for (int n = 0; n < kMostFootSteps && length_of(step) > kLastFootStep; ++n) {
      const Vec2 to = clipped(l, step);
      const Derivatives before = at_;
      const double distance = look_at(to);
      if (distance < nearest) {
        l = to;
        nearest = distance;
        step = next_step(l);
      } else {
        at_ = before;
        step = 0.5 * (to - l);
      }
    }
    return {at_.S, uv_of(l), nearest};
  }

 private:
  using Derivatives = surface::Derivatives;

  Vec2 uv_of(const Vec2& l) const { return origin_ + l.x() * b_ + l.y() * c_; }
  Vec3 first(const Vec2& way) const { return at_.Su * way.x() + at_.Sv * way.y(); }
  double length_of(const Vec2& step) const { return first(step.x() * b_ + step.y() * c_).norm(); }

  double look_at(const Vec2& l) {
    const Vec2 uv = uv_of(l);
    at_ = surface_.derivatives(uv.x(), uv.y());
    return (point_ - at_.S).norm();
  }

  /// Second derivative of the position along two ways in the parameters.
  Vec3 second(const Vec2& a, const Vec2& b) const {
    return at_.Suu * (a.x() * b.x()) + at_.Suv * (a.x() * b.y() + a.y() * b.x()) + at_.Svv * (a.y() * b.y());
  }

  /// From a place of the triangle; 0 where it is the nearest as far as derivatives tell.
  Vec2 next_step(const Vec2& l) const {
    const Vec3 off = point_ - at_.S, B = first(b_), C = first(c_);
    const Vec2 fall(off.dot(B), off.dot(C));
    const Eigen::Matrix2d straight{{B.dot(B), B.dot(C)}, {B.dot(C), C.dot(C)}};
    const Eigen::Matrix2d bent{{off.dot(second(b_, b_)), off.dot(second(b_, c_))},
                               {off.dot(second(b_, c_)), off.dot(second(c_, c_))}};
    Eigen::Matrix2d H = straight - bent;
    const auto definite = [](const Eigen::Matrix2d& m) {
      return m(0, 0) > 0.0 && m.determinant() > kDefiniteShare * m(0, 0) * m(1, 1);
    };
    if (!definite(H)) H = straight;
    if (!definite(H)) return Vec2::Zero();
    const Vec2 step = H.inverse() * fall;
    std::array<bool, 3> blocked{};
    bool any = false;
    for (size_t k = 0; k < 3; ++k) {
      blocked[k] = share_of_corner(l, k) <= kOnFootSide && kIntoTriangle[k].dot(step) < 0.0;
      any = any || blocked[k];
    }
    if (!any) return step;
    // Along a side that holds the place, the one that brings more.
    Vec2 best = Vec2::Zero();
    double gain = 0.0;
    for (size_t k = 0; k < 3; ++k) {
      if (share_of_corner(l, k) > kOnFootSide) continue;
      const double slope = fall.dot(kAlongSide[k]), curve = kAlongSide[k].dot(H * kAlongSide[k]);
      const Vec2 along = slope / curve * kAlongSide[k];
      bool leaves = false;
      for (size_t other = 0; other < 3; ++other)
        leaves = leaves || (other != k && share_of_corner(l, other) <= kOnFootSide &&
                            kIntoTriangle[other].dot(along) < 0.0);
      if (leaves || !(slope * slope / curve > gain)) continue;
      gain = slope * slope / curve;
      best = along;
    }
    return best;
  }

  /// As far as the triangle reaches.
  static Vec2 clipped(const Vec2& l, const Vec2& step) {
    double part = 1.0;
    size_t side = 3;
    for (size_t k = 0; k < 3; ++k) {
      const double change = kIntoTriangle[k].dot(step);
      if (change >= 0.0 || share_of_corner(l, k) + part * change >= 0.0) continue;
      part = std::max(0.0, share_of_corner(l, k)) / -change;
      side = k;
    }
    Vec2 to = l + part * step;
    if (side == 1 || side == 2) to[static_cast<Eigen::Index>(side) - 1] = 0.0;
    to = to.cwiseMax(0.0);
    return to / std::max(1.0, to.sum());
  }

  const surface::Surface& surface_;
  const Vec2 origin_, b_, c_;
  const Vec3 point_;
  Derivatives at_;
};

}  // namespace

SurfaceFoot surface_foot(const surface::Surface& surface, const std::array<Vec2, 3>& uv, const Vec2& start,
                         const Vec3& point) {
  return FootSearch(surface, uv, point).find(start);
}

}  // namespace swarf::stock
