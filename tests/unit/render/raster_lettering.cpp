#include "render/lettering.h"

#include <gtest/gtest.h>

#include "base/check.h"
#include "raster_scene.h"

namespace swarf::render {
namespace {

Image grey(int width, int height) {
  Image image{width, height, std::vector<uint8_t>(size_t{4} * width * height, 128)};
  for (size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  return image;
}

/// Changed pixels in a rectangle.
int changed(const Image& image, int x0, int x1, int y0, int y1) {
  int count = 0;
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) count += pixel(image, x, y).r != 128 ? 1 : 0;
  }
  return count;
}

TEST(Lettering, ACaptionStaysInItsCornerAndHasWrittenPixels) {
  Image image = grey(640, 360);
  draw_caption(image, {"Dome", "t = 12.5 s   F 1500 mm/min"}, Corner::kBottomLeft);
  EXPECT_GT(changed(image, 0, 320, 270, 360), 3000);
  EXPECT_EQ(changed(image, 0, 640, 0, 270), 0);
  EXPECT_EQ(changed(image, 400, 640, 0, 360), 0);
  int bright = 0;
  for (size_t i = 0; i < image.rgba.size(); i += 4) bright += image.rgba[i] > 220 ? 1 : 0;
  EXPECT_GT(bright, 150);  // the letters
  EXPECT_EQ(image.rgba[3], 255);
}

TEST(Lettering, MoreLinesMakeATallerPlateAndNoneMakeNone) {
  Image none = grey(640, 360), one = grey(640, 360), three = grey(640, 360);
  draw_caption(none, {});
  draw_caption(one, {"line"}, Corner::kTopRight);
  draw_caption(three, {"line", "line", "line"}, Corner::kTopRight);
  EXPECT_EQ(none.rgba, grey(640, 360).rgba);
  EXPECT_GT(changed(three, 320, 640, 0, 180), 2 * changed(one, 320, 640, 0, 180) - 200);
  EXPECT_EQ(changed(three, 0, 320, 0, 360), 0);
}

TEST(Lettering, ANoticeIsRedAtTheTopAndAProgressBarGrows) {
  Image image = grey(640, 360), half = grey(640, 360), none = grey(640, 360);
  draw_notice(image, {"gouge 0.2 mm"}, true);
  draw_notice(none, {}, true);
  EXPECT_EQ(none.rgba, grey(640, 360).rgba);
  const Pixel plate = pixel(image, 13, 20);
  EXPECT_GT(plate.r, 2 * plate.g);
  EXPECT_EQ(changed(image, 0, 640, 180, 360), 0);
  draw_progress(half, 0.5);
  EXPECT_GT(pixel(half, 310, 359).r, 200);
  EXPECT_LT(pixel(half, 330, 359).r, 128);
  EXPECT_EQ(changed(half, 0, 640, 0, 350), 0);
}

TEST(Lettering, AColourBarRunsFromLowBelowToHighAbove) {
  Image image = grey(640, 360);
  ColourBar bar;
  bar.low = -5;
  bar.high = 10;
  bar.colour = [](double v) { return v > 0 ? Rgb{1, 0, 0} : Rgb{0, 0, 1}; };
  bar.ticks = {{-5, "-5"}, {0, "0"}, {10, "10"}};
  bar.title = "excess, um";
  draw_colour_bar(image, bar);
  int red = 0, blue = 0, lowest_red = 0, highest_blue = 360;
  for (int y = 0; y < 360; ++y) {
    for (int x = 320; x < 640; ++x) {
      const Pixel p = pixel(image, x, y);
      if (p.r == 255 && p.g == 0 && p.b == 0) ++red, lowest_red = std::max(lowest_red, y);
      if (p.r == 0 && p.g == 0 && p.b == 255) ++blue, highest_blue = std::min(highest_blue, y);
    }
  }
  EXPECT_GT(blue, 300);
  EXPECT_NEAR(static_cast<double>(red) / blue, 2.0, 0.05);  // 10 above zero, 5 below
  EXPECT_EQ(highest_blue, lowest_red + 1);
}

TEST(Lettering, RefusesABarWithoutARange) {
  Image image = grey(64, 64);
  ColourBar bar;
  bar.high = bar.low;
  EXPECT_THROW(draw_colour_bar(image, bar), InternalError);
}

/// 3 px a mm in 640 px: at most 42 mm, so 20 mm, 60 px of pure ink in a row.
TEST(Lettering, TheScaleBarIsAsLongAsItSays) {
  Image image = grey(640, 360);
  draw_scale_bar(image, 3.0);
  int longest = 0;
  for (int y = 0; y < 360; ++y) {
    int row = 0;
    for (int x = 0; x < 640; ++x) {
      row = pixel(image, x, y).r > 235 ? row + 1 : 0;
      longest = std::max(longest, row);
    }
  }
  EXPECT_NEAR(longest, 60, 2);
  EXPECT_THROW(draw_scale_bar(image, 0.0), InternalError);
}

/// A plate hides no place that another leads to.
TEST(Lettering, LeadersLeaveEachOthersPlacesInSight) {
  Image image = grey(640, 360);
  draw_leaders(image, {{300.0, 200.0, "lowest -4.85"}, {350.0, 160.0, "highest +1.67"}}, 640.0);
  EXPECT_GT(pixel(image, 300, 200).r, 220);
  EXPECT_GT(pixel(image, 350, 160).r, 220);
}

/// Letters below 11 px cannot be read, so that small pictures have room for fewer.
TEST(Lettering, ACaptionKeepsToItsShareOfThePicture) {
  EXPECT_EQ(caption_lines(100, 1.0 / 6.0), 1U);
  EXPECT_EQ(caption_lines(270, 1.0 / 6.0), 2U);
  EXPECT_EQ(caption_lines(360, 1.0 / 6.0), 3U);
  EXPECT_EQ(caption_lines(720, 1.0 / 6.0), 4U);
  Image image = grey(480, 270);
  draw_caption(image, std::vector<std::string>(caption_lines(270, 1.0 / 6.0), "work x y z"));
  const int plate = 270 / 6, edge = 9;  // px
  EXPECT_EQ(changed(image, 0, 480, 0, 270 - edge - plate), 0);
  EXPECT_GT(changed(image, 0, 480, 270 - edge - plate, 270), 0);
}

TEST(Lettering, ALongLineEndsWithinThePicture) {
  Image image = grey(320, 180);
  draw_caption(image, {std::string(200, 'W'), "short"});
  EXPECT_GT(changed(image, 0, 300, 0, 180), 0);
  EXPECT_EQ(changed(image, 316, 320, 0, 180), 0);
}

TEST(Lettering, ALegendShowsEachKindInItsColour) {
  Image image = grey(640, 360);
  Strokes red, blue;
  red.sample = {0.9F, 0.0F, 0.0F};
  blue.sample = {0.0F, 0.0F, 0.9F};
  red.words = "red";
  blue.words = "blue";
  red.width = blue.width = 0.3;
  draw_legend(image, "section", {red, blue}, {"a note"});
  int reds = 0, blues = 0;
  for (int y = 0; y < 180; ++y)
    for (int x = 0; x < 320; ++x) {
      const auto p = pixel(image, x, y);
      if (p.r > 200 && p.g < 60) ++reds;
      if (p.b > 200 && p.g < 60) ++blues;
    }
  EXPECT_GT(reds, 30);
  EXPECT_GT(blues, 30);
  EXPECT_EQ(changed(image, 320, 640, 0, 360), 0);
}

/// Places in the corners: dots on them, plates within the picture, two of one place below one another.
TEST(Lettering, LeadersStayInThePictureAndApart) {
  Image image = grey(640, 360);
  draw_leaders(image, {{2.0, 2.0, "deepest -1.00"}, {637.0, 357.0, "highest +2.00"}, {637.0, 357.0, "again"}},
               640.0);
  EXPECT_GT(pixel(image, 2, 2).r, 220);
  EXPECT_GT(pixel(image, 637, 357).r, 220);
  EXPECT_EQ(changed(image, 200, 400, 0, 360), 0);
  Image one = grey(640, 360), two = grey(640, 360);
  draw_leaders(one, {{300.0, 200.0, "first"}}, 640.0);
  draw_leaders(two, {{300.0, 200.0, "first"}, {300.0, 200.0, "other"}}, 640.0);
  EXPECT_GT(changed(two, 0, 640, 0, 360), 1.8 * changed(one, 0, 640, 0, 360));
  // Left of what stands along the right border.
  Image beside = grey(640, 360);
  draw_leaders(beside, {{400.0, 200.0, "highest +10.00"}}, 420.0);
  EXPECT_GT(changed(beside, 0, 420, 0, 360), 0);
  EXPECT_EQ(changed(beside, 420, 640, 0, 360), 0);
}

}  // namespace
}  // namespace swarf::render
