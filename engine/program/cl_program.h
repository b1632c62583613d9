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
  double dwell_s = 0.0;      ///< the tool stands this long before the move (DELAY, cycles)
  double spindle_rpm = 0.0;  ///< 0 while the spindle stands; below 0 counter-clockwise (CCLW)
  int tool = -1;             ///< index into ClProgram::tools; -1: none was loaded
  int line = 0, column = 0;
};

/// A tool as the program calls it: LOADTL/3, LOAD/TOOL,3 or TOOL PATH/...,TOOL,MILL-20MM.
struct ClTool {
  int number = 0;    ///< 0: called by its name
  std::string name;  ///< empty: called by its number
  SourceLocation where;
};

/// CUTTER or TLDATA as written, to be held against the scene's cutter.
struct ClCutter {
  std::vector<double> parameters;  ///< d, r, e, f, alpha, beta, h as far as given; mm, degrees
  int tool = -1;                   ///< index into ClProgram::tools, of the tool loaded there
  SourceLocation where;
};

/// Text that is kept but does nothing: PARTNO, PPRINT, INSERT, COOLNT, PAINT, ...
struct ClNote {
  std::string word, text;
  int line = 0;
};

struct ClProgram {
  std::string file;
  ToolPose start;      ///< the first complete position: nothing is assumed before it
  int start_line = 0;  ///< 0: the program has none
  std::vector<ClMove> moves;
  std::vector<ClTool> tools;  ///< each once, in the order of their first call
  std::vector<ClCutter> cutters;
  std::vector<ClNote> notes;
  int statements = 0;
};

/// Lengths of tool axes may differ from 1 by this much (rounded output of CAM systems); they are normalised.
inline constexpr double kAxisLengthTolerance = 1e-4;
/// The ends of an arc may miss its circle by this much, mm.
inline constexpr double kArcTolerance = 5e-3;

/// Parses CL data as NX (.cls), Creo, CATIA (.cldata, .apt) and others write it. Words:
///   motion    FROM GOTO GODLTA RAPID CIRCLE CYCLE DELAY MSYS CSYS SET/MODE MULTAX
///   rates     FEDRAT SPINDL
///   tools     LOADTL LOAD SELECT CUTTER TLDATA TOOL PATH
///   units     UNITS/MM UNITS/INCHES
///   notes     PARTNO PPRINT INSERT REMARK COOLNT PAINT MACHIN INTOL OUTTOL STOP OPSTOP REWIND END-OF-PATH
///   end       FINI
/// Problems go to `diagnostics` with line and column:
///   "unknown-word", "unsupported-word", "bad-statement", "bad-number", "wrong-arguments", "axis-not-unit",
///   "missing-axis", "no-position", "missing-feed", "missing-spindle", "bad-arc", "bad-cycle",
///   "word-after-end", "from-not-first", "no-motion", "out-of-range"
/// Rules:
///   - The tool axis is (0,0,1) until one is given; a GOTO of three numbers keeps it. After MULTAX/ON one has
///     to be given, MULTAX/OFF turns it back to (0,0,1).
///   - RAPID holds for one move.
///   - CIRCLE/cx,cy,cz,i,j,k,r makes the next GOTO an arc, CLOCKWISE about (i,j,k), as seen against the
///   vector:
///     so run all 676 arcs of the programs in assets/programs/stepnode, of two different systems. An arc that
///     ends where it starts is a whole circle.
///   - MSYS and CSYS give origin, X and Y axis of the system that the positions after it are in; the work
///   frame
///     W is the one without any.
///   - After CYCLE/... each GOTO is a hole, until CYCLE/OFF (cl_cycle.h).
ClProgram parse_cl(const std::string& text, const std::string& file, Diagnostics& diagnostics);

/// Reads the file (refusing what is empty or not text) and parses it. Throws InputError.
ClProgram load_cl(const std::string& path, Diagnostics* warnings = nullptr);

}  // namespace swarf::program
