#include "program/siemens/steps.h"

#include <fmt/format.h>

#include <cmath>

#include "program/siemens/milling.h"

namespace swarf::program::nc::siemens {

using nc::Compensation;

using nc::FeedMode;

using nc::Plane;

namespace {

/// G60, G64 and their relatives; ADIS counts the way before and after a corner, whose deviation is at most
/// half of it.
void corner_words(nc::Control& control, BlockPlace& place, Modes& modes, const BlockWords& words) {
  if (words.contour) {
    if (!(words.contour.value >= 0.0))
      fail(place, "out-of-range", words.contour.offset, "CTOL is below zero", "CTOL=0.01");
    modes.tolerance_mm = control.modal.mm(words.contour.value);
  }
  const std::optional<int> corner = words.code(Group::kCorner);
  if (words.rounding && !(words.rounding.value >= 0.0)) {
    fail(place, "out-of-range", words.rounding.offset, "ADIS is below zero", "ADIS=0.5");
  }
  if (words.rounding) modes.rounding_mm = control.modal.mm(words.rounding.value);
  if (corner) modes.corner = *corner;
  if (corner || words.rounding || words.contour) apply_corner(control, modes);
}

void modal_words(Executor& executor, const BlockWords& words) {
  for (const auto& [group, code] : words.codes) {
    switch (group) {
      case Group::kMotion:
        executor.modes.motion = code;
        break;
      case Group::kPlane:
        nc::set_plane(executor.control, code == kG17 ? Plane::kXY : code == kG18 ? Plane::kZX : Plane::kYZ);
        executor.path.polar_angle.reset();
        break;
      case Group::kOffset:
        use_offset(executor.control, executor.frames, code);
        executor.path.last.valid = false;
        break;
      case Group::kUnits:
        executor.modes.units = code;
        nc::set_inches(executor.control.modal, code == kG70 || code == kG700);
        break;
      case Group::kMeasure:
        executor.modes.incremental = code == kG91;
        break;
      case Group::kFeed:
        nc::set_feed_mode(executor.control.modal, code == kG93   ? FeedMode::kInverseTime
                                                  : code == kG94 ? FeedMode::kPerMinute
                                                                 : FeedMode::kPerRevolution);
        break;
      case Group::kReference:
      case Group::kOrientation:
        (group == Group::kReference ? executor.frames.reference : executor.frames.interpolation) = code;
        if (executor.frames.traori) choose_interpolation(executor.control, executor.frames);
        break;
      case Group::kAngles:
        executor.frames.angles = code;
        break;
      case Group::kPathReference:
        executor.path.by_way = code == kSpath;
        break;
      case Group::kExact:
        executor.control.modal.exact_stop_once = true;
        break;
      default:
        break;
    }
  }
  corner_words(executor.control, executor.place, executor.modes, words);
}

/// F is mm/min under G70 too, which changes the unit of lengths alone.
void feed_words(nc::Control& control, BlockPlace& place, Modes& modes, const BlockWords& words) {
  for (size_t i = 0; i < 3; ++i) {
    const Amount& radius = words.feed_radii[i];
    if (!radius) continue;
    if (!(radius.value > 0.0) || control.modal.inches()) {
      fail(place, "out-of-range", radius.offset, "FGREF is a radius above zero, in mm",
           "FGREF[C]=50, in a metric program");
    }
    modes.feed_radii_mm[i] = radius.value;
    control.modal.feed_radii_mm = modes.feed_radii_mm;
  }
  if (!words.feed || words.code(Group::kNoMotion) == kG4) return;
  const double unit_mm =
      modes.units == kG70 ? 1.0 : control.modal.mm(1.0);  // G70 and G71 are about lengths alone
  nc::set_feed_in(control.report, control.modal, unit_mm, words.feed.value, column(place, words.feed.offset));
}

/// D0: no offset; D1: the length of the tool in the spindle.
void set_cutting_edge(nc::Control& control, BlockPlace& place, PathWords& path, double edge, size_t offset) {
  if (edge != 0.0 && edge != 1.0) {
    fail(place, "unsupported-word", offset, fmt::format("cutting edge D{:g} is not in the tool table", edge),
         "tools have one cutting edge: D1, or D0 for none");
  }
  const NcTool* tool = nc::active_tool(control);
  const bool on = edge == 1.0 && tool != nullptr;
  if (on == control.tools.length_on && (!on || tool->length_mm == control.space.length())) return;
  nc::set_length_compensation(control, on ? tool->length_mm : 0.0, on);
  path.last.valid = false;
}

/// M6, or T where it changes the tool at once: D1 of the new tool holds.
void change_tool(nc::Control& control, BlockPlace& place, PathWords& path, size_t offset) {
  nc::change_tool(control);
  path.last.valid = false;
  set_cutting_edge(control, place, path, 1, offset);
}

void tool_words(nc::Control& control, BlockPlace& place, PathWords& path, const BlockWords& words) {
  if (words.tool.given) {
    const int at = column(place, words.tool.offset);
    const bool none = !words.tool.by_name && words.tool.number == 0;
    const int index = none                 ? -1
                      : words.tool.by_name ? nc::find_tool(control, words.tool.name, at)
                                           : nc::find_tool(control, words.tool.number, at);
    nc::select_tool(control.tools, index, words.tool.number);
    if (control.setup.t_changes_tool) change_tool(control, place, path, words.tool.offset);
  }
  for (const Amount& function : words.functions) {
    if (function.value == 6 && !(control.setup.t_changes_tool && words.tool.given))
      change_tool(control, place, path, function.offset);
  }
  if (words.cutting_edge)
    set_cutting_edge(control, place, path, words.cutting_edge.value, words.cutting_edge.offset);
}

void spindle_words(nc::Control& control, BlockPlace& place, const BlockWords& words) {
  if (words.speed && words.code(Group::kNoMotion) != kG4) {
    if (!(words.speed.value >= 0.0)) {
      fail(place, "out-of-range", words.speed.offset,
           fmt::format("S{:g} is no spindle speed", words.speed.value),
           "the direction is M3 or M4; write S above zero");
    }
    control.modal.speed_rpm = words.speed.value;
  }
  for (const Amount& function : words.functions) {
    if (function.value == 3) control.modal.spindle = 1;
    if (function.value == 4) control.modal.spindle = -1;
    if (function.value == 5) control.modal.spindle = 0;
  }
}

void check_contour_rules(const BlockPlace& place, const Modes& modes, size_t offset) {
  if (modes.corner_rule != "G450")
    fail(place, "unsupported-word", offset,
         "G41 and G42 with G451 (outer corners that run out to a point) are not supported",
         "G450: outer corners are rounded");
  if (modes.entry_rule != "NORM")
    fail(place, "unsupported-word", offset,
         fmt::format("G41 and G42 with {} are not supported", modes.entry_rule),
         "NORM: contours are entered at a right angle");
}

/// G40, G41, G42: before the motion of their block. OFFN widens the cutter from the next G41, G42 on.
/// How G41 and G42 enter contours and pass corners: without effect as long as they are off.
void keep_contour_rule(nc::Control& control, BlockPlace& place, Modes& modes, const NamedPlace& word) {
  const bool entry = word.name == "NORM" || word.name.starts_with("KONT");
  if (!entry && word.name != "G450" && word.name != "G451") return;
  std::string& rule = entry ? modes.entry_rule : modes.corner_rule;
  if (rule == word.name) return;
  rule = word.name;
  if (control.contour.side() != Compensation::kOff) check_contour_rules(place, modes, word.offset);
}

void noted_words(nc::Control& control, BlockPlace& place, Modes& modes, const BlockWords& words) {
  for (const Amount& function : words.functions) {
    const bool known = function.value >= 2 && function.value <= 6;
    if (known || function.value == 17 || function.value == 30) continue;
    const std::string name = fmt::format("M{:.0f}", function.value);
    control.report.without_effect(name);
    control.report.note(name, "");
  }
  for (const NamedPlace& word : words.noted) {
    keep_contour_rule(control, place, modes, word);
    control.report.without_effect(word.name);
    control.report.note(word.name, "");
  }
}

Outcome end_words(CallState& calls, const BlockWords& words) {
  for (const Amount& function : words.functions) {
    if (function.value == 2 || function.value == 30) return Outcome::kEnd;
    if (function.value == 17) return Outcome::kReturn;
  }
  if (words.ends_program) return Outcome::kReturn;
  return calls.pattern_done ? Outcome::kPattern : Outcome::kNext;
}

}  // namespace

Executor::Executor(nc::Control& machine) : control(machine) {
  control.report.words.length_on = "D1";
  control.contour.set_entry(nc::CompensationEntry::kAcrossNext);
  control.modal.exact_stop = true;
  if (control.modal.inches()) modes.units = kG700;
}

void fail(const BlockPlace& place, const char* code, size_t offset, std::string text, std::string fix) {
  refuse(*place.line, offset, code, std::move(text), std::move(fix));
}

long Executor::moves() const {
  return control.report.summary.moves;
}

void Executor::note(const std::string& word, const std::string& text, const std::string& file, int line) {
  control.report.at(control.report.enter_file(file), line, 1);
  control.report.without_effect(word);
  control.report.note(word, text);
}

bool Executor::takes_builders(const std::string& name, const LineRef& line) {
  control.report.at(control.report.enter_file(*line.file), line.line, 1);
  return control.report.take_builder_word(name);
}

Outcome Executor::block(TokenReader& reader, Variables& variables) {
  place.line = &reader.line();
  if (place.line->file != place.file_name) {
    place.file_name = place.line->file;
    place.file = control.report.enter_file(*place.line->file);
  }
  control.report.at(place.file, place.line->line, column(place, reader.offset()));
  const bool modal_call = reader.position() > 0 && reader.previous().named("MCALL");
  words.clear();
  calls.pattern_done = false;
  const bool reading = contour != nullptr;
  read_block(reader, variables, words);
  if (reading) check_contour_block(*this, words, modal_call);
  if (path.open) close_line(*this, words);
  if (modal_call) {
    calls.modal_cycle.reset();
    if (words.calls.empty()) return Outcome::kNext;
    const CycleCall& call = words.calls.front();
    if (call.name.size() != 7 || !call.name.starts_with("CYCLE8")) {
      fail(place, "unsupported-word", call.offset, fmt::format("MCALL {} is not supported", call.name),
           "MCALL takes a drilling cycle or a program: MCALL CYCLE81(10,0,2,-20)");
    }
    calls.modal_cycle = call;
    drilling(control, place, frames, *calls.modal_cycle);  // refuses now what could not be drilled later
    return Outcome::kNext;
  }
  modal_words(*this, words);
  feed_words(control, place, modes, words);
  tool_words(control, place, path, words);
  spindle_words(control, place, words);
  noted_words(control, place, modes, words);
  if (words.transform) transform_words(*this, words);
  if (words.frame) {
    frame_words(*this, words);
  } else {
    for (const CycleCall& call : words.calls) run_call(*this, call);
    motion_words(*this, words);
  }
  if (contour && !reading) return Outcome::kContour;
  return end_words(calls, words);
}

ContourName Executor::contour_asked() const {
  return {contour->call.arguments[0]->text, contour->call.offsets[0]};
}

void Executor::contour_read() {
  mill_contour(*this);
}

void apply_corner(nc::Control& control, Modes& modes) {
  control.modal.exact_stop = modes.corner == kG60;
  control.modal.corner_tolerance_mm = modes.corner == kG641   ? 0.5 * modes.rounding_mm
                                      : modes.corner == kG642 ? modes.tolerance_mm
                                                              : 0.0;
}

/// FGROUP: X Y Z, or them and every rotary axis, which then count with FGREF. FGROUP() is X Y Z again.
void feed_group(Executor& executor, const CycleCall& call) {
  unsigned given = 0, rotary = 0;
  for (const auto& axis : call.arguments) {
    const size_t word = std::string_view(nc::kAxisLetters).find(axis->text[0]);
    nc::require_axis(executor.control, static_cast<nc::AxisWord>(word), column(executor.place, call.offset));
    given |= 1u << word;
  }
  for (int word = 3; word < nc::kAxisWords; ++word) {
    if (executor.control.space.axis_of(static_cast<nc::AxisWord>(word)) >= 0) rotary |= 1u << word;
  }
  const bool linear = given == 0 || given == 0x07u, all = given == (0x07u | rotary);
  if (!linear && !all) {
    fail(executor.place, "unsupported-word", call.offset,
         "FGROUP is supported with X Y Z, or with all axes of the machine",
         "FGROUP(X,Y,Z), or FGROUP() as the control starts");
  }
  if (!linear && executor.frames.traori) {
    fail(executor.place, "unsupported-word", call.offset,
         "FGROUP with rotary axes under TRAORI is not supported",
         "F is that of the tip there: FGROUP(X,Y,Z)");
  }
  executor.modes.feed_of_rotaries = !linear;
  executor.control.modal.feed_rule = linear ? nc::FeedRule::kLinearFirst : nc::FeedRule::kAllAxes;
}

void cutter_words(Executor& executor, const BlockWords& words) {
  const std::optional<int> code = words.code(Group::kCutter);
  if (words.allowance) {
    executor.modes.allowance_mm = executor.control.modal.mm(words.allowance.value);
    if (executor.control.contour.side() != Compensation::kOff && !code) {
      fail(executor.place, "unsupported-word", words.allowance.offset,
           "OFFN that changes while G41 or G42 is active is not supported", "write OFFN with G41 or G42");
    }
  }
  if (!code) return;
  if (*code == kG40) {
    nc::set_compensation(executor.control, Compensation::kOff, 0.0, executor.control.report.place.column);
    return;
  }
  check_contour_rules(executor.place, executor.modes, 0);
  const NcTool* tool = nc::active_tool(executor.control);
  const bool no_table = tool == nullptr && nc::no_tool_table(executor.control, 0);
  if (!no_table && (tool == nullptr || !executor.control.tools.length_on)) {
    executor.control.report.fail("compensation-no-tool", 0,
                                 "cutter radius compensation has no tool: none is in the spindle, or D0",
                                 "load a tool of the table and write D1");
  }
  const double own = no_table ? 0.0 : 0.5 * tool->diameter_mm, radius = own + executor.modes.allowance_mm;
  if (!(radius >= 0.0)) {
    fail(executor.place, "out-of-range", words.allowance ? words.allowance.offset : 0,
         fmt::format("OFFN {:g} mm takes more than the radius {:g} mm of the cutter",
                     executor.modes.allowance_mm, own),
         "compensate on the other side");
  }
  const bool left = (*code == kG41) != mirrored(executor.control, executor.frames);
  nc::set_compensation(executor.control, left ? Compensation::kLeft : Compensation::kRight, radius,
                       executor.control.report.place.column);
}

}  // namespace swarf::program::nc::siemens
