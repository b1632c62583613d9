// The words of surface programs: G and M codes with their modal groups, and what each action wants.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "program/surface_blocks/lexer.h"

namespace swarf::program {

/// Two words of one group contradict each other in a block.
enum class Group { kAction, kPlane, kUnits, kOffset, kDistance, kSpindle, kToolChange, kProgramEnd };

/// Highest number of tools, surfaces and blocks: eight digits, as controls have.
inline constexpr double kMaxNumber = 99999999.0;

/// A G or M code of this program format.
struct Code {
  char letter;
  double number;
  Group group;
};
/// Null when the word is none.
const Code* find_code(const Word& word);

/// Reports a letter, or a G or M code, that surface programs do not have: "unsupported-word" when NC
/// has it elsewhere, else "unknown-word" with the nearest known one. True when the word is known.
bool check_known(const Word& word, int line, Reporter& reporter);

/// What a block does beside its modal words.
enum class Action {
  kNone,
  kOpenSurface,
  kPowerCoefficient,
  kBezierPoint,
  kCloseSurface,
  kArea,
  kIsoPass,
  kFlankPass
};
/// G06.3, G06.4 and G06.5.
inline bool is_cut(Action action) {
  return action == Action::kArea || action == Action::kIsoPass || action == Action::kFlankPass;
}

/// One word that an action takes, with the range of its number.
struct WordRule {
  char letter;
  bool required;
  bool whole;        ///< only whole numbers
  double low, high;  ///< inclusive
  bool above_low;    ///< `low` itself is refused
  const char* meaning;
  const char* unit;  ///< with a leading space, or ""
  const char* example;
};

/// "G10 L70", "G06.3".
const char* name_of(Action action);
/// Words of the action. The words N, T, S, F, G and M stand in any block; see modal_rules().
std::span<const WordRule> rules_of(Action action);
/// Words that any block may have.
std::span<const WordRule> modal_rules();
/// What G10 with this L word does; nothing when it is no surface block.
std::optional<Action> action_of_data_kind(double number);
/// What G10 with this L word means on controls that have it; "" when none has.
std::string other_data_kind(double number);

}  // namespace swarf::program
