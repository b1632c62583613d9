// The passes of one area: from the first boundary across the part until nothing above the scallop is left.
#pragma once

#include <vector>

#include "toolpath/grid_step.h"

namespace swarf::toolpath {

/// A part of a pass to be cut, t_low < t_high, overrun included.
struct Span {
  double t_low = 0.0, t_high = 1.0;
};

/// One pass of the family. Beyond the last boundary only the spans are cut under which material is left.
struct FamilyPass {
  CubicSpline w;
  std::vector<Span> spans;
  double interval_mm = 0.0;        ///< least chord to the previous pass; 0 for the first
  double scallop_theory_mm = 0.0;  ///< greatest cusp between this and the previous pass
};

/// Where a pass of the area asks for more than the cutter's width.
struct ReachProblem {
  double u = 0.0, v = 0.0;
  Interval interval;
};

struct Family {
  std::vector<FamilyPass> passes;
  std::vector<ReachProblem> unreachable;      ///< at most one; the family then ends there
  NextPass::Outcome outcome = NextPass::kOk;  ///< of the step that ended the family early
  double failed_t = 0.0;
};

/// The first pass lies on the first boundary. The last ones run partly beyond the opposite boundary where the
/// surface continues; where it does not, passes stop at the boundary and the last lies on it.
Family plan_family(const Area& area, Planner planner, double overrun_mm);

/// The part [t_low, t_high] of a pass, lengthened by the overrun at both ends as far as the grid reaches.
Span with_overrun(const Area& area, const CubicSpline& w, Span span, double overrun_mm);

/// The worst place of a pass within the part where the interval exceeds the reach of the cutter, if any.
std::vector<ReachProblem> beyond_reach(const Area& area, const CubicSpline& w, IntervalRule rule);

}  // namespace swarf::toolpath
