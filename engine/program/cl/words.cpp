#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/units.h"
#include "program/cl/interpreter.h"

namespace swarf::program {

namespace {

constexpr double kInch = 25.4, kFoot = 12.0 * kInch;

/// What a number with the word behind FEDRAT counts.
struct FeedUnit {
  std::string_view word;
  double length_mm;  ///< 0: the unit of the program
  bool per_revolution;
};
constexpr std::array kFeedUnits{FeedUnit{"MMPM", 1.0, false},  FeedUnit{"PERMIN", 0.0, false},
                                FeedUnit{"IPM", kInch, false}, FeedUnit{"MMPR", 1.0, true},
                                FeedUnit{"PERREV", 0.0, true}, FeedUnit{"IPR", kInch, true},
                                FeedUnit{"FPM", kFoot, false}, FeedUnit{"FPR", kFoot, true}};

const FeedUnit* find_unit(std::string_view word) {
  const auto found = std::find_if(kFeedUnits.begin(), kFeedUnits.end(),
                                  [&](const FeedUnit& unit) { return unit.word == word; });
  return found == kFeedUnits.end() ? nullptr : &*found;
}

}  // namespace

double ClInterpreter::feed_of(const ClArgument& value, const std::string& unit) {
  if (!(value.value > 0.0)) {
    fault("out-of-range", value, fmt::format("the feed is {:g}", value.value), "it must be above 0");
    return 0.0;
  }
  const FeedUnit* known = find_unit(unit);
  const double length =
      known != nullptr && known->length_mm > 0.0 ? known->length_mm * value.value : mm(value.value);
  if (known == nullptr || !known->per_revolution) return mm_s_from_mm_min(length);
  if (spindle_rpm_ == 0.0) {
    fault("missing-spindle", value, "a feed per revolution, and the spindle stands",
          "write SPINDL/RPM,8000,CLW before it");
  }
  return mm_s_from_mm_min(length * std::abs(spindle_rpm_));
}

void ClInterpreter::feed_rate(const ClStatement& s) {
  const char* form = "write FEDRAT/500,MMPM (mm/min), or MMPR, IPM, IPR, FPM, FPR, PERMIN, PERREV";
  const ClArgument* value = nullptr;
  std::string unit;
  for (const ClArgument& argument : s.arguments) {
    if (argument.number && value == nullptr) {
      value = &argument;
    } else if (unit.empty() && find_unit(argument.text) != nullptr) {
      unit = argument.text;
    } else {
      fault("unsupported-word", argument, fmt::format("FEDRAT with '{}' is not followed", shown(argument)),
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
  bool clockwise = spindle_rpm_ >= 0.0, number = false;
  for (const ClArgument& argument : s.arguments) {
    if (argument.text == "RANGE") break;  // the gear, and what follows it
    if (argument.number && !number) {
      rpm = argument.value;
      number = true;
    } else if (argument.text == "OFF") {
      rpm = 0.0;
    } else if (argument.text == "CLW" || argument.text == "CCLW") {
      clockwise = argument.text == "CLW";
    } else if (argument.text != "RPM" && argument.text != "ON") {
      fault("unsupported-word", argument, fmt::format("SPINDL with '{}' is not followed", shown(argument)),
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
  multi_axis_ = on;
}

void ClInterpreter::tool_axis(const ClStatement& s) {
  Vec3 axis;
  if (!numbers(s, 3, 3, "TLAXIS/i,j,k (unit vector)") || !unit_vector(s, 0, "tool axis", axis)) return;
  axis_W_ = X_WC_.linear() * axis;
  axis_known_ = true;
}

void ClInterpreter::cycle(const ClStatement& s) {
  if (s.arguments.size() == 1 && s.arguments[0].text == "OFF") {
    cycle_.reset();
    return;
  }
  if (!not_compensated(s)) return;
  ClCycle cycle;
  cycle.feed_mm_s = feed_mm_s_;
  if (!read_cycle(s, cycle)) return;
  if (!cycle_) cycle_start_W_ = pose_.tip_W;
  cycle_ = cycle;
}

void ClInterpreter::delay(const ClStatement& s) {
  const bool turns = fits(s, "# REV");
  if (!turns && !numbers(s, 1, 1, "DELAY/seconds or DELAY/turns,REV")) return;
  const ClArgument& given = s.arguments[0];
  if (given.value < 0.0) {
    fault("out-of-range", given, fmt::format("the delay is {:g} {}", given.value, turns ? "turns" : "s"),
          "it must not be below 0");
  } else if (turns && spindle_rpm_ == 0.0) {
    fault("missing-spindle", given, "a delay in turns, and the spindle stands",
          "write SPINDL/RPM,8000,CLW before it");
  } else {
    dwell_s_ += turns ? 60.0 * given.value / std::abs(spindle_rpm_) : given.value;
  }
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
  if (fits(s, "MODE ABSOL")) return;
  fault("unsupported-word", s, "SET is not followed by MODE,ABSOL", "write absolute positions, or GODLTA");
}

void ClInterpreter::mode(const ClStatement& s) {
  if (fits(s, "MILL")) return note(s);
  fault("unsupported-word", s, "MODE is not followed by MILL", "give the path of a mill: MODE/MILL");
}

void ClInterpreter::auxiliary(const ClStatement& s) {
  if (s.arguments.empty() || !s.arguments[0].number) {
    fault("wrong-arguments", s, "AUXFUN gives no number", "write AUXFUN/8");
    return;
  }
  const double code = s.arguments[0].value;
  if (code >= 3.0 && code <= 6.0) {
    fault("unsupported-word", s.arguments[0],
          fmt::format("AUXFUN/{:g} {} behind the file's back", code,
                      code == 6.0 ? "changes the tool" : "starts or stops the spindle"),
          code == 6.0 ? "write LOADTL/1" : "write SPINDL/RPM,8000,CLW, CCLW or SPINDL/OFF");
    return;
  }
  note(s);
}

void ClInterpreter::tolerance(const ClStatement& s) {
  if (!numbers(s, 1, 1, "INTOL/0.01 (mm)")) return;
  if (s.arguments[0].value < 0.0) {
    fault("out-of-range", s.arguments[0], fmt::format("{} is {:g}", s.word, s.arguments[0].value),
          "it must not be below 0");
    return;
  }
  note(s);
}

void ClInterpreter::note(const ClStatement& s) {
  std::string text = s.text;
  for (const ClArgument& argument : s.arguments) {
    if (!text.empty()) text += ',';
    text += argument.number ? fmt::format("{}", argument.value) : argument.text;
  }
  sink_.note({s.word, std::move(text), s.line});
}

}  // namespace swarf::program
