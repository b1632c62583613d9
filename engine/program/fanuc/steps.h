// What a block of the Fanuc dialect does, step by step: each function names the state that it reads and
// writes.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "program/fanuc/state.h"

namespace swarf::program::nc::fanuc {

// --- dialect.cpp
bool without_point(const LetterDialect& letters, char letter);
void skip_block_number(LetterDialect& letters);

// --- variables.cpp
void assignment(Calls& calls, Variables& variables, LetterDialect& letters);

// --- flow.cpp
bool macro_word(Calls& calls, Variables& variables, LetterDialect& letters);
void go_to(Calls& calls, LetterDialect& letters, long label, int column);

// --- calls.cpp
void call_macro(Calls& calls, LetterDialect& letters);
void set_modal_macro(Calls& calls, LetterDialect& letters);
void call_modal_macro(Calls& calls, LetterDialect& letters);
bool apply_calls(Fanuc& fanuc);

// --- block.cpp
void check_words(Modes& modes, LetterDialect& letters);
void apply(Fanuc& fanuc);
void update_space(Fanuc& fanuc);

// --- data.cpp
void set_data(Modes& modes, Zero& zero, LetterDialect& letters);
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
void cycle(Fanuc& fanuc, int tenths);

// --- planes.cpp
void turn(Fanuc& fanuc, int tenths);
void expect_plane_block(Planes& planes, LetterDialect& letters);
void tilt_rotaries(Fanuc& fanuc, bool tip_stands);
void only_words(LetterDialect& letters, std::string_view names, const char* form);

// --- motion.cpp
void one_shot(Fanuc& fanuc);
void keep_motion_codes(Modes& modes, Drilling& drilling, LetterDialect& letters);
void motion(Fanuc& fanuc);
bool add_to_nurbs(Modes& modes, std::optional<Nurbs>& nurbs, LetterDialect& letters);

}  // namespace swarf::program::nc::fanuc
