#include "program/siemens/executor.h"

#include <fmt/format.h>

#include <cmath>

namespace swarf::program::nc::siemens {

using nc::Compensation;
using nc::FeedMode;
using nc::Plane;

Executor::Executor(nc::Control& control) : control_(control) {
  nc::DialectWords words;
  words.length_on = "D1";
  control_.report.words = words;
  control_.contour.set_entry(nc::CompensationEntry::kAcrossNext);
  control_.modal.exact_stop = true;
}

void Executor::fail(const char* code, size_t offset, std::string text, std::string fix) const {
  refuse(*line_, offset, code, std::move(text), std::move(fix));
}

long Executor::moves() const {
  return control_.report.summary.moves;
}

void Executor::note(const std::string& word, const std::string& text, const std::string& file, int line) {
  control_.report.at(control_.report.enter_file(file), line, 1);
  control_.report.without_effect(word);
  control_.report.note(word, text);
}

bool Executor::takes_builders(const std::string& name, const LineRef& line) {
  control_.report.at(control_.report.enter_file(*line.file), line.line, 1);
  return control_.report.take_builder_word(name);
}

Outcome Executor::block(TokenReader& reader, Variables& variables) {
  line_ = &reader.line();
  if (line_->file != file_name_) {
    file_name_ = line_->file;
    file_ = control_.report.enter_file(*line_->file);
  }
  control_.report.at(file_, line_->line, column(reader.offset()));
  const bool modal_call = reader.position() > 0 && reader.previous().named("MCALL");
  words_.clear();
  pattern_done_ = false;
  read_block(reader, variables, words_);
  if (modal_call) {
    modal_cycle_.reset();
    if (words_.calls.empty()) return Outcome::kNext;
    const CycleCall& call = words_.calls.front();
    if (call.name.size() != 7 || !call.name.starts_with("CYCLE8")) {
      fail("unsupported-word", call.offset, fmt::format("MCALL {} is not supported", call.name),
           "MCALL takes a drilling cycle or a program: MCALL CYCLE81(10,0,2,-20)");
    }
    modal_cycle_ = call;
    drilling(*modal_cycle_);  // refuses now what could not be drilled later
    return Outcome::kNext;
  }
  modal_words(words_);
  feed_words(words_);
  tool_words(words_);
  spindle_words(words_);
  noted_words(words_);
  if (words_.transform) transform_words(words_);
  if (words_.frame) {
    frame_words(words_);
  } else {
    for (const CycleCall& call : words_.calls) run_call(call);
    motion_words(words_);
  }
  return end_words(words_);
}

void Executor::modal_words(const BlockWords& words) {
  for (const auto& [group, code] : words.codes) {
    switch (group) {
      case Group::kMotion:
        motion_ = code;
        break;
      case Group::kPlane:
        nc::set_plane(control_, code == kG17 ? Plane::kXY : code == kG18 ? Plane::kZX : Plane::kYZ);
        polar_angle_.reset();
        break;
      case Group::kOffset:
        use_offset(code);
        last_.valid = false;
        break;
      case Group::kUnits:
        units_ = code;
        nc::set_inches(control_.modal, code == kG70 || code == kG700);
        break;
      case Group::kMeasure:
        incremental_ = code == kG91;
        break;
      case Group::kFeed:
        nc::set_feed_mode(control_.modal, code == kG93   ? FeedMode::kInverseTime
                                          : code == kG94 ? FeedMode::kPerMinute
                                                         : FeedMode::kPerRevolution);
        break;
      case Group::kReference:
      case Group::kOrientation:
        (group == Group::kReference ? reference_ : interpolation_) = code;
        if (traori_) choose_interpolation();
        break;
      case Group::kAngles:
        angles_ = code;
        break;
      case Group::kPathReference:
        by_way_ = code == kSpath;
        break;
      case Group::kExact:
        control_.modal.exact_stop_once = true;
        break;
      default:
        break;
    }
  }
  corner_words(words);
}

/// G60, G64 and their relatives; ADIS counts the way before and after a corner, whose deviation is at most
/// half of it.
void Executor::corner_words(const BlockWords& words) {
  if (words.contour) {
    if (!(words.contour.value >= 0.0))
      fail("out-of-range", words.contour.offset, "CTOL is below zero", "CTOL=0.01");
    tolerance_mm_ = control_.modal.mm(words.contour.value);
  }
  const std::optional<int> corner = words.code(Group::kCorner);
  if (words.rounding && !(words.rounding.value >= 0.0)) {
    fail("out-of-range", words.rounding.offset, "ADIS is below zero", "ADIS=0.5");
  }
  if (words.rounding) rounding_mm_ = control_.modal.mm(words.rounding.value);
  if (corner) corner_ = *corner;
  if (corner || words.rounding || words.contour) apply_corner();
}

void Executor::apply_corner() {
  control_.modal.exact_stop = corner_ == kG60;
  control_.modal.corner_tolerance_mm = corner_ == kG641   ? 0.5 * rounding_mm_
                                       : corner_ == kG642 ? tolerance_mm_
                                                          : 0.0;
}

/// F is mm/min under G70 too, which changes the unit of lengths alone.
void Executor::feed_words(const BlockWords& words) {
  for (size_t i = 0; i < 3; ++i) {
    const Amount& radius = words.feed_radii[i];
    if (!radius) continue;
    if (!(radius.value > 0.0) || control_.modal.inches()) {
      fail("out-of-range", radius.offset, "FGREF is a radius above zero, in mm",
           "FGREF[C]=50, in a metric program");
    }
    feed_radii_mm_[i] = radius.value;
    control_.modal.feed_radii_mm = feed_radii_mm_;
  }
  if (!words.feed || words.code(Group::kNoMotion) == kG4) return;
  const double unit_mm =
      units_ == kG70 ? 1.0 : control_.modal.mm(1.0);  // G70 and G71 are about lengths alone
  nc::set_feed_in(control_.report, control_.modal, unit_mm, words.feed.value, column(words.feed.offset));
}

void Executor::tool_words(const BlockWords& words) {
  if (words.tool.given) {
    const int at = column(words.tool.offset);
    const bool none = !words.tool.by_name && words.tool.number == 0;
    const int index = none                 ? -1
                      : words.tool.by_name ? nc::find_tool(control_, words.tool.name, at)
                                           : nc::find_tool(control_, words.tool.number, at);
    nc::select_tool(control_.tools, index, words.tool.number);
  }
  for (const Amount& function : words.functions) {
    if (function.value != 6) continue;
    nc::change_tool(control_);
    last_.valid = false;
    set_cutting_edge(1, function.offset);
  }
  if (words.cutting_edge) set_cutting_edge(words.cutting_edge.value, words.cutting_edge.offset);
}

/// D0: no offset; D1: the length of the tool in the spindle.
void Executor::set_cutting_edge(double edge, size_t offset) {
  if (edge != 0.0 && edge != 1.0) {
    fail("unsupported-word", offset, fmt::format("cutting edge D{:g} is not in the tool table", edge),
         "tools have one cutting edge: D1, or D0 for none");
  }
  const NcTool* tool = nc::active_tool(control_);
  const bool on = edge == 1.0 && tool != nullptr;
  if (on == control_.tools.length_on && (!on || tool->length_mm == control_.space.length())) return;
  nc::set_length_compensation(control_, on ? tool->length_mm : 0.0, on);
  last_.valid = false;
}

void Executor::spindle_words(const BlockWords& words) {
  if (words.speed && words.code(Group::kNoMotion) != kG4) {
    if (!(words.speed.value >= 0.0)) {
      fail("out-of-range", words.speed.offset, fmt::format("S{:g} is no spindle speed", words.speed.value),
           "the direction is M3 or M4; write S above zero");
    }
    control_.modal.speed_rpm = words.speed.value;
  }
  for (const Amount& function : words.functions) {
    if (function.value == 3) control_.modal.spindle = 1;
    if (function.value == 4) control_.modal.spindle = -1;
    if (function.value == 5) control_.modal.spindle = 0;
  }
}

void Executor::noted_words(const BlockWords& words) {
  for (const Amount& function : words.functions) {
    const bool known = function.value >= 2 && function.value <= 6;
    if (known || function.value == 17 || function.value == 30) continue;
    const std::string name = fmt::format("M{:.0f}", function.value);
    control_.report.without_effect(name);
    control_.report.note(name, "");
  }
  for (const NamedPlace& word : words.noted) {
    keep_contour_rule(word);
    control_.report.without_effect(word.name);
    control_.report.note(word.name, "");
  }
}

/// FGROUP: X Y Z, or them and every rotary axis, which then count with FGREF. FGROUP() is X Y Z again.
void Executor::feed_group(const CycleCall& call) {
  unsigned given = 0, rotary = 0;
  for (const auto& axis : call.arguments) {
    const size_t word = std::string_view(nc::kAxisLetters).find(axis->text[0]);
    nc::require_axis(control_, static_cast<nc::AxisWord>(word), column(call.offset));
    given |= 1u << word;
  }
  for (int word = 3; word < nc::kAxisWords; ++word) {
    if (control_.space.axis_of(static_cast<nc::AxisWord>(word)) >= 0) rotary |= 1u << word;
  }
  const bool linear = given == 0 || given == 0x07u, all = given == (0x07u | rotary);
  if (!linear && !all) {
    fail("unsupported-word", call.offset, "FGROUP is supported with X Y Z, or with all axes of the machine",
         "FGROUP(X,Y,Z), or FGROUP() as the control starts");
  }
  if (!linear && traori_) {
    fail("unsupported-word", call.offset, "FGROUP with rotary axes under TRAORI is not supported",
         "F is that of the tip there: FGROUP(X,Y,Z)");
  }
  feed_of_rotaries_ = !linear;
  control_.modal.feed_rule = linear ? nc::FeedRule::kLinearFirst : nc::FeedRule::kAllAxes;
}

/// G40, G41, G42: before the motion of their block. OFFN widens the cutter from the next G41, G42 on.
/// How G41 and G42 enter contours and pass corners: without effect as long as they are off.
void Executor::keep_contour_rule(const NamedPlace& word) {
  const bool entry = word.name == "NORM" || word.name.starts_with("KONT");
  if (!entry && word.name != "G450" && word.name != "G451") return;
  std::string& rule = entry ? entry_rule_ : corner_rule_;
  if (rule == word.name) return;
  rule = word.name;
  if (control_.contour.side() != Compensation::kOff) check_contour_rules(word.offset);
}

void Executor::check_contour_rules(size_t offset) const {
  if (corner_rule_ != "G450")
    fail("unsupported-word", offset,
         "G41 and G42 with G451 (outer corners that run out to a point) are not supported",
         "G450: outer corners are rounded");
  if (entry_rule_ != "NORM")
    fail("unsupported-word", offset, fmt::format("G41 and G42 with {} are not supported", entry_rule_),
         "NORM: contours are entered at a right angle");
}

void Executor::cutter_words(const BlockWords& words) {
  const std::optional<int> code = words.code(Group::kCutter);
  if (words.allowance) {
    allowance_mm_ = control_.modal.mm(words.allowance.value);
    if (control_.contour.side() != Compensation::kOff && !code) {
      fail("unsupported-word", words.allowance.offset,
           "OFFN that changes while G41 or G42 is active is not supported", "write OFFN with G41 or G42");
    }
  }
  if (!code) return;
  if (*code == kG40) {
    nc::set_compensation(control_, Compensation::kOff, 0.0, control_.report.place.column);
    return;
  }
  check_contour_rules(0);
  const NcTool* tool = nc::active_tool(control_);
  if (tool == nullptr || !control_.tools.length_on) {
    control_.report.fail("compensation-no-tool", 0,
                         "cutter radius compensation has no tool: none is in the spindle, or D0",
                         "load a tool of the table and write D1");
  }
  const double radius = 0.5 * tool->diameter_mm + allowance_mm_;
  if (!(radius >= 0.0)) {
    fail("out-of-range", words.allowance ? words.allowance.offset : 0,
         fmt::format("OFFN {:g} mm takes more than the radius {:g} mm of the cutter", allowance_mm_,
                     0.5 * tool->diameter_mm),
         "compensate on the other side");
  }
  const bool left = (*code == kG41) != mirrored();
  nc::set_compensation(control_, left ? Compensation::kLeft : Compensation::kRight, radius,
                       control_.report.place.column);
}

Outcome Executor::end_words(const BlockWords& words) {
  for (const Amount& function : words.functions) {
    if (function.value == 2 || function.value == 30) return Outcome::kEnd;
    if (function.value == 17) return Outcome::kReturn;
  }
  if (words.ends_program) return Outcome::kReturn;
  return pattern_done_ ? Outcome::kPattern : Outcome::kNext;
}

}  // namespace swarf::program::nc::siemens
