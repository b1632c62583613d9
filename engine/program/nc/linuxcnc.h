// The reader of the RS274/NGC dialect (LinuxCNC). Source: the language as the LinuxCNC documentation
// describes it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "program/nc/letter_dialect.h"

namespace swarf::program::nc {

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

/// Words of a canned cycle that stay until G80 or another motion.
struct StickyCycle {
  double z = 0.0, r = 0.0, q = 0.0, p = 0.0;
  bool has_z = false, has_r = false, has_q = false, has_p = false;
};

class LinuxCnc final : public LetterDialect {
 public:
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
  };
  struct Sub {
    std::string name;
    bool numbered;
    LineSource* source;
    LineSource::Mark body;
  };

  // linuxcnc_flow.cpp
  bool at_o_word();
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

  // linuxcnc.cpp
  bool execute();
  void read_assignment();
  void assign();
  // linuxcnc_block.cpp
  void check_words();
  void check_axes_and_motion();
  void apply();
  void apply_feed_and_speed();
  void apply_tool();
  void apply_spindle();
  void apply_compensation();
  void apply_offsets();
  void apply_path_mode();
  void apply_machine_codes();
  bool apply_end();
  void set_kinematics(int tenths);
  // linuxcnc_offsets.cpp
  void non_modal();
  void set_data();
  void reference(int tenths);
  void set_reference(int tenths);
  std::optional<kinematics::AxisValues> reference_position(bool second) const;
  void shift_to_words(bool absolute);
  void update_shift();
  // linuxcnc_motion.cpp
  void motion();
  void arc(int tenths);
  void cycle(int tenths);
  bool is_axis_given() const { return (block_.given & kAxisBits) != 0; }
  bool uses_axis_words() const;
  Call& frame() { return calls_.back(); }
  LineSource& source() { return *calls_.back().source; }
  double system_parameter(long number, size_t place);
  std::optional<double> predefined(std::string_view name) const;

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
  bool incremental_ = false, arc_absolute_ = false, retract_to_r_ = false;
  StickyCycle cycle_;
  double cycle_start_ = 0.0;  ///< height before the first hole of a series
  kinematics::AxisValues shift_ = kinematics::AxisValues::Zero();  ///< G92, G52
  bool shift_on_ = true;
  std::array<std::optional<kinematics::AxisValues>, 2> references_;  ///< G28.1, G30.1
  std::array<double, 10> offset_turn_{};                             ///< G10 L2 R, rad
};

}  // namespace swarf::program::nc
