#include "reports/machine_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"

namespace swarf::reports {
namespace {

/// The program is played in at most so long, and about in its own time if that is shorter.
constexpr double kAnimationSeconds = 30.0;
/// A key's rotation as four floats, rad: each is off by at most 2^-25, the angle by twice their norm.
constexpr double kQuaternionError = 4.0 / (1U << 25U);

Pose shifted(const Vec3& by) {
  Pose pose = Pose::Identity();
  pose.translation() = by;
  return pose;
}

}  // namespace

double cycle_seconds(const FinishedRun& run) {
  const double own = std::exp2(std::round(std::log2(run.cycles.period_s())));
  const auto cycles = static_cast<double>(std::max<size_t>(run.last_shown() - run.first_shown(), 1));
  return std::min(own, std::exp2(std::floor(std::log2(kAnimationSeconds / cycles))));
}

MachineNodes::MachineNodes(const FinishedRun& run, const MachineView& view, const motion::AxisKeys& keys)
    : run_(run), view_(view), keys_(keys), seconds_(cycle_seconds(run)) {
  for (const machine::Link& link : run.job.machine.links) add_link(link);
}

int MachineNodes::add(render::GltfNode node) {
  nodes_.push_back(std::move(node));
  return static_cast<int>(nodes_.size()) - 1;
}

/// Carries what its axis moves; of a rotary axis it stands in the axis itself.
int MachineNodes::moving_node(const machine::Link& link, int parent) {
  const kinematics::Axis& axis = run_.job.machine.model.axes[static_cast<size_t>(link.axis)];
  const bool rotary = axis.kind == kinematics::AxisKind::kRotary;
  const Pose stand = rotary ? shifted(axis.origin_M) : Pose::Identity();
  render::GltfNode node{link.name + " " + axis.name, nullptr, {}, parent, {}, {}};
  // What a reviewer turns it by: the axis in the node's own frame, and its travel.
  const double unit = rotary ? deg_from_rad(1.0) : 1.0;
  node.extras = {{"role", "axis"},
                 {"axis", axis.name},
                 {"kind", rotary ? "rotary" : "linear"},
                 {"direction_x", axis.direction_M.x()},
                 {"direction_y", axis.direction_M.y()},
                 {"direction_z", axis.direction_M.z()}};
  if (std::isfinite(axis.min)) node.extras[rotary ? "min_deg" : "min_mm"] = unit * axis.min;
  if (std::isfinite(axis.max)) node.extras[rotary ? "max_deg" : "max_mm"] = unit * axis.max;
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
  if (!link.mesh.triangles.empty()) {
    render::GltfNode shape{link.name, &link.mesh, {link.colour, link.metalness, link.roughness},
                           node,      {},         {}};
    shape.extras = {{"role", link.fixture ? "fixture" : "machine"}};
    node = add(std::move(shape));
  }
  of_link_.push_back(node);
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
    cutter.extras = {{"role", "tool"}};
    const int node = add(std::move(cutter));
    render::GltfNode holder{
        "holder" + name, &view_.holder(tool), kHolderMaterial, node, {}, {view_.holder_in_tool(tool)}};
    holder.extras = {{"role", "tool"}};
    add(std::move(holder));
  }
}

render::GltfNode MachineNodes::stock_node(const std::string& name, const TriMesh& mesh,
                                          const render::Material& material) {
  render::GltfNode node{name, &mesh, material, -1, {}, {}};
  node.extras = {{"role", "stock"}};
  return on_work(std::move(node));
}

render::GltfNode MachineNodes::on_work(render::GltfNode node) const {
  node.parent = of_link_[static_cast<size_t>(run_.job.machine.work_link)];
  node.poses = {view_.work_pose(kinematics::AxisValues::Zero())};
  return node;
}

void MachineNodes::add_to_work(render::GltfNode node) {
  add(on_work(std::move(node)));
}

void MachineNodes::add_stock(const std::vector<StockStage>& stages, const TriMesh& part) {
  if (stages.empty()) {
    add(stock_node("part", part, kStockMaterial));
    return;
  }
  const auto time = [&](uint64_t cycle) {
    return static_cast<double>(cycle - run_.first_shown()) * seconds_;
  };
  std::vector<uint64_t> starts;
  for (const StockStage& stage : stages) starts.push_back(stage.cycle);
  starts.push_back(run_.last_shown());
  for (size_t k = 0; k < starts.size(); ++k) {
    const bool last = k == stages.size();
    render::GltfNode node = stock_node(last ? "part" : fmt::format("stock {} of {}", k + 1, stages.size()),
                                       last ? part : stages[k].mesh, kStockMaterial);
    const Pose pose = node.poses.front();
    node.poses.clear();
    // Hidden before its start and from the next stage's start on.
    for (const size_t at : {size_t{0}, k, k + 1}) {
      if (at >= starts.size()) continue;
      const double t_s = time(starts[at]);
      const bool shown = at == k;
      if (!node.times_s.empty() && t_s <= node.times_s.back()) {
        node.shown.back() = shown ? 1 : node.shown.back();
        continue;
      }
      node.times_s.push_back(t_s);
      node.poses.push_back(pose);
      node.shown.push_back(shown ? 1 : 0);
    }
    add(std::move(node));
  }
}

void MachineNodes::state_errors(render::GltfExtras& extras) const {
  const std::vector<kinematics::Axis>& axes = run_.job.machine.model.axes;
  for (size_t i = 0; i < axes.size(); ++i) {
    const motion::KeyLine& line = keys_.axes()[i];
    double farthest = 0.0;
    for (const motion::AxisKey& key : line.keys()) farthest = std::max(farthest, std::abs(key.q));
    // A slanted axis has three floats for one value.
    const bool rotary = axes[i].kind == kinematics::AxisKind::kRotary;
    const double error = line.error() + (rotary ? kQuaternionError + motion::mixing_error(line.longest_step())
                                                : farthest * std::exp2(-23.0));
    extras[fmt::format("key_error_max_{}_{}", axes[i].name, rotary ? "deg" : "mm")] =
        rotary ? deg_from_rad(error) : error;
    extras[fmt::format("keys_{}", axes[i].name)] = static_cast<double>(line.keys().size());
  }
}

}  // namespace swarf::reports
