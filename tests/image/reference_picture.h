// Pictures against those in tests/image/reference; SWARF_REFRESH_REFERENCES=1 replaces them.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "image/picture_difference.h"
#include "render/image_io.h"

namespace swarf::test {

// The pictures are seeded, so on one machine they are equal. Another instruction set of Embree or llvmpipe
// moves edges by a part of a pixel: a strip of one pixel through a tile, a sixteenth of it, by a third of the
// range would be 5 of 255.
inline constexpr double kTileTolerance = 6.0;

inline const std::filesystem::path kReferences = SWARF_SOURCE_DIR "/tests/image/reference";

inline void keep(const render::Image& picture, const std::string& name) {
  const std::filesystem::path folder = std::filesystem::current_path() / "image_failures";
  std::filesystem::create_directories(folder);
  render::save_png(picture, (folder / name).string());
}

inline void expect_like_reference(const render::Image& picture, const std::string& name) {
  if (std::getenv("SWARF_REFRESH_REFERENCES") != nullptr)
    render::save_png(picture, (kReferences / name).string());
  const render::Image reference = render::load_png((kReferences / name).string());
  ASSERT_EQ(picture.width, reference.width);
  ASSERT_EQ(picture.height, reference.height);
  const TileDifference worst = largest_difference(picture, reference);
  if (worst.mean <= kTileTolerance) return;
  keep(picture, name);
  ADD_FAILURE() << fmt::format("{} differs by {:.1f} of 255 in the tile at ({}, {}); kept in image_failures/",
                               name, worst.mean, worst.x, worst.y);
}

}  // namespace swarf::test
