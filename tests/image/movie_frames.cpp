#include "image/movie_frames.h"

#include <memory>
#include <stdexcept>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

namespace swarf::test {
namespace {

void require_opened(bool holds, const std::string& path) {
  if (!holds) throw std::runtime_error("cannot read the movie " + path);
}

render::Image picture_of(const AVFrame& frame, SwsContext* scaler) {
  render::Image image{frame.width, frame.height, {}};
  image.rgba.resize(size_t{4} * static_cast<size_t>(frame.width) * static_cast<size_t>(frame.height));
  uint8_t* rows[] = {image.rgba.data()};
  const int strides[] = {4 * frame.width};
  sws_scale(scaler, frame.data, frame.linesize, 0, frame.height, rows, strides);
  return image;
}

/// Everything that is open while a file is decoded.
struct Decoder {
  AVFormatContext* format = nullptr;
  AVCodecContext* codec = nullptr;
  SwsContext* scaler = nullptr;
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();

  Decoder() = default;
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  ~Decoder() {
    sws_freeContext(scaler);
    av_frame_free(&frame);
    av_packet_free(&packet);
    avcodec_free_context(&codec);
    avformat_close_input(&format);
  }
};

}  // namespace

std::vector<render::Image> movie_frames(const std::string& path) {
  Decoder d;
  require_opened(avformat_open_input(&d.format, path.c_str(), nullptr, nullptr) == 0, path);
  require_opened(avformat_find_stream_info(d.format, nullptr) >= 0 && d.format->nb_streams >= 1, path);
  const AVCodecParameters* stream = d.format->streams[0]->codecpar;
  d.codec = avcodec_alloc_context3(avcodec_find_decoder(stream->codec_id));
  avcodec_parameters_to_context(d.codec, stream);
  require_opened(avcodec_open2(d.codec, nullptr, nullptr) == 0, path);
  d.scaler =
      sws_getContext(stream->width, stream->height, static_cast<AVPixelFormat>(stream->format), stream->width,
                     stream->height, AV_PIX_FMT_RGBA, SWS_BILINEAR, nullptr, nullptr, nullptr);
  std::vector<render::Image> frames;
  for (bool more = true; more;) {
    more = av_read_frame(d.format, d.packet) == 0;
    if (more && d.packet->stream_index != 0) {  // the names of the chapters
      av_packet_unref(d.packet);
      continue;
    }
    avcodec_send_packet(d.codec, more ? d.packet : nullptr);
    av_packet_unref(d.packet);
    while (avcodec_receive_frame(d.codec, d.frame) == 0) frames.push_back(picture_of(*d.frame, d.scaler));
  }
  return frames;
}

}  // namespace swarf::test
