#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "program/cl_interpreter.h"

namespace swarf::program {

namespace {

constexpr double kInch = 25.4;

bool is_feed_unit(const std::string& word) {
  return word == "MMPM" || word == "PERMIN" || word == "IPM" || word == "MMPR" || word == "PERREV" ||
         word == "IPR";
}

}  // namespace

double ClInterpreter::feed_of(const ClArgument& value, const std::string& unit) {
  if (!(value.value > 0.0)) {
    fault("out-of-range", value, fmt::format("the feed is {:g}", value.value), "it must be above 0");
    return 0.0;
  }
  double length = mm(value.value);
  if (unit == "MMPM" || unit == "MMPR") length = value.value;
  if (unit == "IPM" || unit == "IPR") length = kInch * value.value;
  if (unit != "MMPR" && unit != "PERREV" && unit != "IPR") return mm_s_from_mm_min(length);
  if (spindle_rpm_ == 0.0) {
    fault("missing-spindle", value, "a feed per revolution, and the spindle stands",
          "write SPINDL/RPM,8000,CLW before it");
  }
  return mm_s_from_mm_min(length * std::abs(spindle_rpm_));
}

void ClInterpreter::feed_rate(const ClStatement& s) {
  const char* form = "write FEDRAT/500,MMPM (mm/min), or MMPR, IPM, IPR, PERMIN, PERREV";
  const ClArgument* value = nullptr;
  std::string unit;
  for (const ClArgument& argument : s.arguments) {
    if (argument.number && value == nullptr) {
      value = &argument;
    } else if (unit.empty() && is_feed_unit(argument.text)) {
      unit = argument.text;
    } else {
      fault("unsupported-word", argument, fmt::format("FEDRAT with '{}' is not followed", argument.text),
            form);
      return;
    }
  }
  if (value == nullptr) {
    fault("wrong-arguments", s, "FEDRAT has no number", form);
    return;
  }
  const double feed = feed_of(*value, unit);
  if (feed > 0.0) feed_mm_s_ = feed;
}

void ClInterpreter::spindle(const ClStatement& s) {
  double rpm = std::abs(spindle_rpm_);
  bool clockwise = spindle_rpm_ >= 0.0;
  for (const ClArgument& argument : s.arguments) {
    if (argument.number) {
      rpm = argument.value;
    } else if (argument.text == "OFF") {
      rpm = 0.0;
    } else if (argument.text == "CLW" || argument.text == "CCLW") {
      clockwise = argument.text == "CLW";
    } else if (argument.text != "RPM" && argument.text != "ON") {
      fault("unsupported-word", argument, fmt::format("SPINDL with '{}' is not followed", argument.text),
            "write SPINDL/RPM,8000,CLW (rev/min) or SPINDL/OFF");
      return;
    }
    if (rpm < 0.0) {
      fault("out-of-range", argument, fmt::format("the spindle speed is {:g} rev/min", rpm),
            "it must not be below 0; CCLW turns the other way");
      return;
    }
  }
  spindle_rpm_ = clockwise ? rpm : -rpm;
}

void ClInterpreter::multi_axis(const ClStatement& s) {
  const bool on = s.arguments.empty() || s.arguments[0].text == "ON";
  if (s.arguments.size() > 1 || (!on && s.arguments[0].text != "OFF")) {
    fault("wrong-arguments", s, "MULTAX is followed by neither ON nor OFF", "write MULTAX/ON or MULTAX/OFF");
    return;
  }
  if (!on) axis_W_ = X_WC_.linear().col(2);
  axis_known_ = !on || positioned_;
}

bool ClInterpreter::tool_number(const ClArgument& argument, const ClStatement& s) {
  const double number = argument.number ? argument.value : 0.0;
  if (number < 1.0 || number > 99999999.0 || number != std::floor(number)) {
    fault("wrong-arguments", s, fmt::format("{} gives no tool number", s.word),
          fmt::format("write {}", s.word == "LOADTL" ? "LOADTL/1" : "LOAD/TOOL,1"));
    return false;
  }
  call_tool({static_cast<int>(number), {}, reporter_.at(s.line, s.column)});
  return true;
}

void ClInterpreter::call_tool(const ClTool& tool) {
  const auto same = [&](const ClTool& other) {
    return other.number == tool.number && other.name == tool.name;
  };
  const auto found = std::find_if(program_.tools.begin(), program_.tools.end(), same);
  tool_ = static_cast<int>(found - program_.tools.begin());
  if (found == program_.tools.end()) program_.tools.push_back(tool);
}

void ClInterpreter::load_tool(const ClStatement& s) {
  // What follows the number (OSETNO, ADJUST, lengths) speaks of the control's registers.
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
  // TOOL PATH/operation,TOOL,name: the name may be anything but a comma.
  const std::string_view text = s.text;
  const size_t word = text.rfind(",TOOL,");
  const size_t name = word == std::string_view::npos ? text.size() : word + 6;
  const size_t end = text.find_last_not_of(" \t\r");
  if (end == std::string_view::npos || name > end) {
    fault("wrong-arguments", s, "TOOL PATH names no tool", "write TOOL PATH/ROUGHING,TOOL,MILL-20MM");
    return;
  }
  call_tool({0, std::string(text.substr(name, end + 1 - name)), reporter_.at(s.line, s.column)});
  program_.notes.push_back({s.word, s.text, s.line});
}

void ClInterpreter::tool_data(const ClStatement& s) {
  const char* form = "TLDATA/MILL,diameter,corner radius,length,taper,tip angle";
  const bool mill = !s.arguments.empty() && s.arguments[0].text == "MILL";
  const bool drill = !s.arguments.empty() && s.arguments[0].text == "DRILL";
  if (!mill && !drill) {
    fault("unsupported-word", s, "TLDATA of this tool is not followed", fmt::format("write {}", form));
    return;
  }
  for (size_t i = 1; i < s.arguments.size(); ++i) {
    if (s.arguments[i].number) continue;
    fault("wrong-arguments", s.arguments[i], fmt::format("'{}' is no number", s.arguments[i].text),
          fmt::format("write {}", form));
    return;
  }
  if (s.arguments.size() < 2) {
    fault("wrong-arguments", s, "TLDATA gives no diameter", fmt::format("write {}", form));
    return;
  }
  ClCutter cutter{{mm(s.arguments[1].value)}, tool_, reporter_.at(s.line, s.column)};
  if (mill && s.arguments.size() > 2) cutter.parameters.push_back(mm(s.arguments[2].value));
  program_.cutters.push_back(std::move(cutter));
}

void ClInterpreter::cutter(const ClStatement& s) {
  if (s.arguments.empty() || s.arguments.size() > 7) {
    fault("wrong-arguments", s, fmt::format("CUTTER has {} numbers", s.arguments.size()),
          "write CUTTER/d,r or all seven: CUTTER/d,r,e,f,alpha,beta,h (angles in degrees)");
    return;
  }
  if (!numbers(s, s.arguments.size(), 7, "CUTTER/d,r")) return;
  ClCutter cutter{{}, tool_, reporter_.at(s.line, s.column)};
  for (size_t i = 0; i < s.arguments.size(); ++i) {
    const bool angle = i == 4 || i == 5;
    cutter.parameters.push_back(angle ? s.arguments[i].value : mm(s.arguments[i].value));
  }
  program_.cutters.push_back(std::move(cutter));
}

void ClInterpreter::cutter_compensation(const ClStatement& s) {
  if (s.arguments.size() == 1 && s.arguments[0].text == "OFF") return;
  fault("unsupported-word", s, "CUTCOM shifts the path by a radius that only the control knows",
        "write the path of the tool's centre and CUTCOM/OFF");
}

void ClInterpreter::cycle(const ClStatement& s) {
  if (s.arguments.size() == 1 && s.arguments[0].text == "OFF") {
    cycle_.reset();
    return;
  }
  ClCycle cycle;
  cycle.feed_mm_s = feed_mm_s_;
  if (read_cycle(s, cycle)) cycle_ = cycle;
}

void ClInterpreter::delay(const ClStatement& s) {
  if (!numbers(s, 1, 1, "DELAY/seconds")) return;
  if (s.arguments[0].value < 0.0) {
    fault("out-of-range", s.arguments[0], fmt::format("the delay is {:g} s", s.arguments[0].value),
          "it must not be below 0");
    return;
  }
  dwell_s_ += s.arguments[0].value;
}

void ClInterpreter::units(const ClStatement& s) {
  const std::string unit = s.arguments.size() == 1 ? s.arguments[0].text : "";
  const bool inches = unit == "INCHES" || unit == "INCH";
  if (unit != "MM" && !inches) {
    fault("unsupported-word", s, "UNITS is followed by neither MM nor INCHES",
          "write UNITS/MM or UNITS/INCHES");
  } else if (positioned_ && inches != (unit_mm_ != 1.0)) {
    fault("unsupported-word", s, "the units change after a position has been given",
          "give the units before the first position");
  } else {
    unit_mm_ = inches ? kInch : 1.0;
  }
}

void ClInterpreter::set_mode(const ClStatement& s) {
  if (s.arguments.size() == 2 && s.arguments[0].text == "MODE" && s.arguments[1].text == "ABSOL") return;
  fault("unsupported-word", s, "SET is not followed by MODE,ABSOL", "write absolute positions, or GODLTA");
}

void ClInterpreter::note(const ClStatement& s) {
  std::string text = s.text;
  for (const ClArgument& argument : s.arguments) {
    if (!text.empty()) text += ',';
    text += argument.text;
  }
  program_.notes.push_back({s.word, std::move(text), s.line});
}
}  // namespace swarf::program
