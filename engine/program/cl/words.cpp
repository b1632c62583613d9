#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/units.h"
#include "program/cl/steps.h"
#include "program/move_way.h"

namespace swarf::program::cldata {
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

double feed_of(Reporter& reporter, ClSystems& systems, ClRates& feed, const ClArgument& value,
               const std::string& unit) {
  if (!(value.value > 0.0)) {
    fault(reporter, "out-of-range", value, fmt::format("the feed is {:g}", value.value),
          "it must be above 0");
    return 0.0;
  }
  const FeedUnit* known = find_unit(unit);
  const double length =
      known != nullptr && known->length_mm > 0.0 ? known->length_mm * value.value : systems.mm(value.value);
  if (known == nullptr || !known->per_revolution) return mm_s_from_mm_min(length);
  if (feed.spindle_rpm == 0.0) {
    fault(reporter, "missing-spindle", value, "a feed per revolution, and the spindle stands",
          "write SPINDL/RPM,8000,CLW before it");
  }
  return mm_s_from_mm_min(length * std::abs(feed.spindle_rpm));
}

void feed_rate(ClState& cl, const ClStatement& s) {
  const char* form = "write FEDRAT/500,MMPM (mm/min), or MMPR, IPM, IPR, FPM, FPR, PERMIN, PERREV";
  const ClArgument* value = nullptr;
  std::string unit;
  for (const ClArgument& argument : s.arguments) {
    if (argument.number && value == nullptr) {
      value = &argument;
    } else if (unit.empty() && find_unit(argument.text) != nullptr) {
      unit = argument.text;
    } else {
      fault(cl.reporter, "unsupported-word", argument,
            fmt::format("FEDRAT with '{}' is not followed", shown(argument)), form);
      return;
    }
  }
  if (value == nullptr) {
    fault(cl.reporter, "wrong-arguments", s, "FEDRAT has no number", form);
    return;
  }
  const double feed = feed_of(cl.reporter, cl.systems, cl.feed, *value, unit);
  if (feed > 0.0) cl.feed.feed_mm_s = feed;
}

void spindle(ClState& cl, const ClStatement& s) {
  double rpm = std::abs(cl.feed.spindle_rpm);
  bool clockwise = cl.feed.spindle_rpm >= 0.0, number = false;
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
      fault(cl.reporter, "unsupported-word", argument,
            fmt::format("SPINDL with '{}' is not followed", shown(argument)),
            "write SPINDL/RPM,8000,CLW (rev/min) or SPINDL/OFF");
      return;
    }
    if (rpm < 0.0) {
      fault(cl.reporter, "out-of-range", argument, fmt::format("the spindle speed is {:g} rev/min", rpm),
            "it must not be below 0; CCLW turns the other way");
      return;
    }
  }
  cl.feed.spindle_rpm = clockwise ? rpm : -rpm;
}

void multi_axis(ClState& cl, const ClStatement& s) {
  const bool on = s.arguments.empty() || s.arguments[0].text == "ON";
  if (s.arguments.size() > 1 || (!on && s.arguments[0].text != "OFF")) {
    fault(cl.reporter, "wrong-arguments", s, "MULTAX is followed by neither ON nor OFF",
          "write MULTAX/ON or MULTAX/OFF");
    return;
  }
  // Whether a three-axis tool leans with a TRACUT that tilts, nobody says.
  const Vec3 z_W = cl.systems.X_WC.linear().col(2);
  if (!on) cl.path.axis_W = z_W;
  cl.path.axis_known = on ? cl.path.axis_known && cl.path.positioned
                          : z_W.isApprox(cl.systems.X_SC.linear().col(2), kAxisStands);
  cl.path.multi_axis = on;
}

void tool_axis(ClState& cl, const ClStatement& s) {
  Vec3 axis;
  if (!numbers(cl.reporter, s, 3, 3, "TLAXIS/i,j,k (unit vector)") ||
      !unit_vector(cl.reporter, s, 0, "tool axis", axis))
    return;
  cl.path.axis_W = cl.systems.X_WC.linear() * axis;
  cl.path.axis_known = true;
}

void cycle(ClState& cl, const ClStatement& s) {
  if (s.arguments.size() == 1 && s.arguments[0].text == "OFF") {
    cl.drilling.cycle.reset();
    return;
  }
  // SolidWorks CAM prepares a cycle with INIT, and clears its registers with CLEAR.
  const bool prepares =
      s.arguments.size() == 1 && (s.arguments[0].text == "INIT" || s.arguments[0].text == "CLEAR");
  if (prepares && !cl.drilling.cycle) return note(cl, s);
  if (prepares) {
    fault(cl.reporter, "bad-cycle", s, fmt::format("CYCLE/{} stands inside a cycle", s.arguments[0].text),
          "write CYCLE/OFF before it");
    return;
  }
  if (!not_compensated(cl.reporter, cl.compensation, s)) return;
  ClCycle cycle;
  cycle.feed_mm_s = cl.feed.feed_mm_s;
  if (!read_cycle(cl, s, cycle)) return;
  if (!cl.drilling.cycle) cl.drilling.cycle_start_W = cl.path.pose.tip_W;
  cl.drilling.cycle = cycle;
}

void delay(ClState& cl, const ClStatement& s) {
  const bool turns = fits(s, "# REV");
  if (!turns && !numbers(cl.reporter, s, 1, 1, "DELAY/seconds or DELAY/turns,REV")) return;
  const ClArgument& given = s.arguments[0];
  if (given.value < 0.0) {
    fault(cl.reporter, "out-of-range", given,
          fmt::format("the delay is {:g} {}", given.value, turns ? "turns" : "s"), "it must not be below 0");
  } else if (turns && cl.feed.spindle_rpm == 0.0) {
    fault(cl.reporter, "missing-spindle", given, "a delay in turns, and the spindle stands",
          "write SPINDL/RPM,8000,CLW before it");
  } else {
    cl.feed.dwell_s += turns ? 60.0 * given.value / std::abs(cl.feed.spindle_rpm) : given.value;
    if (cl.feed.dwell_s > 3600.0 * kHoursMax)
      fault(cl.reporter, "too-many-cycles", given,
            fmt::format("the program dwells for {:.3g} h here, more than {:g} h", cl.feed.dwell_s / 3600.0,
                        kHoursMax),
            "mend the delay of this statement");
  }
}

void units(ClState& cl, const ClStatement& s) {
  const std::string unit = s.arguments.size() == 1 ? s.arguments[0].text : "";
  const bool inches = unit == "INCHES" || unit == "INCH";
  if (unit != "MM" && !inches) {
    fault(cl.reporter, "unsupported-word", s, "UNITS is followed by neither MM nor INCHES",
          "write UNITS/MM or UNITS/INCHES");
  } else if ((cl.path.positioned || cl.systems.tracut) && inches != (cl.systems.unit_mm != 1.0)) {
    fault(
        cl.reporter, "unsupported-word", s,
        fmt::format("the units change after {} has been given", cl.path.positioned ? "a position" : "TRACUT"),
        "give the units before the first position and before TRACUT");
  } else {
    cl.systems.unit_mm = inches ? kInch : 1.0;
    cl.program.unit_assumed = false;
  }
}

void set_mode(ClState& cl, const ClStatement& s) {
  if (fits(s, "MODE ABSOL")) return;
  fault(cl.reporter, "unsupported-word", s, "SET is not followed by MODE,ABSOL",
        "write absolute positions, or GODLTA");
}

void mode(ClState& cl, const ClStatement& s) {
  if (fits(s, "MILL")) return note(cl, s);
  fault(cl.reporter, "unsupported-word", s, "MODE is not followed by MILL",
        "give the path of a mill: MODE/MILL");
}

void auxiliary(ClState& cl, const ClStatement& s) {
  if (s.arguments.empty() || !s.arguments[0].number) {
    fault(cl.reporter, "wrong-arguments", s, "AUXFUN gives no number", "write AUXFUN/8");
    return;
  }
  const double code = s.arguments[0].value;
  if (code >= 3.0 && code <= 6.0) {
    fault(cl.reporter, "unsupported-word", s.arguments[0],
          fmt::format("AUXFUN/{:g} {} behind the file's back", code,
                      code == 6.0 ? "changes the tool" : "starts or stops the spindle"),
          code == 6.0 ? "write LOADTL/1" : "write SPINDL/RPM,8000,CLW, CCLW or SPINDL/OFF");
    return;
  }
  note(cl, s);
}

void tolerance(ClState& cl, const ClStatement& s) {
  if (!numbers(cl.reporter, s, 1, 1, "INTOL/0.01 (mm)")) return;
  if (s.arguments[0].value < 0.0) {
    fault(cl.reporter, "out-of-range", s.arguments[0],
          fmt::format("{} is {:g}", s.word, s.arguments[0].value), "it must not be below 0");
    return;
  }
  note(cl, s);
}

void note(ClState& cl, const ClStatement& s) {
  std::string text = s.text;
  for (const ClArgument& argument : s.arguments) {
    if (!text.empty()) text += ',';
    text += argument.number ? fmt::format("{}", argument.value) : argument.text;
  }
  cl.sink.note({s.word, std::move(text), s.line});
}

}  // namespace swarf::program::cldata
