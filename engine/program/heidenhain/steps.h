// What a block of a Heidenhain program does, step by step: each function names the state that it reads and
// writes.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "program/heidenhain/state.h"

namespace swarf::program::nc::heidenhain {

// --- tools.cpp
void tool_call(Executor& executor, BlockReader& reader);
void tool_ready(nc::Control& control, Modes& modes, BlockReader& reader);
void blank_form(nc::Control& control, BlockReader& reader);

// --- functions.cpp
void functions_before(Executor& executor, BlockReader& reader, const MotionWords& words);
void functions_after(Executor& executor, BlockReader& reader, const std::vector<MWord>& words);
void retract_by(nc::Control& control, PathState& path, std::optional<double> way, Motion motion);

// --- arcs.cpp
void polar_line(Executor& executor, BlockReader& reader, size_t start);
void pole(nc::Control& control, PathState& path, Frames& frames, BlockReader& reader);
void circle(Executor& executor, BlockReader& reader, size_t start);
void circle_by_radius(Executor& executor, BlockReader& reader, size_t start);
void circle_tangential(Executor& executor, BlockReader& reader, size_t start);
void polar_circle(Executor& executor, BlockReader& reader, size_t start);
Vec3 polar_end(nc::Control& control, PathState& path, Frames& frames, BlockReader& reader,
               const MotionWords& words, size_t start);

// --- curves.cpp
void surface_line(Executor& executor, BlockReader& reader, size_t start);
void spline(Executor& executor, BlockReader& reader, size_t start);

// --- motion.cpp
void line(Executor& executor, BlockReader& reader, size_t start);
/// `words_taken`: so many of X Y Z A B C.
Target target_of(nc::Control& control, Modes& modes, Frames& frames, BlockReader& reader,
                 const MotionWords& words, int words_taken = nc::kAxisWords);
double feed_of(nc::Control& control, Modes& modes, BlockReader& reader, const MotionWords& words,
               Motion& motion);
void set_feed(nc::Control& control, double feed, bool degrees);
/// Moves now, or waits when a corner follows.
void move(Executor& executor, BlockReader& reader, const MotionWords& words, Element& element);
void emit(Executor& executor, const Element& element);
Vec3 present(nc::Control& control, PathState& path);
Vec3 end_of(nc::Control& control, PathState& path, const Target& target);
void finish_motion(Executor& executor, BlockReader& reader, const MotionWords& words);
double cutter_radius(nc::Control& control, Modes& modes, BlockReader& reader);
nc::Compensation side_of(nc::Control& control, const Frames& frames, nc::Compensation written);

// --- path.cpp
void corner(nc::Control& control, PathState& path, Frames& frames, BlockReader& reader, bool round,
            size_t start);
void close_corner(Executor& executor, Element& next);
void no_open_corner(PathState& path, BlockReader& reader, size_t offset);

// --- cycles.cpp
void cycle_definition(Executor& executor, BlockReader& reader);
void cycle_call(Executor& executor, BlockReader& reader, size_t start);

// --- frame.cpp
void datum_shift(Executor& executor, BlockReader& reader);
void transform(Executor& executor, BlockReader& reader, size_t start);
void mirror_image(Executor& executor, BlockReader& reader);
void rotation(Executor& executor, BlockReader& reader);
void scaling(Executor& executor, BlockReader& reader);
void axis_scaling(Executor& executor, BlockReader& reader);
double plane_scale(nc::Control& control, Frames& frames, BlockReader& reader, size_t offset);
void need_true_size(Frames& frames, BlockReader& reader, size_t offset, const char* what);
void update_frame(Executor& executor);

// --- approach.cpp
void approach(Executor& executor, BlockReader& reader, size_t start);
void depart(Executor& executor, BlockReader& reader, size_t start);
void close_approach(nc::Control& control, PathState& path, const Element& first);
void straight(nc::Control& control, Motion motion, double feed, const Vec3& to);
void circle_move(nc::Control& control, double feed, const Vec3& to, const Vec3& centre,
                 bool counter_clockwise, int further_turns);

// --- drilling.cpp
void run_cycle(Executor& executor, BlockReader& reader, size_t offset);
void execute_cycle(Executor& executor);
void go(nc::Control& control, Motion motion, double height, double feed);
double q(const Drilling& drilling, int number);
double length(const Executor& executor, int number);
double cycle_surface(nc::Control& control, const Drilling& drilling, const Frames& frames);

// --- boring.cpp
void bore(Executor& executor);
void back_bore(Executor& executor);
void mill_bore(Executor& executor);

// --- pattern.cpp
void pattern_definition(nc::Control& control, Drilling& drilling, BlockReader& reader, size_t start);
void call_pattern(Executor& executor, BlockReader& reader, Motion motion, double feed, size_t offset);
void pattern_cycle(Executor& executor, BlockReader& reader, const Cycle& pattern);

// --- plane.cpp
void plane(Executor& executor, BlockReader& reader, size_t start);
void tilt(Executor& executor, BlockReader& reader, const Mat3& rotation, bool on, size_t start);

// --- tilt.cpp
Positioning positioning(nc::Control& control, Modes& modes, BlockReader& reader, size_t start);
void position_plane(Executor& executor, BlockReader& reader, const Positioning& how,
                    const kinematics::AxisValues* goal, size_t start);
void rotary_parameters(nc::Control& control, Parameters& parameters, const kinematics::AxisValues& values);

// --- tcpm.cpp
void function_word(nc::Control& control, Modes& modes, Orientation& orientation, BlockReader& reader,
                   size_t start);
void set_tcpm(nc::Control& control, Orientation& orientation, bool on, bool by_vector, bool spatial,
              bool chosen);
void compensate_heads(nc::Control& control, Orientation& orientation, BlockReader& reader, size_t offset,
                      bool on);
double rotary_feed(nc::Control& control, const Modes& modes, const Orientation& orientation,
                   const Element& element);
void turn_by(nc::Control& control, Orientation& orientation, nc::Tcp law);

}  // namespace swarf::program::nc::heidenhain
