#include "reports/overview.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "base/units.h"
#include "mesh/mesh_ops.h"
#include "render/camera.h"
#include "render/lettering.h"
#include "render/ray/still.h"
#include "reports/machine_view.h"
#include "sim/run/carried_cuts.h"
#include "stock/stock.h"

namespace swarf::reports {
namespace {

using kinematics::AxisKind;
using kinematics::AxisValues;

constexpr int kPanelWidth = 800, kPanelHeight = 720, kSamples = 4;
constexpr double kOverviewView = 0.45;  // rad, vertical
constexpr double kTurn = 30.0;          // deg
constexpr render::Rgb kFeedColour{0.85F, 0.30F, 0.05F}, kRapidColour{0.10F, 0.30F, 0.75F},
    kEdgeColour{0.15F, 0.16F, 0.18F};

using DrawLines = std::vector<render::DrawLine>;

Box empty_box() {
  return {Vec3::Constant(1e9), Vec3::Constant(-1e9)};
}

void widen(Box& box, const Vec3& point) {
  box.lower = box.lower.cwiseMin(point);
  box.upper = box.upper.cwiseMax(point);
}

Box bounds_of(const std::vector<render::DrawItem>& items) {
  Box box = empty_box();
  for (const render::DrawItem& item : items) {
    for (const Vec3& corner : render::corners(mesh::bounds(*item.mesh))) widen(box, item.X_world * corner);
  }
  return box;
}

/// Beside each other, of one height.
render::Image joined(const render::Image& left, const render::Image& right) {
  render::Image both{left.width + right.width, left.height, {}};
  const auto row = [](const render::Image& image, int y) {
    const auto bytes = static_cast<std::ptrdiff_t>(4) * image.width;
    const auto start = image.rgba.begin() + y * bytes;
    return std::pair{start, start + bytes};
  };
  for (int y = 0; y < both.height; ++y) {
    for (const render::Image* image : {&left, &right}) {
      const auto [from, to] = row(*image, y);
      both.rgba.insert(both.rgba.end(), from, to);
    }
  }
  return both;
}

DrawLines axes_arrows(const Pose& X, double length) {
  const std::array<render::Rgb, 3> colours{
      {{0.80F, 0.05F, 0.05F}, {0.05F, 0.55F, 0.10F}, {0.05F, 0.15F, 0.80F}}};
  DrawLines lines;
  for (int i = 0; i < 3; ++i) {
    const Vec3 end = length * Vec3::Unit(i);
    lines.push_back({{X.translation(), X * end}, colours[static_cast<size_t>(i)], 5.0F});
  }
  return lines;
}

/// Stock and tool may stand anywhere: the picture holds all of it.
render::Image panel(std::vector<render::DrawItem> items, DrawLines lines, const Box& seen,
                    const Vec3& direction, const std::vector<std::string>& caption) {
  render::DrawList list;
  list.items = std::move(items);
  list.lines = std::move(lines);
  list.camera = render::look_at_box(seen, -direction, kOverviewView, double(kPanelWidth) / kPanelHeight);
  render::StillOptions options;
  options.width = kPanelWidth;
  options.height = kPanelHeight;
  options.samples_per_pixel = kSamples;
  options.strip_strength = 0.0;
  render::Image image = render::render_still(list, options);
  render::draw_caption(image, caption);
  return image;
}

const Vec3 kMachineSide(-0.75, -1.0, 0.55), kPartSide(0.55, -0.87, 0.64);

bool is_rotary(const kinematics::Axis& axis) {
  return axis.kind == AxisKind::kRotary;
}

/// A line through each rotary axis, where its link carries it.
DrawLines rotary_lines(const machine::MachineScene& machine, const AxisValues& q, double length) {
  constexpr render::Rgb kAxisColour{0.55F, 0.05F, 0.60F};
  const std::vector<Pose> poses = machine::link_poses(machine, q);
  DrawLines lines;
  for (const machine::Link& link : machine.links) {
    if (link.axis < 0 || !is_rotary(machine.model.axes[static_cast<size_t>(link.axis)])) continue;
    const kinematics::Axis& axis = machine.model.axes[static_cast<size_t>(link.axis)];
    const Pose carried = link.parent < 0 ? Pose::Identity() : poses[static_cast<size_t>(link.parent)];
    const Vec3 reach = length * axis.direction_M;
    lines.push_back(
        {{carried * (axis.origin_M - reach), carried * (axis.origin_M + reach)}, kAxisColour, 3.0F});
  }
  return lines;
}

AxisValues at_zero(const kinematics::MachineModel& model) {
  AxisValues q = AxisValues::Zero();
  for (size_t i = 0; i < model.axes.size(); ++i) {
    const kinematics::Axis& axis = model.axes[i];
    const bool inside = axis.min <= 0.0 && axis.max >= 0.0;
    if (!inside) q[static_cast<long>(i)] = 0.5 * (axis.min + axis.max);
  }
  return q;
}

AxisValues turned(const kinematics::MachineModel& model) {
  AxisValues q = at_zero(model);
  const bool turns = std::any_of(model.axes.begin(), model.axes.end(), is_rotary);
  for (size_t i = 0; i < model.axes.size(); ++i) {
    const kinematics::Axis& axis = model.axes[i];
    double& value = q[static_cast<long>(i)];
    if (is_rotary(axis)) value += rad_from_deg(kTurn);
    if (!turns) value += 0.3 * (axis.max - axis.min);
    value = std::clamp(value, axis.min, axis.max);
  }
  return q;
}

std::string values_text(const kinematics::MachineModel& model, const AxisValues& q) {
  std::string text;
  for (size_t i = 0; i < model.axes.size(); ++i) {
    const double value = q[static_cast<long>(i)];
    text += fmt::format("{}{} {:.1f}{}", text.empty() ? "" : "   ", model.axes[i].name,
                        is_rotary(model.axes[i]) ? deg_from_rad(value) : value,
                        is_rotary(model.axes[i]) ? "°" : " mm");
  }
  return text;
}

TriMesh box_mesh(const Box& box) {
  TriMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p((i & 1) != 0 ? box.upper.x() : box.lower.x(), (i & 2) != 0 ? box.upper.y() : box.lower.y(),
                 (i & 4) != 0 ? box.upper.z() : box.lower.z());
    mesh.positions.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

DrawLines box_edges(const Box& box) {
  const auto corner = [&](int i) {
    return Vec3((i & 1) != 0 ? box.upper.x() : box.lower.x(), (i & 2) != 0 ? box.upper.y() : box.lower.y(),
                (i & 4) != 0 ? box.upper.z() : box.lower.z());
  };
  DrawLines lines;
  for (int i = 0; i < 8; ++i) {
    for (const int step : {1, 2, 4}) {
      if ((i & step) == 0) lines.push_back({{corner(i), corner(i | step)}, kEdgeColour, 2.0F});
    }
  }
  return lines;
}

void append_way(std::vector<Vec3>& points, const toolpath::BlockMove& block) {
  if (block.arc) {
    constexpr int kSteps = 24;
    const Vec3& normal = block.arc->normal_W;
    const Vec3 spoke = block.from.tip_W - block.arc->centre_W;
    const double angle = toolpath::arc_angle(block);
    const Vec3 rise = normal * (block.to.tip_W - block.from.tip_W).dot(normal);
    for (int i = 1; i < kSteps; ++i) {
      const double share = double(i) / kSteps;
      points.push_back(block.arc->centre_W + Eigen::AngleAxisd(share * angle, normal) * spoke + share * rise);
    }
  }
  points.push_back(block.to.tip_W);
}

/// Feed moves and rapids as polylines; of long programs every so many blocks, so that a picture stays a
/// matter of seconds.
DrawLines way_lines(const toolpath::Elements& elements) {
  constexpr size_t kBlocks = 30'000;
  const size_t stride = std::max<size_t>(1, elements.size() / kBlocks);
  DrawLines lines;
  bool was_rapid = false;
  for (size_t i = 0; i < elements.size(); i += stride) {
    const toolpath::BlockMove block = elements.block(i);
    const bool rapid = toolpath::is_rapid(block);
    if (lines.empty() || rapid != was_rapid)
      lines.push_back({{block.from.tip_W}, rapid ? kRapidColour : kFeedColour, rapid ? 1.2F : 2.0F});
    if (stride == 1) {
      append_way(lines.back().points, block);
    } else {
      lines.back().points.push_back(block.to.tip_W);
    }
    was_rapid = rapid;
  }
  return lines;
}

render::Image path_panel(const sim::Job& job, const toolpath::ToolPath& path) {
  const Box& box = job.scene.stock.box_W;
  DrawLines lines = way_lines(path.elements);
  Box seen = box;
  widen(seen, Vec3::Zero());
  for (const render::DrawLine& line : lines) {
    if (line.colour != kFeedColour) continue;  // rapids come from afar
    for (const Vec3& point : line.points) widen(seen, point);
  }
  // The lower face stands for the block, whose inside shall be seen.
  const TriMesh floor = box_mesh({box.lower - Vec3(0, 0, 0.01 * box.size().maxCoeff()),
                                  Vec3(box.upper.x(), box.upper.y(), box.lower.z())});
  for (render::DrawLine& edge : box_edges(box)) lines.push_back(std::move(edge));
  for (render::DrawLine& arrow : axes_arrows(Pose::Identity(), 0.15 * box.size().maxCoeff()))
    lines.push_back(std::move(arrow));
  const Vec3 size = box.size();
  return panel({{&floor, Pose::Identity(), kStockMaterial}}, std::move(lines), seen, kPartSide,
               {job.scene.title, fmt::format("stock {:g} x {:g} x {:g} mm; feed orange, rapids blue",
                                             size.x(), size.y(), size.z())});
}

/// The stock that the program begins with, no finer than a picture shows it.
TriMesh raw_mesh(const sim::Job& job) {
  constexpr double kCells = 150.0;  // along its longest side
  const sim::StockSettings& stock = job.scene.stock;
  if (!stock.shape && job.earlier.empty()) return box_mesh(stock.box_W);
  const double voxel = std::max(stock.voxel_mm, stock.box_W.size().maxCoeff() / kCells);
  return sim::starting_stock(job, *sim::carried_cuts(job), voxel).mesh();
}

/// The machine in the middle of the path.
render::Image work_panel(const sim::Job& job, const toolpath::ToolPath& path) {
  const toolpath::BlockMove block = path.elements.block(path.elements.size() / 2);
  const kinematics::MachineModel& model = job.machine.model;
  const auto tool = static_cast<size_t>(std::max(0, block.tool));
  const kinematics::InverseKinematics inverse(sim::machines_by_tool(job)[tool]);
  const AxisValues q = block.axes ? block.axes->to : inverse.solve_nearest(block.to, at_zero(model)).q;
  const MachineView view(job);
  const TriMesh stock = raw_mesh(job);
  std::vector<render::DrawItem> items = view.items(q, tool, &stock);
  // The work and what is near it: the whole machine would leave the stock a few pixels.
  const Pose X_MW = view.work_pose(q);
  const Vec3 centre = X_MW * job.scene.stock.box_W.centre();
  const double near = 1.1 * job.scene.stock.box_W.size().maxCoeff() + 60.0;
  return panel(std::move(items), axes_arrows(X_MW, 0.3 * near),
               {centre - Vec3::Constant(near), centre + Vec3::Constant(near)}, kMachineSide,
               {model.name, values_text(model, q)});
}

}  // namespace

render::Image machine_overview(const machine::MachineScene& machine) {
  sim::Job job;
  job.machine = machine;
  const MachineView view(job);
  const bool bare = std::all_of(machine.links.begin(), machine.links.end(),
                                [](const machine::Link& link) { return link.mesh.triangles.empty(); });
  // A machine without meshes has nothing to be seen by but this plate under its work.
  const TriMesh plate = box_mesh({Vec3(-100, -100, -20), Vec3(100, 100, 0)});
  const std::array<AxisValues, 2> places{at_zero(machine.model), turned(machine.model)};
  Box seen = empty_box();
  for (const AxisValues& q : places) {
    const Box one = bounds_of(view.items(q, 0, bare ? &plate : nullptr));
    widen(seen, one.lower);
    widen(seen, one.upper);
  }
  const double length = seen.size().maxCoeff();
  std::vector<render::Image> panels;
  for (const AxisValues& q : places) {
    DrawLines lines = axes_arrows(view.work_pose(q), 0.12 * length);
    for (render::DrawLine& line : rotary_lines(machine, q, 0.3 * length)) lines.push_back(std::move(line));
    panels.push_back(panel(view.items(q, 0, bare ? &plate : nullptr), std::move(lines), seen, kMachineSide,
                           {machine.model.name, values_text(machine.model, q)}));
  }
  return joined(panels[0], panels[1]);
}

render::Image job_overview(const sim::Job& job, const toolpath::ToolPath& path) {
  if (!path.elements.hold_blocks())
    throw InputError("nothing-to-show", {job.scene.file}, "surface blocks are shown by their run",
                     "run the scene, then 'swarf render DIR --still part.png'");
  return joined(path_panel(job, path), work_panel(job, path));
}

}  // namespace swarf::reports
