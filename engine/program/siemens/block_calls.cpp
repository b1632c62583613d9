#include "program/siemens/block_calls.h"

#include <fmt/format.h>

#include "program/siemens/flow.h"

namespace swarf::program::nc::siemens {
namespace {

/// X, Y, Z, A, B or C, whose place in that list is given.
size_t axis_here(TokenReader& reader, const std::string& of) {
  const Token axis = reader.peek();
  const size_t index = axis.name.size() == 1 ? kAxisNames.find(axis.name[0]) : std::string_view::npos;
  if (index == std::string_view::npos) {
    refuse(reader.line(), reader.offset(), "bad-block", fmt::format("{} names the axes X Y Z A B C", of),
           "FGROUP(X,Y,Z)");
  }
  reader.next();
  return index;
}

}  // namespace

void read_call(TokenReader& reader, Variables& variables, BlockWords& words, const std::string& name,
               size_t offset) {
  CycleCall call;
  call.name = name;
  call.offset = offset;
  if (reader.skip("(") && !reader.skip(")")) {
    do {
      call.offsets.push_back(reader.offset());
      const bool empty = reader.peek().symbol(",") || reader.peek().symbol(")");
      call.arguments.push_back(empty ? std::nullopt : std::optional(evaluate(reader, variables)));
    } while (reader.skip(","));
    reader.expect(")", "the arguments of " + name);
  }
  words.calls.push_back(std::move(call));
}

void read_feed_group(TokenReader& reader, BlockWords& words, const std::string& name, size_t offset) {
  CycleCall call{name, {}, {}, offset};
  reader.expect("(", name);
  if (!reader.skip(")")) {
    do {
      call.offsets.push_back(reader.offset());
      call.arguments.emplace_back(Value::string(std::string(1, kAxisNames[axis_here(reader, name)])));
    } while (reader.skip(","));
    reader.expect(")", "the axes of FGROUP");
  }
  words.calls.push_back(std::move(call));
}

void read_feed_radius(TokenReader& reader, Variables& variables, BlockWords& words, const std::string& name,
                      size_t offset) {
  reader.expect("[", name);
  const size_t index = axis_here(reader, name);
  if (index < 3) {
    refuse(reader.line(), offset, "words-conflict", "FGREF is the radius of a rotary axis", "FGREF[C]=50");
  }
  reader.expect("]", "the axis of FGREF");
  reader.expect("=", name);
  Amount& radius = words.feed_radii[index - 3];
  radius = {evaluate_number(reader, variables), offset, true};
}

void read_noted_index(TokenReader& reader, Variables& variables, BlockWords& words, const std::string& name,
                      size_t offset) {
  reader.expect("[", name);
  const std::string axis = capitals(reader.peek().text);
  if (!reader.done()) reader.next();
  reader.expect("]", "the axis");
  reader.expect("=", name);
  const double value = evaluate_number(reader, variables);
  words.noted.push_back({fmt::format("{}[{}]={:g}", name, axis, value), offset});
}

}  // namespace swarf::program::nc::siemens
