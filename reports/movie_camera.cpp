#include "reports/movie_camera.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/units.h"
#include "render/camera.h"
#include "render/figures/chip_mesh.h"
#include "reports/pictures.h"
#include "reports/section_still.h"

namespace swarf::reports {
namespace {

constexpr double kShotFieldOfView = 0.45;  // rad, vertical: a long lens, little distortion
constexpr double kToolWidths = 14.0;       // tool diameters across the picture that follows the tool
/// Where the work travels farther than so many times its own size, the camera goes with it: else it would be
/// a speck.
constexpr double kFarTravel = 2.0;
/// Of the ball around the stock, which turns in it: a third of its radius is left for the tool.
constexpr double kAroundBall = 1.35;
constexpr render::Rgb kTrailColour{0.85F, 0.10F, 0.05F};
constexpr double kChipSize = 0.2;  // tool diameters
constexpr render::Material kChipMaterial{{0.80F, 0.78F, 0.74F}, 0.7F, 0.3F};
/// Chips that have flown so many of the stock's longest sides away from it have left the picture. Beside the
/// part alone fewer: its light and floor are laid out by all that is drawn.
constexpr double kBeyondWork = 1.5, kBeyondPart = 0.5;

Vec3 turned_about_z(const Vec3& direction, double angle) {
  return Eigen::AngleAxisd(angle, Vec3::UnitZ()) * direction;
}

Box around(const Vec3& centre, double half) {
  return {centre - Vec3::Constant(half), centre + Vec3::Constant(half)};
}

}  // namespace

ShotView::ShotView(const FinishedRun& run, const std::string& default_camera)
    : run_(run),
      view_(run.job),
      default_camera_(default_camera),
      seen_{Vec3::Constant(1e9), Vec3::Constant(-1e9)} {
  constexpr size_t kPlaces = 50;
  for (const motion::Cycle& cycle : run.shown_cycles(kPlaces)) {
    const Vec3 centre = view_.work_pose(cycle.q) * run.job.scene.stock.box_W.centre();
    seen_.lower = seen_.lower.cwiseMin(centre);
    seen_.upper = seen_.upper.cwiseMax(centre);
  }
  find_enclosed();
  for (const cutter::Cutter& tool : run.job.scene.tools)
    chips_.push_back(render::chip_mesh(kChipSize * tool.diameter_mm));
}

/// A fifth of a machine's facets is sunk in other bodies of its link; where no shot shows it they are not
/// looked for.
void ShotView::find_enclosed() {
  const auto& shots = run_.job.scene.movie.shots;
  if (std::all_of(shots.begin(), shots.end(),
                  [](const sim::MovieShot& shot) { return shot.view == sim::MovieView::kPart; }))
    return;
  const std::vector<machine::Link>& links = run_.job.machine.links;
  std::vector<mesh::Enclosed> found(links.size());
  parallel_chunks(links.size(), 1, [&](size_t i, size_t) { found[i] = mesh::find_enclosed(links[i].mesh); });
  for (size_t i = 0; i < links.size(); ++i) {
    if (!found[i].around.empty()) enclosed_.emplace(&links[i].mesh, std::move(found[i]));
  }
}

Vec3 ShotView::direction(const PlannedFrame& frame, sim::MovieView view) const {
  const sim::MovieShot& shot = run_.job.scene.movie.shots[frame.shot];
  const std::string otherwise = view == sim::MovieView::kPart ? "iso" : default_camera_;
  const Vec3 from = camera_direction(shot.camera.empty() ? otherwise : shot.camera);
  return turned_about_z(from, rad_from_deg(shot.orbit_deg) * frame.share);
}

render::Camera ShotView::camera(const PlannedFrame& frame, sim::MovieView view,
                                const std::array<int, 2>& size) const {
  const sim::MovieShot& shot = run_.job.scene.movie.shots[frame.shot];
  const double aspect = static_cast<double>(size[0]) / size[1];
  const Box& stock = run_.job.scene.stock.box_W;
  const auto tool = static_cast<size_t>(frame.cycle.sample.tool);
  const bool part = view == sim::MovieView::kPart;
  const Pose X_work = part ? Pose::Identity() : view_.work_pose(frame.cycle.q);
  Vec3 centre = X_work * stock.centre();
  double width = shot.width_mm, travel = 0.0;
  sim::MovieFollow follow = shot.follow;
  if (follow == sim::MovieFollow::kNothing && !part) {
    if (width == 0.0 && seen_.size().maxCoeff() > kFarTravel * stock.size().maxCoeff()) {
      follow = sim::MovieFollow::kWork;
    } else {
      centre = seen_.centre();
      travel = seen_.size().norm();
    }
  }
  if (!part && width == 0.0) width = (travel + kAroundBall * stock.size().norm()) * std::max(aspect, 1.0);
  if (follow == sim::MovieFollow::kTool) {
    centre = X_work * frame.cycle.sample.pose.tip_W;
    if (shot.width_mm == 0.0) width = kToolWidths * run_.job.scene.tools[tool].diameter_mm;
  }
  const Vec3 from = direction(frame, view);
  if (width == 0.0) return render::look_at_box(stock, -from, kShotFieldOfView, aspect);
  render::Camera camera = render::look_at_box(around(centre, 1.0), -from, kShotFieldOfView, aspect);
  camera.eye = centre + from.normalized() * (0.5 * width / (std::tan(0.5 * kShotFieldOfView) * aspect));
  return camera;
}

/// Thrown and falling in the frame that the picture stands still in, down to where the stock stands.
void ShotView::add_chips(std::span<const Chip> chips, const Pose& X_drawn, bool part,
                         std::vector<render::DrawItem>& items) const {
  Box near{Vec3::Constant(1e30), Vec3::Constant(-1e30)};
  for (const Vec3& corner : render::corners(run_.job.scene.stock.box_W)) {
    near.lower = near.lower.cwiseMin(X_drawn * corner);
    near.upper = near.upper.cwiseMax(X_drawn * corner);
  }
  const double lowest = near.lower.z();
  const Vec3 beyond = Vec3::Constant((part ? kBeyondPart : kBeyondWork) * near.size().maxCoeff());
  for (const Chip& chip : chips) {
    const TriMesh& mesh = chips_[chip.tool];
    const Pose pose = flown(chip, part ? Pose::Identity() : view_.work_pose(chip.q), lowest);
    const Vec3 place = pose.translation();
    if ((place - near.lower + beyond).minCoeff() < 0.0 || (near.upper + beyond - place).minCoeff() < 0.0)
      continue;
    items.push_back({&mesh, pose, kChipMaterial});
  }
}

render::DrawList ShotView::list(const PlannedFrame& frame, sim::MovieView view,
                                const std::array<int, 2>& size, const StockState& stock,
                                const std::vector<uint64_t>& revisions, const std::vector<Vec3>& tip_trail,
                                std::span<const Chip> chips) const {
  const sim::MovieShot& shot = run_.job.scene.movie.shots[frame.shot];
  const auto tool = static_cast<size_t>(frame.cycle.sample.tool);
  const bool part = view == sim::MovieView::kPart;
  const Pose X_work = view_.work_pose(frame.cycle.q);
  const Pose X_drawn = part ? Pose::Identity() : X_work;
  render::DrawList list;
  list.camera = camera(frame, view, size);
  if (part) {
    const Pose X_WT = X_work.inverse() * view_.tool_pose(frame.cycle.q, tool);
    list.items.push_back({&view_.cutter(tool), X_WT, kToolMaterial});
    list.items.push_back({&view_.holder(tool), X_WT * view_.holder_in_tool(tool), kHolderMaterial});
  } else {
    list.items = view_.items(frame.cycle.q, tool, nullptr);
    for (render::DrawItem& item : list.items) {
      const auto known = enclosed_.find(item.mesh);
      if (known != enclosed_.end()) item.enclosed = &known->second;
    }
  }
  const size_t before = list.items.size();
  add_stock(stock, revisions, X_drawn, list.items);
  if (shot.section) {
    const sim::SectionPlane plane = off_walls(*shot.section, run_.job.scene.movie.voxel_mm);
    list.section = {X_drawn * plane.point_W, X_drawn.linear() * plane.normal_W};
    for (size_t i = before; i < list.items.size(); ++i) list.items[i].sectioned = true;
  }
  add_chips(chips, X_drawn, part, list.items);
  if (tip_trail.size() > 1) {
    render::DrawLine line{{}, kTrailColour, std::max(1.5F, static_cast<float>(size[1]) / 400.0F), "trail"};
    for (const Vec3& tip : tip_trail) line.points.push_back(X_drawn * tip);
    list.lines.push_back(line);
  }
  return list;
}

}  // namespace swarf::reports
