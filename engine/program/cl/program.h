// What a CL file says: the moves of the cutter in the work frame, each from where the one before ended.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/frames.h"
#include "program/cl/cycle.h"
#include "program/moves.h"

namespace swarf::program {

/// A tool as the program calls it: LOADTL/3, LOAD/TOOL,3 or TOOL PATH/...,TOOL,MILL-20MM.
struct ClTool {
  int number = 0;    ///< 0: called by its name
  std::string name;  ///< empty: called by its number
  SourceLocation where;
};

/// CUTTER or TLDATA as written, to be held against the scene's cutter.
struct ClCutter {
  std::vector<double> parameters;  ///< d, r, e, f, alpha, beta, h as far as given; mm, degrees
  int tool = -1;  ///< index into ClProgram::tools, of the tool that the next motion is made with
  SourceLocation where;
};

/// Text that is kept but does nothing: PARTNO, PPRINT, INSERT, COOLNT, PAINT, ...
struct ClNote {
  std::string word, text;
  int line = 0;
};

/// Who wrote a CL file, where it bears a sure mark; it settles what words mean that systems use differently.
enum class ClWriter {
  kUnknown,
  kSwarf,      ///< $$ SWARF CL DATA
  kNx,         ///< TOOL PATH/ or TLDATA/
  kCreo,       ///< $$* Pro/CLfile, or data in comments: $$-> CSYS
  kCatia,      ///< $$*CATIA0, $$ CATIA APT VERSION
  kMastercam,  ///< $$Machine Group-
  kCamWorks,   ///< CAMWorks or SOLIDWORKS CAM in a comment or PPRINT before the first motion
  kMakino,     ///< PPRINT/APTCL-SPEC,MAKINO-FF
};
/// "NX" and so on.
const char* writer_name(ClWriter writer);

/// What the points between CUTCOM/LEFT or RIGHT and CUTCOM/OFF are.
enum class ClPoints {
  kCentre,   ///< "centre": of the cutter; the control's register holds its wear, which is taken as 0
  kContour,  ///< "contour": of the part; the control moves the cutter its radius aside
};

/// What the positions behind TRACUT with a matrix are: of the path as it was planned, which the matrix still
/// has to turn, or of the path as it is cut.
enum class ClTracut { kApply, kApplied };

/// Radius of a tool that the scene knows.
struct ClToolRadius {
  int number = 0;
  std::string name;
  double radius_mm = 0.0;
};

/// What a CL file leaves open and its user knows.
struct ClOptions {
  std::optional<ClPoints> cutcom;
  /// CIRCLE runs clockwise about its vector (true), or counter-clockwise. None: as its writer does.
  std::optional<bool> circle_clockwise;
  std::optional<ClTracut> tracut;  ///< none: "tracut-meaning" at a matrix that is not the identity
  std::optional<double> unit_mm;  ///< 1 or 25.4 of a file without UNITS; none: 1, and ClProgram::unit_assumed
  std::vector<ClToolRadius> tools;  ///< for "contour", of tools without CUTTER or TLDATA
};

struct ClProgram {
  std::string file;
  ClWriter writer = ClWriter::kUnknown;
  std::string writer_reason;         ///< "TOOL PATH on line 3"; empty: no mark
  std::vector<std::string> remarks;  ///< what was taken as given, for the report
  ToolPose start;                    ///< the first complete position: nothing is assumed before it
  int start_line = 0;                ///< 0: the program has none
  bool unit_assumed = false;         ///< mm: neither UNITS nor ClOptions::unit_mm says it
  std::vector<Move> moves;           ///< stays empty in stream_cl()
  std::vector<ClTool> tools;         ///< each once, in the order of their first call
  std::vector<ClCutter> cutters;
  std::vector<ClNote> notes;  ///< stays empty in stream_cl()
  int statements = 0;         ///< comments not counted
  long motions = 0;           ///< moves that came
};

/// A hole of a drilling cycle, whole: what a post-processor that keeps cycles writes instead of its moves.
struct ClHole {
  ToolPose at;    ///< of GOTO: the depth counts from here, against the axis
  ClCycle cycle;  ///< its retract_mm is the height that the tool goes to at last, RTRCTO,AUTO too
  int moves = 0;  ///< so many come next: the hole in single steps, its arrival first
  int line = 0;
};

/// A GOTO that gives one position and nothing more: neither the end of an arc, a hole, nor compensated.
struct ClPosition {
  ToolPose pose;                 ///< W
  Pose X_WC = Pose::Identity();  ///< from the coordinates of the statement to the work
  double unit_mm = 1.0;          ///< of the statement's numbers
  bool with_axis = false;        ///< it says the tool axis
  int line = 0;
};

/// Takes moves and notes as they are read.
class ClSink {
 public:
  virtual ~ClSink() = default;
  virtual void move(const Move& move) = 0;
  /// Comes before the move to it; the first one has no move.
  virtual void position(const ClPosition& /*position*/) {}
  /// Comes before the moves of each hole, but not while a contour is compensated.
  virtual void hole(const ClHole& /*hole*/) {}
  virtual void note(ClNote note) = 0;
};

/// Parses CL data as NX (.cls), Creo (.ncl), CATIA (.aptsource), SolidWorks CAM (.clt) and others write it;
/// README.md lists the words that are read, noted and refused, and what each writer means by them. Problems
/// go to `diagnostics` with line and column:
///   "unknown-word", "unsupported-word", "bad-statement", "bad-number", "wrong-arguments", "axis-not-unit",
///   "missing-axis", "no-position", "missing-feed", "missing-spindle", "bad-arc", "circle-sense",
///   "bad-cycle", "bad-nurbs", "no-nurbs", "bad-system", "bad-tracut", "tracut-meaning", "cutcom-meaning",
///   "compensation-*",
///   "word-after-end", "from-not-first", "no-motion", "no-home", "out-of-range", "writer-contradiction"
/// Rules:
///   - The tool axis is (0,0,1) until one is given; a GOTO of three numbers keeps it. After MULTAX/ON one has
///     to be given, MULTAX/OFF turns it back to (0,0,1). TLAXIS gives one for what follows.
///   - RAPID holds for one move.
///   - CIRCLE/cx,cy,cz,i,j,k,r makes the next GOTO an arc about (i,j,k). NX means clockwise, as seen against
///     the vector (its help says so, and so run all 676 arcs of the programs in assets/programs/stepnode, of
///     NX and of Makino's system); Creo means counter-clockwise (its right-hand rule). From another writer
///     INDIRV or ClOptions must tell, else "circle-sense". An arc that ends where it starts is a whole
///     circle; one that ends at another height is a helix.
///   - TLON,GOFWD/(CIRCLE/..),ON,(LINE/..) of CATIA starts along INDIRV and ends at the line's second point.
///   - MSYS and CSYS give origin, X and Y axis of the system that the positions after it are in; the work
///     frame W is the one without any. $$*CATIA0 gives a machining axis system: W is the file's first.
///   - ORIGIN/x,y,z is subtracted from positions, TRANS/x,y,z added (ISO 4343).
///   - TRACUT/a11,a12,a13,a14,a21,..,a34 (ClTracut::kApply) takes positions to A p, until TRACUT/NOMORE; tool
///     axes, arcs and planes go with them. ORIGIN, TRANS and the systems act on what it gives.
///   - After CYCLE/... each GOTO is a hole, until CYCLE/OFF (cycle.h).
ClProgram parse_cl(const std::string& text, const std::string& file, Diagnostics& diagnostics,
                   const ClOptions& options = {});

/// Reads the file (refusing what is empty or not text) and parses it. Throws InputError.
ClProgram load_cl(const std::string& path, Diagnostics* warnings = nullptr, const ClOptions& options = {});

/// The same, line by line into `sink`: memory does not grow with the file. Problems go to `diagnostics`;
/// moves that came before an error have reached the sink.
ClProgram stream_cl(const std::string& path, ClSink& sink, Diagnostics& diagnostics,
                    const ClOptions& options = {});
/// Of a text; messages call it `file`.
ClProgram stream_cl_text(const std::string& text, const std::string& file, ClSink& sink,
                         Diagnostics& diagnostics, const ClOptions& options = {});

}  // namespace swarf::program
