#include "render/movie/movie_writer.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/check.h"
#include "base/diagnostics.h"
#include "support/full_disk.h"
#include "support/scratch.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace swarf::render::movie_writer {
namespace {

constexpr int kWidth = 320, kHeight = 180, kFrames = 30;

Image plain(uint8_t r, uint8_t g, uint8_t b) {
  Image image{kWidth, kHeight, {}};
  for (int i = 0; i < kWidth * kHeight; ++i) image.rgba.insert(image.rgba.end(), {r, g, b, 255});
  return image;
}

void write_movie(const std::string& path) {
  MovieWriter movie(path, kWidth, kHeight, 30);
  for (int i = 0; i < kFrames; ++i) movie.add(i < kFrames / 2 ? plain(200, 40, 40) : plain(40, 60, 180));
  movie.finish();
}

std::string bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

struct Decoded {
  int frames = 0, width = 0, height = 0, format = -1;
  AVRational rate{};
  std::vector<std::array<double, 3>> mean;  ///< Y, U, V per frame
};

double plane_mean(const AVFrame& frame, int plane) {
  const int shift = plane == 0 ? 0 : 1;
  double sum = 0.0;
  for (int y = 0; y < frame.height >> shift; ++y) {
    for (int x = 0; x < frame.width >> shift; ++x) sum += frame.data[plane][y * frame.linesize[plane] + x];
  }
  return sum / ((frame.height >> shift) * (frame.width >> shift));
}

Decoded decode(const std::string& path) {
  Decoded result;
  AVFormatContext* format = nullptr;
  EXPECT_EQ(avformat_open_input(&format, path.c_str(), nullptr, nullptr), 0);
  EXPECT_GE(avformat_find_stream_info(format, nullptr), 0);
  const AVStream* stream = format->streams[0];
  result.rate = stream->avg_frame_rate;
  AVCodecContext* codec = avcodec_alloc_context3(avcodec_find_decoder(stream->codecpar->codec_id));
  avcodec_parameters_to_context(codec, stream->codecpar);
  EXPECT_EQ(avcodec_open2(codec, nullptr, nullptr), 0);
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  for (bool more = true; more;) {
    more = av_read_frame(format, packet) == 0;
    if (more && packet->stream_index != 0) {  // the names of the chapters
      av_packet_unref(packet);
      continue;
    }
    avcodec_send_packet(codec, more ? packet : nullptr);
    av_packet_unref(packet);
    while (avcodec_receive_frame(codec, frame) == 0) {
      ++result.frames;
      result.width = frame->width;
      result.height = frame->height;
      result.format = frame->format;
      if (frame->format == AV_PIX_FMT_YUV420P)
        result.mean.push_back({plane_mean(*frame, 0), plane_mean(*frame, 1), plane_mean(*frame, 2)});
    }
  }
  av_frame_free(&frame);
  av_packet_free(&packet);
  avcodec_free_context(&codec);
  avformat_close_input(&format);
  return result;
}

/// BT.709, studio range, of an 8-bit R'G'B' colour (ITU-R BT.709-6, items 3.2 to 3.5).
std::array<double, 3> bt709(double r, double g, double b) {
  const double y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
  return {16 + 219 * y / 255, 128 + 224 * (b - y) / 1.8556 / 255, 128 + 224 * (r - y) / 1.5748 / 255};
}

TEST(MovieWriter, EveryFrameComesBackWithItsColour) {
  const std::string path = test::scratch_text() + "swarf_movie.mp4";
  write_movie(path);
  const Decoded movie = decode(path);
  EXPECT_EQ(movie.frames, kFrames);
  EXPECT_EQ(movie.width, kWidth);
  EXPECT_EQ(movie.height, kHeight);
  EXPECT_EQ(movie.format, AV_PIX_FMT_YUV420P);
  EXPECT_EQ(av_cmp_q(movie.rate, {30, 1}), 0);
  const auto red = bt709(200, 40, 40), blue = bt709(40, 60, 180);
  for (size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(movie.mean.at(5)[k], red[k], 1.5);
    EXPECT_NEAR(movie.mean.at(25)[k], blue[k], 1.5);
  }
  std::filesystem::remove(path);
}

/// Chapters of a file: where they begin, s, and their names.
std::vector<std::pair<double, std::string>> chapters_of(const std::string& path) {
  std::vector<std::pair<double, std::string>> list;
  AVFormatContext* format = nullptr;
  EXPECT_EQ(avformat_open_input(&format, path.c_str(), nullptr, nullptr), 0);
  for (unsigned i = 0; i < format->nb_chapters; ++i) {
    const AVChapter& chapter = *format->chapters[i];
    const AVDictionaryEntry* title = av_dict_get(chapter.metadata, "title", nullptr, 0);
    list.emplace_back(chapter.start * av_q2d(chapter.time_base), title != nullptr ? title->value : "");
  }
  avformat_close_input(&format);
  return list;
}

class MovieEndings : public testing::TestWithParam<const char*> {};

TEST_P(MovieEndings, FramesAndChaptersComeBack) {
  const std::string path = test::scratch_text() + "swarf_ending" + GetParam();
  {
    MovieWriter movie(path, kWidth, kHeight, 30, {{0, "T1"}, {15, "T2 ball"}});
    for (int i = 0; i < kFrames; ++i) movie.add(i < kFrames / 2 ? plain(200, 40, 40) : plain(40, 60, 180));
    movie.finish();
  }
  const Decoded movie = decode(path);
  EXPECT_EQ(movie.frames, kFrames);
  EXPECT_EQ(movie.width, kWidth);
  const std::vector<std::pair<double, std::string>> expected{{0.0, "T1"}, {0.5, "T2 ball"}};
  if (path.ends_with(".apng"))
    EXPECT_EQ(movie.format, AV_PIX_FMT_RGB24);  // no colour is halved
  else
    EXPECT_EQ(chapters_of(path), expected);
  std::filesystem::remove(path);
}

INSTANTIATE_TEST_SUITE_P(Kinds, MovieEndings, testing::Values(".mp4", ".webm", ".apng"));

TEST(MovieWriter, ANameThatSaysNoKindIsRefused) {
  try {
    MovieWriter movie(test::scratch_text() + "swarf.avi", kWidth, kHeight, 30);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics.list().at(0).code, "movie-ending");
  }
}

TEST(MovieWriter, TheSameFramesGiveTheSameBytesWithTheIndexInFront) {
  const std::string one = test::scratch_text() + "swarf_one.mp4",
                    two = test::scratch_text() + "swarf_two.mp4";
  write_movie(one);
  write_movie(two);
  const std::string first = bytes(one);
  EXPECT_EQ(first, bytes(two));
  EXPECT_LT(first.find("moov"), first.find("mdat"));
  std::filesystem::remove(one);
  std::filesystem::remove(two);
}

TEST(MovieWriter, AnUnfinishedMovieLeavesNothing) {
  const std::filesystem::path folder = test::scratch_folder() / "unfinished_movie";
  std::filesystem::create_directory(folder);
  {
    MovieWriter movie((folder / "movie.mp4").string(), kWidth, kHeight, 30);
    movie.add(plain(1, 2, 3));
    EXPECT_FALSE(std::filesystem::is_empty(folder));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(MovieWriter, SaysWhatIsWrong) {
  try {
    MovieWriter movie(test::scratch_text() + "no_such_folder/x.mp4", kWidth, kHeight, 30);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics.list().at(0).code, "movie-write");
  }
  EXPECT_THROW(MovieWriter(test::scratch_text() + "odd.mp4", 321, 180, 30), InternalError);
  const std::string path = test::scratch_text() + "swarf_empty.mp4";
  MovieWriter movie(path, kWidth, kHeight, 30);
  EXPECT_THROW(movie.finish(), InternalError);
  EXPECT_THROW(movie.add(Image{2, 2, std::vector<uint8_t>(16)}), InternalError);
}

/// Wherever the disk is full: before the header, within the frames, at the index, where the index moves to
/// the front.
TEST(MovieFullDisk, LeavesTheEarlierMovie) {
  const auto folder = test::scratch_folder() / "movie_full_disk";
  std::filesystem::create_directories(folder);
  const std::string path = (folder / "movie.mp4").string();
  write_movie(path);
  const std::string before = bytes(path);
  for (const double share : {0.0, 0.1, 0.5, 0.9, 0.99}) {
    SCOPED_TRACE(share);
    const test::FullDisk disk(static_cast<rlim_t>(share * static_cast<double>(before.size())));
    EXPECT_THROW(write_movie(path), InputError);
    EXPECT_EQ(bytes(path), before);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
  }
  write_movie(path);
  EXPECT_EQ(bytes(path), before);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace swarf::render::movie_writer
