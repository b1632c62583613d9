// The frames of a movie as pictures.
#pragma once

#include <string>
#include <vector>

#include "render/image_io.h"

namespace swarf::test {

/// Decodes the whole file. Throws std::runtime_error when it cannot be read.
std::vector<render::Image> movie_frames(const std::string& path);

}  // namespace swarf::test
