// Variables that a program declares and assigns.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "program/letters/arithmetic.h"
#include "program/siemens/flow_steps.h"

namespace swarf::program::nc::siemens {
namespace {

std::optional<Type> type_of(const std::string& word) {
  if (word == "REAL") return Type::kReal;
  if (word == "INT") return Type::kInt;
  if (word == "BOOL") return Type::kBool;
  if (word == "STRING") return Type::kString;
  return std::nullopt;
}

/// Values of DEF A[3]=SET(1,2), A[3]=(1,2) and A[3]=REP(0).
void read_list(TokenReader& reader, Variables& variables, Variable& variable) {
  const bool repeats = reader.skip("REP");
  if (!repeats) reader.skip("SET");
  reader.expect("(", "the array");
  size_t at = 0;
  do {
    const size_t offset = reader.offset();
    const Value value = converted(evaluate(reader, variables), variable.type, reader.line(), offset);
    if (at >= variable.values.size()) {
      refuse(reader.line(), offset, "out-of-range",
             fmt::format("the array has {} elements, the list has more", variable.values.size()),
             "declare a larger array or shorten the list");
    }
    if (repeats) {
      std::fill(variable.values.begin(), variable.values.end(), value);
    } else {
      variable.values[at++] = value;
    }
  } while (!repeats && reader.skip(","));
  reader.expect(")", "the list");
}

void check_length(const Variable& variable, const Value& value, const LineRef& line, size_t offset) {
  if (variable.type == Type::kString && value.text.size() > variable.text_max) {
    refuse(line, offset, "out-of-range",
           fmt::format("the text has {} characters, the variable holds {}", value.text.size(),
                       variable.text_max),
           "declare a longer STRING[n]");
  }
}

/// $P_UIFR[1]=CTRANS(X,10,Z,-5): the offset is zero but for the axes that are named.
void write_offset(TokenReader& reader, Variables& variables, const SystemName& asked) {
  const size_t offset = reader.offset();
  if (!reader.skip("CTRANS")) {
    refuse(reader.line(), offset, "unsupported-word", "an offset as a whole is given with CTRANS alone",
           "$P_UIFR[1]=CTRANS(X,10,Y,20), or $P_UIFR[1,X,TR]=10");
  }
  variables.system()->write_system(asked, Value::real(0.0));
  reader.expect("(", "CTRANS");
  while (!reader.skip(")")) {
    SystemName one = asked;
    one.offset = reader.offset();
    one.indices = {asked.indices[0], Value::string(capitals(reader.peek().text)), Value::string("TR")};
    if (!reader.done()) reader.next();
    reader.expect(",", "the axis of CTRANS");
    variables.system()->write_system(one, evaluate(reader, variables));
    if (!reader.skip(",") && !reader.peek().symbol(")")) reader.expect(")", "CTRANS");
  }
  if (reader.peek().symbol(":")) {
    refuse(reader.line(), reader.offset(), "unsupported-word",
           "offsets that turn, scale or mirror are not supported", "shift with CTRANS, rotate with AROT");
  }
}

void declare(BlockTarget& target, Variables& variables, TokenReader& reader, Type type, size_t text_max) {
  const size_t offset = reader.offset();
  if (reader.peek().kind != TokenKind::kName) {
    refuse(reader.line(), offset, "bad-block", "the name of a variable is missing",
           "a name begins with two letters or '_'");
  }
  const std::string name = reader.next().name;
  const auto& formulas = expression_words();
  if (target.knows(name) || is_parameter(name) || handler_of(name) != nullptr || name[0] == '$' ||
      std::find(formulas.begin(), formulas.end(), name) != formulas.end()) {
    refuse(reader.line(), offset, "reserved-name", fmt::format("{} is a word of the language", name),
           fmt::format("call the variable _{}", name));
  }
  Variable variable;
  variable.type = type;
  variable.text_max = text_max;
  if (reader.peek().symbol("[")) {
    for (const double size : evaluate_indices(reader, variables)) {
      if (size != std::floor(size) || size < 1 || size > static_cast<double>(kArrayMax)) {
        refuse(reader.line(), offset, "out-of-range", fmt::format("{:g} is not a size of an array", size),
               fmt::format("sizes are whole numbers from 1 to {}", kArrayMax));
      }
      variable.sizes.push_back(static_cast<int>(size));
    }
  }
  Variable& made = variables.declare(name, std::move(variable), reader.line(), offset);
  if (!reader.skip("=")) return;
  if (!made.sizes.empty()) {
    read_list(reader, variables, made);
    return;
  }
  const size_t at = reader.offset();
  const Value value = evaluate(reader, variables);
  check_length(made, value, reader.line(), at);
  made.values[0] = converted(value, type, reader.line(), at);
}

}  // namespace

Type read_type(TokenReader& reader) {
  const size_t offset = reader.offset();
  const std::string word = reader.done() ? "" : reader.next().name;
  if (const auto type = type_of(word)) return *type;
  if (word == "CHAR" || word == "AXIS" || word == "FRAME" || word == "CHAN" || word == "NCK") {
    refuse(reader.line(), offset, "unsupported-word", fmt::format("variables of {} are not supported", word),
           "REAL, INT, BOOL and STRING of the program are");
  }
  refuse(reader.line(), offset, "bad-block", fmt::format("'{}' is not a type of variable", word),
         "REAL, INT, BOOL, STRING[n]");
}

bool assign(TokenReader& reader, Variables& variables) {
  const Token& name = reader.peek();
  if (name.kind != TokenKind::kName) return false;
  const LineRef& line = reader.line();
  if (name.name[0] == '$') {
    const SystemName asked = system_name(reader, variables);
    reader.expect("=", asked.name);
    if (asked.name == "$P_UIFR" && asked.indices.size() == 1 && variables.system() != nullptr) {
      write_offset(reader, variables, asked);
      return true;
    }
    const Value value = evaluate(reader, variables);
    if (variables.system() == nullptr) {
      refuse(line, asked.offset, "unsupported-word",
             fmt::format("the system variable {} is not simulated", asked.name),
             "assign to a variable of the program");
    }
    variables.system()->write_system(asked, value);
    return true;
  }
  const bool parameter = is_parameter(name.name) || (same(name.name, "R") && reader.peek(1).symbol("["));
  Variable* variable = parameter ? nullptr : variables.find(name.name);
  if (!parameter && variable == nullptr) return false;
  reader.next();
  std::vector<double> indices;
  if (reader.peek().symbol("[")) indices = evaluate_indices(reader, variables);
  reader.expect("=", name.name);
  const size_t offset = reader.offset();
  if (variable != nullptr && indices.empty() && !variable->sizes.empty()) {
    read_list(reader, variables, *variable);
    return true;
  }
  const Value value = evaluate(reader, variables);
  if (parameter) {
    double index = 0.0;
    if (name.name == "R")
      index = indices[0];
    else if (nc::read_number(std::string_view(name.name).substr(1), index) == std::string_view::npos)
      index = std::numeric_limits<double>::infinity();
    variables.set_parameter(index, value, line, offset);
    return true;
  }
  Value& to = variables.element(name.name, indices, line, name.offset);
  check_length(*variable, value, line, offset);
  to = converted(value, variable->type, line, offset);
  return true;
}

void on_def(Flow& flow, TokenReader& reader) {
  const Type type = read_type(reader);
  size_t text_max = 0;
  if (type == Type::kString) {
    const size_t offset = reader.offset();
    const double length = evaluate_indices(reader, flow.variables)[0];
    if (length != std::floor(length) || length < 1 || length > 200) {
      refuse(reader.line(), offset, "out-of-range", "a STRING holds 1 to 200 characters",
             "DEF STRING[32] NAME");
    }
    text_max = static_cast<size_t>(length);
  }
  do {
    declare(flow.target, flow.variables, reader, type, text_max);
  } while (reader.skip(","));
  finish_block(reader, "DEF");
}

}  // namespace swarf::program::nc::siemens
