// O words: subprograms, conditions, loops.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/linuxcnc/reader.h"

namespace swarf::program::nc::linuxcnc {
namespace {

/// "The maximum subroutine nesting level is 10."
constexpr size_t kCallsMax = 10;

}  // namespace

bool LinuxCnc::at_o_word() {
  const size_t from = reader_.at();
  if (reader_.peek() == '/') {
    reader_.skip();
    reader_.skip_space();
  }
  if (reader_.peek_upper() == 'N') {
    reader_.skip();
    reader_.skip_space();
    while ((reader_.peek() >= '0' && reader_.peek() <= '9') || reader_.peek() == '.') reader_.skip();
    reader_.skip_space();
  }
  const bool found = reader_.peek_upper() == 'O';
  if (!found) reader_.move_to(from);
  return found;
}

LinuxCnc::OWord LinuxCnc::read_o_word() {
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
  word.column = reader_.column();
  reader_.skip();
  reader_.skip_space();
  if (reader_.peek() == '<') {
    reader_.skip();
    for (; !reader_.done() && reader_.peek() != '>'; reader_.skip()) {
      const char c = reader_.peek();
      if (c != ' ' && c != '\t') word.name += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    if (reader_.done() || word.name.empty())
      control_.report.fail("bad-o-word", word.column, "the name of this O word does not end",
                           "write O<name>");
    reader_.skip();
  } else {
    word.name = fmt::format("{}", std::lround(std::clamp(reader_.value(), -1e9, 1e9)));
  }
  reader_.skip_space();
  for (const Spelling& one : kKeywords) {
    if (!reader_.take(one.text)) continue;
    word.keyword = one.keyword;
    return word;
  }
  std::string_view message;
  skip_comments(kLinuxCncSyntax, reader_, control_, message);
  if (!reader_.done())
    control_.report.fail(
        "unknown-o-word", reader_.column(), fmt::format("this is no keyword of an O word (O{})", word.name),
        "write sub, endsub, call, return, if, elseif, else, endif, while, endwhile, do, repeat, endrepeat, "
        "break or continue");
  return word;
}

void LinuxCnc::end_of_o_word(const char* what) {
  std::string_view message;
  skip_comments(kLinuxCncSyntax, reader_, control_, message);
  if (!reader_.done()) control_.report.fail("unexpected-character", reader_.column(), what, "take it out");
}

double LinuxCnc::condition() {
  reader_.skip_space();
  const double value = reader_.bracketed();
  end_of_o_word("nothing follows the condition of an O word");
  return value;
}

void LinuxCnc::flow() {
  const OWord word = read_o_word();
  constexpr Keyword kAlone[] = {Keyword::kSub,      Keyword::kElse,      Keyword::kEndIf, Keyword::kDo,
                                Keyword::kEndWhile, Keyword::kEndRepeat, Keyword::kBreak, Keyword::kContinue};
  if (std::find(std::begin(kAlone), std::end(kAlone), word.keyword) != std::end(kAlone))
    end_of_o_word("nothing follows this O word");
  switch (word.keyword) {
    case Keyword::kNone:
      // A program number; in a numbered subprogram list the next one ends the main program's text.
      return;
    case Keyword::kSub:
      return define_sub(word);
    case Keyword::kCall:
      return call_sub(word);
    case Keyword::kReturn:
    case Keyword::kEndSub:
      if (calls_.size() < 2)
        control_.report.fail("bad-o-word", word.column, "this ends a subprogram, and none was called",
                             "take it out");
      reader_.skip_space();
      value_returned_ = reader_.peek() == '[';
      returned_ = value_returned_ ? reader_.bracketed() : 0.0;
      end_of_o_word("only a value in [ ] follows the end of a subprogram");
      return leave();
    case Keyword::kIf:
    case Keyword::kElseIf:
    case Keyword::kElse:
    case Keyword::kEndIf:
      return step_if(word);
    case Keyword::kBreak:
    case Keyword::kContinue:
      return leave_loop(word);
    default:
      return step_loop(word);
  }
}

LinuxCnc::OWord LinuxCnc::skip_to(const std::string& name, std::initializer_list<Keyword> ends,
                                  const char* missing) {
  const Place from = control_.report.place;
  std::string_view line;
  while (source().next(line)) {
    ++control_.report.summary.lines;
    control_.report.at(source().file(), static_cast<int>(source().line_number()), 1);
    reader_.begin(line);
    reader_.skip_space();
    if (!at_o_word()) continue;
    const size_t start = reader_.at();
    reader_.skip();
    reader_.skip_space();
    const bool computed = reader_.peek() == '#' || reader_.peek() == '[';
    reader_.move_to(start);
    if (computed) continue;
    const OWord word = read_o_word();
    if (word.name != name) continue;
    if (std::find(ends.begin(), ends.end(), word.keyword) != ends.end()) return word;
  }
  control_.report.at(from.file, from.line, from.column);
  control_.report.fail("unclosed-o-word", 0, fmt::format("O{} has no {} in this file", name, missing),
                       fmt::format("add O{} {}", name, missing));
}

LinuxCnc::Loop& LinuxCnc::top_loop(const OWord& word, Keyword kind) {
  auto& loops = frame().loops;
  if (loops.empty() || loops.back().name != word.name || loops.back().kind != kind)
    control_.report.fail("bad-o-word", word.column,
                         fmt::format("O{} ends nothing that is open here", word.name),
                         "close the innermost O word first, with its own number");
  return loops.back();
}

void LinuxCnc::step_if(const OWord& word) {
  auto& loops = frame().loops;
  if (word.keyword == Keyword::kEndIf) {
    top_loop(word, Keyword::kIf);
    loops.pop_back();
    return;
  }
  if (word.keyword != Keyword::kIf) {
    // The branch before it was taken.
    top_loop(word, Keyword::kIf);
    skip_to(word.name, {Keyword::kEndIf}, "endif");
    loops.pop_back();
    return;
  }
  loops.push_back({word.name, Keyword::kIf, {}, 0, control_.report.place.line});
  if (condition() != 0.0) return;
  for (;;) {
    const OWord next = skip_to(word.name, {Keyword::kElseIf, Keyword::kElse, Keyword::kEndIf}, "endif");
    if (next.keyword == Keyword::kEndIf) {
      loops.pop_back();
      return;
    }
    if (next.keyword == Keyword::kElse || condition() != 0.0) return;
  }
}

void LinuxCnc::step_loop(const OWord& word) {
  auto& loops = frame().loops;
  const auto again = [&](const Loop& loop) {
    nc::jump(control_);
    source().seek(loop.top);
  };
  const bool ends_do = word.keyword == Keyword::kWhile && !loops.empty() && loops.back().name == word.name &&
                       loops.back().kind == Keyword::kDo;
  if (ends_do) {
    if (condition() != 0.0) return again(loops.back());
    loops.pop_back();
    return;
  }
  LineSource::Mark next = source().mark();
  switch (word.keyword) {
    case Keyword::kDo:
      loops.push_back({word.name, Keyword::kDo, next, 0, control_.report.place.line});
      return;
    case Keyword::kWhile: {
      const bool inside =
          !loops.empty() && loops.back().name == word.name && loops.back().kind == Keyword::kWhile;
      if (!inside)
        loops.push_back({word.name, Keyword::kWhile, source().line_mark(), 0, control_.report.place.line});
      if (condition() != 0.0) return;
      loops.pop_back();
      skip_to(word.name, {Keyword::kEndWhile}, "endwhile");
      return;
    }
    case Keyword::kEndWhile:
      return again(top_loop(word, Keyword::kWhile));
    case Keyword::kRepeat: {
      const double times = condition();
      if (times < 0.5) {
        skip_to(word.name, {Keyword::kEndRepeat}, "endrepeat");
        return;
      }
      loops.push_back({word.name, Keyword::kRepeat, next, std::lround(std::min(times, 1e12)) - 1,
                       control_.report.place.line});
      return;
    }
    case Keyword::kEndRepeat: {
      Loop& loop = top_loop(word, Keyword::kRepeat);
      if (loop.left-- > 0) return again(loop);
      loops.pop_back();
      return;
    }
    default:
      return;
  }
}

void LinuxCnc::leave_loop(const OWord& word) {
  auto& loops = frame().loops;
  while (!loops.empty() && loops.back().name != word.name) loops.pop_back();
  if (loops.empty() || loops.back().kind == Keyword::kIf)
    control_.report.fail("bad-o-word", word.column,
                         fmt::format("O{} is no loop that is open here", word.name),
                         "name the loop to leave");
  const Loop loop = loops.back();
  if (word.keyword == Keyword::kContinue && loop.kind == Keyword::kWhile) {
    nc::jump(control_);
    return source().seek(loop.top);
  }
  const Keyword end = loop.kind == Keyword::kRepeat  ? Keyword::kEndRepeat
                      : loop.kind == Keyword::kWhile ? Keyword::kEndWhile
                                                     : Keyword::kWhile;
  const OWord last = skip_to(word.name, {end}, "end");
  if (word.keyword == Keyword::kContinue) return step_loop(last);
  loops.pop_back();
}

// --- Subprograms
// ---------------------------------------------------------------------------------------------

void LinuxCnc::define_sub(const OWord& word) {
  const bool known = std::any_of(subs_.begin(), subs_.end(),
                                 [&](const Sub& sub) { return sub.name == word.name && !sub.numbered; });
  if (!known) subs_.push_back({word.name, false, &source(), source().mark()});
  skip_to(word.name, {Keyword::kEndSub}, "endsub");
}

const LinuxCnc::Sub* LinuxCnc::scan(LineSource& in, const std::string& name, bool numbered) {
  const LineSource::Mark back = in.mark();
  const Place here = control_.report.place;
  const std::string_view line_here = reader_.line();
  const std::string kept(line_here);
  const size_t at_here = reader_.at();
  in.seek({});
  const Sub* found = nullptr;
  std::string_view line;
  while (found == nullptr && in.next(line)) {
    reader_.begin(line);
    reader_.skip_space();
    if (!at_o_word()) continue;
    const size_t start = reader_.at();
    reader_.skip();
    reader_.skip_space();
    if (reader_.peek() == '#' || reader_.peek() == '[') continue;
    reader_.move_to(start);
    control_.report.at(in.file(), static_cast<int>(in.line_number()), 1);
    const OWord word = read_o_word();
    if (word.name != name || word.keyword != (numbered ? Keyword::kNone : Keyword::kSub)) continue;
    subs_.push_back({name, numbered, &in, in.mark()});
    found = &subs_.back();
  }
  in.seek(back);
  control_.report.at(here.file, here.line, here.column);
  kept_line_ = kept;
  reader_.begin(kept_line_);
  reader_.move_to(at_here);
  return found;
}

/// O...sub must have been passed before its call, a numbered subprogram follows it; both may have a file of
/// their own.
const LinuxCnc::Sub* LinuxCnc::find_sub(const std::string& name, bool numbered) {
  for (const Sub& sub : subs_) {
    if (sub.name == name && sub.numbered == numbered) return &sub;
  }
  LineSource& main = *sources_.front();
  const Sub* here = scan(source(), name, numbered);
  if (here == nullptr && &source() != &main) here = scan(main, name, numbered);
  if (here != nullptr && !numbered)
    control_.report.fail("unknown-subprogram", 0,
                         fmt::format("O{} is called before its definition in line {}", name, here->body.line),
                         "write the subprogram before its first call");
  if (here != nullptr) return here;
  const std::string file = find_subprogram(path_, control_.setup, name, {".ngc", ".nc", ""});
  return file.empty() ? nullptr : scan(open(file), name, numbered);
}

void LinuxCnc::call_sub(const OWord& word) {
  Call call;
  call.sub = word.name;
  size_t count = 0;
  for (reader_.skip_space(); reader_.peek() == '['; reader_.skip_space()) {
    if (++count > 30)
      control_.report.fail("too-many-arguments", reader_.column(), "a call has at most 30 arguments",
                           "pass fewer");
    call.arguments[count] = reader_.bracketed();
    call.assigned |= uint64_t{1} << count;
  }
  end_of_o_word("only arguments in [ ] follow a call");
  const Sub* sub = find_sub(word.name, false);
  if (sub == nullptr)
    control_.report.fail("unknown-subprogram", word.column,
                         fmt::format("O{} is called, and no such subprogram is in this file or in {}.ngc",
                                     word.name, word.name),
                         "define it with O... sub, or give the folder of the file");
  returned_ = 0.0;
  value_returned_ = false;
  enter(*sub, std::move(call));
}

void LinuxCnc::enter(const Sub& sub, Call call) {
  nc::jump(control_);
  if (calls_.size() > kCallsMax)
    control_.report.fail("recursion-limit", 0,
                         fmt::format("more than {} subprograms call each other here", kCallsMax),
                         "end the recursion with a condition");
  call.back = source().mark();
  // The caller's source may be the same file: it returns by its mark.
  call.source = sub.source;
  call.top = sub.body;
  call.source->seek(sub.body);
  calls_.push_back(std::move(call));
}

void LinuxCnc::leave() {
  Call& call = frame();
  if (call.restores) restore(*call.saved, 0);
  call.restores = false;
  if (call.left > 0) {
    --call.left;
    nc::jump(control_);
    call.source->seek(call.top);
    return;
  }
  if (call.numbered) {  // #1 to #30 are global there
    Call& caller = calls_[calls_.size() - 2];
    caller.arguments = call.arguments;
    caller.assigned = call.assigned;
  }
  const LineSource::Mark back = call.back;
  calls_.pop_back();
  source().seek(back);
}

void LinuxCnc::call_number(int number, long times, int column) {
  if (times == 0) return;
  const std::string name = fmt::format("{}", number);
  const Sub* sub = find_sub(name, true);
  if (sub == nullptr)
    control_.report.fail(
        "unknown-subprogram", column,
        fmt::format("M98 calls O{}, and it is neither in this file nor in {}.ngc", number, number),
        "add the subprogram, or give the folder of its file");
  if (sub->source == &source() && sub->body.line <= source().line_number())
    control_.report.fail(
        "unknown-subprogram", column,
        fmt::format("O{} stands before this M98, in line {}: numbered subprograms follow their call", number,
                    sub->body.line),
        "write it behind the end of the main program");
  Call call;
  call.sub = name;
  call.numbered = true;
  call.left = times - 1;
  // Numbered subprograms share the parameters of their caller.
  call.arguments = frame().arguments;
  call.assigned = frame().assigned;
  enter(*sub, std::move(call));
}

void LinuxCnc::end_of_flow() {
  if (!frame().loops.empty()) {
    const Loop& loop = frame().loops.back();
    control_.report.at(source().file(), loop.line, 1);
    control_.report.fail("unclosed-o-word", 0,
                         fmt::format("O{} is not closed at the end of the file", loop.name), "add its end");
  }
  if (calls_.size() == 1) {
    warn_of_missing_end("M2, M30 or %");
    ended_ = true;
    return;
  }
  control_.report.fail("unclosed-o-word", 0,
                       fmt::format("subprogram O{} does not end in its file", frame().sub),
                       frame().numbered ? "end it with M99" : "end it with O... endsub");
}

}  // namespace swarf::program::nc::linuxcnc
