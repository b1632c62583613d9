// One block of Siemens 840D as data: its words with their values, checked against each other, before
// anything is done.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "program/siemens/expression.h"
#include "program/siemens/polynomial.h"
#include "program/siemens/words.h"

namespace swarf::program::nc::siemens {

/// How a coordinate was written.
enum class Way {
  kModal,        ///< X10: by G90 or G91
  kAbsolute,     ///< X=AC(10)
  kIncremental,  ///< X=IC(10)
  kShortest,     ///< C=DC(10)
  kPositive,     ///< C=ACP(10)
  kNegative,     ///< C=ACN(10)
};

struct Coordinate {
  double value = 0.0;  ///< as written: mm or inches, degrees
  Way way = Way::kModal;
  size_t offset = 0;
  explicit operator bool() const { return given; }
  bool given = false;
};

/// A number with its place.
struct Amount {
  double value = 0.0;
  size_t offset = 0;
  bool given = false;
  explicit operator bool() const { return given; }
};

struct ToolCall {
  bool given = false;
  bool by_name = false;
  int number = 0;
  std::string name;
  size_t offset = 0;
};

/// A call with arguments: CYCLE800(...), MSG(...). Arguments that are left out are empty.
struct CycleCall {
  std::string name;
  std::vector<std::optional<Value>> arguments;
  std::vector<size_t> offsets;
  size_t offset = 0;
};

struct NamedPlace {
  std::string name;
  size_t offset = 0;
};

/// What a block has in numbers; as made, it has none.
struct BlockNumbers {
  std::array<Coordinate, 6> axes;           ///< X Y Z A B C
  std::array<Coordinate, 3> centre;         ///< I J K
  std::array<Coordinate, 3> between;        ///< I1 J1 K1
  Coordinate polar_angle, polar_radius;     ///< AP RP
  std::array<Amount, 3> angles;             ///< A2 B2 C2
  std::array<Amount, 3> vector;             ///< A3 B3 C3
  Amount radius, opening, turns;            ///< CR AR TURN
  Amount feed, speed, cutting_edge;         ///< F S D
  Amount rounding, plane_turn, contour;     ///< ADIS RPL CTOL
  std::array<Coefficients, 6> polynomials;  ///< PO of X Y Z A B C; their ends stand in `axes`
  Coefficients divisor;                     ///< PO[]
  double divisor_end = 1.0;
  Amount interval;                                ///< PL
  Amount allowance;                               ///< OFFN
  Amount round, chamfer, chamfer_leg, round_all;  ///< RND CHF CHR RNDM
  Amount corner_feed, corner_feed_all, angle;     ///< FRC FRCM ANG
  std::array<Amount, 3> feed_radii;               ///< FGREF of A B C
};

struct BlockWords : BlockNumbers {
  ToolCall tool;
  std::vector<Amount> functions;  ///< M
  std::vector<std::pair<Group, int>> codes;
  std::optional<int> motion;            ///< of Group::kMotion, in this block
  std::optional<int> frame, transform;  ///< TRANS ..., TRAORI TRAFOOF
  size_t frame_offset = 0, motion_offset = 0, other_offset = 0;
  std::vector<CycleCall> calls;
  std::vector<NamedPlace> noted;
  bool ends_program = false;  ///< RET

  /// As made, with the memory of its lists.
  void clear();
  bool any_axis() const;
  bool moves() const;  ///< something that a motion is made of
  std::optional<int> code(Group group) const {
    for (const auto& [of, code] : codes) {
      if (of == group) return code;
    }
    return std::nullopt;
  }
};

/// Words that contradict each other throw InputError "words-conflict", "unexpected-word". `machine_axis`: the
/// first axis that is named as the machine's (X1=); `line`: the block's text, for the place.
void check_block(const BlockWords& words, const Coordinate* machine_axis, const LineRef& line);

/// Reads the rest of a block; assignments to variables are done as they are met. Throws InputError:
///   "unknown-word", "unsupported-word", "word-twice", "two-motion-words", "modal-conflict", "bad-block",
///   "bad-number", "not-whole-number", "wrong-type", "words-conflict", "too-many-coefficients".
void read_block(TokenReader& reader, Variables& variables, BlockWords& words);

}  // namespace swarf::program::nc::siemens
