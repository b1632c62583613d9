#include "sim/job/tool_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "base/units.h"

namespace swarf::sim {
namespace {

using cutter::Cutter;
using cutter::Shape;

constexpr double kInch = 25.4;
constexpr double kTwistDrill = 118.0;    // deg
constexpr double kLargestTool = 1000.0;  // mm

struct ShapeWord {
  const char* word;
  Shape shape;
};
constexpr std::array<ShapeWord, 5> kShapeWords{{{"flat", Shape::kFlat},
                                                {"ball", Shape::kBall},
                                                {"bull", Shape::kBullNose},
                                                {"drill", Shape::kDrill},
                                                {"chamfer", Shape::kChamfer}}};

std::string lower(std::string_view text) {
  std::string low(text);
  std::transform(low.begin(), low.end(), low.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return low;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// Takes a number off the front; none where there is none.
std::optional<double> take_number(std::string_view& text) {
  double value = 0.0;
  const auto [next, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || !std::isfinite(value)) return std::nullopt;
  text.remove_prefix(static_cast<size_t>(next - text.data()));
  return value;
}

bool take_word(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

/// A length in mm; "in" or "mm" may follow it.
std::optional<double> take_length(std::string_view& text) {
  const std::optional<double> number = take_number(text);
  if (!number) return std::nullopt;
  if (take_word(text, "in")) return *number * kInch;
  take_word(text, "mm");
  return number;
}

/// What stands after the equals sign; none where it is no such word.
std::optional<Cutter> read_shape_word(std::string_view text) {
  Cutter c;
  for (const ShapeWord& one : kShapeWords) {
    if (take_word(text, one.word)) {
      c.shape = one.shape;
      break;
    }
  }
  const std::optional<double> diameter = take_length(text);
  if (!diameter) return std::nullopt;
  c.diameter_mm = *diameter;
  if (c.shape == Shape::kBall) c.corner_radius_mm = c.radius();
  if (c.shape == Shape::kBullNose) {
    const std::optional<double> radius = take_word(text, "r") ? take_length(text) : std::nullopt;
    if (!radius) return std::nullopt;
    c.corner_radius_mm = *radius;
  }
  if (c.shape == Shape::kDrill) c.point_angle_rad = rad_from_deg(kTwistDrill);
  if (c.shape == Shape::kDrill || c.shape == Shape::kChamfer) {
    const std::optional<double> angle = take_word(text, "a") ? take_number(text) : std::nullopt;
    if (angle) c.point_angle_rad = rad_from_deg(*angle);
    if (!angle && c.shape == Shape::kChamfer) return std::nullopt;
  }
  return text.empty() ? std::optional<Cutter>(c) : std::nullopt;
}

void add_length(Cutter& c) {
  c.length_mm = c.flute_length_mm = 60.0 + 2.0 * c.diameter_mm;
  c.gauge_length_mm = c.length_mm;
  c.shank_diameter_mm = c.diameter_mm;
  c.holder = {{c.diameter_mm, c.diameter_mm, 1.0}};
}

/// "T4" and "4" are number 4, anything else a name.
void set_call(Cutter& c, std::string_view called) {
  std::string_view digits = called;
  if (std::toupper(static_cast<unsigned char>(called.front())) == 'T') digits.remove_prefix(1);
  int number = 0;
  const auto [next, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  const bool numbered = failure == std::errc() && next == digits.data() + digits.size() && number > 0;
  if (numbered) {
    c.number = number;
  } else {
    c.name = called;
  }
}

void fail(const std::string& text, const SourceLocation& where, Diagnostics& diagnostics) {
  diagnostics.error("bad-tool-word", where, text,
                    "write the diameter in mm, or a shape and its numbers: T1=6,T2=ball4,T3=drill5,"
                    "T4=bull10r1,T5=chamfer8a90,T6=0.25in");
}

std::optional<Cutter> read_one(std::string_view word, bool only, const SourceLocation& where,
                               Diagnostics& diagnostics) {
  const size_t equals = word.find('=');
  const std::string_view called = equals == word.npos ? "" : trimmed(word.substr(0, equals));
  const std::string shape = lower(trimmed(equals == word.npos ? word : word.substr(equals + 1)));
  std::optional<Cutter> c = read_shape_word(shape);
  if (!c) {
    fail(fmt::format("'{}' does not describe a tool", word), where, diagnostics);
    return std::nullopt;
  }
  if (called.empty() && (!only || equals != word.npos)) {
    fail(fmt::format("'{}' does not say which tool it is", word), where, diagnostics);
    return std::nullopt;
  }
  if (!(c->diameter_mm > 0.0) || c->diameter_mm > kLargestTool) {
    fail(fmt::format("'{}' has a diameter of {:g} mm: it must be above 0 and at most {:g} mm", word,
                     c->diameter_mm, kLargestTool),
         where, diagnostics);
    return std::nullopt;
  }
  if (!called.empty()) set_call(*c, called);
  add_length(*c);
  for (const cutter::Problem& problem : cutter::validate(*c))
    fail(fmt::format("'{}': {}", word, problem.text), where, diagnostics);
  return c;
}

}  // namespace

std::vector<Cutter> read_tool_words(const std::string& list, const SourceLocation& where,
                                    Diagnostics& diagnostics) {
  std::vector<Cutter> tools;
  const bool only = list.find(',') == list.npos;
  std::string_view rest = list;
  while (true) {
    const size_t comma = std::min(rest.find(','), rest.size());
    std::optional<Cutter> c = read_one(trimmed(rest.substr(0, comma)), only, where, diagnostics);
    if (c) tools.push_back(std::move(*c));
    if (comma == rest.size()) return tools;
    rest.remove_prefix(comma + 1);
  }
}

bool is_bare(const Cutter& tool) {
  const double slack = 1e-9 * tool.diameter_mm;
  const auto slim = [&](const cutter::ToolSection& section) {
    return std::max(section.diameter_mm, section.top_diameter_mm) <= tool.diameter_mm + slack;
  };
  return tool.flute_length_mm >= tool.length_mm && tool.shank_diameter_mm <= tool.diameter_mm + slack &&
         std::all_of(tool.holder.begin(), tool.holder.end(), slim);
}

}  // namespace swarf::sim
