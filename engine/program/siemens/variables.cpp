#include "program/siemens/variables.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

namespace swarf::program::nc::siemens {

const char* type_name(Type type) {
  switch (type) {
    case Type::kBool:
      return "BOOL";
    case Type::kInt:
      return "INT";
    case Type::kReal:
      return "REAL";
    case Type::kString:
      return "STRING";
  }
  return "";
}

Value converted(const Value& value, Type type, const LineRef& line, size_t offset) {
  if ((value.type == Type::kString) != (type == Type::kString)) {
    refuse(line, offset, "wrong-type",
           fmt::format("{} is given where {} is wanted", type_name(value.type), type_name(type)),
           "texts and numbers are never converted into each other");
  }
  if (type == Type::kBool) return Value::boolean(value.number != 0.0);
  if (type != Type::kInt) return {type, value.number, value.text};
  const double whole = value.type == Type::kReal ? std::round(value.number) : value.number;
  if (std::fabs(whole) > std::numeric_limits<int>::max()) {
    refuse(line, offset, "out-of-range", fmt::format("{:g} does not fit INT", value.number),
           "INT has 32 bits: -2147483647 to 2147483647");
  }
  return Value::integer(whole);
}

bool is_parameter(const std::string& name) {
  return name.size() > 1 && name[0] == 'R' && name.find_first_not_of("0123456789", 1) == std::string::npos;
}

Variable* Variables::find(const std::string& name) {
  if (const auto found = scope_->find(name); found != scope_->end()) return &found->second;
  const auto global = globals_.find(name);
  return global == globals_.end() ? nullptr : &global->second;
}

int Variables::parameter_index(double index, const LineRef& line, size_t offset) {
  if (index != std::floor(index) || index < 0 || index >= kParametersMax) {
    refuse(line, offset, "out-of-range", fmt::format("R{:g} does not exist", index),
           fmt::format("R parameters run from R0 to R{}", kParametersMax - 1));
  }
  return static_cast<int>(index);
}

Value Variables::parameter(double index, const LineRef& line, size_t offset) const {
  const int number = parameter_index(index, line, offset);
  const auto found = parameters_.find(number);
  if (found == parameters_.end()) {
    refuse(
        line, offset, "undefined-parameter",
        fmt::format("R{} is read before the program has set it; the control would take what was left in it",
                    number),
        fmt::format("assign it first: R{}=0", number));
  }
  return found->second;
}

void Variables::set_parameter(double index, const Value& value, const LineRef& line, size_t offset) {
  parameters_[parameter_index(index, line, offset)] = converted(value, Type::kReal, line, offset);
}

std::vector<std::string> Variables::names() const {
  std::vector<std::string> names;
  for (const Scope* scope : {&std::as_const(*scope_), &globals_}) {
    for (const auto& [name, variable] : *scope) names.push_back(name);
  }
  return names;
}

Value& Variables::element(const std::string& name, const std::vector<double>& indices, const LineRef& line,
                          size_t offset) {
  Variable* variable = find(name);
  if (variable == nullptr) {
    const std::string near = nearest_name(name, names());
    refuse(
        line, offset, "undefined-variable", fmt::format("{} is not declared", name),
        near.empty() ? fmt::format("declare it: DEF REAL {}", name) : fmt::format("did you mean {}?", near));
  }
  if (indices.size() != variable->sizes.size()) {
    refuse(line, offset, "out-of-range",
           fmt::format("{} has {} indices, {} are given", name, variable->sizes.size(), indices.size()),
           fmt::format("it is declared in line {}", variable->declared_line));
  }
  size_t at = 0;
  for (size_t n = 0; n < indices.size(); ++n) {
    if (indices[n] != std::floor(indices[n]) || indices[n] < 0 || indices[n] >= variable->sizes[n]) {
      refuse(line, offset, "out-of-range",
             fmt::format("index {:g} of {} is outside 0 to {}", indices[n], name, variable->sizes[n] - 1),
             "indices start at 0 and end below the declared size");
    }
    at = at * static_cast<size_t>(variable->sizes[n]) + static_cast<size_t>(indices[n]);
  }
  return variable->values[at];
}

Variable& Variables::declare(const std::string& name, Variable variable, const LineRef& line, size_t offset) {
  if (const auto other = scope_->find(name); other != scope_->end()) {
    refuse(line, offset, "declared-twice",
           fmt::format("{} was declared in line {} already", name, other->second.declared_line),
           "keep one of the two declarations");
  }
  size_t count = 1;
  for (const int size : variable.sizes) count *= static_cast<size_t>(size);
  if (count > kArrayMax) {
    refuse(line, offset, "out-of-range", fmt::format("{} would have {} elements", name, count),
           fmt::format("at most {} elements", kArrayMax));
  }
  const Value zero = variable.type == Type::kString ? Value::string("") : Value{variable.type, 0.0, {}};
  variable.values.assign(count, zero);
  variable.declared_line = line.line;
  return scope_->emplace(name, std::move(variable)).first->second;
}

}  // namespace swarf::program::nc::siemens
