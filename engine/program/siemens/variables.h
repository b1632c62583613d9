// Variables of Siemens 840D: R parameters of the channel and what DEF declares, with their types.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "program/siemens/lexer.h"

namespace swarf::program::nc::siemens {

enum class Type { kBool, kInt, kReal, kString };
/// "REAL" and so on.
const char* type_name(Type type);

struct Value {
  Type type = Type::kReal;
  double number = 0.0;  ///< BOOL: 0 or 1; INT: a whole number of 32 bits
  std::string text;     ///< STRING only

  static Value real(double x) { return {Type::kReal, x, {}}; }
  static Value integer(double x) { return {Type::kInt, x, {}}; }
  static Value boolean(bool x) { return {Type::kBool, x ? 1.0 : 0.0, {}}; }
  static Value string(std::string x) { return {Type::kString, 0.0, std::move(x)}; }
};

/// `value` as the type, by the control's rules: REAL to INT rounds (halves away from zero) and must fit 32
/// bits, numbers to BOOL are "not zero", texts and numbers do not mix. Throws InputError "wrong-type",
/// "out-of-range" at the offset.
Value converted(const Value& value, Type type, const LineRef& line, size_t offset);

/// What one DEF declares.
struct Variable {
  Type type = Type::kReal;
  size_t text_max = 0;        ///< STRING[n]
  std::vector<int> sizes;     ///< of an array; empty: one value
  std::vector<Value> values;  ///< last index runs fastest
  int declared_line = 0;
};

/// The declared variables of one program level.
using Scope = std::map<std::string, Variable>;

inline constexpr int kParametersMax = 1000;  ///< R0 to R999, the most that the control can be set up for
inline constexpr size_t kArrayMax = 100'000;

/// A system variable as a program names it: $P_UIFR[1,X,TR] has the indices 1, "X" and "TR".
struct SystemName {
  std::string name;
  std::vector<Value> indices;
  const LineRef& line;
  size_t offset = 0;
};

/// What the control says in system variables ($...). Both throw InputError "unsupported-word",
/// "out-of-range", "axis-missing", "start-unknown", "unknown-tool".
class SystemVariables {
 public:
  virtual ~SystemVariables() = default;
  virtual Value read_system(const SystemName& asked) = 0;
  virtual void write_system(const SystemName& asked, const Value& value) = 0;
};

/// R parameters of the channel and the scope of the running program.
/// R12.
bool is_parameter(const std::string& name);

class Variables {
 public:
  /// None: system variables are refused. Must outlive its use.
  void connect(SystemVariables& system) { system_ = &system; }
  SystemVariables* system() { return system_; }
  /// The scope of the running program; must outlive its use.
  void enter(Scope& scope) { scope_ = &scope; }
  /// A variable of the running program, else a global one (GUD) that holds a value from before it.
  Variable* find(const std::string& name);
  /// A GUD of type REAL. Programs may declare variables of its name, which hide it.
  void set_global(const std::string& name, double value) { globals_[name].values = {Value::real(value)}; }

  /// Throws InputError "undefined-parameter" (R that nothing has set: the control would take what an earlier
  /// program left), "out-of-range" (index).
  Value parameter(double index, const LineRef& line, size_t offset) const;
  void set_parameter(double index, const Value& value, const LineRef& line, size_t offset);

  /// Element of a declared variable; throws "undefined-variable" with the nearest name, "out-of-range".
  Value& element(const std::string& name, const std::vector<double>& indices, const LineRef& line,
                 size_t offset);
  /// Declares; throws "declared-twice".
  Variable& declare(const std::string& name, Variable variable, const LineRef& line, size_t offset);
  std::vector<std::string> names() const;

 private:
  static int parameter_index(double index, const LineRef& line, size_t offset);

  Scope* scope_ = nullptr;
  Scope globals_;
  SystemVariables* system_ = nullptr;
  std::map<int, Value> parameters_;
};

}  // namespace swarf::program::nc::siemens
