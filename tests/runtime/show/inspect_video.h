// What a video file holds, by decoding all of it.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <string>

#include "runtime/base/result.h"

namespace probe::show {

struct VideoInfo {
  int width = 0, height = 0, frames = 0;
  double frames_per_second = 0;
  std::string codec;  // "h264"
};

// Owns what decoding needs, so that every way out frees it.
struct Decoder {
  AVFormatContext* format = nullptr;
  AVCodecContext* codec = nullptr;
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  ~Decoder() {
    av_frame_free(&frame);
    av_packet_free(&packet);
    avcodec_free_context(&codec);
    avformat_close_input(&format);
  }
};

inline Result<VideoInfo> inspect_video(const std::string& path) {
  const auto failed = [&](const char* what, int code) {
    return Failure{Fault::kVideo, std::string(what) + " (" + std::to_string(code) + ")", path};
  };
  Decoder d;
  int code = avformat_open_input(&d.format, path.c_str(), nullptr, nullptr);
  if (code < 0) return failed("cannot be opened", code);
  code = avformat_find_stream_info(d.format, nullptr);
  if (code < 0) return failed("no streams", code);
  const int index = av_find_best_stream(d.format, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (index < 0) return failed("no video stream", index);
  const AVStream* stream = d.format->streams[index];
  const AVCodec* decoder = avcodec_find_decoder(stream->codecpar->codec_id);
  d.codec = avcodec_alloc_context3(decoder);
  if (d.codec == nullptr) return failed("no memory", AVERROR(ENOMEM));
  avcodec_parameters_to_context(d.codec, stream->codecpar);
  code = avcodec_open2(d.codec, decoder, nullptr);
  if (code < 0) return failed("no decoder", code);

  VideoInfo info{stream->codecpar->width, stream->codecpar->height, 0,
                 av_q2d(stream->avg_frame_rate), avcodec_get_name(stream->codecpar->codec_id)};
  bool reading = true;
  while (reading) {
    reading = av_read_frame(d.format, d.packet) >= 0;
    if (reading && d.packet->stream_index != index) {
      av_packet_unref(d.packet);
      continue;
    }
    code = avcodec_send_packet(d.codec, reading ? d.packet : nullptr);
    av_packet_unref(d.packet);
    if (code < 0) return failed("cannot be decoded", code);
    while (avcodec_receive_frame(d.codec, d.frame) >= 0) ++info.frames;
  }
  return info;
}

}  // namespace probe::show
