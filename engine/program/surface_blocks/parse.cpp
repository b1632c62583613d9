// The interpreter of surface programs (theory 1.6). Each block goes through four steps:
//
//   words (nc_lexer) -> modal conflicts (block_rules) -> rules (block_rules, here) -> apply (here)
//
// Nothing changes before the whole block has passed. A block that fails leaves the state as it was and marks
// what it would have changed as suspect, so that its consequences are not reported as errors of later blocks.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "program/source_text.h"
#include "program/surface_blocks/operations.h"
#include "program/surface_blocks/program.h"
#include "program/surface_blocks/table.h"

namespace swarf::program {
namespace {

/// What a refused block would have changed.
struct Suspects {
  bool tool = false, spindle = false, feed = false, operation = false, all_surfaces = false,
       program_end = false;
  std::set<int> surfaces;

  bool has_surface(int number) const { return all_surfaces || surfaces.count(number) != 0; }
};

class Interpreter {
 public:
  Interpreter(const std::string& file, Purpose purpose, Diagnostics& diagnostics)
      : reporter_(diagnostics, file), purpose_(purpose) {
    program_.file = file;
  }

  Program run(const std::string& text) {
    if (!check_text(
            text, reporter_,
            "give a program with a surface (G10 L70 ... L79) and an operation (G06.3, G06.4 or G06.5)"))
      return std::move(program_);
    int line_number = 0;
    for (const std::string_view line : split_lines(text)) {
      read_block(lex_line(line, ++line_number, reporter_));
      if (reporter_.full() || words_after_end_) break;
    }
    if (!reporter_.full()) finish();
    return std::move(program_);
  }

 private:
  void read_block(const Block& block) {
    if (block.percent) {
      // The first '%' opens the tape, the next one ends it.
      tape_ended_ = program_.blocks > 0 || tape_begun_;
      tape_begun_ = true;
    }
    if (!block.complete) suspect_everything();
    if (block.words.empty()) return;
    ++program_.blocks;
    last_line_ = block.line;
    if (end_line_ > 0 || tape_ended_) {
      reporter_.error("words-after-end", block.line, block.words.front().column,
                      fmt::format("{} stands after the end of the program ({})", block.words.front().text,
                                  end_line_ > 0 ? fmt::format("line {}", end_line_) : "the second '%'"),
                      "remove what follows, or move the end of the program");
      words_after_end_ = true;
      return;
    }
    if (!interpret(block)) suspect(block);
  }

  /// Steps 2 to 4; false when the block was refused.
  bool interpret(const Block& block) {
    const int errors = reporter_.errors();
    auto checked = check_conflicts(block, reporter_);
    if (!checked) return false;
    check_words(*checked, reporter_);
    const Modal modal = modal_after(*checked, modal_, reporter_);
    const auto shape = check_action(*checked, modal);
    if (reporter_.errors() != errors || has_refused_words(block) || touches_suspect_surface(*checked))
      return false;
    apply(*checked, modal, shape);
    return true;
  }

  static bool has_refused_words(const Block& block) {
    for (const Word& word : block.words) {
      if (!word.valid) return true;
    }
    return !block.complete;
  }

  /// Step 3 against the state so far; the finished surface of a G10 L79.
  std::shared_ptr<const surface::PolynomialSurface> check_action(const CheckedBlock& block,
                                                                 const Modal& modal) {
    const bool cuts = is_cut(block.action);
    if (cuts) check_ready_to_cut(trusted(modal), block, reporter_);
    if (block.action == Action::kNone || !block.values.has('P') || touches_suspect_surface(block))
      return nullptr;
    if (block.action == Action::kOpenSurface) {
      check_open_surface(table_, block, reporter_);
      return nullptr;
    }
    const SurfaceEntry* entry = known_surface(block);
    if (entry == nullptr) return nullptr;
    if (cuts) {
      check_closed(*entry, block);
      check_flank(*entry, block);
    } else if (block.action == Action::kCloseSurface) {
      return check_close_surface(*entry, block, reporter_);
    } else {
      check_coefficient(*entry, block, reporter_);
    }
    return nullptr;
  }

  /// Modal words for the checks: what a refused block should have set counts as set.
  Modal trusted(Modal modal) const {
    if (suspects_.tool) modal.loaded_tool = std::max(modal.loaded_tool, 1);
    if (suspects_.feed) modal.feed_mm_min = std::max(modal.feed_mm_min, 1.0);
    if (suspects_.spindle) {
      modal.spindle_on = true;
      modal.speed_rpm = std::max(modal.speed_rpm, 1.0);
    }
    return modal;
  }

  const SurfaceEntry* known_surface(const CheckedBlock& block) {
    const int number = block.values.whole('P');
    const auto found = table_.find(number);
    if (found != table_.end()) return &found->second;
    std::string open;
    for (const auto& [other, entry] : table_) open += fmt::format("{}P{}", open.empty() ? "" : ", ", other);
    reporter_.error("surface-unknown", block.line, block.column_of('P'),
                    fmt::format("surface {} is not known: no G10 L70 P{} stands before", number, number),
                    open.empty() ? fmt::format("open it first: G10 L70 P{} Q3 R3", number)
                                 : fmt::format("known are {}; or open it with G10 L70 P{}", open, number));
    suspects_.surfaces.insert(number);
    return nullptr;
  }

  void check_closed(const SurfaceEntry& entry, const CheckedBlock& block) {
    if (entry.closed()) return;
    const int number = block.values.whole('P');
    reporter_.error("surface-not-closed", block.line, block.column_of('P'),
                    fmt::format("surface {}, opened in line {}, is not closed yet", number, entry.where.line),
                    fmt::format("write G10 L79 P{} D1 before this block", number));
    suspects_.surfaces.insert(number);
  }

  /// The side of a tool follows a ruled surface, and no other operation of the same program does.
  void check_flank(const SurfaceEntry& entry, const CheckedBlock& block) {
    const bool flank = block.action == Action::kFlankPass;
    if (flank && entry.degree_v != 1)
      reporter_.error("flank-needs-ruled", block.line, block.column_of('P'),
                      fmt::format("surface {} has degree {} in v: G06.5 mills ruled surfaces, which are "
                                  "straight along v",
                                  block.values.whole('P'), entry.degree_v),
                      "write R1 in its G10 L70, with its rulings along v; or use G06.3");
    for (const Operation& before : program_.operations) {
      if ((before.kind == OperationKind::kFlank) == flank) continue;
      reporter_.error(
          "mixed-operations", block.line, block.action_column,
          fmt::format("{} stands in one program with the operation of line {}: one mills with the "
                      "side of the tool, the other with its end",
                      name_of(block.action), before.where.line),
          "write two programs, and two set-ups that run them");
      return;
    }
  }

  bool touches_suspect_surface(const CheckedBlock& block) const {
    return block.action != Action::kNone && suspects_.has_surface(block.values.whole('P'));
  }

  /// Step 4.
  void apply(const CheckedBlock& block, const Modal& modal,
             const std::shared_ptr<const surface::PolynomialSurface>& shape) {
    modal_ = modal;
    const int number = block.values.whole('P');
    switch (block.action) {
      case Action::kNone:
        break;
      case Action::kOpenSurface:
        open_surface(table_, block, reporter_);
        break;
      case Action::kPowerCoefficient:
      case Action::kBezierPoint:
        add_coefficient(table_.at(number), block);
        break;
      case Action::kCloseSurface:
        close_surface(number, block.line, shape);
        break;
      case Action::kArea:
      case Action::kIsoPass:
      case Action::kFlankPass:
        program_.operations.push_back(make_operation(modal, block, table_.at(number), reporter_));
        break;
    }
    if (block.m_column[2] > 0 || block.m_column[30] > 0) end_line_ = block.line;
  }

  void close_surface(int number, int line, std::shared_ptr<const surface::PolynomialSurface> shape) {
    SurfaceEntry& entry = table_.at(number);
    entry.index = static_cast<int>(program_.surfaces.size());
    entry.closed_line = line;
    program_.surfaces.push_back({number, std::move(shape), entry.where});
  }

  void suspect(const Block& block) {
    for (const Word& word : block.words) {
      suspects_.tool =
          suspects_.tool || word.letter == 'T' || (word.letter == 'M' && (!word.valid || word.value == 6.0));
      suspects_.spindle = suspects_.spindle || word.letter == 'S' || word.letter == 'M';
      suspects_.feed = suspects_.feed || word.letter == 'F';
      suspects_.program_end = suspects_.program_end || word.letter == 'M';
      // An unknown G word may have been meant as an operation.
      suspects_.operation =
          suspects_.operation || (word.letter == 'G' && !(word.valid && word.value == 10.0));
    }
    const Word* number = find_word(block, 'P');
    if (number != nullptr && number->valid && std::abs(number->value) <= kMaxNumber) {
      suspects_.surfaces.insert(static_cast<int>(number->value));
    } else if (find_word(block, 'G') != nullptr) {
      suspects_.all_surfaces = true;
    }
  }

  void suspect_everything() {
    suspects_.tool = suspects_.spindle = suspects_.feed = suspects_.operation = true;
    suspects_.all_surfaces = suspects_.program_end = true;
  }

  /// What only the end of the file can tell.
  void finish() {
    for (const auto& [number, entry] : table_) {
      if (entry.closed() || suspects_.has_surface(number)) continue;
      reporter_.error("surface-not-closed", entry.where.line, entry.where.column,
                      fmt::format("surface {} is never closed", number),
                      fmt::format("write G10 L79 P{} D1", number));
    }
    if (purpose_ == Purpose::kDesign) {
      if (table_.empty()) {
        reporter_.error("no-surface", 0, 0, "the file describes no surface",
                        "write one between G10 L70 and G10 L79");
      }
    } else if (program_.operations.empty() && !suspects_.operation) {
      reporter_.error(
          "no-operation", 0, 0, "the program has no operation: it cuts nothing",
          "add G06.3 (whole surface), G06.4 (one pass) or G06.5 (flank) after the surface is closed");
    }
    if (end_line_ == 0 && !words_after_end_ && !suspects_.program_end) {
      reporter_.warning("no-program-end", last_line_, 0, "the program ends without M30 or M2",
                        "add M30 as the last block");
    }
  }

  Reporter reporter_;
  Purpose purpose_;
  Program program_;
  Modal modal_;
  SurfaceTable table_;
  Suspects suspects_;
  int last_line_ = 0;
  int end_line_ = 0;  ///< of M30 or M2, 0 before
  bool tape_begun_ = false;
  bool tape_ended_ = false;
  bool words_after_end_ = false;
};

}  // namespace

Program parse_surface_blocks(const std::string& text, const std::string& file, Diagnostics& diagnostics,
                             Purpose purpose) {
  return Interpreter(file, purpose, diagnostics).run(text);
}

Program load_program(const std::string& path, Diagnostics* warnings) {
  Diagnostics diagnostics;
  Program program = parse_surface_blocks(read_file(path), path, diagnostics);
  diagnostics.throw_if_errors();
  if (warnings != nullptr) *warnings = std::move(diagnostics);
  return program;
}

bool mills_by_flank(const std::string& path) {
  try {
    const Program program = load_program(path);
    return program.operations.front().kind == OperationKind::kFlank;
  } catch (const InputError&) {
    return false;
  }
}

std::vector<SurfaceDefinition> load_surfaces(const std::string& path) {
  Diagnostics diagnostics;
  Program program = parse_surface_blocks(read_file(path), path, diagnostics, Purpose::kDesign);
  diagnostics.throw_if_errors();
  return std::move(program.surfaces);
}

}  // namespace swarf::program
