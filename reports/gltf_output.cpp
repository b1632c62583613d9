#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "base/side_by_side.h"
#include "base/units.h"
#include "mesh/mesh_ops.h"
#include "render/camera.h"
#include "render/figures/colour.h"
#include "render/gltf/gltf_writer.h"
#include "reports/machine_nodes.h"
#include "reports/part_view.h"
#include "reports/pictures.h"
#include "reports/review_models.h"

namespace swarf::reports {
namespace {

constexpr double kMachinePartError = 0.02;  // mm; the part in machine.glb is only looked at
constexpr size_t kStages = 9;               // of the stock before it is the part: each costs some 50 kB
constexpr double kPinShare = 0.012;         // of the part's longest side: a pin's radius
constexpr std::array<int, 2> kCameraAspect{16, 9};

/// Copies of the vertices that the given triangles use.
TriMesh sub_mesh(const TriMesh& mesh, const std::vector<std::array<uint32_t, 3>>& triangles,
                 bool with_deviation) {
  TriMesh part;
  std::vector<uint32_t> place(mesh.positions.size(), UINT32_MAX);
  for (const auto& triangle : triangles) {
    std::array<uint32_t, 3> moved{};
    for (size_t c = 0; c < 3; ++c) {
      uint32_t& index = place[triangle[c]];
      if (index == UINT32_MAX) {
        index = static_cast<uint32_t>(part.positions.size());
        part.positions.push_back(mesh.positions[triangle[c]]);
        part.normals.push_back(mesh.normals[triangle[c]]);
        if (with_deviation) part.deviation_um.push_back(mesh.deviation_um[triangle[c]]);
      }
      moved[c] = index;
    }
    part.triangles.push_back(moved);
  }
  return part;
}

/// glTF knows no NaN: the measured face and the rest of the part are meshes of their own.
std::pair<TriMesh, TriMesh> split_by_measure(const TriMesh& mesh) {
  std::vector<std::array<uint32_t, 3>> measured, rest;
  for (const auto& triangle : mesh.triangles) {
    const bool known = std::none_of(triangle.begin(), triangle.end(),
                                    [&](uint32_t v) { return std::isnan(mesh.deviation_um[v]); });
    (known ? measured : rest).push_back(triangle);
  }
  return {sub_mesh(mesh, measured, true), sub_mesh(mesh, rest, false)};
}

/// Of every cycle that is shown.
motion::AxisKeys keys_of(const FinishedRun& run) {
  motion::AxisKeys keys(run.job.machine.model.axes);
  motion::CycleReader reader(run.cycles);
  std::vector<motion::Cycle> window;
  for (size_t k = run.first_shown(); k <= run.last_shown(); ++k) {
    window.push_back(reader.at(k));
    if (window.size() < motion::CycleStream::kWindow && k < run.last_shown()) continue;
    keys.add(window);
    window.clear();
  }
  keys.finish();
  return keys;
}

/// A double pyramid that stands on its lower tip, at the origin.
TriMesh pin_mesh(double radius) {
  const auto r = static_cast<float>(radius);
  TriMesh mesh;
  mesh.positions = {{0, 0, 0}, {r, 0, 3 * r}, {0, r, 3 * r}, {-r, 0, 3 * r}, {0, -r, 3 * r}, {0, 0, 4 * r}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 1, 4}, {5, 1, 2}, {5, 2, 3}, {5, 3, 4}, {5, 4, 1}};
  return mesh;
}

render::GltfNode pin_node(const ReviewPin& pin, const Vec3& at, const TriMesh& mesh) {
  constexpr render::Material kRed{{0.55F, 0.01F, 0.02F}, 0.0F, 0.5F};
  constexpr render::Material kAmber{{0.70F, 0.33F, 0.0F}, 0.0F, 0.5F};
  Pose place = Pose::Identity();
  place.translation() = at;
  render::GltfNode node{fmt::format("finding {}: {}", pin.number, pin.code),
                        &mesh,
                        pin.severity == Severity::kError ? kRed : kAmber,
                        -1,
                        {},
                        {place}};
  node.extras = {{"role", "finding"},
                 {"finding", static_cast<double>(pin.number)},
                 {"code", pin.code},
                 {"text", pin.text},
                 {"line", double(pin.line)},
                 {"time_s", pin.t_s},
                 {"x_mm", at.x()},
                 {"y_mm", at.y()},
                 {"z_mm", at.z()}};
  if (pin.amount_mm > 0.0) node.extras["amount_mm"] = pin.amount_mm;
  return node;
}

render::GltfNode design_node(const TriMesh& mesh) {
  constexpr render::Material kDesign{{0.10F, 0.30F, 0.62F}, 0.0F, 0.6F};
  render::GltfNode node{"design", &mesh, kDesign, -1, {}, {}};
  node.extras = {{"role", "design"}};
  return node;
}

std::vector<render::GltfCamera> part_cameras(const Box& box) {
  constexpr double kView = 0.45;  // rad, vertical: as the stills
  std::vector<render::GltfCamera> cameras;
  for (const char* name : {"iso", "front", "right", "back", "left", "top"})
    cameras.push_back(
        {fmt::format("camera {}", name), render::look_at_box(box, -camera_direction(name), kView,
                                                             double(kCameraAspect[0]) / kCameraAspect[1])});
  return cameras;
}

}  // namespace

double animation_scale(const FinishedRun& run) {
  return run.cycles.period_s() / cycle_seconds(run);
}

namespace {

/// Of the part for its own file and for the machine's.
void add_part(const FinishedRun& run, const TriMesh& closed, double max_error_mm, ReviewModels& models) {
  TriMesh light = mesh::decimate(closed, max_error_mm, &models.part.error_mm);
  models.machine_part = mesh::decimate(light, kMachinePartError, nullptr);
  mesh::split_creases(models.machine_part, kCreaseRad);  // decimate() has joined them
  models.part.mesh = shown_part(run, std::move(light), kShownVertices, &models.part.colours_off);
}

}  // namespace

ReviewModels review_models(const FinishedRun& run, const TriMesh& closed, double max_error_mm,
                           std::vector<ReviewPin> pins) {
  ReviewModels models;
  models.pins = std::move(pins);
  // Each decimates meshes for itself, which keeps one processor.
  const std::array<std::function<void()>, 3> parts{[&] { add_part(run, closed, max_error_mm, models); },
                                                   [&] { models.stages = stock_stages(run, kStages); },
                                                   [&] { models.way = program_way(run); }};
  side_by_side(
      parts.size(), 2, [&](size_t n) { parts[n](); }, [](size_t) {});
  return models;
}

void show_worst(const FinishedRun& run, std::span<const WorstPlace> worst, ReviewModels& models) {
  add_worst_places(run, worst, models.part.mesh);
}

std::string part_glb(const FinishedRun& run, const ReviewModels& models, const GltfOptions& options) {
  auto [measured, rest] = split_by_measure(models.part.mesh);
  const render::DeviationScale scale = deviation_scale(run.job, run.dexels);
  if (options.colours) render::colour_by_deviation(measured, scale);
  const Box box = mesh::bounds(models.part.mesh);
  const TriMesh pin = pin_mesh(kPinShare * box.size().maxCoeff());
  render::GltfScene scene;
  const auto add = [&](const char* name, const TriMesh& mesh, const render::Material& material) {
    if (mesh.triangles.empty()) return;
    render::GltfNode node{name, &mesh, material, -1, {}, {}};
    node.extras = {{"role", "part"}};
    node.grid = box;  // both sides of the edge between them are rounded alike
    scene.nodes.push_back(std::move(node));
  };
  add("machined surface", measured, {{1.0F, 1.0F, 1.0F}, 0.0F, 0.6F});
  add("part", rest, kStockMaterial);
  for (const ReviewPin& one : models.pins)
    if (one.place_W) scene.nodes.push_back(pin_node(one, *one.place_W, pin));
  if (options.design && !models.design.mesh.triangles.empty())
    scene.nodes.push_back(design_node(models.design.mesh));
  scene.lines = fan_lines(run);
  scene.paths = {gltf_path(models.way)};
  scene.cameras = part_cameras(box);
  scene.extras = {{"scene", run.job.scene.name},
                  {"deviation_scale_below_um", scale.below_um},
                  {"deviation_scale_above_um", scale.above_um},
                  {"path_error_mm", models.way.error_mm},
                  {"decimation_error_um", um_from_mm(models.part.error_mm)}};
  if (!std::isnan(models.part.colours_off)) scene.extras["colours_off_share"] = models.part.colours_off;
  return render::glb_bytes(scene, options.encoding);
}

std::string machine_glb(const FinishedRun& run, const ReviewModels& models, const GltfOptions& options) {
  const MachineView view(run.job);
  std::optional<motion::AxisKeys> own;
  if (run.keys == nullptr || run.window) own = keys_of(run);
  MachineNodes nodes(run, view, own ? *own : *run.keys);
  nodes.add_tools();
  nodes.add_stock(models.stages, models.machine_part);
  if (options.design && !models.design.mesh.triangles.empty())
    nodes.add_to_work(design_node(models.design.mesh));
  render::GltfScene scene;
  scene.clip = run.job.scene.name.empty() ? "program" : run.job.scene.name;
  scene.cameras = {{"camera machine", machine_camera(run, "machine", {kCameraAspect[0], kCameraAspect[1]})}};
  scene.extras = {
      {"scene", run.job.scene.name},
      {"program_seconds_per_second", animation_scale(run)},
      {"program_seconds_at_start", static_cast<double>(run.first_shown()) * run.cycles.period_s()}};
  nodes.state_errors(scene.extras);
  scene.nodes = nodes.take();
  const TriMesh pin = pin_mesh(kPinShare * mesh::bounds(models.part.mesh).size().maxCoeff());
  for (const ReviewPin& one : models.pins)
    if (one.place_M) scene.nodes.push_back(pin_node(one, *one.place_M, pin));
  return render::glb_bytes(scene, options.encoding);
}

}  // namespace swarf::reports
