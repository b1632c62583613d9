// Second and third parsing step: modal conflicts inside a block, then the rules of its words one by one.
// Nothing here knows or changes the state of the program.
#pragma once

#include <array>
#include <optional>

#include "program/surface_blocks/lexer.h"
#include "program/surface_blocks/vocabulary.h"

namespace swarf::program {

/// Numbers of the words that keep their rules, by letter.
class Values {
 public:
  void set(char letter, double value) { values_[static_cast<size_t>(letter - 'A')] = value; }
  bool has(char letter) const { return get(letter).has_value(); }
  std::optional<double> get(char letter) const { return values_[static_cast<size_t>(letter - 'A')]; }
  double get(char letter, double otherwise) const { return get(letter).value_or(otherwise); }
  int whole(char letter) const { return static_cast<int>(get(letter, 0.0)); }

 private:
  std::array<std::optional<double>, 26> values_;
};

/// A block whose words have passed the first two steps.
struct CheckedBlock {
  Action action = Action::kNone;
  int line = 0;
  int action_column = 0;  ///< of the G word that acts, 0 when there is none
  Values values;
  std::array<int, 100> m_column{};  ///< column of each M word by its number, 0: not there
  const Block* words = nullptr;

  /// Column of the word with this letter, else of the action.
  int column_of(char letter) const;
};

/// Steps 1 and 2: reports words that are unknown ("unknown-word", "unsupported-word"), twice there
/// ("word-twice") or contradict each other ("modal-conflict", "two-motion-words"). Nothing when the block
/// cannot be understood.
std::optional<CheckedBlock> check_conflicts(const Block& block, Reporter& reporter);

/// Step 3: reports words that the action does not take ("unexpected-word"), words it lacks ("missing-word"),
/// and numbers outside their rule ("not-whole-number", "out-of-range"); stores the others in block.values.
void check_words(CheckedBlock& block, Reporter& reporter);

}  // namespace swarf::program
