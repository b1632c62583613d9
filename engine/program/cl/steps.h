// What the statements of CL data do, step by step: each function names the state that it reads and writes.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "program/cl/state.h"

namespace swarf::program::cldata {

/// Executes the statements one by one. All references must outlive the run.
ClProgram run(const std::string& file, const ClOptions& options, ClSink& sink, Diagnostics& diagnostics,
              ClLines& lines);

// --- reader.cpp
void fault(Reporter& reporter, const char* code, const ClStatement& at, std::string text, std::string fix);
void fault(Reporter& reporter, const char* code, const ClArgument& at, std::string text, std::string fix);
/// True when all arguments are numbers and their count is one of the two.
bool numbers(Reporter& reporter, const ClStatement& s, size_t few, size_t many, const char* form);
bool all_numbers(Reporter& reporter, const ClStatement& s, const char* form);
/// The unit vector of three numbers.
bool unit_vector(Reporter& reporter, const ClStatement& s, size_t first, const char* what, Vec3& unit);
/// Whether the arguments are these words and numbers, one # for each number: "LINE ### ###".
bool fits(const ClStatement& s, std::string_view pattern);
void remark(ClProgram& program, std::string text);

// --- motion.cpp
Vec3 point_at(const ClSystems& systems, const ClStatement& s, size_t first);
/// False with a fault where a statement without a tool axis has none to keep.
bool axis_stands(Reporter& reporter, const ClPath& path, const ClStatement& s);
bool pose_of(Reporter& reporter, ClSystems& systems, ClPath& path, const ClStatement& s, ToolPose& pose);
void go_to(ClState& cl, const ClStatement& s);
void go_delta(ClState& cl, const ClStatement& s);
void go_home(ClState& cl, const ClStatement& s);
void from(ClState& cl, const ClStatement& s);
void start_at(ClProgram& program, ClPath& path, const ClStatement& s, const ToolPose& pose);
void move_to(ClState& cl, const ClStatement& s, const ToolPose& to);
/// One move as it leaves the reader, compensated where CUTCOM is on.
void send(ClState& cl, const ClStatement& s, const ToolPose& to, const std::optional<Arc>& arc,
          double feed_mm_s, double dwell_s);
void emit(ClSink& sink, ClProgram& program, const Move& move);
void rapid(ClState& cl, const ClStatement& s);
void retract(ClState& cl, const ClStatement& s);
void clearance_plane(ClState& cl, const ClStatement& s);

// --- writer_marks.cpp
void comment(ClState& cl, const ClStatement& s);
void mark(Reporter& reporter, ClProgram& program, ClWriter writer, const std::string& what,
          const ClStatement& s);
/// +1: CIRCLE runs counter-clockwise about its vector, -1: clockwise; none: nobody says.
std::optional<double> circle_sense(const ClOptions& options, const ClProgram& program);
void pprint(ClState& cl, const ClStatement& s);

// --- arc.cpp
void circle(ClState& cl, const ClStatement& s);
void move_arc(ClState& cl, const ClStatement& s);
/// One GOTO with several positions behind a CIRCLE: points passed on the arc, then its end.
void go_round(ClState& cl, const ClStatement& s);
/// True with a fault where Creo may mean another point of the arc before, or a straight line.
bool continues_arc(Reporter& reporter, ClPath& path, ClArcs& arcs, const ClStatement& s, const Vec3& to);
/// Moves to `to` round circle_.
void add_arc(ClState& cl, const ClStatement& s, const ToolPose& to);

// --- tlon.cpp
void direction(ClState& cl, const ClStatement& s);
void part_surface(ClState& cl, const ClStatement& s);
void tool_on(ClState& cl, const ClStatement& s);
/// +1 or -1 as INDIRV points along counter-clockwise or clockwise about the axis where the tool stands;
/// none with a fault when it points off the circle.
std::optional<double> sense_along(Reporter& reporter, ClPath& path, ClArcs& arcs, const ClStatement& s,
                                  const Vec3& centre_W, const Vec3& axis_W);

// --- system.cpp
void system(ClState& cl, const ClStatement& s);
/// CSYS of nine numbers as MSYS, of twelve as SolidWorks CAM writes it.
void work_system(ClState& cl, const ClStatement& s);
/// TRNTYP of SolidWorks CAM.
void transformation(ClState& cl, const ClStatement& s);
void matrix_system(ClState& cl, const ClStatement& s);
void creo_system(ClState& cl, const ClStatement& s);
void catia_system(ClState& cl, const ClStatement& s);
void origin(ClState& cl, const ClStatement& s);
void translation(ClState& cl, const ClStatement& s);
/// TRACUT: a matrix that turns the positions behind it, or has turned them already.
void transformed_cut(ClState& cl, const ClStatement& s);

// --- nurbs.cpp
void nurbs(ClState& cl, const ClStatement& s);
/// True when the statement belongs to the curve that is open, or is refused there.
bool inside_nurbs(ClState& cl, const ClStatement& s);

// --- tools.cpp
void load_tool(ClState& cl, const ClStatement& s);
void load(ClState& cl, const ClStatement& s);
void tool_path(ClState& cl, const ClStatement& s);
void tool_data(ClState& cl, const ClStatement& s);
void cutter(ClState& cl, const ClStatement& s);
/// Of the tool that is loaded; none when neither the file nor the scene says.
std::optional<double> cutter_radius(const ClOptions& options, const ClProgram& program,
                                    const ClToolState& tool);

// --- cutcom.cpp
void cutter_compensation(ClState& cl, const ClStatement& s);
void compensate(ClState& cl, const ClStatement& s, const ToolPose& to, const std::optional<Arc>& arc,
                double feed_mm_s, double dwell_s);
/// False with a fault while the contour is compensated.
bool not_compensated(Reporter& reporter, ClCutcom& compensation, const ClStatement& s);

// --- words.cpp
void feed_rate(ClState& cl, const ClStatement& s);
void spindle(ClState& cl, const ClStatement& s);
void multi_axis(ClState& cl, const ClStatement& s);
void tool_axis(ClState& cl, const ClStatement& s);
void cycle(ClState& cl, const ClStatement& s);
void delay(ClState& cl, const ClStatement& s);
void units(ClState& cl, const ClStatement& s);
void set_mode(ClState& cl, const ClStatement& s);
void mode(ClState& cl, const ClStatement& s);
void auxiliary(ClState& cl, const ClStatement& s);
void tolerance(ClState& cl, const ClStatement& s);
void note(ClState& cl, const ClStatement& s);
/// mm/s from a feed and the word behind it; 0 with a fault when it cannot be told.
double feed_of(Reporter& reporter, ClSystems& systems, ClRates& feed, const ClArgument& value,
               const std::string& unit);

// --- cycle_words.cpp
bool read_cycle(ClState& cl, const ClStatement& s, ClCycle& cycle);

}  // namespace swarf::program::cldata
