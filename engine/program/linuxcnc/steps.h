// What a block of RS274/NGC does, step by step: each function names the state that it reads and writes.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "program/linuxcnc/state.h"

namespace swarf::program::nc::linuxcnc {

// --- flow.cpp
bool at_o_word(LetterDialect& letters);
void flow(LinuxCnc& linuxcnc);
void leave(LinuxCnc& linuxcnc);
void call_number(Calls& calls, LetterDialect& letters, int number, long times, int column);
void end_of_flow(Calls& calls, LetterDialect& letters);

// --- parameters.cpp
std::string message_text(LetterDialect& letters);
bool is_read_only(LinuxCnc& linuxcnc, std::string_view name);

// --- block.cpp
void polar_words(LinuxCnc& linuxcnc);
void check_words(Modes& modes, Curves& curves, LetterDialect& letters);
void apply(LinuxCnc& linuxcnc);
bool apply_end(LinuxCnc& linuxcnc);
bool uses_axis_words(const LetterDialect& letters);

// --- tools.cpp
void apply_tool(Modes& modes, Curves& curves, LetterDialect& letters);
void apply_compensation(Modes& modes, Zero& zero, LetterDialect& letters);
void apply_length(Zero& zero, LetterDialect& letters);
std::optional<double> diameter_of(Zero& zero, LetterDialect& letters, int number, int column);
void set_tool_data(Zero& zero, LetterDialect& letters, int kind);

// --- state.cpp
void apply_saved_state(LinuxCnc& linuxcnc, int tenths, int column);
void restore(Modes& modes, Zero& zero, LetterDialect& letters, const ModalState& state, int column);

// --- machine.cpp
void read_input(Modes& modes, LetterDialect& letters);
void warn_of_output(LetterDialect& letters);
void switch_kinematics(Modes& modes, LetterDialect& letters, int tenths, int column);

// --- offsets.cpp
void non_modal(LinuxCnc& linuxcnc);
std::optional<kinematics::AxisValues> reference_position(const Zero& zero, const LetterDialect& letters,
                                                         bool second);
void update_shift(Zero& zero, LetterDialect& letters);

// --- motion.cpp
void motion(LinuxCnc& linuxcnc);

// --- cycles.cpp
void cycle(Modes& modes, Drilling& drilling, LetterDialect& letters, int tenths);
void check_cycle(const LetterDialect& letters, int tenths);
void keep_cycle_words(Drilling& drilling, LetterDialect& letters, bool same);

// --- curves.cpp
void cubic_spline(Modes& modes, Curves& curves, LetterDialect& letters);
void quadratic_spline(Modes& modes, LetterDialect& letters);
void check_nurbs_words(Curves& curves, LetterDialect& letters);
void nurbs_point(Modes& modes, Curves& curves, LetterDialect& letters);
void close_nurbs(Curves& curves, LetterDialect& letters);
[[noreturn]] void fail_open_nurbs(const Curves& curves, const LetterDialect& letters);

}  // namespace swarf::program::nc::linuxcnc
