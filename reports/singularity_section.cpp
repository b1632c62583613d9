#include "reports/singularity_section.h"

#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "reports/singularity_figures.h"

namespace swarf::reports {
namespace {

using motion::BlockSingularity;
using motion::SingularityScan;

/// Below this the worst block is straight: there is nothing to draw, mm.
constexpr double kStraight = 1e-6;

std::string degrees(double rad) {
  return fmt::format("{:.3f}", deg_from_rad(rad));
}

std::string pieces_text(const std::optional<int>& pieces) {
  return pieces ? fmt::format("{}", *pieces) : "none";
}

const char* law_of(const toolpath::ToolPath& path, const BlockSingularity& block) {
  return toolpath::law_name(path.elements.block(static_cast<size_t>(block.pole.element)).law);
}

int line_of(const toolpath::ToolPath& path, const BlockSingularity& block) {
  return path.elements.line(static_cast<size_t>(block.pole.element));
}

Table worst_table(const toolpath::ToolPath& path, const SingularityScan& scan) {
  Table table;
  table.title = "The blocks whose tip would leave its line most with linear axes";
  table.columns = {{"Block", "line", true},
                   {"Law"},
                   {"To the pole", "deg", true},
                   {"Singular cone", "deg", true},
                   {scan.outer_axis + " swings", "deg", true},
                   {"From the segment", "mm", true},
                   {"at u", "", true},
                   {"From the line", "mm", true},
                   {"at u", "", true},
                   {"Analytic", "mm", true},
                   {"Past its end", "mm", true},
                   {"Bound", "mm", true},
                   {"Pieces", "equal / greedy", true}};
  const auto mm = [](double value) { return fmt::format("{:.4f}", value); };
  for (const BlockSingularity& block : scan.worst) {
    const kinematics::TrajectoryError& error = block.error;
    if (error.segment.value <= kStraight) break;  // they are in falling order
    const auto place = [&](const kinematics::Peak& peak) { return fmt::format("{:.4f}", peak.u); };
    const std::string cone = degrees(block.pole.cone_rad) + (block.pole.in_cone() ? ", inside" : "");
    table.rows.push_back({fmt::format("{}", line_of(path, block)), law_of(path, block),
                          degrees(block.pole.pole_distance_rad), block.pole.cone_rad == 0.0 ? "–" : cone,
                          degrees(block.pole.outer_swing_rad), mm(error.segment.value), place(error.segment),
                          mm(error.line.value), place(error.line), mm(block.analytic.value),
                          mm(error.beyond.value), mm(error.bound_mm),
                          pieces_text(block.equal) + " / " + pieces_text(block.greedy)});
  }
  table.notes = {
      fmt::format(
          "{} of {} feed blocks enter their singular cone: there {} would have to turn faster than it "
          "can to keep the block's feed. Not looked at: {} rapids, {} arcs of the tip (no line to "
          "leave), {} blocks without axis values.",
          scan.in_cone, scan.blocks, scan.outer_axis, scan.rapids, scan.arcs, scan.unreachable),
      fmt::format(
          "Maxima are roots of the exact derivative, proven to 1e-9 mm. Analytic: So's Eq. (3), (8), (6) "
          "as corrected, distance to the line. Bound: 1/8 max|p''|. Pieces: for {:g} µm from their own "
          "segments.",
          um_from_mm(scan.tolerance_mm))};
  return table;
}

Table pieces_table(const papers::BlockStudy& study, int line) {
  Table table;
  table.title = fmt::format("Line {} cut into pieces on its programmed line", line);
  table.intro =
      "At the cuts the tip stands on the line, the axis on the great circle, and the axis values are exact; "
      "between them the axes are linear.";
  table.columns = {
      {"Equal pieces", "", true}, {"From their segments", "mm", true}, {"From their lines", "mm", true}};
  for (const papers::PiecesRow& row : study.pieces) {
    table.rows.push_back({fmt::format("{}", row.pieces), fmt::format("{:.6f}", row.error.segment_mm),
                          fmt::format("{:.6f}", row.error.line_mm)});
  }
  return table;
}

Table tolerance_table(const papers::BlockStudy& study, int line) {
  Table table;
  table.title = fmt::format("Pieces that line {} needs", line);
  table.columns = {{"Tolerance", "mm", true}, {"Equal pieces", "", true}, {"Greedy", "", true}};
  for (const papers::ToleranceRow& row : study.tolerances)
    table.rows.push_back(
        {fmt::format("{:g}", row.tolerance_mm), pieces_text(row.equal), pieces_text(row.greedy)});
  table.notes = {
      "Greedy: each piece as long as the tolerance allows. None: no number helps, the block passes the pole "
      "itself."};
  return table;
}

std::string branch_text(const kinematics::BranchChoice& choice) {
  const auto one = [](bool other) { return other ? "second" : "first"; };
  return fmt::format("{} to {}", one(choice.other_from), one(choice.other_to));
}

Table branch_table(const SingularityScan& scan, const papers::BlockStudy& study, int line) {
  Table table;
  table.title = fmt::format("Line {}: the other rotary solution and the other way round", line);
  table.columns = {{"Solution at its ends"},
                   {"Way of " + scan.outer_axis},
                   {scan.outer_axis + " swings", "deg", true},
                   {scan.inner_axis + " swings", "deg", true},
                   {"From the segment", "mm", true},
                   {"From the line", "mm", true},
                   {"Travel"}};
  for (const auto& [choice, beyond] : study.branches) {
    table.rows.push_back({branch_text(choice), choice.long_way ? "long" : "short",
                          degrees(choice.outer_swing_rad), degrees(choice.inner_swing_rad),
                          fmt::format("{:.6f}", choice.segment_mm), fmt::format("{:.6f}", choice.line_mm),
                          beyond.empty() ? "inside" : beyond + " leaves it"});
  }
  table.highlighted_row = study.branches.empty() ? -1 : 0;
  table.notes = {"First: the solution as the block runs; its row is marked. All with linear axes."};
  return table;
}

std::string circle_text(const toolpath::ToolPath& path, const motion::CircleError& circle) {
  const auto line = [&](int element) { return path.elements.line(static_cast<size_t>(element)); };
  return fmt::format(
      " Lines {} to {} are a circle of radius {:.4f} mm in {} blocks: linear axes lead the tip {:.6f} mm "
      "away "
      "from it (line {}), straight blocks {:.6f} mm.",
      line(circle.first), line(circle.last), circle.radius_mm, circle.blocks(), circle.value_mm,
      line(circle.element), circle.chord_mm);
}

}  // namespace

Topic singularity_topic(const toolpath::ToolPath& path, const SingularityScan& scan,
                        const papers::BlockStudy& study) {
  Topic topic;
  topic.id = "singularity";
  topic.name = "Singularity";
  topic.title = "Singularity (So et al.)";
  const BlockSingularity& worst = scan.worst.front();
  const int line = line_of(path, worst);
  if (worst.error.segment.value <= kStraight) {
    topic.intro = fmt::format(
        "With linear axes the tip stays on its lines in all {} feed blocks that were looked at, within 1e-6 "
        "mm. Not looked at: {} rapids, {} arcs of the tip, {} blocks without axis values.",
        scan.blocks, scan.rapids, scan.arcs, scan.unreachable);
    return topic;
  }
  const bool joint = std::string(law_of(path, worst)) == toolpath::law_name(toolpath::BlockLaw::kJoint);
  topic.intro = fmt::format(
      "With linear axes the tip leaves its programmed segment by {:.6f} mm in line {}, {} deg away from the "
      "pole. {}",
      worst.error.segment.value, line, degrees(worst.pole.pole_distance_rad),
      joint ? "The program runs with linear axes: this is the error of the run. Under TCP it would be 0, and "
              "the cost would be time."
            : "The program runs under TCP, so that the run does not have this error: it is what a control "
              "without TCP would do.");
  if (scan.circle) topic.intro += circle_text(path, *scan.circle);
  topic.tables = {worst_table(path, scan)};
  topic.figures = {trajectory_figure(worst, study), pole_figure(worst, study)};
  topic.tables.push_back(tolerance_table(study, line));
  topic.tables.push_back(pieces_table(study, line));
  topic.tables.push_back(branch_table(scan, study, line));
  return topic;
}

}  // namespace swarf::reports
