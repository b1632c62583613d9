// Subprograms and macros: M98, M198, M99, G65, G66, G67.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "program/fanuc/reader.h"

namespace swarf::program::nc::fanuc {
namespace {

/// Levels of the 30i: subprograms and macros together, and macros with variables of their own.
constexpr size_t kCallsMax = 15, kMacrosMax = 5;
constexpr int kArgumentSets = 10;

/// Variables of arguments I: every letter but G L N O P; 0 for those. I J K count on by three in each set.
constexpr std::array<int, 26> kArgumentOf{1, 2, 3, 7,  8,  9,  0,  11, 4,  5,  6,  0,  13,
                                          0, 0, 0, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26};

}  // namespace

const Fanuc::Known* Fanuc::scan(LineSource& in, int number) {
  const LineSource::Mark back = in.mark();
  const std::string kept(reader_.line());
  const size_t at = reader_.at();
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
    programs_.push_back({number, &in, in.mark()});
    found = &programs_.back();
  }
  in.seek(back);
  kept_line_ = kept;
  reader_.begin(kept_line_);
  reader_.move_to(at);
  return found;
}

/// `external`: M198, which does not look into the file of the program itself.
const Fanuc::Known* Fanuc::find_program(int number, bool external) {
  LineSource* own = sources_.front().get();
  for (const Known& one : programs_) {
    if (one.number == number && !(external && one.source == own)) return &one;
  }
  if (!external) {
    if (const Known* here = scan(*own, number)) return here;
  }
  for (const std::string& name :
       {fmt::format("O{:04}", number), fmt::format("O{}", number), fmt::format("{}", number)}) {
    const std::string file = find_subprogram(path_, control_.setup, name,
                                             {"", ".nc", ".NC", ".tap", ".TAP", ".cnc", ".txt", ".TXT"});
    if (file.empty()) continue;
    if (const Known* there = scan(open(file), number)) return there;
  }
  return nullptr;
}

void Fanuc::call(int number, long times, int column, const Call* macro, bool external) {
  if (times == 0) return;
  const Known* program = find_program(number, external);
  if (program == nullptr)
    control_.report.fail(
        "unknown-subprogram", column,
        external ? fmt::format("O{:04} is called from another device, and no file O{:04} with the "
                               "line O{:04} stands beside the program",
                               number, number, number)
                 : fmt::format("O{:04} is called, and it is neither in this file nor in one named "
                               "O{:04} with the line O{:04}",
                               number, number, number),
        "add the subprogram, or give the folder of its file");
  const auto macros = static_cast<size_t>(
      std::count_if(calls_.begin(), calls_.end(), [](const Call& one) { return one.own_locals; }));
  if (calls_.size() > kCallsMax || (macro != nullptr && macros > kMacrosMax))
    control_.report.fail(
        "recursion-limit", column,
        fmt::format("more than {} subprograms or {} macros call each other here", kCallsMax, kMacrosMax),
        "end the recursion with a condition");
  nc::jump(control_);
  Call next;
  if (macro != nullptr)
    next = *macro;
  else
    next.modals = calls_.back().modals;
  next.back = source().mark();
  next.source = program->source;
  next.top = program->body;
  next.left = times - 1;
  next.source->seek(next.top);
  calls_.push_back(std::move(next));
}

void Fanuc::leave(int column) {
  Call& here = calls_.back();
  if (here.left > 0) {
    --here.left;
    nc::jump(control_);
    here.source->seek(here.top);
    return;
  }
  const LineSource::Mark back = here.back;
  if (here.modal >= 0) {
    // Arguments are set in the G66 block alone: what the macro leaves in its variables stays.
    Modal& modal = modals_[static_cast<size_t>(here.modal)];
    modal.locals = here.locals;
    modal.assigned = here.assigned;
  } else {
    calls_[calls_.size() - 2].modals = here.modals;
  }
  calls_.pop_back();
  source().seek(back);
  if (block_.has('P')) go_to(whole(block_, 'P', 1, 99999999, reader_, control_), column);
}

/// Arguments I give each letter its variable; I J K that stand again, or out of order, begin the next set of
/// arguments II (#4 #5 #6, #7 #8 #9 ..). Where both name one variable the later word holds.
void Fanuc::read_arguments(int g_group, Call& macro) {
  struct Word {
    char letter;
    double value;
    size_t place;
  };
  std::array<Word, 26 + kRepeatsMax> words{};
  size_t count = 0;
  for (char letter = 'A'; letter <= 'Z'; ++letter) {
    if (block_.has(letter) && kArgumentOf[static_cast<size_t>(letter - 'A')] != 0)
      words[count++] = {letter, block_.get(letter), block_.place(letter)};
  }
  for (int i = 0; i < block_.repeat_count; ++i) {
    const auto& again = block_.repeats[static_cast<size_t>(i)];
    words[count++] = {again.letter, again.value, again.place};
  }
  std::sort(words.begin(), words.begin() + static_cast<long>(count),
            [](const Word& a, const Word& b) { return a.place < b.place; });
  int set = 0, last = -1;
  for (size_t i = 0; i < count; ++i) {
    const Word& word = words[i];
    if (word.place < block_.g_places[static_cast<size_t>(g_group)])
      control_.report.fail("unexpected-word", reader_.column_of(word.place),
                           fmt::format("the argument {} stands before G65 or G66", word.letter),
                           "write G65 P and L first, then the arguments");
    int variable = kArgumentOf[static_cast<size_t>(word.letter - 'A')];
    if (word.letter >= 'I' && word.letter <= 'K') {
      if (word.letter - 'I' <= last) ++set;
      last = word.letter - 'I';
      if (set >= kArgumentSets)
        control_.report.fail("word-twice", reader_.column_of(word.place),
                             fmt::format("more than {} sets of I J K as arguments", kArgumentSets),
                             "pass the others in variables from #100");
      variable += 3 * set;
    }
    macro.locals[static_cast<size_t>(variable)] = word.value;
    macro.assigned |= uint64_t{1} << variable;
  }
}

/// G65 and G66 stand alone with their arguments.
Fanuc::Call Fanuc::macro_call(int g_group, const char* word) {
  if (block_.g_given != 1u << g_group || block_.free_g > 0 || block_.m_count > 0)
    control_.report.fail("modal-conflict", g_column(g_group),
                         fmt::format("another code stands with {}", word), "write it in a block of its own");
  need('P', word);
  Call macro;
  macro.own_locals = true;
  read_arguments(g_group, macro);
  return macro;
}

void Fanuc::call_macro() {
  Call macro = macro_call(kFanucOneShot, "G65");
  macro.modals = calls_.back().modals;
  const long times = block_.has('L') ? whole(block_, 'L', 0, 9999, reader_, control_) : 1;
  call(whole(block_, 'P', 1, 99999999, reader_, control_), times, g_column(kFanucOneShot), &macro, false);
}

/// G66 and G67. Several G66 nest: the last one is called after the moves, the one before after its moves.
void Fanuc::set_modal_macro() {
  const int at = g_column(kFanucMacro);
  const bool inside =
      std::any_of(calls_.begin(), calls_.end(), [](const Call& one) { return one.modal >= 0; });
  if (inside)
    control_.report.fail("unsupported-word", at, "G66 and G67 stand in a macro that G66 calls",
                         "set and cancel modal macros outside of them");
  if (block_.g[kFanucMacro] == 670) {
    if (!modals_.empty()) modals_.pop_back();
  } else {
    const Call macro = macro_call(kFanucMacro, "G66");
    const int number = whole(block_, 'P', 1, 99999999, reader_, control_);
    const long times = block_.has('L') ? whole(block_, 'L', 0, 9999, reader_, control_) : 1;
    modals_.push_back({number, times, macro.locals, macro.assigned});
  }
  calls_.back().modals = modals_.size();
}

/// After a block with a move.
void Fanuc::call_modal_macro() {
  const int at = reader_.column_of(block_.first);
  const int ends[] = {20, 300, 980, 990, 1980};
  if (std::any_of(std::begin(ends), std::end(ends), [&](int code) { return block_.has_m(code); }))
    control_.report.fail("modal-conflict", at,
                         "a move that calls the macro of G66 stands with a call or an end of the program",
                         "write them in two blocks");
  Call macro;
  macro.modals = calls_.back().modals - 1;
  macro.modal = static_cast<int>(macro.modals);
  const Modal& modal = modals_[macro.modals];
  macro.own_locals = true;
  macro.locals = modal.locals;
  macro.assigned = modal.assigned;
  call(modal.number, modal.times, at, &macro, false);
}

/// P0030100 calls O0100 three times; with L, P is the number alone.
void Fanuc::call_subprogram(int column, bool external) {
  need('P', external ? "M198" : "M98");
  const int p = whole(block_, 'P', 1, 99999999, reader_, control_);
  const bool counted = p > 9999 && !block_.has('L');
  const long times = counted           ? p / 10000
                     : block_.has('L') ? whole(block_, 'L', 0, 9999, reader_, control_)
                                       : 1;
  const int number = counted ? p % 10000 : p;
  if (counted && times > 0 && find_program(number, external) == nullptr &&
      find_program(p, external) != nullptr)
    control_.report.fail(
        "unknown-subprogram", this->column('P'),
        fmt::format("P{} without L calls O{:04} {} times, and there is only O{}", p, number, times, p),
        fmt::format("write P{} L1", p));
  call(number, times, column, nullptr, external);
}

bool Fanuc::apply_calls() {
  for (int i = 0; i < block_.m_count; ++i) {
    const int code = block_.m[static_cast<size_t>(i)];
    const int at = reader_.column_of(block_.m_places[static_cast<size_t>(i)]);
    if (code == 20 || code == 300) return false;
    if (code == 980 || code == 1980) {
      call_subprogram(at, code == 1980);
      return true;
    }
    if (code != 990) continue;
    if (calls_.size() > 1) {
      leave(at);
      return true;
    }
    if (block_.has('P')) {
      go_to(whole(block_, 'P', 1, 99999999, reader_, control_), at);
      return true;
    }
    control_.report.warn_once("main-program-repeats", at,
                              "M99 repeats the main program for ever; it was run once",
                              "end it with M30 where that is meant");
    return false;
  }
  return true;
}

}  // namespace swarf::program::nc::fanuc
