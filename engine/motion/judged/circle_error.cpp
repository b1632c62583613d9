#include "motion/judged/circle_error.h"

#include <algorithm>
#include <cmath>

#include "base/minima.h"
#include "base/units.h"

namespace swarf::motion {
namespace {

/// Points are on the circle when they miss it by no more than this, mm: what six decimals of the points and
/// the circle through three of them leave, with room. Below any tolerance of a part.
constexpr double kOnCircle = 1e-3;
constexpr size_t kBlocksMin = 8;
/// The distance is sampled at this many places of a block; its greatest is then refined between neighbours.
constexpr int kCircleNodes = 32;

struct Circle {
  Vec3 centre, normal;
  double radius = 0.0;

  double distance(const Vec3& p) const {
    const Vec3 gap = p - centre;
    const double height = gap.dot(normal);
    return std::hypot(height, (gap - height * normal).norm() - radius);
  }
};

std::optional<Circle> circle_through(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, n = ab.cross(ac);
  const double n2 = n.squaredNorm();
  if (n2 <= 1e-18 * ab.squaredNorm() * ac.squaredNorm() || n2 == 0.0) return std::nullopt;
  const Vec3 to_centre = (ac.squaredNorm() * n.cross(ab) + ab.squaredNorm() * ac.cross(n)) / (2.0 * n2);
  return Circle{a + to_centre, n.normalized(), to_centre.norm()};
}

/// The points of a run of blocks, each beginning where the last one ended.
class Points {
 public:
  Points(const BlockMotions& motions, std::span<const int> elements)
      : motions_(motions), elements_(elements) {}

  size_t blocks() const { return elements_.size(); }
  BlockMotion motion(size_t block) const { return motions_[static_cast<size_t>(elements_[block])]; }
  /// Point `i` of a run that begins with block `first`.
  Vec3 at(size_t first, size_t i) const {
    return i == 0 ? motion(first).block.from.tip_W : motion(first + i - 1).block.to.tip_W;
  }
  bool joined(size_t block) const {
    return elements_[block] == elements_[block - 1] + 1 && motion(block).machine == motion(block - 1).machine;
  }

 private:
  const BlockMotions& motions_;
  std::span<const int> elements_;
};

double angle_on(const Circle& circle, double chord) {
  return 2.0 * std::asin(std::min(1.0, 0.5 * chord / circle.radius));
}

/// How many blocks from `first` stay on the circle of the first three points; 0 when they are too few or
/// turn by less than a quarter, which a straight row with rounded points does too.
size_t run_length(const Points& points, size_t first) {
  if (first + kBlocksMin > points.blocks()) return 0;
  const auto circle = circle_through(points.at(first, 0), points.at(first, 1), points.at(first, 2));
  if (!circle) return 0;
  size_t blocks = 0;
  double turn = 0.0;
  while (first + blocks < points.blocks() && (blocks == 0 || points.joined(first + blocks)) &&
         circle->distance(points.at(first, blocks + 1)) <= kOnCircle) {
    turn += angle_on(*circle, (points.at(first, blocks + 1) - points.at(first, blocks)).norm());
    ++blocks;
  }
  return blocks >= kBlocksMin && turn >= 0.5 * kPi ? blocks : 0;
}

/// Three points far apart carry the circle of a run better than its first three.
std::optional<Circle> circle_of(const Points& points, size_t first, size_t blocks) {
  return circle_through(points.at(first, 0), points.at(first, blocks / 3), points.at(first, 2 * blocks / 3));
}

void look_along(const BlockMotion& motion, const Circle& circle, int element, CircleError& error) {
  const auto at = [&](double u) {
    const kinematics::AxisValues q = motion.q_from + u * (motion.q_to - motion.q_from);
    return circle.distance(kinematics::forward(*motion.machine, q).tip_W);
  };
  const Minimum greatest = greatest_sampled(at, 0.0, 1.0, kCircleNodes);
  if (greatest.value <= error.value_mm) return;
  error.value_mm = greatest.value;
  error.u = greatest.at;
  error.element = element;
}

}  // namespace

std::optional<CircleError> circle_error(const BlockMotions& motions, std::span<const int> elements) {
  const Points points(motions, elements);
  size_t longest = 0, first = 0;
  for (size_t i = 0; i < points.blocks();) {
    const size_t blocks = run_length(points, i);
    if (blocks > longest) {
      longest = blocks;
      first = i;
    }
    i += std::max<size_t>(1, blocks);
  }
  if (longest == 0) return std::nullopt;
  const auto circle = circle_of(points, first, longest);
  if (!circle) return std::nullopt;
  CircleError error;
  error.first = elements[first];
  error.last = elements[first + longest - 1];
  error.radius_mm = circle->radius;
  for (size_t i = 0; i < longest; ++i) {
    const double angle = angle_on(*circle, (points.at(first, i + 1) - points.at(first, i)).norm());
    error.chord_mm = std::max(error.chord_mm, circle->radius * (1.0 - std::cos(0.5 * angle)));
    look_along(points.motion(first + i), *circle, elements[first + i], error);
  }
  return error;
}

}  // namespace swarf::motion
