// What a Siemens 840D keeps from block to block, as plain data; steps.h has what is done with it.
//
// Settings of the control that a program cannot show are those of delivery: G1, G17, G710, G90, G94, G60 at
// the start, D1 after a tool change (MD20270), RPY order of ROT (MD10600), circle tolerance 0.01 mm or one
// thousandth of the radius (MD21000, MD21010), ORIWKS (great circle) for orientations.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "program/control/control.h"
#include "program/control/cycles.h"
#include "program/control/offsets.h"
#include "program/control/path.h"
#include "program/control/stretch.h"
#include "program/control/tilt.h"
#include "program/control/tools.h"
#include "program/siemens/block.h"
#include "program/siemens/flow.h"

namespace swarf::program::nc::siemens {

/// The last piece of contour, for CT.
struct Piece {
  Vec3 direction = Vec3::Zero();  ///< tangent at its end, program coordinates
  bool valid = false;
};
/// A line given by its angle alone (ANG=): it ends where the line of the next block crosses it.
struct OpenLine {
  double angle_deg = 0.0;
  nc::Place place;
};
/// What CYCLE832() goes back to.
struct Corner {
  int code = kG60;
  double tolerance_mm = 0.0;
};

/// The block that is being executed.
struct BlockPlace {
  const LineRef* line = nullptr;
  const std::string* file_name = nullptr;
  int file = 0;
};

/// Modal words.
struct Modes {
  int motion = kG1;
  bool incremental = false;
  int units = kG710;
  int corner = kG60;
  double tolerance_mm = 0.0;     ///< of CYCLE832 or CTOL, for G642
  double rounding_mm = 0.0;      ///< ADIS, for G641
  double round_all_mm = 0.0;     ///< RNDM; 0: off
  double corner_feed = 0.0;      ///< FRCM, as written; 0: off
  std::optional<Corner> before;  ///< while CYCLE832 is on
  double allowance_mm = 0.0;     ///< OFFN
  std::string corner_rule = "G450", entry_rule = "NORM";
  bool feed_of_rotaries = false;  ///< FGROUP has them
  std::array<double, 3> feed_radii_mm{nc::kDegreePerMm, nc::kDegreePerMm, nc::kDegreePerMm};
};

/// What moves the program's zero, and what orientations are counted in.
struct Frames {
  Pose programmed = Pose::Identity();  ///< TRANS, ROT ...
  nc::Stretch stretch;                 ///< SCALE, MIRROR: of the words; no offsets
  Pose swivelled = Pose::Identity();   ///< CYCLE800
  bool traori = false, swivel_on = false;
  std::optional<int> reference;                           ///< ORIWKS, ORIMKS
  std::optional<int> interpolation;                       ///< ORIVECT, ORIAXES: goes before ORIWKS and ORIMKS
  std::optional<int> angles;                              ///< ORIEULER, ORIRPY
  std::map<int, kinematics::AxisValues> pending_offsets;  ///< written, and not called yet
};

/// What the next piece of contour counts from.
struct PathWords {
  bool by_way = true;                  ///< SPATH; false: UPATH
  Vec3 pole = Vec3::Zero();            ///< program coordinates, mm
  std::optional<double> polar_angle;   ///< AP, degrees
  std::optional<double> polar_radius;  ///< RP, mm
  Piece last;
  std::optional<OpenLine> open;
};

struct CallState {
  bool pattern_done = false;  ///< the block was a pattern
  std::optional<CycleCall> modal_cycle;
};

/// A cycle whose contour is being read, and what holds again when that is done.
struct ContourReading {
  CycleCall call;
  std::string text;  ///< of the cycle's block
  LineRef line;
  BlockPlace place;
  int column = 0;
  bool started = false;             ///< its first point has come
  double round_all_mm = 0.0;        ///< RNDM, while the tool goes to that point
  std::vector<nc::Segment> pieces;  ///< the first one leads to the contour
  nc::PathState path;
  nc::ModalState modal;
  Modes modes;
  PathWords words;
  std::optional<CycleCall> modal_cycle;
};

/// The blocks of words: what Flow hands on.
struct Executor final : BlockTarget {
  explicit Executor(nc::Control& machine);

  Outcome block(TokenReader& reader, Variables& variables) override;
  Value read_system(const SystemName& asked) override;
  void write_system(const SystemName& asked, const Value& value) override;
  bool knows(const std::string& name) const override { return find_word(name) != nullptr; }
  const std::vector<std::string>& names() const override { return word_names(); }
  void note(const std::string& word, const std::string& text, const std::string& file, int line) override;
  bool takes_builders(const std::string& name, const LineRef& line) override;
  long moves() const override;
  ContourName contour_asked() const override;
  void contour_read() override;

  nc::Control& control;
  BlockPlace place;
  BlockWords words;
  Modes modes;
  Frames frames;
  PathWords path;
  CallState calls;
  std::unique_ptr<ContourReading> contour;  ///< CYCLE72 reads its contour
};

inline int column(const BlockPlace& place, size_t offset) {
  return column_of(*place.line, offset);
}

/// An argument of a cycle as a number; `fallback` where it is left out. Throws InputError "wrong-type", and
/// "missing-argument" when there is no fallback.
double argument(const CycleCall& call, size_t index, const LineRef& line, std::optional<double> fallback);
/// The same, a whole number.
int whole_argument(const CycleCall& call, size_t index, const LineRef& line, std::optional<double> fallback);
bool has_argument(const CycleCall& call, size_t index);

}  // namespace swarf::program::nc::siemens
