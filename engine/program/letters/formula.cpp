#include "program/letters/formula.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "program/letters/line_source.h"

namespace swarf::program::nc {
namespace {

constexpr int kDepthMax = 100;

char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}
char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

}  // namespace

char FormulaReader::peek_upper() const {
  return upper(peek());
}

int FormulaReader::column() const {
  return column_at(line_, at_);
}

int FormulaReader::column_of(size_t at) const {
  return column_at(line_, at);
}

void FormulaReader::refuse(size_t at, const char* code, std::string text, std::string fix) const {
  control_.report.fail(code, column_at(line_, at), std::move(text), std::move(fix));
}

double FormulaReader::checked(std::optional<double> result, size_t at, const std::string& why) const {
  if (result) return *result;
  refuse(at, "bad-arithmetic", why, "check the numbers that lead here");
}

bool FormulaReader::take(std::string_view word) {
  if (line_.size() - at_ < word.size()) return false;
  for (size_t i = 0; i < word.size(); ++i) {
    if (upper(line_[at_ + i]) != word[i]) return false;
  }
  at_ += word.size();
  return true;
}

double FormulaReader::value() {
  skip_space();
  const size_t from = at_;
  double number = 0.0;
  const size_t length = read_number(line_.substr(at_), number);
  if (length == std::string_view::npos)
    refuse(from, "bad-number", "this number does not fit the range of floating point",
           "write a number of at most 15 digits");
  if (length > 0) {
    at_ += length;
    return number;
  }
  if (peek() == '-' || peek() == '+') {
    const bool minus = peek() == '-';
    skip();
    skip_space();
    if (peek() == '-' || peek() == '+')
      refuse(from, "bad-number", "two signs stand one after the other", "write one sign");
    const double amount = value();
    return minus ? -amount : amount;
  }
  if (peek() == '[') return bracketed();
  if (peek() == '#') return parameter_value();
  return function_value();
}

double FormulaReader::bracketed() {
  const size_t from = at_;
  if (peek() != '[') refuse(from, "bad-expression", "a '[' is missing here", "write [ before the formula");
  if (++depth_ > kDepthMax)
    refuse(from, "bad-expression", fmt::format("more than {} brackets in one another", kDepthMax),
           "compute a part of the formula into a parameter first");
  skip();
  const double result = expression(0);
  if (std::isnan(result))
    refuse(from, "undefined-parameter", "the variable in these brackets is vacant: nothing assigned it",
           "assign it before it is read");
  skip_space();
  if (peek() != ']')
    refuse(at_, "bad-expression", done() ? "the '[' is not closed" : "an operator or ']' is missing here",
           "close the formula with ]");
  skip();
  --depth_;
  return result;
}

const OperatorWord* FormulaReader::peek_operator() {
  skip_space();
  const char first = peek_upper();
  if (first == ']' || first == '\0') return nullptr;
  for (const OperatorWord& one : syntax_.operators) {
    const size_t from = at_;
    if (one.word[0] != first || !take(one.word)) continue;
    at_ = from;
    return &one;
  }
  return nullptr;
}

double FormulaReader::expression(int lowest_rank) {
  double left = value();
  for (const OperatorWord* op = peek_operator(); op != nullptr && op->rank >= lowest_rank;
       op = peek_operator()) {
    const size_t from = at_;
    at_ += op->word.size();
    const double right = expression(op->rank + 1);
    std::string why;
    left = std::isnan(left) || std::isnan(right) ? with_vacant(op->op, left, right, from)
                                                 : checked(apply(op->op, left, right, why), from, why);
  }
  return left;
}

double FormulaReader::function_value() {
  const size_t from = at_;
  if (syntax_.named_parameters && take("EXISTS")) {
    skip_space();
    if (peek() != '[')
      refuse(at_, "bad-expression", "EXISTS asks for a named parameter", "write EXISTS[#<name>]");
    skip();
    skip_space();
    std::string name;
    if (peek() != '#')
      refuse(at_, "bad-expression", "EXISTS asks for a named parameter", "write EXISTS[#<name>]");
    const size_t at_name = at_;
    parameter_number(name);
    if (name.empty())
      refuse(at_name, "bad-expression", "EXISTS asks for a named parameter", "write EXISTS[#<name>]");
    skip_space();
    if (peek() != ']') refuse(at_, "bad-expression", "the '[' is not closed", "write EXISTS[#<name>]");
    skip();
    return parameters_.exists(name) ? 1.0 : 0.0;
  }
  if (take("ATAN")) {
    skip_space();
    const double y = bracketed();
    skip_space();
    std::string why;
    if (peek() != '/')
      refuse(at_, "bad-expression", "ATAN needs both sides of the triangle", "write ATAN[y]/[x]");
    skip();
    skip_space();
    return checked(arc_tangent(y, bracketed(), syntax_.arc_tangent_positive, why), from, why);
  }
  const char first = peek_upper();
  for (const FunctionWord& one : syntax_.functions) {
    if (one.word[0] != first || !take(one.word)) continue;
    skip_space();
    if (peek() == '[') {
      const double argument = bracketed();
      std::string why;
      return checked(apply(one.function, argument, why), from, why);
    }
    at_ = from;
  }
  refuse(from, "bad-number",
         done()          ? "a number is missing at the end of the line"
         : peek() == '(' ? "a comment stands between the letter and its number"
                         : "a number is missing here",
         "write a number, #parameter or [formula]");
}

long FormulaReader::parameter_number(std::string& name) {
  const size_t from = at_;
  name.clear();
  skip();  // '#'
  skip_space();
  if (peek() == '<' && syntax_.named_parameters) {
    skip();
    for (; !done() && peek() != '>'; skip()) {
      if (peek() != ' ' && peek() != '\t') name += lower(peek());
    }
    if (done() || name.empty())
      refuse(from, "bad-parameter", "the name of this parameter does not end", "write #<name>");
    skip();
    return 0;
  }
  const double number = value();
  const long whole = std::isnan(number) ? -1 : std::lround(std::clamp(number, -1e9, 1e9));
  if (!(std::abs(number - static_cast<double>(whole)) <= 1e-6) || whole < 0)
    refuse(from, "bad-parameter", fmt::format("#{:g} is not the number of a parameter", number),
           "parameters have whole numbers from 1");
  return whole;
}

/// A vacant variable equals another vacant one and no number; elsewhere it counts as zero.
double FormulaReader::with_vacant(Operator op, double left, double right, size_t from) {
  const bool both = std::isnan(left) && std::isnan(right);
  if (op == Operator::kEqual) return both ? 1.0 : 0.0;
  if (op == Operator::kNotEqual) return both ? 0.0 : 1.0;
  control_.report.warn_once("vacant-value", column_at(line_, from), "a vacant variable counts as zero here",
                            "assign it before it is read");
  std::string why;
  return checked(apply(op, std::isnan(left) ? 0.0 : left, std::isnan(right) ? 0.0 : right, why), from, why);
}

double FormulaReader::parameter_value() {
  const size_t from = at_;
  std::string name;
  if (++depth_ > kDepthMax)
    refuse(from, "bad-expression", fmt::format("more than {} levels in one another", kDepthMax),
           "compute a part of the formula into a parameter first");
  const long number = parameter_number(name);
  --depth_;
  if (syntax_.null_variable && parameters_.vacant(number)) return std::numeric_limits<double>::quiet_NaN();
  return name.empty() ? parameters_.read(number, from) : parameters_.read_named(name, from);
}

}  // namespace swarf::program::nc
