// What the milling cycles of the 840D share: their arguments, and moves in a frame of their own.
//
//   POCKET3( .. ) -> MillCall (numbers, checked) -> Outline (ways in the plane) -> MillMotion -> Control
//
// The manual (Cycles, PGZ) says where material goes, the depths, directions, feeds, where the tool comes from
// and goes to. How passes in the plane follow each other it leaves to the control: what is taken here is said
// by a warning once a program, and changes neither walls nor floor. No code of the control was
// at hand.
#pragma once

#include <optional>
#include <string>

#include "program/siemens/outline.h"
#include "program/siemens/steps.h"

namespace swarf::program::nc::siemens {

/// A call and the control that runs it: arguments by position (0: the first), lengths in mm.
class MillCall {
 public:
  /// Refuses where no milling cycle can run: start unknown, G41 or G42, no tool, mirrored or scaled axes,
  /// more than `arguments_max` arguments.
  MillCall(Executor& executor, const CycleCall& call, size_t arguments_max);

  bool given(size_t index) const { return has_argument(call_, index); }
  double number(size_t index, std::optional<double> fallback) const;
  int whole(size_t index, std::optional<double> fallback) const;
  double length(size_t index, std::optional<double> fallback) const;
  /// A length that is zero or more; its sign does not count.
  double size(size_t index, std::optional<double> fallback) const;
  /// The same, above zero.
  double way(size_t index) const;
  /// F of an argument, units per minute or turn as G94, G95 say; 0 or left out: the F that holds.
  double feed(size_t index) const;
  /// +1: counter-clockwise about the plane's normal, -1: clockwise. 0 climb, 1 conventional, 2 G2, 3 G3;
  /// `outside`: about the work, not within it.
  int sense(size_t index, bool outside) const;
  /// The fewest equal steps of at most `most` that make up `way`; `most` 0: one. 0 where there is no way.
  int steps(double way, double most, size_t index) const;
  /// Arguments that choose variants, from `first` on: left out, or 0.
  void only_zero_from(size_t first) const;
  void only_zero_between(size_t first, size_t behind) const;
  /// _GMODE (hundreds: machine; thousands: from the centre; ten thousands: all of it), _DMODE (the plane),
  /// _AMODE (units: how the depth is given, tens: widths in mm or percent) that newer cycles append.
  void plain_modes(size_t gmode) const;
  [[noreturn]] void fail(const char* code, size_t index, std::string text, std::string fix) const;
  /// What the manual leaves to the control, once a program and code.
  void warn(const char* code, std::string text) const;

  double tool_radius() const { return tool_radius_; }
  int column() const;
  const std::string& name() const { return call_.name; }
  Executor& executor() const { return executor_; }

 private:
  Executor& executor_;
  const CycleCall& call_;
  double tool_radius_ = 0.0;
};

/// Of the tool's diameter: the step between passes where none is given.
inline constexpr double kStepOfTool = 0.8;

/// Heights along the plane's normal, mm.
struct MillHeights {
  double retract = 0.0;  ///< RTP
  double safe = 0.0;     ///< RFP + SDIS: infeeds count from here
  double bottom = 0.0;   ///< DP
};
/// RTP, RFP, SDIS, DP from argument `first` on, and DPR behind them where there is one. The units digit of
/// argument `amode` says which depth counts: 1 from RFP, 2 absolute.
MillHeights mill_heights(const MillCall& call, bool has_dpr, size_t amode, size_t first = 0);

/// A rectangle with round corners, or a circle, mm and degrees.
struct MillShape {
  double half_length = 0.0, half_width = 0.0, corner = 0.0;
  Vec2 centre = Vec2::Zero();
  double angle_deg = 0.0;
};
/// Length, width, corner radius, centre (two) and angle from argument `at` on; `what`: pocket, spigot.
MillShape rectangle_at(const MillCall& call, size_t at, const char* what);
/// Radius (or the diameter) and centre (two) from argument `at` on.
MillShape circle_at(const MillCall& call, size_t at, bool diameter);

/// Moves in the frame of a cycle: its origin in the plane, turned by an angle. Heights are those of the
/// program. Borrows F and its mode while it lives.
class MillMotion {
 public:
  MillMotion(const MillCall& call, const Vec2& origin, double angle_deg);
  void rapid(const Vec2& to);
  void rapid_height(double height);
  void feed(const Vec2& to, double feed);
  void feed_height(double height, double feed);
  /// An arc, or a whole circle; with `height` a helix.
  void arc(const Vec2& to, const Vec2& centre, int turn, double feed, std::optional<double> height = {});
  /// From its start, where the tool stands, around.
  void follow(const Outline& outline, double feed);
  /// Straight to `to` and down to `height`.
  void ramp(const Vec2& to, double height, double feed);

 private:
  nc::Target at(const Vec2& to) const;
  void use(double feed);

  nc::Control& control_;
  int column_;
  Vec2 origin_, along_;
  nc::PlaneAxes axes_;
  Borrowed<double> feed_, unit_;
  Borrowed<nc::FeedMode> mode_;
  double feed_unit_mm_;
};

// --- pockets.cpp
void pocket(Executor& executor, const CycleCall& call);  ///< POCKET1 to POCKET4
// --- slots.cpp
void slots(Executor& executor, const CycleCall& call);  ///< SLOT1, SLOT2, LONGHOLE
// --- spigots.cpp
void spigot(Executor& executor, const CycleCall& call);  ///< CYCLE76, CYCLE77
// --- contour_cycle.cpp
/// CYCLE72: its contour is read next.
void begin_contour(Executor& executor, const CycleCall& call);
/// "bad-contour" for words that no contour of a cycle has.
void check_contour_block(Executor& executor, const BlockWords& words, bool modal_call);
/// The contour has been read: mills it.
void mill_contour(Executor& executor);
// --- facing.cpp
void face(Executor& executor, const CycleCall& call);  ///< CYCLE61, CYCLE71

}  // namespace swarf::program::nc::siemens
