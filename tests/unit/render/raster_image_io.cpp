#include "render/image_io.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/diagnostics.h"
#include "base/rng.h"
#include "support/full_disk.h"
#include "support/scratch.h"

namespace swarf::render {
namespace {

const std::string kFolder = test::scratch_text();

TEST(ImageIo, APictureComesBackByteForByte) {
  Image image{37, 19, std::vector<uint8_t>(size_t{4} * 37 * 19)};
  Rng rng(5);
  for (uint8_t& byte : image.rgba) byte = static_cast<uint8_t>(rng.next());
  const std::string path = kFolder + "swarf_round_trip.png";
  save_png(image, path);
  const Image back = load_png(path);
  EXPECT_EQ(back.width, 37);
  EXPECT_EQ(back.height, 19);
  EXPECT_EQ(back.rgba, image.rgba);
  {
    const test::FullDisk disk(100);
    EXPECT_THROW(save_png(image, path), InputError);
  }
  EXPECT_EQ(load_png(path).rgba, image.rgba) << "the old picture stays";
  std::filesystem::remove(path);
}

TEST(ImageIo, SaysWhatIsWrongWithAPath) {
  const Image image{1, 1, {1, 2, 3, 255}};
  try {
    save_png(image, kFolder + "no_such_folder/x.png");
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics.list().at(0).code, "image-write");
  }
  const std::string path = kFolder + "swarf_no_picture.png";
  std::ofstream(path) << "no picture";
  EXPECT_THROW(load_png(path), InputError);
  EXPECT_THROW(load_png(path + ".missing"), InputError);
  std::filesystem::remove(path);
}

/// A gradient with noise, as metal is drawn.
Image grainy(int width, int height) {
  Image image{width, height, {}};
  Rng rng(3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 4; ++c)
        image.rgba.push_back(c == 3 ? 255
                                    : static_cast<uint8_t>(60 + 120 * x / width + rng.uniform(0.0, 6.0)));
  return image;
}

TEST(ImageIo, WebpIsSmallAndTheSameEachTime) {
  const Image image = grainy(320, 200);
  const std::string bytes = webp(image, kPageQuality);
  EXPECT_TRUE(bytes.starts_with("RIFF"));
  EXPECT_EQ(bytes.substr(8, 4), "WEBP");
  EXPECT_EQ(webp(image, kPageQuality), bytes);
  const std::string path = kFolder + "swarf_grainy.png";
  save_png(image, path);
  EXPECT_LT(3 * bytes.size(), std::filesystem::file_size(path));
  std::filesystem::remove(path);
  EXPECT_FALSE(webp(Image{1, 1, {1, 2, 3, 255}}, kPageQuality).empty());
}

}  // namespace
}  // namespace swarf::render
