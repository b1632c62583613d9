// Variables of custom macro B: local, common and system ones.
#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "program/control/presets.h"
#include "program/fanuc/steps.h"

namespace swarf::program::nc::fanuc {
namespace {

constexpr long kLocals = 33;
constexpr long kFirstCommon = 100;

/// The call whose #1 to #33 hold here.
size_t locals(const Calls& calls) {
  size_t level = calls.stack.size() - 1;
  while (level > 0 && !calls.stack[level].own_locals) --level;
  return level;
}

/// The comment behind #3000=1 and #3006=1, which the control shows: ": text".
std::string comment_behind(const LetterDialect& letters) {
  const std::string_view rest = letters.reader.line().substr(letters.reader.at());
  const size_t open = rest.find('('), close = rest.find(')');
  if (open == std::string_view::npos || close == std::string_view::npos || close < open) return "";
  return ": " + std::string(rest.substr(open + 1, close - open - 1));
}

void assign(Calls& calls, Variables& variables, LetterDialect& letters, long number, double value,
            size_t place) {
  const int at = letters.reader.column_of(place);
  const bool vacates = std::isnan(value);  // #1=#0
  if (number >= 1 && number <= kLocals) {
    Call& here = calls.stack[locals(calls)];
    const uint64_t bit = uint64_t{1} << number;
    here.locals[static_cast<size_t>(number)] = value;
    here.assigned = vacates ? here.assigned & ~bit : here.assigned | bit;
  } else if (number >= kFirstCommon && number <= kLastCommon) {
    variables.common[static_cast<size_t>(number)] = value;
    variables.assigned[static_cast<size_t>(number)] = !vacates;
  } else if (vacates) {
    letters.control.report.fail("undefined-parameter", at,
                                fmt::format("#{} is given a vacant variable", number),
                                "assign the variable before it is read");
  } else if (number == 3000) {
    letters.control.report.fail(
        "program-alarm", at,
        fmt::format("the program raises its alarm {:g} here{}", value, comment_behind(letters)),
        "find out why the program stops itself");
  } else if (number == 3006) {
    letters.control.report.note("#3006", fmt::format("stop {:g}{}", value, comment_behind(letters)));
  } else if (number == 3003) {
    letters.control.report.without_effect("#3003 (single block off)");
  } else if (number == 3004 && value >= 0.0 && value < 4.0) {
    letters.control.report.without_effect("#3004 (feed hold and override off)");
  } else {
    letters.control.report.fail("bad-parameter", at, fmt::format("#{} cannot be assigned", number),
                                "programs may set #1 to #33 and #100 to #999; offsets with G10");
  }
}

}  // namespace

/// G code that holds in a group of the manual's table (#4001 to #4022), as far as programs can change it
/// here.
std::optional<double> modal_code(const Fanuc& fanuc, long group) {
  switch (group) {
    case 1:
      return fanuc.modes.motion / 10.0;
    case 2:
      return 17.0 + static_cast<int>(fanuc.control.modal.plane);
    case 3:
      return fanuc.modes.incremental ? 91.0 : 90.0;
    case 5:
      return fanuc.control.modal.feed_mode == FeedMode::kInverseTime ? 93.0
             : fanuc.control.modal.feed_mode == FeedMode::kPerMinute ? 94.0
                                                                     : 95.0;
    case 6:
      return fanuc.control.modal.inches() ? 20.0 : 21.0;
    case 7:
      return fanuc.control.contour.side() == Compensation::kOff    ? 40.0
             : fanuc.control.contour.side() == Compensation::kLeft ? 41.0
                                                                   : 42.0;
    case 8:
      return fanuc.modes.length_code / 10.0;
    case 9:
      return fanuc.modes.cycle / 10.0;
    case 10:
      return fanuc.modes.retract_to_r ? 99.0 : 98.0;
    case 11:
      return fanuc.mapping.scaled ? 51.0 : 50.0;
    case 12:
      return fanuc.calls.stack.top().modals > 0 ? 66.0 : 67.0;
    case 13:
      return 97.0;
    case 14:
      return fanuc.control.offsets.active > 100 ? 54.1 : 53.0 + fanuc.control.offsets.active;
    case 16:
      return fanuc.modes.turn_code / 10.0;
    case 17:
      return fanuc.mapping.polar.on ? 16.0 : 15.0;
    case 22:
      return fanuc.mapping.mirrored ? 51.1 : 50.1;
    default:
      return std::nullopt;
  }
}

namespace {

double system_variable(Fanuc& fanuc, long number, size_t place) {
  if (fanuc.rules.variable != nullptr) {
    if (const std::optional<double> own = fanuc.rules.variable(fanuc, number, place)) return *own;
  }
  const auto in_words = [&](double value, long word) {
    return word < 3 ? value / fanuc.control.modal.mm(1.0) : deg_from_rad(value);
  };
  const auto programmed = [&](long word) {
    const double value = nc::position(fanuc.control)[static_cast<size_t>(word)];
    if (!std::isfinite(value))
      fanuc.control.report.fail("start-unknown", fanuc.reader.column_of(place),
                                fmt::format("#{} asks for a position that is not known yet", number),
                                "give the start position: start in [setup] of the scene, swarf check --home");
    return in_words(value, word);
  };
  const auto offset = [&](long from, int first) {
    const long word = (number - from) % 20;
    const int axis = fanuc.control.space.axis_of(static_cast<AxisWord>(word));
    const int of = first + static_cast<int>((number - from) / 20);
    return axis < 0 ? 0.0
                    : in_words(nc::offset_origin(fanuc.control.space, fanuc.control.offsets, of)[axis], word);
  };
  const auto is_offset = [&](long from, long count) {
    return number >= from && number < from + 20 * count && (number - from) % 20 < kAxisWords;
  };
  if (number >= 5001 && number <= 5006) return programmed(number - 5001);
  if (number >= 5041 && number <= 5046) return programmed(number - 5041);
  if (number >= 5021 && number <= 5026) {
    const long word = number - 5021;
    const int axis = fanuc.control.space.axis_of(static_cast<AxisWord>(word));
    return axis < 0 ? 0.0 : in_words(fanuc.control.path.q[axis], word);
  }
  if (is_offset(5221, 6)) return offset(5221, 1);
  if (is_offset(7001, 48)) return offset(7001, 101);
  if (is_offset(14001, 300)) return offset(14001, 101);
  if (number >= 4001 && number <= 4022) {
    if (const std::optional<double> code = modal_code(fanuc, number - 4000)) return *code;
  }
  for (size_t slot = 0; slot < 4; ++slot) {
    // #10001: wear of lengths, #11001: lengths, #12001: wear of radii, #13001: radii.
    const long first = 10000 + 1000 * static_cast<long>(slot % 2 == 1 ? slot - 1 : slot + 1);
    if (number > first && number < first + 1000)
      return tool_offset(fanuc.zero, fanuc, static_cast<int>(number - first), slot,
                         fanuc.reader.column_of(place)) /
             fanuc.control.modal.mm(1.0);
  }
  if (number == 4107) return fanuc.modes.d_number;
  if (number == 4109) return fanuc.control.modal.feed;
  if (number == 4111) return fanuc.modes.h_number;
  if (number == 4119) return fanuc.control.modal.speed_rpm;
  if (number == 4120) return fanuc.control.tools.selected_number;
  if (number == 4130) return fanuc.control.offsets.active > 100 ? fanuc.control.offsets.active - 100 : 0.0;
  fanuc.control.report.fail(
      "undefined-parameter", fanuc.reader.column_of(place),
      fmt::format("#{} is no variable that can be read here", number),
      "read #4001 to #4130 (modal codes), #5001 to #5046 (positions) or #5221 to #5326 (offsets)");
}

}  // namespace

void set_presets(const Presets& presets, Calls& calls, Variables& variables) {
  for (const auto& [name, preset] : presets) {
    const long number = preset_number(name, "").value_or(0);
    if (number >= 1 && number <= kLocals) {
      calls.stack.top().locals[static_cast<size_t>(number)] = preset.value;
      calls.stack.top().assigned |= uint64_t{1} << number;
    } else if (number >= kFirstCommon && number <= kLastCommon) {
      variables.common[static_cast<size_t>(number)] = preset.value;
      variables.assigned[static_cast<size_t>(number)] = true;
    } else {
      refuse_preset(name, preset, "programs may set #1 to #33 and #100 to #999: 500 = 3.5");
    }
  }
}

void assignment(Calls& calls, Variables& variables, LetterDialect& letters) {
  const size_t place = letters.reader.at();
  std::string name;
  const long number = letters.reader.parameter_number(name);
  letters.reader.skip_space();
  if (letters.reader.peek() != '=')
    letters.control.report.fail("bad-parameter", letters.reader.column(), "'=' is missing after the variable",
                                "write #1=2.5");
  letters.reader.skip();
  assign(calls, variables, letters, number, letters.reader.open_formula(), place);
}

double Fanuc::read(long number, size_t place) {
  if (number >= 1 && number <= kLocals) {
    const Call& here = calls.stack[locals(calls)];
    if ((here.assigned >> number & 1u) != 0) return here.locals[static_cast<size_t>(number)];
  } else if (number >= kFirstCommon && number <= kLastCommon &&
             variables.assigned[static_cast<size_t>(number)]) {
    return variables.common[static_cast<size_t>(number)];
  } else if (number > kLastCommon) {
    return system_variable(*this, number, place);
  }
  control.report.fail("undefined-parameter", reader.column_of(place),
                      fmt::format("#{} is vacant: nothing assigned it", number),
                      "assign it before it is read");
}

bool Fanuc::vacant(long number) const {
  if (number >= 1 && number <= kLocals) return (calls.stack[locals(calls)].assigned >> number & 1u) == 0;
  if (number >= kFirstCommon && number <= kLastCommon)
    return !variables.assigned[static_cast<size_t>(number)];
  return number == 0;
}

double Fanuc::read_named(std::string_view name, size_t place) {
  control.report.fail("bad-parameter", reader.column_of(place),
                      fmt::format("#<{}>: this dialect has no named variables", name), "write #100");
}

bool Fanuc::exists(std::string_view /*name*/) {
  return false;
}

}  // namespace swarf::program::nc::fanuc
