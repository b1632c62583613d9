#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "program/cl/interpreter.h"

namespace swarf::program {

bool ClInterpreter::tool_number(const ClArgument& argument, const ClStatement& s) {
  const double number = argument.number ? argument.value : 0.0;
  if (number < 1.0 || number > 99999999.0 || number != std::floor(number)) {
    fault("wrong-arguments", s, fmt::format("{} gives no tool number", s.word),
          fmt::format("write {}", s.word == "LOADTL" ? "LOADTL/1" : "LOAD/TOOL,1"));
    return false;
  }
  call_tool(s, {static_cast<int>(number), {}, reporter_.at(s.line, s.column)});
  return true;
}

void ClInterpreter::call_tool(const ClStatement& s, const ClTool& tool) {
  const auto same = [&](const ClTool& other) {
    return other.number == tool.number && other.name == tool.name;
  };
  const auto found = std::find_if(program_.tools.begin(), program_.tools.end(), same);
  const int index = static_cast<int>(found - program_.tools.begin());
  if (index != tool_ && !not_compensated(s)) return;
  tool_ = index;
  if (found == program_.tools.end()) program_.tools.push_back(tool);
}

void ClInterpreter::load_tool(const ClStatement& s) {
  // What follows the number (OSETNO, ADJUST, LENGTH, lengths) speaks of the control's registers.
  tool_number(s.arguments.empty() ? ClArgument{} : s.arguments[0], s);
}

void ClInterpreter::load(const ClStatement& s) {
  if (s.arguments.size() < 2 || s.arguments[0].text != "TOOL") {
    fault("wrong-arguments", s, fmt::format("{} is not followed by TOOL and a number", s.word),
          fmt::format("write {}/TOOL,1", s.word));
  } else if (s.word == "LOAD") {
    tool_number(s.arguments[1], s);
  }
  // SELECT only brings the tool to the magazine's gate.
}

void ClInterpreter::tool_path(const ClStatement& s) {
  mark(ClWriter::kNx, "TOOL PATH", s);
  // TOOL PATH/operation,TOOL,name: the name may be anything but a comma.
  const std::string_view text = s.text;
  const size_t word = text.rfind(",TOOL,");
  const size_t name = word == std::string_view::npos ? text.size() : word + 6;
  const size_t end = text.find_last_not_of(" \t\r");
  if (end == std::string_view::npos || name > end) {
    fault("wrong-arguments", s, "TOOL PATH names no tool", "write TOOL PATH/ROUGHING,TOOL,MILL-20MM");
    return;
  }
  call_tool(s, {0, std::string(text.substr(name, end + 1 - name)), reporter_.at(s.line, s.column)});
  sink_.note({s.word, s.text, s.line});
}

void ClInterpreter::tool_data(const ClStatement& s) {
  mark(ClWriter::kNx, "TLDATA", s);
  const char* form = "TLDATA/MILL,diameter,corner radius,length,taper,tip angle";
  const bool mill = !s.arguments.empty() && s.arguments[0].text == "MILL";
  const bool drill = !s.arguments.empty() && s.arguments[0].text == "DRILL";
  if (!mill && !drill) {
    fault("unsupported-word", s, "TLDATA of this tool is not followed", fmt::format("write {}", form));
    return;
  }
  // TLDATA/DRILL may name the module that owns the tool before the numbers: TLDATA/DRILL,MILL,8.0,...
  const size_t first = drill && s.arguments.size() > 1 && s.arguments[1].text == "MILL" ? 2 : 1;
  for (size_t i = first; i < s.arguments.size(); ++i) {
    if (s.arguments[i].number) continue;
    fault("wrong-arguments", s.arguments[i], fmt::format("'{}' is no number", s.arguments[i].text),
          fmt::format("write {}", form));
    return;
  }
  if (s.arguments.size() <= first) {
    fault("wrong-arguments", s, "TLDATA gives no diameter", fmt::format("write {}", form));
    return;
  }
  ClCutter cutter{{mm(s.arguments[first].value)}, tool_, reporter_.at(s.line, s.column)};
  if (mill && s.arguments.size() > 2) cutter.parameters.push_back(mm(s.arguments[2].value));
  add_cutter(std::move(cutter));
}

void ClInterpreter::cutter(const ClStatement& s) {
  if (s.arguments.empty() || s.arguments.size() > 7) {
    fault("wrong-arguments", s, fmt::format("CUTTER has {} numbers", s.arguments.size()),
          "write CUTTER/d,r or all seven: CUTTER/d,r,e,f,alpha,beta,h (angles in degrees)");
    return;
  }
  if (!numbers(s, s.arguments.size(), 7, "CUTTER/d,r")) return;
  if (s.arguments[0].value < 0.0 || (s.arguments.size() > 1 && s.arguments[1].value < 0.0)) {
    fault("out-of-range", s.arguments[s.arguments[0].value < 0.0 ? 0 : 1],
          "CUTTER has a diameter or a corner radius below 0", "write CUTTER/d,r with numbers of 0 or more");
    return;
  }
  ClCutter cutter{{}, tool_, reporter_.at(s.line, s.column)};
  for (size_t i = 0; i < s.arguments.size(); ++i) {
    const bool angle = i == 4 || i == 5;
    cutter.parameters.push_back(angle ? s.arguments[i].value : mm(s.arguments[i].value));
  }
  add_cutter(std::move(cutter));
}

void ClInterpreter::add_cutter(ClCutter cutter) {
  // CATIA and Mastercam write CUTTER before the LOADTL of its tool, NX and Creo behind it: it holds for the
  // motion that follows.
  cutter_ = static_cast<int>(program_.cutters.size());
  program_.cutters.push_back(std::move(cutter));
}

std::optional<double> ClInterpreter::cutter_radius() const {
  if (cutter_ >= 0) return 0.5 * program_.cutters[static_cast<size_t>(cutter_)].parameters[0];
  for (auto one = program_.cutters.rbegin(); one != program_.cutters.rend(); ++one) {
    if (one->tool == tool_) return 0.5 * one->parameters[0];
  }
  const std::vector<ClToolRadius>& known = options_.tools;
  if (tool_ < 0) return known.size() == 1 ? std::optional(known[0].radius_mm) : std::nullopt;
  const ClTool& tool = program_.tools[static_cast<size_t>(tool_)];
  for (const ClToolRadius& one : known) {
    if (tool.number != 0 ? one.number == tool.number : one.name == tool.name) return one.radius_mm;
  }
  // As in a scene: the one tool that has no name is the one that is called by its name.
  if (tool.number == 0 && known.size() == 1 && known[0].name.empty()) return known[0].radius_mm;
  return std::nullopt;
}

}  // namespace swarf::program
