#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "mesh/mesh_ops.h"
#include "render/figures/colour.h"
#include "render/gltf/gltf_writer.h"
#include "reports/part_view.h"
#include "reports/pictures.h"

namespace swarf::reports {
namespace {

constexpr double kAnimationSeconds =
    30.0;  // the program is played in so long, or in its own time if that is shorter
constexpr size_t kPosesPerSecond = 60;      // before thinning
constexpr double kMachinePartError = 0.02;  // mm; the part in machine.glb is only looked at

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

/// Cycles spread evenly over the program.
std::vector<motion::Cycle> animation_cycles(const FinishedRun& run) {
  return run.shown_cycles(static_cast<size_t>(kAnimationSeconds) * kPosesPerSecond + 1);
}

}  // namespace

double animation_scale(const FinishedRun& run) {
  return std::max(1.0, run.shown_s() / kAnimationSeconds);
}

void write_part_glb(const FinishedRun& run, const DisplayMesh& part, const std::string& path) {
  auto [measured, rest] = split_by_measure(part.mesh);
  const render::DeviationScale scale = deviation_scale(run.job);
  render::colour_by_deviation(measured, scale);
  render::GltfScene scene;
  if (!measured.triangles.empty()) {
    scene.nodes.push_back({"machined surface", &measured, {{1.0F, 1.0F, 1.0F}, 0.0F, 0.6F}, -1, {}, {}, {}});
  }
  if (!rest.triangles.empty()) scene.nodes.push_back({"part", &rest, kStockMaterial, -1, {}, {}, {}});
  scene.lines = fan_lines(run);
  scene.extras = {{"scene", run.job.scene.name},
                  {"deviation_scale_below_um", fmt::format("{:g}", scale.below_um)},
                  {"deviation_scale_above_um", fmt::format("{:g}", scale.above_um)},
                  {"decimation_error_um", fmt::format("{:.4f}", um_from_mm(part.error_mm))}};
  render::write_glb(path, scene);
}

DisplayMesh display_mesh(const FinishedRun& run, const TriMesh& closed, double max_error_mm) {
  DisplayMesh display;
  display.mesh = shown_part(run, mesh::decimate(closed, max_error_mm, &display.error_mm));
  return display;
}

void write_machine_glb(const FinishedRun& run, const DisplayMesh& part, const std::string& path) {
  const MachineView view(run.job);
  TriMesh shown = mesh::decimate(part.mesh, kMachinePartError, nullptr);
  shown.deviation_um.clear();
  mesh::split_creases(shown, kCreaseRad);  // decimate() has joined them
  const double scale = animation_scale(run);
  const double start_s = static_cast<double>(run.first_shown()) * run.cycles.period_s();
  std::vector<double> times;
  std::vector<std::vector<Pose>> link_poses(run.job.machine.links.size());
  const size_t tools = run.job.scene.tools.size();
  std::vector<std::vector<Pose>> tool_poses(tools);
  std::vector<std::vector<uint8_t>> tool_shown(tools);
  std::vector<Pose> work_poses;
  for (const motion::Cycle& cycle : animation_cycles(run)) {
    const kinematics::AxisValues& q = cycle.q;
    times.push_back((cycle.sample.t_s - start_s) / scale);
    const std::vector<Pose> poses = machine::link_poses(run.job.machine, q);
    for (size_t link = 0; link < poses.size(); ++link) link_poses[link].push_back(poses[link]);
    for (size_t tool = 0; tool < tools; ++tool) {
      tool_poses[tool].push_back(view.tool_pose(q, tool));
      tool_shown[tool].push_back(static_cast<size_t>(cycle.sample.tool) == tool ? 1 : 0);
    }
    work_poses.push_back(view.work_pose(q));
  }
  render::GltfScene scene;
  for (size_t link = 0; link < link_poses.size(); ++link) {
    const machine::Link& l = run.job.machine.links[link];
    if (!l.mesh.triangles.empty()) {
      scene.nodes.push_back(
          {l.name, &l.mesh, {l.colour, l.metalness, l.roughness}, -1, times, link_poses[link], {}});
    }
  }
  for (size_t tool = 0; tool < tools; ++tool) {
    const std::string name =
        tools > 1 ? fmt::format(" {}", cutter::call_name(run.job.scene.tools[tool])) : "";
    scene.nodes.push_back(
        {"cutter" + name, &view.cutter(tool), kToolMaterial, -1, times, tool_poses[tool], tool_shown[tool]});
    const int cutter = static_cast<int>(scene.nodes.size()) - 1;
    scene.nodes.push_back(
        {"holder" + name, &view.holder(tool), kHolderMaterial, cutter, {}, {view.holder_in_tool(tool)}, {}});
  }
  scene.nodes.push_back({"part", &shown, kStockMaterial, -1, times, work_poses, {}});
  scene.extras = {{"scene", run.job.scene.name},
                  {"program_seconds_per_second", fmt::format("{:g}", scale)},
                  {"program_seconds_at_start", fmt::format("{:g}", start_s)}};
  render::write_glb(path, scene);
}

}  // namespace swarf::reports
