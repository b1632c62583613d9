#include "papers/lin_koren.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "motion/offline_baseline.h"
#include "toolpath/scallop_interval.h"

namespace swarf::papers {
namespace {

/// Intervals of Eq. (2), which the planners use, at the paper's plain circle.
void interval_rows(std::vector<PaperRow>& rows) {
  constexpr double kRadius = 50.0;
  constexpr double kScallop = 0.01;
  rows.push_back({"Path interval, R = 50 mm, h = 10 µm", "Eq. (2)", "2R/(R+h) sqrt(2Rh+h²)",
                  fmt::format("{:.7f}", toolpath::chord_for_scallop(kRadius, kScallop)), "mm", "",
                  "exact for the chord between the contact points"});
  rows.push_back({"Longest useful interval, D = 10 mm", "after Eq. (2)", "10",
                  fmt::format("{:.6f}", toolpath::reach_limit(10.0, kRadius, kScallop)), "mm", "E2",
                  "the bottom reaches the cusp only up to D R/(R+h)"});
}

void fig6_rows(std::vector<PaperRow>& rows) {
  for (const motion::Fig6Row& row : motion::reproduce_fig6()) {
    const bool greedy = row.segments != 52;
    const bool best = row.segmentation.find("chord") != std::string::npos;
    if (best && !greedy) {
      rows.push_back({"Chord error with 52 segments", "Eq. (8), Fig. 6", "1",
                      fmt::format("{:.4f}", row.chord_error_um), "µm", "E6",
                      "the best that 52 segments can do"});
    }
    if (!greedy) continue;
    rows.push_back({"Segments for 1 µm", "Eq. (8), Fig. 6", "52", fmt::format("{}", row.segments), "", "E6",
                    "the fewest that keep 1 µm"});
    rows.push_back({"Orientation error, linear in u", "Eq. (7), Fig. 6", "0.017",
                    fmt::format("{:.6f}", row.linear_u_deg), "deg", "E5", "Eq. (7) as printed gives less"});
    rows.push_back({"Orientation error, linear along the chord", "Fig. 6", "0.017",
                    fmt::format("{:.6f}", row.linear_chord_deg), "deg", "E5",
                    "this is what the figure shows"});
  }
  rows.push_back({"Position error of 0.017 deg", "section 4", "45",
                  fmt::format("{:.4f}", um_from_mm(motion::fig6_position_error_mm())), "µm", "E8",
                  "rounded in the paper"});
}

void motion_rows(const sim::Result& result, std::vector<PaperRow>& rows) {
  const sim::ComparisonRow* stop = nullptr;
  const sim::ComparisonRow* look_ahead = nullptr;
  for (const sim::ComparisonRow& row : result.modes) {
    if (row.name == "taylor1 (Eq. 5)") {
      rows.push_back({"Feed variation of Eq. (5), this job", "section 3", "< 0.1",
                      fmt::format("{:.3f}", 100.0 * row.feed_error_max_rel), "%", "E7",
                      "V T (C'.C'')/(2|C'|³): below 0.1 % only where the path is nearly straight or slow"});
    }
    if (row.name.rfind("offline, stop", 0) == 0) stop = &row;
    if (row.name.rfind("offline, look", 0) == 0) look_ahead = &row;
  }
  if (stop == nullptr || look_ahead == nullptr) return;
  const double ours = result.main.motion.statistics.time_s;
  rows.push_back({"Off-line time against real time", "section 1", "substantially more",
                  fmt::format("{:.1f} times (stops), {:.2f} times (look-ahead)", stop->time_s / ours,
                              look_ahead->time_s / ours),
                  "", "E19",
                  "the loss is that of stopping at each block; a control with look-ahead does not stop"});
}

void kinematics_rows(const sim::Job& job, const sim::Result& result, std::vector<PaperRow>& rows) {
  rows.push_back({"Rotary angles of the tables", "Eq. (10)", "a = atan(Ox/Oy), b = atan(√(Ox²+Oy²)/Oz)",
                  "a = atan2(√(Ox²+Oy²), Oz), b = atan2(Ox, Oy)", "", "E1",
                  "the letters are swapped in print"});
  rows.push_back({"Orientation", "Eq. (6)", "Sv × Su",
                  job.program.surfaces.front().surface->outward_sign() > 0 ? "Su × Sv" : "Sv × Su", "", "E4",
                  "the sign that points out of the material (D of G10 L79)"});
  rows.push_back({"Forward of inverse, this job", "Eq. (10), (11)", "-",
                  fmt::format("{:.1e}", result.main.motion.statistics.fk_ik_error_max_mm), "mm", "",
                  "largest of all cycles"});
}

void scallop_rows(const sim::Result& result, std::vector<PaperRow>& rows) {
  for (const sim::ComparisonRow& row : result.planners) {
    if (row.name != "lin_koren") continue;
    rows.push_back(
        {"Scallop of the paper's planner, this job", "section 2", "the given h",
         fmt::format("{:.3f} (theory {:.3f})", row.surface.scallop_max_um, row.surface.scallop_theory_um),
         "µm", "E3", "R = 1/kappa across the path is conservative: the exact R is kappa_t/K_G"});
  }
}

}  // namespace

std::vector<PaperRow> lin_koren_rows(const sim::Job& job, const sim::Result& result) {
  std::vector<PaperRow> rows;
  interval_rows(rows);
  scallop_rows(result, rows);
  motion_rows(result, rows);
  fig6_rows(rows);
  kinematics_rows(job, result, rows);
  return rows;
}

}  // namespace swarf::papers
