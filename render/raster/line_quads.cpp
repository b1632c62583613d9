#include "render/raster/line_quads.h"

#include <algorithm>

namespace swarf::render {
namespace {

using Eigen::Vector4d;

constexpr double kNearMargin = 1e-6;  // of w: keeps the division away from zero behind the near plane
constexpr double kTowardsEye = 2e-4;  // of the depth range: lifts lines off the surface they lie on

/// Cuts the segment at the near plane z = -w; false when all of it lies in front of that plane.
bool clip_near(Vector4d& a, Vector4d& b) {
  const double da = a.z() + a.w(), db = b.z() + b.w();
  if (da <= kNearMargin && db <= kNearMargin) return false;
  if (da < kNearMargin) a += (b - a) * ((kNearMargin - da) / (db - da));
  if (db < kNearMargin) b += (a - b) * ((kNearMargin - db) / (da - db));
  return true;
}

void add_segment(Vector4d a, Vector4d b, const DrawLine& line, const Eigen::Array2d& half_size,
                 std::vector<LineVertex>& quads) {
  if (!clip_near(a, b)) return;
  const Vec3 pa = a.head<3>() / a.w(), pb = b.head<3>() / b.w();
  const Vec2 along_px = ((pb - pa).head<2>().array() * half_size).matrix();
  const double length_px = along_px.norm();
  const Vec2 unit = length_px > 0.0 ? Vec2(along_px / length_px) : Vec2(1.0, 0.0);
  // Half a width longer at each end, so that corners of a polyline have no gap.
  const Vec2 forward = (unit.array() * (0.5 * line.width_px) / half_size).matrix();
  const Vec2 side = (Vec2(-unit.y(), unit.x()).array() * (0.5 * line.width_px) / half_size).matrix();
  const auto corner = [&](const Vec3& p, const Vec2& offset) {
    return LineVertex{{static_cast<float>(p.x() + offset.x()), static_cast<float>(p.y() + offset.y()),
                       static_cast<float>(std::max(p.z() - kTowardsEye, -1.0))},
                      {line.colour[0], line.colour[1], line.colour[2]}};
  };
  const LineVertex a0 = corner(pa, -forward - side), a1 = corner(pa, -forward + side);
  const LineVertex b0 = corner(pb, forward - side), b1 = corner(pb, forward + side);
  quads.insert(quads.end(), {a0, b0, b1, a0, b1, a1});
}

}  // namespace

std::vector<LineVertex> line_quads(const std::vector<DrawLine>& lines, const Eigen::Matrix4d& clip_from_world,
                                   int width, int height) {
  const Eigen::Array2d half_size(0.5 * width, 0.5 * height);
  std::vector<LineVertex> quads;
  for (const DrawLine& line : lines) {
    for (size_t i = 1; i < line.points.size(); ++i) {
      add_segment(clip_from_world * line.points[i - 1].homogeneous(),
                  clip_from_world * line.points[i].homogeneous(), line, half_size, quads);
    }
  }
  return quads;
}

}  // namespace swarf::render
