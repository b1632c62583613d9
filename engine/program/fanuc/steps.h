// What a block of the Fanuc dialect does, step by step: each function names the state that it reads and
// writes.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "program/fanuc/state.h"

namespace swarf::program::nc::fanuc {

// --- dialect.cpp
/// Reads the program as this control does.
void run_as(const Rules& rules, const std::string& path, Control& control);
bool without_point(const LetterDialect& letters, char letter);
void skip_block_number(LetterDialect& letters);

// --- variables.cpp
std::optional<double> modal_code(const Fanuc& fanuc, long group);
/// #1 to #33 of the main program and #100 to #999 as ControlSetup::presets has them.
void set_presets(const Presets& presets, Calls& calls, Variables& variables);
void assignment(Calls& calls, Variables& variables, LetterDialect& letters);

// --- flow.cpp
bool macro_word(Calls& calls, Variables& variables, LetterDialect& letters);
/// The first block with this number behind `from`.
std::optional<LineSource::Mark> find_label(LineSource& in, const LineSource::Mark& from, long label);
void go_to(Calls& calls, LetterDialect& letters, long label, int column);

// --- calls.cpp
void call_macro(Fanuc& fanuc);
void set_modal_macro(Calls& calls, LetterDialect& letters);
void call_modal_macro(Fanuc& fanuc);
bool apply_calls(Fanuc& fanuc);

// --- block.cpp
void check_words(Modes& modes, LetterDialect& letters, const Rules& rules);
void apply(Fanuc& fanuc);
void update_space(Fanuc& fanuc);

// --- data.cpp
void set_data(Modes& modes, Zero& zero, LetterDialect& letters, const Rules& rules);
double tool_offset(Zero& zero, LetterDialect& letters, int number, size_t slot, int column);
double tool_value(Modes& modes, Zero& zero, LetterDialect& letters, char letter, bool length);
void shift_to_words(Fanuc& fanuc, bool position);

// --- transform.cpp
Target words(Modes& modes, Mapping& mapping, LetterDialect& letters);
void map_arc(Mapping& mapping, LetterDialect& letters, ArcWords& arc);
bool mapped(const Mapping& mapping);
bool reversed(const Mapping& mapping, const LetterDialect& letters);
void refuse_mapped(Mapping& mapping, LetterDialect& letters, int column, const char* what, bool polar_too);
void mirror(Fanuc& fanuc, int tenths);
void scale(Fanuc& fanuc, int tenths);
void polar(Modes& modes, Mapping& mapping, LetterDialect& letters, int tenths);

// --- cycles.cpp
/// The cycle that is on, at each of these points of the plane (program coordinates, mm).
void drill_holes(Fanuc& fanuc, std::span<const Vec2> holes);
void cycle(Fanuc& fanuc, int tenths);

// --- pockets.cpp
/// G12, G13 of derived dialects: about the present position, I K Q D L Z.
void circular_pocket(Fanuc& fanuc, bool clockwise);
std::vector<Vec2> holes_on_circle(const Vec2& centre, double radius_mm, double start_deg, double step_deg,
                                  int count);
std::vector<Vec2> holes_on_line(const Vec2& first, double distance_mm, double angle_deg, int count);
/// X Y of a pattern's block, or the present position.
Vec2 pattern_place(Fanuc& fanuc);

// --- planes.cpp
void turn(Fanuc& fanuc, int tenths);
void expect_plane_block(Planes& planes, LetterDialect& letters);
void tilt_rotaries(Fanuc& fanuc, bool tip_stands);
void only_words(LetterDialect& letters, std::string_view names, const char* form);

// --- motion.cpp
/// P of a dwell.
double seconds_of_p(const Fanuc& fanuc);
void one_shot(Fanuc& fanuc);
void keep_motion_codes(Modes& modes, Drilling& drilling, LetterDialect& letters);
void motion(Fanuc& fanuc);
bool add_to_nurbs(Modes& modes, std::optional<Nurbs>& nurbs, LetterDialect& letters);

}  // namespace swarf::program::nc::fanuc
