// What the blocks of Heidenhain programs do: calls of the control.
//
// The frame is  T(shift) Rz(turn) R_tilt T(shift') Rz(turn'),  the first pair as cycles 7 and 10 say before a
// plane is tilted, the second as they say within it. R_tilt by spatial angles: Rz(SPC) Ry(SPB) Rx(SPA), that
// is SPA about the fixed X, then SPB about the fixed Y, then SPC about the fixed Z.
//
// Settings of the control that a program cannot show are those of delivery: M127 (rotary axes as written),
// M129, R0, preset 1; F in inch programs counts tenths of an inch per minute; a circle's ends may differ by
// 0.016 mm from its radius.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "program/nc/control.h"
#include "program/nc/heidenhain_corner.h"
#include "program/nc/heidenhain_flow.h"

namespace swarf::program::heidenhain {

/// A word with a value; `offset` of its letters in the block.
struct Amount {
  double value = 0.0;
  size_t offset = 0;
  bool given = false, incremental = false;
  explicit operator bool() const { return given; }
};

struct MWord {
  int number = 0;
  size_t offset = 0;
  Amount amount;     ///< M140 MB, M128 F
  bool max = false;  ///< M140 MB MAX
  uint8_t axes = 0;  ///< M94 A B C, bit per nc::AxisWord
};

enum class FeedWord { kNone, kValue, kMax, kAuto, kPerRevolution };

/// The words of a motion block.
struct MotionWords {
  std::array<Amount, nc::kAxisWords> axes;
  Amount polar_radius, polar_angle, radius;
  std::array<Amount, 3> normal, tool;
  std::array<std::array<Amount, 3>, nc::kAxisWords> coefficients;  ///< K1, K2, K3 of each axis (SPL)
  std::optional<nc::Compensation> compensation;
  int sense = 0;  ///< DR+ 1, DR- -1
  FeedWord feed = FeedWord::kNone;
  Amount feed_value;
  std::vector<MWord> functions;
  bool any_linear() const { return axes[0] || axes[1] || axes[2]; }
  bool any_rotary() const { return axes[3] || axes[4] || axes[5]; }
  /// A block after which a modal cycle (M89) drills.
  bool positions() const { return any_linear() || polar_radius || polar_angle; }
  bool has_function(int number) const;
};

/// Which words a block may have besides M and F.
enum WordSet : unsigned {
  kAxesAllowed = 1,
  kPolarAllowed = 2,
  kRadiusAllowed = 4,
  kSenseAllowed = 8,
  kCompensationAllowed = 16,
  kVectorsAllowed = 32,
  kFeedAllowed = 64,
  kFunctionsAllowed = 128,
  kMachineAllowed = 256,  ///< M91
  kTcpAllowed = 512,      ///< M128
  kCoefficientsAllowed = 1024,
};
/// Reads to the end of the block. "unknown-word", "unexpected-word", "word-twice", "unsupported-word".
MotionWords read_motion_words(BlockReader& reader, unsigned allowed);
/// "unknown-word" with the nearest known one, "unsupported-word" for one that the control knows.
[[noreturn]] void refuse_word(BlockReader& reader, size_t offset, std::string_view word);
/// FMAX as a cycle's feed: what the control keeps of it in the Q parameter.
inline constexpr double kRapidFeed = 99999.999;
/// Spatial angles SPA SPB SPC in degrees: about the fixed X, then the fixed Y, then the fixed Z.
Mat3 spatial_rotation(double a_deg, double b_deg, double c_deg);
/// The number of a cycle and of its part, as in "7.1".
struct CycleNumber {
  int number = 0, part = -1;
};

class Executor {
 public:
  Executor(nc::Control& control);
  /// Runs the program to its end.
  void run(const std::string& path);

 private:
  /// A motion that waits for the corner behind it.
  struct Element {
    nc::Motion motion = nc::Motion::kFeed;
    nc::Target target;
    nc::ArcWords arc;
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< program coordinates
    double feed = 0.0;
    nc::Place place;
    size_t offset = 0;
  };
  struct Corner {
    bool round = false;
    double size_mm = 0.0, feed = 0.0;
    nc::Place place;
  };
  struct Level {
    Vec3 shift = Vec3::Zero();
    double turn_deg = 0.0;
    bool none() const { return shift.isZero(0.0) && turn_deg == 0.0; }
  };
  /// A cycle that CYCL CALL executes.
  struct Cycle {
    int number = 0;
    std::map<int, double> q;  ///< by number of the Q parameter
    size_t offset = 0;
  };

  // heidenhain_executor.cpp
  void block(BlockReader& reader);
  bool statement(BlockReader& reader, std::string_view word, size_t start);
  void begin_program(BlockReader& reader, size_t start);
  void function_number(BlockReader& reader, size_t start);
  void assignment(BlockReader& reader);

  // heidenhain_tools.cpp
  void tool_call(BlockReader& reader);
  void tool_ready(BlockReader& reader);
  void blank_form(BlockReader& reader);
  void functions_before(BlockReader& reader, const MotionWords& words);
  void functions_after(BlockReader& reader, const std::vector<MWord>& words);
  void reduce_display(const MWord& word);
  void retract(BlockReader& reader, const MWord& word, const MotionWords& words);
  void retract_by(std::optional<double> way, nc::Motion motion);

  // heidenhain_arcs.cpp
  void polar_line(BlockReader& reader, size_t start);
  void pole(BlockReader& reader);
  void circle(BlockReader& reader, size_t start);
  void circle_by_radius(BlockReader& reader, size_t start);
  void circle_tangential(BlockReader& reader, size_t start);
  void polar_circle(BlockReader& reader, size_t start);
  int sense(BlockReader& reader, const MotionWords& words, size_t start);
  void only_plane(BlockReader& reader, const MotionWords& words);
  const Vec3& centre(BlockReader& reader, size_t offset);

  // heidenhain_curves.cpp
  void surface_line(BlockReader& reader, size_t start);
  Vec3 surface_offset(BlockReader& reader, const MotionWords& words, const Vec3& axis, size_t start);
  void spline(BlockReader& reader, size_t start);

  // heidenhain_motion.cpp
  void line(BlockReader& reader, size_t start);
  void move_without_axes(BlockReader& reader, const MotionWords& words, Element& element, size_t start);
  void machine_line(BlockReader& reader, const MotionWords& words, size_t start);
  nc::Target target_of(BlockReader& reader, const MotionWords& words);
  double feed_of(BlockReader& reader, const MotionWords& words, nc::Motion& motion);
  void set_feed(double feed, bool degrees);
  void rotary_move(nc::Motion motion, const nc::Target& target);
  /// Moves now, or waits when a corner follows.
  void move(BlockReader& reader, const MotionWords& words, Element element);
  void emit(const Element& element);
  Vec3 present();
  Vec3 end_of(const nc::Target& target);
  void finish_motion(BlockReader& reader, const MotionWords& words);

  // heidenhain_path.cpp
  void corner(BlockReader& reader, bool round, size_t start);
  void close_corner(Element& next);
  void no_open_corner(BlockReader& reader, size_t offset);

  // heidenhain_cycles.cpp
  void cycle_definition(BlockReader& reader);
  void old_cycle(BlockReader& reader, CycleNumber number, size_t offset);
  void old_drilling(BlockReader& reader, CycleNumber number);
  void parameter_cycle(BlockReader& reader, int number, size_t offset);
  void datum_shift(BlockReader& reader);
  void datum_transform(BlockReader& reader, size_t start);
  void rotation(BlockReader& reader);
  void tilt_cycle(BlockReader& reader);
  void tolerance(BlockReader& reader, int part);
  void preset(BlockReader& reader, const Cycle& cycle);
  void cycle_call(BlockReader& reader, size_t start);

  // heidenhain_drilling.cpp
  void run_cycle(BlockReader& reader, size_t offset);
  void check_cycle() const;
  void drill_pecking();
  void drill_once();
  double feed_out() const;
  void go(nc::Motion motion, double height, double feed);
  double q(int number) const;

  // heidenhain_plane.cpp
  void plane(BlockReader& reader, size_t start);
  Mat3 plane_rotation(BlockReader& reader, const std::string& kind, size_t start);
  void position_plane(BlockReader& reader, bool reset, size_t start);
  void tilt(BlockReader& reader, const Mat3& rotation, bool on, size_t start);
  void rotary_parameters(const kinematics::AxisValues& values);
  void function_word(BlockReader& reader, size_t start);
  void tcpm(BlockReader& reader);
  void set_tcpm(bool on, bool by_vector, bool spatial, bool chosen);
  void turn_by(nc::Tcp law);
  void update_frame();
  Level& level() { return tilted_ ? inner_ : outer_; }

  nc::Control& control_;
  Parameters parameters_;
  Flow flow_;
  bool begun_ = false;

  double feed_ = 0.0;                               ///< as written; 0: none
  double tool_feed_ = 0.0;                          ///< F of TOOL CALL, for FAUTO
  double delta_radius_ = 0.0, delta_corner_ = 0.0;  ///< DR, DR2 of TOOL CALL, mm
  bool shortest_ = false;                           ///< M126
  bool per_revolution_ = false;                     ///< M136
  bool tcpm_ = false, path_chosen_ = false, spatial_ = false;
  bool path_is_contour_ = false;
  std::optional<Vec3> centre_;
  Amount polar_radius_, polar_angle_;  ///< modal, mm and degrees
  std::optional<Vec3> tangent_;        ///< at the end of the last element
  std::optional<Element> held_;
  std::optional<Corner> corner_;
  std::optional<Cycle> cycle_;
  int open_cycle_ = 0;       ///< the old cycle whose parts are being read
  bool modal_call_ = false;  ///< M89
  Level outer_, inner_;
  Mat3 tilt_ = Mat3::Identity();
  bool tilted_ = false;
};

}  // namespace swarf::program::heidenhain
