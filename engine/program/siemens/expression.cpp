#include "program/siemens/expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "base/units.h"
#include "program/siemens/functions.h"

namespace swarf::program::nc::siemens {
namespace {

constexpr int kDepthMax = 100;
constexpr double kRelativeEquality = 1e-12;

struct Binary {
  std::string_view symbol;
  int rank;  ///< binds more tightly when larger; equal ranks from the left (header)
};
constexpr std::array<Binary, 19> kBinary = {{{"==", 0},
                                             {"<>", 0},
                                             {">", 0},
                                             {"<", 0},
                                             {">=", 0},
                                             {"<=", 0},
                                             {"<<", 1},
                                             {"OR", 2},
                                             {"XOR", 3},
                                             {"AND", 4},
                                             {"B_OR", 5},
                                             {"B_XOR", 6},
                                             {"B_AND", 7},
                                             {"+", 8},
                                             {"-", 8},
                                             {"*", 9},
                                             {"/", 9},
                                             {"DIV", 9},
                                             {"MOD", 9}}};
/// Names that the control has for the types of machining of CYCLE832 (SINUMERIK ONE, NC programming, 12/2019:
/// units the type, tens the orientation tolerance, millions Top Surface); a variable of the program goes
/// before.
std::optional<int> cycle_constant(std::string_view name) {
  static constexpr std::pair<std::string_view, int> kNames[] = {{"_OFF", 0},
                                                                {"_FINISH", 1},
                                                                {"_SEMIFIN", 2},
                                                                {"_ROUGH", 3},
                                                                {"_PRECISION", 4},
                                                                {"_ORI_FINISH", 11},
                                                                {"_ORI_SEMIFIN", 12},
                                                                {"_ORI_ROUGH", 13},
                                                                {"_ORI_PRECISION", 14},
                                                                {"_TOP_SURFACE_SMOOTH_OFF", 1000000},
                                                                {"_TOP_SURFACE_SMOOTH_ON", 2000000}};
  for (const auto& [known, value] : kNames) {
    if (name == known) return value;
  }
  return std::nullopt;
}

class Evaluator {
 public:
  Evaluator(TokenReader& reader, Variables& variables) : reader_(reader), variables_(variables) {}

  /// A formula of operators that bind at least as tightly as `lowest`.
  Value formula(int lowest) {
    Value left = unary();
    for (const Binary* op = operator_here(); op != nullptr && op->rank >= lowest; op = operator_here()) {
      const size_t offset = reader_.offset();
      reader_.next();
      const Value right = formula(op->rank + 1);
      left = binary(op->symbol, left, right, offset);
    }
    return left;
  }

 private:
  const Binary* operator_here() const {
    const Token& token = reader_.peek();
    if (token.kind != TokenKind::kSymbol && token.kind != TokenKind::kName) return nullptr;
    const auto found = std::find_if(kBinary.begin(), kBinary.end(),
                                    [&](const Binary& one) { return same(token.name, one.symbol); });
    return found == kBinary.end() ? nullptr : &*found;
  }

  Value unary() {
    if (++depth_ > kDepthMax) {
      fail("bad-expression", reader_.offset(), "the formula is nested too deeply", "split it up");
    }
    const size_t offset = reader_.offset();
    Value value;
    const bool plain = reader_.peek().kind == TokenKind::kNumber;  // most are; no sign needs to be looked for
    if (!plain && reader_.skip("-")) {
      const Value operand = number(unary(), offset);
      value = {operand.type == Type::kBool ? Type::kInt : operand.type, -operand.number, {}};
    } else if (!plain && reader_.skip("+")) {
      value = number(unary(), offset);
    } else if (!plain && reader_.skip("NOT")) {
      value = Value::boolean(number(unary(), offset).number == 0.0);
    } else if (!plain && reader_.skip("B_NOT")) {
      value = Value::integer(~bits(unary(), offset));
    } else {
      value = primary();
    }
    --depth_;
    return value;
  }

  Value primary() {
    const size_t offset = reader_.offset();
    if (reader_.done()) fail("bad-expression", offset, "the formula ends too early", "write its next value");
    const Token& token = reader_.next();
    switch (token.kind) {
      case TokenKind::kNumber:
        return token.whole && std::fabs(token.number) <= INT32_MAX ? Value::integer(token.number)
                                                                   : Value::real(token.number);
      case TokenKind::kString:
        return Value::string(std::string(token.text));
      case TokenKind::kAddress:
        if (token.letter == 'R' && token.whole) return variables_.parameter(token.number, line(), offset);
        break;
      case TokenKind::kName:
        return named(token, offset);
      case TokenKind::kSymbol:
        if (token.name == "(") {
          Value value = formula(0);
          reader_.expect(")", "the formula in parentheses");
          return value;
        }
        break;
    }
    fail("bad-expression", offset, fmt::format("'{}' is not a value", token.text),
         "a formula has numbers, R parameters, variables and functions");
  }

  Value named(const Token& token, size_t offset) {
    if (const auto constant = cycle_constant(token.name); constant && variables_.find(token.name) == nullptr)
      return Value::integer(*constant);
    if (token.name == "TRUE" || token.name == "FALSE") return Value::boolean(token.name == "TRUE");
    if (token.name == "R" && reader_.peek().symbol("[")) {
      return variables_.parameter(index(), line(), offset);
    }
    if (reader_.peek().symbol("(")) return function(token, offset);
    if (token.name[0] == '$') {
      if (token.name == "$PI") return Value::real(kPi);
      reader_.back();
      const SystemName asked = system_name(reader_, variables_);
      if (variables_.system() != nullptr) return variables_.system()->read_system(asked);
      fail("unsupported-word", offset, fmt::format("the system variable {} is not simulated", asked.name),
           "write its value, or assign it to a variable of the program");
    }
    std::vector<double> indices;
    if (reader_.peek().symbol("[")) indices = evaluate_indices(reader_, variables_);
    return variables_.element(token.name, indices, line(), offset);
  }

  double index() {
    reader_.expect("[", "R");
    const size_t offset = reader_.offset();
    const double value = number(formula(0), offset).number;
    reader_.expect("]", "the index");
    return value;
  }

  Value function(const Token& token, size_t offset) {
    const std::string name = token.name;
    if (name == "CTRANS" || name == "CROT" || name == "CSCALE" || name == "CMIRROR") {
      fail("unsupported-word", offset, fmt::format("{} gives a frame, which no variable holds here", name),
           "write $P_UIFR[1,X,TR]= for offsets, TRANS and AROT for frames");
    }
    reader_.expect("(", name);
    std::vector<Value> arguments;
    if (!reader_.skip(")")) {
      do {
        arguments.push_back(formula(0));
      } while (reader_.skip(","));
      reader_.expect(")", "the arguments of " + name);
    }
    return call_function(name, arguments, line(), offset);
  }

  Value binary(std::string_view symbol, const Value& left, const Value& right, size_t offset) {
    if (symbol == "<<") return Value::string(as_text(left) + as_text(right));
    if (const bool texts = left.type == Type::kString && right.type == Type::kString;
        texts && (symbol == "==" || symbol == "<>")) {
      return Value::boolean((left.text == right.text) == (symbol == "=="));
    }
    const double a = number(left, offset).number, b = number(right, offset).number;
    if (symbol == "==" || symbol == "<>" || symbol[0] == '<' || symbol[0] == '>') {
      return compare(symbol, a, b);
    }
    if (symbol == "AND") return Value::boolean(a != 0.0 && b != 0.0);
    if (symbol == "OR") return Value::boolean(a != 0.0 || b != 0.0);
    if (symbol == "XOR") return Value::boolean((a != 0.0) != (b != 0.0));
    if (symbol == "B_AND") return Value::integer(bits(left, offset) & bits(right, offset));
    if (symbol == "B_OR") return Value::integer(bits(left, offset) | bits(right, offset));
    if (symbol == "B_XOR") return Value::integer(bits(left, offset) ^ bits(right, offset));
    return arithmetic(symbol, left, right, offset);
  }

  static Value compare(std::string_view symbol, double a, double b) {
    const bool same = std::fabs(a - b) <= kRelativeEquality * std::max(std::fabs(a), std::fabs(b));
    if (symbol == "==") return Value::boolean(same);
    if (symbol == "<>") return Value::boolean(!same);
    if (symbol == "<=") return Value::boolean(same || a < b);
    if (symbol == ">=") return Value::boolean(same || a > b);
    return Value::boolean(!same && (symbol == "<" ? a < b : a > b));
  }

  Value arithmetic(std::string_view symbol, const Value& left, const Value& right, size_t offset) {
    const double a = left.number, b = right.number;
    const bool whole = left.type != Type::kReal && right.type != Type::kReal;
    const bool divides = symbol == "/" || symbol == "DIV" || symbol == "MOD";
    if (divides && b == 0.0) {
      fail("division-by-zero", offset, fmt::format("{:g} {} {:g} divides by zero", a, symbol, b),
           "test the divisor before this block");
    }
    if (symbol == "MOD" && !whole) {
      fail("wrong-type", offset, "MOD takes whole numbers", "convert with TRUNC or ROUND into an INT first");
    }
    const double result = symbol == "+"     ? a + b
                          : symbol == "-"   ? a - b
                          : symbol == "*"   ? a * b
                          : symbol == "/"   ? a / b
                          : symbol == "DIV" ? std::trunc(a / b)
                                            : std::fmod(a, b);
    if (!std::isfinite(result)) {
      fail("out-of-range", offset, "the result does not fit the range of floating point",
           "check the values of the formula");
    }
    const bool integer = whole && symbol != "/";
    if (integer && std::fabs(result) > INT32_MAX) {
      fail("out-of-range", offset, fmt::format("{:g} does not fit INT", result),
           "write one of the numbers with a point to reckon with REAL");
    }
    return {integer ? Type::kInt : Type::kReal, result, {}};
  }

  int32_t bits(const Value& value, size_t offset) {
    return static_cast<int32_t>(converted(number(value, offset), Type::kInt, line(), offset).number);
  }

  const Value& number(const Value& value, size_t offset) const {
    if (value.type == Type::kString) {
      refuse(line(), offset, "wrong-type", "a text stands where a number is wanted",
             "texts can be compared with == and <> and joined with <<");
    }
    return value;
  }

  [[noreturn]] void fail(std::string code, size_t offset, std::string text, std::string fix) const {
    refuse(line(), offset, std::move(code), std::move(text), std::move(fix));
  }
  const LineRef& line() const { return reader_.line(); }

  TokenReader& reader_;
  Variables& variables_;
  int depth_ = 0;
};

}  // namespace

void TokenReader::expect(std::string_view symbol, std::string_view after) {
  if (skip(symbol)) return;
  refuse(line_, offset(), "bad-block", fmt::format("'{}' is missing after {}", symbol, after),
         fmt::format("write '{}' here", symbol));
}

size_t TokenReader::end_offset() const {
  if (tokens_.empty()) return 0;
  const Token& last = tokens_.back();
  return last.kind == TokenKind::kString ? last.offset + last.text.size() + 2
                                         : last.offset + last.text.size();
}

Value evaluate(TokenReader& reader, Variables& variables) {
  return Evaluator(reader, variables).formula(0);
}

double evaluate_number(TokenReader& reader, Variables& variables) {
  const size_t offset = reader.offset();
  return converted(evaluate(reader, variables), Type::kReal, reader.line(), offset).number;
}

std::vector<double> evaluate_indices(TokenReader& reader, Variables& variables) {
  std::vector<double> indices;
  reader.expect("[", "the name");
  do {
    indices.push_back(evaluate_number(reader, variables));
  } while (reader.skip(","));
  reader.expect("]", "the index");
  return indices;
}

SystemName system_name(TokenReader& reader, Variables& variables) {
  SystemName asked{reader.peek().name, {}, reader.line(), reader.offset()};
  reader.next();
  if (!reader.skip("[")) return asked;
  do {
    const Token& token = reader.peek();
    const bool ends = reader.peek(1).symbol(",") || reader.peek(1).symbol("]");
    const bool name =
        token.kind == TokenKind::kName && token.name[0] != '$' && variables.find(token.name) == nullptr;
    const bool machine_axis = token.kind == TokenKind::kAddress && token.letter != 'R';
    if (ends && (name || machine_axis)) {
      asked.indices.push_back(Value::string(capitals(token.text)));
      reader.next();
    } else {
      asked.indices.push_back(evaluate(reader, variables));
    }
  } while (reader.skip(","));
  reader.expect("]", "the index");
  return asked;
}

const std::vector<std::string>& expression_words() {
  static const std::vector<std::string> words = [] {
    std::vector<std::string> all = function_names();
    for (const char* word :
         {"AND", "OR", "XOR", "NOT", "B_AND", "B_OR", "B_XOR", "B_NOT", "DIV", "MOD", "TRUE", "FALSE"}) {
      all.emplace_back(word);
    }
    return all;
  }();
  return words;
}

}  // namespace swarf::program::nc::siemens
