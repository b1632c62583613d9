#include "program/siemens/flow_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "program/letters/arithmetic.h"

namespace swarf::program::nc::siemens {
namespace {

/// Ends a repetition or the program (`to_caller`: M17, also out of a repeated part); false at the last one.
bool leave_level(Flow& flow, bool to_caller) {
  if (!to_caller && top(flow).again > 0) {
    --top(flow).again;
    top(flow).next = top(flow).first;
    return true;
  }
  while (to_caller && top(flow).part && !top(flow).contour) flow.levels.leave();
  const Level left = flow.levels.leave();
  if (left.again > 0) {  // a subprogram with P that ended by M17
    flow.levels.enter(left);
    --top(flow).again;
    top(flow).next = top(flow).first;
    return true;
  }
  if (flow.levels.empty()) return false;
  flow.variables.enter(*top(flow).scope);
  const LineRef line = source(flow).line(std::max(0, top(flow).next - 1));
  for (const Returned& back : left.returned) {
    const Value& value = left.scope->at(back.parameter).values[0];
    Value& to = flow.variables.element(back.variable, {}, line, 0);
    to = converted(value, to.type, line, 0);
  }
  if (left.contour) flow.target.contour_read();
  return true;
}

/// /2 N100 LABEL:
void skip_head(Flow& flow, TokenReader& reader) {
  if (reader.skip("/")) {
    const bool level = reader.peek().kind == TokenKind::kNumber && reader.peek().whole;
    if (level) reader.next();
    flow.target.note("/", "block skip is off: the block is executed", source(flow).path(),
                     flow.line.current + 1);
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

void words(Flow& flow, TokenReader& reader) {
  const Token& first = reader.peek();
  if (first.kind == TokenKind::kName) {
    if (const Handler handler = handler_of(first.name)) {
      reader.next();
      handler(flow, reader);
      return;
    }
  }
  if (subprogram_here(flow, reader)) return;
  const long before = flow.target.moves();
  const Outcome outcome = flow.target.block(reader, flow.variables);
  if (outcome == Outcome::kContour) return enter_contour(flow);
  const bool modal = flow.modal.file >= 0 && flow.levels.size() == flow.modal.depth;
  // In a main program that is called, M2 and M30 mean M17 (manual, subprograms), and so at the end of a
  // contour.
  const auto called = [&] {
    const auto programs = flow.levels.count([](const Level& level) { return !level.part; });
    return programs > 1 || flow.levels.count([](const Level& level) { return level.contour; }) > 0;
  };
  const bool ends = outcome == Outcome::kEnd && !called();
  if (ends) {
    flow.levels.clear();
    flow.counts.ended = true;
  } else if (outcome == Outcome::kReturn || outcome == Outcome::kEnd) {
    leave_level(flow, true);
    flow.counts.ended = flow.levels.empty();
  } else if (modal && outcome == Outcome::kPattern) {
    refuse(flow.line.running, 0, "unsupported-word",
           "a position pattern while MCALL calls a program is not supported",
           "write the positions as blocks, or MCALL with a drilling cycle");
  } else if (modal && flow.target.moves() != before) {
    const ModalCall call_now = flow.modal;
    call(flow, call_now.file, nullptr, call_now.arguments, 1);
  }
}

void statement(Flow& flow) {
  const LineRef there = source(flow).line(flow.line.current);
  flow.line.text = there.text;  // stays while other lines are looked at
  flow.line.running = {there.file, there.line, flow.line.text};
  const LineRef& line = flow.line.running;
  if (flow.line.current == 0 && line.text.starts_with('%')) {
    flow.target.note("%", std::string(line.text), source(flow).path(),
                     1);  // name of the program, as archives have it
    return;
  }
  lex(line, flow.line.tokens);
  if (flow.line.tokens.empty()) return;
  TokenReader reader(line, flow.line.tokens);
  skip_head(flow, reader);
  if (reader.done()) return;
  ++flow.counts.blocks;
  words(flow, reader);
}

bool condition(Variables& variables, TokenReader& reader) {
  const size_t offset = reader.offset();
  return converted(evaluate(reader, variables), Type::kBool, reader.line(), offset).number != 0.0;
}

/// Goes on with a line of the running program; jumps back are counted against endless loops.
void jump(Flow& flow, int index, const LineRef& from) {
  while (top(flow).part && (index < top(flow).first || index >= top(flow).stop)) {
    if (top(flow).contour)
      refuse(from, 0, "bad-contour", "a jump leaves the blocks between the labels of a contour",
             "end the contour at its last label, or write it as a program of its own");
    flow.levels.leave();
  }
  top(flow).next = index;
  if (index > flow.line.current) return;
  if (flow.target.moves() != flow.counts.moves_seen) flow.counts.jumps = 0;
  flow.counts.moves_seen = flow.target.moves();
  if (++flow.counts.jumps <= flow.limits.jumps_max) return;
  refuse(from, 0, "endless-loop",
         fmt::format("the program jumped back {} times without a move, last in this block",
                     flow.limits.jumps_max),
         "check the condition of the loop");
}

/// The label or number after GOTOF, GOTOB, GOTO (forwards, then backwards) or GOTOC (no error without one).
void go(Flow& flow, TokenReader& reader) {
  const Token& word = reader.peek();
  const std::string how = [&] {
    // The jump word stands just before the reader's place.
    const Token& jump_word = flow.line.tokens[reader.position() - 1];
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
  const auto forwards = [&] { return source(flow).find_label(label, flow.line.current + 1, 1); };
  const auto backwards = [&] { return source(flow).find_label(label, flow.line.current, -1); };
  std::optional<int> index = how == "GOTOB" ? backwards() : forwards();
  if (!index && (how == "GOTO" || how == "GOTOC")) index = backwards();
  if (index) {
    jump(flow, *index, reader.line());
  } else if (how != "GOTOC") {
    refuse(reader.line(), offset, "unknown-label",
           fmt::format("there is no {} {} this block", label,
                       how == "GOTOF"   ? "after"
                       : how == "GOTOB" ? "before"
                                        : "before or after"),
           "labels stand at the start of a block and end with ':'");
  }
}

void on_goto(Flow& flow, TokenReader& reader) {
  go(flow, reader);
  finish_block(reader, "the jump");
}

void on_if(Flow& flow, TokenReader& reader) {
  const bool holds = condition(flow.variables, reader);
  const Token& token = reader.peek();
  if (token.kind == TokenKind::kName && token.name.starts_with("GOTO") && handler_of(token.name) != nullptr) {
    if (!holds) return;
    reader.next();
    on_goto(flow, reader);
    return;
  }
  finish_block(reader, "IF and its condition");
  const int partner = source(flow).partner(flow.line.current);
  if (!holds) jump(flow, partner + 1, reader.line());
}

void on_else(Flow& flow, TokenReader& reader) {
  finish_block(reader, "ELSE");
  jump(flow, source(flow).partner(flow.line.current), reader.line());
}

/// LOOP and ENDIF: only their partners matter.
void on_nothing(Flow& flow, TokenReader& reader) {
  finish_block(reader, "this word");
  source(flow).partner(flow.line.current);
}

void on_while(Flow& flow, TokenReader& reader) {
  const bool holds = condition(flow.variables, reader);
  finish_block(reader, "WHILE and its condition");
  const int end = source(flow).partner(flow.line.current);
  if (!holds) jump(flow, end + 1, reader.line());
}

void on_back(Flow& flow, TokenReader& reader) {
  finish_block(reader, "the end of the loop");
  jump(flow, source(flow).partner(flow.line.current), reader.line());
}

/// What FOR counts with: R7, or a declared variable of type INT or REAL.
struct LoopCounter {
  Variable* variable = nullptr;  ///< null: an R parameter
  double parameter = 0.0;        ///< its number
};

LoopCounter read_counter(Variables& variables, TokenReader& reader, const LineRef& head) {
  const Token& name = reader.peek();
  LoopCounter counter;
  if (name.kind == TokenKind::kName && is_parameter(name.name)) {
    nc::read_number(std::string_view(name.name).substr(1), counter.parameter);
  } else {
    counter.variable = name.kind == TokenKind::kName ? variables.find(name.name) : nullptr;
    const bool counts = counter.variable != nullptr && counter.variable->sizes.empty() &&
                        (counter.variable->type == Type::kInt || counter.variable->type == Type::kReal);
    if (!counts) {
      refuse(head, reader.offset(), "bad-block", "FOR counts with an R parameter or a declared INT or REAL",
             "FOR R1=1 TO 5, or declare it: DEF INT N, then FOR N=1 TO 5");
    }
  }
  reader.next();
  return counter;
}

/// A count is whole: the control rounds what a REAL is given.
double set_counter(Variables& variables, const LoopCounter& counter, const Value& value,
                   const LineRef& head) {
  const Value whole = converted(value, Type::kInt, head, 0);
  if (counter.variable == nullptr) {
    variables.set_parameter(counter.parameter, whole, head, 0);
  } else {
    counter.variable->values[0] = converted(whole, counter.variable->type, head, 0);
  }
  return whole.number;
}

double counted(const Variables& variables, const LoopCounter& counter, const LineRef& head) {
  return counter.variable == nullptr ? variables.parameter(counter.parameter, head, 0).number
                                     : counter.variable->values[0].number;
}

/// FOR n = first TO last: true while the variable has not passed `last`.
bool for_goes_on(Variables& variables, TokenReader& reader, const LineRef& head, bool first) {
  const LoopCounter counter = read_counter(variables, reader, head);
  reader.expect("=", "the variable of FOR");
  const Value start = evaluate(reader, variables);
  reader.expect("TO", "the first value of FOR");
  const double last = evaluate_number(reader, variables);
  finish_block(reader, "FOR");
  const Value value = first ? start : Value::real(counted(variables, counter, head) + 1.0);
  return set_counter(variables, counter, value, head) <= last;
}

void on_for(Flow& flow, TokenReader& reader) {
  const bool runs = for_goes_on(flow.variables, reader, reader.line(), true);
  const int end = source(flow).partner(flow.line.current);
  if (!runs) jump(flow, end + 1, reader.line());
}

void on_endfor(Flow& flow, TokenReader& reader) {
  finish_block(reader, "ENDFOR");
  const int head = source(flow).partner(flow.line.current);
  const LineRef line = source(flow).line(head);
  std::vector<Token> tokens;
  lex(line, tokens);
  TokenReader again(line, tokens);
  while (!again.skip("FOR")) again.next();
  if (for_goes_on(flow.variables, again, line, false)) jump(flow, head + 1, reader.line());
}

void on_until(Flow& flow, TokenReader& reader) {
  const bool done = condition(flow.variables, reader);
  finish_block(reader, "UNTIL and its condition");
  const int head = source(flow).partner(flow.line.current);
  if (!done) jump(flow, head + 1, reader.line());
}

/// CASE formula OF 1 GOTOF A 2 GOTOF B DEFAULT GOTOF C
void on_case(Flow& flow, TokenReader& reader) {
  const double value = evaluate_number(reader, flow.variables);
  reader.expect("OF", "the formula of CASE");
  while (!reader.done()) {
    const bool hit = reader.skip("DEFAULT") || evaluate_number(reader, flow.variables) == value;
    const Token& word = reader.peek();
    if (word.kind != TokenKind::kName || !word.name.starts_with("GOTO") || handler_of(word.name) == nullptr) {
      refuse(reader.line(), reader.offset(), "bad-block", "a jump is missing after the value of CASE",
             "write CASE R1 OF 1 GOTOF LABEL");
    }
    reader.next();
    if (hit) {
      go(flow, reader);
      return;
    }
    if (!reader.done()) reader.next();
  }
}

}  // namespace

Flow::Flow(BlockTarget& blocks, std::vector<std::string> subprogram_folders, FlowLimits most)
    : target(blocks), limits(most) {
  programs.folders = std::move(subprogram_folders);
  variables.connect(target);
}

Handler handler_of(const std::string& word) {
  static const std::map<std::string, Handler> handlers = {
      {"IF", &on_if},         {"ELSE", &on_else},    {"ENDIF", &on_nothing}, {"WHILE", &on_while},
      {"ENDWHILE", &on_back}, {"FOR", &on_for},      {"ENDFOR", &on_endfor}, {"LOOP", &on_nothing},
      {"ENDLOOP", &on_back},  {"UNTIL", &on_until},  {"REPEAT", &on_repeat}, {"REPEATB", &on_repeat},
      {"GOTOF", &on_goto},    {"GOTOB", &on_goto},   {"GOTO", &on_goto},     {"GOTOC", &on_goto},
      {"CASE", &on_case},     {"DEF", &on_def},      {"PROC", &on_proc},     {"EXTERN", &on_extern},
      {"CALL", &on_call},     {"EXTCALL", &on_call}, {"MCALL", &on_mcall},
  };
  const auto found = handlers.find(word);
  return found == handlers.end() ? nullptr : found->second;
}

void finish_block(TokenReader& reader, std::string_view after) {
  if (reader.done()) return;
  refuse(reader.line(), reader.offset(), "bad-block",
         fmt::format("'{}' does not belong after {}", reader.peek().text, after),
         "write it in a block of its own");
}

void run(Flow& flow, const std::string& path) {
  flow.programs.sources.push_back(std::make_unique<Source>(path));
  flow.counts.lines = flow.programs.sources[0]->lines();
  Level main;
  main.stop = flow.programs.sources[0]->lines();
  main.scope = std::make_shared<Scope>();
  flow.levels.enter(std::move(main));
  flow.variables.enter(*top(flow).scope);
  while (!flow.levels.empty() && !flow.counts.stopped) {
    if (top(flow).next >= top(flow).stop) {
      leave_level(flow, false);
      continue;
    }
    flow.line.current = top(flow).next++;
    statement(flow);
  }
}

}  // namespace swarf::program::nc::siemens
