#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "program/cl/steps.h"

namespace swarf::program::cldata {
namespace {

void call_tool(ClState& cl, const ClStatement& s, const ClTool& tool) {
  const auto same = [&](const ClTool& other) {
    return other.number == tool.number && other.name == tool.name;
  };
  const auto found = std::find_if(cl.program.tools.begin(), cl.program.tools.end(), same);
  const int index = static_cast<int>(found - cl.program.tools.begin());
  if (index != cl.tool.active && !not_compensated(cl.reporter, cl.compensation, s)) return;
  cl.tool.active = index;
  if (found == cl.program.tools.end()) cl.program.tools.push_back(tool);
}

bool tool_number(ClState& cl, const ClArgument& argument, const ClStatement& s) {
  const double number = argument.number ? argument.value : 0.0;
  if (number < 1.0 || number > 99999999.0 || number != std::floor(number)) {
    fault(cl.reporter, "wrong-arguments", s, fmt::format("{} gives no tool number", s.word),
          fmt::format("write {}", s.word == "LOADTL" ? "LOADTL/1" : "LOAD/TOOL,1"));
    return false;
  }
  call_tool(cl, s, {static_cast<int>(number), {}, cl.reporter.at(s.line, s.column)});
  return true;
}

void add_cutter(ClProgram& program, ClToolState& tool, ClCutter cutter) {
  // CATIA and Mastercam write CUTTER before the LOADTL of its tool, NX and Creo behind it: it holds for the
  // motion that follows.
  tool.next_cutter = static_cast<int>(program.cutters.size());
  program.cutters.push_back(std::move(cutter));
}

}  // namespace

void load_tool(ClState& cl, const ClStatement& s) {
  // What follows the number (OSETNO, ADJUST, LENGTH, lengths) speaks of the control's registers.
  tool_number(cl, s.arguments.empty() ? ClArgument{} : s.arguments[0], s);
}

void load(ClState& cl, const ClStatement& s) {
  if (s.arguments.size() < 2 || s.arguments[0].text != "TOOL") {
    fault(cl.reporter, "wrong-arguments", s, fmt::format("{} is not followed by TOOL and a number", s.word),
          fmt::format("write {}/TOOL,1", s.word));
  } else if (s.word == "LOAD") {
    tool_number(cl, s.arguments[1], s);
  }
  // SELECT only brings the tool to the magazine's gate.
}

void tool_path(ClState& cl, const ClStatement& s) {
  mark(cl.reporter, cl.program, ClWriter::kNx, "TOOL PATH", s);
  // TOOL PATH/operation,TOOL,name: the name may be anything but a comma.
  const std::string_view text = s.text;
  const size_t word = text.rfind(",TOOL,");
  const size_t name = word == std::string_view::npos ? text.size() : word + 6;
  const size_t end = text.find_last_not_of(" \t\r");
  if (end == std::string_view::npos || name > end) {
    fault(cl.reporter, "wrong-arguments", s, "TOOL PATH names no tool",
          "write TOOL PATH/ROUGHING,TOOL,MILL-20MM");
    return;
  }
  call_tool(cl, s, {0, std::string(text.substr(name, end + 1 - name)), cl.reporter.at(s.line, s.column)});
  cl.sink.note({s.word, s.text, s.line});
}

void tool_data(ClState& cl, const ClStatement& s) {
  mark(cl.reporter, cl.program, ClWriter::kNx, "TLDATA", s);
  const char* form = "TLDATA/MILL,diameter,corner radius,length,taper,tip angle";
  const bool mill = !s.arguments.empty() && s.arguments[0].text == "MILL";
  const bool drill = !s.arguments.empty() && s.arguments[0].text == "DRILL";
  if (!mill && !drill) {
    fault(cl.reporter, "unsupported-word", s, "TLDATA of this tool is not followed",
          fmt::format("write {}", form));
    return;
  }
  // TLDATA/DRILL may name the module that owns the tool before the numbers: TLDATA/DRILL,MILL,8.0,...
  const size_t first = drill && s.arguments.size() > 1 && s.arguments[1].text == "MILL" ? 2 : 1;
  for (size_t i = first; i < s.arguments.size(); ++i) {
    if (s.arguments[i].number) continue;
    fault(cl.reporter, "wrong-arguments", s.arguments[i],
          fmt::format("'{}' is no number", s.arguments[i].text), fmt::format("write {}", form));
    return;
  }
  if (s.arguments.size() <= first) {
    fault(cl.reporter, "wrong-arguments", s, "TLDATA gives no diameter", fmt::format("write {}", form));
    return;
  }
  ClCutter cutter{
      {cl.systems.mm(s.arguments[first].value)}, cl.tool.active, cl.reporter.at(s.line, s.column)};
  if (mill && s.arguments.size() > 2) cutter.parameters.push_back(cl.systems.mm(s.arguments[2].value));
  add_cutter(cl.program, cl.tool, std::move(cutter));
}

void cutter(ClState& cl, const ClStatement& s) {
  if (s.arguments.empty() || s.arguments.size() > 7) {
    fault(cl.reporter, "wrong-arguments", s, fmt::format("CUTTER has {} numbers", s.arguments.size()),
          "write CUTTER/d,r or all seven: CUTTER/d,r,e,f,alpha,beta,h (angles in degrees)");
    return;
  }
  if (!numbers(cl.reporter, s, s.arguments.size(), 7, "CUTTER/d,r")) return;
  if (s.arguments[0].value < 0.0 || (s.arguments.size() > 1 && s.arguments[1].value < 0.0)) {
    fault(cl.reporter, "out-of-range", s.arguments[s.arguments[0].value < 0.0 ? 0 : 1],
          "CUTTER has a diameter or a corner radius below 0", "write CUTTER/d,r with numbers of 0 or more");
    return;
  }
  ClCutter cutter{{}, cl.tool.active, cl.reporter.at(s.line, s.column)};
  for (size_t i = 0; i < s.arguments.size(); ++i) {
    const bool angle = i == 4 || i == 5;
    cutter.parameters.push_back(angle ? s.arguments[i].value : cl.systems.mm(s.arguments[i].value));
  }
  add_cutter(cl.program, cl.tool, std::move(cutter));
}

std::optional<double> cutter_radius(const ClOptions& options, const ClProgram& program,
                                    const ClToolState& tool) {
  if (tool.next_cutter >= 0)
    return 0.5 * program.cutters[static_cast<size_t>(tool.next_cutter)].parameters[0];
  for (auto one = program.cutters.rbegin(); one != program.cutters.rend(); ++one) {
    if (one->tool == tool.active) return 0.5 * one->parameters[0];
  }
  const std::vector<ClToolRadius>& known = options.tools;
  if (tool.active < 0) return known.size() == 1 ? std::optional(known[0].radius_mm) : std::nullopt;
  const ClTool& called = program.tools[static_cast<size_t>(tool.active)];
  for (const ClToolRadius& one : known) {
    if (called.number != 0 ? one.number == called.number : one.name == called.name) return one.radius_mm;
  }
  // As in a scene: the one tool that has no name is the one that is called by its name.
  if (called.number == 0 && known.size() == 1 && known[0].name.empty()) return known[0].radius_mm;
  return std::nullopt;
}

}  // namespace swarf::program::cldata
