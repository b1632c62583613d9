#include "program/surface_blocks/rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace swarf::program {
namespace {

bool has_code_letter(const Word& word) {
  return word.letter == 'G' || word.letter == 'M';
}

bool all_known(const Block& block, Reporter& reporter) {
  bool known = true;
  for (const Word& word : block.words) known = check_known(word, block.line, reporter) && known;
  return known;
}

/// The word of `block` before `last` that says the same thing, or null.
const Word* same_word_before(const Block& block, const Word& last) {
  for (const Word& word : block.words) {
    if (&word == &last) break;
    if (word.letter == last.letter && (!has_code_letter(last) || word.value == last.value)) return &word;
  }
  return nullptr;
}

/// The code before `last` of the same modal group, or null.
const Word* same_group_before(const Block& block, const Word& last) {
  const Code* code = find_code(last);
  for (const Word& word : block.words) {
    if (&word == &last || code == nullptr) break;
    const Code* other = find_code(word);
    if (other != nullptr && other->group == code->group) return &word;
  }
  return nullptr;
}

bool check_repeats(const Block& block, Reporter& reporter) {
  const int errors = reporter.errors();
  for (const Word& word : block.words) {
    if (const Word* first = same_word_before(block, word)) {
      reporter.error("word-twice", block.line, word.column,
                     fmt::format("{} stands after {} in the same block", word.text, first->text),
                     fmt::format("keep one {} word",
                                 has_code_letter(word) ? word.text : std::string_view(&word.letter, 1)));
      continue;
    }
    const Word* other = same_group_before(block, word);
    if (other == nullptr) continue;
    const bool motion = find_code(word)->group == Group::kAction;
    reporter.error(motion ? "two-motion-words" : "modal-conflict", block.line, word.column,
                   fmt::format("{} and {} contradict each other in one block", other->text, word.text),
                   motion ? "write them in two blocks" : "keep the one that is meant");
  }
  return reporter.errors() == errors;
}

/// What G10 does follows from its L word.
std::optional<Action> data_action(const Block& block, const Word& g10, Reporter& reporter) {
  const char* kinds = "L70 opens a surface, L71 and L72 give coefficients and control points, L79 closes it";
  const Word* kind = find_word(block, 'L');
  if (kind == nullptr) {
    reporter.error("missing-word", block.line, g10.column, "G10 needs L, the kind of its data", kinds);
    return std::nullopt;
  }
  if (!kind->valid) return std::nullopt;
  if (const auto action = action_of_data_kind(kind->value)) return action;
  const std::string other = other_data_kind(kind->value);
  if (other.empty()) {
    reporter.error("unknown-word", block.line, kind->column, fmt::format("G10 {} is not known", kind->text),
                   kinds);
  } else {
    reporter.error("unsupported-word", block.line, kind->column,
                   fmt::format("G10 {} ({}) is known on controls, but surface programs do not have it",
                               kind->text, other),
                   kinds);
  }
  return std::nullopt;
}

std::optional<Action> action_of(const Block& block, const Word& word, Reporter& reporter) {
  if (word.value == 10.0) return data_action(block, word, reporter);
  if (word.value == 6.5) return Action::kFlankPass;
  return word.value == 6.3 ? Action::kArea : Action::kIsoPass;
}

const WordRule* find_rule(Action action, char letter) {
  for (const auto rules : {rules_of(action), modal_rules()}) {
    const auto found =
        std::find_if(rules.begin(), rules.end(), [&](const WordRule& r) { return r.letter == letter; });
    if (found != rules.end()) return &*found;
  }
  return nullptr;
}

std::string range_of(const WordRule& rule) {
  const char* whole = rule.whole ? "a whole number " : "";
  const bool bounded = rule.high < std::numeric_limits<double>::max();
  if (rule.above_low) {
    const std::string top = bounded ? fmt::format(" and at most {:.10g}{}", rule.high, rule.unit) : "";
    return fmt::format("{}above {:g}{}{}", whole, rule.low, rule.unit, top);
  }
  return fmt::format("{}from {:g} to {:.10g}{}", whole, rule.low, rule.high, rule.unit);
}

bool keeps_range(const WordRule& rule, double value) {
  // The outward sign has no middle.
  if (rule.letter == 'D') return value == 1.0 || value == -1.0;
  return value <= rule.high && (rule.above_low ? value > rule.low : value >= rule.low);
}

void check_value(CheckedBlock& block, const Word& word, const WordRule& rule, Reporter& reporter) {
  const std::string fix = fmt::format("write {}", rule.example);
  if (rule.whole && word.value != std::floor(word.value)) {
    reporter.error("not-whole-number", block.line, word.column,
                   fmt::format("{}: the {} must be a whole number", word.text, rule.meaning), fix);
  } else if (!keeps_range(rule, word.value)) {
    const std::string range = rule.letter == 'D' ? "+1 or -1" : range_of(rule);
    reporter.error("out-of-range", block.line, word.column,
                   fmt::format("{}: the {} must be {}", word.text, rule.meaning, range), fix);
  } else {
    block.values.set(word.letter, word.value);
  }
}

void check_word(CheckedBlock& block, const Word& word, Reporter& reporter) {
  const bool data_kind = word.letter == 'L' && block.action != Action::kArea &&
                         block.action != Action::kNone && block.action != Action::kIsoPass;
  if (has_code_letter(word) || data_kind) return;
  const WordRule* rule = find_rule(block.action, word.letter);
  if (rule == nullptr) {
    std::string taken;
    for (const WordRule& r : rules_of(block.action)) taken += fmt::format(" {}", r.letter);
    reporter.error("unexpected-word", block.line, word.column,
                   fmt::format("{} does not belong in {}", word.text, name_of(block.action)),
                   taken.empty() ? "such a block takes N, G, M, T, S and F words only"
                                 : fmt::format("{} takes{}", name_of(block.action), taken));
  } else if (word.valid) {
    check_value(block, word, *rule, reporter);
  }
}

void check_missing(const CheckedBlock& block, Reporter& reporter) {
  for (const WordRule& rule : rules_of(block.action)) {
    if (!rule.required || find_word(*block.words, rule.letter) != nullptr) continue;
    reporter.error("missing-word", block.line, block.action_column,
                   fmt::format("{} needs {}, the {}", name_of(block.action), rule.letter, rule.meaning),
                   fmt::format("add {}", rule.example));
  }
  const auto present = [&](char letter) { return find_word(*block.words, letter) != nullptr; };
  if (block.action == Action::kPowerCoefficient && !present('X') && !present('Y') && !present('Z')) {
    reporter.error("missing-word", block.line, block.action_column,
                   "G10 L71 gives no coefficient: X, Y and Z are missing",
                   "add X, Y or Z in mm; those left out are 0");
  }
}

void check_block_number(const CheckedBlock& block, Reporter& reporter) {
  const Word* number = find_word(*block.words, 'N');
  if (number == nullptr || number == &block.words->words.front()) return;
  reporter.error("unexpected-word", block.line, number->column,
                 fmt::format("{} stands inside the block", number->text), "the block number N comes first");
}

}  // namespace

int CheckedBlock::column_of(char letter) const {
  const Word* word = find_word(*words, letter);
  return word != nullptr ? word->column : action_column;
}

std::optional<CheckedBlock> check_conflicts(const Block& block, Reporter& reporter) {
  if (!all_known(block, reporter)) return std::nullopt;
  if (!check_repeats(block, reporter)) return std::nullopt;
  CheckedBlock checked;
  checked.line = block.line;
  checked.words = &block;
  for (const Word& word : block.words) {
    const Code* code = find_code(word);
    if (code == nullptr) continue;
    if (code->letter == 'M') checked.m_column[static_cast<size_t>(code->number)] = word.column;
    if (code->group != Group::kAction) continue;
    const auto action = action_of(block, word, reporter);
    if (!action) return std::nullopt;
    checked.action = *action;
    checked.action_column = word.column;
  }
  return checked;
}

void check_words(CheckedBlock& block, Reporter& reporter) {
  check_block_number(block, reporter);
  for (const Word& word : block.words->words) check_word(block, word, reporter);
  check_missing(block, reporter);
}

}  // namespace swarf::program
