// The first two steps of letter dialects: a line becomes words, and words of one modal group contradict each
// other.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "program/letters/formula.h"

namespace swarf::program::nc {

/// A G or M code of a dialect.
struct Code {
  int tenths;    ///< ten times its number: G43.4 is 434
  int8_t group;  ///< two codes of one group contradict each other; kFree: they never do
  /// kArguments: read; M behind it is a word, and I J K may stand several times (arguments of macros).
  /// kAbsent: takes a code of the dialect that this one is derived from out of its table.
  enum class Use : uint8_t { kRead, kNoEffect, kUnsupported, kArguments, kAbsent } use = Use::kRead;
  const char* meaning = "";  ///< for messages about codes without effect or support
  int acts_as =
      -1;  ///< the code (in tenths) of the dialect that this one is derived from, which does the same
};
inline constexpr int8_t kFree = -1;
inline constexpr int kGroups = 22;
inline constexpr int kMCodesMax = 8;

/// I J K of the second to the tenth set of a macro's arguments.
inline constexpr int kRepeatsMax = 27;

inline constexpr int kCodeTenths = 5000;

/// Whether a list can be indexed; dialects assert it of theirs.
constexpr bool fits_tables(std::span<const Code> codes) {
  for (const Code& code : codes) {
    if (code.tenths < 0 || code.tenths >= kCodeTenths || code.group < kFree || code.group >= kGroups)
      return false;
  }
  return true;
}

/// G or M codes by their number in tenths, made once from the dialect's list.
class CodeTable {
 public:
  explicit CodeTable(std::span<const Code> codes) { add(codes); }
  /// The codes of the dialect that this one is derived from, and those that differ.
  CodeTable(std::span<const Code> base, std::span<const Code> own) { add(base), add(own); }
  const Code* find(int tenths) const {
    return tenths >= 0 && tenths < kCodeTenths ? codes_[static_cast<size_t>(tenths)] : nullptr;
  }

 private:
  void add(std::span<const Code> codes);
  std::array<const Code*, kCodeTenths> codes_{};
};

/// "G43.4" from 434.
std::string code_name(char letter, int tenths);

struct LetterSyntax {
  const CodeTable* g_codes;
  const CodeTable* m_codes;
  std::string_view letters;      ///< that are words
  bool semicolon_comment;        ///< ';' starts a comment; else it ends the block
  bool number_first;             ///< N stands at the head of its block or nowhere
  bool active_comments = false;  ///< (ABORT, text) stops the program
  bool polar = false;            ///< @ (distance) and ^ (angle) are words
  bool corners = false;          ///< ,R and ,C round and cut the corner behind their block
};

/// The words of one line.
struct LetterBlock {
  uint32_t given = 0;  ///< bit per letter A..Z
  std::array<double, 26> values{};
  std::array<uint16_t, 26> places{};  ///< byte offset of the word in the line
  uint32_t g_given = 0;               ///< bit per group
  std::array<int, kGroups> g{};       ///< tenths, as Code::acts_as has them
  std::array<int, kGroups> g_written{};
  std::array<uint16_t, kGroups> g_places{};
  std::array<int, kMCodesMax> m{};  ///< tenths, in the order written
  std::array<uint16_t, kMCodesMax> m_places{};
  int m_count = 0;
  uint32_t m_groups = 0;
  int free_g = 0;    ///< number of G codes without a group
  int listed_m = 0;  ///< number of M codes without effect
  size_t first = 0;  ///< byte offset of the first word
  struct Repeat {
    char letter;
    double value;
    uint16_t place;
  };
  bool arguments = false;  ///< a code of Code::Use::kArguments stands in it
  std::array<Repeat, kRepeatsMax> repeats{};
  int repeat_count = 0;
  struct Corner {
    char letter = 0;  ///< R or C; 0: none
    double value = 0.0;
    size_t place = 0;
  } corner;  ///< ,R and ,C
  struct Polar {
    bool given = false;
    double value = 0.0;
    size_t place = 0;
  } distance, angle;         ///< @ and ^
  bool skip_mark = false;    ///< '/' before it
  std::string_view message;  ///< text of the last (MSG, ...) comment

  void clear() {
    given = g_given = m_groups = 0;
    m_count = free_g = listed_m = repeat_count = 0;
    skip_mark = arguments = false;
    corner.letter = 0;
    distance.given = angle.given = false;
    message = {};
  }
  void set(char letter, double value, size_t place) {
    const auto slot = static_cast<size_t>(letter - 'A');
    given |= 1u << slot;
    values[slot] = value;
    places[slot] = static_cast<uint16_t>(place);
  }
  bool has(char letter) const { return (given >> (letter - 'A') & 1u) != 0; }
  double get(char letter) const { return values[static_cast<size_t>(letter - 'A')]; }
  double get(char letter, double otherwise) const { return has(letter) ? get(letter) : otherwise; }
  size_t place(char letter) const { return places[static_cast<size_t>(letter - 'A')]; }
  bool has_g(int group) const { return (g_given >> group & 1u) != 0; }
  bool has_m(int tenths) const;
  bool empty() const {
    return (given | g_given) == 0 && m_count == 0 && free_g == 0 && corner.letter == 0 && !distance.given &&
           !angle.given;
  }
};

/// Reads the words from where `reader` stands to the end of the line into `block`, which must be clear.
/// Faults: "unknown-word", "unsupported-word", "word-twice", "modal-conflict", "two-motion-words" (group 1),
/// "unclosed-comment", "unexpected-character", "bad-number", and those of formulas. `stop`: a character that
/// ends the words and is left standing ('#' for assignments), 0 for none.
void read_words(const LetterSyntax& syntax, FormulaReader& reader, Control& control, LetterBlock& block,
                char stop);

/// Skips ( ) comments, and ; comments where they exist, and white space. (MSG, text) goes to `message`.
void skip_comments(const LetterSyntax& syntax, FormulaReader& reader, Control& control,
                   std::string_view& message);

/// Lists a code without effect, refuses one that is known and not supported.
void check_use(const Code& code, char letter, int column, Control& control);

/// The axis words of the block as a target, mm and rad.
Target target_of(const LetterBlock& block, bool incremental, const FormulaReader& reader,
                 const Control& control);

/// The circle of a G2 or G3 block, from R or from I J K (`absolute`: in program coordinates instead of
/// relative to the start); nothing when the block has no geometry. "bad-arc", "missing-word".
std::optional<ArcWords> arc_words(const LetterBlock& block, const Target& target, bool absolute,
                                  const FormulaReader& reader, Control& control);

/// A whole number in [low, high]; "not-whole-number", "out-of-range".
int whole(const LetterBlock& block, char letter, int low, int high, const FormulaReader& reader,
          Control& control);

}  // namespace swarf::program::nc
