#include "reports/singularity_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/units.h"
#include "reports/html.h"
#include "reports/svg_plot.h"

namespace swarf::reports {
namespace {

using kinematics::BlockEnds;
using motion::BlockSingularity;

/// Of a drawing, in its own units: half the page and all of it.
constexpr double kHalfWidth = 540.0, kFullWidth = 1120.0;
constexpr double kMargin = 46.0;

/// Two coordinates of a tip: along the programmed line and across it, in the plane that the outer axis turns.
class LineView {
 public:
  LineView(const BlockEnds& ends, const Vec3& outer_W) : origin_(ends.from.tip_W) {
    const Vec3 way = ends.to.tip_W - ends.from.tip_W;
    const Vec3 in_plane = way - way.dot(outer_W) * outer_W;
    along_ =
        in_plane.norm() > 1e-9 * (1.0 + way.norm()) ? Vec3(in_plane.normalized()) : outer_W.unitOrthogonal();
    across_ = outer_W.cross(along_);
  }
  Vec2 operator()(const Vec3& tip_W) const {
    return {(tip_W - origin_).dot(along_), (tip_W - origin_).dot(across_)};
  }

 private:
  Vec3 origin_, along_, across_;
};

/// A drawing with one scale for both directions.
class Canvas {
 public:
  Canvas(const Vec2& low, const Vec2& high, double width, double height_max)
      : width_(width),
        scale_(std::min((width - 2.0 * kMargin) / (high - low).x(),
                        (height_max - 2.0 * kMargin) / (high - low).y())),
        height_(2.0 * kMargin + scale_ * (high - low).y()),
        centre_(0.5 * (low + high)) {}

  Vec2 pixel(const Vec2& p) const {
    return {0.5 * width_ + scale_ * (p.x() - centre_.x()), 0.5 * height_ - scale_ * (p.y() - centre_.y())};
  }

  void path(const char* css_class, const std::vector<Vec2>& points, bool closed = false) {
    body_ += fmt::format(R"(<path class="{}" d="M)", css_class);
    for (const Vec2& point : points) {
      const Vec2 p = pixel(point);
      body_ += fmt::format("{:.2f} {:.2f} ", p.x(), p.y());
    }
    body_ += closed ? "Z\"/>" : "\"/>";
  }
  void circle(const char* css_class, const Vec2& centre, double radius) {
    const Vec2 p = pixel(centre);
    body_ += fmt::format(R"(<circle class="{}" cx="{:.2f}" cy="{:.2f}" r="{:.2f}"/>)", css_class, p.x(),
                         p.y(), scale_ * radius);
  }
  /// A dot with a word beside it, `shift` in the drawing's own units from the dot.
  void point(const char* css_class, const Vec2& at, const std::string& word, const Vec2& shift,
             const char* anchor = "start") {
    const Vec2 p = pixel(at);
    body_ +=
        fmt::format(R"(<g class="{}"><circle cx="{:.2f}" cy="{:.2f}" r="3.4"/>)", css_class, p.x(), p.y());
    text_at(p + shift, word, anchor);
    body_ += "</g>";
  }
  void text(const Vec2& at, const std::string& word, const Vec2& shift, const char* anchor) {
    text_at(pixel(at) + shift, word, anchor);
  }
  void open(const char* css_class) { body_ += fmt::format(R"(<g class="{}">)", css_class); }
  void close() { body_ += "</g>"; }

  std::string svg(const std::string& spoken) const {
    return fmt::format(
        R"(<svg class="drawing" viewBox="0 0 {:.0f} {:.0f}" role="img" aria-label="{}">{}</svg>)", width_,
        height_, escape(spoken), body_);
  }

 private:
  void text_at(const Vec2& p, const std::string& word, const char* anchor) {
    body_ += fmt::format(R"(<text x="{:.2f}" y="{:.2f}" text-anchor="{}">{}</text>)", p.x(), p.y(), anchor,
                         escape(word));
  }

  double width_, scale_, height_;
  Vec2 centre_;
  std::string body_;
};

/// Ticks of both directions, below and to the left of what is drawn.
void draw_scales(Canvas& canvas, const Vec2& low, const Vec2& high) {
  const Ticks x = round_ticks(low.x(), high.x(), 7), y = round_ticks(low.y(), high.y(), 4);
  const double step = std::max(x.step, y.step);
  const auto inside = [](double tick, double from, double to) { return tick >= from && tick <= to; };
  canvas.open("grid");
  for (double tick = std::ceil(low.x() / step) * step; tick <= high.x(); tick += step)
    canvas.path("tick", {{tick, low.y()}, {tick, high.y()}});
  for (double tick = std::ceil(low.y() / step) * step; tick <= high.y(); tick += step)
    canvas.path("tick-y", {{low.x(), tick}, {high.x(), tick}});
  canvas.close();
  for (double tick = std::ceil(low.x() / step) * step; inside(tick, low.x(), high.x()); tick += step)
    canvas.text({tick, low.y()}, tick_text(tick, step), {0.0, 18.0}, "middle");
  for (double tick = std::ceil(low.y() / step) * step; inside(tick, low.y(), high.y()); tick += step)
    canvas.text({low.x(), tick}, tick_text(tick, step), {-8.0, 4.0}, "end");
  canvas.text({high.x(), low.y()}, "along the programmed line (mm)", {0.0, 36.0}, "end");
  canvas.text({low.x(), high.y()}, "across it (mm)", {-38.0, -12.0}, "start");
}

/// A line from a point of the trajectory to what its distance is measured from.
void draw_measure(Canvas& canvas, const Vec2& from, const Vec2& to, const std::string& word,
                  const Vec2& shift, const char* anchor) {
  canvas.open("measure");
  canvas.path("dimension", {from, to});
  canvas.text(from, word, shift, anchor);
  canvas.close();
}

/// Where a word stands beside a point: away from `middle`.
struct Beside {
  Vec2 shift;
  const char* anchor;
};
Beside beside(const Vec2& point, const Vec2& middle) {
  const Vec2 gap = point - middle;
  const Vec2 d = gap.norm() > 0.0 ? Vec2(gap.normalized()) : Vec2(Vec2::UnitY());
  return {{12.0 * d.x(), -14.0 * d.y() + 4.0}, d.x() > 0.4 ? "start" : d.x() < -0.4 ? "end" : "middle"};
}

}  // namespace

Figure trajectory_figure(const BlockSingularity& block, const papers::BlockStudy& study) {
  const BlockEnds& ends = block.ends;
  const LineView view(ends, study.outer_W);
  std::vector<Vec2> real, analytic;
  Vec2 low = view(ends.from.tip_W).cwiseMin(view(ends.to.tip_W));
  Vec2 high = view(ends.from.tip_W).cwiseMax(view(ends.to.tip_W));
  for (size_t i = 0; i < study.tip_W.size(); ++i) {
    real.push_back(view(study.tip_W[i]));
    analytic.push_back(view(study.analytic_W[i]));
    low = low.cwiseMin(real.back());
    high = high.cwiseMax(real.back());
  }
  const Vec2 centre =
      std::accumulate(real.begin(), real.end(), Vec2(Vec2::Zero())) / static_cast<double>(real.size());
  const double extent = (high - low).maxCoeff();
  low -= Vec2::Constant(0.06 * extent);
  high += Vec2(0.36, 0.12) * extent;  // the words stand above and to the right
  Canvas canvas(low, high, kFullWidth, 560.0);
  draw_scales(canvas, low, high);
  const Vec2 p0 = view(ends.from.tip_W), p1 = view(ends.to.tip_W);
  canvas.path("programmed", {p0, p1});
  canvas.path("series s0", real);
  canvas.path("dots", analytic);

  const Vec2 farthest = view(study.farthest_line_W);
  const double side = farthest.y() < 0.0 ? -1.0 : 1.0;  // on which side of the line it bulges
  draw_measure(
      canvas, farthest, {farthest.x(), 0.0},
      fmt::format("{:.6f} mm from the line (u = {:.4f})", block.error.line.value, block.error.line.u),
      {0.0, side > 0.0 ? -12.0 : 20.0}, "end");
  const Vec2 out = view(study.farthest_segment_W), way = p1 - p0;
  const double share = way.norm() > 0.0 ? (out - p0).dot(way) / way.squaredNorm() : 0.0;
  draw_measure(canvas, out, p0 + std::clamp(share, 0.0, 1.0) * way,
               fmt::format("{:.6f} mm from the segment (u = {:.4f})", block.error.segment.value,
                           block.error.segment.u),
               {10.0, 5.0}, "start");
  for (const double u : {0.25, 0.5, 0.75}) {
    const Vec2 at = real[static_cast<size_t>(u * papers::BlockStudy::kParts)];
    const Beside place = beside(at, centre);
    canvas.point("mark", at, fmt::format("u = {:g}", u), place.shift, place.anchor);
  }
  canvas.point("point", p0, "P0", {0.0, side * 20.0}, "middle");
  canvas.point("point", p1, "P1", {0.0, side * 20.0}, "middle");

  Figure figure;
  figure.wide = true;
  figure.title = "Fig. 9: the block's real path, the analytic one and the programmed line";
  figure.svg =
      canvas.svg(fmt::format("The tip leaves its line of {:.3f} mm by {:.3f} mm sideways and passes its "
                             "end by {:.3f} mm.",
                             block.error.chord_mm, block.error.line.value, block.error.beyond.value));
  figure.caption =
      "Seen along the outer rotary axis, one scale for both directions. The distance to the infinite line "
      "hides "
      "how far the tip goes beyond the ends; the distance to the segment does not (E15).";
  figure.legend = {{"programmed", "programmed line"},
                   {"series s0", "real path, axes linear"},
                   {"dots", "analytic, Eq. (3) corrected"}};
  return figure;
}

Figure pole_figure(const BlockSingularity& block, const papers::BlockStudy& study) {
  const Vec3& pole = study.pole_W;
  const Vec3 seed = std::abs(pole.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 x = (seed - seed.dot(pole) * pole).normalized(), y = pole.cross(x);
  const auto polar = [&](const Vec3& axis_W) -> Vec2 {
    const Vec2 in_plane(axis_W.dot(x), axis_W.dot(y));
    const double sine = in_plane.norm(), beta = std::atan2(sine, axis_W.dot(pole));
    return sine > 0.0 ? Vec2(deg_from_rad(beta) / sine * in_plane) : Vec2(Vec2::Zero());
  };
  std::vector<Vec2> joint, great_circle;
  double farthest = deg_from_rad(block.pole.cone_rad) < 20.0 ? deg_from_rad(block.pole.cone_rad) : 0.0;
  for (size_t i = 0; i < study.axis_W.size(); ++i) {
    joint.push_back(polar(study.axis_W[i]));
    great_circle.push_back(polar(study.tcp_axis_W[i]));
    farthest = std::max({farthest, joint.back().norm(), great_circle.back().norm()});
  }
  const Ticks rings = round_ticks(0.0, farthest, 4);
  const double rim = rings.values.back();
  Canvas canvas(Vec2::Constant(-rim), Vec2::Constant(rim), kHalfWidth, 500.0);
  canvas.open("grid");
  for (const double ring : rings.values) {
    if (ring > 0.0) canvas.circle("ring", Vec2::Zero(), ring);
  }
  for (int spoke = 0; spoke < 12; ++spoke) {
    const double angle = spoke * kPi / 6.0;
    canvas.path("spoke", {Vec2::Zero(), rim * Vec2(std::cos(angle), std::sin(angle))});
  }
  canvas.close();
  const std::array<std::pair<Vec2, const char*>, 4> ends_of_axes{
      {{{rim, 0}, "0°"}, {{0, rim}, "90°"}, {{-rim, 0}, "180°"}, {{0, -rim}, "270°"}}};
  canvas.text(ends_of_axes[0].first, ends_of_axes[0].second, {8.0, 4.0}, "start");
  canvas.text(ends_of_axes[1].first, ends_of_axes[1].second, {0.0, -8.0}, "middle");
  canvas.text(ends_of_axes[2].first, ends_of_axes[2].second, {-8.0, 4.0}, "end");
  canvas.text(ends_of_axes[3].first, ends_of_axes[3].second, {0.0, 18.0}, "middle");
  if (block.pole.cone_rad > 0.0 && deg_from_rad(block.pole.cone_rad) <= rim)
    canvas.circle("cone", Vec2::Zero(), deg_from_rad(block.pole.cone_rad));
  canvas.path("turn", great_circle);
  canvas.path("series s0", joint);
  // The rings' numbers stand away from the path, on the far side of the pole.
  const Vec2 middle = joint[joint.size() / 2];
  const Vec2 away = middle.norm() > 0.0 ? Vec2(-middle.normalized()) : Vec2(Vec2::UnitX());
  for (const double ring : rings.values) {
    if (ring > 0.0) canvas.text(ring * away, tick_text(ring, rings.step) + "°", {0.0, 4.0}, "middle");
  }
  const auto outward = [&](const Vec2& p) -> Vec2 {
    const Vec2 d = p.norm() > 0.0 ? Vec2(p.normalized()) : Vec2(Vec2::UnitX());
    return {14.0 * d.x(), -14.0 * d.y() + 4.0};
  };
  canvas.point("point", joint.front(), "P0", outward(joint.front()), "middle");
  canvas.point("point", joint.back(), "P1", outward(joint.back()), "middle");
  canvas.point("point", Vec2::Zero(), "pole", {8.0, 16.0}, "start");

  Figure figure;
  figure.title = "The tool axis around the pole";
  figure.svg = canvas.svg(fmt::format("The tool axis stays {:.3f} degrees away from the pole at least.",
                                      deg_from_rad(block.pole.pole_distance_rad)));
  figure.caption = fmt::format(
      "Distance from the pole outwards, azimuth of the tool axis in the work frame around. Inside the "
      "singular "
      "cone of {:.2f} deg the outer rotary axis is slower than the block's feed would need.",
      deg_from_rad(block.pole.cone_rad));
  figure.legend = {{"series s0", "axes linear"}, {"turn", "great circle (tcp)"}, {"cone", "singular cone"}};
  return figure;
}

}  // namespace swarf::reports
