// Where the shots of a storyboard begin and end in the program.
#pragma once

#include "motion/cycles/cycles.h"
#include "sim/job/movie_keys.h"
#include "sim/run/cycle_window.h"

namespace swarf::sim {

/// Of shots that say from or to.
bool has_places(const MovieShot& shot);

/// What of the motion such a shot shows. Throws InputError "place-unknown" at the shot for a line or a time
/// that the program has not.
CycleWindow shot_window(const MovieShot& shot, const motion::Cycles& cycles);

/// "nothing-cut": a shot of cutting alone in which no feed move lies.
InputError shot_cuts_nothing(const MovieShot& shot);

/// All lines that the shots of a movie name move something, and their sections go through the stock. Before
/// the motion is known.
void require_shot_lines(const MovieSettings& movie, const toolpath::Elements& elements, const Box& stock_W);

/// All shots of the movie are there, and cut where they are to.
void require_shots(const MovieSettings& movie, const motion::Cycles& cycles);

}  // namespace swarf::sim
