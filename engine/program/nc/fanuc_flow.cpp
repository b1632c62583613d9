// Custom macro B: IF, WHILE, GOTO; M98, M99, G65.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/nc/fanuc.h"

namespace swarf::program::nc {
namespace {

constexpr size_t kCallsMax = 15;

}  // namespace

double Fanuc::condition() {
  reader_.skip_space();
  return reader_.bracketed();
}

int Fanuc::loop_number() {
  const size_t place = reader_.at();
  const double number = reader_.value();
  if (number != 1.0 && number != 2.0 && number != 3.0)
    control_.fail("out-of-range", reader_.column_of(place),
                  fmt::format("loops have the numbers 1 to 3, not {:g}", number), "write DO1 to DO3");
  return static_cast<int>(number);
}

bool Fanuc::macro_word() {
  const size_t place = reader_.at();
  auto& loops = calls_.back().loops;
  if (reader_.take("GOTO")) {
    go_to(std::lround(std::clamp(reader_.value(), -1e9, 1e9)), reader_.column_of(place));
    return true;
  }
  if (reader_.take("IF")) {
    const bool holds = condition() != 0.0;
    reader_.skip_space();
    if (reader_.take("GOTO")) {
      const double label = reader_.value();
      if (holds) go_to(std::lround(std::clamp(label, -1e9, 1e9)), reader_.column_of(place));
    } else if (reader_.take("THEN")) {
      reader_.skip_space();
      if (reader_.peek() != '#')
        control_.fail("bad-statement", reader_.column(), "THEN wants an assignment",
                      "write IF [#1 GT 2] THEN #3=4");
      if (holds)
        assignment();
      else
        reader_.move_to(reader_.line().size());
    } else {
      control_.fail("bad-statement", reader_.column(), "GOTO or THEN is missing after the condition",
                    "write IF [#1 GT 2] GOTO 10");
    }
    return true;
  }
  const bool is_while = reader_.take("WHILE");
  if (is_while || reader_.take("DO")) {
    bool holds = true;
    if (is_while) {
      holds = condition() != 0.0;
      reader_.skip_space();
      if (!reader_.take("DO"))
        control_.fail("bad-statement", reader_.column(), "DO is missing after the condition",
                      "write WHILE [#1 GT 2] DO1");
    }
    const int number = loop_number();
    std::erase_if(loops, [&](const auto& one) { return one.first == number; });
    if (holds)
      loops.emplace_back(number, source().line_mark());
    else
      skip_to_end(number);
    if (!holds) reader_.move_to(reader_.line().size());
    return true;
  }
  if (!reader_.take("END")) return false;
  const int number = loop_number();
  if (loops.empty() || loops.back().first != number)
    control_.fail("bad-statement", reader_.column_of(place),
                  fmt::format("END{} ends no loop that is open here", number),
                  "close the innermost DO first");
  control_.jump();
  source().seek(loops.back().second);
  reader_.begin({});
  return true;
}

void Fanuc::skip_to_end(int loop) {
  const Place from = control_.place();
  std::string_view line;
  while (source().next(line)) {
    ++control_.summary().lines;
    control_.at(source().file(), static_cast<int>(source().line_number()), 1);
    reader_.begin(line);
    reader_.skip_space();
    if (!reader_.take("END")) continue;
    reader_.skip_space();
    if (reader_.value() == loop) return;
  }
  control_.at(from.file, from.line, from.column);
  control_.fail("unclosed-loop", 0, fmt::format("DO{} has no END{}", loop, loop), "add the END of the loop");
}

bool Fanuc::labelled(std::string_view line, long label) {
  size_t at = line.find_first_not_of(" \t");
  if (at == std::string_view::npos || (line[at] != 'N' && line[at] != 'n')) return false;
  double number = 0.0;
  at = line.find_first_not_of(" \t", at + 1);
  if (at == std::string_view::npos) return false;
  const size_t length = read_number(line.substr(at), number);
  return length > 0 && length != std::string_view::npos && number == static_cast<double>(label);
}

void Fanuc::go_to(long label, int column) {
  control_.jump();
  calls_.back().loops.clear();
  const LineSource::Mark here = source().mark();
  LineSource::Mark begin = calls_.size() > 1 ? calls_.back().top : LineSource::Mark{};
  std::string_view line;
  for (const bool ahead : {true, false}) {
    if (!ahead) source().seek(begin);
    while (source().next(line)) {
      if (!ahead && source().line_number() > here.line) break;
      if (!labelled(line, label)) continue;
      source().seek(source().line_mark());
      reader_.begin({});
      return;
    }
  }
  control_.fail("unknown-label", column, fmt::format("GOTO {}: there is no block N{}", label, label),
                "add the block number");
}

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

const Fanuc::Known* Fanuc::find_program(int number) {
  for (const Known& one : programs_) {
    if (one.number == number) return &one;
  }
  if (const Known* here = scan(*sources_.front(), number)) return here;
  for (const std::string& name :
       {fmt::format("O{:04}", number), fmt::format("O{}", number), fmt::format("{}", number)}) {
    const std::string file = find_subprogram(path_, control_.setup(), name, {"", ".nc", ".tap", ".NC"});
    if (file.empty()) continue;
    if (const Known* there = scan(open(file), number)) return there;
  }
  return nullptr;
}

void Fanuc::call(int number, long times, int column, const Call* macro) {
  if (times == 0) return;
  const Known* program = find_program(number);
  if (program == nullptr)
    control_.fail("unknown-subprogram", column,
                  fmt::format("O{:04} is called, and it is neither in this file nor in one named O{:04}",
                              number, number),
                  "add the subprogram, or give the folder of its file");
  if (calls_.size() > kCallsMax)
    control_.fail("recursion-limit", column,
                  fmt::format("more than {} subprograms call each other here", kCallsMax),
                  "end the recursion with a condition");
  control_.jump();
  Call next;
  if (macro != nullptr) next = *macro;
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
    control_.jump();
    here.source->seek(here.top);
    return;
  }
  const LineSource::Mark back = here.back;
  calls_.pop_back();
  source().seek(back);
  if (block_.has('P')) go_to(whole(block_, 'P', 1, 99999999, reader_, control_), column);
}

void Fanuc::call_macro() {
  struct Argument {
    char letter;
    int variable;
  };
  static constexpr Argument kArguments[] = {{'A', 1},  {'B', 2},  {'C', 3},  {'I', 4},  {'J', 5},
                                            {'K', 6},  {'D', 7},  {'E', 8},  {'F', 9},  {'H', 11},
                                            {'Q', 17}, {'R', 18}, {'S', 19}, {'T', 20}, {'U', 21},
                                            {'V', 22}, {'W', 23}, {'X', 24}, {'Y', 25}, {'Z', 26}};
  need('P', "G65");
  Call macro;
  macro.source = nullptr;
  macro.own_locals = true;
  for (const Argument& one : kArguments) {
    if (!block_.has(one.letter)) continue;
    macro.locals[static_cast<size_t>(one.variable)] = block_.get(one.letter);
    macro.assigned |= uint64_t{1} << one.variable;
  }
  const long times = block_.has('L') ? whole(block_, 'L', 0, 9999, reader_, control_) : 1;
  call(whole(block_, 'P', 1, 99999999, reader_, control_), times, g_column(kFanucOneShot), &macro);
}

bool Fanuc::apply_calls() {
  for (int i = 0; i < block_.m_count; ++i) {
    const int code = block_.m[static_cast<size_t>(i)];
    const int at = reader_.column_of(block_.m_places[static_cast<size_t>(i)]);
    if (code == 20 || code == 300) return false;
    if (code == 980) {
      need('P', "M98");
      const int p = whole(block_, 'P', 1, 99999999, reader_, control_);
      // P0030100 calls O0100 three times; with L, P is the number alone.
      const bool counted = p > 9999 && !block_.has('L');
      const long times = counted           ? p / 10000
                         : block_.has('L') ? whole(block_, 'L', 0, 9999, reader_, control_)
                                           : 1;
      call(counted ? p % 10000 : p, times, at, nullptr);
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
    control_.warn_once("main-program-repeats", at, "M99 repeats the main program for ever; it was run once",
                       "end it with M30 where that is meant");
    return false;
  }
  return true;
}

}  // namespace swarf::program::nc
