// What the words of Siemens 840D blocks do: calls of the control.
//
// Settings of the control that a program cannot show are those of delivery: G1, G17, G710, G90, G94, G60 at
// the start, D1 after a tool change (MD20270), RPY order of ROT (MD10600), circle tolerance 0.01 mm or one
// thousandth of the radius (MD21000, MD21010), ORIWKS (great circle) for orientations.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "program/control/control.h"
#include "program/control/cycles.h"
#include "program/control/offsets.h"
#include "program/control/path.h"
#include "program/control/tilt.h"
#include "program/control/tools.h"
#include "program/siemens/block.h"
#include "program/siemens/flow.h"

namespace swarf::program::nc::siemens {

class Executor final : public BlockTarget {
 public:
  explicit Executor(nc::Control& control);

  Outcome block(TokenReader& reader, Variables& variables) override;
  Value read_system(const SystemName& asked) override;
  void write_system(const SystemName& asked, const Value& value) override;
  bool knows(const std::string& name) const override { return find_word(name) != nullptr; }
  const std::vector<std::string>& names() const override { return word_names(); }
  void note(const std::string& word, const std::string& text, const std::string& file, int line) override;
  bool takes_builders(const std::string& name, const LineRef& line) override;
  long moves() const override;

 private:
  /// The last piece of contour, for CT.
  struct Piece {
    Vec3 direction = Vec3::Zero();  ///< tangent at its end, program coordinates
    bool valid = false;
  };
  /// What CYCLE832() goes back to.
  struct Corner {
    int code = kG60;
    double tolerance_mm = 0.0;
  };

  int column(size_t offset) const { return column_of(*line_, offset); }
  [[noreturn]] void fail(const char* code, size_t offset, std::string text, std::string fix) const;

  // executor.cpp
  void modal_words(const BlockWords& words);
  void corner_words(const BlockWords& words);
  void apply_corner();
  void feed_words(const BlockWords& words);
  void tool_words(const BlockWords& words);
  void set_cutting_edge(double edge, size_t offset);
  void spindle_words(const BlockWords& words);
  void noted_words(const BlockWords& words);
  void keep_contour_rule(const NamedPlace& word);
  void check_contour_rules(size_t offset) const;
  void cutter_words(const BlockWords& words);
  void feed_group(const CycleCall& call);
  Outcome end_words(const BlockWords& words);

  // motion.cpp
  void motion_words(const BlockWords& words);
  nc::Target target_of(const BlockWords& words, bool machine) const;
  void orientation(const BlockWords& words, nc::Target& target);
  void straight(nc::Motion motion, const nc::Target& target);
  void circle(const BlockWords& words, const nc::Target& target);
  void opened(const BlockWords& words, nc::ArcWords& arc, nc::Target& target, const Vec3& from,
              nc::Motion motion);
  void circle_through(const BlockWords& words, const nc::Target& target);
  void circle_tangential(const nc::Target& target);
  void send_arc(nc::Motion motion, const nc::Target& target, nc::ArcWords& arc, size_t offset);
  Vec3 end_of(const nc::Target& target, const Vec3& from) const;
  void machine_move(const BlockWords& words);
  void dwell(const BlockWords& words);
  void approach_point(const BlockWords& words, int code);
  double arc_scale(size_t offset) const;
  bool mirrored() const;
  nc::Motion turned(nc::Motion motion) const;

  // polar.cpp
  Vec3 polar_way(double angle_deg, double radius_mm) const;
  double polar_radius(const Coordinate& word) const;
  void set_pole(const BlockWords& words, int code);
  void polar_end(const BlockWords& words, nc::Target& target);

  // patterns.cpp
  std::vector<Vec2> places(const CycleCall& call);
  void pattern(const CycleCall& call);

  // system.cpp
  int system_axis(const SystemName& asked, size_t n) const;
  void check_metric(const SystemName& asked) const;
  int offset_index(const SystemName& asked, bool& shifts) const;
  kinematics::AxisValues offset_of(int number) const;
  Value position_of(const SystemName& asked);
  Value tool_data(const SystemName& asked);
  void use_offset(int number);

  // curves.cpp
  static const Coefficients* first_polynomial(const BlockWords& words);
  void check_polynomial(const BlockWords& words) const;
  PolynomialBlock polynomial_block(const BlockWords& words, const nc::Target& target);
  void polynomial_orientation(const BlockWords& words, const nc::Target& target, PolynomialBlock& block);
  void polynomial(const BlockWords& words, const nc::Target& target);
  void polynomial_path(const CycleCall& call);

  // frames.cpp
  void frame_words(const BlockWords& words);
  void transform_words(const BlockWords& words);
  void set_frame();
  void choose_interpolation();
  Mat3 rotation_of(const BlockWords& words) const;
  void scale_words(const BlockWords& words, bool mirrors);
  void swivel(const CycleCall& call);
  void swivel_off();
  Pose swivel_plane(const CycleCall& call);
  double travel_along_tool(const CycleCall& call) const;
  void retract(const CycleCall& call, int how);

  // cycles.cpp
  void run_call(const CycleCall& call);
  void high_speed(const CycleCall& call);
  nc::DrillCycle drilling(const CycleCall& call) const;
  double depth_of(const CycleCall& call, double reference) const;
  void boring(const CycleCall& call, nc::DrillCycle& cycle) const;
  void only_zero(const CycleCall& call, size_t first, size_t last) const;
  void modes(const CycleCall& call, size_t first) const;
  void pecking(const CycleCall& call, double reference, nc::DrillCycle& cycle) const;
  void tapping(const CycleCall& call, nc::DrillCycle& cycle) const;
  void drill(const nc::DrillCycle& cycle, const CycleCall& call);

  nc::Control& control_;
  const LineRef* line_ = nullptr;
  const std::string* file_name_ = nullptr;
  int file_ = 0;
  BlockWords words_;

  int motion_ = kG1;
  bool incremental_ = false;
  int units_ = kG710;
  int corner_ = kG60;
  double tolerance_mm_ = 0.0;           ///< of CYCLE832 or CTOL, for G642
  double rounding_mm_ = 0.0;            ///< ADIS, for G641
  std::optional<Corner> before_;        ///< while CYCLE832 is on
  Pose programmed_ = Pose::Identity();  ///< TRANS, ROT ...
  Vec3 shape_ = Vec3::Ones();  ///< SCALE, MIRROR: the control's coordinates are these times the program's
  Pose swivelled_ = Pose::Identity();  ///< CYCLE800
  bool traori_ = false, swivel_on_ = false;
  std::optional<int> reference_;      ///< ORIWKS, ORIMKS
  std::optional<int> interpolation_;  ///< ORIVECT, ORIAXES: goes before ORIWKS and ORIMKS
  std::optional<int> angles_;         ///< ORIEULER, ORIRPY
  bool by_way_ = true;                ///< SPATH; false: UPATH
  double allowance_mm_ = 0.0;         ///< OFFN
  std::string corner_rule_ = "G450", entry_rule_ = "NORM";
  bool feed_of_rotaries_ = false;  ///< FGROUP has them
  std::array<double, 3> feed_radii_mm_{nc::kDegreePerMm, nc::kDegreePerMm, nc::kDegreePerMm};
  Vec3 pole_ = Vec3::Zero();                               ///< program coordinates, mm
  std::optional<double> polar_angle_;                      ///< AP, degrees
  std::optional<double> polar_radius_;                     ///< RP, mm
  std::map<int, kinematics::AxisValues> pending_offsets_;  ///< written, and not called yet
  bool pattern_done_ = false;                              ///< the block was a pattern
  Piece last_;
  std::optional<CycleCall> modal_cycle_;
};

/// An argument of a cycle as a number; `fallback` where it is left out. Throws InputError "wrong-type", and
/// "missing-argument" when there is no fallback.
double argument(const CycleCall& call, size_t index, const LineRef& line, std::optional<double> fallback);
/// The same, a whole number.
int whole_argument(const CycleCall& call, size_t index, const LineRef& line, std::optional<double> fallback);
bool has_argument(const CycleCall& call, size_t index);

}  // namespace swarf::program::nc::siemens
