#include "program/siemens/flow.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace swarf::program::nc::siemens {

Flow::Flow(BlockTarget& target, std::vector<std::string> subprogram_folders, FlowLimits limits)
    : target_(target), folders_(std::move(subprogram_folders)), limits_(limits) {
  variables_.connect(target_);
}

Flow::~Flow() = default;

std::vector<std::string> Flow::files() const {
  std::vector<std::string> files;
  for (const auto& source : sources_) files.push_back(source->path());
  return files;
}

void Flow::run(const std::string& path) {
  sources_.push_back(std::make_unique<Source>(path));
  lines_ = sources_[0]->lines();
  Level main;
  main.stop = sources_[0]->lines();
  main.scope = std::make_shared<Scope>();
  levels_.push_back(std::move(main));
  variables_.enter(*top().scope);
  while (!levels_.empty() && !stopped_) {
    if (top().next >= top().stop) {
      leave_level(false);
      continue;
    }
    current_ = top().next++;
    statement();
  }
}

/// Ends a repetition or the program (`to_caller`: M17, also out of a repeated part); false at the last one.
bool Flow::leave_level(bool to_caller) {
  if (!to_caller && top().again > 0) {
    --top().again;
    top().next = top().first;
    return true;
  }
  while (to_caller && top().part) levels_.pop_back();
  const Level left = std::move(levels_.back());
  levels_.pop_back();
  if (left.again > 0) {  // a subprogram with P that ended by M17
    levels_.push_back(left);
    --top().again;
    top().next = top().first;
    return true;
  }
  if (levels_.empty()) return false;
  variables_.enter(*top().scope);
  const LineRef line = source().line(std::max(0, top().next - 1));
  for (const Returned& back : left.returned) {
    const Value& value = left.scope->at(back.parameter).values[0];
    Value& to = variables_.element(back.variable, {}, line, 0);
    to = converted(value, to.type, line, 0);
  }
  return true;
}

void Flow::statement() {
  const LineRef there = source().line(current_);
  text_ = there.text;  // stays while other lines are looked at
  running_ = {there.file, there.line, text_};
  const LineRef& line = running_;
  if (current_ == 0 && line.text.starts_with('%')) {
    target_.note("%", std::string(line.text), source().path(),
                 1);  // name of the program, as archives have it
    return;
  }
  lex(line, tokens_);
  if (tokens_.empty()) return;
  TokenReader reader(line, tokens_);
  skip_head(reader);
  if (reader.done()) return;
  ++blocks_;
  words(reader);
}

/// /2 N100 LABEL:
void Flow::skip_head(TokenReader& reader) {
  if (reader.skip("/")) {
    const bool level = reader.peek().kind == TokenKind::kNumber && reader.peek().whole;
    if (level) reader.next();
    target_.note("/", "block skip is off: the block is executed", source().path(), current_ + 1);
  }
  const Token& number = reader.peek();
  if (number.kind == TokenKind::kAddress && number.letter == 'N') {
    if (!number.whole || number.number < 0) {
      refuse(reader.line(), number.offset, "bad-number", "a block number is a whole number", "write N100");
    }
    reader.next();
  }
  if (reader.peek().kind == TokenKind::kName && reader.peek(1).symbol(":")) {
    reader.next();
    reader.next();
  }
}

void Flow::words(TokenReader& reader) {
  const Token& first = reader.peek();
  if (first.kind == TokenKind::kName) {
    if (const Handler handler = handler_of(first.name)) {
      reader.next();
      (this->*handler)(reader);
      return;
    }
  }
  if (subprogram_here(reader)) return;
  const long before = target_.moves();
  const Outcome outcome = target_.block(reader, variables_);
  const auto programs =
      std::count_if(levels_.begin(), levels_.end(), [](const Level& level) { return !level.part; });
  const bool modal = modal_.file >= 0 && levels_.size() == modal_.depth;
  // In a main program that is called, M2 and M30 mean M17 (manual, subprograms).
  const bool ends = outcome == Outcome::kEnd && programs == 1;
  if (ends) {
    levels_.clear();
    ended_ = true;
  } else if (outcome == Outcome::kReturn || outcome == Outcome::kEnd) {
    leave_level(true);
    ended_ = levels_.empty();
  } else if (modal && outcome == Outcome::kPattern) {
    refuse(running_, 0, "unsupported-word", "a position pattern while MCALL calls a program is not supported",
           "write the positions as blocks, or MCALL with a drilling cycle");
  } else if (modal && target_.moves() != before) {
    const ModalCall call_now = modal_;
    call(call_now.file, nullptr, call_now.arguments, 1);
  }
}

Flow::Handler Flow::handler_of(const std::string& word) {
  static const std::map<std::string, Handler> handlers = {
      {"IF", &Flow::on_if},         {"ELSE", &Flow::on_else},     {"ENDIF", &Flow::on_nothing},
      {"WHILE", &Flow::on_while},   {"ENDWHILE", &Flow::on_back}, {"FOR", &Flow::on_for},
      {"ENDFOR", &Flow::on_endfor}, {"LOOP", &Flow::on_nothing},  {"ENDLOOP", &Flow::on_back},
      {"UNTIL", &Flow::on_until},   {"REPEAT", &Flow::on_repeat}, {"REPEATB", &Flow::on_repeat},
      {"GOTOF", &Flow::on_goto},    {"GOTOB", &Flow::on_goto},    {"GOTO", &Flow::on_goto},
      {"GOTOC", &Flow::on_goto},    {"CASE", &Flow::on_case},     {"DEF", &Flow::on_def},
      {"PROC", &Flow::on_proc},     {"EXTERN", &Flow::on_extern}, {"CALL", &Flow::on_call},
      {"EXTCALL", &Flow::on_call},  {"MCALL", &Flow::on_mcall},
  };
  const auto found = handlers.find(word);
  return found == handlers.end() ? nullptr : found->second;
}

void Flow::finish_block(TokenReader& reader, std::string_view after) {
  if (reader.done()) return;
  refuse(reader.line(), reader.offset(), "bad-block",
         fmt::format("'{}' does not belong after {}", reader.peek().text, after),
         "write it in a block of its own");
}

bool Flow::condition(TokenReader& reader) {
  const size_t offset = reader.offset();
  return converted(evaluate(reader, variables_), Type::kBool, reader.line(), offset).number != 0.0;
}

/// Goes on with a line of the running program; jumps back are counted against endless loops.
void Flow::jump(int index, const LineRef& from) {
  while (top().part && (index < top().first || index >= top().stop)) levels_.pop_back();
  top().next = index;
  if (index > current_) return;
  if (target_.moves() != moves_seen_) jumps_ = 0;
  moves_seen_ = target_.moves();
  if (++jumps_ <= limits_.jumps_max) return;
  refuse(
      from, 0, "endless-loop",
      fmt::format("the program jumped back {} times without a move, last in this block", limits_.jumps_max),
      "check the condition of the loop");
}

void Flow::on_if(TokenReader& reader) {
  const bool holds = condition(reader);
  const Token& token = reader.peek();
  if (token.kind == TokenKind::kName && token.name.starts_with("GOTO") && handler_of(token.name) != nullptr) {
    if (!holds) return;
    reader.next();
    on_goto(reader);
    return;
  }
  finish_block(reader, "IF and its condition");
  const int partner = source().partner(current_);
  if (!holds) jump(partner + 1, reader.line());
}

void Flow::on_else(TokenReader& reader) {
  finish_block(reader, "ELSE");
  jump(source().partner(current_), reader.line());
}

/// LOOP and ENDIF: only their partners matter.
void Flow::on_nothing(TokenReader& reader) {
  finish_block(reader, "this word");
  source().partner(current_);
}

void Flow::on_while(TokenReader& reader) {
  const bool holds = condition(reader);
  finish_block(reader, "WHILE and its condition");
  const int end = source().partner(current_);
  if (!holds) jump(end + 1, reader.line());
}

void Flow::on_back(TokenReader& reader) {
  finish_block(reader, "the end of the loop");
  jump(source().partner(current_), reader.line());
}

/// FOR n = first TO last: true while the variable has not passed `last`.
bool Flow::for_goes_on(TokenReader& reader, const LineRef& head, bool first) {
  const Token& name = reader.peek();
  Variable* variable = name.kind == TokenKind::kName ? variables_.find(name.name) : nullptr;
  if (variable == nullptr || variable->type != Type::kInt || !variable->sizes.empty()) {
    refuse(head, reader.offset(), "bad-block", "FOR counts with a declared INT variable",
           "declare it: DEF INT N, then FOR N=1 TO 5");
  }
  reader.next();
  reader.expect("=", "the variable of FOR");
  const Value start = evaluate(reader, variables_);
  reader.expect("TO", "the first value of FOR");
  const double last = evaluate_number(reader, variables_);
  finish_block(reader, "FOR");
  Value& value = variable->values[0];
  value = converted(first ? start : Value::integer(value.number + 1.0), Type::kInt, head, 0);
  return value.number <= last;
}

void Flow::on_for(TokenReader& reader) {
  const bool runs = for_goes_on(reader, reader.line(), true);
  const int end = source().partner(current_);
  if (!runs) jump(end + 1, reader.line());
}

void Flow::on_endfor(TokenReader& reader) {
  finish_block(reader, "ENDFOR");
  const int head = source().partner(current_);
  const LineRef line = source().line(head);
  std::vector<Token> tokens;
  lex(line, tokens);
  TokenReader again(line, tokens);
  while (!again.skip("FOR")) again.next();
  if (for_goes_on(again, line, false)) jump(head + 1, reader.line());
}

void Flow::on_until(TokenReader& reader) {
  const bool done = condition(reader);
  finish_block(reader, "UNTIL and its condition");
  const int head = source().partner(current_);
  if (!done) jump(head + 1, reader.line());
}

void Flow::on_goto(TokenReader& reader) {
  go(reader);
  finish_block(reader, "the jump");
}

/// The label or number after GOTOF, GOTOB, GOTO (forwards, then backwards) or GOTOC (no error without one).
void Flow::go(TokenReader& reader) {
  const Token& word = reader.peek();
  const std::string how = [&] {
    // The jump word stands just before the reader's place.
    const Token& jump_word = tokens_[reader.position() - 1];
    return jump_word.name;
  }();
  std::string label;
  if (word.kind == TokenKind::kName) label = word.name;
  if (word.kind == TokenKind::kAddress && word.letter == 'N' && word.whole) label = capitals(word.text);
  if (label.empty()) {
    refuse(reader.line(), reader.offset(), "bad-block",
           fmt::format("{} needs a label or a block number", how),
           fmt::format("write {} LABEL or {} N100; a label begins with two letters or '_'", how, how));
  }
  const size_t offset = reader.offset();
  reader.next();
  const auto forwards = [&] { return source().find_label(label, current_ + 1, 1); };
  const auto backwards = [&] { return source().find_label(label, current_, -1); };
  std::optional<int> index = how == "GOTOB" ? backwards() : forwards();
  if (!index && (how == "GOTO" || how == "GOTOC")) index = backwards();
  if (index) {
    jump(*index, reader.line());
  } else if (how != "GOTOC") {
    refuse(reader.line(), offset, "unknown-label",
           fmt::format("there is no {} {} this block", label,
                       how == "GOTOF"   ? "after"
                       : how == "GOTOB" ? "before"
                                        : "before or after"),
           "labels stand at the start of a block and end with ':'");
  }
}

/// CASE formula OF 1 GOTOF A 2 GOTOF B DEFAULT GOTOF C
void Flow::on_case(TokenReader& reader) {
  const double value = evaluate_number(reader, variables_);
  reader.expect("OF", "the formula of CASE");
  while (!reader.done()) {
    const bool hit = reader.skip("DEFAULT") || evaluate_number(reader, variables_) == value;
    const Token& word = reader.peek();
    if (word.kind != TokenKind::kName || !word.name.starts_with("GOTO") || handler_of(word.name) == nullptr) {
      refuse(reader.line(), reader.offset(), "bad-block", "a jump is missing after the value of CASE",
             "write CASE R1 OF 1 GOTOF LABEL");
    }
    reader.next();
    if (hit) {
      go(reader);
      return;
    }
    if (!reader.done()) reader.next();
  }
}

}  // namespace swarf::program::nc::siemens
