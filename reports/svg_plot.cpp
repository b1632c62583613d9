#include "reports/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "reports/html.h"

namespace swarf::reports {
namespace {

using Point = std::array<double, 2>;

// The drawing in its own units; the style sheet scales it to the column.
constexpr double kWidth = 540.0, kHeight = 300.0;
constexpr double kTop = 30.0, kBottom = 46.0, kRight = 18.0;
constexpr double kTickCharWidth = 7.2;  ///< of the 12-unit type that the style sheet sets
constexpr int kColumns = 800;           ///< finer than a screen shows at this width
constexpr int kSeriesColours = 6;       ///< in the style sheet

/// Relative width below which a range counts as one value: no tick could show it with readable digits.
constexpr double kNoWidth = 1e-9;

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return low > high; }
};

/// One axis: what it covers, its ticks, and the power of ten taken out of its numbers.
struct Axis {
  Range range;
  Ticks ticks;
  int exponent = 0;
  double pixel_low = 0.0, pixel_high = 1.0;

  double pixel(double value) const {
    return pixel_low + (value - range.low) / (range.high - range.low) * (pixel_high - pixel_low);
  }
  std::string label(double value) const {
    const double scale = std::pow(10.0, -exponent);
    return tick_text(value * scale, ticks.step * scale);
  }
};

/// Multiples of 3 outside 1e-3 .. 1e6, where plain digits become hard to read.
int exponent_of(const Range& range) {
  const double largest = std::max(std::abs(range.low), std::abs(range.high));
  if (largest == 0.0 || (largest >= 1e-3 && largest < 1e6)) return 0;
  return 3 * static_cast<int>(std::floor(std::log10(largest) / 3.0));
}

/// `to_ticks`: the axis ends at round numbers; otherwise at its data.
Axis make_axis(Range range, int wanted, bool to_ticks) {
  if (range.empty()) range = {0.0, 1.0};
  Axis axis{range, round_ticks(range.low, range.high, wanted)};
  axis.exponent = exponent_of(range);
  const double size = std::max(std::abs(range.low), std::abs(range.high));
  if (to_ticks || range.high - range.low <= kNoWidth * size) {
    axis.range = {axis.ticks.values.front(), axis.ticks.values.back()};
  } else {
    std::erase_if(axis.ticks.values, [&](double tick) {
      const double slack = 1e-9 * axis.ticks.step;  // rounding of k * step only
      return tick < range.low - slack || tick > range.high + slack;
    });
  }
  return axis;
}

std::string superscript(int number) {
  static constexpr std::string_view kDigits[] = {"⁰", "¹", "²", "³", "⁴",  //
                                                 "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = number < 0 ? "⁻" : "";
  for (const char c : std::to_string(std::abs(number))) out += kDigits[c - '0'];
  return out;
}

std::string axis_title(const std::string& label, const std::string& unit, int exponent) {
  std::string in_brackets = exponent == 0 ? "" : "×10" + superscript(exponent);
  if (!unit.empty()) in_brackets += (in_brackets.empty() ? "" : " ") + unit;
  return in_brackets.empty() ? label : label + " (" + in_brackets + ")";
}

Axis x_axis(const Plot& plot) {
  Range range;
  for (const Series& series : plot.series) {
    for (const Point& point : series.points) range.add(point[0]);
  }
  for (const Bar& bar : plot.bars) {
    range.add(bar.low);
    range.add(bar.high);
  }
  for (const LimitLine& limit : plot.limits) {
    if (limit.vertical) range.add(limit.value);
  }
  return make_axis(range, 7, false);
}

Axis y_axis(const Plot& plot) {
  Range range;
  for (const Series& series : plot.series) {
    for (const Point& point : series.points) range.add(point[1]);
  }
  for (const Bar& bar : plot.bars) range.add(bar.value);
  for (const LimitLine& limit : plot.limits) {
    if (!limit.vertical) range.add(limit.value);
  }
  if (plot.y_from_zero || !plot.bars.empty()) range.add(0.0);
  return make_axis(range, 5, true);
}

double left_margin(const Axis& y) {
  size_t longest = 1;
  for (const double tick : y.ticks.values) {
    const std::string text = y.label(tick);
    // Bytes that continue a UTF-8 character (the thin space) take no room of their own.
    const auto characters = std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; });
    longest = std::max(longest, static_cast<size_t>(characters));
  }
  return 16.0 + kTickCharWidth * static_cast<double>(longest);
}

std::string grid(const Axis& x, const Axis& y) {
  std::string out = "<g class=\"grid\">";
  for (const double tick : y.ticks.values) {
    out += fmt::format(R"(<path d="M{:.1f} {:.1f}H{:.1f}"/>)", x.pixel_low, y.pixel(tick), x.pixel_high);
  }
  for (const double tick : x.ticks.values) {
    out += fmt::format(R"(<path d="M{:.1f} {:.1f}v5" class="tick"/>)", x.pixel(tick), y.pixel_low);
  }
  out += fmt::format(R"(<path d="M{:.1f} {:.1f}H{:.1f}" class="base"/></g>)", x.pixel_low, y.pixel_low,
                     x.pixel_high);
  return out;
}

std::string lettering(const Plot& plot, const Axis& x, const Axis& y) {
  std::string out = "<g class=\"ticks\">";
  for (const double tick : y.ticks.values) {
    out += fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="end">{}</text>)", x.pixel_low - 8.0,
                       y.pixel(tick) + 4.0, y.label(tick));
  }
  for (const double tick : x.ticks.values) {
    out += fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle">{}</text>)", x.pixel(tick),
                       y.pixel_low + 19.0, x.label(tick));
  }
  out += "</g><g class=\"axis-titles\">";
  out += fmt::format(R"(<text x="2" y="14">{}</text>)",
                     escape(axis_title(plot.y_label, plot.y_unit, y.exponent)));
  out += fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="end">{}</text></g>)", x.pixel_high,
                     y.pixel_low + 39.0, escape(axis_title(plot.x_label, plot.x_unit, x.exponent)));
  return out;
}

/// "M12.3 45.6 13.1 44 ...": points that fall on the one before, at a tenth of a unit, are left out.
std::string path_data(const std::vector<Point>& points, const Axis& x, const Axis& y) {
  std::string out, last;
  bool pen_down = false;
  for (const Point& point : points) {
    if (!std::isfinite(point[0]) || !std::isfinite(point[1])) {
      pen_down = false;
      continue;
    }
    std::string text = fmt::format("{:.1f} {:.1f}", x.pixel(point[0]), y.pixel(point[1]));
    if (pen_down && text == last) continue;
    out += pen_down ? " " : "M";
    out += text;
    last = std::move(text);
    pen_down = true;
  }
  return out;
}

std::string lines(const Plot& plot, const Axis& x, const Axis& y) {
  std::string out;
  for (size_t i = 0; i < plot.series.size(); ++i) {
    const std::string data = path_data(decimate(plot.series[i].points, kColumns), x, y);
    if (data.empty()) continue;
    out += fmt::format(R"(<path class="series s{}" d="{}"/>)", i % kSeriesColours, data);
  }
  return out;
}

std::string bars(const Plot& plot, const Axis& x, const Axis& y) {
  std::string out = plot.bars.empty() ? "" : "<g class=\"bars\">";
  for (const Bar& bar : plot.bars) {
    if (bar.value == 0.0) continue;
    const double left = x.pixel(bar.low), right = x.pixel(bar.high), top = y.pixel(bar.value);
    const double gap = right - left > 4.0 ? 1.0 : 0.0;  // narrow bars stand close
    out += fmt::format(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}"><title>)"
                       R"({:.4g} – {:.4g} {}: {:.6g} {}</title></rect>)",
                       left + gap / 2, top, std::max(right - left - gap, 0.3), y.pixel_low - top, bar.low,
                       bar.high, escape(plot.x_unit), bar.value, escape(plot.y_unit));
  }
  return plot.bars.empty() ? out : out + "</g>";
}

std::string limit_lines(const Plot& plot, const Axis& x, const Axis& y) {
  std::string out = plot.limits.empty() ? "" : "<g class=\"limits\">";
  double label_y = kTop + 12.0;  // labels of vertical lines stand below one another
  for (const LimitLine& limit : plot.limits) {
    if (limit.vertical) {
      const double at = x.pixel(limit.value);
      const bool to_the_left = at > (x.pixel_low + x.pixel_high) / 2;
      out += fmt::format(R"(<path d="M{:.1f} {:.1f}V{:.1f}"/><text x="{:.1f}" y="{:.1f}"{}>{}</text>)", at,
                         y.pixel_low, kTop, at + (to_the_left ? -5.0 : 5.0), label_y,
                         to_the_left ? R"( text-anchor="end")" : "", escape(limit.label));
      label_y += 16.0;
    } else {
      const double at = y.pixel(limit.value);
      out += fmt::format(
          R"(<path d="M{:.1f} {:.1f}H{:.1f}"/><text x="{:.1f}" y="{:.1f}" text-anchor="end">{}</text>)",
          x.pixel_low, at, x.pixel_high, x.pixel_high - 2.0, at - 5.0, escape(limit.label));
    }
  }
  return plot.limits.empty() ? out : out + "</g>";
}

/// What the plot shows, for those who hear the page.
std::string spoken(const Plot& plot, const Axis& x) {
  std::string out = fmt::format("{}. {} from {:.4g} to {:.4g} {}.", plot.title, plot.x_label, x.range.low,
                                x.range.high, plot.x_unit);
  for (const Series& series : plot.series) {
    Range range;
    for (const Point& point : series.points) range.add(point[1]);
    if (range.empty()) continue;
    out += fmt::format(" {}: {:.4g} to {:.4g} {}.", series.name.empty() ? plot.y_label : series.name,
                       range.low, range.high, plot.y_unit);
  }
  if (!plot.bars.empty()) out += fmt::format(" {} bars of {}.", plot.bars.size(), plot.y_label);
  return out;
}

/// Collects one column's points and gives back those that a line through all of them would show.
class ColumnThinner {
 public:
  explicit ColumnThinner(std::vector<Point>& out) : out_(out) {}

  void add(long column, const Point& point, size_t index) {
    if (column != column_) flush();
    column_ = column;
    if (kept_.empty()) kept_.assign(4, {index, point});
    if (point[1] < kept_[1].second[1]) kept_[1] = {index, point};
    if (point[1] > kept_[2].second[1]) kept_[2] = {index, point};
    kept_[3] = {index, point};
  }

  void flush() {
    std::ranges::sort(kept_, {}, &std::pair<size_t, Point>::first);
    size_t last = std::numeric_limits<size_t>::max();
    for (const auto& [index, point] : kept_) {
      if (index != last) out_.push_back(point);
      last = index;
    }
    kept_.clear();
  }

 private:
  std::vector<Point>& out_;
  std::vector<std::pair<size_t, Point>> kept_;  ///< first, lowest, highest, last, each with its index
  long column_ = -1;
};

}  // namespace

Ticks round_ticks(double low, double high, int wanted) {
  const double size = std::max(std::abs(low), std::abs(high));
  if (high - low <= kNoWidth * size) {
    const double middle = low + (high - low) / 2, half = size == 0.0 ? 0.5 : size / 2;
    low = middle - half;
    high = middle + half;
  }
  const double raw = (high - low) / wanted;
  const double decade = std::pow(10.0, std::floor(std::log10(raw)));
  const double ratio = raw / decade;
  Ticks ticks;
  ticks.step = decade * (ratio < 1.5 ? 1.0 : ratio < 3.5 ? 2.0 : ratio < 7.5 ? 5.0 : 10.0);
  // A limit that is a multiple of the step but for its last digits must not gain a step of its own.
  constexpr double kSlack = 1e-9;
  const double first = std::floor(low / ticks.step + kSlack), last = std::ceil(high / ticks.step - kSlack);
  for (double k = first; k <= last; k += 1.0) ticks.values.push_back(k * ticks.step);
  return ticks;
}

std::string tick_text(double value, double step) {
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  if (std::abs(value) < step / 2) value = 0.0;
  std::string text = fmt::format("{:.{}f}", std::abs(value), decimals);
  const size_t whole = std::min(text.find('.'), text.size());
  if (whole > 4) {
    for (size_t at = whole; at > 3; at -= 3) text.insert(at - 3, at - 3 == 0 ? "" : "\u2009");
  }
  return (value < 0.0 ? "−" : "") + text;
}

std::vector<Point> decimate(const std::vector<Point>& points, int columns) {
  Range range;
  double before = -std::numeric_limits<double>::infinity();
  for (const Point& point : points) {
    if (!std::isfinite(point[0])) continue;
    if (point[0] < before) return points;
    before = point[0];
    range.add(point[0]);
  }
  if (range.empty() || range.low == range.high) return points;
  std::vector<Point> out;
  ColumnThinner thinner(out);
  for (size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(points[i][0]) || !std::isfinite(points[i][1])) {
      thinner.flush();
      out.push_back(points[i]);
      continue;
    }
    const double share = (points[i][0] - range.low) / (range.high - range.low);
    thinner.add(std::lround(std::floor(share * columns)), points[i], i);
  }
  thinner.flush();
  return out;
}

std::string plot_svg(const Plot& plot) {
  Axis x = x_axis(plot), y = y_axis(plot);
  x.pixel_low = left_margin(y);
  x.pixel_high = kWidth - kRight;
  y.pixel_low = kHeight - kBottom;
  y.pixel_high = kTop;
  std::string out = fmt::format(
      R"(<svg class="plot" viewBox="0 0 {} {}" role="img" aria-label="{}")"
      R"( data-box="{:.1f} {:.1f} {:.1f} {:.1f}" data-range="{:.9g} {:.9g} {:.9g} {:.9g}")"
      R"( data-x-unit="{}" data-y-unit="{}">)",
      kWidth, kHeight, escape(spoken(plot, x)), x.pixel_low, x.pixel_high, y.pixel_low, y.pixel_high,
      x.range.low, x.range.high, y.range.low, y.range.high, escape(plot.x_unit), escape(plot.y_unit));
  out += grid(x, y) + bars(plot, x, y) + lines(plot, x, y) + limit_lines(plot, x, y) + lettering(plot, x, y);
  return out + "</svg>";
}

}  // namespace swarf::reports
