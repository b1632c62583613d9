#include "sim/job/driven_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/mesh_io.h"
#include "mesh/mesh_ops.h"
#include "position/concave_radius.h"
#include "position/face_target.h"
#include "position/mesh_target.h"
#include "position/patch_target.h"

namespace swarf::sim {
namespace {

class MeshPart final : public position::Target {
 public:
  explicit MeshPart(const TriMesh& mesh) : target_(mesh) {}
  void raise(const position::ToolProfile& profile, const position::GuideLine& line, position::Rest& best,
             position::Near& near) const override {
    target_.raise(profile, line, best, near.triangle);
  }

 private:
  position::MeshTarget target_;
};

/// A position that is not proven drives nothing.
[[noreturn]] void refuse_position(const position::GuideLine& line, double gap_mm) {
  const Vec3& p = line.point_W;
  throw InputError(
      "position-not-proven", {},
      fmt::format("over ({:.6f}, {:.6f}) mm the tool may have to stand {:.3g} mm higher than where "
                  "it was found to touch: the search gave up after {} cells",
                  p.x(), p.y(), gap_mm, position::PatchTarget::kMostLeaves),
      "the cutter fits a hollow of the part exactly there, or runs along a wall at its own radius: "
      "move the guide by a micrometre, or take a smaller cutter");
}

class PatchPart final : public position::Target {
 public:
  explicit PatchPart(std::vector<position::Patch> patches) : target_(std::move(patches)) {}
  void raise(const position::ToolProfile& profile, const position::GuideLine& line, position::Rest& best,
             position::Near& near) const override {
    position::PatchWork work;
    target_.raise(profile, line, best, near.patch, work);
    if (work.gap > position::kPatchProof_mm) refuse_position(line, work.gap);
  }

 private:
  position::PatchTarget target_;
};

class FacePart final : public position::Target {
 public:
  explicit FacePart(const std::vector<surface::Face>& faces) : target_(faces) {}
  void raise(const position::ToolProfile& profile, const position::GuideLine& line, position::Rest& best,
             position::Near& near) const override {
    position::PatchWork work;
    target_.raise(profile, line, best, near, work);
    if (work.gap > position::kPatchProof_mm) refuse_position(line, work.gap);
  }

 private:
  position::FaceTarget target_;
};

Box bounds_of(const surface::Surface& surface) {
  constexpr int kParts = 64;
  Box box{Vec3::Constant(std::numeric_limits<double>::infinity()),
          Vec3::Constant(-std::numeric_limits<double>::infinity())};
  for (int i = 0; i <= kParts; ++i) {
    for (int k = 0; k <= kParts; ++k) {
      const Vec3 p = surface.point(double(i) / kParts, double(k) / kParts);
      box = {box.lower.cwiseMin(p), box.upper.cwiseMax(p)};
    }
  }
  return box;
}

/// The box that holds a box, in other directions.
Box turned(const Box& box, const position::GuideLine& plane) {
  Box out{Vec3::Constant(std::numeric_limits<double>::infinity()),
          Vec3::Constant(-std::numeric_limits<double>::infinity())};
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p =
        plane.local({(corner & 1 ? box.upper : box.lower).x(), (corner & 2 ? box.upper : box.lower).y(),
                     (corner & 4 ? box.upper : box.lower).z()});
    out = {out.lower.cwiseMin(p), out.upper.cwiseMax(p)};
  }
  return out;
}

/// The rectangle around the part as seen from above.
Box bounds_of(const Job& job) {
  if (job.design_mesh) return mesh::bounds(*job.design_mesh);
  Box box = bounds_of(*job.design.front());
  for (const surface::SurfacePtr& surface : job.design) {
    const Box one = bounds_of(*surface);
    box = {box.lower.cwiseMin(one.lower), box.upper.cwiseMax(one.upper)};
  }
  return box;
}

void fill_area(Job& job) {
  DrivenSettings& driven = *job.scene.driven;
  if (driven.area_said || driven.plan.mode == toolpath::GuideMode::kGuide ||
      driven.plan.mode == toolpath::GuideMode::kSpiral)
    return;
  const Box box = turned(bounds_of(job), position::turned_line(Vec3::Zero(), driven.plan.axis_W));
  driven.plan.area = {Vec2(box.lower.head<2>()), Vec2(box.upper.head<2>())};
  job.scene.assumptions.push_back({"Area",
                                   fmt::format("X {:.3f} to {:.3f}, Y {:.3f} to {:.3f} mm", box.lower.x(),
                                               box.upper.x(), box.lower.y(), box.upper.y()),
                                   "the rectangle around the part", "driven.area_mm"});
}

/// A ball that is rounder than the part's narrowest hollow gouges nothing and leaves material there. Hollows
/// that loops have cut away may be told too; other shapes bridge every hollow with their bottom.
void check_hollows(const Job& job, const std::vector<position::Patch>& patches, Diagnostics& diagnostics) {
  constexpr size_t kMostCells = 20'000;
  const cutter::Cutter& tool = job.scene.tools.front();
  if (tool.shape != cutter::Shape::kBall) return;
  const position::ConcaveRadius hollow = position::smallest_concave_radius(patches, kMostCells);
  const double radius = 0.5 * tool.diameter_mm;
  const Vec3& p = hollow.place_W;
  const position::Patch* patch = hollow.patch >= 0 ? &patches[static_cast<size_t>(hollow.patch)] : nullptr;
  const bool cut_away = patch != nullptr && patch->domain != nullptr && !patch->domain->inside(hollow.uv);
  if (hollow.radius >= radius || cut_away) return;
  diagnostics.warning(
      "cutter-too-round", job.scene.driven->where,
      fmt::format(
          "the part has a hollow of radius {:.4g} mm at ({:.3f}, {:.3f}, {:.3f}) mm: the ball of radius {:g} "
          "mm rides over it and leaves material there",
          hollow.radius, p.x(), p.y(), p.z(), radius),
      hollow.at_least > 0.0
          ? fmt::format("a ball D{:.3g} touches everywhere inside the faces (proven)", 2.0 * hollow.at_least)
          : "take a smaller ball");
}

}  // namespace

void load_driven(Job& job, Diagnostics& diagnostics) {
  DrivenSettings& driven = *job.scene.driven;
  if (driven.by_design && job.design.empty()) {
    diagnostics.error(
        "driven-without-surface", driven.where,
        "[driven] by_design needs surfaces in [design], and there are none",
        "describe them ([design] kind = \"nurbs\"), or name a file: driven.surface, driven.mesh or "
        "driven.step");
    return;
  }
  position::Part part;
  part.floor_mm = driven.floor_mm;
  if (driven.mesh) {
    part.targets.push_back(std::make_shared<MeshPart>(*job.design_mesh));
  } else if (driven.step) {
    part.targets.push_back(std::make_shared<FacePart>(job.driven_faces));
    check_hollows(job, position::patches_of(job.driven_faces), diagnostics);
  } else {
    std::vector<position::Patch> patches;
    for (const surface::SurfacePtr& surface : job.design) patches.push_back({surface});
    check_hollows(job, patches, diagnostics);
    part.targets.push_back(std::make_shared<PatchPart>(std::move(patches)));
  }
  fill_area(job);
  const position::GuideLine plane = position::turned_line(Vec3::Zero(), driven.plan.axis_W);
  driven.plan.stock_top_mm = turned(job.scene.stock.box_W, plane).upper.z();
  try {
    job.driven = std::make_shared<toolpath::DrivenPart>(
        toolpath::DrivenPart{std::move(part), position::ToolProfile(job.scene.tools.front())});
  } catch (const InputError& error) {
    diagnostics.append(error.diagnostics);
  }
}

toolpath::ToolPath driven_path(const Job& job, double cam_tolerance_mm, Diagnostics& diagnostics) {
  toolpath::DrivenPlan plan = job.scene.driven->plan;
  plan.cam_tolerance_mm = cam_tolerance_mm;
  return toolpath::driven_path(plan, job.driven, job.scene.driven->where, diagnostics);
}

}  // namespace swarf::sim
