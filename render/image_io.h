// PNG files.
#pragma once

#include <string>

#include "render/draw_list.h"

namespace swarf::render {

/// Writes to a temporary name beside `path`, then renames: a killed run leaves no half file.
/// Throws InputError "image-write" when the file cannot be written.
void save_png(const Image& image, const std::string& path);

/// Throws InputError "image-read" when the file is missing or no PNG.
Image load_png(const std::string& path);

}  // namespace swarf::render
