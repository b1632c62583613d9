#include "render/movie/movie_writer.h"

#include <array>

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

constexpr const char* kPreset = "veryfast";
constexpr const char* kQuality = "20";  // constant rate factor: no loss that shows at 1:1
constexpr int kKeyFrameSeconds = 2;     // how far a player has to decode to jump

std::string reason_of(int error) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(error, text.data(), text.size());
  return text.data();
}

}  // namespace

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
  NewFile file;
  std::unique_ptr<AVFormatContext, libav::FreeFormat> format;
  std::unique_ptr<AVCodecContext, libav::FreeByAddress<avcodec_free_context>> codec;
  std::unique_ptr<AVFrame, libav::FreeByAddress<av_frame_free>> frame;
  std::unique_ptr<AVPacket, libav::FreeByAddress<av_packet_free>> packet;
  std::unique_ptr<SwsContext, decltype(&sws_freeContext)> scaler{nullptr, sws_freeContext};
  AVStream* stream = nullptr;
  int64_t frames = 0;
  bool finished = false;

  Impl(std::string movie, int width, int height, int fps);
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

MovieWriter::Impl::Impl(std::string movie, int width, int height, int fps)
    : path(std::move(movie)),
      file(path, {"movie-write", "the movie cannot be written"}),
      packet(av_packet_alloc()) {
  av_log_set_level(AV_LOG_QUIET);  // libav talks on stderr; what goes wrong comes back as codes
  SWARF_CHECK(width > 0 && height > 0 && width % 2 == 0 && height % 2 == 0, "4:2:0 needs even sizes");
  SWARF_CHECK(fps > 0, "a movie needs frames per second");
  AVFormatContext* made = nullptr;
  require(avformat_alloc_output_context2(&made, nullptr, "mp4", file.temporary().c_str()),
          "no mp4 container");
  format.reset(made);
  open_codec(width, height, fps);
  prepare_frame(width, height);
  open_file();
}

void MovieWriter::Impl::open_codec(int width, int height, int fps) {
  const AVCodec* encoder = avcodec_find_encoder_by_name("libx264");
  if (encoder == nullptr) {
    throw InputError(
        "movie-write", {path}, "libav has no H.264 encoder (libx264)",
        "install libavcodec with libx264 (Debian: apt-get install libavcodec59), or leave out [movie]");
  }
  codec.reset(avcodec_alloc_context3(encoder));
  codec->width = width;
  codec->height = height;
  codec->pix_fmt = AV_PIX_FMT_YUV420P;
  codec->time_base = {1, fps};
  codec->framerate = {fps, 1};
  codec->gop_size = kKeyFrameSeconds * fps;
  codec->thread_count = 1;  // x264's bytes depend on the number of threads
  codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_BITEXACT;
  codec->color_primaries = AVCOL_PRI_BT709;
  codec->color_trc = AVCOL_TRC_BT709;
  codec->colorspace = AVCOL_SPC_BT709;
  codec->color_range = AVCOL_RANGE_MPEG;
  require(av_opt_set(codec->priv_data, "preset", kPreset, 0), "x264 preset");
  require(av_opt_set(codec->priv_data, "crf", kQuality, 0), "x264 quality");
  require(avcodec_open2(codec.get(), encoder, nullptr), "the H.264 encoder does not open");
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
  av_dict_set(&options, "movflags", "+faststart", 0);
  const int written = avformat_write_header(format.get(), &options);
  av_dict_free(&options);
  require(written, "the movie's header cannot be written");
}

void MovieWriter::Impl::prepare_frame(int width, int height) {
  frame.reset(av_frame_alloc());
  frame->format = AV_PIX_FMT_YUV420P;
  frame->width = width;
  frame->height = height;
  require(av_frame_get_buffer(frame.get(), 0), "no memory for a frame");
  scaler.reset(sws_getContext(width, height, AV_PIX_FMT_RGBA, width, height, AV_PIX_FMT_YUV420P,
                              SWS_BILINEAR | SWS_ACCURATE_RND | SWS_BITEXACT, nullptr, nullptr, nullptr));
  SWARF_CHECK(scaler != nullptr, "swscale cannot convert RGBA to 4:2:0");
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

MovieWriter::MovieWriter(const std::string& path, int width, int height, int fps)
    : impl_(std::make_unique<Impl>(path, width, height, fps)) {}

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
