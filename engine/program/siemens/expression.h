// Formulas of Siemens 840D, evaluated where they stand.
//
//  priority: 1 NOT B_NOT - + | 2 * / DIV MOD | 3 + - | 4 B_AND | 5 B_XOR | 6 B_OR | 7 AND | 8 XOR | 9 OR
//            10 << | 11 == <> > < >= <=
//
//  Angles are degrees. INT / INT is REAL; DIV gives whole numbers; REALs are compared with a relative
//  tolerance of 1e-12, as the control does. A comparison as operand of AND needs its own parentheses.
#pragma once

#include <vector>

#include "program/siemens/variables.h"

namespace swarf::program::nc::siemens {

/// Behind the last one.
inline const Token kNoToken;

/// A place in the tokens of a line; formulas are read from it and move it on.
class TokenReader {
 public:
  TokenReader(const LineRef& line, const std::vector<Token>& tokens) : line_(line), tokens_(tokens) {}

  bool done() const { return at_ >= tokens_.size(); }
  const Token& peek(size_t ahead = 0) const {
    return at_ + ahead < tokens_.size() ? tokens_[at_ + ahead] : kNoToken;
  }
  const Token& next() { return tokens_[at_++]; }
  const Token& previous() const { return tokens_[at_ - 1]; }
  /// Steps back to the token before.
  void back() { --at_; }
  bool skip(std::string_view symbol_or_name) {
    if (!here(symbol_or_name)) return false;
    ++at_;
    return true;
  }
  /// Throws InputError "bad-block" unless the symbol stands here.
  void expect(std::string_view symbol, std::string_view after);
  /// Byte offset of the token here, or of the end of the line.
  size_t offset() const { return done() ? end_offset() : tokens_[at_].offset; }
  const LineRef& line() const { return line_; }
  size_t position() const { return at_; }

 private:
  bool here(std::string_view symbol_or_name) const {
    if (done()) return false;
    const Token& token = tokens_[at_];
    return (token.kind == TokenKind::kSymbol || token.kind == TokenKind::kName) &&
           same(token.name, symbol_or_name);
  }
  size_t end_offset() const;

  const LineRef& line_;
  const std::vector<Token>& tokens_;
  size_t at_ = 0;
};

/// Evaluates the formula that starts here. Throws InputError: "bad-expression", "wrong-type",
/// "division-by-zero", "out-of-domain" (ASIN, ACOS, SQRT, LN, TAN at its pole), "out-of-range",
/// "undefined-variable", "undefined-parameter", "unsupported-word" (system variables).
Value evaluate(TokenReader& reader, Variables& variables);
/// A number; texts are refused.
double evaluate_number(TokenReader& reader, Variables& variables);
/// [a] or [a,b]: reads the brackets and their formulas.
std::vector<double> evaluate_indices(TokenReader& reader, Variables& variables);

/// $NAME or $NAME[...], which stands here. Names among the indices (X, TR) that are no variables are texts.
SystemName system_name(TokenReader& reader, Variables& variables);

/// Names that formulas know: functions and operators.
const std::vector<std::string>& expression_words();

}  // namespace swarf::program::nc::siemens
