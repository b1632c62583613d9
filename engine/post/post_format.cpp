#include "post/post_format.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/config.h"
#include "program/dialects.h"

namespace swarf::post {

namespace {

using P = Place;

const std::vector<Place> kNone{}, kNumbered{P::kNumber}, kCommented{P::kText},
    kHead{P::kMachine, P::kSource, P::kProgram, P::kUnit}, kTool{P::kT, P::kName, P::kS},
    kRetractTo{P::kHomeAlong, P::kT}, kApproach{P::kRotaries, P::kAcross, P::kAlong, P::kT},
    kSpindle{P::kS, P::kT}, kDwells{P::kSeconds}, kRapid{P::kAxes}, kLine{P::kAxes, P::kF},
    kArc{P::kAxes, P::kF, P::kCentre, P::kCentrePoint}, kTcp{P::kT, P::kAxes},
    kTilt{P::kTurn1, P::kTurn2, P::kTurn3, P::kSide, P::kT}, kNext{P::kAxes, P::kAcross},
    kCycle{P::kAxes,  P::kF,         P::kBottom,          P::kClear, P::kSurface,   P::kRetract, P::kReturn,
           P::kDepth, P::kClearance, P::kSecondClearance, P::kStep,  P::kStepFirst, P::kDwell,   P::kFeed,
           P::kPitch, P::kS};

std::string listed(const std::vector<Place>& places) {
  std::string text;
  for (const Place one : places)
    text += fmt::format("{}{{{}}}", text.empty() ? "" : " ", place_names()[static_cast<size_t>(one)]);
  return text.empty() ? "no place" : text;
}

LineTemplate lines(ConfigTable& table, const std::string& key, const std::vector<Place>& places) {
  std::string bad;
  LineTemplate read(table.text(key, ""), places, bad);
  if (bad.empty()) return read;
  std::vector<std::string> names;
  for (const Place one : places) names.emplace_back(place_names()[static_cast<size_t>(one)]);
  const std::string near = nearest_name(bad, names);
  table.error(
      "unknown-place", key, fmt::format("{} has no place {{{}}}", key, bad),
      (near.empty() ? "" : fmt::format("did you mean {{{}}}? ", near)) + "it may hold " + listed(places));
  return {};
}

NumberFormat number_format(ConfigTable& numbers, const std::string& key, int decimals) {
  ConfigTable table = numbers.table(key);
  NumberFormat format;
  format.decimals = table.integer("decimals", 0, 9, decimals);
  format.point = table.boolean("point", true);
  format.zeros = table.boolean("zeros", false);
  format.plus = table.boolean("plus", false);
  return format;
}

void read_numbers(ConfigTable numbers, NumberFormats& to) {
  to.linear = number_format(numbers, "linear", 3);
  to.rotary = number_format(numbers, "rotary", 3);
  to.feed = number_format(numbers, "feed", 1);
  to.inverse_time = number_format(numbers, "inverse_time", 4);
  to.speed = number_format(numbers, "speed", 0);
  to.time = number_format(numbers, "time", 3);
}

void read_blocks(ConfigTable blocks, PostFormat& post) {
  post.block_number = lines(blocks, "number", kNumbered);
  post.number_start = blocks.integer("start", 0, 1'000'000, 10);
  post.number_step = blocks.integer("step", 1, 1000, 10);
}

void read_comment(ConfigTable comment, PostFormat& post) {
  post.comment = lines(comment, "line", kCommented);
  post.comment_without = comment.text("without", "");
  post.comment_longest = static_cast<size_t>(comment.integer("longest", 8, 1000, 60));
}

void read_tool(ConfigTable tool, PostFormat& post) {
  post.retract = lines(tool, "retract", kRetractTo);
  post.change = lines(tool, "change", kTool);
  post.change_by_name = lines(tool, "change_by_name", kTool);
  post.approach = lines(tool, "approach", kApproach);
  post.length_on = lines(tool, "length_on", kApproach);
  post.length_off = lines(tool, "length_off", kNone);
}

void read_machine_words(ConfigTable& table, PostFormat& post) {
  ConfigTable spindle = table.table("spindle");
  post.clockwise = lines(spindle, "clockwise", kSpindle);
  post.counter_clockwise = lines(spindle, "counter_clockwise", kSpindle);
  post.spindle_stop = lines(spindle, "stop", kSpindle);
  ConfigTable coolant = table.table("coolant");
  post.flood = coolant.text("flood", "");
  post.mist = coolant.text("mist", "");
  post.coolant_off = coolant.text("off", "");
  ConfigTable words = table.table("words");
  post.dwell = lines(words, "dwell", kDwells);
  post.stop = words.text("stop", "");
  post.optional_stop = words.text("optional_stop", "");
}

void read_motion(ConfigTable motion, MotionWords& to) {
  to.modal = motion.boolean("modal", true);
  to.rapid = lines(motion, "rapid", kRapid);
  to.line = lines(motion, "line", kLine);
  to.clockwise = lines(motion, "clockwise", kArc);
  to.counter_clockwise = lines(motion, "counter_clockwise", kArc);
  to.plane = {motion.text("plane_xy", ""), motion.text("plane_zx", ""), motion.text("plane_yz", "")};
  to.plane_words = motion.boolean("plane_words", true);
  to.helix = motion.boolean("helix", true);
  for (const auto& [key, line] : {std::pair{"rapid", &to.rapid}, std::pair{"line", &to.line}}) {
    if (line->uses(Place::kAxes)) continue;
    motion.error("missing-place", key, fmt::format("{} does not say where to go", key),
                 fmt::format("write {{axes}} in it: {} = \"G1 {{axes}} {{F}}\"", key));
  }
}

void read_feed_and_tcp(ConfigTable& table, PostFormat& post) {
  ConfigTable feed = table.table("feed");
  post.per_minute = feed.text("per_minute", "");
  post.inverse_time = feed.text("inverse_time", "");
  const bool all = feed.choice("counts", {"all_axes", "linear_first"}, "all_axes") == "all_axes";
  post.feed_counts = all ? FeedCounts::kAllAxes : FeedCounts::kLinearFirst;
  ConfigTable tcp = table.table("tcp");
  post.tcp_on = lines(tcp, "on", kTcp);
  post.tcp_off = lines(tcp, "off", kTcp);
  post.tcp_by_default = tcp.boolean("by_default", false);
  post.tcp_arcs = tcp.boolean("arcs", true);
  post.tcp_warning = tcp.text("warning", "");
}

void read_cycles(ConfigTable cycle, CycleWords& to) {
  to.drill = lines(cycle, "drill", kCycle);
  to.drill_dwell = lines(cycle, "drill_dwell", kCycle);
  to.deep = lines(cycle, "deep", kCycle);
  to.chip_break = lines(cycle, "chip_break", kCycle);
  to.bore = lines(cycle, "bore", kCycle);
  to.bore_dwell = lines(cycle, "bore_dwell", kCycle);
  to.tap = lines(cycle, "tap", kCycle);
  to.next = lines(cycle, "next", kNext);
  to.call = lines(cycle, "call", kNone);
  to.end = cycle.text("end", "");
  to.return_start = cycle.text("return_start", "");
  to.return_clear = cycle.text("return_clear", "");
  to.dwell_in_ms = cycle.boolean("dwell_in_ms", false);
}

void read_unit(ConfigTable output, OutputUnit& to) {
  to.inches = output.choice("unit", {"mm", "inch"}, "mm") == "inch";
  to.mm = output.text("mm", "");
  to.inch = output.text("inch", "");
  to.feed_per_inch = output.integer("feed_per_inch", 1, 1000, 1);
}

void read_planes(ConfigTable plane, PlaneWords& to) {
  to.on = lines(plane, "on", kTilt);
  to.off = lines(plane, "off", kTool);
  to.use = plane_use(plane.choice("use", {"never", "cycles", "constant"}, "cycles"));
  to.turns = plane.choice("turns", {"zxz", "zyx"}, "zxz") == "zxz" ? PlaneTurns::kZXZ : PlaneTurns::kZYX;
  to.positive = plane.text("positive", "");
  to.negative = plane.text("negative", "");
  for (const Place place : {P::kTurn1, P::kTurn2, P::kTurn3}) {
    if (to.on.empty() || to.on.uses(place)) continue;
    const char* name = place_names()[static_cast<size_t>(place)];
    plane.error("missing-place", "on", fmt::format("on does not say the turn {{{}}}", name),
                "write all three: on = \"G68.2 X0 Y0 Z0 I{turn_1} J{turn_2} K{turn_3}\"");
  }
}

}  // namespace

PlaneUse plane_use(std::string_view name) {
  return name == "never" ? PlaneUse::kNever : name == "cycles" ? PlaneUse::kCycles : PlaneUse::kConstant;
}

PostFormat in_unit(PostFormat format, bool inches) {
  if (format.unit.inches == inches) return format;
  if (format.unit.inch.empty() || format.unit.mm.empty() || !format.head.uses(Place::kUnit))
    throw InputError("no-unit-words", {format.file},
                     fmt::format("{} does not say how a program names its unit", format.name),
                     "write [output] mm = \"G21\" and inch = \"G20\", and {unit} in the head of [program]");
  format.unit.inches = inches;
  for (NumberFormat* const one : {&format.numbers.linear, &format.numbers.feed})
    one->decimals = std::clamp(one->decimals + (inches ? 1 : -1), 0, 9);
  return format;
}

double half_digit_mm(const PostFormat& format) {
  return format.unit.length_mm() * half_digit(format.numbers.linear);
}

/// What would leave an axis where it is, or a mode on.
void check_whole(ConfigTable& table, const PostFormat& post) {
  const auto demand = [&](bool right, const char* key, const std::string& text, const char* fix) {
    if (!right) table.error("incomplete-post", key, text, fix);
  };
  for (const Place place : {Place::kRotaries, Place::kAcross, Place::kAlong}) {
    demand(post.approach.uses(place) || post.length_on.uses(place), "tool",
           fmt::format("neither approach nor length_on has {{{}}}: these axes would not be sent to the work",
                       place_names()[static_cast<size_t>(place)]),
           "write approach = \"G0 {rotaries}\\nG0 {across}\" and length_on = \"G43 {along} H{T}\"");
  }
  demand(post.inverse_time.empty() || !post.per_minute.empty(), "feed",
         "inverse_time has a word, and nothing ends it", "write per_minute = \"G94\"");
  demand(post.tcp_on.empty() == post.tcp_off.empty(), "tcp", "on and off belong together",
         "write both, or neither");
  demand(post.tilted_plane.on.empty() == post.tilted_plane.off.empty(), "tilted_plane",
         "on and off belong together", "write both, or neither");
  for (const LineTemplate* arc : {&post.motion.clockwise, &post.motion.counter_clockwise}) {
    const bool whole =
        arc->uses(Place::kAxes) && (arc->uses(Place::kCentre) || arc->uses(Place::kCentrePoint));
    demand(arc->empty() || whole, "motion", "an arc does not say its end and its centre",
           "write {axes} and {centre}, or {centre_point}");
  }
}

PostFormat load_post(const std::string& file) {
  Diagnostics diagnostics;
  ConfigTable table = ConfigTable::load(file, {}, diagnostics);
  diagnostics.throw_if_errors();
  PostFormat post;
  post.file = file;
  post.name = table.text("name");
  if (table.has("prefer"))
    post.prefer = preference(table.choice("prefer", {"time", "accuracy", "travel"}, "time"));
  const std::string dialect = table.text("dialect");
  if (const auto found = program::dialect_of(dialect))
    post.dialect = *found;
  else if (!dialect.empty())
    table.error("unknown-dialect", "dialect", fmt::format("'{}' is no dialect", dialect),
                "choose " + program::dialect_list(" or "));
  read_numbers(table.table("numbers"), post.numbers);
  read_unit(table.table("output"), post.unit);
  read_blocks(table.table("blocks"), post);
  read_comment(table.table("comment"), post);
  ConfigTable program = table.table("program");
  post.head = lines(program, "head", kHead);
  post.tail = lines(program, "tail", kHead);
  read_tool(table.table("tool"), post);
  read_machine_words(table, post);
  read_motion(table.table("motion"), post.motion);
  read_feed_and_tcp(table, post);
  read_cycles(table.table("cycle"), post.cycle);
  read_planes(table.table("tilted_plane"), post.tilted_plane);
  check_whole(table, post);
  table.finish();
  diagnostics.throw_if_errors();
  return post;
}

}  // namespace swarf::post
