// From segments to complete moves: axis values, poses, law, time.
#pragma once

#include "program/control/control.h"

namespace swarf::program::nc {

/// Whole turns of an arc leave as moves of their own. "out-of-range", "tcp-length", "arc-axes",
/// "too-many-moves"; throws ProgramStopped when the sink wants no more.
void emit(Control& control, const Segment& segment);

}  // namespace swarf::program::nc
