// Point patterns: PATTERN DEF with CYCL CALL PAT, cycles 220 (circle) and 221 (rows).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/angles.h"
#include "base/units.h"
#include "program/heidenhain/steps.h"
#include "program/letters/arithmetic.h"

namespace swarf::program::nc::heidenhain {

using nc::Motion;

namespace {

constexpr int kPointsMax = 100'000;

/// A way in the plane, mm; exact at multiples of 90 degrees.
Vec2 polar_step(double radius, double angle_deg) {
  return {radius * cos_deg(angle_deg), radius * sin_deg(angle_deg)};
}

struct PatternKind {
  std::string_view name;
  std::vector<std::string_view> needed, more;
};

const std::vector<PatternKind>& kinds() {
  static const std::vector<PatternKind> all{
      {"POS", {"X", "Y"}, {"Z"}},
      {"ROW", {"X", "Y", "D", "NUM"}, {"ROT", "Z"}},
      {"PAT", {"X", "Y", "DX", "DY", "NUMX", "NUMY"}, {"ROT", "ROTX", "ROTY", "Z"}},
      {"FRAME", {"X", "Y", "DX", "DY", "NUMX", "NUMY"}, {"ROT", "ROTX", "ROTY", "Z"}},
      {"CIRC", {"X", "Y", "D", "START", "NUM"}, {"Z"}},
      {"PITCHCIRC", {"X", "Y", "D", "START", "STEP", "NUM"}, {"Z"}}};
  return all;
}

/// The words of one pattern, between its brackets.
class Items {
 public:
  Items(BlockReader& reader, const PatternKind& kind, size_t start) : reader_(reader), start_(start) {
    if (!reader.take_char('('))
      reader.fail("missing-word", reader.offset(), fmt::format("'(' is missing behind {}", kind.name),
                  "POS1 (X+25 Y+33.5 Z+0)");
    while (!reader.take_char(')')) {
      reader.done();
      const size_t at = reader.offset();
      const std::string word(reader.take_letters());
      const auto in = [&](const std::vector<std::string_view>& list) {
        return std::find(list.begin(), list.end(), word) != list.end();
      };
      if (!in(kind.needed) && !in(kind.more))
        reader.fail("unexpected-word", at,
                    fmt::format("{} is no word of {}", word.empty() ? std::string(1, reader.peek()) : word,
                                kind.name),
                    "take it out, or close the bracket");
      if (!values_.emplace(word, reader.value()).second)
        reader.fail("word-twice", at, fmt::format("{} stands twice in this pattern", word),
                    "keep one of them");
    }
    for (const std::string_view word : kind.needed) {
      if (values_.count(std::string(word)) == 0)
        reader.fail("missing-word", start, fmt::format("{} has no {}", kind.name, word),
                    fmt::format("{}+0", word));
    }
  }
  double operator[](const std::string& word) const {
    const auto found = values_.find(word);
    return found == values_.end() ? 0.0 : found->second;
  }
  int count(const std::string& word) const {
    const double number = (*this)[word];
    if (!(number >= 1.0 && number <= kPointsMax) || number != std::floor(number))
      reader_.fail("out-of-range", start_, fmt::format("{} is {:g}", word, number),
                   fmt::format("a whole number from 1 to {}", kPointsMax));
    return static_cast<int>(number);
  }

 private:
  BlockReader& reader_;
  size_t start_;
  std::map<std::string, double> values_;
};

void add_points(std::vector<PatternPoint>& points, const PatternPoint& point, BlockReader& reader,
                size_t start) {
  if (points.size() >= kPointsMax)
    reader.fail("out-of-range", start, fmt::format("this pattern has more than {} points", kPointsMax),
                "correct the numbers of points");
  points.push_back(point);
}

/// Rows of points from `first`, the second one backwards and so on.
void add_rows(std::vector<PatternPoint>& points, const Rows& rows, BlockReader& reader, size_t start) {
  for (int j = 0; j < rows.lines; ++j) {
    for (int n = 0; n < rows.columns; ++n) {
      const int i = j % 2 == 0 ? n : rows.columns - 1 - n;
      const bool edge = i == 0 || j == 0 || i == rows.columns - 1 || j == rows.lines - 1;
      if (rows.frame && !edge) continue;
      add_points(points, {rows.first + i * rows.column_step + j * rows.line_step, rows.height}, reader,
                 start);
    }
  }
}

/// To a point of the working plane, at the present height.
void go_to_point(nc::Control& control, Frames& frames, Motion motion, double feed, const Vec2& point) {
  const nc::PlaneAxes axes = nc::axes_of(control.modal.plane);
  Vec3 to = nc::position_xyz(control);
  to[axes.first] = frames.stretch.along(axes.first, point.x(), false);
  to[axes.second] = frames.stretch.along(axes.second, point.y(), false);
  straight(control, motion, feed, to);
}

}  // namespace

/// PATTERN DEF POS1 (X+25 Y+33.5 Z+0) ~ ROW1 (..) ~ PAT1 (..) ~ FRAME1 (..) ~ CIRC1 (..) ~ PITCHCIRC1 (..)
void pattern_definition(nc::Control& control, Drilling& drilling, BlockReader& reader, size_t start) {
  if (!reader.take("DEF"))
    reader.fail("missing-word", start, "PATTERN without DEF", "PATTERN DEF POS1 (X+25 Y+33 Z+0)");
  std::vector<PatternPoint> points;
  while (!reader.done()) {
    const size_t at = reader.offset();
    const std::string name(reader.take_letters());
    const auto kind = std::find_if(kinds().begin(), kinds().end(),
                                   [&](const PatternKind& one) { return one.name == name; });
    if (kind == kinds().end())
      reader.fail("unknown-word", at,
                  fmt::format("{} is no pattern", name.empty() ? std::string(1, reader.peek()) : name),
                  "POS, ROW, PAT, FRAME, CIRC or PITCHCIRC");
    reader.whole_number(999);
    const Items items(reader, *kind, at);
    const double unit = control.modal.mm(1.0), height = unit * items["Z"];
    const Vec2 first = unit * Vec2(items["X"], items["Y"]);
    if (name == "POS") {
      add_points(points, {first, height}, reader, at);
    } else if (name == "ROW") {
      const Vec2 step = polar_step(unit * items["D"], items["ROT"]);
      add_rows(points, {first, step, Vec2::Zero(), items.count("NUM"), 1, height, false}, reader, at);
    } else if (name == "PAT" || name == "FRAME") {
      const Vec2 x = polar_step(unit * items["DX"], items["ROT"] + items["ROTX"]);
      const Vec2 y = polar_step(unit * items["DY"], items["ROT"] + items["ROTY"] + 90.0);
      add_rows(points, {first, x, y, items.count("NUMX"), items.count("NUMY"), height, name == "FRAME"},
               reader, at);
    } else {
      const int number = items.count("NUM");
      const double step = name == "CIRC" ? 360.0 / number : items["STEP"];
      for (int i = 0; i < number; ++i) {
        const Vec2 out = polar_step(0.5 * unit * items["D"], items["START"] + i * step);
        add_points(points, {first + out, height}, reader, at);
      }
    }
  }
  if (points.empty())
    reader.fail("missing-word", start, "PATTERN DEF has no points", "PATTERN DEF POS1 (X+25 Y+33.5 Z+0)");
  drilling.pattern = points;
}

/// CYCL CALL PAT FMAX: the cycle at each point; between them at the height of the call or the second set-up
/// clearance, whichever is higher.
void call_pattern(Executor& executor, BlockReader& reader, Motion motion, double feed, size_t offset) {
  if (executor.drilling.pattern.empty())
    reader.fail("no-pattern", offset, "no PATTERN DEF stands before CYCL CALL PAT",
                "PATTERN DEF POS1 (X+25 Y+33.5 Z+0)");
  if (!executor.drilling.cycle || executor.drilling.cycle->number < 200)
    reader.fail("no-cycle", offset, "CYCL CALL PAT without a cycle from 200 on before it",
                "write CYCL DEF before it");
  if (!executor.control.path.started)
    reader.fail("start-unknown", offset, "a cycle starts, and the position is not known yet",
                "position all axes before it");
  const nc::Place place = reader.place_of(offset);
  executor.control.report.at(place.file, place.line, place.column);
  const int normal = nc::axes_of(executor.control.modal.plane).normal;
  const double called_at = nc::position_xyz(executor.control)[normal];
  for (const PatternPoint& point : executor.drilling.pattern) {
    executor.drilling.raised = point.height;
    const double height =
        std::max(called_at, cycle_surface(executor.control, executor.drilling, executor.frames) +
                                length(executor, Q::kSecondClearance));
    if (nc::position_xyz(executor.control)[normal] != height)
      go(executor.control, Motion::kRapid, height, 0.0);
    go_to_point(executor.control, executor.frames, motion, feed, point.at);
    execute_cycle(executor);
  }
  executor.drilling.raised = 0.0;
}

/// 220, 221: the last cycle at each point, when they are defined. Their Q200, Q203 and Q204 hold for it.
void pattern_cycle(Executor& executor, BlockReader& reader, const Cycle& pattern) {
  const auto given = [&](int number) {
    const auto found = pattern.q.find(number);
    return found == pattern.q.end() ? 0.0 : found->second;
  };
  const auto count = [&](int number) {
    const double value = given(number);
    if (!(value >= 1.0 && value <= kPointsMax) || value != std::floor(value))
      reader.fail("out-of-range", pattern.offset, fmt::format("Q{} is {:g}", number, value),
                  fmt::format("a whole number from 1 to {}", kPointsMax));
    return static_cast<int>(value);
  };
  if (!executor.drilling.cycle || executor.drilling.cycle->number < 200)
    reader.fail(
        "no-cycle", pattern.offset,
        fmt::format("cycle {} repeats the cycle before it, and there is none from 200 on", pattern.number),
        "define the drilling cycle before it");
  if (!executor.control.path.started)
    reader.fail("start-unknown", pattern.offset, "a cycle starts, and the position is not known yet",
                "position all axes before it");
  std::vector<PatternPoint> points;
  if (pattern.number == 220) {
    if (given(365) != 0.0)
      reader.fail("unsupported-word", pattern.offset,
                  "ways along the pitch circle (Q365=1) are not supported", "Q365=0");
    const int number = count(241);
    const Vec2 centre(executor.control.modal.mm(given(216)), executor.control.modal.mm(given(217)));
    const double range = given(246) - given(245);
    // Without a step, the points share the angle out; a whole circle has no second point at its end.
    const bool whole = std::abs(std::remainder(range, 360.0)) < 1e-9;
    const double shared = number < 2 ? 0.0 : whole ? range / number : range / (number - 1);
    const double step = given(247) != 0.0 ? given(247) : shared;
    for (int i = 0; i < number; ++i)
      add_points(
          points,
          {centre + polar_step(0.5 * executor.control.modal.mm(given(244)), given(245) + i * step), 0.0},
          reader, pattern.offset);
  } else {
    const Vec2 first(executor.control.modal.mm(given(225)), executor.control.modal.mm(given(226)));
    const Vec2 column = polar_step(executor.control.modal.mm(given(237)), given(224)),
               line = polar_step(executor.control.modal.mm(given(238)), given(224) + 90.0);
    add_rows(points, {first, column, line, count(242), count(243), 0.0, false}, reader, pattern.offset);
  }
  for (const int shared : {200, 203, 204}) {
    const auto found = pattern.q.find(shared);
    if (found != pattern.q.end()) executor.drilling.cycle->q[shared] = found->second;
  }
  const nc::Place place = reader.place_of(pattern.offset);
  executor.control.report.at(place.file, place.line, place.column);
  const double second = q(executor.drilling, Q::kSecondClearance);
  go(executor.control, Motion::kRapid,
     cycle_surface(executor.control, executor.drilling, executor.frames) +
         std::max(length(executor, Q::kClearance), length(executor, Q::kSecondClearance)),
     0.0);
  for (size_t i = 0; i < points.size(); ++i) {
    go_to_point(executor.control, executor.frames, Motion::kRapid, 0.0, points[i].at);
    // Q301 = 0: between the points at the set-up clearance alone.
    const bool low = given(301) == 0.0 && i + 1 < points.size();
    executor.drilling.cycle->q[Q::kSecondClearance] = low ? 0.0 : second;
    execute_cycle(executor);
  }
  executor.drilling.cycle->q[Q::kSecondClearance] = second;
}

}  // namespace swarf::program::nc::heidenhain
