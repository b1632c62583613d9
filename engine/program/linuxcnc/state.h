// What the reader of RS274/NGC (LinuxCNC) keeps from block to block, as plain data; steps.h has what is done
// with it. Source: the language as the LinuxCNC documentation describes it.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "program/control/call_stack.h"
#include "program/control/curve.h"
#include "program/letters/letter_dialect.h"
#include "program/linuxcnc/codes.h"

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
  bool unit_known = false, inches = false, incremental = false, arc_absolute = false, retract_to_r = false;
  Plane plane = Plane::kXY;
  FeedMode feed_mode = FeedMode::kPerMinute;
  double feed = 0.0, speed_rpm = 0.0;
  int spindle = 0, work_offset = 1, tool_number = 0;
  int radius_code = G::kCompensationOff;
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

/// O-words that run, and those that were found.
struct Calls {
  CallStack<Call> stack;
  std::vector<Sub> known;
};

/// Parameters up to #30 are arguments, from kNumbers on they belong to the control.
inline constexpr long kNumbers = 5400, kArguments = 30;
inline constexpr long kControlNumbers = 5161;  ///< reference positions and offsets: G codes set them
/// #5599: whether (DEBUG, ) speaks; on until a program says otherwise.
inline constexpr long kDebugOutput = 5599;

/// #numbers and #<names>.
struct NumbersAndNames {
  std::vector<Named> globals;
  std::vector<double> numbers;  ///< #31 to #5399, and #1 to #30 of the main program
  std::vector<bool> number_set;
  std::vector<std::pair<long, double>> new_numbers;  ///< of this block: assigned when it is read
  std::vector<std::pair<std::string, double>> new_names;
  double returned = 0.0, debug_output = 1.0;
  bool value_returned = false;
  bool in_message = false;  ///< a value is wanted for a message: what nobody assigned has none there
};

/// Modal codes in tenths, and what words of the machine say.
struct Modes {
  int motion = -1;  ///< -1: none
  bool incremental = false, arc_absolute = false;
  bool retract_to_r = true, retract_known = false;  ///< G99; a G98 or G99 was read
  bool tool_called = false, mist = false, flood = false, input_read = false;
  int radius_code = G::kCompensationOff;  ///< G40, G41, G41.1, ...
  double diameter_mm = 0.0;               ///< of the cutter that G41 or G42 compensate
  std::array<bool, 3> kinematics_told{};  ///< M428, M429, M430: the default has been reported
};

struct Drilling {
  StickyCycle words;
  double cycle_start = 0.0;  ///< height before the first hole of a series
};

struct Curves {
  std::optional<Vec3> spline_tangent;  ///< where the last G5 leads on to, mm; none: the next is the first
  std::optional<OpenNurbs> nurbs;
};

/// What moves the program's zero.
struct Zero {
  kinematics::AxisValues shift = kinematics::AxisValues::Zero();  ///< G92, G52
  bool shift_on = false;  ///< G92.2 keeps the values and switches them off
  std::array<std::optional<kinematics::AxisValues>, 2> references;  ///< G28.1, G30.1
  std::array<double, 10> offset_turn{};                             ///< G10 L2 R, rad
  std::map<int, ToolData> tool_data;
};

inline constexpr uint32_t kAxisBits = 7u | 7u << ('X' - 'A');

struct LinuxCnc final : LetterDialect {
  LinuxCnc(const std::string& file, Control& machine);
  double read(long number, size_t place) override;
  double read_named(std::string_view name, size_t place) override;
  bool exists(std::string_view name) override;
  bool vacant(long /*number*/) const override { return false; }

  Calls calls;
  NumbersAndNames parameters;
  Modes modes;
  Drilling drilling;
  Curves curves;
  Zero zero;
};

inline bool is_axis_given(const LetterDialect& letters) {
  return (letters.block.given & kAxisBits) != 0;
}
/// The call that runs, and the file that is being read.
inline Call& frame(Calls& calls) {
  return calls.stack.top();
}
inline LineSource& source(Calls& calls) {
  return *calls.stack.top().source;
}

}  // namespace swarf::program::nc::linuxcnc
