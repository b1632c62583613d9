#include "reports/section_still.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "base/units.h"
#include "mesh/mesh_ops.h"
#include "render/camera.h"
#include "render/figures/colour.h"
#include "render/lettering.h"
#include "reports/design_view.h"
#include "reports/mesh_section.h"
#include "reports/part_view.h"
#include "reports/pictures.h"

namespace swarf::reports {
namespace {

constexpr double kRoom =
    1.5;  // times the distance that the part needs: legend, scale and bar stand beside it
constexpr double kOffWallsVoxels = 0.05;
constexpr double kEdgeOn = 0.02;        // sine of the least angle between the line of sight and the plane
constexpr double kWhiskerShare = 0.06;  // of the picture's width: the longest line of a deviation at most
constexpr double kAlongNormal = 0.1;    // of a ray's normal, in the plane at least: else no line shows it
constexpr render::Rgb kPartLine{0.012F, 0.013F, 0.016F};
constexpr render::Rgb kDesignLine{0.02F, 0.62F, 0.95F};
constexpr float kDesignTube = 1.5F;  // px: of the design on a machine that is cut open
constexpr double kPartWidth = 0.2, kDesignWidth = 0.07, kWhiskerWidth = 0.08;  // of the height of text

/// Of rays whose heights differ by less than this the first is named: rounding does not choose the place; mm.
constexpr double kAlike = 1e-9;

/// A measuring ray, or what two of them say in between.
struct SectionRay {
  Vec3 foot_W = Vec3::Zero(), normal_W = Vec3::Zero();
  double height_mm = 0.0;
};

/// Of neighbouring rays that stand on either side of the plane.
struct RaysBeside {
  std::vector<SectionRay> between;            ///< in the plane
  std::optional<SectionRay> lowest, highest;  ///< of the rays themselves
  double farthest_mm = 0.0;                   ///< of the rays from the plane
};

void add_rays(const stock::SurfaceDexels& dexels, const sim::SectionPlane& plane, RaysBeside& found) {
  const auto ray = [&](uint32_t i) {
    return SectionRay{dexels.points()[i], dexels.normals()[i], dexels.heights_mm()[i]};
  };
  for (const auto& [a, b] : dexels.field().edges) {
    if (dexels.blocks()[a] == stock::kUncut || dexels.blocks()[b] == stock::kUncut) continue;
    const SectionRay one = ray(a), other = ray(b);
    const double above = plane.normal_W.dot(one.foot_W - plane.point_W);
    const double other_above = plane.normal_W.dot(other.foot_W - plane.point_W);
    if ((above < 0.0) == (other_above < 0.0)) continue;
    const double t = above / (above - other_above);
    found.between.push_back({one.foot_W + t * (other.foot_W - one.foot_W),
                             one.normal_W + t * (other.normal_W - one.normal_W),
                             one.height_mm + t * (other.height_mm - one.height_mm)});
    found.farthest_mm = std::max({found.farthest_mm, std::abs(above), std::abs(other_above)});
    for (const SectionRay& end : {one, other}) {
      if (!found.lowest || end.height_mm < found.lowest->height_mm - kAlike) found.lowest = end;
      if (!found.highest || end.height_mm > found.highest->height_mm + kAlike) found.highest = end;
    }
  }
}

RaysBeside rays_beside(const FinishedRun& run, const sim::SectionPlane& plane) {
  RaysBeside found;
  for (const stock::SurfaceDexels& dexels : run.dexels) add_rays(dexels, plane, found);
  return found;
}

/// What lies below the plane, and in it.
Box kept_box(const TriMesh& part, const sim::SectionPlane& plane) {
  Box box{Vec3::Constant(std::numeric_limits<double>::infinity()),
          Vec3::Constant(-std::numeric_limits<double>::infinity())};
  const auto add = [&](const Vec3& p) {
    box.lower = box.lower.cwiseMin(p);
    box.upper = box.upper.cwiseMax(p);
  };
  for (const auto& v : part.positions) {
    const Vec3 p(v[0], v[1], v[2]);
    if (plane.normal_W.dot(p - plane.point_W) <= 0.0) add(p);
  }
  for (const auto& ends : section_pieces(part, plane.point_W, plane.normal_W)) {
    add(ends[0]);
    add(ends[1]);
  }
  return box;
}

/// Places of the plane on the picture.
class Paper {
 public:
  Paper(const SectionView& view, const render::Image& image)
      : view_(view), width_(image.width), height_(image.height) {}
  Vec2 at(const Vec3& place) const {
    const Vec3& n = view_.plane.normal_W;
    return render::picture_place(view_.camera, place - n.dot(place - view_.plane.point_W) * n, width_,
                                 height_);
  }
  double px_per_mm() const { return render::px_per_mm_at_target(view_.camera, height_); }

 private:
  const SectionView& view_;
  int width_, height_;
};

render::Strokes outline(const TriMesh& mesh, const SectionView& view, const Paper& paper) {
  render::Strokes strokes;
  for (const auto& ends : section_pieces(mesh, view.plane.point_W, view.plane.normal_W))
    strokes.pieces.push_back({paper.at(ends[0]), paper.at(ends[1]), {}});
  return strokes;
}

void colour(render::Strokes& strokes, const render::Rgb& colour, double width, const std::string& words) {
  for (render::Strokes::Piece& piece : strokes.pieces) piece.colour = colour;
  strokes.sample = colour;
  strokes.width = width;
  strokes.words = words;
}

/// Deviations as lines on the design, along its normal as the plane shows it.
render::Strokes whiskers(const RaysBeside& rays, const SectionView& view, const Paper& paper, int width_px,
                         const render::DeviationScale& scale) {
  double most = 0.0;
  for (const SectionRay& ray : rays.between) most = std::max(most, std::abs(ray.height_mm));
  render::Strokes strokes;
  if (most == 0.0) return strokes;
  const double times =
      std::max(1.0, render::round_length(kWhiskerShare * width_px / paper.px_per_mm() / most));
  for (const SectionRay& ray : rays.between) {
    const Vec3& n = view.plane.normal_W;
    const Vec3 along = ray.normal_W - n.dot(ray.normal_W) * n;
    if (along.norm() < kAlongNormal) continue;
    strokes.pieces.push_back({paper.at(ray.foot_W),
                              paper.at(ray.foot_W + times * ray.height_mm * along.normalized()),
                              render::deviation_colour(um_from_mm(ray.height_mm), scale)});
  }
  strokes.width = kWhiskerWidth;
  strokes.words = fmt::format("deviation, {:g} times as long", times);
  strokes.sample = render::deviation_colour(scale.at(1.0), scale);
  return strokes;
}

render::Leader leader_to(const SectionRay& ray, const char* name, const Paper& paper) {
  const Vec2 at = paper.at(ray.foot_W + ray.height_mm * ray.normal_W);
  const double shown_um = std::round(100.0 * um_from_mm(ray.height_mm)) / 100.0 + 0.0;  // never -0
  return {at.x(), at.y(), fmt::format("{} {:+.2f} µm", name, shown_um)};
}

}  // namespace

namespace {

/// The plane with its normal on the side of the eye. It goes through the box, and so does the one that is
/// drawn.
sim::SectionPlane facing(const Vec3& to_eye, const sim::SectionPlane& plane, const Box& whole,
                         double voxel_mm, const SourceLocation& where) {
  const sim::SectionPlane turned{plane.point_W,
                                 plane.normal_W.dot(to_eye) < 0.0 ? Vec3(-plane.normal_W) : plane.normal_W};
  if (!sim::divides(plane, whole) || !sim::divides(off_walls(turned, voxel_mm), whole))
    throw InputError("section-misses", where,
                     fmt::format("the section {} misses the part", sim::section_words(plane)),
                     fmt::format("the part reaches {}", sim::extent_along(plane, whole)));
  return turned;
}

/// How far the eye stands above the plane, mm; enough to see it.
double seen_from(const Vec3& eye, const Vec3& to_eye, const sim::SectionPlane& plane,
                 const SourceLocation& where, const std::string& camera, const char* fix) {
  const double above = plane.normal_W.dot(eye - plane.point_W);
  if (plane.normal_W.dot(to_eye) >= kEdgeOn && above > 0.0) return above;
  throw InputError(
      "section-edge-on", where,
      fmt::format("from camera '{}' the section {} is seen edge-on", camera, sim::section_words(plane)), fix);
}

}  // namespace

sim::SectionPlane off_walls(const sim::SectionPlane& plane, double voxel_mm) {
  return {plane.point_W - kOffWallsVoxels * voxel_mm * plane.normal_W, plane.normal_W};
}

SectionView section_view(const FinishedRun& run, const TriMesh& part, const sim::SectionPlane& plane,
                         const SourceLocation& where, const std::string& camera, double vertical_fov_rad,
                         double aspect) {
  const double voxel = run.job.scene.stock.voxel_mm;
  const Vec3 to_eye = (camera.empty() ? plane.normal_W : camera_direction(camera)).normalized();
  SectionView view;
  view.asked = facing(to_eye, plane, mesh::bounds(part), voxel, where);
  view.plane = off_walls(view.asked, voxel);
  view.camera = render::look_at_box(kept_box(part, view.plane), -to_eye, vertical_fov_rad, aspect);
  view.camera.eye = view.camera.target + kRoom * (view.camera.eye - view.camera.target);
  const double above = seen_from(view.camera.eye, to_eye, view.plane, where, camera,
                                 "name another camera, or none: then it is looked at straight on");
  view.camera.target = view.camera.eye - above / view.plane.normal_W.dot(to_eye) * to_eye;
  return view;
}

std::vector<render::Strokes> open_machine(const FinishedRun& run, const Pose& X_MW,
                                          const sim::SectionPlane& section, const SourceLocation& where,
                                          const std::string& camera, render::DrawList& list) {
  const Pose X_WM = X_MW.inverse();
  const Vec3 eye = X_WM * list.camera.eye, to_eye = (eye - X_WM * list.camera.target).normalized();
  const double voxel = run.job.scene.movie.voxel_mm;  // of stock_at()
  const sim::SectionPlane plane =
      off_walls(facing(to_eye, section, run.job.scene.stock.box_W, voxel, where), voxel);
  seen_from(eye, to_eye, plane, where, camera, "name another camera");
  list.section = {X_MW * plane.point_W, X_MW.linear() * plane.normal_W};
  for (const auto& ends : section_pieces(shown_design(run.job).mesh, plane.point_W, plane.normal_W))
    list.lines.push_back({{X_MW * ends[0], X_MW * ends[1]}, kDesignLine, kDesignTube, "design"});
  if (list.lines.empty()) return {};
  return {{{}, kDesignWidth, "design", kDesignLine}};
}

std::vector<render::DrawLine> kept_lines(const std::vector<render::DrawLine>& lines,
                                         const sim::SectionPlane& plane) {
  std::vector<render::DrawLine> kept;
  const auto above = [&](const Vec3& p) { return plane.normal_W.dot(p - plane.point_W); };
  for (const render::DrawLine& line : lines) {
    bool inside = false;
    for (size_t k = 0; k < line.points.size(); ++k) {
      const Vec3& p = line.points[k];
      const double height = above(p);
      if (k > 0 && inside != (height <= 0.0)) {
        const double before = above(line.points[k - 1]);
        const Vec3 crossing = line.points[k - 1] + before / (before - height) * (p - line.points[k - 1]);
        if (!inside) kept.push_back({{}, line.colour, line.width_px, line.name});
        kept.back().points.push_back(crossing);
      } else if (k == 0 && height <= 0.0) {
        kept.push_back({{}, line.colour, line.width_px, line.name});
      }
      inside = height <= 0.0;
      if (inside) kept.back().points.push_back(p);
    }
  }
  return kept;
}

void draw_section(const FinishedRun& run, const TriMesh& part, const SectionView& view, bool labels,
                  double right_px, render::Image& image) {
  const Paper paper(view, image);
  std::vector<render::Strokes> kinds{outline(part, view, paper)};
  colour(kinds.back(), kPartLine, kPartWidth, "part as cut");
  kinds.push_back(outline(shown_design(run.job).mesh, view, paper));
  colour(kinds.back(), kDesignLine, kDesignWidth, "design");
  const RaysBeside rays = rays_beside(run, view.asked);
  if (labels) kinds.push_back(whiskers(rays, view, paper, image.width, deviation_scale(run.job, run.dexels)));
  std::erase_if(kinds, [](const render::Strokes& kind) { return kind.pieces.empty(); });
  for (const render::Strokes& kind : kinds) render::draw_strokes(image, kind);
  if (!labels) return;
  std::vector<std::string> notes;
  if (rays.lowest)
    notes.push_back(
        fmt::format("values: measuring rays, at most {:.2g} mm from the plane", rays.farthest_mm));
  render::draw_scale_bar(image, paper.px_per_mm());
  const Vec2 legend = render::draw_legend(image, "section " + sim::section_words(view.asked), kinds, notes);
  if (rays.lowest)
    render::draw_leaders(
        image, {leader_to(*rays.lowest, "lowest", paper), leader_to(*rays.highest, "highest", paper)},
        right_px, legend);
}

}  // namespace swarf::reports
