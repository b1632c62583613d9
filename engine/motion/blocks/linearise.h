// A block under joint motion, cut into pieces on its programmed line so that each stays within a tolerance.
//
//   P0 --x----x---x--- P1     tip straight, axis on the great circle (slerp) at the cuts,
//                             exact axis values there, axes linear between them
//
// The error of a piece is the distance of the true trajectory to the piece's own segment (E15).
#pragma once

#include <optional>
#include <vector>

#include "kinematics/singularity.h"

namespace swarf::motion {

/// The block between the fractions s0 < s1 of its programmed line; the axis values continue `before`, those
/// at s0. nullopt: the machine has no axis values there.
std::optional<kinematics::BlockEnds> piece_of(const kinematics::InverseKinematics& inverse,
                                              const kinematics::BlockEnds& block, double s0, double s1,
                                              const kinematics::AxisValues& before);

/// Error of a block in `pieces` equal pieces, mm; infinity when the machine has no axis values for a cut.
struct PiecesError {
  double segment_mm = 0.0, line_mm = 0.0;
};
PiecesError equal_pieces_error(const kinematics::MachineModel& machine,
                               const kinematics::InverseKinematics& inverse,
                               const kinematics::BlockEnds& block, int pieces);

/// Most pieces that are tried; a block that needs more passes the pole, where no number of pieces helps.
inline constexpr int kLinearPiecesMax = 1024;

/// The least number of equal pieces within the tolerance (mm, above 0), by bisection: the error falls with
/// the number wherever the pole is not passed; nullopt above kLinearPiecesMax.
std::optional<int> equal_pieces(const kinematics::MachineModel& machine,
                                const kinematics::InverseKinematics& inverse,
                                const kinematics::BlockEnds& block, double tolerance_mm);

/// Cuts from 0 to 1, each as far from the one before as the tolerance allows (to 1e-9 of the block, by
/// bisection); the block alone: {0, 1}. nullopt: more than kLinearPiecesMax, or a step without an end
/// (through the pole the outer axis jumps by half a turn).
std::optional<std::vector<double>> greedy_cuts(const kinematics::MachineModel& machine,
                                               const kinematics::InverseKinematics& inverse,
                                               const kinematics::BlockEnds& block, double tolerance_mm);

}  // namespace swarf::motion
