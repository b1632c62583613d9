#include "motion/blocks/linearise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/tool_axis.h"

namespace swarf::motion {
namespace {

using kinematics::AxisValues;
using kinematics::BlockEnds;
using kinematics::InverseKinematics;
using kinematics::MachineModel;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A step shorter than this share of the block does not end: the pole is there.
constexpr double kShortest = 1e-9;

bool within(const MachineModel& machine, const std::optional<BlockEnds>& piece, double tolerance_mm) {
  if (!piece) return false;
  return kinematics::trajectory_error_bound(machine, *piece) <= tolerance_mm ||
         kinematics::segment_deviation(machine, *piece).value <= tolerance_mm;
}

}  // namespace

std::optional<BlockEnds> piece_of(const InverseKinematics& inverse, const BlockEnds& block, double s0,
                                  double s1, const AxisValues& before) {
  BlockEnds piece;
  piece.from = s0 <= 0.0 ? block.from : pose_between(block.from, block.to, s0);
  piece.to = s1 >= 1.0 ? block.to : pose_between(block.from, block.to, s1);
  piece.q_from = before;
  const kinematics::Branch branch = inverse.solve_nearest(piece.to, before);
  if (branch.outcome == kinematics::InverseOutcome::kUnreachable) return std::nullopt;
  piece.q_to = branch.q;
  return piece;
}

PiecesError equal_pieces_error(const MachineModel& machine, const InverseKinematics& inverse,
                               const BlockEnds& block, int pieces) {
  SWARF_CHECK(pieces > 0, "a block has at least one piece");
  PiecesError worst;
  AxisValues q = block.q_from;
  for (int i = 0; i < pieces; ++i) {
    const auto piece =
        piece_of(inverse, block, static_cast<double>(i) / pieces, static_cast<double>(i + 1) / pieces, q);
    if (!piece) return {kInfinity, kInfinity};
    const kinematics::TrajectoryError error = kinematics::trajectory_error(machine, *piece);
    worst.segment_mm = std::max(worst.segment_mm, error.segment.value);
    worst.line_mm = std::max(worst.line_mm, error.line.value);
    q = piece->q_to;
  }
  return worst;
}

std::optional<int> equal_pieces(const MachineModel& machine, const InverseKinematics& inverse,
                                const BlockEnds& block, double tolerance_mm) {
  SWARF_CHECK(tolerance_mm > 0.0, "a tolerance above 0");
  const auto holds = [&](int pieces) {
    AxisValues q = block.q_from;
    for (int i = 0; i < pieces; ++i) {
      const auto piece =
          piece_of(inverse, block, static_cast<double>(i) / pieces, static_cast<double>(i + 1) / pieces, q);
      if (!within(machine, piece, tolerance_mm)) return false;
      q = piece->q_to;
    }
    return true;
  };
  int enough = 1;
  while (!holds(enough)) {
    if (enough >= kLinearPiecesMax) return std::nullopt;
    enough *= 2;
  }
  int few = enough / 2;
  while (enough - few > 1) {
    const int middle = (few + enough) / 2;
    (holds(middle) ? enough : few) = middle;
  }
  return enough;
}

std::optional<std::vector<double>> greedy_cuts(const MachineModel& machine, const InverseKinematics& inverse,
                                               const BlockEnds& block, double tolerance_mm) {
  SWARF_CHECK(tolerance_mm > 0.0, "a tolerance above 0");
  std::vector<double> cuts{0.0};
  AxisValues q = block.q_from;
  while (cuts.back() < 1.0) {
    const double from = cuts.back();
    const auto reach = [&](double to) { return piece_of(inverse, block, from, to, q); };
    std::optional<BlockEnds> piece = reach(1.0);
    double end = 1.0;
    if (!within(machine, piece, tolerance_mm)) {
      double beyond = 1.0;
      end = from;
      while (beyond - end > kShortest) {
        const double middle = 0.5 * (end + beyond);
        (within(machine, reach(middle), tolerance_mm) ? end : beyond) = middle;
      }
      if (end - from <= kShortest) return std::nullopt;
      piece = reach(end);
    }
    cuts.push_back(end);
    q = piece->q_to;
    if (static_cast<int>(cuts.size()) > kLinearPiecesMax) return std::nullopt;
  }
  return cuts;
}

}  // namespace swarf::motion
