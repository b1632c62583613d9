#include <algorithm>

#include "base/check.h"
#include "toolpath/alarms.h"
#include "toolpath/links.h"
#include "toolpath/orientation.h"
#include "toolpath/pass_family.h"
#include "toolpath/tool_path.h"

namespace swarf::toolpath {
namespace {

/// The area of an operation; a single iso pass (G06.4) is an area that starts on its line.
Area area_of(const program::Operation& operation, const surface::SurfacePtr& surface, const ContactEnd& end) {
  using program::StartBoundary;
  Area area;
  area.surface = surface;
  area.scallop_mm = operation.scallop_mm;
  area.end = end;
  area.zigzag = operation.zigzag;
  area.lean = lean_of(operation.lead_rad, operation.tilt_rad);
  if (operation.kind == program::OperationKind::kIsoPass) {
    area.start_w = operation.iso_v;
    return area;
  }
  area.along_u = operation.start == StartBoundary::kV0 || operation.start == StartBoundary::kV1;
  const bool from_one = operation.start == StartBoundary::kV1 || operation.start == StartBoundary::kU1;
  area.start_w = from_one ? 1.0 : 0.0;
  area.end_w = 1.0 - area.start_w;
  return area;
}

/// The spans of a family in the order and direction of travel.
std::vector<SurfacePass> travelled(const Area& area, const Family& family,
                                   const program::Operation& operation) {
  std::vector<SurfacePass> passes;
  for (size_t k = 0; k < family.passes.size(); ++k) {
    const FamilyPass& from = family.passes[k];
    const bool reversed = area.zigzag && k % 2 == 1;
    for (size_t i = 0; i < from.spans.size(); ++i) {
      const Span& span = from.spans[reversed ? from.spans.size() - 1 - i : i];
      SurfacePass pass;
      pass.surface = area.surface;
      pass.curve = {area.along_u, from.w};
      pass.t_start = reversed ? span.t_high : span.t_low;
      pass.t_end = reversed ? span.t_low : span.t_high;
      pass.feed_mm_s = operation.feed_mm_s;
      pass.chord_tolerance_mm = operation.chord_tolerance_mm;
      pass.lead_rad = operation.lead_rad;
      pass.tilt_rad = operation.tilt_rad;
      pass.interval_mm = from.interval_mm;
      pass.scallop_theory_mm = from.scallop_theory_mm;
      pass.pass = static_cast<int>(k);
      passes.push_back(std::move(pass));
    }
  }
  return passes;
}

/// The family of one operation; empty when it went to the diagnostics.
Family family_of(Area& area, const OperationContext& context, const PlanOptions& options,
                 Diagnostics& diagnostics) {
  if (!check_lean(area, context, diagnostics)) return {};
  const bool single = context.operation->kind == program::OperationKind::kIsoPass;
  const double w_last = single ? area.start_w : area.end_w;
  if (!check_gouging(area, area.start_w, w_last, context, diagnostics)) return {};
  extend_beyond_edges(area, options.overrun_mm);
  Family family;
  if (single) {
    FamilyPass pass;
    pass.w = CubicSpline::constant(area.start_w);
    pass.spans = {with_overrun(area, pass.w, {}, options.overrun_mm)};
    family.passes = {pass};
    area.continues_across = true;  // not asked for
  } else {
    if (!check_pass_count(area, context, diagnostics)) return {};
    family = plan_family(area, options.planner, options.overrun_mm);
  }
  report_family(area, family, context, diagnostics);
  return family;
}

}  // namespace

const char* planner_name(Planner planner) {
  switch (planner) {
    case Planner::kConstantScallop:
      return "constant_scallop";
    case Planner::kLinKoren:
      return "lin_koren";
    case Planner::kIsoparametric:
      return "isoparametric";
  }
  return "unknown";
}

ToolPath plan(const program::Program& program, const cutter::Cutter& cutter, const PlanOptions& options,
              Diagnostics& diagnostics) {
  SWARF_CHECK(has_contact_end(cutter), "the planners know flat ends, balls and bull noses only");
  ToolPath path;
  path.planner = planner_name(options.planner);
  for (size_t i = 0; i < program.operations.size(); ++i) {
    const program::Operation& operation = program.operations[i];
    const program::SurfaceDefinition& definition = program.surfaces.at(operation.surface);
    const OperationContext context{&operation, definition.number, cutter.diameter_mm};
    Diagnostics found;
    Area area = area_of(operation, definition.surface, contact_end(cutter));
    const Family family = family_of(area, context, options, found);
    if (!found.has_errors()) {
      append_passes(path, travelled(area, family, operation), static_cast<int>(i), operation.where, cutter,
                    options, found);
      path.passes += static_cast<int>(family.passes.size());
    }
    diagnostics.append(found);
  }
  return path;
}

}  // namespace swarf::toolpath
