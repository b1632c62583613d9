#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>
#include <utility>

#include "base/config.h"
#include "base/units.h"
#include "mesh/mesh_ops.h"
#include "render/camera.h"
#include "render/figures/colour.h"
#include "render/image_io.h"
#include "render/lettering.h"
#include "render/ray/ray_scene.h"
#include "render/ray/still.h"
#include "reports/part_view.h"
#include "reports/pictures.h"
#include "reports/section_still.h"
#include "sim/run/cut_along.h"

namespace swarf::reports {
namespace {

constexpr double kFieldOfView = 0.45;  // rad, vertical: a long lens, little distortion
constexpr int kColourStops = 33;
constexpr double kBeforeSurface = 1e-3;  // of the part's diagonal: a place is seen from so far before it
// Of 255: StillOptions::noise. With it and 16 samples the dome's pictures are off those of 512 samples a
// pixel by 2.1 (machine), 1.9 (part), 1.4 (deviation) and 2.9 (fan), root mean square, as they are written.
constexpr double kStillNoise = 5.0;

// Bare cut metal: the strip lights break at each ridge, which is what makes cusps of a few micrometres
// visible.
constexpr render::Material kPolished{{0.56F, 0.57F, 0.59F}, 1.0F, 0.16F};
constexpr render::Material kColoured{{1.0F, 1.0F, 1.0F}, 0.0F, 0.7F};  // by the vertices
constexpr render::Material kMatt{{0.75F, 0.76F, 0.78F}, 0.0F, 0.6F};   // behind lines: no reflections

double aspect(const std::array<int, 2>& size) {
  return static_cast<double>(size[0]) / size[1];
}

render::StillOptions still_options(const sim::Job& job) {
  render::StillOptions options;
  options.width = job.scene.stills.size[0];
  options.height = job.scene.stills.size[1];
  options.samples_per_pixel = job.scene.stills.samples;
  options.noise = kStillNoise;
  return options;
}

constexpr std::array<double, 5> kTickPlaces{-1.0, -0.5, 0.0, 0.5, 1.0};
constexpr const char* kNotMeasured = "not measured";

std::string tick_label(const render::DeviationScale& scale, double place) {
  return place == 0.0 ? "0" : fmt::format("{:+.3g}", scale.at(place));
}

/// The colour bar as it is drawn on a picture.
render::ColourBar lettered_bar(const render::DeviationScale& scale) {
  render::ColourBar bar;
  bar.low = -1.0;
  bar.high = 1.0;
  bar.colour = [scale](double place) { return render::deviation_colour(scale.at(place), scale); };
  bar.title = "deviation, µm";
  for (const double place : kTickPlaces) bar.ticks.push_back({place, tick_label(scale, place)});
  bar.apart = kNotMeasured;
  bar.apart_colour = render::deviation_colour(std::numeric_limits<double>::quiet_NaN(), scale);
  return bar;
}

/// The first cycle in contact from the middle of the shown time on.
motion::Cycle middle_cycle(const FinishedRun& run) {
  const size_t middle = (run.first_shown() + run.last_shown() + 1) / 2;
  motion::CycleReader reader(run.cycles);
  for (size_t k = middle; k <= run.last_shown(); ++k) {
    if (reader.at(k).sample.kind == motion::SampleKind::kCutting) return reader.at(k);
  }
  return reader.at(middle);
}

}  // namespace

Vec3 camera_direction(const std::string& name) {
  if (const auto direction = sim::camera_named(name)) return *direction;
  throw InputError(
      "unknown-camera", {"--camera"}, fmt::format("there is no camera '{}'", name),
      fmt::format("one of {}, or a direction x,y,z from the subject to the eye", sim::camera_names()));
}

render::Camera machine_camera(const FinishedRun& run, const std::string& name,
                              const std::array<int, 2>& size) {
  // What the picture must hold: the stock at every table position, and the head above it.
  const MachineView view(run.job);
  const Box& box = run.job.scene.stock.box_W;
  Box seen{Vec3::Constant(1e9), Vec3::Constant(-1e9)};
  constexpr size_t kPlaces = 50;
  for (const motion::Cycle& cycle : run.shown_cycles(kPlaces)) {
    const Vec3 centre = view.work_pose(cycle.q) * box.centre();
    seen.lower = seen.lower.cwiseMin(centre);
    seen.upper = seen.upper.cwiseMax(centre);
  }
  const double margin = 0.9 * box.size().maxCoeff();
  seen.lower.array() -= margin;
  seen.upper.array() += margin;
  return render::look_at_box(seen, -camera_direction(name), kFieldOfView, aspect(size));
}

TriMesh stock_at(const FinishedRun& run, const motion::Cycle& cycle) {
  sim::CutAlong along(run.job, run.carried, run.cycles, run.job.scene.movie.voxel_mm);
  along.advance(cycle);
  TriMesh mesh = along.stock().mesh();
  mesh::split_creases(mesh, kCreaseRad);
  return mesh;
}

const std::string& still_name(StillKind kind) {
  return sim::kStillKinds.at(static_cast<size_t>(kind));
}

StillKind still_kind(const std::string& name) {
  const auto& names = sim::kStillKinds;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<StillKind>(found - names.begin());
  throw InputError("unknown-still", {"--kind"}, fmt::format("there is no still '{}'", name),
                   fmt::format("one of {}", fmt::join(names, ", ")));
}

ColourBar deviation_colour_bar(const render::DeviationScale& scale) {
  ColourBar bar{"Deviation from the design", "µm", -1.0, 1.0, {}};
  for (int i = 0; i < kColourStops; ++i) {
    const double um = scale.at(2.0 * i / (kColourStops - 1) - 1.0);
    const auto rgba = render::srgb8_from_linear(render::deviation_colour(um, scale));
    bar.stops.push_back({rgba[0], rgba[1], rgba[2]});
  }
  for (const double place : kTickPlaces) bar.ticks.emplace_back(place, tick_label(scale, place));
  const auto rest = render::srgb8_from_linear(kStockMaterial.colour);
  bar.apart = kNotMeasured;
  bar.apart_colour = {rest[0], rest[1], rest[2]};
  return bar;
}

namespace {

/// A drawing whose colours are deviations, and where its bar begins, px from the left.
std::pair<render::Image, double> with_colour_bar(const render::DrawList& list,
                                                 const render::DeviationScale& scale,
                                                 render::StillOptions options) {
  options.strip_strength = 0.0;  // reflections would tint the colours
  render::Image image = render::render_still(list, options);
  const double begins = render::draw_colour_bar(image, lettered_bar(scale));
  return {std::move(image), begins};
}

/// The deepest and the highest of the vertices from `first` on, with their values.
std::vector<render::Leader> extreme_leaders(const TriMesh& coloured, size_t first,
                                            const render::DrawList& list,
                                            const render::StillOptions& options) {
  const render::RayScene scene(list, 0.0, options.kept_tree);
  const Vec3 size = mesh::bounds(coloured).size();
  std::vector<render::Leader> leaders;
  for (const double sign : {-1.0, 1.0}) {
    size_t most = coloured.positions.size();
    for (size_t i = first; i < coloured.deviation_um.size(); ++i) {
      const double um = sign * coloured.deviation_um[i];
      if (!std::isnan(um) && (most == coloured.positions.size() || um > sign * coloured.deviation_um[most]))
        most = i;
    }
    if (most == coloured.positions.size()) return {};
    // A few places alone need not hold the deepest, or the highest.
    if (first > 0 && sign * coloured.deviation_um[most] < 0.0) continue;
    const auto& p = coloured.positions[most];
    const Vec3 place(p[0], p[1], p[2]), to_eye = (list.camera.eye - place).normalized();
    // From a little before the surface on, which would hide itself.
    const Vec3 from = place + kBeforeSurface * size.norm() * to_eye;
    const bool hidden = scene.occluded(from.cast<float>(), to_eye.cast<float>());
    const Vec2 at = render::picture_place(list.camera, place, options.width, options.height);
    leaders.push_back({at.x(), at.y(),
                       fmt::format("{} {:+.2f} µm{}", sign < 0.0 ? "deepest" : "highest",
                                   coloured.deviation_um[most], hidden ? ", behind" : "")});
  }
  return leaders;
}

}  // namespace

render::Image deviation_picture(const TriMesh& coloured, const render::DeviationScale& scale,
                                const std::string& camera, render::StillOptions options,
                                std::optional<size_t> labelled) {
  render::RayTreePtr own;
  if (options.kept_tree == nullptr) options.kept_tree = &own;
  render::DrawList list;
  const double ratio = static_cast<double>(options.width) / options.height;
  list.camera = render::look_at_box(mesh::bounds(coloured), -camera_direction(camera), kFieldOfView, ratio);
  list.items.push_back({&coloured, Pose::Identity(), kColoured});
  auto [image, bar_begins] = with_colour_bar(list, scale, options);
  if (labelled) {
    render::draw_leaders(image, extreme_leaders(coloured, *labelled, list, options), bar_begins);
    render::draw_scale_bar(image, render::px_per_mm_at_target(list.camera, options.height));
  }
  return image;
}

namespace {

/// The part, its deviation or the paths on it, cut open; of the paths what lies on the side that is kept.
render::Image section_picture(const FinishedRun& run, const TriMesh& part, StillKind kind,
                              const std::string& camera, const StillLook& look,
                              render::StillOptions options) {
  const SectionView view = section_view(run, part, *look.section, look.section_where, camera, kFieldOfView,
                                        aspect(run.job.scene.stills.size));
  render::DrawList list;
  list.camera = view.camera;
  list.section = {view.plane.point_W, view.plane.normal_W};
  TriMesh coloured;
  render::Image image;
  double right_px = options.width;
  if (kind == StillKind::kDeviation) {
    coloured = part;
    const render::DeviationScale scale = deviation_scale(run.job, run.dexels);
    render::colour_by_deviation(coloured, scale);
    list.items.push_back({&coloured, Pose::Identity(), kColoured});
    list.items.back().sectioned = true;
    std::tie(image, right_px) = with_colour_bar(list, scale, options);
  } else {
    list.items.push_back({&part, Pose::Identity(), kind == StillKind::kFan ? kMatt : kPolished});
    list.items.back().sectioned = true;
    if (kind == StillKind::kFan) {
      list.lines = kept_lines(fan_lines(run), view.plane);
      options.strip_strength = 0.0;
    }
    image = render::render_still(list, options);
  }
  draw_section(run, part, view, look.labels, right_px, image);
  return image;
}

render::Image machine_picture(const FinishedRun& run, const std::string& camera, const StillLook& look,
                              const render::StillOptions& options) {
  const MachineView view(run.job);
  const motion::Cycle cycle = middle_cycle(run);
  render::DrawList list;
  list.camera = machine_camera(run, camera, run.job.scene.stills.size);
  std::vector<render::Strokes> lines;
  if (look.section)
    lines = open_machine(run, view.work_pose(cycle.q), *look.section, look.section_where, camera, list);
  const TriMesh half_cut = stock_at(run, cycle);
  list.items = view.items(cycle.q, static_cast<size_t>(cycle.sample.tool), &half_cut);
  render::Image image = render::render_still(list, options);
  if (!look.labels) return image;
  render::draw_scale_bar(image, render::px_per_mm_at_target(list.camera, options.height));
  if (look.section) render::draw_legend(image, "section " + sim::section_words(*look.section), lines, {});
  return image;
}

render::Image deviation_still(const FinishedRun& run, const StillPart& part, const std::string& camera,
                              const StillLook& look, const render::StillOptions& options) {
  TriMesh coloured = part.mesh;
  const render::DeviationScale scale = deviation_scale(run.job, run.dexels);
  render::colour_by_deviation(coloured, scale);
  // Only places of rays have values to tell.
  const auto labelled = look.labels ? std::optional(part.measured) : std::nullopt;
  return deviation_picture(coloured, scale, camera, options, labelled);
}

/// The part, or the fan over it.
render::Image part_picture(const FinishedRun& run, const TriMesh& part, StillKind kind,
                           const std::string& camera, bool labels, render::StillOptions options) {
  render::DrawList list;
  list.camera = render::look_at_box(mesh::bounds(part), -camera_direction(camera), kFieldOfView,
                                    aspect(run.job.scene.stills.size));
  list.items.push_back({&part, Pose::Identity(), kind == StillKind::kFan ? kMatt : kPolished});
  if (kind == StillKind::kFan) {
    list.lines = fan_lines(run);
    options.strip_strength = 0.0;
  }
  render::Image image = render::render_still(list, options);
  if (labels) render::draw_scale_bar(image, render::px_per_mm_at_target(list.camera, options.height));
  return image;
}

render::Image still_picture(const FinishedRun& run, const StillPart& part, StillKind kind,
                            const std::string& camera_name, const StillLook& look) {
  render::StillOptions options = still_options(run.job);
  options.transparent = look.transparent;
  options.kept_tree = look.kept_tree;
  const bool machine = kind == StillKind::kMachine;
  if (look.section && !machine) return section_picture(run, part.mesh, kind, camera_name, look, options);
  const std::string camera = camera_name.empty() ? machine ? "machine" : "iso" : camera_name;
  if (machine) return machine_picture(run, camera, look, options);
  if (kind == StillKind::kDeviation) return deviation_still(run, part, camera, look, options);
  return part_picture(run, part.mesh, kind, camera, look.labels, options);
}

}  // namespace

StillPart still_part(const FinishedRun& run, TriMesh closed, const std::vector<WorstPlace>& worst) {
  StillPart part{shown_part(run, std::move(closed))};
  part.measured = part.mesh.positions.size();
  add_worst_places(run, worst, part.mesh);
  return part;
}

void make_still(const FinishedRun& run, const StillPart& part, StillKind kind, const std::string& camera,
                const std::string& path, const StillLook& look) {
  render::save_png(still_picture(run, part, kind, camera, look), path);
}

}  // namespace swarf::reports
