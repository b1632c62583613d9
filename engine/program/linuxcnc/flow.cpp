// O words: subprograms, conditions, loops.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/linuxcnc/steps.h"

namespace swarf::program::nc::linuxcnc {
namespace {

/// "The maximum subroutine nesting level is 10."
constexpr size_t kCallsMax = 10;

OWord read_o_word(LetterDialect& letters) {
  struct Spelling {
    std::string_view text;
    Keyword keyword;
  };
  // Longer words before their beginnings.
  static constexpr Spelling kKeywords[] = {{"SUB", Keyword::kSub},
                                           {"ENDSUB", Keyword::kEndSub},
                                           {"CALL", Keyword::kCall},
                                           {"RETURN", Keyword::kReturn},
                                           {"DO", Keyword::kDo},
                                           {"WHILE", Keyword::kWhile},
                                           {"ENDWHILE", Keyword::kEndWhile},
                                           {"IF", Keyword::kIf},
                                           {"ELSEIF", Keyword::kElseIf},
                                           {"ELSE", Keyword::kElse},
                                           {"ENDIF", Keyword::kEndIf},
                                           {"REPEAT", Keyword::kRepeat},
                                           {"ENDREPEAT", Keyword::kEndRepeat},
                                           {"BREAK", Keyword::kBreak},
                                           {"CONTINUE", Keyword::kContinue}};
  OWord word;
  word.column = letters.reader.column();
  letters.reader.skip();
  letters.reader.skip_space();
  if (letters.reader.peek() == '<') {
    letters.reader.skip();
    for (; !letters.reader.done() && letters.reader.peek() != '>'; letters.reader.skip()) {
      const char c = letters.reader.peek();
      if (c != ' ' && c != '\t') word.name += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    if (letters.reader.done() || word.name.empty())
      letters.control.report.fail("bad-o-word", word.column, "the name of this O word does not end",
                                  "write O<name>");
    letters.reader.skip();
  } else {
    word.name = fmt::format("{}", std::lround(std::clamp(letters.reader.value(), -1e9, 1e9)));
  }
  letters.reader.skip_space();
  for (const Spelling& one : kKeywords) {
    if (!letters.reader.take(one.text)) continue;
    word.keyword = one.keyword;
    return word;
  }
  std::string_view message;
  skip_comments(kLinuxCncSyntax, letters.reader, letters.control, message);
  if (!letters.reader.done())
    letters.control.report.fail(
        "unknown-o-word", letters.reader.column(),
        fmt::format("this is no keyword of an O word (O{})", word.name),
        "write sub, endsub, call, return, if, elseif, else, endif, while, endwhile, do, repeat, endrepeat, "
        "break or continue");
  return word;
}

/// Fails with `what` unless only comments follow.
void end_of_o_word(LetterDialect& letters, const char* what) {
  std::string_view message;
  skip_comments(kLinuxCncSyntax, letters.reader, letters.control, message);
  if (!letters.reader.done())
    letters.control.report.fail("unexpected-character", letters.reader.column(), what, "take it out");
}

double condition(LetterDialect& letters) {
  letters.reader.skip_space();
  const double value = letters.reader.bracketed();
  end_of_o_word(letters, "nothing follows the condition of an O word");
  return value;
}

OWord skip_to(Calls& calls, LetterDialect& letters, const std::string& name,
              std::initializer_list<Keyword> ends, const char* missing) {
  const Place from = letters.control.report.place;
  std::string_view line;
  while (source(calls).next(line)) {
    ++letters.control.report.summary.lines;
    letters.control.report.at(source(calls).file(), static_cast<int>(source(calls).line_number()), 1);
    letters.reader.begin(line);
    letters.reader.skip_space();
    if (!at_o_word(letters)) continue;
    const size_t start = letters.reader.at();
    letters.reader.skip();
    letters.reader.skip_space();
    const bool computed = letters.reader.peek() == '#' || letters.reader.peek() == '[';
    letters.reader.move_to(start);
    if (computed) continue;
    const OWord word = read_o_word(letters);
    if (word.keyword == Keyword::kSub && *ends.begin() == Keyword::kEndSub)
      letters.control.report.fail(
          "bad-o-word", word.column,
          fmt::format("O{} sub stands inside of O{} sub: LinuxCNC nests no definitions", word.name, name),
          fmt::format("end O{} with endsub before it", name));
    if (word.name != name) continue;
    if (std::find(ends.begin(), ends.end(), word.keyword) != ends.end()) return word;
  }
  letters.control.report.at(from.file, from.line, from.column);
  letters.control.report.fail("unclosed-o-word", 0, fmt::format("O{} has no {} in this file", name, missing),
                              fmt::format("add O{} {}", name, missing));
}

Loop& top_loop(Calls& calls, LetterDialect& letters, const OWord& word, Keyword kind) {
  auto& loops = frame(calls).loops;
  if (loops.empty() || loops.back().name != word.name || loops.back().kind != kind)
    letters.control.report.fail("bad-o-word", word.column,
                                fmt::format("O{} ends nothing that is open here", word.name),
                                "close the innermost O word first, with its own number");
  return loops.back();
}

void step_if(Calls& calls, LetterDialect& letters, const OWord& word) {
  auto& loops = frame(calls).loops;
  if (word.keyword == Keyword::kEndIf) {
    top_loop(calls, letters, word, Keyword::kIf);
    loops.pop_back();
    return;
  }
  if (word.keyword != Keyword::kIf) {
    // The branch before it was taken.
    top_loop(calls, letters, word, Keyword::kIf);
    skip_to(calls, letters, word.name, {Keyword::kEndIf}, "endif");
    loops.pop_back();
    return;
  }
  loops.push_back({word.name, Keyword::kIf, {}, 0, letters.control.report.place.line});
  if (condition(letters) != 0.0) return;
  for (;;) {
    const OWord next =
        skip_to(calls, letters, word.name, {Keyword::kElseIf, Keyword::kElse, Keyword::kEndIf}, "endif");
    if (next.keyword == Keyword::kEndIf) {
      loops.pop_back();
      return;
    }
    if (next.keyword == Keyword::kElse || condition(letters) != 0.0) return;
  }
}

void step_loop(Calls& calls, LetterDialect& letters, const OWord& word) {
  auto& loops = frame(calls).loops;
  const auto again = [&](const Loop& loop) {
    nc::jump(letters.control);
    source(calls).seek(loop.top);
  };
  const bool ends_do = word.keyword == Keyword::kWhile && !loops.empty() && loops.back().name == word.name &&
                       loops.back().kind == Keyword::kDo;
  if (ends_do) {
    if (condition(letters) != 0.0) return again(loops.back());
    loops.pop_back();
    return;
  }
  LineSource::Mark next = source(calls).mark();
  switch (word.keyword) {
    case Keyword::kDo:
      loops.push_back({word.name, Keyword::kDo, next, 0, letters.control.report.place.line});
      return;
    case Keyword::kWhile: {
      const bool inside =
          !loops.empty() && loops.back().name == word.name && loops.back().kind == Keyword::kWhile;
      if (!inside)
        loops.push_back(
            {word.name, Keyword::kWhile, source(calls).line_mark(), 0, letters.control.report.place.line});
      if (condition(letters) != 0.0) return;
      loops.pop_back();
      skip_to(calls, letters, word.name, {Keyword::kEndWhile}, "endwhile");
      return;
    }
    case Keyword::kEndWhile:
      return again(top_loop(calls, letters, word, Keyword::kWhile));
    case Keyword::kRepeat: {
      const double times = condition(letters);
      if (times < 0.5) {
        skip_to(calls, letters, word.name, {Keyword::kEndRepeat}, "endrepeat");
        return;
      }
      loops.push_back({word.name, Keyword::kRepeat, next, std::lround(std::min(times, 1e12)) - 1,
                       letters.control.report.place.line});
      return;
    }
    case Keyword::kEndRepeat: {
      Loop& loop = top_loop(calls, letters, word, Keyword::kRepeat);
      if (loop.left-- > 0) return again(loop);
      loops.pop_back();
      return;
    }
    default:
      return;
  }
}

void leave_loop(Calls& calls, LetterDialect& letters, const OWord& word) {
  auto& loops = frame(calls).loops;
  while (!loops.empty() && loops.back().name != word.name) loops.pop_back();
  if (loops.empty() || loops.back().kind == Keyword::kIf)
    letters.control.report.fail("bad-o-word", word.column,
                                fmt::format("O{} is no loop that is open here", word.name),
                                "name the loop to leave");
  const Loop loop = loops.back();
  if (word.keyword == Keyword::kContinue && loop.kind == Keyword::kWhile) {
    nc::jump(letters.control);
    return source(calls).seek(loop.top);
  }
  const Keyword end = loop.kind == Keyword::kRepeat  ? Keyword::kEndRepeat
                      : loop.kind == Keyword::kWhile ? Keyword::kEndWhile
                                                     : Keyword::kWhile;
  const OWord last = skip_to(calls, letters, word.name, {end}, "end");
  if (word.keyword == Keyword::kContinue) return step_loop(calls, letters, last);
  loops.pop_back();
}

void define_sub(Calls& calls, LetterDialect& letters, const OWord& word) {
  const bool known = std::any_of(calls.known.begin(), calls.known.end(),
                                 [&](const Sub& sub) { return sub.name == word.name && !sub.numbered; });
  if (!known) calls.known.push_back({word.name, false, &source(calls), source(calls).mark()});
  skip_to(calls, letters, word.name, {Keyword::kEndSub}, "endsub");
}

const Sub* scan(Calls& calls, LetterDialect& letters, LineSource& in, const std::string& name,
                bool numbered) {
  const LineSource::Mark back = in.mark();
  const Place here = letters.control.report.place;
  const std::string_view line_here = letters.reader.line();
  const std::string kept(line_here);
  const size_t at_here = letters.reader.at();
  in.seek({});
  const Sub* found = nullptr;
  std::string_view line;
  while (found == nullptr && in.next(line)) {
    letters.reader.begin(line);
    letters.reader.skip_space();
    if (!at_o_word(letters)) continue;
    const size_t start = letters.reader.at();
    letters.reader.skip();
    letters.reader.skip_space();
    if (letters.reader.peek() == '#' || letters.reader.peek() == '[') continue;
    letters.reader.move_to(start);
    letters.control.report.at(in.file(), static_cast<int>(in.line_number()), 1);
    const OWord word = read_o_word(letters);
    if (word.name != name || word.keyword != (numbered ? Keyword::kNone : Keyword::kSub)) continue;
    calls.known.push_back({name, numbered, &in, in.mark()});
    found = &calls.known.back();
  }
  in.seek(back);
  letters.control.report.at(here.file, here.line, here.column);
  letters.kept_line = kept;
  letters.reader.begin(letters.kept_line);
  letters.reader.move_to(at_here);
  return found;
}

/// O...sub may stand before or behind its call (LinuxCNC looks ahead for it), a numbered subprogram behind
/// it; both may have a file of their own.
const Sub* find_sub(Calls& calls, LetterDialect& letters, const std::string& name, bool numbered) {
  for (const Sub& sub : calls.known) {
    if (sub.name == name && sub.numbered == numbered) return &sub;
  }
  LineSource& main = *letters.sources.front();
  const Sub* here = scan(calls, letters, source(calls), name, numbered);
  if (here == nullptr && &source(calls) != &main) here = scan(calls, letters, main, name, numbered);
  if (here != nullptr) return here;
  const std::string file = find_subprogram(letters.path, letters.control.setup, name, {".ngc", ".nc", ""});
  return file.empty() ? nullptr : scan(calls, letters, letters.open(file), name, numbered);
}

void enter(Calls& calls, LetterDialect& letters, const Sub& sub, Call call) {
  nc::jump(letters.control);
  if (calls.stack.full(kCallsMax))
    letters.control.report.fail(kRecursionLimit, 0,
                                fmt::format("more than {} subprograms call each other here", kCallsMax),
                                "end the recursion with a condition");
  call.back = source(calls).mark();
  // The caller's source may be the same file: it returns by its mark.
  call.source = sub.source;
  call.top = sub.body;
  call.source->seek(sub.body);
  calls.stack.enter(std::move(call));
}

void call_sub(Calls& calls, NumbersAndNames& parameters, LetterDialect& letters, const OWord& word) {
  Call call;
  call.sub = word.name;
  size_t count = 0;
  std::string_view message;
  const auto to_argument = [&] { skip_comments(kLinuxCncSyntax, letters.reader, letters.control, message); };
  for (to_argument(); letters.reader.peek() == '['; to_argument()) {
    if (++count > 30)
      letters.control.report.fail("too-many-arguments", letters.reader.column(),
                                  "a call has at most 30 arguments", "pass fewer");
    call.arguments[count] = letters.reader.bracketed();
    call.assigned |= uint64_t{1} << count;
  }
  end_of_o_word(letters, "only arguments in [ ] follow a call");
  const Sub* sub = find_sub(calls, letters, word.name, false);
  if (sub == nullptr)
    letters.control.report.fail(
        "unknown-subprogram", word.column,
        fmt::format("O{} is called, and no such subprogram is in this file or in {}.ngc", word.name,
                    word.name),
        "define it with O... sub, or give the folder of the file");
  parameters.returned = 0.0;
  parameters.value_returned = false;
  enter(calls, letters, *sub, std::move(call));
}

}  // namespace

bool at_o_word(LetterDialect& letters) {
  const size_t from = letters.reader.at();
  if (letters.reader.peek() == '/') {
    letters.reader.skip();
    letters.reader.skip_space();
  }
  if (letters.reader.peek_upper() == 'N') {
    letters.reader.skip();
    letters.reader.skip_space();
    while ((letters.reader.peek() >= '0' && letters.reader.peek() <= '9') || letters.reader.peek() == '.')
      letters.reader.skip();
    letters.reader.skip_space();
  }
  const bool found = letters.reader.peek_upper() == 'O';
  if (!found) letters.reader.move_to(from);
  return found;
}

void flow(LinuxCnc& linuxcnc) {
  const OWord word = read_o_word(linuxcnc);
  constexpr Keyword kAlone[] = {Keyword::kSub,      Keyword::kElse,      Keyword::kEndIf, Keyword::kDo,
                                Keyword::kEndWhile, Keyword::kEndRepeat, Keyword::kBreak, Keyword::kContinue};
  if (std::find(std::begin(kAlone), std::end(kAlone), word.keyword) != std::end(kAlone))
    end_of_o_word(linuxcnc, "nothing follows this O word");
  switch (word.keyword) {
    case Keyword::kNone:
      // A program number; in a numbered subprogram list the next one ends the main program's text.
      return;
    case Keyword::kSub:
      return define_sub(linuxcnc.calls, linuxcnc, word);
    case Keyword::kCall:
      return call_sub(linuxcnc.calls, linuxcnc.parameters, linuxcnc, word);
    case Keyword::kReturn:
    case Keyword::kEndSub:
      if (!linuxcnc.calls.stack.called())
        linuxcnc.control.report.fail("bad-o-word", word.column, "this ends a subprogram, and none was called",
                                     "take it out");
      linuxcnc.reader.skip_space();
      linuxcnc.parameters.value_returned = linuxcnc.reader.peek() == '[';
      linuxcnc.parameters.returned = linuxcnc.parameters.value_returned ? linuxcnc.reader.bracketed() : 0.0;
      end_of_o_word(linuxcnc, "only a value in [ ] follows the end of a subprogram");
      return leave(linuxcnc);
    case Keyword::kIf:
    case Keyword::kElseIf:
    case Keyword::kElse:
    case Keyword::kEndIf:
      return step_if(linuxcnc.calls, linuxcnc, word);
    case Keyword::kBreak:
    case Keyword::kContinue:
      return leave_loop(linuxcnc.calls, linuxcnc, word);
    default:
      return step_loop(linuxcnc.calls, linuxcnc, word);
  }
}

void leave(LinuxCnc& linuxcnc) {
  Call& call = frame(linuxcnc.calls);
  if (call.restores) restore(linuxcnc.modes, linuxcnc.zero, linuxcnc, *call.saved, 0);
  call.restores = false;
  if (call.left > 0) {
    --call.left;
    nc::jump(linuxcnc.control);
    call.source->seek(call.top);
    return;
  }
  if (call.numbered) {  // #1 to #30 are global there
    Call& caller = linuxcnc.calls.stack.caller();
    caller.arguments = call.arguments;
    caller.assigned = call.assigned;
  }
  const LineSource::Mark back = call.back;
  linuxcnc.calls.stack.leave();
  source(linuxcnc.calls).seek(back);
}

void call_number(Calls& calls, LetterDialect& letters, int number, long times, int column) {
  if (times == 0) return;
  const std::string name = fmt::format("{}", number);
  const Sub* sub = find_sub(calls, letters, name, true);
  if (sub == nullptr)
    letters.control.report.fail(
        "unknown-subprogram", column,
        fmt::format("M98 calls O{}, and it is neither in this file nor in {}.ngc", number, number),
        "add the subprogram, or give the folder of its file");
  if (sub->source == &source(calls) && sub->body.line <= source(calls).line_number())
    letters.control.report.fail(
        "unknown-subprogram", column,
        fmt::format("O{} stands before this M98, in line {}: numbered subprograms follow their call", number,
                    sub->body.line),
        "write it behind the end of the main program");
  Call call;
  call.sub = name;
  call.numbered = true;
  call.left = times - 1;
  // Numbered subprograms share the parameters of their caller.
  call.arguments = frame(calls).arguments;
  call.assigned = frame(calls).assigned;
  enter(calls, letters, *sub, std::move(call));
}

void end_of_flow(Calls& calls, LetterDialect& letters) {
  if (!frame(calls).loops.empty()) {
    const Loop& loop = frame(calls).loops.back();
    letters.control.report.at(source(calls).file(), loop.line, 1);
    letters.control.report.fail("unclosed-o-word", 0,
                                fmt::format("O{} is not closed at the end of the file", loop.name),
                                "add its end");
  }
  if (!calls.stack.called()) {
    letters.warn_of_missing_end("M2, M30 or %");
    letters.ended = true;
    return;
  }
  letters.control.report.fail("unclosed-o-word", 0,
                              fmt::format("subprogram O{} does not end in its file", frame(calls).sub),
                              frame(calls).numbered ? "end it with M99" : "end it with O... endsub");
}

}  // namespace swarf::program::nc::linuxcnc
