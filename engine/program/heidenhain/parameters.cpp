#include "program/heidenhain/parameters.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>

#include "base/units.h"
#include "program/control/presets.h"
#include "program/letters/arithmetic.h"

namespace swarf::program::nc::heidenhain {
namespace {

using nc::Function;
using nc::Operator;

constexpr int kBracketsMax = 64;
constexpr int kNumberMax = 1999;

double checked(BlockReader& reader, std::optional<double> value, size_t offset, const std::string& why) {
  if (value && std::isfinite(*value)) return *value;
  reader.fail("out-of-domain", offset, why.empty() ? "the result is too large for a number" : why,
              "correct the formula, or the values that it is given");
}

double sum(BlockReader& reader, int depth);

double apply_function(BlockReader& reader, std::string_view word, double x, size_t offset) {
  struct Named {
    std::string_view word;
    Function function;
  };
  static constexpr std::array<Named, 9> kNamed{{{"SIN", Function::kSin},
                                                {"COS", Function::kCos},
                                                {"TAN", Function::kTan},
                                                {"ASIN", Function::kAsin},
                                                {"ACOS", Function::kAcos},
                                                {"ATAN", Function::kAtan},
                                                {"SQRT", Function::kSqrt},
                                                {"LN", Function::kLn},
                                                {"EXP", Function::kExp}}};
  std::string why;
  for (const Named& one : kNamed) {
    if (one.word == word) return checked(reader, nc::apply(one.function, x, why), offset, why);
  }
  if (word == "LOG") return checked(reader, nc::apply(Function::kLn, x, why), offset, why) / std::log(10.0);
  if (word == "SQ") return checked(reader, x * x, offset, why);
  if (word == "ABS") return std::abs(x);
  if (word == "NEG") return -x;
  if (word == "INT") return std::trunc(x);
  if (word == "FRAC") return x - std::trunc(x);
  if (word == "SGN") return x < 0.0 ? -1.0 : 1.0;
  static const std::vector<std::string> known{"SIN",  "COS", "TAN",  "ASIN", "ACOS", "ATAN",
                                              "SQRT", "LN",  "EXP",  "LOG",  "SQ",   "ABS",
                                              "NEG",  "INT", "FRAC", "SGN",  "PI"};
  const std::string near = nearest_name(word, known);
  reader.fail(
      "unknown-word", offset, fmt::format("{} is no function of a formula", word),
      near.empty() ? "write SIN, COS, SQRT ... or a parameter" : fmt::format("did you mean {}?", near));
}

double operand(BlockReader& reader, int depth) {
  reader.done();
  const size_t start = reader.offset();
  if (depth > kBracketsMax)
    reader.fail("bad-expression", start, "the formula is nested too deeply", "split it into several blocks");
  if (reader.peek() == '-' || reader.peek() == '+') {
    const double sign = reader.peek() == '-' ? -1.0 : 1.0;
    reader.skip();
    return sign * operand(reader, depth + 1);
  }
  if (reader.take_char('(')) {
    const double inner = sum(reader, depth + 1);
    if (!reader.take_char(')')) {
      reader.done();
      reader.fail("bad-expression", reader.offset(), "a closing bracket is missing here", "write )");
    }
    return inner;
  }
  if (reader.value_follows()) return reader.value();
  const std::string word(reader.letters());
  if (word.empty()) {
    reader.fail("bad-expression", start, "a number, a parameter or a function is missing here",
                "complete the formula");
  }
  reader.take_letters();
  if (word == "PI") return kPi;
  return apply_function(reader, word, operand(reader, depth + 1), start);
}

double power(BlockReader& reader, int depth) {
  double left = operand(reader, depth);
  for (;;) {
    reader.done();
    const size_t start = reader.offset();
    if (!reader.take_char('^')) return left;
    std::string why;
    left = checked(reader, nc::apply(Operator::kPower, left, operand(reader, depth), why), start, why);
  }
}

double product(BlockReader& reader, int depth) {
  double left = power(reader, depth);
  for (;;) {
    reader.done();
    const size_t start = reader.offset();
    const char c = reader.peek();
    if (c != '*' && c != '/' && c != '%') return left;
    reader.skip();
    const double right = power(reader, depth);
    std::string why;
    const Operator op = c == '*' ? Operator::kMultiply : Operator::kDivide;
    if (c == '%') {
      if (right == 0.0) reader.fail("out-of-domain", start, "division by zero", "correct the divisor");
      left = std::fmod(left, right);
    } else {
      left = checked(reader, nc::apply(op, left, right, why), start, why);
    }
  }
}

double sum(BlockReader& reader, int depth) {
  double left = product(reader, depth);
  for (;;) {
    reader.done();
    const size_t start = reader.offset();
    const char c = reader.peek();
    if (c != '+' && c != '-') return left;
    reader.skip();
    const double right = product(reader, depth);
    std::string why;
    left = checked(reader, nc::apply(c == '+' ? Operator::kAdd : Operator::kSubtract, left, right, why),
                   start, why);
  }
}

}  // namespace

Parameters::Name Parameters::name(BlockReader& reader) {
  reader.done();
  const size_t start = reader.offset();
  const std::string word(reader.take_letters());
  Name name;
  if (word == "QL" || word == "QR" || word == "QS") {
    name.kind = word[1];
  } else if (word != "Q") {
    reader.fail("bad-parameter", start, "a Q parameter belongs here", "write Q1, QL1, QR1 or QS1");
  }
  name.number = static_cast<int>(reader.whole_number(kNumberMax));
  return name;
}

std::string Parameters::text_of(const Name& name) {
  return name.kind == 'Q' ? fmt::format("Q{}", name.number) : fmt::format("Q{}{}", name.kind, name.number);
}

std::optional<double> Parameters::find(const Name& name) const {
  const std::map<int, double>& values = name.kind == 'L' ? local_ : name.kind == 'R' ? kept_ : global_;
  const auto found = values.find(name.number);
  if (found == values.end()) return std::nullopt;
  return found->second;
}

void Parameters::forget(const Name& name) {
  (name.kind == 'L' ? local_ : name.kind == 'R' ? kept_ : global_).erase(name.number);
}

double Parameters::read(BlockReader& reader) {
  reader.done();
  const size_t start = reader.offset();
  const Name asked = name(reader);
  if (asked.kind == 'S') {
    reader.fail("bad-parameter", start, "QS parameters hold text, and a number belongs here", "use Q");
  }
  if (const std::optional<double> value = find(asked)) return *value;
  reader.fail("undefined-parameter", start, fmt::format("{} has no value", text_of(asked)),
              "assign it before it is used: Q1 = 10");
}

std::string Parameters::read_text(BlockReader& reader) {
  const size_t start = reader.offset();
  const Name asked = name(reader);
  if (asked.kind != 'S')
    reader.fail("bad-parameter", start, "a text belongs here", "write \"NAME\" or a QS parameter");
  const auto found = texts_.find(asked.number);
  if (found != texts_.end()) return found->second;
  reader.fail("undefined-parameter", start, fmt::format("{} has no value", text_of(asked)),
              "assign it before it is used: QS1 = \"TEXT\"");
}

void Parameters::set(const Name& name, double value) {
  (name.kind == 'L' ? local_ : name.kind == 'R' ? kept_ : global_)[name.number] = value;
}

void Parameters::set_presets(const Presets& presets) {
  for (const auto& [name, preset] : presets) {
    const char kind = name.starts_with("QL") ? 'L' : name.starts_with("QR") ? 'R' : 'Q';
    const std::optional<long> number = preset_number(name, kind == 'Q' ? "Q" : name.substr(0, 2));
    if (!number || *number > kNumberMax)
      refuse_preset(name, preset, "programs read Q0 to Q1999, QL and QR: Q5 = 2");
    set({kind, static_cast<int>(*number)}, preset.value);
  }
}

void Parameters::assign(BlockReader& reader, const Name& name) {
  if (name.kind != 'S') {
    set(name, formula(reader));
    return;
  }
  std::string text = reader.text_value();
  while (reader.take_char('|')) {
    if (!reader.take_char('|'))
      reader.fail("bad-expression", reader.offset(), "texts are joined by ||", "QS1 = QS2 || QS3");
    text += reader.text_value();
  }
  reader.expect_end();
  texts_[name.number] = text;
}

std::map<int, double> Parameters::swap_local(std::map<int, double> local) {
  std::swap(local_, local);
  return local;
}

double formula(BlockReader& reader) {
  const double value = sum(reader, 0);
  if (!reader.done()) {
    reader.fail("bad-expression", reader.offset(), "the formula ends here, the block does not",
                "write an operator between two values");
  }
  return value;
}

void basic_function(BlockReader& reader, int number) {
  const Parameters::Name name = Parameters::name(reader);
  const auto word = [&](std::string_view expected) {
    reader.done();
    if (!reader.take(expected))
      reader.fail("missing-word", reader.offset(), fmt::format("FN {} wants {} here", number, expected),
                  "complete the function");
  };
  const auto sign = [&](char expected) {
    if (!reader.take_char(expected))
      reader.fail("missing-word", reader.offset(), fmt::format("FN {} wants {} here", number, expected),
                  "complete the function");
  };
  sign('=');
  reader.done();
  const size_t start = reader.offset();
  std::string why;
  std::optional<double> result;
  if (number >= 5 && number <= 7) {
    word(number == 5 ? "SQRT" : number == 6 ? "SIN" : "COS");
    const Function function = number == 5 ? Function::kSqrt : number == 6 ? Function::kSin : Function::kCos;
    result = nc::apply(function, reader.value(), why);
  } else {
    const double a = reader.value();
    if (number == 0) result = a;
    if (number == 1) sign('+'), result = nc::apply(Operator::kAdd, a, reader.value(), why);
    if (number == 2) sign('-'), result = nc::apply(Operator::kSubtract, a, reader.value(), why);
    if (number == 3) sign('*'), result = nc::apply(Operator::kMultiply, a, reader.value(), why);
    if (number == 4) word("DIV"), result = nc::apply(Operator::kDivide, a, reader.value(), why);
    if (number == 8) word("LEN"), result = std::hypot(a, reader.value());
    if (number == 13) word("ANG"), result = nc::arc_tangent(a, reader.value(), true, why);
  }
  const double value = checked(reader, result, start, why);
  reader.expect_end();
  reader.parameters().set(name, value);
}

}  // namespace swarf::program::nc::heidenhain
