// Values in letter dialects: numbers, #parameters, [formulas] and functions, as data says how they are spelt.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "program/control/control.h"
#include "program/letters/arithmetic.h"

namespace swarf::program::nc {

struct FunctionWord {
  std::string_view word;  ///< in capitals
  Function function;
};
struct OperatorWord {
  std::string_view word;  ///< in capitals; longer words before their beginnings
  Operator op;
  int rank;  ///< binds more tightly when larger; equal ranks from the left
};
struct FormulaSyntax {
  std::span<const FunctionWord> functions;
  std::span<const OperatorWord> operators;
  bool named_parameters = false;      ///< #<name> and EXISTS[#<name>]
  bool null_variable = false;         ///< #0 and variables without a value are vacant: not a number
  bool arc_tangent_positive = false;  ///< ATAN[y]/[x] in [0, 360)
};

/// The parameters of a program. Faults are thrown through the control.
class Parameters {
 public:
  virtual ~Parameters() = default;
  /// "undefined-parameter" where none was assigned. `place`: byte offset in the line, for faults.
  virtual double read(long number, size_t place) = 0;
  virtual double read_named(std::string_view name, size_t place) = 0;
  virtual bool exists(std::string_view name) = 0;
  /// Whether nothing assigned it; asked only where FormulaSyntax::null_variable is set.
  virtual bool vacant(long number) const = 0;
};

/// Reads values out of one line.
class FormulaReader {
 public:
  FormulaReader(const FormulaSyntax& syntax, Parameters& parameters, Control& control)
      : syntax_(syntax), parameters_(parameters), control_(control) {}
  void begin(std::string_view line) { line_ = line, at_ = 0, depth_ = 0; }

  std::string_view line() const { return line_; }
  size_t at() const { return at_; }
  void move_to(size_t at) { at_ = at; }
  bool done() const { return at_ >= line_.size(); }
  char peek() const { return at_ < line_.size() ? line_[at_] : '\0'; }
  /// The letter here in capitals.
  char peek_upper() const;
  void skip_space() {
    while (at_ < line_.size() && (line_[at_] == ' ' || line_[at_] == '\t')) ++at_;
  }
  void skip() { ++at_; }
  int column() const;
  int column_of(size_t at) const;
  /// True when `word` (capitals) stands here; skips it then.
  bool take(std::string_view word);
  /// A value of a word: number, parameter, formula, function, with an optional sign; not a number for a
  /// vacant variable.
  double value();
  /// A formula without brackets, as far as it goes (right sides of Fanuc's assignments); not a number where
  /// it is a vacant variable alone.
  double open_formula() { return expression(0); }
  /// What stands in brackets, the opening one still to come.
  double bracketed();
  /// '#' and what it names: a number, or a name (returned in `name`, in small letters).
  long parameter_number(std::string& name);

 private:
  double expression(int lowest_rank);
  double function_value();
  double parameter_value();
  double with_vacant(Operator op, double left, double right, size_t from);
  const OperatorWord* peek_operator();
  [[noreturn]] void refuse(size_t at, const char* code, std::string text, std::string fix) const;
  double checked(std::optional<double> result, size_t at, const std::string& why) const;

  const FormulaSyntax& syntax_;
  Parameters& parameters_;
  Control& control_;
  std::string_view line_;
  size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace swarf::program::nc
