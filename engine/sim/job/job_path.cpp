#include "sim/job/job_path.h"

#include <fmt/format.h>

#include <utility>

#include "motion/blocks/dog_leg.h"
#include "sim/job/driven_guides.h"
#include "sim/job/driven_part.h"
#include "sim/job/flank_job.h"
#include "sim/job/nc_job.h"
#include "toolpath/cl_path.h"

namespace swarf::sim {
namespace {

toolpath::ToolPath plan_surfaces(const Job& job, toolpath::Planner planner, Diagnostics& diagnostics) {
  toolpath::PlanOptions options = job.scene.toolpath;
  options.planner = planner;
  toolpath::ToolPath path = toolpath::plan(job.program, job.scene.tools.front(), options, diagnostics);
  if (!job.scene.chord_tolerance_mm) return path;
  toolpath::Elements elements;
  for (toolpath::Element element : path.elements) {
    if (auto* pass = std::get_if<toolpath::SurfacePass>(&element.what))
      pass->chord_tolerance_mm = *job.scene.chord_tolerance_mm;
    elements.push_back(std::move(element));
  }
  path.elements = std::move(elements);
  return path;
}

/// As its surface drives it, or as CAM blocks; before either its guides are looked along.
toolpath::ToolPath path_over_part(const Job& job, Diagnostics& diagnostics) {
  toolpath::ToolPath driven = driven_path(job, 0.0, diagnostics);
  if (!diagnostics.has_errors()) look_along_guides(job, driven.elements, diagnostics);
  const double tolerance = job.scene.driven->plan.cam_tolerance_mm;
  if (tolerance <= 0.0 || diagnostics.has_errors()) return driven;
  return driven_path(job, tolerance, diagnostics);
}

JobPath path_of_program(const Job& job, toolpath::Planner planner, Diagnostics& diagnostics) {
  switch (job.scene.kind) {
    case ProgramKind::kNc: {
      toolpath::NcPath nc = read_nc_program(job, diagnostics);
      return {std::move(nc.path), std::move(nc.reading)};
    }
    case ProgramKind::kCl:
      return {toolpath::cl_path(*job.cl, job.scene.block_law, diagnostics, cl_tools(job)), {}};
    case ProgramKind::kDriven:
      return {path_over_part(job, diagnostics), {}};
    case ProgramKind::kFlank:
      return {flank::flank_path(job.flank, flank_rule(job)), {}};
    case ProgramKind::kSurfaceBlocks:
      break;
  }
  return {plan_surfaces(job, planner, diagnostics), {}};
}

/// mm, a thousand kilometres: beyond it no machine goes, and squares of what is far beyond overflow.
constexpr double kFarthestTip = 1e9;

/// No place of the tip may lie where nothing can be computed with it.
void check_places(const toolpath::ToolPath& path) {
  if (!path.elements.hold_blocks()) return;
  for (size_t i = 0; i < path.elements.size(); ++i) {
    const Vec3 tip = path.elements.block(i).to.tip_W;
    if (tip.cwiseAbs().maxCoeff() <= kFarthestTip) continue;
    throw InputError("out-of-range", path.elements.where(i),
                     fmt::format("this block goes to ({:.4g}, {:.4g}, {:.4g}) mm, {:g} km away", tip.x(),
                                 tip.y(), tip.z(), tip.cwiseAbs().maxCoeff() * 1e-6),
                     "write positions and offsets that a machine can reach");
  }
}

JobPath with_rapids(const Job& job, toolpath::Planner planner, Diagnostics& diagnostics) {
  JobPath found = path_of_program(job, planner, diagnostics);
  diagnostics.throw_if_errors();
  check_places(found.path);
  found.path = motion::with_dog_legs(std::move(found.path), machines_by_tool(job));
  return found;
}

}  // namespace

JobPath job_path(const Job& job, Diagnostics& diagnostics) {
  return with_rapids(job, job.scene.toolpath.planner, diagnostics);
}

toolpath::ToolPath path_by(const Job& job, toolpath::Planner planner, Diagnostics& diagnostics) {
  return with_rapids(job, planner, diagnostics).path;
}

}  // namespace swarf::sim
