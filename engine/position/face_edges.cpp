#include "position/face_edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/diagnostics.h"

namespace swarf::position {
namespace {

/// The part of a segment within the unit square.
std::optional<EdgeSpan> within_square(const EdgeSpan& span) {
  const Vec2 way = span.to - span.from;
  double first = 0.0, last = 1.0;
  for (int i = 0; i < 2; ++i) {
    if (way[i] == 0.0) {
      if (span.from[i] < 0.0 || span.from[i] > 1.0) return std::nullopt;
      continue;
    }
    const double low = -span.from[i] / way[i], high = (1.0 - span.from[i]) / way[i];
    first = std::max(first, std::min(low, high));
    last = std::min(last, std::max(low, high));
  }
  if (first > last) return std::nullopt;
  const auto at = [&](double t) -> Vec2 {
    return (span.from + t * way).cwiseMax(Vec2::Zero()).cwiseMin(Vec2::Ones());
  };
  return EdgeSpan{span.patch, first > 0.0 ? at(first) : span.from, last < 1.0 ? at(last) : span.to};
}

/// Proven: how far the curve of the span leaves its chord, mm.
double chord_of(const surface::Surface& surface, const EdgeSpan& span) {
  const Vec2 way = (span.to - span.from).cwiseAbs();
  const surface::BendBounds bend =
      surface.bend_bounds(span.from.cwiseMin(span.to), span.from.cwiseMax(span.to));
  return 0.125 * (way.x() * way.x() * bend.uu.most() + 2.0 * way.x() * way.y() * bend.uv.most() +
                  way.y() * way.y() * bend.vv.most());
}

class EdgeMaker {
 public:
  explicit EdgeMaker(size_t most) : most_(most) {}

  void add_face(const surface::Face& face, int patch) {
    for (const surface::TrimLoop& loop : face.loops) {
      for (size_t i = 0; i < loop.size(); ++i)
        add({patch, loop[i], loop[(i + 1) % loop.size()]}, *face.surface);
    }
    if (!face.loops.empty()) add_border(face, patch);
  }
  FaceEdges take() { return std::move(edges_); }

 private:
  void add(const EdgeSpan& whole, const surface::Surface& surface) {
    const std::optional<EdgeSpan> span = within_square(whole);
    if (span) divide(*span, surface, 0);
  }
  void divide(const EdgeSpan& span, const surface::Surface& surface, int depth) {
    constexpr int kDeepest = 40;
    if (depth < kDeepest && chord_of(surface, span) > kEdgeChord_mm) {
      const Vec2 middle = 0.5 * (span.from + span.to);
      divide({span.patch, span.from, middle}, surface, depth + 1);
      divide({span.patch, middle, span.to}, surface, depth + 1);
      return;
    }
    if (edges_.spans.size() >= most_) refuse(span.patch);
    const auto first = static_cast<uint32_t>(edges_.mesh.positions.size());
    for (const Vec2& uv : {span.from, span.to}) {
      const Vec3 p = surface.point(uv.x(), uv.y());
      edges_.mesh.positions.push_back(
          {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    }
    edges_.mesh.triangles.push_back({first, first + 1, first + 1});
    edges_.spans.push_back(span);
  }
  [[noreturn]] void refuse(int patch) const {
    throw InputError("too-many-edges", {},
                     fmt::format("the loops up to face {} need more than {} straight edges within {:g} mm",
                                 patch, most_, kEdgeChord_mm),
                     "export the part with plainer edges, or a part of it");
  }

  /// Where the square ends inside the loops the face ends as well.
  void add_border(const surface::Face& face, int patch) {
    const surface::FaceDomain domain(face);
    constexpr std::array<std::array<double, 4>, 4> kSides{
        {{0, 0, 1, 0}, {1, 0, 1, 1}, {1, 1, 0, 1}, {0, 1, 0, 0}}};
    for (const auto& side : kSides) {
      const Vec2 from(side[0], side[1]), to(side[2], side[3]);
      const std::vector<double> stops = crossings(face, from, to);
      for (size_t i = 0; i + 1 < stops.size(); ++i) {
        const double middle = 0.5 * (stops[i] + stops[i + 1]);
        if (stops[i] < stops[i + 1] && domain.inside(from + middle * (to - from)))
          add({patch, from + stops[i] * (to - from), from + stops[i + 1] * (to - from)}, *face.surface);
      }
    }
  }
  /// Where loops meet the side, as parts of it from 0 to 1; sorted.
  static std::vector<double> crossings(const surface::Face& face, const Vec2& from, const Vec2& to) {
    const Vec2 along = to - from, across(-along.y(), along.x());
    std::vector<double> stops{0.0, 1.0};
    const auto stop = [&](double part) {
      if (part > 0.0 && part < 1.0) stops.push_back(part);
    };
    for (const surface::TrimLoop& loop : face.loops) {
      for (size_t i = 0; i < loop.size(); ++i) {
        const Vec2 a = loop[i] - from, b = loop[(i + 1) % loop.size()] - from;
        const double ya = a.dot(across), yb = b.dot(across);
        if (ya == 0.0) stop(a.dot(along));
        if ((ya < 0.0) != (yb < 0.0)) stop((a + ya / (ya - yb) * (b - a)).dot(along));
      }
    }
    std::sort(stops.begin(), stops.end());
    return stops;
  }

  size_t most_;
  FaceEdges edges_;
};

}  // namespace

FaceEdges face_edges(const std::vector<surface::Face>& faces, size_t most) {
  EdgeMaker maker(most);
  for (size_t i = 0; i < faces.size(); ++i) maker.add_face(faces[i], static_cast<int>(i));
  return maker.take();
}

}  // namespace swarf::position
