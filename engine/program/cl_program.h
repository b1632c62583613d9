// What a CL file says: the moves of the cutter in the work frame, each from where the one before ended.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/frames.h"

namespace swarf::program {

/// The tip goes round `centre_W` counter-clockwise about `normal_W`; it stays an arc until it is cut.
struct ClArc {
  Vec3 centre_W = Vec3::Zero();
  Vec3 normal_W = Vec3::UnitZ();  ///< unit
};

/// One motion statement.
struct ClMove {
  ToolPose from, to;         ///< W
  std::optional<ClArc> arc;  ///< none: a straight move
  double feed_mm_s = 0.0;    ///< 0: rapid (FEDRAT is mm/min in the text)
  double spindle_rpm = 0.0;  ///< 0 while the spindle stands
  int tool = 0;              ///< LOADTL; 0: none was loaded
  int line = 0, column = 0;
};

/// CUTTER as written, to be held against the scene's cutter.
struct ClCutter {
  std::vector<double> parameters;  ///< d, r, e, f, alpha, beta, h as far as given; mm, degrees
  SourceLocation where;
};

/// Text that is kept but does nothing: PARTNO, PPRINT, INSERT, COOLNT.
struct ClNote {
  std::string word, text;
  int line = 0;
};

struct ClProgram {
  std::string file;
  ToolPose start;      ///< the first complete position: nothing is assumed before it
  int start_line = 0;  ///< 0: the program has none
  std::vector<ClMove> moves;
  std::vector<ClCutter> cutters;
  std::vector<ClNote> notes;
  int statements = 0;
};

/// Lengths of tool axes may differ from 1 by this much (rounded output of CAM systems); they are normalised.
inline constexpr double kAxisLengthTolerance = 1e-4;
/// The ends of an arc may miss its circle by this much, mm.
inline constexpr double kArcTolerance = 5e-3;

/// Parses CL data. Words: PARTNO PPRINT INSERT REMARK, UNITS/MM, LOADTL, CUTTER, MULTAX, FROM, GOTO, GODLTA,
/// CIRCLE, RAPID, FEDRAT, SPINDL, COOLNT, FINI. Problems go to `diagnostics` with line and column:
///   "unknown-word", "unsupported-word", "bad-statement", "bad-number", "wrong-arguments", "axis-not-unit",
///   "missing-multax", "missing-axis", "no-position", "missing-feed", "bad-arc", "word-after-end",
///   "from-not-first", "no-motion", "out-of-range"
/// Rules: tool axes are (0,0,1) while MULTAX is off. With MULTAX/ON a GOTO of three numbers keeps the axis.
/// RAPID holds for one move. CIRCLE/cx,cy,cz,i,j,k,r makes the next GOTO an arc, counter-clockwise about
/// (i,j,k); an arc that ends where it starts is a whole circle.
ClProgram parse_cl(const std::string& text, const std::string& file, Diagnostics& diagnostics);

/// Reads the file (refusing what is empty or not text) and parses it. Throws InputError.
ClProgram load_cl(const std::string& path, Diagnostics* warnings = nullptr);

}  // namespace swarf::program
