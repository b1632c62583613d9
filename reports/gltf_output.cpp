#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "base/units.h"
#include "mesh/mesh_ops.h"
#include "render/figures/colour.h"
#include "render/gltf/gltf_writer.h"
#include "reports/part_view.h"
#include "reports/pictures.h"

namespace swarf::reports {
namespace {

/// The program is played in at most so long, and about in its own time if that is shorter.
constexpr double kAnimationSeconds = 30.0;
/// A key's rotation as four floats, rad: each is off by at most 2^-25, the angle by twice their norm.
constexpr double kQuaternionError = 4.0 / (1U << 25U);
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

/// Seconds of the animation for each cycle: a power of two, so that the time of every key is a float exactly.
double cycle_seconds(const FinishedRun& run) {
  const double own = std::exp2(std::round(std::log2(run.cycles.period_s())));
  const auto cycles = static_cast<double>(std::max<size_t>(run.last_shown() - run.first_shown(), 1));
  return std::min(own, std::exp2(std::floor(std::log2(kAnimationSeconds / cycles))));
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

/// The machine as a tree of nodes: an axis moves its own node alone, in straight lines between its keys.
class MachineNodes {
 public:
  MachineNodes(const FinishedRun& run, const MachineView& view, const motion::AxisKeys& keys)
      : run_(run), view_(view), keys_(keys), seconds_(cycle_seconds(run)) {
    for (const machine::Link& link : run.job.machine.links) add_link(link);
  }
  void add_tools();
  void add_part(const TriMesh& part);
  std::vector<render::GltfNode> take() { return std::move(nodes_); }
  /// How far each axis strays from the cycles between its keys.
  void state_errors(std::map<std::string, std::string>& extras) const;

 private:
  void add_link(const machine::Link& link);
  int add(render::GltfNode node) {
    nodes_.push_back(std::move(node));
    return static_cast<int>(nodes_.size()) - 1;
  }
  int moving_node(const machine::Link& link, int parent);

  const FinishedRun& run_;
  const MachineView& view_;
  const motion::AxisKeys& keys_;
  double seconds_;
  std::vector<render::GltfNode> nodes_;
  std::vector<int> of_link_;  ///< the node that carries the link's mesh and what hangs on it
};

Pose shifted(const Vec3& by) {
  Pose pose = Pose::Identity();
  pose.translation() = by;
  return pose;
}

/// Carries what its axis moves; of a rotary axis it stands in the axis itself.
int MachineNodes::moving_node(const machine::Link& link, int parent) {
  const kinematics::Axis& axis = run_.job.machine.model.axes[static_cast<size_t>(link.axis)];
  const bool rotary = axis.kind == kinematics::AxisKind::kRotary;
  const Pose stand = rotary ? shifted(axis.origin_M) : Pose::Identity();
  render::GltfNode node{link.name + " " + axis.name, nullptr, {}, parent, {}, {}};
  for (const motion::AxisKey& key : keys_.axes()[static_cast<size_t>(link.axis)].keys()) {
    node.times_s.push_back(static_cast<double>(key.cycle) * seconds_);
    node.poses.push_back(stand.inverse() * kinematics::axis_motion(axis, key.q) * stand);
    node.poses.back().translation() += stand.translation();
  }
  const int moving = add(std::move(node));
  return rotary ? add({link.name + " frame", nullptr, {}, moving, {}, {stand.inverse()}}) : moving;
}

void MachineNodes::add_link(const machine::Link& link) {
  int node = link.parent < 0 ? -1 : of_link_[static_cast<size_t>(link.parent)];
  if (link.axis >= 0) node = moving_node(link, node);
  of_link_.push_back(
      link.mesh.triangles.empty()
          ? node
          : add({link.name, &link.mesh, {link.colour, link.metalness, link.roughness}, node, {}, {}}));
}

void MachineNodes::add_tools() {
  const std::vector<cutter::Cutter>& tools = run_.job.scene.tools;
  const int parent = of_link_[static_cast<size_t>(run_.job.machine.tool_link)];
  for (size_t tool = 0; tool < tools.size(); ++tool) {
    const std::string name = tools.size() > 1 ? fmt::format(" {}", cutter::call_name(tools[tool])) : "";
    render::GltfNode cutter{"cutter" + name, &view_.cutter(tool), kToolMaterial, parent, {}, {}};
    for (const motion::AxisKeys::ToolKey& key : keys_.tools()) {
      cutter.times_s.push_back(static_cast<double>(key.cycle) * seconds_);
      cutter.poses.push_back(view_.tool_pose(kinematics::AxisValues::Zero(), tool));
      cutter.shown.push_back(static_cast<size_t>(key.tool) == tool ? 1 : 0);
    }
    const int node = add(std::move(cutter));
    add({"holder" + name, &view_.holder(tool), kHolderMaterial, node, {}, {view_.holder_in_tool(tool)}});
  }
}

void MachineNodes::add_part(const TriMesh& part) {
  add({"part",
       &part,
       kStockMaterial,
       of_link_[static_cast<size_t>(run_.job.machine.work_link)],
       {},
       {view_.work_pose(kinematics::AxisValues::Zero())}});
}

void MachineNodes::state_errors(std::map<std::string, std::string>& extras) const {
  const std::vector<kinematics::Axis>& axes = run_.job.machine.model.axes;
  for (size_t i = 0; i < axes.size(); ++i) {
    const motion::KeyLine& line = keys_.axes()[i];
    double farthest = 0.0;
    for (const motion::AxisKey& key : line.keys()) farthest = std::max(farthest, std::abs(key.q));
    // A slanted axis has three floats for one value.
    const bool rotary = axes[i].kind == kinematics::AxisKind::kRotary;
    const double error = line.error() + (rotary ? kQuaternionError : farthest * std::exp2(-23.0));
    extras[fmt::format("key_error_max_{}_{}", axes[i].name, rotary ? "deg" : "mm")] =
        fmt::format("{:.6f}", rotary ? deg_from_rad(error) : error);
    extras[fmt::format("keys_{}", axes[i].name)] = fmt::format("{}", line.keys().size());
  }
}

}  // namespace

double animation_scale(const FinishedRun& run) {
  return run.cycles.period_s() / cycle_seconds(run);
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
  std::optional<motion::AxisKeys> own;
  if (run.keys == nullptr || run.window) own = keys_of(run);
  MachineNodes nodes(run, view, own ? *own : *run.keys);
  nodes.add_tools();
  nodes.add_part(shown);
  render::GltfScene scene;
  scene.extras = {{"scene", run.job.scene.name},
                  {"program_seconds_per_second", fmt::format("{}", animation_scale(run))},
                  {"program_seconds_at_start",
                   fmt::format("{}", static_cast<double>(run.first_shown()) * run.cycles.period_s())}};
  nodes.state_errors(scene.extras);
  scene.nodes = nodes.take();
  render::write_glb(path, scene);
}

}  // namespace swarf::reports
