#include "reports/finding_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "base/units.h"
#include "mesh/mesh_ops.h"
#include "render/camera.h"
#include "render/figures/colour.h"
#include "render/image_io.h"
#include "render/lettering.h"
#include "render/ray/ray_scene.h"
#include "render/ray/still.h"
#include "reports/movie_stock.h"
#include "reports/part_view.h"
#include "sim/judge/finding_groups.h"

namespace swarf::reports {
namespace {

constexpr double kContactView = 0.45;  // rad, vertical
constexpr int kPictureSamples = 12;    // a pixel: these are looked at, not printed
constexpr double kLeastView_mm = 25.0;
constexpr double kDiametersShown = 2.0;  // of the tool, about a place on the part
constexpr double kLeastShare = 0.05;     // of the part, where the tool is smaller
constexpr render::Rgb kRingColour{0.85F, 0.05F, 0.04F};

/// Pictures beside the findings of the page.
constexpr int kCardWidth = 640, kCardHeight = 400;

/// From the place to the eye, those that are tried first are kept where others show no more.
std::vector<Vec3> views() {
  std::vector<Vec3> list;
  for (const double up_deg : {35.0, 15.0, 60.0})
    for (const double round_deg : {-125.0, -55.0, -90.0, 180.0, 0.0, -145.0, -35.0, 90.0, 125.0, 55.0}) {
      const double up = rad_from_deg(up_deg), round = rad_from_deg(round_deg);
      list.emplace_back(std::cos(up) * std::cos(round), std::cos(up) * std::sin(round), std::sin(up));
    }
  return list;
}

/// Places about the contact that its picture should show.
std::vector<Vec3> neighbours(const Vec3& place, double view_mm) {
  std::vector<Vec3> list;
  for (const double share : {0.02, 0.08, 0.2})
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const Vec3 way(x, y, z);
          if (way.norm() > 0.0) list.push_back(place + share * view_mm * way.normalized());
        }
  return list;
}

Vec3 best_view(const render::DrawList& list, const Vec3& place, double view_mm) {
  const render::RayScene scene(list, 0.0);
  const std::vector<Vec3> places = neighbours(place, view_mm);
  Vec3 best = Vec3::UnitZ();
  int most = -1;
  for (const Vec3& view : views()) {
    const render::Vec3f direction = view.cast<float>();
    const auto seen = static_cast<int>(std::count_if(places.begin(), places.end(), [&](const Vec3& at) {
      return !scene.occluded(at.cast<float>(), direction);
    }));
    if (seen > most) {
      most = seen;
      best = view;
    }
  }
  return best;
}

/// Half way to the eye, where nothing hides it.
render::DrawLine ring_about(const Vec3& place, const render::Camera& camera, double radius) {
  constexpr int kCorners = 48;
  const Vec3 to_eye = camera.eye - place, out = to_eye.normalized();
  const Vec3 x =
      (std::abs(out.z()) < 0.9 ? Vec3(Vec3::UnitZ()) : Vec3(Vec3::UnitX())).cross(out).normalized();
  const Vec3 y = out.cross(x), centre = place + 0.5 * to_eye;
  render::DrawLine ring;
  for (int i = 0; i <= kCorners; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / kCorners;
    ring.points.push_back(centre + 0.5 * radius * (std::cos(turn) * x + std::sin(turn) * y));
  }
  ring.colour = kRingColour;
  ring.width_px = 3.0F;
  ring.name = "contact";
  return ring;
}

/// Of a finding: when, and where in the machine.
struct Moment {
  motion::Cycle cycle;
  Vec3 place_M = Vec3::Zero();
};

/// The first cycle that is not before the finding; its own place, or the tip of the tool.
Moment moment_of(const FinishedRun& run, const sim::Finding& finding, motion::CycleReader& reader) {
  constexpr double kSlack = 1e-6;  // of a cycle: rounding of the time alone
  const double k = std::max(0.0, std::ceil(finding.t_s / run.cycles.period_s() - kSlack));
  const motion::Cycle& cycle = reader.at(std::min(static_cast<size_t>(k), run.cycles.size() - 1));
  if (finding.place_M) return {cycle, *finding.place_M};
  const Pose work = MachineView(run.job).work_pose(cycle.q);
  return {cycle, work * finding.place_W.value_or(cycle.sample.pose.tip_W)};
}

render::StillOptions options_of(int width, int height, int samples) {
  render::StillOptions options;
  options.width = width;
  options.height = height;
  options.samples_per_pixel = std::min(kPictureSamples, samples);
  options.strip_strength = 0.0;  // reflections would tint colours and hide edges
  options.floor = false;
  return options;
}

/// The stock must have been cut up to the moment.
render::Image machine_image(const FinishedRun& run, const Moment& moment, const MovieStock& stock,
                            const render::StillOptions& options) {
  const auto tool = static_cast<size_t>(std::max<int>(0, moment.cycle.sample.tool));
  const MachineView view(run.job);
  render::DrawList list;
  list.items = view.items(moment.cycle.q, tool, nullptr);
  add_stock(stock.state(), stock.revisions(), view.work_pose(moment.cycle.q), list.items);
  const double view_mm = std::max(kLeastView_mm, 2.5 * run.job.scene.tools[tool].diameter_mm);
  const Vec3 half = Vec3::Constant(view_mm);
  list.camera = render::look_at_box({moment.place_M - half, moment.place_M + half},
                                    -best_view(list, moment.place_M, view_mm), kContactView,
                                    static_cast<double>(options.width) / options.height);
  list.lines.push_back(ring_about(moment.place_M, list.camera, 0.25 * view_mm));
  return render::render_still(list, options);
}

/// What the measuring rays have found.
bool on_the_surface(const sim::Finding& finding) {
  static constexpr std::array kChecks{"gouge", "excess", "scallop"};
  return finding.place_W && std::find(kChecks.begin(), kChecks.end(), finding.check) != kChecks.end();
}

/// It happens at a moment of the program.
bool has_moment(const sim::Finding& finding) {
  return finding.where.line > 0 && finding.t_s >= 0.0;
}

}  // namespace

std::vector<std::string> make_finding_pictures(const FinishedRun& run, const TriMesh& part,
                                               const sim::Result& result,
                                               const std::function<std::string(size_t)>& file_of,
                                               Progress& progress) {
  const std::vector<sim::FindingGroup> groups = sim::group_findings(result.findings);
  const size_t most = std::min(groups.size(), kFindingPicturesMost);
  std::vector<std::string> files(most);
  std::vector<std::pair<Moment, size_t>> moments;
  std::optional<TriMesh> coloured;
  motion::CycleReader reader(run.cycles);
  for (size_t i = 0; i < most && !progress.stop_requested(); ++i) {
    const sim::Finding& worst = result.findings[groups[i].members.front()];
    if (on_the_surface(worst) && !part.deviation_um.empty()) {
      if (!coloured)
        render::colour_by_deviation(coloured.emplace(part), deviation_scale(run.job, run.dexels));
      const double size = mesh::bounds(part).size().maxCoeff();
      files[i] = file_of(i + 1);
      make_place_picture(*coloured, *worst.place_W,
                         std::clamp(kDiametersShown * worst.reach_mm, kLeastShare * size, size), files[i]);
    } else if (has_moment(worst) || worst.place_M) {
      moments.emplace_back(moment_of(run, worst, reader), i);
    }
  }
  if (moments.empty()) return files;
  // The stock is cut once, through all of them.
  std::stable_sort(moments.begin(), moments.end(), [](const auto& a, const auto& b) {
    return a.first.cycle.sample.t_s < b.first.cycle.sample.t_s;
  });
  MovieStock stock(run, sim::MovieColours::kMaterial);
  for (const auto& [moment, i] : moments) {
    if (progress.stop_requested()) break;
    stock.advance(moment.cycle);
    files[i] = file_of(i + 1);
    render::save_png(
        machine_image(run, moment, stock, options_of(kCardWidth, kCardHeight, run.job.scene.stills.samples)),
        files[i]);
  }
  return files;
}

void make_finding_picture(const FinishedRun& run, const KeptFindings& kept, int number,
                          const std::string& path) {
  const auto named = std::find(kept.numbers.begin(), kept.numbers.end(), number);
  if (named == kept.numbers.end()) {
    const int many = kept.faults();
    throw InputError("unknown-finding", {fmt::format("--finding {}", number)},
                     many == 0 ? "this run has no finding" : fmt::format("this run has {} findings", many),
                     many == 0 ? "leave out --finding" : fmt::format("write a number from 1 to {}", many));
  }
  const sim::Finding& finding = kept.list[static_cast<size_t>(named - kept.numbers.begin())];
  motion::CycleReader reader(run.cycles);
  const Moment moment = moment_of(run, finding, reader);
  MovieStock stock(run, sim::MovieColours::kMaterial);
  stock.advance(moment.cycle);
  const auto& size = run.job.scene.stills.size;
  render::Image image =
      machine_image(run, moment, stock, options_of(size[0], size[1], run.job.scene.stills.samples));
  std::vector<std::string> lines{fmt::format("finding {}: {}", number, finding.text)};
  if (finding.where.line > 0)
    lines.push_back(fmt::format("line {}   {:.3f} s   {}", finding.where.line, finding.t_s, finding.block));
  render::draw_caption(image, lines);
  render::save_png(image, path);
}

namespace {

/// What lies so near to a place that a picture of it may show it.
TriMesh neighbourhood(const TriMesh& mesh, const Vec3& place, double reach_mm) {
  TriMesh near = mesh;
  near.triangles.clear();
  for (const auto& t : mesh.triangles) {
    const bool inside = std::any_of(t.begin(), t.end(), [&](uint32_t v) {
      const auto& p = mesh.positions[v];
      return (Vec3(p[0], p[1], p[2]) - place).norm() < reach_mm;
    });
    if (inside) near.triangles.push_back(t);
  }
  return near;
}

}  // namespace

void make_place_picture(const TriMesh& coloured, const Vec3& place, double width_mm,
                        const std::string& path) {
  constexpr double kShown = 3.0;  // widths: beyond, nothing is in the picture
  const TriMesh near = neighbourhood(coloured, place, kShown * width_mm);
  render::DrawList list;
  list.items.push_back({&near, Pose::Identity(), {{1.0F, 1.0F, 1.0F}, 0.0F, 0.7F}});
  const Vec3 half = Vec3::Constant(0.5 * width_mm);
  const render::StillOptions options = options_of(kCardWidth, kCardHeight, kPictureSamples);
  list.camera = render::look_at_box({place - half, place + half}, -best_view(list, place, width_mm),
                                    kContactView, double(options.width) / options.height);
  list.lines.push_back(ring_about(place, list.camera, 0.2 * width_mm));
  render::save_png(render::render_still(list, options), path);
}

}  // namespace swarf::reports
