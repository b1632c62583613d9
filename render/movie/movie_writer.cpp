#include "render/movie/movie_writer.h"

#include <array>
#include <cstdint>

#include "base/check.h"
#include "base/diagnostics.h"
#include "base/file.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

namespace swarf::render {
namespace {

struct Setting {
  const char *name, *value;
};

/// A kind of file by its ending.
struct MovieKind {
  const char *ending, *container, *encoder;
  AVPixelFormat pixels;
  std::vector<Setting> codec, file;
};

const std::vector<MovieKind>& kinds() {
  // Constant rate factors: no loss that shows at 1:1.
  static const std::vector<MovieKind> list{
      {".mp4",
       "mp4",
       "libx264",
       AV_PIX_FMT_YUV420P,
       // Less than half of the encoder's time with "veryfast", which mostly looks for motion; as near to the
       // frames or nearer (45.0 against 43.8 dB), for 1.4 times the bytes. Transforms of 8 x 8 and blocks
       // that are filtered cost a twentieth and keep gradients smooth.
       {{"preset", "ultrafast"}, {"crf", "24"}, {"x264-params", "deblock=0,0:8x8dct=1:partitions=i4x4,i8x8"}},
       {{"movflags", "+faststart"}}},
      {".webm",
       "webm",
       "libvpx-vp9",
       AV_PIX_FMT_YUV420P,
       {{"crf", "30"}, {"deadline", "realtime"}, {"cpu-used", "6"}},
       {}},
      {".apng", "apng", "apng", AV_PIX_FMT_RGB24, {{"pred", "mixed"}}, {{"plays", "0"}}}};
  return list;
}

const MovieKind& kind_of(const std::string& path) {
  for (const MovieKind& kind : kinds()) {
    if (path.ends_with(kind.ending)) return kind;
  }
  throw InputError("movie-ending", {path}, "this is no kind of movie",
                   "end the name in .mp4, .webm or .apng");
}

constexpr int kKeyFrameSeconds = 2;  // how far a player has to decode to jump

std::string reason_of(int error) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(error, text.data(), text.size());
  return text.data();
}

}  // namespace

void check_movie_name(const std::string& path) {
  kind_of(path);
}

/// What libav has made goes back to it.
namespace libav {
template <auto Free>
struct FreeByAddress {
  template <class T>
  void operator()(T* object) const {
    Free(&object);
  }
};
struct FreeFormat {
  void operator()(AVFormatContext* format) const {
    avio_closep(&format->pb);
    avformat_free_context(format);
  }
};
}  // namespace libav

struct MovieWriter::Impl {
  std::string path;
  const MovieKind& kind;
  NewFile file;
  std::unique_ptr<AVFormatContext, libav::FreeFormat> format;
  std::unique_ptr<AVCodecContext, libav::FreeByAddress<avcodec_free_context>> codec;
  std::unique_ptr<AVFrame, libav::FreeByAddress<av_frame_free>> frame;
  std::unique_ptr<AVPacket, libav::FreeByAddress<av_packet_free>> packet;
  std::unique_ptr<SwsContext, decltype(&sws_freeContext)> scaler{nullptr, sws_freeContext};
  AVStream* stream = nullptr;
  int64_t frames = 0;
  bool finished = false;

  Impl(std::string movie, int width, int height, int fps, const MovieChapters& chapters);
  void add_chapters(const MovieChapters& chapters);
  void open_codec(int width, int height, int fps);
  void open_file();
  void prepare_frame(int width, int height);
  /// Sends a frame (null: the end) and writes what comes out.
  void encode(const AVFrame* input);
  void require(int result, const char* what) const;
};

void MovieWriter::Impl::require(int result, const char* what) const {
  if (result < 0) file.refuse(std::string(what) + ": " + reason_of(result));
}

MovieWriter::Impl::Impl(std::string movie, int width, int height, int fps, const MovieChapters& chapters)
    : path(std::move(movie)),
      kind(kind_of(path)),
      file(path, {"movie-write", "the movie cannot be written"}),
      packet(av_packet_alloc()) {
  av_log_set_level(AV_LOG_QUIET);  // libav talks on stderr; what goes wrong comes back as codes
  SWARF_CHECK(width > 0 && height > 0 && width % 2 == 0 && height % 2 == 0, "4:2:0 needs even sizes");
  SWARF_CHECK(fps > 0, "a movie needs frames per second");
  AVFormatContext* made = nullptr;
  require(avformat_alloc_output_context2(&made, nullptr, kind.container, file.temporary().c_str()),
          "no such container");
  format.reset(made);
  open_codec(width, height, fps);
  prepare_frame(width, height);
  add_chapters(chapters);
  open_file();
}

/// A container that knows none leaves them out. Each ends where the next begins, the last with the movie.
void MovieWriter::Impl::add_chapters(const MovieChapters& chapters) {
  constexpr int64_t kToTheEnd = INT32_MAX;
  for (size_t i = 0; i < chapters.size(); ++i) {
    auto** grown = static_cast<AVChapter**>(av_realloc_array(format->chapters, i + 1, sizeof(AVChapter*)));
    SWARF_CHECK(grown != nullptr, "no memory for a chapter");
    format->chapters = grown;
    auto* chapter = static_cast<AVChapter*>(av_mallocz(sizeof(AVChapter)));
    SWARF_CHECK(chapter != nullptr, "no memory for a chapter");
    chapter->id = static_cast<int64_t>(i) + 1;
    chapter->time_base = codec->time_base;
    chapter->start = static_cast<int64_t>(chapters[i].first);
    chapter->end = i + 1 < chapters.size() ? static_cast<int64_t>(chapters[i + 1].first) : kToTheEnd;
    av_dict_set(&chapter->metadata, "title", chapters[i].second.c_str(), 0);
    format->chapters[i] = chapter;
    format->nb_chapters = static_cast<unsigned>(i) + 1;
  }
}

void MovieWriter::Impl::open_codec(int width, int height, int fps) {
  const AVCodec* encoder = avcodec_find_encoder_by_name(kind.encoder);
  if (encoder == nullptr) {
    throw InputError(
        "movie-write", {path}, std::string("libav has no encoder ") + kind.encoder,
        "install libavcodec with it (Debian: apt-get install libavcodec59), or leave out [movie]");
  }
  codec.reset(avcodec_alloc_context3(encoder));
  codec->width = width;
  codec->height = height;
  codec->pix_fmt = kind.pixels;
  codec->time_base = {1, fps};
  codec->framerate = {fps, 1};
  codec->gop_size = kKeyFrameSeconds * fps;
  codec->thread_count = 1;  // x264's bytes depend on the number of threads
  codec->flags |= AV_CODEC_FLAG_BITEXACT;
  if ((format->oformat->flags & AVFMT_GLOBALHEADER) != 0) codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  if (kind.pixels == AV_PIX_FMT_YUV420P) {
    codec->color_primaries = AVCOL_PRI_BT709;
    codec->color_trc = AVCOL_TRC_BT709;
    codec->colorspace = AVCOL_SPC_BT709;
    codec->color_range = AVCOL_RANGE_MPEG;
  }
  for (const Setting& setting : kind.codec)
    require(av_opt_set(codec->priv_data, setting.name, setting.value, 0), setting.name);
  require(avcodec_open2(codec.get(), encoder, nullptr), "the encoder does not open");
}

void MovieWriter::Impl::open_file() {
  stream = avformat_new_stream(format.get(), nullptr);
  SWARF_CHECK(stream != nullptr, "libav cannot add a stream");
  stream->time_base = codec->time_base;
  stream->avg_frame_rate = codec->framerate;
  require(avcodec_parameters_from_context(stream->codecpar, codec.get()), "stream parameters");
  format->flags |= AVFMT_FLAG_BITEXACT;
  require(avio_open(&format->pb, file.temporary().c_str(), AVIO_FLAG_WRITE), "the movie cannot be made");
  AVDictionary* options = nullptr;
  for (const Setting& setting : kind.file) av_dict_set(&options, setting.name, setting.value, 0);
  const int written = avformat_write_header(format.get(), &options);
  av_dict_free(&options);
  require(written, "the movie's header cannot be written");
}

void MovieWriter::Impl::prepare_frame(int width, int height) {
  frame.reset(av_frame_alloc());
  frame->format = kind.pixels;
  frame->width = width;
  frame->height = height;
  require(av_frame_get_buffer(frame.get(), 0), "no memory for a frame");
  scaler.reset(sws_getContext(width, height, AV_PIX_FMT_RGBA, width, height, kind.pixels,
                              SWS_BILINEAR | SWS_ACCURATE_RND | SWS_BITEXACT, nullptr, nullptr, nullptr));
  SWARF_CHECK(scaler != nullptr, "swscale cannot convert RGBA");
  if (kind.pixels != AV_PIX_FMT_YUV420P) return;
  const int* bt709 = sws_getCoefficients(SWS_CS_ITU709);
  constexpr int kOne = 1 << 16;  // swscale's fixed point
  sws_setColorspaceDetails(scaler.get(), bt709, 1, bt709, 0, 0, kOne, kOne);
}

void MovieWriter::Impl::encode(const AVFrame* input) {
  require(avcodec_send_frame(codec.get(), input), "a frame cannot be encoded");
  for (;;) {
    const int result = avcodec_receive_packet(codec.get(), packet.get());
    if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) return;
    require(result, "a frame cannot be encoded");
    packet->duration = 1;
    av_packet_rescale_ts(packet.get(), codec->time_base, stream->time_base);
    packet->stream_index = stream->index;
    require(av_interleaved_write_frame(format.get(), packet.get()), "the movie cannot be written");
  }
}

MovieWriter::MovieWriter(const std::string& path, int width, int height, int fps,
                         const MovieChapters& chapters)
    : impl_(std::make_unique<Impl>(path, width, height, fps, chapters)) {}

MovieWriter::~MovieWriter() = default;

void MovieWriter::add(const Image& image) {
  Impl& impl = *impl_;
  SWARF_CHECK(!impl.finished, "the movie is finished");
  SWARF_CHECK(image.width == impl.codec->width && image.height == impl.codec->height,
              "a frame of another size");
  impl.require(av_frame_make_writable(impl.frame.get()), "no memory for a frame");
  const uint8_t* rows[] = {image.rgba.data()};
  const int strides[] = {4 * image.width};
  sws_scale(impl.scaler.get(), rows, strides, 0, image.height, impl.frame->data, impl.frame->linesize);
  impl.frame->pts = impl.frames++;
  impl.encode(impl.frame.get());
}

void MovieWriter::finish() {
  Impl& impl = *impl_;
  SWARF_CHECK(!impl.finished && impl.frames > 0, "a movie is finished once, after its frames");
  impl.encode(nullptr);
  impl.require(av_write_trailer(impl.format.get()), "the movie cannot be completed");
  impl.require(avio_closep(&impl.format->pb), "the movie cannot be completed");
  impl.file.move_into_place();
  impl.finished = true;
}

}  // namespace swarf::render
