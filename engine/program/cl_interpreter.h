// Executes the statements of CL data one by one: the state between them and one handler for each word.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "program/cl_cycle.h"
#include "program/cl_nurbs.h"
#include "program/cl_program.h"
#include "program/cl_statement.h"
#include "program/reporter.h"

namespace swarf::program {

class ClInterpreter {
 public:
  ClInterpreter(const std::string& file, Diagnostics& diagnostics);
  ClProgram run(const std::string& text);

 private:
  using Handler = void (ClInterpreter::*)(const ClStatement&);
  struct Word {
    const char* name;
    Handler handler;
  };
  static std::span<const Word> words();

  void take(const ClStatement& statement);
  void finish();
  void fault(const char* code, const ClStatement& at, std::string text, std::string fix);
  void fault(const char* code, const ClArgument& at, std::string text, std::string fix);
  /// True when all arguments are numbers and their count is one of the two.
  bool numbers(const ClStatement& s, size_t few, size_t many, const char* form);
  /// The unit vector of three numbers.
  bool unit_vector(const ClStatement& s, size_t first, const char* what, Vec3& unit);
  /// A finite number in the units of the program, in mm.
  double mm(double value) const { return value * unit_mm_; }
  Vec3 point_at(const ClStatement& s, size_t first) const;

  // Motion (cl_motion.cpp).
  bool pose_of(const ClStatement& s, ToolPose& pose);
  void go_to(const ClStatement& s);
  void go_delta(const ClStatement& s);
  void from(const ClStatement& s);
  void start_at(const ClStatement& s, const ToolPose& pose);
  void move_to(const ClStatement& s, const ToolPose& to);
  void add_move(const ClStatement& s, const ToolPose& to, double feed_mm_s, double dwell_s);
  void drill(const ClStatement& s, const ToolPose& hole);
  bool arc_fits(const ClStatement& s, const ClMove& move);
  void circle(const ClStatement& s);
  void rapid(const ClStatement& s);
  void system(const ClStatement& s);

  // MOVNRB (cl_nurbs.cpp).
  void nurbs(const ClStatement& s);
  void nurbs_sizes(const ClStatement& s);
  void nurbs_values(const ClStatement& s);
  /// MOVNRB/NEXT: the curve is whole; its moves.
  void follow_nurbs(const ClStatement& s);
  /// True when the statement belongs to the curve that is open, or is refused there.
  bool inside_nurbs(const ClStatement& s);

  // Everything else (cl_words.cpp).
  void feed_rate(const ClStatement& s);
  void spindle(const ClStatement& s);
  void multi_axis(const ClStatement& s);
  void load_tool(const ClStatement& s);
  void load(const ClStatement& s);
  void tool_path(const ClStatement& s);
  void tool_data(const ClStatement& s);
  void cutter(const ClStatement& s);
  void cutter_compensation(const ClStatement& s);
  void cycle(const ClStatement& s);
  void delay(const ClStatement& s);
  void units(const ClStatement& s);
  void set_mode(const ClStatement& s);
  void note(const ClStatement& s);
  void end(const ClStatement&) { ended_ = true; }
  /// mm/s from a feed and the word behind it; 0 with a fault when it cannot be told.
  double feed_of(const ClArgument& value, const std::string& unit);
  bool tool_number(const ClArgument& argument, const ClStatement& s);
  void call_tool(const ClTool& tool);

  // CYCLE (cl_cycle_words.cpp).
  bool read_cycle(const ClStatement& s, ClCycle& cycle);
  bool read_cycle_word(const ClStatement& s, size_t at, ClCycle& cycle);
  /// False with a fault when the cycle contradicts itself.
  bool cycle_fits(const ClStatement& s, const ClCycle& cycle);

  Reporter reporter_;
  ClProgram program_;
  ToolPose pose_;
  Vec3 axis_W_ = Vec3::UnitZ();   ///< of a position that gives none
  Pose X_WC_ = Pose::Identity();  ///< MSYS: from the coordinates of the program to the work
  bool positioned_ = false;
  bool axis_known_ = true;  ///< (0,0,1) until MULTAX/ON
  bool rapid_ = false, ended_ = false, feed_missed_ = false;
  double unit_mm_ = 1.0;  ///< 25.4 after UNITS/INCHES
  double feed_mm_s_ = 0.0, spindle_rpm_ = 0.0, arc_radius_ = 0.0, dwell_s_ = 0.0;
  int tool_ = -1;
  std::optional<ClArc> arc_;
  std::optional<ClCycle> cycle_;
  std::optional<ClNurbs> nurbs_;  ///< from MOVNRB/3AXIS or 5AXIS to MOVNRB/OFF
};

}  // namespace swarf::program
