// What an NC program says, as the control that reads it executes it: a stream of complete moves.
//
//   text --dialect--> Control (modal state, offsets, frames, TCP, machine) --> NcMove, NcMove, ... --> NcSink
//
// The control knows the machine, so every move has both its axis values and its tool poses; nothing is left
// to interpret. Programs are streamed: only the sink decides what is kept.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "base/frames.h"
#include "kinematics/machine_model.h"
#include "program/block_law.h"
#include "program/moves.h"

namespace swarf::program {

/// What the control's tool table says of a tool.
struct NcTool {
  int number = 0;                 ///< T word; 0: known by its name only
  std::string name;               ///< T="name"; empty: known by its number only
  double length_mm = 0.0;         ///< gauge line to tip
  double diameter_mm = 0.0;       ///< for cutter radius compensation
  double corner_radius_mm = 0.0;  ///< for LN blocks that give the contact point
};

/// One block's motion: what the machine adds to the move of its tool.
struct NcMove : Move {
  kinematics::AxisValues q_from = kinematics::AxisValues::Zero();  ///< machine coordinates, mm, rad
  kinematics::AxisValues q_to = kinematics::AxisValues::Zero();
  BlockLaw law = BlockLaw::kJoint;
  double duration_s = 0.0;  ///< of a feed move at its programmed feed (G93, G94, G95 alike); 0 for rapids
  bool exact_stop = false;  ///< G9, G60, G61: comes to rest at its end
  double corner_tolerance_mm = 0.0;  ///< G64 P, CYCLE832, TOLERANCE: the corner at its end may be rounded by
                                     ///< this much; 0: the control's own default
  int file = 0;                      ///< index into NcSummary::files
};

/// A message, comment or machine function without effect on the geometry: kept for the report.
struct NcNote {
  std::string word, text;
  int file = 0, line = 0;
};

/// Takes the moves as they are executed. Returning false stops the program (the user pressed Ctrl-C).
class NcSink {
 public:
  virtual ~NcSink() = default;
  virtual bool move(const NcMove& move) = 0;
  virtual void note(const NcNote& /*note*/) {}
};

/// The dialects that are read.
enum class Dialect { kLinuxCnc, kFanuc, kSiemens, kHeidenhain, kHaas, kMazak };
/// "linuxcnc" and so on.
const char* dialect_name(Dialect dialect);

/// What X Y Z of a program are: axis values, or the tip in the work with the law of TCP.
enum class Kinematics { kIdentity, kTcp };
/// "identity", "tcp".
const char* kinematics_name(Kinematics kinematics);

/// What LinuxCNC's kinematics switches mean on this machine. Which kinematics a number selects is the INI
/// file's affair: [KINS]KINEMATICS with sparm=identityfirst exchanges types 0 and 1, remaps turn them into
/// M428 to M430, and type 2 is a module of the machine's owner.
struct KinematicsSwitch {
  std::optional<Kinematics> start;  ///< what a program starts with; none: identity
  std::optional<Kinematics> m428;  ///< none: TCP, as in LinuxCNC's own table-tilting and bridge mill machines
  std::optional<Kinematics> m429;  ///< none: identity, as there
  std::optional<Kinematics> m430;  ///< none: unknown, M430 is refused
};

/// Where RAD of the 840D's LONGHOLE and SLOT1 ends, and from where to where AFSL of SLOT2 counts: at the
/// slot's edge, or at the middle of its round end. The manual shows it by a figure.
enum class SlotEnds { kEdge, kCentre };

/// Words that the machine's builder gave a meaning and that move nothing, with what they do: "M68"
/// (LinuxCNC's M100 to M199, Fanuc; the other dialects list every M that they do not act on), "CYCL DEF 392"
/// (Heidenhain), the name of a program (840D). Each is listed as without effect where it stands.
using BuilderWords = std::map<std::string, std::string>;
/// A key of BuilderWords as it is looked up ("m068" is "M68"); empty when it is none of the three.
std::string builder_word(const std::string& written);

/// A parameter's value before the program starts.
struct Preset {
  double value = 0.0;
  SourceLocation where;  ///< of the one who says so
};
/// By name as preset_name() gives it: "500" (#500 of Fanuc, Haas, Mazak, LinuxCNC), "_DEPTH" (#<_depth> of
/// LinuxCNC, a GUD of the 840D), "R12" (840D), "Q5", "QL5", "QR5" (Heidenhain).
using Presets = std::map<std::string, Preset>;
/// The name of a preset: in capitals, without # and < >.
std::string preset_name(std::string_view written);

/// What stands in the control before the program starts.
struct ControlSetup {
  kinematics::MachineModel machine;  ///< with gauge_M, or with one fixed tip for every tool
  std::vector<NcTool> tools;
  /// Tools by number that a table has and does not say enough of, each with its place and reason
  /// ("unknown-tool" where one is called).
  std::map<int, std::string> incomplete_tools;
  /// Work offsets by number (1: G54, 2: G55, ...), mm and rad, as differences from the machine position at
  /// which the tip stands on the work's origin with the rotary axes at zero. What is not given is zero.
  std::map<int, kinematics::AxisValues> work_offsets;
  /// Axis values where the program starts. None: the first move with all axes given starts it (reported).
  std::optional<kinematics::AxisValues> start;
  std::vector<std::string>
      subprogram_folders;              ///< where called programs are looked for besides the program's own
  KinematicsSwitch kinematics_switch;  ///< LinuxCNC only
  BuilderWords builder_words;
  std::optional<SlotEnds> slot_ends;  ///< Siemens only; none: "slot-ends" where it matters
  Presets presets;                    ///< "bad-preset" for one that the dialect does not have
  /// Length of the unit that holds before the program says its own (G20, G21), 1 or 25.4: the machine's
  /// default. None: 1, and the warning "units-assumed" where a program without such a word moves.
  std::optional<double> unit_mm;
  /// The tool in the spindle before the program starts: index into `tools`; -1: the spindle is empty.
  int start_tool = -1;
  /// `start_tool` is a guess (the only tool there is): it holds only where the program cuts before it calls
  /// one, and the warning "start-tool-assumed" says so.
  bool start_tool_if_needed = false;
  /// Positions are those of the tip, whatever the tool's length, as long as the program calls no length (G43
  /// H, D1): the work offset was taken with the tool itself. Off: they are those of the gauge line, and the
  /// warning "length-not-compensated" says so.
  bool tip_without_length = false;
  /// T changes the tool at once, without M6 (LinuxCNC, Fanuc; Siemens, where programs without M6 show it
  /// too).
  bool t_changes_tool = false;
  long moves_max = 50'000'000;  ///< endless loops end here, with the line that broke the limit
};

/// A tool that was asked for without a tool table.
struct AskedTool {
  int number = 0;    ///< 0: by its name
  std::string name;  ///< "": by its number
  int line = 0;
};

/// What was read, for the report.
struct NcSummary {
  Dialect dialect = Dialect::kLinuxCnc;
  std::string dialect_reason;      ///< why it was recognised; "the scene says so"
  std::vector<std::string> files;  ///< the program, then each file it called
  long lines = 0, blocks = 0, moves = 0;
  std::string start;                   ///< in words: where the program started and why there
  std::string start_tool;              ///< in words: what was in the spindle then, and why; "": nothing
  std::vector<AskedTool> tools_asked;  ///< without a tool table: each once, in the program's order
  bool tip_positions = false;          ///< ControlSetup::tip_without_length has mattered
  std::vector<int> tools_used;         ///< indices into ControlSetup::tools, in order of their first cut
  std::vector<std::string> functions;  ///< words that were read and have no effect on the geometry (M8, MSG),
                                       ///< each once, for "what was not simulated"
};

/// Runs the program file. `dialect` none: recognised from the text, as its common core of ISO words where
/// nothing shows it; the note "dialect-assumed" says so, and the warning "dialect-changed" where the first
/// lines cannot be read in the dialect that the text speaks for. Problems go to `diagnostics` with
/// file:line:column; moves that came before an error have reached the sink.
NcSummary run_nc(const std::string& path, std::optional<Dialect> dialect, const ControlSetup& setup,
                 NcSink& sink, Diagnostics& diagnostics);

}  // namespace swarf::program
