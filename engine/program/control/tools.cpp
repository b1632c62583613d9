#include "program/control/tools.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/control/offsets.h"
#include "program/control/path.h"

namespace swarf::program::nc {
namespace {

void warn_of_no_table(Control& control, const std::string& asked, int column) {
  control.report.warn_once(
      "no-tool-table", column,
      fmt::format("{} cannot be looked up, there is no tool table: tools have length and radius 0 here",
                  asked),
      "give one: [[tool]] or tool_table of the scene, swarf check --tools");
}

std::string spoken(const AskedTool& tool) {
  return tool.number > 0 || tool.name.empty() ? fmt::format("T{}", tool.number)
                                              : fmt::format("T=\"{}\"", tool.name);
}

void keep_asked(Control& control, AskedTool tool) {
  std::vector<AskedTool>& all = control.report.summary.tools_asked;
  const bool known = std::any_of(all.begin(), all.end(), [&](const AskedTool& one) {
    return one.number == tool.number && one.name == tool.name;
  });
  tool.line = control.report.place.line;
  if (!known) all.push_back(std::move(tool));
}

int not_found(Control& control, const AskedTool& tool, int column) {
  const std::string asked = spoken(tool);
  if (control.setup.tools.empty() && control.setup.incomplete_tools.empty()) {
    keep_asked(control, tool);
    warn_of_no_table(control, asked, column);
    return -1;
  }
  constexpr size_t kNamesMax = 8;
  const std::vector<NcTool>& tools = control.setup.tools;
  std::string list;
  for (size_t i = 0; i < std::min(tools.size(), kNamesMax); ++i) {
    if (i > 0) list += ", ";
    if (tools[i].number != 0) list += fmt::format("T{}", tools[i].number);
    if (!tools[i].name.empty())
      list += fmt::format("{}\"{}\"", tools[i].number != 0 ? " " : "", tools[i].name);
  }
  if (tools.size() > kNamesMax) list += fmt::format(" and {} more", tools.size() - kNamesMax);
  control.report.fail(
      "unknown-tool", column, fmt::format("{} is not in the tool table, which has {}", asked, list),
      "add the tool to the table ([[tool]] or tool_table of the scene, swarf check --tools), or correct "
      "the call");
}

}  // namespace

bool no_tool_table(Control& control, int column) {
  const bool none = control.setup.tools.empty() && control.setup.incomplete_tools.empty();
  if (none) warn_of_no_table(control, "the tool", column);
  return none;
}

int find_tool(Control& control, int number, int column) {
  const auto incomplete = control.setup.incomplete_tools.find(number);
  if (incomplete != control.setup.incomplete_tools.end())
    control.report.fail(
        "unknown-tool", column,
        fmt::format("T{} is in the tool table and cannot be used, {}", number, incomplete->second),
        fmt::format("complete its line, or describe it: [[tool]] number = {}", number));
  const auto found = std::find_if(control.setup.tools.begin(), control.setup.tools.end(),
                                  [&](const NcTool& tool) { return tool.number == number; });
  if (found != control.setup.tools.end()) return static_cast<int>(found - control.setup.tools.begin());
  return not_found(control, {number, ""}, column);
}

int find_tool(Control& control, const std::string& name, int column) {
  const auto found = std::find_if(control.setup.tools.begin(), control.setup.tools.end(),
                                  [&](const NcTool& tool) { return tool.name == name; });
  if (found != control.setup.tools.end()) return static_cast<int>(found - control.setup.tools.begin());
  return not_found(control, {0, name}, column);
}

void select_tool(ToolState& tools, int index, int number) {
  tools.selected = index;
  tools.selected_number = number;
}

const NcTool* active_tool(const Control& control) {
  return control.tools.active < 0 ? nullptr : &control.setup.tools[static_cast<size_t>(control.tools.active)];
}

bool tip_is_reference(const Control& control) {
  return control.setup.tip_without_length && !control.tools.length_called;
}

void set_true_tool(Control& control) {
  const NcTool* tool = active_tool(control);
  const double length = tool == nullptr ? 0.0 : tool->length_mm;
  control.space.set_true_length(length);
  if (tip_is_reference(control)) {
    moved_frame(control, "the tool");
    control.space.set_length(length);
  }
  if (!control.path.started) return;
  const LinearMap& map = control.space.real(control.space.rotary_of(control.path.q));
  control.path.pose = {map.base_W + map.columns_W * control.space.linear_of(control.path.q), map.axis_W};
}

void change_tool(Control& control) {
  if (control.contour.side() != Compensation::kOff) {
    control.report.fail("compensation-active", 0, "the tool changes while cutter radius compensation is on",
                        fmt::format("switch it off first: {}", control.report.words.compensation_off));
  }
  flush(control);
  control.modal.spindle = 0;
  if (control.setup.machine.tool_change) {
    if (control.path.started) {
      Target target;
      for (int word = 0; word < kAxisWords; ++word) {
        if (control.space.axis_of(static_cast<AxisWord>(word)) >= 0)
          target.set(word,
                     (*control.setup.machine.tool_change)[control.space.axis_of(static_cast<AxisWord>(word))],
                     false);
      }
      machine_line(control, Motion::kRapid, target);
    } else {
      control.path.q = *control.setup.machine.tool_change;
      start_here(control,
                 fmt::format("the machine's tool change position, at the first tool change in line {}",
                             control.report.place.line));
    }
  }
  control.tools.active = control.tools.selected;
  control.tools.active_number = control.tools.selected_number;
  set_true_tool(control);
}

void declare_tool(Control& control, int index, int number) {
  flush(control);
  control.tools.active = index;
  control.tools.active_number = number;
  set_true_tool(control);
}

void set_length_compensation(Control& control, double length_mm, bool on) {
  moved_frame(control, "the tool length compensation");
  control.tools.length_on = on;
  control.tools.length_called = control.tools.length_called || on;
  const NcTool* tool = active_tool(control);
  const double without = tip_is_reference(control) && tool != nullptr ? tool->length_mm : 0.0;
  control.space.set_length(on ? length_mm : without);
}

}  // namespace swarf::program::nc
