// What the blocks of Heidenhain programs do: calls of the control.
//
// The frame is  T(shift) Rz(turn) R_tilt T(shift') Rz(turn'),  the first pair as cycles 7 and 10 say before a
// plane is tilted, the second as they say within it. R_tilt by spatial angles: Rz(SPC) Ry(SPB) Rx(SPA), that
// is SPA about the fixed X, then SPB about the fixed Y, then SPC about the fixed Z. Mirror images and
// scalings are applied to the words (frame.h).
//
// Settings of the control that a program cannot show are those of delivery: M127 (rotary axes as written),
// M129, R0, preset 1; F in inch programs counts tenths of an inch per minute; a circle's ends may differ by
// 0.016 mm from its radius.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "program/control/control.h"
#include "program/control/cycles.h"
#include "program/control/offsets.h"
#include "program/control/path.h"
#include "program/control/tilt.h"
#include "program/control/tools.h"
#include "program/heidenhain/corner.h"
#include "program/heidenhain/flow.h"
#include "program/heidenhain/frame.h"
#include "program/heidenhain/words.h"

namespace swarf::program::nc::heidenhain {

/// FMAX as a cycle's feed: what the control keeps of it in the Q parameter.
inline constexpr double kRapidFeed = 99999.999;
/// The number of a cycle and of its part, as in "7.1".
struct CycleNumber {
  int number = 0, part = -1;
};

/// Directions of X Y Z of the machine, and of the tool's own frame, in W.
Mat3 linear_columns_W(const kinematics::MachineModel& machine, const kinematics::AxisValues& q);
Mat3 tool_frame_W(const kinematics::MachineModel& machine, const kinematics::AxisValues& q);

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
  /// APPR, which waits for the first piece of contour behind it.
  struct Approach {
    std::string kind;                   ///< LT, LN, CT or LCT
    Vec3 contour = Vec3::Zero();        ///< its first point
    double length = 0.0, radius = 0.0;  ///< LEN and R, mm
    double angle = 0.0;                 ///< CCA, rad
    nc::Compensation side = nc::Compensation::kOff;
    double cutter = 0.0;                   ///< radius that RL or RR compensate, mm
    nc::Motion entry = nc::Motion::kFeed;  ///< of the way to the auxiliary point
    double entry_feed = 0.0;
    nc::Motion motion = nc::Motion::kFeed;  ///< from there
    double feed = 0.0;
    nc::Place place;
  };
  /// A cycle that CYCL CALL executes.
  struct Cycle {
    int number = 0;
    std::map<int, double> q;  ///< by number of the Q parameter
    size_t offset = 0;
  };

  /// How PLANE goes to its position.
  struct Positioning {
    std::string kind;  ///< MOVE, TURN or STAY
    nc::TiltPreference preference;
    nc::Motion motion = nc::Motion::kFeed;
    double feed = 0.0;
    double distance = 0.0;  ///< DIST, mm: from the tip to the point about which MOVE turns
    size_t distance_offset = 0;
    bool turns_table = false;          ///< TABLE ROT
    bool retracts = false;             ///< MB
    std::optional<double> retraction;  ///< mm; none: MB MAX
  };
  /// A place for a cycle, as programmed, mm.
  struct PatternPoint {
    Vec2 at = Vec2::Zero();
    double height = 0.0;  ///< added to the cycle's surface
  };
  struct Rows {
    Vec2 first, column_step, line_step;
    int columns, lines;
    double height;
    bool frame;  ///< its outline alone
  };

  // executor.cpp
  void block(BlockReader& reader);
  bool statement(BlockReader& reader, std::string_view word, size_t start);
  void begin_program(BlockReader& reader, size_t start);
  void function_number(BlockReader& reader, size_t start);
  void assignment(BlockReader& reader);

  // tools.cpp
  void tool_call(BlockReader& reader);
  void tool_ready(BlockReader& reader);
  void blank_form(BlockReader& reader);

  // functions.cpp
  void functions_before(BlockReader& reader, const MotionWords& words);
  void functions_after(BlockReader& reader, const std::vector<MWord>& words);
  void reduce_display(const MWord& word);
  void retract(BlockReader& reader, const MWord& word, const MotionWords& words);
  void retract_by(std::optional<double> way, nc::Motion motion);

  // arcs.cpp
  void polar_line(BlockReader& reader, size_t start);
  void pole(BlockReader& reader);
  void circle(BlockReader& reader, size_t start);
  void circle_by_radius(BlockReader& reader, size_t start);
  void circle_tangential(BlockReader& reader, size_t start);
  void polar_circle(BlockReader& reader, size_t start);
  /// +1 counter-clockwise, -1 clockwise in the control's frame.
  int sense(BlockReader& reader, const MotionWords& words, size_t start);
  Vec3 from_pole(double radius_mm, double angle_deg) const;
  Vec3 polar_end(BlockReader& reader, const MotionWords& words, size_t start);
  void only_plane(BlockReader& reader, const MotionWords& words);
  const Vec3& centre(BlockReader& reader, size_t offset);

  // curves.cpp
  void surface_line(BlockReader& reader, size_t start);
  Vec3 surface_offset(BlockReader& reader, const MotionWords& words, const Vec3& axis, size_t start);
  void spline(BlockReader& reader, size_t start);

  // motion.cpp
  void line(BlockReader& reader, size_t start);
  void move_without_axes(BlockReader& reader, const MotionWords& words, Element& element, size_t start);
  void machine_line(BlockReader& reader, const MotionWords& words, size_t start);
  /// `words_taken`: so many of X Y Z A B C.
  nc::Target target_of(BlockReader& reader, const MotionWords& words, int words_taken = nc::kAxisWords);
  double feed_of(BlockReader& reader, const MotionWords& words, nc::Motion& motion);
  void set_feed(double feed, bool degrees);
  void rotary_move(nc::Motion motion, const nc::Target& target);
  /// Moves now, or waits when a corner follows.
  void move(BlockReader& reader, const MotionWords& words, Element& element);
  void emit(const Element& element);
  Vec3 present();
  Vec3 end_of(const nc::Target& target);
  void finish_motion(BlockReader& reader, const MotionWords& words);
  double cutter_radius(BlockReader& reader);
  nc::Compensation side_of(nc::Compensation written) const;

  // path.cpp
  void corner(BlockReader& reader, bool round, size_t start);
  void close_corner(Element& next);
  void no_open_corner(BlockReader& reader, size_t offset);

  // cycles.cpp
  void cycle_definition(BlockReader& reader);
  void old_cycle(BlockReader& reader, CycleNumber number, size_t offset);
  void old_drilling(BlockReader& reader, CycleNumber number);
  void builders_cycle(BlockReader& reader);
  void parameter_cycle(BlockReader& reader, int number, size_t offset);
  void tilt_cycle(BlockReader& reader);
  void tolerance(BlockReader& reader, int part);
  void preset(BlockReader& reader, const Cycle& cycle);
  void cycle_call(BlockReader& reader, size_t start);

  // frame.cpp
  void datum_shift(BlockReader& reader);
  void transform(BlockReader& reader, size_t start);
  void mirror_image(BlockReader& reader);
  void rotation(BlockReader& reader);
  void scaling(BlockReader& reader);
  void axis_scaling(BlockReader& reader);
  double scale_factor(BlockReader& reader);
  void need_order(BlockReader& reader, size_t start, bool later_active, const char* what);
  double plane_scale(BlockReader& reader, size_t offset);
  void need_true_size(BlockReader& reader, size_t offset, const char* what);
  void update_frame();
  Level& level() { return tilted_ ? inner_ : outer_; }
  const Level& level() const { return tilted_ ? inner_ : outer_; }

  // approach.cpp
  void approach(BlockReader& reader, size_t start);
  void depart(BlockReader& reader, size_t start);
  void close_approach(const Element& first);
  void check_approach(BlockReader& reader, const std::string& kind, const MotionWords& words, size_t start);
  void straight(nc::Motion motion, double feed, const Vec3& to);
  void circle_move(double feed, const Vec3& to, const Vec3& centre, bool counter_clockwise,
                   int further_turns);
  void round(nc::Motion motion, double feed, const Vec3& to, const Vec3& centre, bool counter_clockwise);

  // drilling.cpp
  void run_cycle(BlockReader& reader, size_t offset);
  void execute_cycle();
  void check_values() const;
  void check_cycle() const;
  void drill_pecking();
  void drill_once();
  void drill_deep();
  double feed_out() const;
  void go(nc::Motion motion, double height, double feed);
  double q(int number) const;
  double length(int number) const;
  double surface() const;

  // boring.cpp
  void bore();
  void back_bore();
  void mill_bore();
  void free_edge(int direction, double way, double feed);
  int disengaging_direction(int least) const;

  // pattern.cpp
  void pattern_definition(BlockReader& reader, size_t start);
  void call_pattern(BlockReader& reader, nc::Motion motion, double feed, size_t offset);
  void pattern_cycle(BlockReader& reader, const Cycle& pattern);
  static void add_points(std::vector<PatternPoint>& points, const PatternPoint& point, BlockReader& reader,
                         size_t start);
  static void add_rows(std::vector<PatternPoint>& points, const Rows& rows, BlockReader& reader,
                       size_t start);
  void go_to_point(nc::Motion motion, double feed, const Vec2& point);

  // plane.cpp
  void plane(BlockReader& reader, size_t start);
  Mat3 plane_rotation(BlockReader& reader, const std::string& kind, size_t start);
  void axial_plane(BlockReader& reader, size_t start);
  void tilt(BlockReader& reader, const Mat3& rotation, bool on, size_t start);

  // tilt.cpp
  Positioning positioning(BlockReader& reader, size_t start);
  void position_plane(BlockReader& reader, const Positioning& how, const kinematics::AxisValues* goal,
                      size_t start);
  void turn_about(const kinematics::AxisValues& goal, const Positioning& how);
  bool rotary_is_free(const kinematics::AxisValues& q) const;
  void rotary_parameters(const kinematics::AxisValues& values);

  // tcpm.cpp
  void function_word(BlockReader& reader, size_t start);
  void tcpm(BlockReader& reader);
  void set_tcpm(bool on, bool by_vector, bool spatial, bool chosen);
  void compensate_heads(BlockReader& reader, size_t offset, bool on);
  void reference_point(BlockReader& reader, size_t at);
  double rotary_feed(const Element& element) const;
  void turn_by(nc::Tcp law);

  nc::Control& control_;
  Parameters parameters_;
  Flow flow_;
  bool begun_ = false;

  double feed_ = 0.0;                               ///< as written; 0: none
  double tool_feed_ = 0.0;                          ///< F of TOOL CALL, for FAUTO
  double delta_radius_ = 0.0, delta_corner_ = 0.0;  ///< DR, DR2 of TOOL CALL, mm
  std::map<int, double> defined_radius_;            ///< by TOOL DEF where there is no tool table, mm
  bool shortest_ = false;                           ///< M126
  bool per_revolution_ = false;                     ///< M136
  bool tcpm_ = false, path_chosen_ = false, spatial_ = false;
  bool path_is_contour_ = false;
  std::optional<Vec3> centre_;
  Amount polar_radius_, polar_angle_;  ///< modal, mm and degrees
  std::optional<Vec3> tangent_;        ///< at the end of the last element
  std::optional<Element> held_;
  std::optional<Corner> corner_;
  std::optional<Approach> approach_;
  std::optional<Cycle> cycle_;
  int open_cycle_ = 0;       ///< the old cycle whose parts are being read
  bool modal_call_ = false;  ///< M89
  std::vector<PatternPoint> pattern_;
  double raised_ = 0.0;  ///< of the point whose cycle runs, mm
  Level outer_, inner_;
  Mat3 tilt_ = Mat3::Identity();
  bool tilted_ = false;
  std::array<double, 3> axial_deg_{};  ///< A B C of PLANE AXIAL, which are modal
  bool compensates_heads_ = false;     ///< M114, M144
  bool rotary_feed_mm_ = false;        ///< M116
  Stretch stretch_;                    ///< of level()
  bool last_rapid_ = false;            ///< the last motion block went at FMAX
};

}  // namespace swarf::program::nc::heidenhain
