// Q parameters and formulas of Heidenhain programs.
//
// Order of a formula, as the control's manual states it: brackets, sign of an operand, functions, ^, then
// * / %, then + -; equal ranks from the left. So SIN Q3 ^ 2 = (SIN Q3)^2, -3^2 = 9, 2 ^ 3 ^ 2 = 64.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "program/heidenhain/text.h"
#include "program/nc_program.h"

namespace swarf::program::nc::heidenhain {

/// Q and QR hold in every program; QL belong to one program level.
class Parameters {
 public:
  struct Name {
    char kind = 'Q';  ///< 'Q', 'L' (QL), 'R' (QR), 'S' (QS)
    int number = 0;
  };
  /// Q5, QL3, QR7, QS1 at the reader's place ("bad-parameter").
  static Name name(BlockReader& reader);
  static std::string text_of(const Name& name);

  /// The number of the parameter here ("undefined-parameter").
  double read(BlockReader& reader);
  std::string read_text(BlockReader& reader);
  std::optional<double> find(const Name& name) const;
  std::optional<double> find_q(int number) const { return find({'Q', number}); }
  void set(const Name& name, double value);
  /// Q, QL of the main program, QR. Throws InputError "bad-preset".
  void set_presets(const Presets& presets);
  /// The parameter has no value any more.
  void forget(const Name& name);
  void set_q(int number, double value) { set({'Q', number}, value); }
  /// Behind the '=': a formula, or a text for QS.
  void assign(BlockReader& reader, const Name& name);

  /// A called program starts with QL of its own.
  std::map<int, double> swap_local(std::map<int, double> local);

 private:
  std::map<int, double> global_, local_, kept_;
  std::map<int, std::string> texts_;
};

/// The value of the formula here, up to the end of the block ("bad-expression", "out-of-domain").
double formula(BlockReader& reader);
/// FN 0 to FN 8 and FN 13, behind the colon.
void basic_function(BlockReader& reader, int number);

}  // namespace swarf::program::nc::heidenhain
