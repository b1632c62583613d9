// The reader of the Fanuc dialect (series 30i words): ISO words, custom macro B, five-axis words.
#pragma once

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "program/letters/letter_dialect.h"

namespace swarf::program::nc::fanuc {

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
  kFanucScale = 11,
  kFanucMacro = 12,
  kFanucOffset = 14,
  kFanucPath = 15,
  kFanucTurn = 16,
  kFanucPolar = 17,
  kFanucMirror = 18,
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
  using Locals = std::array<double, 34>;
  struct Call {
    LineSource* source = nullptr;
    LineSource::Mark back, top;
    long left = 0;
    bool own_locals = false;  ///< G65, G66: #1 to #33 of its own
    int modal = -1;           ///< index into modals_ of the macro that runs here; -1: none of them
    size_t modals = 0;        ///< so many of modals_ hold here: the last of these is called after each move
    Locals locals{};
    uint64_t assigned = 0;
    std::vector<std::pair<int, LineSource::Mark>> loops;  ///< DO number, its WHILE line
  };
  /// G66 until its G67.
  struct Modal {
    int number;
    long times;
    Locals locals;
    uint64_t assigned;
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
  /// Mirror image and scaling of one axis, in this order: p' = factor p + shift.
  struct AxisMap {
    bool mirrored = false;
    double mirror_at = 0.0, scale = 1.0, centre = 0.0;
    double factor() const;
    double shift() const;
    bool mirrors() const { return factor() < 0.0; }
    double at(double value, bool is_incremental) const;
  };
  /// G16; what the words gave last.
  struct Polar {
    bool on = false;
    double radius_mm = std::numeric_limits<double>::quiet_NaN(), angle_deg = radius_mm;
  };
  /// G68.2 P2 and P3 while their blocks come in.
  struct PlaneBlocks {
    int form = 0;
    bool incremental = false;
    Place where;
    std::array<Vec3, 3> vectors{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  ///< P2: points; P3: X, Z, origin
    unsigned given = 0;                                                     ///< bit per Q
    double turn_deg = 0.0;
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
    bool z_incremental = false, r_incremental = false;  ///< as they were written: G90 and G91 come later
  };

  // dialect.cpp
  bool execute();
  bool program_head();
  void state_number_rule();
  bool without_point(char letter) const;
  bool statement();
  void skip_block_number();
  // variables.cpp
  void assignment();
  void assign(long number, double value, size_t place);
  std::string comment_behind() const;
  size_t locals() const;
  double system_variable(long number, size_t place);
  std::optional<double> modal_code(long group) const;
  // flow.cpp
  bool macro_word();
  double condition();
  long label_value();
  void go_to(long label, int column);
  void skip_to_end(int loop);
  bool ends_loop(std::string_view line, int loop);
  void leave_loops(const LineSource::Mark& target);
  int loop_number();
  bool labelled(std::string_view line, long label);
  // calls.cpp
  const Known* find_program(int number, bool external);
  const Known* scan(LineSource& in, int number);
  void call(int number, long times, int column, const Call* macro, bool external);
  void read_arguments(int g_group, Call& macro);
  Call macro_call(int g_group, const char* word);
  void call_macro();
  void set_modal_macro();
  void call_modal_macro();
  void call_subprogram(int column, bool external);
  void leave(int column);
  bool apply_calls();
  // block.cpp
  void check_words();
  void apply();
  void apply_machine();
  void set_units(bool inches);
  void apply_modes();
  void apply_radius();
  void apply_length();
  void update_space();
  // data.cpp
  void set_data();
  void set_tool_offset(int kind);
  double tool_offset(int number, size_t slot, int column);
  double tool_value(char letter, bool length);
  void shift_to_words(bool position);
  // transform.cpp
  Target words();
  void polar_words(Target& target);
  void map_arc(ArcWords& arc);
  bool mapped() const;
  bool reversed() const;
  void refuse_mapped(int column, const char* what, bool polar_too);
  void check_transform(int column);
  void mirror(int tenths);
  void scale(int tenths);
  double magnification(char letter);
  void polar(int tenths);
  // cycles.cpp
  void cycle(int tenths);
  void keep_cycle_words(char depth_letter);
  void check_cycle_words(int tenths, char depth_letter);
  Vec3 bore_shift();
  DrillCycle drill_cycle(int tenths);
  // planes.cpp
  void turn(int tenths);
  void turn_in_plane();
  void tilt(bool incremental);
  Mat3 roll_pitch_yaw();
  void collect_plane();
  void plane_by_points(const PlaneBlocks& plane);
  void plane_by_vectors(const PlaneBlocks& plane);
  void tilt_by_tool_axis();
  void set_plane(const Vec3& origin, const Mat3& rotation, bool incremental);
  void expect_plane_block();
  void tilt_rotaries(bool tip_stands);
  Vec3 plane_words(const char letters[4]) const;
  void only_words(std::string_view letters, const char* form);
  // motion.cpp
  void one_shot();
  void references();
  void reference();
  void check_reference();
  void return_from_reference();
  void keep_motion_codes();
  void motion();
  void nurbs();
  bool add_to_nurbs();
  int g(int group) const { return block_.has_g(group) ? block_.g[static_cast<size_t>(group)] : -1; }
  LineSource& source() { return *calls_.back().source; }

  static constexpr long kLastCommon = 999;
  static constexpr uint32_t kAxisBits = 7u | 7u << ('X' - 'A');

  std::vector<Call> calls_;
  std::vector<Modal> modals_;
  std::vector<Known> programs_;
  std::vector<double> commons_;  ///< #100 to #999
  std::vector<bool> common_set_;

  int motion_ = 0, cycle_ = 800, length_code_ = 490, turn_code_ = 690;  ///< tenths
  int d_number_ = 0, h_number_ = 0;                                     ///< D and H as written last
  bool number_rule_stated_ = false;
  bool moved_ = false;  ///< the block has a move
  bool incremental_ = false, retract_to_r_ = false;
  CycleWords sticky_;
  double cycle_start_ = 0.0;  ///< initial level: the height before the first cycle of a series
  Tcp tcp_ = Tcp::kOff;
  Turned turned_;
  std::optional<PlaneBlocks> plane_blocks_;
  kinematics::AxisValues shift_ = kinematics::AxisValues::Zero();  ///< G92
  kinematics::AxisValues local_ = kinematics::AxisValues::Zero();  ///< G52
  std::optional<Nurbs> nurbs_;
  std::array<AxisMap, 3> map_;
  bool mirrored_ = false, scaled_ = false;
  Polar polar_;
  std::map<int, std::array<std::optional<double>, 4>> offsets_;  ///< G10 L10 to L13, mm, by number
  std::array<std::optional<double>, kAxisWords> through_;        ///< the point that G28 passed, for G29
};

}  // namespace swarf::program::nc::fanuc
