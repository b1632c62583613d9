// Executes the statements of CL data one by one: the state between them and one handler for each word.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "program/cl/compensation.h"
#include "program/cl/cycle.h"
#include "program/cl/nurbs.h"
#include "program/cl/program.h"
#include "program/cl/statement.h"
#include "program/reporter.h"

namespace swarf::program {

class ClInterpreter {
 public:
  /// All references must outlive the interpreter.
  ClInterpreter(const std::string& file, const ClOptions& options, ClSink& sink, Diagnostics& diagnostics);
  ClProgram run(ClLines& lines);

 private:
  using Handler = void (ClInterpreter::*)(const ClStatement&);
  struct Word {
    const char* name;
    Handler handler;
  };
  static std::span<const Word> words();

  /// The circle that the next position goes round.
  struct Circle {
    Vec3 centre_W, normal_W;  ///< counter-clockwise about the unit normal
    double radius = 0.0;
    std::optional<double> turns;  ///< TIMES of NX
  };
  /// A plane that the tip stays on: PSIS, CLEARP.
  struct Plane {
    Vec3 point_W, normal_W;
  };

  void take(const ClStatement& statement);
  void refuse_word(const ClStatement& statement);
  void finish();
  void fault(const char* code, const ClStatement& at, std::string text, std::string fix);
  void fault(const char* code, const ClArgument& at, std::string text, std::string fix);
  /// True when all arguments are numbers and their count is one of the two.
  bool numbers(const ClStatement& s, size_t few, size_t many, const char* form);
  bool all_numbers(const ClStatement& s, const char* form);
  /// The unit vector of three numbers.
  bool unit_vector(const ClStatement& s, size_t first, const char* what, Vec3& unit);
  /// Whether the arguments are these words and numbers, one # for each number: "LINE ### ###".
  static bool fits(const ClStatement& s, std::string_view pattern);
  /// A finite number in the units of the program, in mm.
  double mm(double value) const { return value * unit_mm_; }
  Vec3 point_at(const ClStatement& s, size_t first) const;
  void remark(std::string text);

  // Who wrote it (writer_marks.cpp).
  void comment(const ClStatement& s);
  void mark(ClWriter writer, const std::string& what, const ClStatement& s);
  /// +1: CIRCLE runs counter-clockwise about its vector, -1: clockwise; none: nobody says.
  std::optional<double> circle_sense() const;
  void pprint(const ClStatement& s);

  // Motion (motion.cpp).
  bool pose_of(const ClStatement& s, ToolPose& pose);
  void go_to(const ClStatement& s);
  void go_delta(const ClStatement& s);
  void go_home(const ClStatement& s);
  void from(const ClStatement& s);
  void start_at(const ClStatement& s, const ToolPose& pose);
  void move_to(const ClStatement& s, const ToolPose& to);
  void add_move(const ClStatement& s, const ToolPose& to, double feed_mm_s, double dwell_s);
  /// One move as it leaves the reader, compensated where CUTCOM is on.
  void send(const ClStatement& s, const ToolPose& to, const std::optional<ClArc>& arc, double feed_mm_s,
            double dwell_s);
  void emit(const ClMove& move);
  void drill(const ClStatement& s, const ToolPose& hole);
  void rapid(const ClStatement& s);
  void retract(const ClStatement& s);
  void clearance_plane(const ClStatement& s);

  // Arcs (arc.cpp).
  void circle(const ClStatement& s);
  void move_arc(const ClStatement& s);
  void direction(const ClStatement& s);
  void part_surface(const ClStatement& s);
  void tool_on(const ClStatement& s);
  /// The move of TLON round circle_, whose normal has no sense yet. `second`: ON,2,INTOF.
  void catia_circle(const ClStatement& s, const Vec3& end_W, bool second);
  /// +1 or -1 as INDIRV points along counter-clockwise or clockwise about the axis where the tool stands;
  /// none with a fault when it points off the circle.
  std::optional<double> sense_along(const ClStatement& s, const Vec3& centre_W, const Vec3& axis_W);
  /// One GOTO with several positions behind a CIRCLE: points passed on the arc, then its end.
  void go_round(const ClStatement& s);
  /// True with a fault where Creo may mean another point of the arc before, or a straight line.
  bool continues_arc(const ClStatement& s, const Vec3& to);
  /// False with a fault unless the points follow each other on the circle.
  bool passes(const ClStatement& s, const std::vector<Vec3>& points);
  bool arc_fits(const ClStatement& s, const Vec3& from, const Vec3& to);
  /// Moves to `to` round circle_.
  void add_arc(const ClStatement& s, const ToolPose& to);

  // Coordinate systems (system.cpp).
  void system(const ClStatement& s);
  void matrix_system(const ClStatement& s);
  void creo_system(const ClStatement& s);
  void catia_system(const ClStatement& s);
  void origin(const ClStatement& s);
  void translation(const ClStatement& s);
  void transformed_cut(const ClStatement& s);
  bool may_change_system(const ClStatement& s);
  void set_system(const Pose& X_SC);

  // MOVNRB (nurbs.cpp).
  void nurbs(const ClStatement& s);
  void nurbs_sizes(const ClStatement& s);
  void nurbs_values(const ClStatement& s);
  /// MOVNRB/NEXT: the curve is whole; its moves.
  void follow_nurbs(const ClStatement& s);
  /// True when the statement belongs to the curve that is open, or is refused there.
  bool inside_nurbs(const ClStatement& s);

  // Tools (tools.cpp).
  void load_tool(const ClStatement& s);
  void load(const ClStatement& s);
  void tool_path(const ClStatement& s);
  void tool_data(const ClStatement& s);
  void cutter(const ClStatement& s);
  bool tool_number(const ClArgument& argument, const ClStatement& s);
  void call_tool(const ClStatement& s, const ClTool& tool);
  void add_cutter(ClCutter cutter);
  /// Of the tool that is loaded; none when neither the file nor the scene says.
  std::optional<double> cutter_radius() const;

  // Cutter compensation (cutcom.cpp).
  void cutter_compensation(const ClStatement& s);
  bool read_cutcom(const ClStatement& s, nc::Compensation& side, nc::Plane& plane);
  void start_contour(const ClStatement& s, nc::Compensation side, nc::Plane plane);
  void compensate(const ClStatement& s, const ToolPose& to, const std::optional<ClArc>& arc, double feed_mm_s,
                  double dwell_s);
  /// False with a fault while the contour is compensated.
  bool not_compensated(const ClStatement& s);

  // Everything else (words.cpp).
  void feed_rate(const ClStatement& s);
  void spindle(const ClStatement& s);
  void multi_axis(const ClStatement& s);
  void tool_axis(const ClStatement& s);
  void cycle(const ClStatement& s);
  void delay(const ClStatement& s);
  void units(const ClStatement& s);
  void set_mode(const ClStatement& s);
  void mode(const ClStatement& s);
  void auxiliary(const ClStatement& s);
  void tolerance(const ClStatement& s);
  void note(const ClStatement& s);
  void end(const ClStatement&) { ended_ = true; }
  /// mm/s from a feed and the word behind it; 0 with a fault when it cannot be told.
  double feed_of(const ClArgument& value, const std::string& unit);

  // CYCLE (cycle_words.cpp).
  bool read_cycle(const ClStatement& s, ClCycle& cycle);
  bool read_fixed_cycle(const ClStatement& s, ClCycle& cycle);
  bool read_cycle_kind(const ClStatement& s, size_t& at, ClCycle& cycle);
  bool read_cycle_word(const ClStatement& s, size_t& at, ClCycle& cycle);
  bool read_retract(const ClStatement& s, size_t& at, ClCycle& cycle);
  /// False with a fault when the cycle contradicts itself.
  bool cycle_fits(const ClStatement& s, const ClCycle& cycle);

  const ClOptions& options_;
  ClSink& sink_;
  Reporter reporter_;
  ClProgram program_;
  ToolPose pose_;
  Vec3 axis_W_ = Vec3::UnitZ();   ///< of a position that gives none
  Pose X_SC_ = Pose::Identity();  ///< MSYS: from the coordinates of the program to the file's first system
  Pose X_WC_ = Pose::Identity();  ///< the same with ORIGIN and TRANS: to the work
  Vec3 origin_ = Vec3::Zero();
  std::optional<Vec3> translation_;
  std::optional<Pose> first_catia_;  ///< of $$*CATIA0: machining axes to the part
  std::optional<std::array<double, 12>> creo_system_;
  int catia_lines_ = 0;  ///< comments of $$*CATIA0 that are still to come
  std::array<double, 12> catia_{};
  bool positioned_ = false;
  bool axis_known_ = true;  ///< (0,0,1) until MULTAX/ON
  bool multi_axis_ = false;
  bool rapid_ = false, ended_ = false, feed_missed_ = false;
  double unit_mm_ = 1.0;  ///< 25.4 after UNITS/INCHES
  double feed_mm_s_ = 0.0, spindle_rpm_ = 0.0, dwell_s_ = 0.0;
  int tool_ = -1;
  int cutter_ = -1;  ///< index of the CUTTER that the next motion takes up
  std::optional<Circle> circle_;
  std::optional<Circle> rounded_;    ///< the arc of the statement before, in files of Creo
  std::optional<Vec3> direction_W_;  ///< INDIRV
  std::optional<Plane> part_surface_, clearance_;
  std::optional<ToolPose> home_;  ///< FROM
  std::optional<ClCycle> cycle_;
  std::optional<ClCycle> cycle_words_;  ///< of the last CYCLE, as they were given: what CYCLE/ON changes
  Vec3 cycle_start_W_ = Vec3::Zero();   ///< where the tip stood when the cycle began
  std::optional<ClNurbs> nurbs_;        ///< from MOVNRB/3AXIS or 5AXIS to MOVNRB/OFF
  std::unique_ptr<ClCompensation> compensation_;
  nc::Compensation last_side_ = nc::Compensation::kOff;  ///< what CUTCOM/ON switches on again
  nc::Plane last_plane_ = nc::Plane::kXY;
  std::optional<ClPoints> file_cutcom_;  ///< what the file says of its points
};

}  // namespace swarf::program
