#include "render/figures/tool_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/units.h"
#include "mesh/mesh_ops.h"
#include "render/figures/figure_mesh.h"

namespace swarf::render {
namespace {

constexpr double kHelixRad = rad_from_deg(30.0);
constexpr double kToolCreaseRad = rad_from_deg(55.0);
/// Share of the flute length over which the gullets run out into the shank.
constexpr double kRunOut = 0.22;

struct SectionPoint {
  double turn;    ///< share of the flute's sector, from the cutting edge backwards
  double radius;  ///< share of the cutter's radius
};

/// One flute's sector of the cross-section: margin, relief, gullet, rake face.
constexpr std::array<SectionPoint, 12> kSection{{{0.00, 1.000},
                                                 {0.06, 0.996},
                                                 {0.12, 0.985},
                                                 {0.26, 0.945},
                                                 {0.38, 0.900},
                                                 {0.50, 0.800},
                                                 {0.60, 0.700},
                                                 {0.70, 0.620},
                                                 {0.79, 0.585},
                                                 {0.87, 0.615},
                                                 {0.93, 0.700},
                                                 {0.975, 0.860}}};
/// Depth of the gullets at height z: 1 along the flutes, falling smoothly to 0 at their end.
double gullet_depth(double z, double flute_length) {
  const double t = std::clamp((flute_length - z) / (kRunOut * flute_length), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// The thinnest place of the section.
constexpr double kGround = 0.585;

/// Rings of equally many points, stacked from the tip upwards and joined as they come.
class RingStack {
 public:
  explicit RingStack(int flutes)
      : around_(static_cast<uint32_t>(flutes * kSection.size())), flutes_(flutes) {}

  /// `depth`: 1 with full gullets, 0 round. A ring where the last one was is left out.
  void ring(const Vec2& at, double depth, double turn_rad) {
    if (rings_ > 0 && at == last_) return;
    const auto first = static_cast<uint32_t>(mesh_.positions.size());
    for (uint32_t k = 0; k < around_; ++k) {
      const SectionPoint& s = kSection[k % kSection.size()];
      // Seen from the shank, a right-hand cutter turns clockwise, towards smaller angles: the edge leads at
      // the smaller end of its sector and margin, relief and gullet follow at larger angles.
      const double sector = std::floor(static_cast<double>(k) / kSection.size());
      const double angle = turn_rad + (sector + s.turn) * 2.0 * kPi / flutes_;
      const double r = at.x() * (1.0 - depth * (1.0 - s.radius));
      mesh_.positions.push_back({static_cast<float>(r * std::cos(angle)),
                                 static_cast<float>(r * std::sin(angle)), static_cast<float>(at.y())});
    }
    if (rings_++ > 0) join(first - around_, first);
    last_ = at;
  }
  /// Closes the last ring by a fan about a point of the axis; `up` for the top end.
  void cap(double z, bool up) {
    const auto centre = static_cast<uint32_t>(mesh_.positions.size());
    const uint32_t ring = up ? centre - around_ : 0;
    mesh_.positions.push_back({0.0F, 0.0F, static_cast<float>(z)});
    for (uint32_t k = 0; k < around_; ++k) {
      const uint32_t next = (k + 1) % around_;
      mesh_.triangles.push_back(up ? std::array{centre, ring + k, ring + next}
                                   : std::array{centre, ring + next, ring + k});
    }
  }
  const Vec2& last() const { return last_; }
  TriMesh& mesh() { return mesh_; }

 private:
  void join(uint32_t low, uint32_t high) {
    for (uint32_t k = 0; k < around_; ++k) {
      const uint32_t next = (k + 1) % around_;
      mesh_.triangles.push_back({low + k, low + next, high + next});
      mesh_.triangles.push_back({low + k, high + next, high + k});
    }
  }

  TriMesh mesh_;
  uint32_t around_;
  int flutes_;
  int rings_ = 0;
  Vec2 last_ = Vec2::Zero();
};

/// The outline with points no farther apart than `step`, without those on the axis; a level end is not
/// divided.
std::vector<Vec2> close_points(const std::vector<Vec2>& outline, double step) {
  std::vector<Vec2> points;
  for (size_t i = 1; i < outline.size(); ++i) {
    const Vec2 along = outline[i] - outline[i - 1];
    const int pieces = along.y() == 0.0 ? 1 : std::max(1, static_cast<int>(std::ceil(along.norm() / step)));
    for (int k = 1; k <= pieces; ++k) {
      const Vec2 p = k == pieces ? outline[i] : Vec2(outline[i - 1] + along * k / pieces);
      if (p.x() > 1e-3 * step) points.push_back(p);
    }
  }
  return points;
}

}  // namespace

TriMesh tool_mesh(const ToolFigure& figure) {
  SWARF_CHECK(figure.flutes.size() >= 2 && figure.flute_count >= 1, "the outline of a cutter");
  double radius = 0.0;
  for (const Vec2& p : figure.flutes) radius = std::max(radius, p.x());
  const Vec2 end = figure.flutes.back();
  const double twist_per_mm = std::tan(kHelixRad) / radius;
  const bool runs_out = figure.above.empty() || figure.above.front().x() >= kGround * end.x();
  RingStack stack(figure.flute_count);
  for (const Vec2& p : close_points(figure.flutes, std::min(0.1 * radius, end.y() / 8.0))) {
    stack.ring(p, runs_out ? gullet_depth(p.y(), end.y()) : 1.0, twist_per_mm * p.y());
  }
  // A level end face is dished as on a real cutter, so that only the edges touch the plane of the tip.
  const Vec2& corner = figure.flutes[1];
  const double dish = corner.y() == 0.0 ? 0.06 * corner.x() : 0.0;
  const double turn = twist_per_mm * end.y();
  for (const Vec2& p : figure.above) stack.ring(p, 0.0, turn);
  stack.cap(stack.last().y(), true);
  stack.cap(dish, false);
  mesh::compute_vertex_normals(stack.mesh(), kToolCreaseRad);
  return std::move(stack.mesh());
}

TriMesh holder_mesh(double diameter, double length) {
  SWARF_CHECK(diameter > 0.0 && length > 0.0, "size of the holder");
  const double r = 0.5 * diameter, l = length;
  const double b = std::min(0.03 * diameter, 0.02 * length);
  const std::array<Vec2, 22> profile{Vec2(0, 0),
                                     Vec2(0.52 * r - b, 0),
                                     Vec2(0.52 * r, b),
                                     Vec2(0.70 * r, 0.07 * l),
                                     Vec2(0.70 * r, 0.24 * l - b),
                                     Vec2(0.70 * r - b, 0.24 * l),
                                     Vec2(0.60 * r, 0.24 * l),
                                     Vec2(0.60 * r, 0.60 * l),
                                     Vec2(0.64 * r, 0.66 * l),
                                     Vec2(0.72 * r, 0.70 * l),
                                     Vec2(r - b, 0.70 * l),
                                     Vec2(r, 0.70 * l + b),
                                     Vec2(r, 0.77 * l - b),
                                     Vec2(r - b, 0.77 * l),
                                     Vec2(0.86 * r, 0.80 * l),
                                     Vec2(0.86 * r, 0.85 * l),
                                     Vec2(r - b, 0.88 * l),
                                     Vec2(r, 0.88 * l + b),
                                     Vec2(r, l - b),
                                     Vec2(r - b, l),
                                     Vec2(0.5 * r, l),
                                     Vec2(0, l)};
  return revolved_profile(profile, 96);
}

}  // namespace swarf::render
