// The control as every dialect sees it: the modal state of the machine tool, and the motions its words come
// down to. A dialect reads text and calls these functions; no function here knows any dialect.
//
//   words -> [dialect] -> Target, ArcWords, DrillCycle, Curve -> Control -> cutter compensation -> NcMove ->
//   sink
//
// Coordinates (mm and rad everywhere; dialects convert with mm() and rad_from_deg):
//   p        program coordinates: what X Y Z mean at this moment
//   F        the programmable frame (TRANS, ROT, G68.2, PLANE): any rigid Pose
//   origin   axis values at which the gauge line (a tool of length 0) stands on the program's zero with the
//   rotary
//            axes at zero; setup.work_offsets are differences from the one of W's origin
//   c        compensated tool length (G43 H, D1, TOOL CALL), along the tool axis
//   kAxes:   q_linear = origin + shift + c + F p            XYZ are axis values, rotaries are independent
//   kWork:   tip_W    = L (origin + shift - zero) + F_W p   XYZ are the tip in W; the linear axes follow the
//   rotaries
//            that stand or are given (L: axis values to W with the rotary axes at zero; F_W: F turned
//            likewise)
//   TCP is kWork with the law of the tip: kTcpAxes for rotary values, kTcp for vectors; without TCP every law
//   is kJoint, and an arc is the tip's arc in W, which needs standing rotaries.
//
// Faults of the program are thrown as InputError at the current place; run_nc reports them and stops the
// program there, as a control does. Everything that a block says is checked before the first call that
// changes state: it is the dialect's part to call the functions only after its own checks (words, groups,
// rules).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinematics/machine_model.h"
#include "program/control/contour.h"
#include "program/control/curve.h"
#include "program/control/dialect_words.h"
#include "program/control/drill_cycle.h"
#include "program/control/target.h"
#include "program/control/work_space.h"
#include "program/nc_program.h"

namespace swarf::program::nc {

/// Thrown where the sink wants no more moves; run_nc catches it.
struct ProgramStopped {};

/// The radius at which one degree is one mm of arc.
inline constexpr double kDegreePerMm = 57.29577951308232;

struct Control final : public ContourHost {
 public:
  /// All references must outlive the control. Throws InputError when the machine has no unique inverse, lacks
  /// one of X Y Z, or names an axis other than X Y Z A B C ("axis-names").
  Control(const ControlSetup& setup, NcSink& sink, Diagnostics& diagnostics, NcSummary& summary);
  ~Control();
  Control(const Control&) = delete;
  Control& operator=(const Control&) = delete;

  // --- Place: which block is being executed; every fault and move carries it -------------------------------
  /// `file`: index into NcSummary::files, see enter_file().
  void at(int file, int line, int column) override { place_ = {file, line, column}; }
  Place place() const { return place_; }
  /// The index of this file in NcSummary::files, added when it is new.
  int enter_file(const std::string& path);
  /// A fault in the current block. `column` 0: the column of at().
  [[noreturn]] void fail(const char* code, int column, std::string text, std::string fix) const override;
  /// A warning that is given once per `code` and program.
  void warn_once(const char* code, int column, std::string text, std::string fix);
  /// True for a word of ControlSetup::builder_words, as builder_word() gives it: it is listed.
  bool take_builder_word(const std::string& word);
  /// A word that was read and has no effect on the geometry: listed once in NcSummary::functions.
  void without_effect(std::string_view word);
  void note(std::string_view word, std::string_view text);
  /// What remedies call things; the words of letter dialects unless the dialect says otherwise.
  void set_words(const DialectWords& words) { words_ = words; }
  const DialectWords& words() const override { return words_; }

  // --- Units, plane, feed, spindle -------------------------------------------------------------------------
  void set_inches(bool inches) { unit_mm_ = inches ? 25.4 : 1.0; }
  bool inches() const { return unit_mm_ != 1.0; }
  double mm(double program_length) const { return program_length * unit_mm_; }
  void set_plane(Plane plane);
  Plane plane() const override { return plane_; }
  /// A new mode forgets F, as controls do; G93 wants F in each feed block ("missing-feed").
  void set_feed_mode(FeedMode mode);
  FeedMode feed_mode() const { return feed_mode_; }
  /// F as written: units/min and deg/min, units/rev, or 1/min. Above 0 ("bad-feed"). It is a speed: a later
  /// change of the units leaves it what it is.
  void set_feed(double value, int column) { set_feed_in(unit_mm_, value, column); }
  /// Where F counts in other units of length than X Y Z do.
  void set_feed_in(double unit_mm, double value, int column);
  double feed() const { return feed_; }
  /// The mode and the F (0: none), in the units that hold; no F of the present block.
  void restore_feed(FeedMode mode, double feed);
  void set_feed_rule(FeedRule rule) { feed_rule_ = rule; }
  /// Radii at which rotary axes A B C count for F, mm; 180/pi as long as none is set: a degree is a mm.
  void set_feed_radii(const std::array<double, 3>& radii_mm) { feed_radii_mm_ = radii_mm; }
  void set_speed(double rpm) { speed_rpm_ = rpm; }
  double speed_rpm() const { return speed_rpm_; }
  /// +1 clockwise (M3), -1 counter-clockwise (M4), 0 stopped (M5).
  void set_spindle(int direction) { spindle_ = direction; }
  int spindle() const { return spindle_; }

  // --- Tools -----------------------------------------------------------------------------------------------
  /// Index into ControlSetup::tools. "unknown-tool" names it and the tools there are. With an empty table
  /// nothing can be looked up: returns -1 and warns once ("no-tool-table").
  int find_tool(int number, int column);
  int find_tool(const std::string& name, int column);
  /// What stands ready (T); change_tool() puts it into the spindle. -1 with `number` 0 empties the spindle.
  void select_tool(int index, int number);
  int selected_number() const { return selected_number_; }
  /// M6: moves to MachineModel::tool_change where the machine has one (rapid, all axes), stops the spindle.
  /// The compensated length stays what it is; the dialect sets it.
  void change_tool();
  /// The tool that is in the spindle already: no change, no motion.
  void declare_tool(int index, int number);
  int tool() const { return tool_; }
  int tool_number() const { return tool_number_; }
  /// The tool in the spindle, null when there is none or no table.
  const NcTool* active_tool() const;
  const NcTool& tool_at(int index) const { return setup_.tools[static_cast<size_t>(index)]; }
  /// Compensated length c; 0 with G49, D0. The tip itself always stands where the tool's true length puts it.
  void set_length_compensation(double length_mm, bool on);
  double length_compensation() const { return space_.length(); }
  bool length_compensated() const { return length_on_; }

  // --- Cutter radius compensation --------------------------------------------------------------------------
  /// G41 (left), G42 (right) or off. The next straight move in the plane leads in. "compensation-plane"
  /// outside one plane, "compensation-no-tool" without a radius. Off: the next move leads out.
  void set_compensation(Compensation side, double radius_mm, int column);
  Compensation compensation() const;
  /// G40 was given, and the move in the plane that leads out has not come yet.
  bool leading_out() const;
  /// Compensation begins where the tool stands, a cutter radius beside `contour_point` (program coordinates),
  /// from which the next move counts: approaches that a dialect has moved itself. No lead-in follows.
  void enter_compensation(Compensation side, double radius_mm, const Vec3& contour_point);
  /// Where the lead-in ends; kAcrossNext unless the dialect says otherwise.
  void set_compensation_entry(CompensationEntry entry);
  /// Which corners the control takes for smooth ones, rad; as good as none unless the dialect says otherwise.
  void set_compensation_smooth(double angle_rad);

  // --- Frames and offsets ----------------------------------------------------------------------------------
  /// Work offset by number (1: G54); 0: none (G53, G500: the work zero itself).
  void set_work_offset(int number);
  int work_offset() const { return offset_number_; }
  /// Axis values of the origin of an offset in machine coordinates (G10 L2, $P_UIFR).
  kinematics::AxisValues offset_origin(int number) const;
  void set_offset_origin(int number, const kinematics::AxisValues& origin);
  /// Further shift of all offsets, as axis values (G92, G52): added to the origin.
  void set_shift(const kinematics::AxisValues& shift);
  const kinematics::AxisValues& shift() const { return space_.shift(); }
  /// The programmable frame F (see above), and what XYZ mean.
  void set_frame(const Pose& frame);
  const Pose& frame() const { return space_.frame(); }
  void set_coordinates(Coordinates coordinates);
  Coordinates coordinates() const { return space_.coordinates(); }
  /// TCP on (kWork with the law of the tip) or off. Off leaves the coordinates at kAxes.
  void set_tcp(Tcp tcp);
  Tcp tcp() const { return tcp_; }

  // --- Exact stop and corners ------------------------------------------------------------------------------
  void set_exact_stop(bool on) { exact_stop_ = on; }
  void exact_stop_once() { exact_stop_once_ = true; }  ///< G9
  bool exact_stop() const { return exact_stop_; }
  void set_corner_tolerance(double mm) { corner_tolerance_mm_ = mm; }
  double corner_tolerance() const { return corner_tolerance_mm_; }
  /// G4: the next move waits this long before it starts. Zero or more ("out-of-range").
  void dwell(double seconds);

  // --- Motion ----------------------------------------------------------------------------------------------
  /// Rapid or feed on a straight line (or the joint-linear one, see above). What the target does not give
  /// stays.
  void line(Motion motion, const Target& target);
  /// G2, G3 in the active plane (or about ArcWords::normal). "bad-arc". Without TCP an arc during which
  /// rotary axes turn is one of axis values and no arc on the part: it comes as chords (curve.h).
  void arc(Motion motion, const Target& target, const ArcWords& words);
  /// One hole, at the target's place in the plane: the positions of the cycle's moves along the plane's
  /// normal.
  void drill(const DrillCycle& cycle, const Target& target);
  /// A parametric curve (NURBS, polynomial) as straight moves whose chords miss it by at most `tolerance_mm`.
  void curve(const Curve& curve, double tolerance_mm);
  /// The target in machine coordinates (G53, SUPA, M91, G28, G30): joint-linear.
  void machine_line(Motion motion, const Target& target);
  /// Both rotary solutions that bring the tool axis to `axis_P` (program frame F), nearest to the present
  /// values first; empty when the machine cannot point there. Linear values keep the tip where it is in W.
  std::vector<kinematics::AxisValues> tilt_solutions(const Vec3& axis_P) const;
  /// The one that `preference` chooses ("unreachable-orientation", with the degrees that are missing).
  kinematics::AxisValues tilt_solution(const Vec3& axis_P, const TiltPreference& preference,
                                       int column) const;
  /// Moves the rotaries to those of `q`: linear axes stand (tip_stands false) or keep the tip in W.
  void turn_rotaries(Motion motion, const kinematics::AxisValues& q, bool tip_stands);
  /// To be called at each jump back and each call: "endless-loop" after a million of them without a move.
  void jump();
  /// Ends what is still in look-ahead; at the end of the program, before positions are read, before M6.
  void flush();
  /// Ends the program: flush, the last dwell, "no-start" when no complete position came.
  void finish();

  // --- Where things are ------------------------------------------------------------------------------------
  /// Program coordinates of the last programmed point, mm and rad, in the order X Y Z A B C. Entries that are
  /// not known yet are NaN.
  const std::array<double, kAxisWords>& position();
  Vec3 position_xyz();
  /// Machine coordinates (compensated position).
  const kinematics::AxisValues& axis_values() const { return q_; }
  /// Present orientation of the tool in the program frame.
  Vec3 tool_axis_P();
  /// The tool axis with all rotary axes at zero, in the program frame.
  Vec3 tool_axis_at_zero_P() const;
  bool started() const { return started_; }
  /// Index into MachineModel::axes of a word's axis; -1: the machine has none.
  int axis_of(AxisWord word) const { return space_.axis_of(word); }
  /// "axis-missing" unless the machine has the axis.
  int require_axis(AxisWord word, int column) const;
  const kinematics::MachineModel& machine() const { return setup_.machine; }
  const ControlSetup& setup() const { return setup_; }
  const WorkSpace& space() const { return space_; }
  NcSummary& summary() { return summary_; }
  Diagnostics& diagnostics() { return diagnostics_; }

 private:
  /// Where a block goes, in full.
  struct Goal {
    Vec3 p = Vec3::Zero();
    std::array<double, 3> rotary{};      ///< machine values of A B C
    std::array<double, 3> programmed{};  ///< program values of A B C
    bool turns = false;                  ///< a rotary axis moves
  };
  void refresh_position();
  Goal resolve(const Target& target);
  double rotary_goal(const Target& target, int slot) const;
  void solve_vector(const Target& target, Goal& goal);
  void check_axes(const Target& target) const;
  bool ready(Motion motion, const Target& target, bool machine);
  bool learn_linear(const Target& target, bool machine);
  void start_here(const std::string& how);
  void count_unwinding(int slot, double turn);
  void prepare(Motion motion, const Target& target, Segment& segment);
  void take(Segment& segment);
  void arrive(const Goal& goal);
  void turning_arc(Motion motion, const ArcWords& words, const Goal& goal);
  void place_circle(Motion motion, const ArcWords& words, Segment& segment) const;
  void emit(const Segment& segment) override;
  void emit_piece(const Segment& segment, const Vec3& p_to, const std::array<double, 3>& rotary_to,
                  double share, double turn);
  void send(const Segment& segment, NcMove& move);
  void set_time(const Segment& segment, double way, double turn_deg, double share, NcMove& move) const;
  void place_arc(const Segment& segment, NcMove& move);
  void go(Motion motion, int normal, double height);
  void check_cycle(const DrillCycle& cycle, const Target& hole);
  void peck_down(const DrillCycle& cycle, int normal, double sign);
  void draw_out(const DrillCycle& cycle, int normal);
  void step_aside(const Vec3& by);
  void leave_aside(const DrillCycle& cycle, int normal);
  void bore_back(const DrillCycle& cycle, const Target& above);
  void moved_frame(const char* what);
  void set_true_tool();
  int not_found(const std::string& asked, int column);
  std::string missing_axes() const;
  [[noreturn]] void fail_tilt(const Vec3& axis_P, const TiltPreference& preference, int axis,
                              int column) const;
  kinematics::InverseSolutions tilt_branches(const Vec3& axis_P) const;

  const ControlSetup& setup_;
  NcSink& sink_;
  Diagnostics& diagnostics_;
  NcSummary& summary_;
  WorkSpace space_;
  std::unique_ptr<Contour> contour_;

  DialectWords words_;
  Place place_;
  double unit_mm_ = 1.0;
  Plane plane_ = Plane::kXY;
  FeedMode feed_mode_ = FeedMode::kPerMinute;
  FeedRule feed_rule_ = FeedRule::kLinearFirst;
  std::array<double, 3> feed_radii_mm_{kDegreePerMm, kDegreePerMm, kDegreePerMm};
  double feed_ = 0.0;          ///< 0: none
  double feed_unit_mm_ = 1.0;  ///< of the length in F
  bool feed_fresh_ = false;    ///< F stood in this block
  double speed_rpm_ = 0.0;
  int spindle_ = 0;
  int selected_ = -1, selected_number_ = 0;
  int tool_ = -1, tool_number_ = 0;
  bool length_on_ = false;
  int offset_number_ = 1;
  std::map<int, kinematics::AxisValues> origins_;
  Tcp tcp_ = Tcp::kOff;
  bool exact_stop_ = false, exact_stop_once_ = false;
  double corner_tolerance_mm_ = 0.0;
  double pending_dwell_s_ = 0.0;

  kinematics::AxisValues q_ = kinematics::AxisValues::Zero();  ///< where the machine was sent
  std::array<double, kAxisWords> position_{};  ///< program coordinates of the programmed point
  bool position_valid_ = false;
  uint8_t known_ = 0;  ///< axes whose value is known, by AxisWord, before the start
  bool started_ = false;
  ToolPose pose_;  ///< of the true tool at q_
  std::vector<std::string> warned_;
  long jumps_ = 0;
  bool axes_rigid_ = true;  ///< linear axis values and W differ by a rigid motion or its mirror image
  long unwound_[3] = {0, 0, 0};
  Place first_motion_;
};

}  // namespace swarf::program::nc
