// The plain data that dialects hand to the control.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/frames.h"
#include "program/block_law.h"

namespace swarf::program::nc {

/// The axis words, in this order everywhere.
enum AxisWord { kX, kY, kZ, kA, kB, kC };
inline constexpr int kAxisWords = 6;
inline constexpr char kAxisLetters[] = "XYZABC";

struct Place {
  int file = 0, line = 0, column = 0;
};

enum class Motion { kRapid, kFeed, kClockwise, kCounterClockwise };

/// G17, G18, G19 with their first, second and normal axes: XY Z, ZX Y, YZ X.
enum class Plane { kXY, kZX, kYZ };
struct PlaneAxes {
  int first, second, normal;
};
constexpr PlaneAxes axes_of(Plane plane) {
  return plane == Plane::kXY   ? PlaneAxes{0, 1, 2}
         : plane == Plane::kZX ? PlaneAxes{2, 0, 1}
                               : PlaneAxes{1, 2, 0};
}

/// G94, G95, G93.
enum class FeedMode { kPerMinute, kPerRevolution, kInverseTime };

/// What F in units/min counts when XYZ and rotary axes move together without TCP.
enum class FeedRule {
  kLinearFirst,  ///< the way of X Y Z; degrees only when they stand (RS274/NGC; 840D's FGROUP default)
  kAllAxes,      ///< the root of the sum of all squares, a degree counting as a mm (Fanuc, Heidenhain)
};

/// How an absolute rotary word is reached.
enum class RotaryWay {
  kAsWritten,  ///< the value itself: 359 to 1 turns back by 358 degrees
  kShortest,   ///< DC(), shortest-path controls: at most half a turn
  kPositive,   ///< ACP()
  kNegative,   ///< ACN()
};

/// What X Y Z mean: axis values, or the tip in W (see control.h).
enum class Coordinates { kAxes, kWork };

/// Tool centre point control; the law of the moves.
enum class Tcp {
  kOff,
  kAxes,    ///< orientation by rotary words, rotaries linear between them (G43.4, TRAORI + ORIAXES, M128)
  kVector,  ///< orientation by vectors, the axis along the great circle (G43.5, ORIVECT, LN with T vectors)
};

/// The side of the contour, looking along the travel, on which the cutter goes.
enum class Compensation { kOff, kLeft, kRight };

/// Where the first compensated move ends, a cutter radius beside its programmed end.
enum class CompensationEntry {
  kAlongEntry,  ///< across the lead-in itself; the corner to the next move is then an ordinary one (LinuxCNC)
  kAcrossNext,  ///< across the start of the next move (Fanuc type A, 840D NORM, Heidenhain)
};

/// Where a block goes. Unset words stay where they are. mm, rad.
struct Target {
  std::array<double, kAxisWords> value{};
  uint8_t given = 0;        ///< bit per AxisWord
  uint8_t incremental = 0;  ///< bit per AxisWord: added to the present programmed value
  std::array<RotaryWay, 3> way{RotaryWay::kAsWritten, RotaryWay::kAsWritten,
                               RotaryWay::kAsWritten};  ///< A B C
  std::optional<Vec3> axis_P;  ///< tool axis, tip to spindle, program frame; any length above 0; TCP only
  int column = 0;              ///< of the first axis word

  void set(int word, double amount, bool is_incremental) {
    value[static_cast<size_t>(word)] = amount;
    const unsigned bit = 1u << word;
    given = static_cast<uint8_t>(given | bit);
    incremental = static_cast<uint8_t>(is_incremental ? incremental | bit : incremental & ~bit);
  }
  bool has(int word) const { return (given >> word & 1u) != 0; }
  bool is_incremental(int word) const { return (incremental >> word & 1u) != 0; }
  bool any() const { return given != 0 || axis_P.has_value(); }
  bool rotary() const { return (given & 0x38u) != 0 || axis_P.has_value(); }
};

/// How a circle is given: centre or radius.
struct ArcWords {
  std::optional<Vec3> centre;  ///< program coordinates, absolute; its part along the normal does not matter
  double radius = 0.0;         ///< without a centre: mm, below 0: the longer of both arcs
  int further_turns = 0;       ///< whole turns before the one that ends at the target (RS274 P - 1, TURN=)
  std::optional<Vec3> normal;  ///< axis of the circle, program frame, instead of the plane's (CIP): the
                               ///< motion's sense is counted about it
  int column = 0;
  double radius_tolerance_mm = 5e-3;  ///< by how much start and end radius may differ; else "bad-arc"
};

/// Which of two rotary solutions a tilted plane takes.
struct TiltPreference {
  enum class Choice {
    kNearest,   ///< the least rotary travel
    kPositive,  ///< SEQ+, _DIR 1: the tilting axis (the one that `axis` names) positive, or zero
    kNegative,
  };
  Choice choice = Choice::kNearest;
  int axis = -1;  ///< AxisWord; -1: the rotary next to the tool side that tilts (the second of rotary_order)
};

/// What a block asks for at its end, between its piece of contour and the next one.
struct CornerWords {
  enum class Kind {
    kRound,  ///< an arc that touches both pieces; size: its radius
    kLegs,   ///< a straight cut; size: what it takes off each piece
    kChord,  ///< a straight cut; size: its own length
  };
  Kind kind = Kind::kRound;
  double size_mm = 0.0;
  double feed = 0.0;          ///< as F is written; 0: that of a neighbour
  bool feed_of_next = false;  ///< of the piece behind the corner, else of the one before it
  bool modal = false;         ///< at each corner of the contour: elsewhere nothing is wrong
  double smooth_rad = 1e-9;   ///< pieces that turn by no more have no corner
  Place place;
};

/// One piece of programmed contour, before and after cutter compensation. Program coordinates.
struct Segment {
  Motion motion = Motion::kRapid;
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  std::array<double, 3> rotary_from{}, rotary_to{};  ///< machine values of A B C, rad
  bool turns_rotaries = false;
  Vec3 centre = Vec3::Zero(), normal = Vec3::UnitZ();  ///< of arcs; counter-clockwise about the normal
  int further_turns = 0;
  bool machine = false;  ///< from and to are linear axis values, and `law` is theirs
  BlockLaw law = BlockLaw::kJoint;
  // Modal words that held when it was programmed:
  double feed = 0.0;  ///< as written
  double feed_unit_mm = 1.0;
  FeedMode feed_mode = FeedMode::kPerMinute;
  double dwell_s = 0.0, corner_tolerance_mm = 0.0, spindle_rpm = 0.0;
  bool exact_stop = false;
  Place place;
  bool is_arc() const { return motion == Motion::kClockwise || motion == Motion::kCounterClockwise; }
};

}  // namespace swarf::program::nc
