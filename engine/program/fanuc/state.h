// What a Fanuc control (series 30i words) keeps from block to block, as plain data; steps.h has what is done
// with it.
#pragma once

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "program/fanuc/codes.h"
#include "program/letters/letter_dialect.h"

namespace swarf::program::nc::fanuc {

extern const LetterSyntax kFanucSyntax;
extern const FormulaSyntax kFanucFormula;

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
  bool mirrors() const { return factor() < 0.0; }
  double at(double value, bool is_incremental) const;
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
  std::vector<Call> stack;
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
  int d_number = 0, h_number = 0;  ///< D and H as written last
  bool number_rule_stated = false;
  bool moved = false;  ///< the block has a move
  bool incremental = false, retract_to_r = false;
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
  bool mirrored = false, scaled = false;
  Polar polar;
};

inline constexpr long kLastCommon = 999;
inline constexpr uint32_t kAxisBits = 7u | 7u << ('X' - 'A');

struct Fanuc final : LetterDialect {
  Fanuc(const std::string& file, Control& machine);
  double read(long number, size_t place) override;
  double read_named(std::string_view name, size_t place) override;
  bool exists(std::string_view name) override;
  bool vacant(long number) const override;

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
  return *calls.stack.back().source;
}

}  // namespace swarf::program::nc::fanuc
