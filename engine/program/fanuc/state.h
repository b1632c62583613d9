// What a Fanuc control (series 30i words) keeps from block to block, as plain data; steps.h has what is done
// with it.
#pragma once

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "program/control/call_stack.h"
#include "program/control/stretch.h"
#include "program/fanuc/codes.h"
#include "program/letters/letter_dialect.h"

namespace swarf::program::nc::fanuc {

struct Fanuc;

/// A code of group 0 that a derived dialect adds.
struct OwnCode {
  int tenths;
  std::string_view letters;  ///< that it gives a meaning; axis words need not stand here
  void (*act)(Fanuc&);
};

/// What the controls of this family do each in its own way, as data: a derived dialect is its words (code
/// tables made of those of the 30i and what differs) and its rules. The defaults are those of the 30i.
struct Rules {
  const LetterSyntax* syntax = nullptr;
  const FormulaSyntax* formula = nullptr;
  std::span<const OwnCode> own_codes = {};
  std::string_view free_letters = "PQR";                  ///< that stand with codes without a group (G05 P)
  std::string_view listed_letters = "";                   ///< that stand with M codes without effect
  std::span<const std::string_view> listed_statements{};  ///< begin lines that print and move nothing (DPRNT)
  std::string_view pointless_letters = "XYZABC";          ///< whose numbers a point gives another meaning
  const char* point_rule = "calculator type, parameter 3401";  ///< why numbers without a point are read so
  bool warn_of_pointless = false;         ///< a fault of the program where the machine is not set so
  bool point_is_seconds = false;          ///< P of dwells: seconds with a decimal point, milliseconds without
  std::string_view repeats = "KL";        ///< letters that repeat a cycle
  int program_digits = 4;                 ///< of O numbers in the names of files
  bool counted_calls = true;              ///< M98 P0030100 calls O0100 three times
  char call_label = '\0';                 ///< M98 with this letter begins at that block of the program
  size_t calls_max = 15, macros_max = 5;  ///< levels: subprograms and macros together, macros
  bool reference_alone = false;           ///< G28 without words sends all axes home
  int further_offsets = 300;              ///< G54.1 P, G10 L20 P
  bool offset_diameters = false;          ///< G10 L12, L13 set diameters
  const char* offset_rule = "as machines are delivered (parameter 5004)";
  int plane_form = -1;          ///< P of G68.2 that always holds
  int plane_off = G::kTurnOff;  ///< ends a tilted plane; another code than G69: G69 leaves it alone
  bool mirror_at_zero = false;  ///< mirror images lie at the program's zero: their words are 0
  /// A variable that means something else here; nothing: as on the 30i. `place` for faults.
  std::optional<double> (*variable)(Fanuc&, long number, size_t place) = nullptr;
};

inline constexpr std::string_view kFanucLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ";
extern const Rules kFanucRules;
extern const FormulaSyntax kFanucFormula;
/// The codes of the 30i, for the tables of derived dialects.
extern const std::span<const Code> kFanucGCodes, kFanucMCodes;

enum FanucGroup {
  kFanucOneShot = 0,
  kFanucMotion = 1,
  kFanucPlane = 2,
  kFanucDistance = 3,
  kFanucFeed = 5,
  kFanucUnits = 6,
  kFanucRadius = 7,
  kFanucLength = 8,
  kFanucCycle = 9,
  kFanucRetract = 10,
  kFanucScale = 11,
  kFanucMacro = 12,
  kFanucOffset = 14,
  kFanucPath = 15,
  kFanucTurn = 16,
  kFanucPolar = 17,
  kFanucMirror = 18,
  kFanucEnd = 0,
  kFanucTool = 1,
  kFanucSpindle = 2
};

using Locals = std::array<double, 34>;
/// A program that runs.
struct Call {
  LineSource* source = nullptr;
  LineSource::Mark back, top;
  LineSource::Mark head;  ///< where its program begins; M97 calls a part of that
  long left = 0;
  bool own_locals = false;  ///< G65, G66: #1 to #33 of its own
  int modal = -1;           ///< index into modals_ of the macro that runs here; -1: none of them
  size_t modals = 0;        ///< so many of modals_ hold here: the last of these is called after each move
  Locals locals{};
  uint64_t assigned = 0;
  std::vector<std::pair<int, LineSource::Mark>> loops;  ///< DO number, its WHILE line
};
/// G66 until its G67.
struct Modal {
  int number;
  long times;
  Locals locals;
  uint64_t assigned;
};
struct Known {
  int number;
  LineSource* source;
  LineSource::Mark body;
};
/// G06.2 while its blocks come in.
struct Nurbs {
  int order = 4;
  std::vector<CurvePoint> points;
  std::vector<double> weights, knots;
  Place where;
};
/// Mirror image and scaling of one axis, in this order: p' = factor p + shift.
struct AxisMap {
  bool mirrored = false;
  double mirror_at = 0.0, scale = 1.0, centre = 0.0;
  double factor() const;
  double shift() const;
};
/// G16; what the words gave last.
struct Polar {
  bool on = false;
  double radius_mm = std::numeric_limits<double>::quiet_NaN(), angle_deg = radius_mm;
};
/// G68.2 P2 and P3 while their blocks come in.
struct PlaneBlocks {
  int form = 0;
  bool incremental = false;
  Place where;
  std::array<Vec3, 3> vectors{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  ///< P2: points; P3: X, Z, origin
  unsigned given = 0;                                                     ///< bit per Q
  double turn_deg = 0.0;
};
/// G68.2 or G68; the frame that the others are put on.
struct Turned {
  Pose frame = Pose::Identity();
  bool on = false, in_work = false;
};

/// Words of a canned cycle that stay until G80 or another motion, mm and s.
struct CycleWords {
  double z = 0.0, r = 0.0, q = 0.0, p = 0.0, i = 0.0, j = 0.0;
  bool has_z = false, has_r = false, has_q = false, has_i = false, has_j = false;
  bool z_incremental = false, r_incremental = false;  ///< as they were written: G90 and G91 come later
};

/// Programs that run, macros that wait, programs that were found.
struct Calls {
  CallStack<Call> stack;
  std::vector<Modal> modal;
  std::vector<Known> known;
};

/// #100 to #999.
struct Variables {
  std::vector<double> common;
  std::vector<bool> assigned;
};

/// Modal codes in tenths, and what the words of the dialect keep.
struct Modes {
  int motion = 0, cycle = G::kCycleOff, length_code = G::kLengthOff, turn_code = G::kTurnOff;
  int d_number = 0, h_number = 0;       ///< D and H as written last
  bool d_kept = false, h_kept = false;  ///< named beside no G41 or G43: the next one takes them
  bool number_rule_stated = false;
  bool moved = false;  ///< the block has a move
  bool incremental = false, retract_to_r = false;
  bool rotaries_stand = false;  ///< G254 of Haas: what holds is made for the rotary axes where they stand
  Tcp tcp = Tcp::kOff;
};

struct Drilling {
  CycleWords words;
  double cycle_start = 0.0;  ///< initial level: the height before the first cycle of a series
};

struct Planes {
  Turned turned;
  std::optional<PlaneBlocks> open;
};

/// What moves the program's zero, besides frames.
struct Zero {
  kinematics::AxisValues shift = kinematics::AxisValues::Zero();  ///< G92
  kinematics::AxisValues local = kinematics::AxisValues::Zero();  ///< G52
  std::map<int, std::array<std::optional<double>, 4>> offsets;    ///< G10 L10 to L13, mm, by number
  std::array<std::optional<double>, kAxisWords> through;          ///< the point that G28 passed, for G29
};

/// G50.1 G51.1, G50 G51, G15 G16.
struct Mapping {
  std::array<AxisMap, 3> axis;
  Stretch stretch;  ///< of the words, made of them
  bool mirrored = false, scaled = false;
  Polar polar;
};

inline constexpr long kLastCommon = 999;
inline constexpr uint32_t kAxisBits = 7u | 7u << ('X' - 'A');

struct Fanuc final : LetterDialect {
  Fanuc(const std::string& file, Control& machine, const Rules& own);
  double read(long number, size_t place) override;
  double read_named(std::string_view name, size_t place) override;
  bool exists(std::string_view name) override;
  bool vacant(long number) const override;

  const Rules& rules;
  Calls calls;
  Variables variables{std::vector<double>(kLastCommon + 1, 0.0), std::vector<bool>(kLastCommon + 1, false)};
  Modes modes;
  Drilling drilling;
  Planes planes;
  Zero zero;
  std::optional<Nurbs> nurbs;
  Mapping mapping;
};

/// The code of a modal group in tenths; -1: the block has none.
inline int g(const LetterDialect& letters, int group) {
  return letters.block.has_g(group) ? letters.block.g[static_cast<size_t>(group)] : -1;
}
/// The file that is being read.
inline LineSource& source(Calls& calls) {
  return *calls.stack.top().source;
}

}  // namespace swarf::program::nc::fanuc
