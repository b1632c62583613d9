// Text and colour bars on finished pictures (Cairo).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/draw_list.h"

namespace swarf::render {

enum class Corner { kTopLeft, kTopRight, kBottomLeft, kBottomRight };

/// Lines of text on a translucent plate in a corner of the picture; the first line is bold. Sizes follow the
/// picture's height; a line that would leave the picture is cut short. An empty list draws nothing.
void draw_caption(Image& image, const std::vector<std::string>& lines, Corner corner = Corner::kBottomLeft);

/// The same at the top left on a red plate, bright or dimmed: what the viewer must not miss.
void draw_notice(Image& image, const std::vector<std::string>& lines, bool bright);

/// As many lines as a caption may have that covers no more than this share (below 1) of a picture's height;
/// at least one.
size_t caption_lines(int height_px, double share);

/// A thin bar along the lower edge, filled from the left by this share.
void draw_progress(Image& image, double share);

struct ColourTick {
  double value = 0.0;
  std::string label;
};

/// A vertical bar at the right edge, low at the bottom.
struct ColourBar {
  double low = 0.0, high = 1.0;
  std::function<Rgb(double value)> colour;  ///< linear RGB of a value in [low, high]
  std::vector<ColourTick> ticks;            ///< values in [low, high]
  std::string title;                        ///< above the bar, with the unit: "deviation, um"
  std::string apart;                   ///< below the bar, beside a patch of its own: "not measured"; "": none
  Rgb apart_colour{0.0F, 0.0F, 0.0F};  ///< linear RGB of that patch
};

/// Along the right border; where its plate begins, px from the left.
double draw_colour_bar(Image& image, const ColourBar& bar);

/// A bar at the lower left, of the longest of 1, 2, 5 times a power of ten mm that takes no more than a
/// fifth of the picture's width, with its length: "20 mm". `px_per_mm` > 0: where it is to be read.
void draw_scale_bar(Image& image, double px_per_mm);

/// The greatest of 1, 2 and 5 times a power of ten that is at most `value` (> 0).
double round_length(double value);

/// Straight pieces of one kind, px from the upper left corner.
struct Strokes {
  struct Piece {
    Vec2 from, to;
    Rgb colour;  ///< linear
  };
  std::vector<Piece> pieces{};
  double width = 0.12;  ///< of the height of text
  std::string words{};  ///< in the legend
  Rgb sample{};         ///< colour there, linear
};
void draw_strokes(Image& image, const Strokes& strokes);

/// At the upper left: a title in bold, a line of each kind with its words, and notes. Where its plate ends.
Vec2 draw_legend(Image& image, const std::string& title, const std::vector<Strokes>& kinds,
                 const std::vector<std::string>& notes);

/// Words that lead to a place of the picture.
struct Leader {
  double x = 0.0, y = 0.0;  ///< px from the upper left corner
  std::string text{};
};
/// Each on a plate of its own beside its place, within the picture and where it hides no place and no other
/// plate, left of `right_px` and outside of the corner up to `legend`, with a line to the place and a dot on
/// it.
void draw_leaders(Image& image, const std::vector<Leader>& leaders, double right_px,
                  const Vec2& legend = Vec2::Zero());

}  // namespace swarf::render
