// How one control wants its programs, as data: what assets/posts/*.toml says and a shop writes for itself.
// README.md lists the keys. Nothing here knows a control; the only rule that a key cannot change is the order
// of the writer's steps (writer.h).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "post/line_template.h"
#include "post/number_format.h"
#include "post/preference.h"
#include "post/tilted_plane.h"
#include "program/nc_program.h"

namespace swarf::post {

/// What F counts in a block that turns rotary axes without TCP and without inverse time.
enum class FeedCounts {
  kAllAxes,      ///< the root of the sum of the squares of mm and degrees
  kLinearFirst,  ///< the way of X Y Z; degrees when they stand
};

struct NumberFormats {
  NumberFormat linear, rotary;      ///< unit of the program, degrees
  NumberFormat feed, inverse_time;  ///< unit/min, 1/min
  NumberFormat speed, time;         ///< 1/min, s
};

struct MotionWords {
  bool modal = true;  ///< a word that is the last one's is left out
  LineTemplate rapid, line, clockwise, counter_clockwise;
  std::array<std::string, 3> plane;  ///< of XY, ZX, YZ; "": no arcs in that plane
  bool plane_words = true;           ///< they are written; else they only say which planes there are
  bool helix = true;
};

struct CycleWords {
  LineTemplate drill, drill_dwell, deep, chip_break, bore, bore_dwell, tap;  ///< empty: written as moves
  LineTemplate next;  ///< a further hole of the same cycle, arrival and all; empty: each is written whole
  LineTemplate call;  ///< runs what the lines above have defined; empty: they run themselves
  std::string end, return_start, return_clear;
  bool dwell_in_ms = false;
};

/// The unit of lengths and feeds in the program.
struct OutputUnit {
  bool inches = false;
  std::string mm, inch;   ///< {unit} of head and tail; both empty: they name their unit themselves
  int feed_per_inch = 1;  ///< what F counts in a program in inches: 10, tenths of an inch

  double length_mm() const { return inches ? 25.4 : 1.0; }
  double feed_mm() const { return inches ? 25.4 / feed_per_inch : 1.0; }
};

struct PlaneWords {
  LineTemplate on, off;  ///< empty: the control has none
  PlaneUse use = PlaneUse::kCycles;
  PlaneTurns turns = PlaneTurns::kZXZ;
  std::string positive, negative;  ///< {side}: which solution of the rotary axes
};

struct PostFormat {
  std::string file, name;
  program::Dialect dialect = program::Dialect::kFanuc;  ///< the reader that reads these programs back
  NumberFormats numbers;
  OutputUnit unit;
  LineTemplate block_number;  ///< with {number}; empty: blocks are not numbered
  int number_start = 10, number_step = 10;
  LineTemplate comment;
  std::string comment_without;  ///< characters that it cannot hold
  size_t comment_longest = 60;
  LineTemplate head, tail;
  LineTemplate retract, change, change_by_name, approach, length_on, length_off;
  LineTemplate clockwise, counter_clockwise, spindle_stop;
  std::string flood, mist, coolant_off, stop, optional_stop;
  LineTemplate dwell;
  MotionWords motion;
  std::string per_minute, inverse_time;
  FeedCounts feed_counts = FeedCounts::kAllAxes;
  LineTemplate tcp_on, tcp_off;
  std::optional<Preference> prefer;  ///< none: the first way through each stretch that can be driven
  bool tcp_by_default = false, tcp_arcs = true;
  std::string tcp_warning;  ///< told when TCP is used
  CycleWords cycle;
  PlaneWords tilted_plane;

  bool has_tcp() const { return !tcp_on.empty(); }
};

/// Of "never", "cycles", "constant".
PlaneUse plane_use(std::string_view name);

/// The format with lengths in inches or mm: a digit more or less where that changes. Throws InputError
/// "no-unit-words" for a post whose head does not say {unit}.
PostFormat in_unit(PostFormat format, bool inches);
/// Half of the last digit of a length, mm.
double half_digit_mm(const PostFormat& format);

/// Reads the file. Throws InputError with every fault: what ConfigTable finds, "unknown-place" for a { } that
/// a key does not have, "missing-place", "unknown-dialect", "incomplete-post".
PostFormat load_post(const std::string& file);

}  // namespace swarf::post
