// Movies: H.264 that plays in every browser, WebM, and animated PNG for pages that take no movie (libav).
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "render/draw_list.h"

namespace swarf::render {

/// Where a chapter begins, frames, and its name; the first begins at 0.
using MovieChapters = std::vector<std::pair<size_t, std::string>>;

/// Before any work: throws InputError "movie-ending" for a name that is no kind of movie.
void check_movie_name(const std::string& path);

/// Encodes images by the file's ending:
///   .mp4   H.264 4:2:0 in BT.709, with its index at the front so that it plays while loading
///   .webm  VP9 4:2:0 in BT.709
///   .apng  every pixel as it is, repeated for ever: for a few seconds in a README
/// mp4 and WebM hold the chapters.
///
/// One encoder thread: the same images give the same bytes on every run. The file appears under its name only
/// in finish(); a writer destroyed before that leaves nothing behind.
class MovieWriter {
 public:
  /// `width` and `height` even, `fps` frames a second. Throws InputError "movie-write" when the file cannot
  /// be made, or this libav lacks the encoder, and "movie-ending".
  MovieWriter(const std::string& path, int width, int height, int fps, const MovieChapters& chapters = {});
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
