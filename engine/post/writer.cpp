#include "post/writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/units.h"

namespace swarf::post {
namespace {

constexpr std::string_view kLetters = "XYZABC";

/// A cycle's rapid in front of it that would only move across is part of the next hole.
bool leads_to_hole(const PlannedStretch& planned, size_t i) {
  return i + 1 < planned.steps.size() && planned.steps[i].kind == StepKind::kRapid &&
         planned.steps[i + 1].kind == StepKind::kHole;
}

bool is_comment(const std::string& word) {
  constexpr std::array kWords{"PPRINT", "PARTNO", "REMARK", "MACHIN", "TOOL PATH", "TPRINT"};
  return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
}

/// What F says: `inverse`: inverse times are on; `linear`: X, Y or Z is written. Degrees alone have no unit.
double feed_value(const PostFormat& format, const PlanStep& step, bool inverse, bool linear) {
  const double minutes = std::max(step.duration_s, 1e-9) / 60.0;
  if (step.timed && inverse) return 1.0 / minutes;
  if (step.timed) {
    const bool rests = step.way_mm < 1e-9;
    const double way = format.feed_counts == FeedCounts::kAllAxes || rests
                           ? std::hypot(step.way_mm, step.turn_deg)
                           : step.way_mm;
    return way / minutes / (rests || !linear ? 1.0 : format.unit.feed_mm());
  }
  // With TCP the tip's feed means nothing while the tip stands.
  const bool rests = step.tcp && step.turns && step.tip_mm < 1e-9;
  return rests ? step.turn_deg / minutes : mm_min_from_mm_s(step.feed_mm_s) / format.unit.feed_mm();
}

/// In the program's unit.
std::string written_length(const PostFormat& format, double mm) {
  return written(format.numbers.linear, mm / format.unit.length_mm());
}

/// What a comment can hold of the text.
std::string fitting(const PostFormat& format, std::string_view text) {
  std::string kept;
  for (const char one : text) {
    const bool fits = one >= ' ' && one <= '~' && format.comment_without.find(one) == std::string::npos;
    if (fits && kept.size() < format.comment_longest) kept += one;
  }
  return kept;
}

}  // namespace

Writer::Writer(const PostFormat& format, const PlannerSetup& setup, const ProgramNames& names, Out out,
               Diagnostics& diagnostics)
    : format_(format),
      setup_(setup),
      names_(names),
      out_(std::move(out)),
      diagnostics_(diagnostics),
      block_(format.number_start) {
  for (const kinematics::Axis& axis : setup.machine.axes) has_.at(kLetters.find(axis.name.front())) = true;
  const int along = axis_along_tool(setup.machine);
  along_ = static_cast<int>(kLetters.find(setup.machine.axes[static_cast<size_t>(along)].name.front()));
}

void Writer::put_line(std::string_view text) {
  line_.clear();
  if (!format_.block_number.empty() && text != "%") {
    PlaceValues number;
    number.set(Place::kNumber, std::to_string(block_));
    std::vector<std::string> filled;
    format_.block_number.fill(number, filled);
    line_ = filled.front() + " ";
    block_ += format_.number_step;
  }
  line_ += text;
  line_ += '\n';
  out_(line_);
  ++summary_.blocks;
}

void Writer::put(const LineTemplate& lines) {
  lines_.clear();
  lines.fill(values_, lines_);
  for (const std::string& one : lines_) put_line(one);
}

void Writer::motion(const LineTemplate& lines) {
  lines_.clear();
  const bool holds =
      format_.motion.modal && !lines.first_word().empty() && lines.first_word() == motion_word_;
  if (holds)
    lines.fill_without_first(values_, lines_);
  else
    lines.fill(values_, lines_);
  for (const std::string& one : lines_) put_line(one);
  if (!lines_.empty()) motion_word_ = lines.first_word();
}

void Writer::comment(std::string_view text) {
  const std::string kept = fitting(format_, text);
  if (kept.size() != text.size()) ++summary_.comments_changed;
  if (kept.empty() || format_.comment.empty()) return;
  values_.set(Place::kText, kept);
  put(format_.comment);
}

void Writer::not_written(const std::string& word) {
  std::vector<std::string>& words = summary_.not_written;
  if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
}

void Writer::set_coolant(const std::string& word) {
  if (word == coolant_) return;
  const bool was_on = !coolant_.empty() && coolant_ != format_.coolant_off;
  if (!word.empty() && (was_on || word != format_.coolant_off)) {
    end_cycle();
    put_line(word);
  }
  coolant_ = word;
}

void Writer::coolant(const std::string& text) {
  if (text != "OFF" && text != "MIST" && text != "ON" && text != "FLOOD") {
    not_written("COOLNT/" + text);
    return;
  }
  if ((text == "OFF" ? format_.coolant_off : text == "MIST" ? format_.mist : format_.flood).empty())
    not_written("COOLNT/" + text);
  coolant_wanted_ = text == "OFF" ? format_.coolant_off : text == "MIST" ? format_.mist : format_.flood;
  // It is switched on with the new tool over the work.
  if (!change_comes_) set_coolant(coolant_wanted_);
}

void Writer::note(const program::ClNote& note) {
  const auto stop = [&](const std::string& word) {
    end_cycle();
    if (word.empty()) return not_written(note.word);
    put_line(word);
  };
  if (note.word == "COOLNT") {
    coolant(note.text);
  } else if (note.word == "STOP") {
    stop(format_.stop);
  } else if (note.word == "OPSTOP") {
    stop(format_.optional_stop);
  } else if (note.word == "INSERT") {
    end_cycle();
    put_line(note.text);
    diagnostics_.warning("insert-as-written", {names_.source, note.line, 0},
                         fmt::format("INSERT stands in the program as it is: {}", note.text),
                         "what it does to the axes and to modal words is not known here");
    forget_words();
  } else if (is_comment(note.word)) {
    comment(note.text);
  } else {
    not_written(note.word);
  }
}

/// X Y Z, and the rotary words outside of tilted planes, in which the axes stand where the plane has them.
Writer::Words Writer::words_of(const PlanStep& step) const {
  Words words;
  for (size_t i = 0; i < (step.tilt ? 3U : 6U); ++i) {
    if (!has_.at(i)) continue;
    words.at(i) =
        kLetters[i] + (i < 3 ? written_length(format_, step.p[static_cast<long>(i)])
                             : written(format_.numbers.rotary, deg_from_rad(step.rotary.at(i - 3))));
  }
  return words;
}

std::string Writer::changed(const Words& words, bool all) {
  std::string text;
  for (size_t i = 0; i < 6; ++i) {
    if (words.at(i).empty() || (!all && words.at(i) == words_.at(i))) continue;
    if (!text.empty()) text += ' ';
    text += words.at(i);
    words_.at(i) = words.at(i);
    if (i < 3) p_[static_cast<long>(i)] = std::strtod(words.at(i).c_str() + 1, nullptr);
  }
  return text;
}

void Writer::forget_words() {
  for (std::string& one : words_) one.clear();
  feed_.clear();
  motion_word_.clear();
}

void Writer::set_tcp(bool on) {
  if (tcp_ == on) return;
  if (on) set_tilt(nullptr);
  end_cycle();
  put(on ? format_.tcp_on : format_.tcp_off);
  tcp_ = on;
  forget_words();
}

void Writer::set_tilt(const std::shared_ptr<const TiltedPlane>& tilt) {
  if (tilt == tilt_) return;
  end_cycle();
  set_tcp(false);
  if (tilt_) put(format_.tilted_plane.off);
  tilt_ = tilt;
  forget_words();
  if (!tilt) return;
  set_timed(false);
  constexpr std::array kTurns{Place::kTurn1, Place::kTurn2, Place::kTurn3};
  for (size_t i = 0; i < kTurns.size(); ++i)
    values_.set(kTurns.at(i), written(format_.numbers.rotary, tilt->turns_deg.at(i)));
  values_.set(Place::kSide, tilt->positive ? format_.tilted_plane.positive : format_.tilted_plane.negative);
  put(format_.tilted_plane.on);
}

void Writer::set_plane(int plane) {
  if (plane == plane_) return;
  plane_ = plane;
  if (format_.motion.plane_words) put_line(format_.motion.plane.at(static_cast<size_t>(plane)));
}

void Writer::set_timed(bool timed) {
  if (format_.inverse_time.empty() || timed == timed_) return;
  put_line(timed ? format_.inverse_time : format_.per_minute);
  timed_ = timed;
  feed_.clear();
}

void Writer::spindle(double rpm) {
  if (rpm == spindle_) return;
  end_cycle();
  values_.set(Place::kS, written(format_.numbers.speed, std::abs(rpm)));
  const LineTemplate& lines = rpm == 0.0  ? format_.spindle_stop
                              : rpm > 0.0 ? format_.clockwise
                                          : format_.counter_clockwise;
  if (lines.empty()) not_written("SPINDL");
  put(lines);
  spindle_ = rpm;
}

void Writer::dwell(double seconds) {
  if (seconds <= 0.0) return;
  end_cycle();
  if (format_.dwell.empty()) not_written("DELAY");
  values_.set(Place::kSeconds, written(format_.numbers.time, seconds));
  put(format_.dwell);
}

void Writer::change_tool(const PlanStep& step) {
  if (step.tool == tool_) return;
  tool_ = step.tool;
  if (step.tool < 0) {
    diagnostics_.error("tool-not-loaded", {names_.source, step.line, 0},
                       "the CL data moves without a tool: the program could not call its length",
                       "write LOADTL/1 before it");
    return;
  }
  const PostTool& tool = setup_.tools[static_cast<size_t>(step.tool)];
  values_.set(Place::kT, tool.number > 0 ? std::to_string(tool.number) : "");
  values_.set(Place::kName, tool.name);
  values_.set(Place::kS, written(format_.numbers.speed, std::abs(step.spindle_rpm)));
  put(format_.length_off);
  if (tool.number <= 0 && format_.change_by_name.empty()) {
    diagnostics_.error(
        "tool-number", {names_.source, step.line, 0},
        fmt::format("tool {} has no number, and {} calls tools by number", tool.name, format_.name),
        "give it one: LOADTL/1 in the CL data, or a number in --tools");
  }
  put(tool.number > 0 ? format_.change : format_.change_by_name);
  spindle_ = 0.0;
}

void Writer::approach(const PlanStep& step) {
  end_cycle();
  set_tilt(nullptr);
  set_tcp(false);
  set_plane(0);
  const char letter = kLetters[static_cast<size_t>(along_)];
  values_.set(Place::kHomeAlong, letter + written_length(format_, retracted(setup_.machine)));
  put(format_.retract);
  if (step.tool != tool_) set_coolant(format_.coolant_off);
  change_tool(step);
  spindle(step.spindle_rpm);
  forget_words();
  PlanStep by_axes = step;
  by_axes.p = step.axes_p;
  const Words words = words_of(by_axes);
  std::array<std::string, 3> group;  // rotary axes, across, along
  for (size_t i = 0; i < 6; ++i) {
    std::string& to = group.at(i > 2 ? 0 : static_cast<int>(i) == along_ ? 2 : 1);
    if (!words.at(i).empty()) to += (to.empty() ? "" : " ") + words.at(i);
  }
  values_.set(Place::kRotaries, group[0]);
  values_.set(Place::kAcross, group[1]);
  values_.set(Place::kAlong, group[2]);
  put(format_.approach);
  put(format_.length_on);
  changed(words, true);
  set_coolant(coolant_wanted_);
  set_tcp(step.tcp);
  if (!step.tcp) return;
  values_.set(Place::kAxes, changed(words_of(step), true));
  motion(format_.motion.rapid);
}

void Writer::feed_word(const PlanStep& step) {
  const bool linear = values_.of(Place::kAxes).find_first_of("XYZ") != std::string::npos;
  const double value = feed_value(format_, step, timed_, linear);
  std::string text = "F";
  text += written(timed_ ? format_.numbers.inverse_time : format_.numbers.feed, value);
  if (std::strtod(text.c_str() + 1, nullptr) == 0.0) {
    diagnostics_.error("feed-below-digits", {names_.source, step.line, 0},
                       fmt::format("the feed {:g} would be written as {}", value, text),
                       "write more digits: [numbers.feed] or [numbers.inverse_time] decimals of the post");
  }
  values_.set(Place::kF, text == feed_ && !timed_ ? "" : text);
  feed_ = text;
}

void Writer::arc_words(const PlanStep& step) {
  constexpr std::array<std::array<size_t, 2>, 3> kAxes{{{0, 1}, {2, 0}, {1, 2}}};
  const auto [a, b] = kAxes.at(static_cast<size_t>(step.plane));
  std::string centre, point;
  for (const size_t i : {std::min(a, b), std::max(a, b)}) {
    const double value = step.centre[static_cast<long>(i)] / format_.unit.length_mm();
    centre += fmt::format("{}{}{}", centre.empty() ? "" : " ", "IJK"[i],
                          written(format_.numbers.linear, value - p_[static_cast<long>(i)]));
    point +=
        fmt::format("{}{}{}", point.empty() ? "" : " ", kLetters[i], written(format_.numbers.linear, value));
    words_.at(i).clear();  // both coordinates of the end are written
  }
  values_.set(Place::kCentre, centre);
  values_.set(Place::kCentrePoint, point);
}

void Writer::move(const PlanStep& step) {
  spindle(step.spindle_rpm);
  dwell(step.dwell_s);
  // Where a cycle is called it may stay; where its word is modal a rapid would drill.
  if (format_.cycle.call.empty()) end_cycle();
  set_tcp(step.tcp);
  set_tilt(step.tilt);
  if (step.kind == StepKind::kRapid) {
    values_.set(Place::kAxes, changed(words_of(step), false));
    return motion(format_.motion.rapid);
  }
  end_cycle();
  set_timed(step.timed);
  const bool arc = step.kind == StepKind::kArc;
  if (arc) {
    set_plane(step.plane);
    arc_words(step);
  }
  values_.set(Place::kAxes, changed(words_of(step), false));
  if (values_.of(Place::kAxes).empty()) return;
  feed_word(step);
  motion(!arc             ? format_.motion.line
         : step.clockwise ? format_.motion.clockwise
                          : format_.motion.counter_clockwise);
}

void Writer::head() {
  values_.set(Place::kProgram, names_.program);
  values_.set(Place::kMachine, fitting(format_, names_.machine));
  values_.set(Place::kSource, names_.source);
  values_.set(Place::kUnit, format_.unit.inches ? format_.unit.inch : format_.unit.mm);
  put(format_.head);
}

void Writer::stretch(const PlannedStretch& planned) {
  size_t next = 0;
  const auto notes = [&](size_t step) {
    for (; next < planned.notes.size() && planned.notes[next].before <= step; ++next)
      note(planned.notes[next].note);
  };
  for (size_t i = 0; i < planned.steps.size(); ++i) {
    const PlanStep& step = planned.steps[i];
    change_comes_ = step.kind == StepKind::kApproach && step.tool != tool_;
    notes(i);
    if (leads_to_hole(planned, i)) {
      const PlanStep& cycle = planned.steps[i + 1];
      if (merges_with(step, cycle, planned.holes[static_cast<size_t>(cycle.hole)])) {
        values_.set(Place::kAxes, changed(words_of(step), false));
        put(format_.cycle.next);
        put(format_.cycle.call);
        changed(words_of(cycle), false);
        notes(++i);
        continue;
      }
    }
    if (step.kind == StepKind::kApproach)
      approach(step);
    else if (step.kind == StepKind::kHole)
      hole(step, planned.holes[static_cast<size_t>(step.hole)]);
    else
      move(step);
  }
  change_comes_ = false;
  notes(planned.steps.size());
}

void Writer::tail() {
  end_cycle();
  set_tilt(nullptr);
  set_tcp(false);
  set_timed(false);
  set_plane(0);
  const char letter = kLetters[static_cast<size_t>(along_)];
  values_.set(Place::kHomeAlong, letter + written_length(format_, retracted(setup_.machine)));
  put(format_.retract);
  spindle(0.0);
  set_coolant(format_.coolant_off);
  put(format_.tail);
}

}  // namespace swarf::post
