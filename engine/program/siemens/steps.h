// What a block of Siemens 840D does, step by step: each function names the state that it reads and writes.
#pragma once

#include <string>
#include <vector>

#include "program/siemens/state.h"

namespace swarf::program::nc::siemens {

// --- executor.cpp
[[noreturn]] void fail(const BlockPlace& place, const char* code, size_t offset, std::string text,
                       std::string fix);
void apply_corner(nc::Control& control, Modes& modes);
void cutter_words(Executor& executor, const BlockWords& words);
void feed_group(Executor& executor, const CycleCall& call);

// --- motion.cpp
void motion_words(Executor& executor, const BlockWords& words);
bool mirrored(nc::Control& control, const Frames& frames);

/// The programmed end of a motion from `from`.
Vec3 end_of(const Target& target, const Vec3& from);
/// What the radius of an arc in the plane is multiplied by.
double arc_scale(nc::Control& control, const BlockPlace& place, const Frames& frames, size_t offset);

// --- corners.cpp
void corner_modes(nc::Control& control, BlockPlace& place, Modes& modes, const BlockWords& words);
void ask_for_corner(nc::Control& control, const BlockPlace& place, const Modes& modes, const Frames& frames,
                    const BlockWords& words);
void angle_end(Executor& executor, const BlockWords& words, Target& target);
/// ANG= without an end: the line waits for the next block.
void open_line(Executor& executor, const BlockWords& words);
/// Moves along the line that waits, up to where that of this block crosses it, whose ANG= is then done with.
void close_line(Executor& executor, BlockWords& words);
/// "line-without-end" where a line still waits.
void refuse_open_line(const Executor& executor);

// --- polar.cpp
void set_pole(Executor& executor, const BlockWords& words, int code);
void polar_end(Executor& executor, const BlockWords& words, Target& target);

// --- patterns.cpp
void pattern(Executor& executor, const CycleCall& call);

// --- system.cpp
void use_offset(nc::Control& control, Frames& frames, int number);

// --- curves.cpp
const Coefficients* first_polynomial(const BlockWords& words);
void check_polynomial(nc::Control& control, const BlockPlace& place, const Modes& modes,
                      const BlockWords& words);
void polynomial(Executor& executor, const BlockWords& words, const Target& target);
void polynomial_path(BlockPlace& place, const CycleCall& call);

// --- frames.cpp
void frame_words(Executor& executor, const BlockWords& words);
void transform_words(Executor& executor, const BlockWords& words);
void choose_interpolation(nc::Control& control, Frames& frames);
void swivel(Executor& executor, const CycleCall& call);

// --- cycles.cpp
void run_call(Executor& executor, const CycleCall& call);
DrillCycle drilling(nc::Control& control, const BlockPlace& place, const Frames& frames,
                    const CycleCall& call);
void only_zero(const BlockPlace& place, const CycleCall& call, size_t first, size_t last);
void drill(nc::Control& control, BlockPlace& place, PathWords& path, const DrillCycle& cycle,
           const CycleCall& call);

}  // namespace swarf::program::nc::siemens
