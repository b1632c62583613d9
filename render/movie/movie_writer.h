// H.264 movies that play in every browser (libav, libx264).
#pragma once

#include <memory>
#include <string>

#include "render/draw_list.h"

namespace swarf::render {

/// Encodes images into an .mp4: H.264 4:2:0 in BT.709, with its index at the front so that it plays while
/// loading.
///
/// One encoder thread: the same images give the same bytes on every run. The file appears under its name only
/// in finish(); a writer destroyed before that leaves nothing behind.
class MovieWriter {
 public:
  /// `width` and `height` even, `fps` frames a second. Throws InputError "movie-write" when the file cannot
  /// be made or this libav has no H.264 encoder.
  MovieWriter(const std::string& path, int width, int height, int fps);
  ~MovieWriter();
  MovieWriter(const MovieWriter&) = delete;
  MovieWriter& operator=(const MovieWriter&) = delete;

  /// Appends one frame of the movie's size.
  void add(const Image& image);
  /// Ends the file and gives it its name. To be called once, after at least one frame.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace swarf::render
