#include "render/lettering.h"

#include <cairo/cairo.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "base/check.h"

namespace swarf::render {
namespace {

constexpr double kTextShare = 0.024;  // text height as a share of the picture's height
constexpr double kMinTextPx = 11.0;   // below this DejaVu is hard to read
using Paint = std::array<double, 4>;  // sRGB and opacity
constexpr Paint kPlate{0.08, 0.10, 0.12, 0.72};
constexpr Paint kChip{0.80, 0.80, 0.80, 1.0};  // behind the lines of a legend, which may be dark
constexpr Paint kNotice{0.78, 0.08, 0.06, 0.92}, kDimNotice{0.45, 0.06, 0.05, 0.75};
constexpr double kProgressShare = 0.008;  // height of the bar as a share of the picture's

double text_px_of(int height) {
  return std::max(kTextShare * height, kMinTextPx);
}

/// Of lines, in heights of text: the plate's edge, from one line to the next, and the whole plate.
constexpr double kPad = 0.8, kStep = 1.35;
double plate_height(size_t lines) {
  return kStep * static_cast<double>(lines) + 1.2 * kPad;
}

/// A Cairo drawing over the pixels of an image; they are written back by finish().
class Canvas {
 public:
  explicit Canvas(Image& image)
      : image_(image),
        surface_(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, image.width, image.height),
                 cairo_surface_destroy),
        cairo_(cairo_create(surface_.get()), cairo_destroy) {
    SWARF_CHECK(image.width > 0 && image.height > 0, "lettering needs a picture");
    SWARF_CHECK(cairo_status(cairo_.get()) == CAIRO_STATUS_SUCCESS, "Cairo cannot make a surface");
    cairo_select_font_face(cr(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr(), text_px());
  }

  cairo_t* cr() const { return cairo_.get(); }
  double text_px() const { return text_px_of(image_.height); }
  void bold(bool on) const {
    cairo_select_font_face(cr(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           on ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  }
  double text_width(const std::string& text) const {
    cairo_text_extents_t extents;
    cairo_text_extents(cr(), text.c_str(), &extents);
    return extents.x_advance;
  }
  void text(double x, double baseline, const std::string& words) const {
    cairo_set_source_rgb(cr(), 0.96, 0.97, 0.98);
    cairo_move_to(cr(), x, baseline);
    cairo_show_text(cr(), words.c_str());
  }
  void plate(double x, double y, double width, double height, const Paint& paint = kPlate) const {
    const double r = 0.4 * text_px();
    cairo_new_sub_path(cr());
    cairo_arc(cr(), x + width - r, y + r, r, -M_PI / 2, 0);
    cairo_arc(cr(), x + width - r, y + height - r, r, 0, M_PI / 2);
    cairo_arc(cr(), x + r, y + height - r, r, M_PI / 2, M_PI);
    cairo_arc(cr(), x + r, y + r, r, M_PI, 1.5 * M_PI);
    cairo_close_path(cr());
    cairo_set_source_rgba(cr(), paint[0], paint[1], paint[2], paint[3]);
    cairo_fill(cr());
  }
  void stroke(const Vec2& from, const Vec2& to, const Rgb& linear) const;
  /// Lays the drawing over the picture. It lies within these rows: others are not looked at.
  void finish(double top, double bottom);
  void finish() { finish(0.0, image_.height); }

 private:
  Image& image_;
  std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
  std::unique_ptr<cairo_t, decltype(&cairo_destroy)> cairo_;
};

void Canvas::finish(double top, double bottom) {
  cairo_surface_flush(surface_.get());
  const uint8_t* rows = cairo_image_surface_get_data(surface_.get());
  const int stride = cairo_image_surface_get_stride(surface_.get());
  const int end = std::min(image_.height, static_cast<int>(std::ceil(bottom)));
  for (int y = std::max(0, static_cast<int>(std::floor(top))); y < end; ++y) {
    const auto* over = reinterpret_cast<const uint32_t*>(rows + static_cast<ptrdiff_t>(y) * stride);
    uint8_t* pixel = &image_.rgba[size_t{4} * image_.width * y];
    for (int x = 0; x < image_.width; ++x, pixel += 4) {
      const uint32_t value = over[x];  // premultiplied, alpha in the highest byte
      const uint32_t alpha = value >> 24;
      if (alpha == 0) continue;
      for (int k = 0; k < 3; ++k) {
        const uint32_t below = (pixel[k] * (255 - alpha) + 127) / 255;
        pixel[k] = static_cast<uint8_t>(std::min<uint32_t>(((value >> (16 - 8 * k)) & 255) + below, 255));
      }
      pixel[3] = static_cast<uint8_t>(alpha + (pixel[3] * (255 - alpha) + 127) / 255);
    }
  }
}

double srgb(double linear) {
  linear = std::clamp(linear, 0.0, 1.0);
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

void Canvas::stroke(const Vec2& from, const Vec2& to, const Rgb& linear) const {
  cairo_set_source_rgb(cr(), srgb(linear[0]), srgb(linear[1]), srgb(linear[2]));
  cairo_move_to(cr(), from.x(), from.y());
  cairo_line_to(cr(), to.x(), to.y());
  cairo_stroke(cr());
}

struct BarLayout {
  double x, y, width, height;
};

void draw_ramp(const Canvas& canvas, const ColourBar& bar, const BarLayout& at) {
  const int rows = std::max(1, static_cast<int>(at.height));
  for (int i = 0; i < rows; ++i) {
    const double value = bar.high + (bar.low - bar.high) * (i + 0.5) / rows;
    const Rgb c = bar.colour(value);
    cairo_set_source_rgb(canvas.cr(), srgb(c[0]), srgb(c[1]), srgb(c[2]));
    cairo_rectangle(canvas.cr(), at.x, at.y + i, at.width, 1.0);
    cairo_fill(canvas.cr());
  }
}

void draw_ticks(const Canvas& canvas, const ColourBar& bar, const BarLayout& at) {
  const double text_px = canvas.text_px();
  for (const ColourTick& tick : bar.ticks) {
    SWARF_CHECK(tick.value >= bar.low && tick.value <= bar.high, "a tick outside the colour bar");
    const double y = at.y + std::floor(at.height) * (bar.high - tick.value) / (bar.high - bar.low);
    cairo_set_source_rgb(canvas.cr(), 0.96, 0.97, 0.98);
    cairo_set_line_width(canvas.cr(), std::max(1.0, 0.07 * text_px));
    cairo_move_to(canvas.cr(), at.x + at.width, y);
    cairo_rel_line_to(canvas.cr(), 0.35 * text_px, 0.0);
    cairo_stroke(canvas.cr());
    canvas.text(at.x + at.width + 0.6 * text_px, y + 0.35 * text_px, tick.label);
  }
}

void draw_apart(const Canvas& canvas, const ColourBar& bar, const BarLayout& at) {
  const double text_px = canvas.text_px();
  const Rgb& c = bar.apart_colour;
  cairo_set_source_rgb(canvas.cr(), srgb(c[0]), srgb(c[1]), srgb(c[2]));
  cairo_rectangle(canvas.cr(), at.x, at.y, at.width, at.height);
  cairo_fill(canvas.cr());
  canvas.text(at.x + at.width + 0.6 * text_px, at.y + 0.5 * at.height + 0.35 * text_px, bar.apart);
}

}  // namespace

namespace {

/// The words, or as many of their letters with dots behind them as fit.
std::string fitted(const Canvas& canvas, std::string words, double width) {
  if (canvas.text_width(words) <= width) return words;
  while (!words.empty() && canvas.text_width(words + "...") > width) {
    // Bytes 10xxxxxx go on with a letter.
    while (words.size() > 1 && (static_cast<unsigned char>(words.back()) & 0xc0U) == 0x80U) words.pop_back();
    words.pop_back();
  }
  return words + "...";
}

void draw_lines(Image& image, std::vector<std::string> lines, Corner corner, const Paint& paint) {
  if (lines.empty()) return;
  Canvas canvas(image);
  const double text_px = canvas.text_px(), pad = kPad * text_px, step = kStep * text_px;
  double width = 0.0;
  for (size_t i = 0; i < lines.size(); ++i) {
    canvas.bold(i == 0);
    lines[i] = fitted(canvas, std::move(lines[i]), image.width - 4.0 * pad);
    width = std::max(width, canvas.text_width(lines[i]) + 2.0 * pad);
  }
  const double height = plate_height(lines.size()) * text_px;
  const bool right = corner == Corner::kTopRight || corner == Corner::kBottomRight;
  const bool bottom = corner == Corner::kBottomLeft || corner == Corner::kBottomRight;
  const double x = right ? image.width - pad - width : pad;
  const double y = bottom ? image.height - pad - height : pad;
  canvas.plate(x, y, width, height, paint);
  for (size_t i = 0; i < lines.size(); ++i) {
    canvas.bold(i == 0);
    canvas.text(x + pad, y + 0.6 * pad + step * (static_cast<double>(i) + 0.77), lines[i]);
  }
  canvas.finish(y, y + height);
}

}  // namespace

void draw_caption(Image& image, const std::vector<std::string>& lines, Corner corner) {
  draw_lines(image, lines, corner, kPlate);
}

size_t caption_lines(int height_px, double share) {
  size_t lines = 1;
  while (plate_height(lines + 1) * text_px_of(height_px) <= share * height_px) ++lines;
  return lines;
}

void draw_notice(Image& image, const std::vector<std::string>& lines, bool bright) {
  draw_lines(image, lines, Corner::kTopLeft, bright ? kNotice : kDimNotice);
}

void draw_progress(Image& image, double share) {
  Canvas canvas(image);
  const double height = std::max(2.0, std::round(kProgressShare * image.height));
  const auto bar = [&](double width, double r, double g, double b, double opacity) {
    cairo_set_source_rgba(canvas.cr(), r, g, b, opacity);
    cairo_rectangle(canvas.cr(), 0.0, image.height - height, width, height);
    cairo_fill(canvas.cr());
  };
  bar(image.width, 0.08, 0.10, 0.12, 0.45);
  bar(std::clamp(share, 0.0, 1.0) * image.width, 0.95, 0.55, 0.10, 1.0);
  canvas.finish(image.height - height, image.height);
}

double draw_colour_bar(Image& image, const ColourBar& bar) {
  SWARF_CHECK(bar.low < bar.high && bar.colour, "a colour bar needs a range and colours");
  Canvas canvas(image);
  const double text_px = canvas.text_px(), pad = 0.8 * text_px, bar_width = 1.1 * text_px;
  double text_width = 0.0;
  for (const ColourTick& tick : bar.ticks) text_width = std::max(text_width, canvas.text_width(tick.label));
  const double below = bar.apart.empty() ? 0.0 : 1.8 * text_px;
  text_width = std::max(text_width, canvas.text_width(bar.apart));
  const double inner = std::max(bar_width + 0.6 * text_px + text_width, canvas.text_width(bar.title));
  const double height = 0.56 * image.height, top = 0.22 * image.height;
  const double x = std::floor(image.width - 2.0 * pad - inner);
  canvas.plate(x - pad, top - 2.0 * text_px - pad, inner + 2.0 * pad,
               height + below + 2.6 * text_px + 2.0 * pad);
  canvas.text(x, top - text_px, bar.title);
  const BarLayout at{x, std::floor(top), bar_width, std::floor(height)};
  draw_ramp(canvas, bar, at);
  draw_ticks(canvas, bar, at);
  if (!bar.apart.empty())
    draw_apart(canvas, bar,
               {x, std::floor(at.y + at.height + 0.8 * text_px), bar_width, std::floor(text_px)});
  canvas.finish();
  return x - pad;
}

double round_length(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  double length = decade;
  for (const double step : {2.0, 5.0})
    if (step * decade <= value) length = step * decade;
  return length;
}

void draw_scale_bar(Image& image, double px_per_mm) {
  SWARF_CHECK(px_per_mm > 0.0 && std::isfinite(px_per_mm), "a scale bar needs a scale");
  constexpr double kWidthShare = 0.2;
  const double most_mm = kWidthShare * image.width / px_per_mm;
  const double length = round_length(most_mm);
  Canvas canvas(image);
  const double text_px = canvas.text_px(), pad = 0.8 * text_px, width = length * px_per_mm;
  const std::string words = fmt::format("{:g} mm", length);
  const double inner = std::max(width, canvas.text_width(words));
  const double x = 2.0 * pad, bottom = image.height - 2.0 * pad;
  canvas.plate(x - pad, bottom - 2.1 * text_px, inner + 2.0 * pad, 2.1 * text_px + pad);
  canvas.text(x + 0.5 * (inner - canvas.text_width(words)), bottom - 0.9 * text_px, words);
  cairo_set_line_width(canvas.cr(), std::max(1.5, 0.12 * text_px));
  const double from = x + 0.5 * (inner - width);
  for (const double end : {from, from + width}) {
    cairo_move_to(canvas.cr(), end, bottom - 0.5 * text_px);
    cairo_line_to(canvas.cr(), end, bottom + 0.1 * text_px);
  }
  cairo_move_to(canvas.cr(), from, bottom - 0.2 * text_px);
  cairo_line_to(canvas.cr(), from + width, bottom - 0.2 * text_px);
  cairo_stroke(canvas.cr());
  canvas.finish();
}

void draw_strokes(Image& image, const Strokes& strokes) {
  Canvas canvas(image);
  cairo_set_line_cap(canvas.cr(), CAIRO_LINE_CAP_ROUND);
  cairo_set_line_width(canvas.cr(), std::max(1.2, strokes.width * canvas.text_px()));
  for (const Strokes::Piece& piece : strokes.pieces) canvas.stroke(piece.from, piece.to, piece.colour);
  canvas.finish();
}

Vec2 draw_legend(Image& image, const std::string& title, const std::vector<Strokes>& kinds,
                 const std::vector<std::string>& notes) {
  Canvas canvas(image);
  const double text_px = canvas.text_px(), pad = 0.8 * text_px, step = 1.35 * text_px, sample = 2.2 * text_px;
  double width = 0.0;
  for (const Strokes& kind : kinds)
    width = std::max(width, sample + 0.6 * text_px + canvas.text_width(kind.words));
  for (const std::string& note : notes) width = std::max(width, canvas.text_width(note));
  canvas.bold(true);
  width = std::max(width, canvas.text_width(title));
  const double rows = 1.0 + static_cast<double>(kinds.size() + notes.size());
  canvas.plate(pad, pad, width + 2.0 * pad, step * rows + 1.2 * pad);
  double baseline = 1.6 * pad + 0.77 * step;
  canvas.text(2.0 * pad, baseline, title);
  canvas.bold(false);
  for (const Strokes& kind : kinds) {
    baseline += step;
    const double y = baseline - 0.35 * text_px;
    canvas.plate(2.0 * pad - 0.3 * text_px, y - 0.55 * text_px, sample + 0.6 * text_px, 1.1 * text_px, kChip);
    cairo_set_line_width(canvas.cr(), std::max(1.2, kind.width * text_px));
    canvas.stroke({2.0 * pad, y}, {2.0 * pad + sample, y}, kind.sample);
    canvas.text(2.0 * pad + sample + 0.6 * text_px, baseline, kind.words);
  }
  for (const std::string& note : notes) canvas.text(2.0 * pad, baseline += step, note);
  canvas.finish();
  return {3.0 * pad + width, pad + step * rows + 1.2 * pad};
}

namespace {

/// A plate for words of one line.
struct LeaderPlate {
  double x, y, width, height;
  bool meets(const LeaderPlate& other) const {
    return x < other.x + other.width && other.x < x + width && y < other.y + other.height &&
           other.y < y + height;
  }
  bool covers(const Leader& leader) const {
    return leader.x > x && leader.x < x + width && leader.y > y && leader.y < y + height;
  }
};

/// Up and right of the place, else left, else below it, whichever hides no place and no other plate.
LeaderPlate plate_for(const Leader& leader, double width, double text_px, const Vec2& most,
                      const std::vector<Leader>& leaders, const std::vector<LeaderPlate>& taken) {
  const double height = 1.9 * text_px, pad = 0.5 * text_px;
  const auto at = [&](double x, double y) {
    return LeaderPlate{std::clamp(x, pad, std::max(pad, most.x() - pad - width)),
                       std::clamp(y, pad, std::max(pad, most.y() - pad - height)), width, height};
  };
  const double right = leader.x + 3.0 * text_px, left = leader.x - 3.0 * text_px - width;
  for (const double y : {leader.y - 4.0 * text_px, leader.y + 2.1 * text_px}) {
    for (const double x : {right, left}) {
      const LeaderPlate plate = at(x, y);
      if (std::none_of(taken.begin(), taken.end(),
                       [&](const LeaderPlate& one) { return plate.meets(one); }) &&
          std::none_of(leaders.begin(), leaders.end(), [&](const Leader& one) { return plate.covers(one); }))
        return plate;
    }
  }
  LeaderPlate plate = at(right, leader.y - 4.0 * text_px);
  for (const LeaderPlate& one : taken)
    if (plate.meets(one)) plate.y = one.y + 1.2 * height;
  return plate;
}

}  // namespace

void draw_leaders(Image& image, const std::vector<Leader>& leaders, double right_px, const Vec2& legend) {
  if (leaders.empty()) return;
  Canvas canvas(image);
  const double text_px = canvas.text_px(), pad = 0.5 * text_px;
  std::vector<LeaderPlate> taken;
  if (!legend.isZero()) taken.push_back({0.0, 0.0, legend.x(), legend.y()});
  for (const Leader& leader : leaders) {
    const LeaderPlate at = plate_for(leader, canvas.text_width(leader.text) + 2.0 * pad, text_px,
                                     {right_px, image.height}, leaders, taken);
    taken.push_back(at);
    cairo_set_source_rgb(canvas.cr(), 0.96, 0.97, 0.98);
    cairo_set_line_width(canvas.cr(), std::max(1.0, 0.1 * text_px));
    cairo_move_to(canvas.cr(), leader.x, leader.y);
    cairo_line_to(canvas.cr(), std::clamp(leader.x, at.x, at.x + at.width),
                  std::clamp(leader.y, at.y, at.y + at.height));
    cairo_stroke(canvas.cr());
    cairo_arc(canvas.cr(), leader.x, leader.y, 0.25 * text_px, 0.0, 2.0 * M_PI);
    cairo_fill(canvas.cr());
    canvas.plate(at.x, at.y, at.width, at.height);
    canvas.text(at.x + pad, at.y + 1.25 * text_px, leader.text);
  }
  canvas.finish();
}

}  // namespace swarf::render
