// The reader of the Fanuc dialect (series 30i words): ISO words, custom macro B, five-axis words.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "program/nc/letter_dialect.h"

namespace swarf::program::nc {

extern const LetterSyntax kFanucSyntax;
extern const FormulaSyntax kFanucFormula;

enum FanucGroup {
  kFanucOneShot = 0,
  kFanucMotion = 1,
  kFanucPlane = 2,
  kFanucDistance = 3,
  kFanucFeed = 5,
  kFanucUnits = 6,
  kFanucRadius = 7,
  kFanucLength = 8,
  kFanucCycle = 9,
  kFanucRetract = 10,
  kFanucOffset = 14,
  kFanucPath = 15,
  kFanucTurn = 16,
  kFanucEnd = 0,
  kFanucTool = 1,
  kFanucSpindle = 2
};

class Fanuc final : public LetterDialect {
 public:
  Fanuc(const std::string& path, Control& control);
  void run();
  double read(long number, size_t place) override;
  double read_named(std::string_view name, size_t place) override;
  bool exists(std::string_view name) override;
  bool vacant(long number) const override;

 private:
  struct Call {
    LineSource* source;
    LineSource::Mark back, top;
    long left = 0;
    bool own_locals = false;  ///< G65: #1 to #33 of its own
    std::array<double, 34> locals{};
    uint64_t assigned = 0;
    std::vector<std::pair<int, LineSource::Mark>> loops;  ///< DO number, its WHILE line
  };
  struct Known {
    int number;
    LineSource* source;
    LineSource::Mark body;
  };
  /// G06.2 while its blocks come in.
  struct Nurbs {
    int order = 4;
    std::vector<CurvePoint> points;
    std::vector<double> weights, knots;
    Place where;
  };
  /// G68.2 or G68; the frame that the others are put on.
  struct Turned {
    Pose frame = Pose::Identity();
    bool on = false, in_work = false;
  };

  /// Words of a canned cycle that stay until G80 or another motion, mm and s.
  struct CycleWords {
    double z = 0.0, r = 0.0, q = 0.0, p = 0.0, i = 0.0, j = 0.0;
    bool has_z = false, has_r = false, has_q = false, has_i = false, has_j = false;
  };

  // fanuc.cpp
  bool execute();
  bool statement();
  void assignment();
  void assign(long number, double value, size_t place);
  size_t locals() const;
  double system_variable(long number, size_t place);
  // fanuc_flow.cpp
  bool macro_word();
  double condition();
  void go_to(long label, int column);
  void skip_to_end(int loop);
  int loop_number();
  bool labelled(std::string_view line, long label);
  const Known* find_program(int number);
  const Known* scan(LineSource& in, int number);
  void call(int number, long times, int column, const Call* macro);
  void call_macro();
  void leave(int column);
  bool apply_calls();
  // fanuc_block.cpp
  void check_words();
  void apply();
  void apply_machine();
  void apply_modes();
  void apply_radius();
  void apply_length();
  void update_space();
  double tool_value(char letter, bool length);
  // fanuc_cycles.cpp
  void cycle(int tenths);
  void keep_cycle_words(char depth_letter);
  void check_cycle_words(int tenths, char depth_letter);
  Vec3 bore_shift();
  DrillCycle drill_cycle(int tenths);
  // fanuc_motion.cpp
  void one_shot();
  void reference();
  void shift_to_words(bool position);
  void set_data();
  void motion();
  void turn(int tenths);
  void tilt_rotaries();
  void nurbs();
  bool add_to_nurbs();
  Target words();
  int g(int group) const { return block_.has_g(group) ? block_.g[static_cast<size_t>(group)] : -1; }
  LineSource& source() { return *calls_.back().source; }

  static constexpr uint32_t kAxisBits = 7u | 7u << ('X' - 'A');

  std::vector<Call> calls_;
  std::vector<Known> programs_;
  std::vector<double> commons_;  ///< #100 to #999
  std::vector<bool> common_set_;

  int motion_ = 0, cycle_ = 800;  ///< tenths
  bool incremental_ = false, retract_to_r_ = false;
  CycleWords sticky_;
  double cycle_start_ = 0.0;  ///< initial level: the height before the first cycle of a series
  Tcp tcp_ = Tcp::kOff;
  Turned turned_;
  kinematics::AxisValues shift_ = kinematics::AxisValues::Zero();  ///< G92
  kinematics::AxisValues local_ = kinematics::AxisValues::Zero();  ///< G52
  std::optional<Nurbs> nurbs_;
};

}  // namespace swarf::program::nc
