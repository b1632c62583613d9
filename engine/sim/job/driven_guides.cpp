#include "sim/job/driven_guides.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "kinematics/reach.h"
#include "position/part_check.h"
#include "position/patch_joints.h"

namespace swarf::sim {
namespace {

using position::GuideLine;
using toolpath::DrivenPass;

std::string place_text(const Vec3& p) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f}) mm", p.x(), p.y(), p.z());
}

/// A ball of a micrometre's radius: it finds what lies under an axis.
position::ToolProfile needle() {
  cutter::Cutter tool;
  tool.shape = cutter::Shape::kBall;
  tool.corner_radius_mm = 1e-3;
  tool.diameter_mm = 2.0 * tool.corner_radius_mm;
  return position::ToolProfile(tool);
}

/// How far the tool gets beyond the part.
class PartUnderAxis {
 public:
  PartUnderAxis(const Job& job)
      : part_(job.driven->part), needle_(needle()), where_(job.scene.driven->where) {
    part_.floor_mm.reset();
  }

  void see(const DrivenPass& pass, const GuideLine& line, double length) {
    if (is_over(line)) return;
    if (length_mm_ == 0.0) {
      pass_ = pass.pass;
      first_ = line.point_W;
    }
    length_mm_ += length;
  }

  void tell(Diagnostics& diagnostics) const {
    if (length_mm_ == 0.0) return;
    diagnostics.warning(
        "guide-beyond-part", where_,
        fmt::format(
            "along {:.1f} mm of the guides, first of pass {} at ({:.3f}, {:.3f}) mm, nothing of the part "
            "lies under the tool's axis: the tool rolls over the part's end there, or stands on floor_mm",
            length_mm_, pass_ + 1, first_.x(), first_.y()),
        "keep the guides on the part: area_mm, guide_mm, or centre_mm and radius_mm");
  }

 private:
  /// A position that is not proven, as beside a wall along the axis, has something under it.
  bool is_over(const GuideLine& line) {
    try {
      return part_.rest(needle_, line, near_).touches();
    } catch (const InputError&) {
      return true;
    }
  }

  position::Part part_;
  position::ToolProfile needle_;
  SourceLocation where_;
  position::Near near_;
  double length_mm_ = 0.0;
  int pass_ = 0;
  Vec3 first_ = Vec3::Zero();
};

/// The worst of each axis over the poses that have been seen.
class TravelLook {
 public:
  explicit TravelLook(const Job& job)
      : machine_(machines_by_tool(job).front()), inverse_(machine_), where_(job.scene.driven->where) {
    for (size_t i = 0; i < machine_.axes.size(); ++i)
      q_[static_cast<Eigen::Index>(i)] = machine_.axes[i].home;
    worst_.resize(machine_.axes.size());
  }

  void see(const ToolPose& pose, const std::string& name) {
    const kinematics::Branch branch = inverse_.solve_nearest(pose, q_);
    if (branch.outcome == kinematics::InverseOutcome::kUnreachable) {
      if (unreached_.empty()) unreached_ = name + " at " + place_text(pose.tip_W);
      return;
    }
    q_ = branch.q;
    for (size_t i = 0; i < worst_.size(); ++i) {
      const double value = q_[static_cast<Eigen::Index>(i)];
      const double excess = std::abs(kinematics::travel_excess(machine_.axes[i], value));
      if (excess > worst_[i].excess) worst_[i] = {excess, value, name + " at " + place_text(pose.tip_W)};
    }
  }

  void tell(Diagnostics& diagnostics) const {
    constexpr double kRounding = 1e-9;  // mm or rad
    const char* fix =
        "move setup.work_origin_mm, turn the part (setup.work_rotation_deg), or lean the tool less "
        "(lead_deg, tilt_deg)";
    if (!unreached_.empty())
      diagnostics.warning("driven-travel", where_,
                          "no values of the machine's axes bring the tool to its pose in " + unreached_, fix);
    for (size_t i = 0; i < worst_.size(); ++i)
      if (worst_[i].excess > kRounding)
        diagnostics.warning("driven-travel", where_,
                            kinematics::travel_text(machine_.axes[i], worst_[i].value, worst_[i].place), fix);
  }

 private:
  struct Worst {
    double excess = 0.0, value = 0.0;
    std::string place;
  };

  kinematics::MachineModel machine_;
  kinematics::InverseKinematics inverse_;
  SourceLocation where_;
  kinematics::AxisValues q_ = kinematics::AxisValues::Zero();
  std::vector<Worst> worst_;
  std::string unreached_;
};

/// Every line of a pass that is looked at, with the tool at rest on it; false where it rests on nothing.
template <typename See>
bool each_line(const DrivenPass& pass, const SourceLocation& where, Diagnostics& diagnostics, See see) {
  const double end = pass.guide->end();
  const double parts = std::max(1.0, std::ceil(end / kGuideLook_mm));
  position::Near near;
  for (double i = 0.0; i <= parts; i += 1.0) {
    const double x = end * (i / parts);
    const toolpath::TipPoint tip = toolpath::tip_at(pass, x, near);
    const GuideLine line = pass.guide->line(x);
    if (!std::isfinite(tip.rest.height)) {
      diagnostics.error("guide-misses-part", where,
                        fmt::format("pass {}: the tool rests on nothing at ({:.3f}, {:.3f}) mm",
                                    pass.pass + 1, line.point_W.x(), line.point_W.y()),
                        "keep the guide on the part (area_mm), or say how low the tool may go: floor_mm");
      return false;
    }
    // Each look stands for half of the way on both sides of it.
    const double share = i == 0.0 || i == parts ? 0.5 : 1.0;
    see(line, tip.pose, share * end / parts);
  }
  return true;
}

/// Of the joints under a guide those with the widest gap and with the highest step.
struct WorstJoints {
  const position::OpenJoint *gap = nullptr, *step = nullptr;
};

WorstJoints under_guides(const std::vector<position::OpenJoint>& joints, const std::vector<GuideLine>& lines,
                         double radius) {
  WorstJoints worst;
  for (const position::OpenJoint& joint : joints) {
    const Vec3 middle = joint.at + 0.5 * joint.to;
    const bool met = std::any_of(lines.begin(), lines.end(), [&](const GuideLine& line) {
      return line.local(middle).head<2>().norm() <= radius + kGuideLook_mm;
    });
    if (!met) continue;
    if (joint.gap_mm > position::kJoined_mm && (worst.gap == nullptr || joint.gap_mm > worst.gap->gap_mm))
      worst.gap = &joint;
    const double step = std::abs(joint.step_mm);
    if (step > position::kJoined_mm && (worst.step == nullptr || step > std::abs(worst.step->step_mm)))
      worst.step = &joint;
  }
  return worst;
}

void tell_gap(const Job& job, const position::OpenJoint& joint, Diagnostics& diagnostics) {
  const DrivenSettings& driven = *job.scene.driven;
  const double sink = position::sinks_into(job.driven->profile, joint.gap_mm);
  const std::string text = fmt::format("surfaces {} and {} leave a gap of {:.4g} mm at {}: ", joint.patch + 1,
                                       joint.other + 1, joint.gap_mm, place_text(joint.at));
  const char* fix = "let the surfaces meet, take a wider cutter, or say how low the tool may go: floor_mm";
  const std::string depth = std::isfinite(sink)
                                ? fmt::format("the tip sinks into it by up to {:.3g} um", um_from_mm(sink))
                                : "the cutter falls through";
  if (sink <= driven.plan.chord_tolerance_mm)
    diagnostics.warning("part-gap", driven.where, text + "the cutter rides over it; " + depth, fix);
  else if (driven.floor_mm)
    diagnostics.warning("part-gap-wide", driven.where, text + depth, fix);
  else
    diagnostics.error("part-gap-wide", driven.where, text + depth, fix);
}

void tell_joints(const Job& job, const std::vector<GuideLine>& lines, Diagnostics& diagnostics) {
  if (job.scene.driven->mesh || job.scene.driven->step) return;
  std::vector<position::Patch> patches;
  for (const surface::SurfacePtr& surface : job.design) patches.push_back({surface});
  const double radius = job.driven->profile.radius();
  const std::vector<position::OpenJoint> joints = position::open_joints(patches, 2.0 * radius);
  const WorstJoints worst = under_guides(joints, lines, radius);
  if (worst.gap != nullptr) tell_gap(job, *worst.gap, diagnostics);
  if (worst.step == nullptr) return;
  const position::OpenJoint& step = *worst.step;
  diagnostics.warning(
      "part-step", job.scene.driven->where,
      fmt::format(
          "surface {} ends {:.4g} mm {} surface {} at {}: no surface closes the step; the border above "
          "stops the tool, which gouges neither and leaves the step",
          step.patch + 1, std::abs(step.step_mm), step.step_mm > 0.0 ? "below" : "above", step.other + 1,
          place_text(step.at)),
      "let the surfaces meet, or add the wall between them");
}

}  // namespace

void look_along_guides(const Job& job, const toolpath::Elements& elements, Diagnostics& diagnostics) {
  PartUnderAxis under(job);
  TravelLook travel(job);
  std::vector<GuideLine> lines;
  const DrivenSettings& driven = *job.scene.driven;
  for (size_t i = 0; i < elements.size(); ++i) {
    const toolpath::Element element = elements[i];
    if (const auto* move = std::get_if<toolpath::FreeMove>(&element.what)) {
      travel.see(move->from, "a free move");
      travel.see(move->to, "a free move");
    }
    const auto* pass = std::get_if<DrivenPass>(&element.what);
    if (pass == nullptr) continue;
    const bool rests = each_line(*pass, driven.where, diagnostics,
                                 [&](const GuideLine& line, const ToolPose& pose, double length) {
                                   if (!driven.plan.follows) under.see(*pass, line, length);
                                   travel.see(pose, fmt::format("pass {}", pass->pass + 1));
                                   lines.push_back(line);
                                 });
    if (!rests) return;
  }
  under.tell(diagnostics);
  travel.tell(diagnostics);
  tell_joints(job, lines, diagnostics);
}

}  // namespace swarf::sim
