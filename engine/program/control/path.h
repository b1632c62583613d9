// Lines and arcs: from the words of a motion block to segments.
#pragma once

#include <string>

#include "program/control/control.h"

namespace swarf::program::nc {

/// Rapid or feed on a straight line (or the joint-linear one, control.h). What the target does not give
/// stays.
void line(Control& control, Motion motion, const Target& target);
/// G2, G3 in the active plane (or about ArcWords::normal). "bad-arc". Without TCP an arc during which rotary
/// axes turn is one of axis values and no arc on the part: it comes as chords (curve.h).
void arc(Control& control, Motion motion, const Target& target, const ArcWords& words);
/// The target in machine coordinates (G53, SUPA, M91, G28, G30): joint-linear.
void machine_line(Control& control, Motion motion, const Target& target);

/// The machine stands at PathState::q from now on; `how` it came there, for the report.
void start_here(Control& control, const std::string& how);
/// Names of the axes whose position is not known.
std::string missing_axes(const WorkSpace& space, const PathState& path);
/// The modal words of a segment that starts now: takes the pending dwell and G9. "missing-feed",
/// "feed-without-spindle".
void prepare(Report& report, ModalState& modal, Motion motion, const Target& target, Segment& segment);

}  // namespace swarf::program::nc
