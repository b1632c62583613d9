// The reader of the RS274/NGC dialect (LinuxCNC). Source: the language as the LinuxCNC documentation
// describes it.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "program/control/curve.h"
#include "program/letters/letter_dialect.h"

namespace swarf::program::nc::linuxcnc {

extern const LetterSyntax kLinuxCncSyntax;
extern const FormulaSyntax kLinuxCncFormula;

/// Modal groups of the code table.
enum LinuxCncGroup {
  kNonModal = 0,
  kMotionGroup = 1,
  kPlaneGroup = 2,
  kDistanceGroup = 3,
  kArcDistanceGroup = 4,
  kFeedGroup = 5,
  kUnitsGroup = 6,
  kRadiusGroup = 7,
  kLengthGroup = 8,
  kRetractGroup = 10,
  kOffsetGroup = 12,
  kPathGroup = 13,
  kMachineGroup = 14,  ///< G53
  kStopGroup = 0,
  kToolGroup = 1,
  kSpindleGroup = 2,
  kCoolantGroup = 3,
  kCallGroup = 4,
  kKinsGroup = 5
};

/// Words of a canned cycle that stay while the same cycle goes on; R while any cycle does. Lengths in mm.
struct StickyCycle {
  std::optional<double> depth, r, q, p;
  std::array<std::optional<double>, 3> ijk;
};

/// What M70 and M73 keep: the words that the reference lists for them, and no others (not the motion mode,
/// the kinematics, G52, G92).
struct ModalState {
  bool inches = false, incremental = false, arc_absolute = false, retract_to_r = false;
  Plane plane = Plane::kXY;
  FeedMode feed_mode = FeedMode::kPerMinute;
  double feed = 0.0, speed_rpm = 0.0;
  int spindle = 0, work_offset = 1, tool_number = 0;
  int radius_code = 400;
  double diameter_mm = 0.0;  ///< of the cutter that is compensated
  double length_mm = 0.0;
  bool length_on = false, exact_stop = false, mist = false, flood = false;
  double corner_tolerance_mm = 0.0;
};

/// What G10 wrote over the tool table.
struct ToolData {
  std::optional<double> length_mm, diameter_mm;
};

/// The points of G5.2 that have come so far.
struct OpenNurbs {
  int order = 0;
  std::vector<CurvePoint> points;
  std::vector<double> weights;
  Place place;  ///< of G5.2
};

class LinuxCnc final : public LetterDialect {
 public:
  /// Parameters up to #30 are arguments, from kNumbers on they belong to the control.
  static constexpr long kNumbers = 5400, kArguments = 30;
  LinuxCnc(const std::string& path, Control& control);
  void run();

  double read(long number, size_t place) override;
  double read_named(std::string_view name, size_t place) override;
  bool exists(std::string_view name) override;
  bool vacant(long /*number*/) const override { return false; }

 private:
  enum class Keyword {
    kNone,
    kSub,
    kEndSub,
    kCall,
    kReturn,
    kDo,
    kWhile,
    kEndWhile,
    kIf,
    kElseIf,
    kElse,
    kEndIf,
    kRepeat,
    kEndRepeat,
    kBreak,
    kContinue
  };
  struct OWord {
    std::string name;  ///< digits, or the name in small letters
    Keyword keyword = Keyword::kNone;
    int column = 0;
  };
  struct Loop {
    std::string name;
    Keyword kind;  ///< kDo, kWhile, kRepeat, kIf
    LineSource::Mark top;
    long left = 0;  ///< repetitions still to come
    int line = 0;
  };
  struct Named {
    std::string name;
    double value;
  };
  struct Call {
    std::string sub;
    LineSource* source;
    LineSource::Mark back, top;  ///< where it returns to, where its body starts
    bool numbered = false;       ///< M98: ends with M99
    long left = 0;               ///< repetitions still to come (M98 L)
    std::array<double, 31> arguments{};
    uint64_t assigned = 0;  ///< bits of `arguments`
    std::vector<Named> named;
    std::vector<Loop> loops;
    std::optional<ModalState> saved;  ///< M70, M73
    bool restores = false;            ///< M73: the state comes back at the end of the subprogram
  };
  struct Sub {
    std::string name;
    bool numbered;
    LineSource* source;
    LineSource::Mark body;
  };

  // flow.cpp
  bool at_o_word();
  /// Fails with `what` unless only comments follow.
  void end_of_o_word(const char* what);
  OWord read_o_word();
  void flow();
  void step_if(const OWord& word);
  void step_loop(const OWord& word);
  void leave_loop(const OWord& word);
  Loop& top_loop(const OWord& word, Keyword kind);
  OWord skip_to(const std::string& name, std::initializer_list<Keyword> ends, const char* missing);
  void define_sub(const OWord& word);
  void call_sub(const OWord& word);
  const Sub* find_sub(const std::string& name, bool numbered);
  const Sub* scan(LineSource& source, const std::string& name, bool numbered);
  void enter(const Sub& sub, Call call);
  void leave();
  void call_number(int number, long times, int column);
  double condition();
  void end_of_flow();

  // dialect.cpp
  bool execute();
  void read_assignment();
  void assign();
  std::string message_text();
  // block.cpp
  void check_words();
  void check_letters();
  void check_axes_and_motion();
  void apply();
  void apply_feed_and_speed();
  void warn_of_feed_units();
  void apply_machine_functions();
  void apply_offsets();
  void apply_path_mode();
  bool apply_end();
  // tools.cpp
  void apply_tool();
  void declare_tool();
  void apply_compensation();
  void apply_length();
  std::optional<double> diameter_of(int number, int column);
  double length_of(int number, int column);
  int tool_word(char letter);
  void set_tool_data(int kind);
  double touched_length(int kind, double value) const;
  // state.cpp
  void apply_saved_state(int tenths, int column);
  ModalState modal_state() const;
  void restore(const ModalState& state, int column);
  // machine.cpp
  void read_input();
  void warn_of_output();
  void switch_kinematics(int tenths, int column);
  void assume_kinematics(int number, Kinematics kinematics, int column);
  // offsets.cpp
  void non_modal();
  void set_data();
  void reference(int tenths);
  void set_reference(int tenths);
  std::optional<kinematics::AxisValues> reference_position(bool second) const;
  void shift_to_words(bool position);
  void update_shift();
  // motion.cpp
  void motion();
  void spline(int tenths);
  void arc(int tenths);
  // cycles.cpp
  void cycle(int tenths);
  void check_cycle(int tenths) const;
  void keep_cycle_words(bool same);
  double cycle_word(const std::optional<double>& value, char letter) const;
  void above_hole(const Target& hole, double r);
  void back_bore(double approach, double bottom, double retract, const Target& hole);
  // curves.cpp
  void check_curve(const char* name) const;
  void cubic_spline();
  void quadratic_spline();
  Vec3 end_of_curve();
  void check_nurbs_words();
  void nurbs_point();
  void close_nurbs();
  [[noreturn]] void fail_open_nurbs() const;
  bool is_axis_given() const { return (block_.given & kAxisBits) != 0; }
  bool uses_axis_words() const;
  Call& frame() { return calls_.back(); }
  LineSource& source() { return *calls_.back().source; }
  // parameters.cpp
  double system_parameter(long number, size_t place);
  double position_parameter(long number, size_t place);
  double machine_length(double mm, long number, size_t place) const;
  std::optional<double> predefined(std::string_view name);
  bool is_read_only(std::string_view name);
  void refuse_machine_value(std::string_view name, size_t place) const;

  static constexpr uint32_t kAxisBits = 7u | 7u << ('X' - 'A');

  std::vector<Call> calls_;
  std::vector<Sub> subs_;
  std::vector<Named> globals_;
  std::vector<double> numbers_;  ///< #31 to #5399, and #1 to #30 of the main program
  std::vector<bool> number_set_;
  std::vector<std::pair<long, double>> new_numbers_;
  std::vector<std::pair<std::string, double>> new_names_;
  double returned_ = 0.0;
  bool value_returned_ = false;

  int motion_ = -1;  ///< tenths; -1: none
  bool incremental_ = false, arc_absolute_ = false;
  bool retract_to_r_ = true, retract_known_ = false;  ///< G99; a G98 or G99 was read
  StickyCycle cycle_;
  std::optional<Vec3> spline_tangent_;  ///< where the last G5 leads on to, mm; none: the next is the first
  std::optional<OpenNurbs> nurbs_;
  double cycle_start_ = 0.0;  ///< height before the first hole of a series
  kinematics::AxisValues shift_ = kinematics::AxisValues::Zero();  ///< G92, G52
  bool shift_on_ = false;  ///< G92.2 keeps the values and switches them off
  std::map<int, ToolData> tool_data_;
  bool tool_called_ = false, mist_ = false, flood_ = false, input_read_ = false;
  int radius_code_ = 400;                  ///< tenths: G40, G41, G41.1, ...
  double diameter_mm_ = 0.0;               ///< of the cutter that G41 or G42 compensate
  std::array<bool, 3> kinematics_told_{};  ///< M428, M429, M430: the default has been reported
  std::array<std::optional<kinematics::AxisValues>, 2> references_;  ///< G28.1, G30.1
  std::array<double, 10> offset_turn_{};                             ///< G10 L2 R, rad
};

}  // namespace swarf::program::nc::linuxcnc
