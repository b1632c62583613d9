// Subprograms and macros: M98, M198, M99, G65, G66, G67.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "program/fanuc/steps.h"

namespace swarf::program::nc::fanuc {
namespace {

constexpr int kArgumentSets = 10;

/// Variables of arguments I: every letter but G L N O P; 0 for those. I J K count on by three in each set.
constexpr std::array<int, 26> kArgumentOf{1, 2, 3, 7,  8,  9,  0,  11, 4,  5,  6,  0,  13,
                                          0, 0, 0, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26};

const Known* scan(Calls& calls, LetterDialect& letters, LineSource& in, int number) {
  const LineSource::Mark back = in.mark();
  const std::string kept(letters.reader.line());
  const size_t at = letters.reader.at();
  in.seek({});
  const Known* found = nullptr;
  std::string_view line;
  while (found == nullptr && in.next(line)) {
    const size_t start = line.find_first_not_of(" \t");
    if (start == std::string_view::npos || (line[start] != 'O' && line[start] != 'o' && line[start] != ':'))
      continue;
    double value = 0.0;
    const size_t length = read_number(line.substr(start + 1), value);
    if (length == 0 || length == std::string_view::npos || value != number) continue;
    calls.known.push_back({number, &in, in.mark()});
    found = &calls.known.back();
  }
  in.seek(back);
  letters.kept_line = kept;
  letters.reader.begin(letters.kept_line);
  letters.reader.move_to(at);
  return found;
}

/// "O0012".
std::string program_name(const Rules& rules, int number) {
  return fmt::format("O{:0{}}", number, rules.program_digits);
}

/// `external`: M198, which does not look into the file of the program itself.
const Known* find_program(Calls& calls, LetterDialect& letters, const Rules& rules, int number,
                          bool external) {
  LineSource* own = letters.sources.front().get();
  for (const Known& one : calls.known) {
    if (one.number == number && !(external && one.source == own)) return &one;
  }
  if (!external) {
    if (const Known* here = scan(calls, letters, *own, number)) return here;
  }
  for (const std::string& name :
       {program_name(rules, number), fmt::format("O{}", number), fmt::format("{}", number)}) {
    const std::string file = find_subprogram(letters.path, letters.control.setup, name,
                                             {"", ".nc", ".NC", ".tap", ".TAP", ".cnc", ".txt", ".TXT"});
    if (file.empty()) continue;
    if (const Known* there = scan(calls, letters, letters.open(file), number)) return there;
  }
  return nullptr;
}

/// The program goes on at `program`, which is called `times` times.
void enter(Fanuc& fanuc, const Known& program, long times, int column, const Call* macro) {
  Calls& calls = fanuc.calls;
  const size_t macros = calls.stack.count([](const Call& one) { return one.own_locals; });
  if (calls.stack.full(fanuc.rules.calls_max) || (macro != nullptr && macros > fanuc.rules.macros_max))
    fanuc.control.report.fail(kRecursionLimit, column,
                              fmt::format("more than {} subprograms or {} macros call each other here",
                                          fanuc.rules.calls_max, fanuc.rules.macros_max),
                              "end the recursion with a condition");
  nc::jump(fanuc.control);
  Call next;
  if (macro != nullptr)
    next = *macro;
  else
    next.modals = calls.stack.top().modals;
  next.back = source(calls).mark();
  next.source = program.source;
  next.top = next.head = program.body;
  next.left = times - 1;
  next.source->seek(next.top);
  calls.stack.enter(std::move(next));
}

void call(Fanuc& fanuc, int number, long times, int column, const Call* macro, bool external) {
  if (times == 0) return;
  const Known* program = find_program(fanuc.calls, fanuc, fanuc.rules, number, external);
  if (program == nullptr) {
    const std::string name = program_name(fanuc.rules, number);
    fanuc.control.report.fail(
        "unknown-subprogram", column,
        external ? fmt::format("{0} is called from another device, and no file {0} with the line {0} stands "
                               "beside the program",
                               name)
                 : fmt::format("{0} is called, and it is neither in this file nor in one named {0} with the "
                               "line {0}",
                               name),
        "add the subprogram, or give the folder of its file");
  }
  enter(fanuc, *program, times, column, macro);
}

/// M97 P, and M98 with a block number: the subprogram begins at that block of `program`.
void call_label(Fanuc& fanuc, const Known& program, char letter, long times, int column) {
  if (times == 0) return;
  const long label = whole(fanuc.block, letter, 1, 99999999, fanuc.reader, fanuc.control);
  const std::optional<LineSource::Mark> begin = find_label(*program.source, program.body, label);
  if (!begin)
    fanuc.control.report.fail("unknown-label", column,
                              fmt::format("{}{}: there is no block N{}", letter, label, label),
                              "add the block number");
  enter(fanuc, {program.number, program.source, *begin}, times, column, nullptr);
  fanuc.calls.stack.top().head = program.body;
}

void leave(Calls& calls, LetterDialect& letters, int column) {
  Call& here = calls.stack.top();
  if (here.left > 0) {
    --here.left;
    nc::jump(letters.control);
    here.source->seek(here.top);
    return;
  }
  const LineSource::Mark back = here.back;
  if (here.modal >= 0) {
    // Arguments are set in the G66 block alone: what the macro leaves in its variables stays.
    Modal& modal = calls.modal[static_cast<size_t>(here.modal)];
    modal.locals = here.locals;
    modal.assigned = here.assigned;
  } else {
    calls.stack.caller().modals = here.modals;
  }
  calls.stack.leave();
  source(calls).seek(back);
  if (letters.block.has('P'))
    go_to(calls, letters, whole(letters.block, 'P', 1, 99999999, letters.reader, letters.control), column);
}

/// Arguments I give each letter its variable; I J K that stand again, or out of order, begin the next set of
/// arguments II (#4 #5 #6, #7 #8 #9 ..). Where both name one variable the later word holds.
void read_arguments(LetterDialect& letters, int g_group, Call& macro) {
  struct Word {
    char letter;
    double value;
    size_t place;
  };
  std::array<Word, 26 + kRepeatsMax> words{};
  size_t count = 0;
  for (char letter = 'A'; letter <= 'Z'; ++letter) {
    if (letters.block.has(letter) && kArgumentOf[static_cast<size_t>(letter - 'A')] != 0)
      words[count++] = {letter, letters.block.get(letter), letters.block.place(letter)};
  }
  for (int i = 0; i < letters.block.repeat_count; ++i) {
    const auto& again = letters.block.repeats[static_cast<size_t>(i)];
    words[count++] = {again.letter, again.value, again.place};
  }
  std::sort(words.begin(), words.begin() + static_cast<long>(count),
            [](const Word& a, const Word& b) { return a.place < b.place; });
  int set = 0, last = -1;
  for (size_t i = 0; i < count; ++i) {
    const Word& word = words[i];
    if (word.place < letters.block.g_places[static_cast<size_t>(g_group)])
      letters.control.report.fail("unexpected-word", letters.reader.column_of(word.place),
                                  fmt::format("the argument {} stands before G65 or G66", word.letter),
                                  "write G65 P and L first, then the arguments");
    int variable = kArgumentOf[static_cast<size_t>(word.letter - 'A')];
    if (word.letter >= 'I' && word.letter <= 'K') {
      if (word.letter - 'I' <= last) ++set;
      last = word.letter - 'I';
      if (set >= kArgumentSets)
        letters.control.report.fail("word-twice", letters.reader.column_of(word.place),
                                    fmt::format("more than {} sets of I J K as arguments", kArgumentSets),
                                    "pass the others in variables from #100");
      variable += 3 * set;
    }
    macro.locals[static_cast<size_t>(variable)] = word.value;
    macro.assigned |= uint64_t{1} << variable;
  }
}

/// G65 and G66 stand alone with their arguments.
Call macro_call(LetterDialect& letters, int g_group, const char* word) {
  if (letters.block.g_given != 1u << g_group || letters.block.free_g > 0 || letters.block.m_count > 0)
    letters.control.report.fail("modal-conflict", letters.g_column(g_group),
                                fmt::format("another code stands with {}", word),
                                "write it in a block of its own");
  letters.need('P', word);
  Call macro;
  macro.own_locals = true;
  read_arguments(letters, g_group, macro);
  return macro;
}

long repeats_of(LetterDialect& letters) {
  return letters.block.has('L') ? whole(letters.block, 'L', 0, 9999, letters.reader, letters.control) : 1;
}

/// P0030100 calls O0100 three times; with L, P is the number alone.
void call_subprogram(Fanuc& fanuc, int column, bool external) {
  fanuc.need('P', external ? "M198" : "M98");
  const int p = whole(fanuc.block, 'P', 1, 99999999, fanuc.reader, fanuc.control);
  const bool counted = fanuc.rules.counted_calls && p > 9999 && !fanuc.block.has('L');
  const long times = counted ? p / 10000 : repeats_of(fanuc);
  const int number = counted ? p % 10000 : p;
  const auto found = [&](int of) { return find_program(fanuc.calls, fanuc, fanuc.rules, of, external); };
  if (counted && times > 0 && found(number) == nullptr && found(p) != nullptr)
    fanuc.control.report.fail(
        "unknown-subprogram", fanuc.column('P'),
        fmt::format("P{} without L calls O{:04} {} times, and there is only O{}", p, number, times, p),
        fmt::format("write P{} L1", p));
  const char label = fanuc.rules.call_label;
  if (label != '\0' && fanuc.block.has(label)) {
    const Known* program = found(number);
    if (program != nullptr) return call_label(fanuc, *program, label, times, column);
  }
  call(fanuc, number, times, column, nullptr, external);
}

}  // namespace

void call_macro(Fanuc& fanuc) {
  Call macro = macro_call(fanuc, kFanucOneShot, "G65");
  macro.modals = fanuc.calls.stack.top().modals;
  const long times = repeats_of(fanuc);
  call(fanuc, whole(fanuc.block, 'P', 1, 99999999, fanuc.reader, fanuc.control), times,
       fanuc.g_column(kFanucOneShot), &macro, false);
}

/// G66 and G67. Several G66 nest: the last one is called after the moves, the one before after its moves.
void set_modal_macro(Calls& calls, LetterDialect& letters) {
  const int at = letters.g_column(kFanucMacro);
  const bool inside = calls.stack.count([](const Call& one) { return one.modal >= 0; }) > 0;
  if (inside)
    letters.control.report.fail("unsupported-word", at, "G66 and G67 stand in a macro that G66 calls",
                                "set and cancel modal macros outside of them");
  if (letters.block.g[kFanucMacro] == G::kModalMacroOff) {
    if (!calls.modal.empty()) calls.modal.pop_back();
  } else {
    const Call macro = macro_call(letters, kFanucMacro, "G66");
    const int number = whole(letters.block, 'P', 1, 99999999, letters.reader, letters.control);
    const long times = repeats_of(letters);
    calls.modal.push_back({number, times, macro.locals, macro.assigned});
  }
  calls.stack.top().modals = calls.modal.size();
}

/// After a block with a move.
void call_modal_macro(Fanuc& fanuc) {
  const int at = fanuc.reader.column_of(fanuc.block.first);
  const int ends[] = {M::kEnd, M::kEndRewind, M::kCall, M::kReturn, M::kCallFile, M::kCallLocal};
  if (std::any_of(std::begin(ends), std::end(ends), [&](int code) { return fanuc.block.has_m(code); }))
    fanuc.control.report.fail(
        "modal-conflict", at,
        "a move that calls the macro of G66 stands with a call or an end of the program",
        "write them in two blocks");
  Call macro;
  macro.modals = fanuc.calls.stack.top().modals - 1;
  macro.modal = static_cast<int>(macro.modals);
  const Modal& modal = fanuc.calls.modal[macro.modals];
  macro.own_locals = true;
  macro.locals = modal.locals;
  macro.assigned = modal.assigned;
  call(fanuc, modal.number, modal.times, at, &macro, false);
}

bool apply_calls(Fanuc& fanuc) {
  for (int i = 0; i < fanuc.block.m_count; ++i) {
    const int code = fanuc.block.m[static_cast<size_t>(i)];
    const int at = fanuc.reader.column_of(fanuc.block.m_places[static_cast<size_t>(i)]);
    if (code == M::kEnd || code == M::kEndRewind) return false;
    if (code == M::kCall || code == M::kCallFile) {
      call_subprogram(fanuc, at, code == M::kCallFile);
      return true;
    }
    if (code == M::kCallLocal) {
      fanuc.need('P', "M97");
      call_label(fanuc, {0, &source(fanuc.calls), fanuc.calls.stack.top().head}, 'P', repeats_of(fanuc), at);
      return true;
    }
    if (code != M::kReturn) continue;
    if (fanuc.calls.stack.called()) {
      leave(fanuc.calls, fanuc, at);
      return true;
    }
    if (fanuc.block.has('P')) {
      go_to(fanuc.calls, fanuc, whole(fanuc.block, 'P', 1, 99999999, fanuc.reader, fanuc.control), at);
      return true;
    }
    fanuc.control.report.warn_once("main-program-repeats", at,
                                   "M99 repeats the main program for ever; it was run once",
                                   "end it with M30 where that is meant");
    return false;
  }
  return true;
}

}  // namespace swarf::program::nc::fanuc
