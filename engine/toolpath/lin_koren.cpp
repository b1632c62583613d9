#include "toolpath/lin_koren.h"

#include <cmath>

#include "toolpath/offset_walk.h"

namespace swarf::toolpath {

NextPass next_lin_koren(const Area& area, const CubicSpline& previous) {
  constexpr int kRounds = 4;
  constexpr double kExcess = 1e-6;  // relative; each round leaves about a hundredth of the excess
  double chord = minimum_interval(area, previous, IntervalRule::kPaper).chord_mm;
  NextPass next;
  for (int i = 0; i < kRounds; ++i) {
    const auto rule = [chord](double) { return chord; };
    next = graph_of(area, previous, offset_walk(area, previous, rule));
    if (next.outcome != NextPass::kOk) return next;
    const double scallop = measure_strip(area, previous, next.w, 0.0, 1.0).scallop_max_mm;
    if (scallop <= area.scallop_mm * (1.0 + kExcess)) break;
    chord *= std::sqrt(area.scallop_mm / scallop);
  }
  return next;
}

}  // namespace swarf::toolpath
